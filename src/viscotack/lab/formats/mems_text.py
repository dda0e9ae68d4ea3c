"""Layout of a LabVIEW program for a MEMS indenter: piezo and displacement of the spring.

A line with the name of the routine, a date and headings stand above a line ``eoh``. Tests of an
array follow each other in blocks, each behind its place and a line ``POC``. Numbers have decimal
commas. The force is the spring constant, which the file does not state, times the displacement.
"""

import re

import numpy as np

from viscotack.errors import InputError
from viscotack.lab.options import TackOptions

from .file import Curve, LabFile
from .numbers import number

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
    ends = [i for i, text in enumerate(file.lines[:_LOOKED]) if text.strip() == "eoh"]
    heads = [text for text in file.lines[:_LOOKED] if text.startswith(_COLUMNS[0])]
    if not ends or not heads:
        raise file.error("no headings above a line 'eoh'")
    headings = [re.fullmatch(r"(.*?)\s*\[(.*)\]", head.strip()) for head in heads[0].split("\t")]
    names = [found[1] if found else "" for found in headings]
    if any(name not in names for name in _COLUMNS):
        raise file.error(f"expected the columns {', '.join(_COLUMNS)} with units")
    places = [names.index(name) for name in _COLUMNS]
    units = [_UNITS.get(found[2], np.nan) for found in headings if found]
    blocks: list[list[list[float]]] = [[]]
    for line, text in enumerate(file.lines[ends[0] + 1 :], start=ends[0] + 2):
        cells = text.split("\t")
        if len(cells) == len(names):
            try:
                blocks[-1].append([number(cells[place], ",") for place in places])
            except InputError as error:
                raise file.error(str(error), line) from None
        elif blocks[-1]:
            blocks.append([])
    found = []
    for block in filter(None, blocks):
        piezo, spring, time = np.array(block).T * np.array([[units[place]] for place in places])
        notes = []
        if np.ptp(piezo) < np.ptp(spring):
            # a spring bends no farther than its drive moves
            piezo, time = 1e3 * piezo, 1e3 * time
            notes.append("piezo in um and time in s, whatever the headings: else the spring bends")
            notes[-1] += " farther than the piezo moves"
        stiffness = given.spring_constant
        found.append(Curve(time, stiffness * spring, piezo, 1, stiffness, tuple(notes)))
    if not found:
        raise file.error("no rows of numbers below 'eoh'")
    return found
