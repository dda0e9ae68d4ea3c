"""Layout of RepTate's text files: parameters in the first line, then columns.

The file extension defines the first columns; further columns are ignored: ``.tts`` and ``.osc``
contain omega, G' and G'', ``.gt`` contains t and the stress after a step of strain ``gamma``,
``.creep`` contains t and the strain under ``stress``, ``.ttsf`` contains T, aT and bT. The units
are fixed: rad/s, Pa, s and C.
"""

import re
from pathlib import PurePath

import numpy as np

from .lab_file import LabFile
from .quantities import bare, recognise
from .tables import Table, tabulated
from .unit_checks import doubtful_temperature

_PARAMETERS = re.compile(r"\s*([\w()\[\],]+\s*=[^;=]*;\s*)+([\w()\[\],]+\s*=[^;=]*)?;?\s*")
_ONE = re.compile(r"\s*\w+\s*=[^;=\s]*\s*;?\s*")
_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_SWEEP = (("w", "rad/s"), ("G'", "Pa"), ("G''", "Pa"))
_COLUMNS = {
    ".tts": _SWEEP,
    ".osc": _SWEEP,
    ".gt": (("t", "s"), ("shear stress", "Pa")),
    ".creep": (("t", "s"), ("shear strain", "-")),
    ".ttsf": (("T", "C"), ("aT", "-"), ("bT", "-")),
}
# files of the same layout without a linear viscoelastic test
_OTHERS = {
    ".shear": "the start-up of shear flow",
    ".uext": "the start-up of extensional flow",
    ".shearxs": "flow-induced crystallisation",
    ".laos": "an oscillation of large amplitude",
    ".dls": "a dielectric spectrum",
    ".gpc": "a distribution of molar mass",
    ".mwd": "a distribution of molar mass",
    ".dmwd": "a distribution of molar mass",
    ".reac": "the molecules of a reaction",
    ".sans": "a scattering experiment",
    ".rouse": "the correlations of a simulated chain",
}
_OFF = 5.0  # K largest difference between the temperatures of the file and of its points


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if neither extension nor first line matches it."""
    ends = _ending(file)
    if ends in _OTHERS:
        return "reptate"
    first = file.lines[0] if file.lines else ""
    alone = ends in _COLUMNS and _ONE.fullmatch(first)
    return "reptate" if _PARAMETERS.fullmatch(first) or alone else None


def tables(file: LabFile) -> list[Table]:
    """Return the table of a file.

    Raises
    ------
    ValueError
        If the first line has no parameters, or a row has too few numbers.
    """
    if what := _OTHERS.get(_ending(file)):
        raise file.error(f"a {_ending(file)} file of RepTate contains {what}, not a modulus")
    if name(file) is None:
        raise file.error("expected parameters such as 'Mw=94.9;T=0;chem=PI;'", 1)
    pairs = (part.partition("=") for part in file.lines[0].split(";"))
    parameters = {key.strip(): value.strip() for key, _, value in pairs}
    numbered = [
        (number, text.split())
        for number, text in enumerate(file.lines[1:], start=2)
        if text.strip() and not text.lstrip().startswith("#")
    ]
    above = []
    while numbered and not _NUMBER.fullmatch(numbered[0][1][0]) and len(above) < 3:
        above.append(numbered.pop(0))
    if len(above) > 2:
        raise file.error("expected a row of headings and a row of units, then numbers", above[2][0])
    return [_table(file, parameters, [cells for _, cells in above], numbered)]


def _table(
    file: LabFile,
    parameters: dict[str, str],
    above: list[list[str]],
    rows: list[tuple[int, list[str]]],
) -> Table:
    fixed = _COLUMNS.get(_ending(file)) or _by_headings(file, above)
    count = len(fixed)
    kelvin = _kelvin(file, parameters.get("T"))
    _check_headings(file, above, fixed)
    if _ending(file) == ".creep" and _number(parameters.get("rec", "0")):
        raise file.error("rec=1: recovery after creep, not a creep compliance", 1)
    whole = len(above[0]) if above else count
    for line, cells in rows:
        if len(cells) < min(whole, count + 1):
            raise file.error(
                f"{len(cells)} numbers under {whole} headings; a number is missing, or "
                "the file is truncated",
                line,
            )
    if above and kelvin is not None:
        _check_temperatures(file, above[0], rows, kelvin, count)
    levels = {}
    notes = [f"used the first {count} columns, in the units of the format: {_words(fixed)}"]
    if _ending(file) == ".gt":
        levels["strain"] = _level(file, parameters, "gamma", 1.0)
    if _ending(file) == ".creep":
        levels["stress"] = _level(file, parameters, "stress", None)
    if kelvin is not None:
        notes += doubtful_temperature(np.array([kelvin]), False)
    names, units = zip(*fixed, strict=True)
    first = [(line, cells[:count]) for line, cells in rows]
    stated = {"temperature": kelvin, "notes": tuple(notes), "levels": levels}
    return tabulated(file, names, units, first, **stated)


def _ending(file: LabFile) -> str:
    return PurePath(file.path).suffix.casefold()


def _words(fixed: tuple[tuple[str, str], ...]) -> str:
    return ", ".join(f"{name} [{unit}]" for name, unit in fixed)


def _by_headings(file: LabFile, above: list[list[str]]) -> tuple[tuple[str, str], ...]:
    """Identify the columns of a file with another extension from its headings."""
    quantities = [_quantity(heading) for heading in above[0]] if above else []
    for fixed in _COLUMNS.values():
        if [_quantity(name) for name, _ in fixed] == quantities[: len(fixed)]:
            return fixed
    raise file.error(
        "the file looks like a RepTate file; name it .tts or .osc (omega, G', G''), .gt (t, G), "
        ".creep (t, strain) or .ttsf (T, aT, bT) to define its columns",
        1,
    )


def _quantity(heading: str) -> str | None:
    found = recognise(heading)
    if found is None:
        return None
    return "angular_frequency" if found.quantity == "frequency" else found.quantity


def _check_headings(
    file: LabFile, above: list[list[str]], fixed: tuple[tuple[str, str], ...]
) -> None:
    """Raise an error if headings or units contradict those of the format."""
    for i, (name, unit) in enumerate(fixed):
        heading = above[0][i] if above and i < len(above[0]) else ""
        given, expected = _quantity(heading), _quantity(name)
        # other words ("sxy", "gamma") are not checked; a modulus is a stress at unit strain
        if given not in (None, expected) and (given, expected) != ("modulus", "stress"):
            raise file.error(f"column {i + 1} has the heading {heading!r}; expected {name!r}")
        below = above[1][i] if len(above) > 1 and i < len(above[1]) else ""
        if below and not _same_unit(below, unit):
            raise file.error(f"column {i + 1} has the unit {below!r}; expected {unit!r}")


def _same_unit(given: str, fixed: str) -> bool:
    given = bare(given)
    if fixed == "C":
        return given.lstrip("°ºo�") == "C"
    return given in (fixed, "-") or (fixed == "rad/s" and given in ("1/s", "s-1"))


def _check_temperatures(
    file: LabFile,
    headings: list[str],
    rows: list[tuple[int, list[str]]],
    kelvin: float,
    count: int,
) -> None:
    """Raise an error if the temperature column contradicts the temperature of the file."""
    if len(headings) <= count or _quantity(headings[count]) != "temperature":
        return
    for line, cells in rows:
        own = _number(cells[count]) if len(cells) > count else None
        if own is not None and abs(own + 273.15 - kelvin) > _OFF:
            raise file.error(
                f'"{headings[count]}" is {own:g} but the file states T={kelvin - 273.15:g} C: a '
                "number is missing, or the file belongs to another test",
                line,
            )


def _level(file: LabFile, parameters: dict[str, str], key: str, default: float | None) -> float:
    """Return the step of a test; RepTate interprets a strain of zero as 1."""
    text = parameters.get(key, "0")
    level = _number(text)
    if level is None or level < 0:
        raise file.error(f"expected a positive number after '{key}=', got {text!r}", 1)
    if level == 0 and default is None:
        raise file.error(f"the first line must state the step of the test, such as '{key}=100;'", 1)
    return level or default or 1.0


def _number(text: str) -> float | None:
    return float(text) if _NUMBER.fullmatch(text) else None


def _kelvin(file: LabFile, text: str | None) -> float | None:
    if text is None:
        return None
    if _NUMBER.fullmatch(text) is None or float(text) <= -273.15:
        raise file.error(f"expected a temperature in C after 'T=', got {text!r}", 1)
    return float(text) + 273.15
