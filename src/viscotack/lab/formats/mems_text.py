"""Layout of a LabVIEW program for a MEMS indenter: piezo and displacement of the spring.

A line with the name of the routine, a date and headings stand above a line ``eoh``. Tests of an
array follow each other in blocks, each behind its place and a line ``POC``. Numbers have decimal
commas. The force is the spring constant, which the file does not state, times the displacement.
"""

import re
from itertools import groupby

import numpy as np

from viscotack.lab.options import TackOptions

from .file import Curve, LabFile

_FIRST = "Quasi static measurement routine"
_LOOKED = 20  # lines searched for the end of the headings
_COLUMNS = ("Piezo position", "MEMS displ.", "Time")
_UNITS = {"nm": 1e-9, "um": 1e-6, "µm": 1e-6, "ms": 1e-3, "s": 1.0}


def curves(file: LabFile, given: TackOptions) -> list[Curve] | None:
    """Return the tests of a file; None for other files.

    Raises
    ------
    ValueError
        If the spring constant is not given, or a row is damaged.
    """
    if not file.lines or not file.lines[0].startswith(_FIRST):
        return None
    if given.spring_constant is None:
        raise file.error("the file states no stiffness of its spring; set --spring-constant")
    end = [text.strip() for text in file.lines[:_LOOKED]].index("eoh")
    heads = [text for text in file.lines[:end] if text.startswith(_COLUMNS[0])][0].split("\t")
    names, units = zip(*(re.split(r"\s*[\[\]]", f"{head}[]")[:2] for head in heads), strict=True)
    if not set(_COLUMNS) <= set(names):
        raise file.error(f"expected the columns {', '.join(_COLUMNS)} with units")
    places = [names.index(name) for name in _COLUMNS]
    factors = np.array([[_UNITS[units[place]]] for place in places])
    found = []
    below = file.lines[end + 1 :]
    for whole, lines in groupby(below, lambda text: text.count("\t") == len(heads) - 1):
        if not whole:
            continue
        numbers = [text.replace(",", ".") for text in lines]
        rows = np.loadtxt(numbers, delimiter="\t", usecols=places, ndmin=2)
        piezo, spring, time = factors * rows.T
        notes = ()
        if np.ptp(piezo) < np.ptp(spring):
            # a spring bends no farther than its drive moves
            piezo, time = 1e3 * piezo, 1e3 * time
            notes = (
                "piezo in um and time in s, whatever the headings: else the spring bends farther "
                "than the piezo moves",
            )
        stiffness = given.spring_constant
        found.append(Curve(time, stiffness * spring, piezo, 1, stiffness, notes))
    if not found:
        raise file.error("no rows of numbers below 'eoh'")
    return found
