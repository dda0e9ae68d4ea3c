"""Layout of RepTate's text files: parameters in the first line, then columns.

``.tts`` and ``.osc`` hold omega, G' and G'', ``.gt`` holds t and G(t), ``.ttsf`` holds T, aT and
bT. Where a file has no headings or no units the format fixes them: rad/s, Pa, s and C.
"""

import re

from .lab_file import LabFile
from .quantities import recognise
from .table import Table, tabulated

_PARAMETERS = re.compile(r"\s*(\w+\s*=[^;=]*;\s*)+(\w+\s*=[^;=]*)?;?\s*")
_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_UNITS = {
    "angular_frequency": "rad/s",
    "frequency": "rad/s",
    "storage": "Pa",
    "loss": "Pa",
    "temperature": "C",
    "time": "s",
    "modulus": "Pa",
    "log10_shift": "-",
    "shift": "-",
    "vertical_shift": "-",
}
_COLUMNS = {
    ".gt": ("t", "G(t)"),
    ".ttsf": ("T", "aT", "bT"),
}


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if the first line has no parameters."""
    return "reptate" if file.lines and _PARAMETERS.fullmatch(file.lines[0]) else None


def tables(file: LabFile) -> list[Table]:
    """Return the one table of a file.

    Raises
    ------
    ValueError
        If the first line has no parameters, or a row does not have enough numbers.
    """
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
    while numbered and _NUMBER.fullmatch(numbered[0][1][0]) is None:
        above.append(numbered.pop(0)[1])
    if len(above) > 2:
        raise file.error("expected a row of headings and a row of units, then numbers", 4)
    headings = above[0] if above else _named(file, numbered)
    units = [
        _UNITS.get(heading.quantity, "") if heading else "" for heading in map(recognise, headings)
    ]
    notes = ("units fixed by the format: rad/s, Pa, s, C",)
    if len(above) == 2:
        notes = ()
        units = [own or fixed for own, fixed in zip(above[1], units, strict=False)]
    return [
        tabulated(
            file,
            headings,
            units,
            numbered,
            temperature=_kelvin(file, parameters.get("T")),
            notes=notes,
        )
    ]


def _named(file: LabFile, rows: list[tuple[int, list[str]]]) -> list[str]:
    suffix = next((end for end in _COLUMNS if file.path.lower().endswith(end)), "")
    names = [*_COLUMNS.get(suffix, ("w", "G'", "G''"))]
    width = len(rows[0][1]) if rows else 0
    return names + [f"column {i + 1}" for i in range(len(names), width)]


def _kelvin(file: LabFile, text: str | None) -> float | None:
    if text is None:
        return None
    if _NUMBER.fullmatch(text) is None or float(text) <= -273.15:
        raise file.error(f"expected a temperature in C after 'T=', got {text!r}", 1)
    return float(text) + 273.15
