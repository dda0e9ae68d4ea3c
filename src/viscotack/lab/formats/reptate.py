"""Layout of RepTate's text files: parameters in the first line, then columns.

The file extension defines the first columns; further columns are ignored. The units are fixed:
rad/s, Pa, s and C. The step of strain (``gamma``) or ``stress`` is one of the parameters.
"""

import re
from pathlib import PurePath

import numpy as np

from viscotack.errors import InputError

from .file import LabFile, entries
from .headings import MATERIAL, bare, recognise
from .numbers import doubtful_temperature, is_number, number
from .tables import Table, tabulated

_PARAMETERS = re.compile(r"\s*([\w()\[\],]+\s*=[^;=]*;\s*)+([\w()\[\],]+\s*=[^;=]*)?;?\s*")
_ONE = re.compile(r"\s*\w+\s*=[^;=\s]*\s*;?\s*")
_SWEEP = (("w", "rad/s"), ("G'", "Pa"), ("G''", "Pa"))
_COLUMNS = {
    ".tts": _SWEEP,
    ".osc": _SWEEP,
    ".gt": (("t", "s"), ("shear stress", "Pa")),
    ".creep": (("t", "s"), ("shear strain", "-")),
    ".ttsf": (("T", "C"), ("aT", "-"), ("bT", "-")),
}
# quantity held constant, its parameter, and its value where that is zero or not stated
_STEPS = {".gt": ("strain", "gamma", 1.0), ".creep": ("stress", "stress", None)}
# files of the same layout without a linear viscoelastic test: other flows, molar masses, scattering
_OTHERS = set(".shear .uext .shearxs .laos .dls .gpc .mwd .dmwd .reac .sans .rouse".split())
_OFF = 5.0  # K largest difference between the temperatures of the file and of its points


def tables(file: LabFile, *_: object) -> list[Table] | None:
    """Return the table of a file; None if neither extension nor first line matches.

    Raises
    ------
    ValueError
        If the first line has no parameters, a row has too few numbers, or headings, units or
        temperatures contradict those of the format.
    """
    ends = PurePath(file.path).suffix.casefold()
    first = file.lines[0] if file.lines else ""
    alone = ends in _COLUMNS and _ONE.fullmatch(first)
    if not (ends in _OTHERS or _PARAMETERS.fullmatch(first) or alone):
        return None
    if ends in _OTHERS:
        raise file.error(f"a {ends} file of RepTate contains no linear viscoelastic test")
    parameters = entries(first.split(";"))
    rows = [
        (line, text.split())
        for line, text in enumerate(file.lines[1:], start=2)
        if text.strip() and not text.lstrip().startswith("#")
    ]
    above: list[list[str]] = []
    while rows and not is_number(rows[0][1][0]) and len(above) < 2:
        above.append(rows.pop(0)[1])
    if rows and not is_number(rows[0][1][0]):
        raise file.error("expected a row of headings and a row of units, then numbers", rows[0][0])
    headings, units = [*above, [], []][:2]
    quantities = list(map(_quantity, headings))
    columns = _COLUMNS.get(ends) or next(
        (c for c in _COLUMNS.values() if [_quantity(x) for x, _ in c] == quantities[: len(c)]), None
    )
    if columns is None:
        raise file.error("end its name with .tts, .osc, .gt, .creep or .ttsf, as RepTate does", 1)
    count, whole = len(columns), len(headings) or len(columns)
    for i, (expected, unit) in enumerate(columns[: len(headings)]):
        given, wanted = quantities[i], _quantity(expected)
        # other words ("sxy", "gamma") are not checked; a modulus is a stress at unit strain
        if given not in (None, wanted) and (given, wanted) != ("modulus", "stress"):
            raise file.error(f"column {i + 1} has the heading {headings[i]!r}; expected {expected}")
        stated = bare(units[i]).lstrip("°ºo\ufffd") if i < len(units) else unit
        if stated not in (unit, "-") and (unit, stated) not in (("rad/s", "1/s"), ("rad/s", "s-1")):
            raise file.error(f"column {i + 1} has the unit {units[i]!r}; expected {unit!r}")
    if ends == ".creep" and _number(file, parameters, "rec"):
        raise file.error("rec=1: recovery after creep, not a creep compliance", 1)
    kelvin = None
    if "T" in parameters:
        kelvin = _number(file, parameters, "T") + 273.15
        if kelvin <= 0:
            raise file.error(f"expected a temperature in C after 'T=', got {parameters['T']}", 1)
    tested = quantities[count : count + 1] == ["temperature"]
    for line, cells in rows:
        if len(cells) < min(whole, count + 1):
            raise file.error(f"{len(cells)} numbers under {whole} headings; truncated?", line)
        own = cells[count].replace(",", ".") if tested and len(cells) > count else ""
        if kelvin is not None and is_number(own) and abs(float(own) + 273.15 - kelvin) > _OFF:
            stated = f"the file states T={parameters['T']} C"
            raise file.error(f'"{headings[count]}" is {own}, but {stated}', line)
    levels = {}
    if ends in _STEPS:
        quantity, key, default = _STEPS[ends]
        level = _number(file, parameters, key) or default
        if level is None or level < 0:
            raise file.error(f"the first line must state the step of the test: '{key}=100;'", 1)
        levels[quantity] = level
    words = ", ".join(f"{name} [{unit}]" for name, unit in columns)
    notes = (f"used the first {count} columns, in the units of the format: {words}",)
    if kelvin is not None:
        notes += tuple(doubtful_temperature(np.array([kelvin]), False))
    names, fixed = zip(*columns, strict=True)
    used = [(line, cells[:count]) for line, cells in rows]
    stated = {"temperature": kelvin, "notes": notes, "levels": levels}
    return [tabulated(file, MATERIAL, names, fixed, used, **stated)]


def _quantity(heading: str) -> str | None:
    found = recognise(heading)
    return found and found.quantity.replace("angular_frequency", "frequency")


def _number(file: LabFile, parameters: dict[str, str], key: str) -> float:
    """Return a parameter of the first line, 0 if it is not stated."""
    text = parameters.get(key, "0")
    try:
        value = number(text, ".")
    except InputError:
        value = np.nan
    if np.isnan(value):
        raise file.error(f"expected a number after '{key}=', got {text!r}", 1)
    return value
