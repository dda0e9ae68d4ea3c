"""Layout of plain tables: headings, units beside or below them, rows.

Separated by commas, semicolons, tabs or spaces. The two-row tables of pyvisco (``f, E_stor,
E_loss, T, Set`` above ``Hz, MPa, MPa, C, -``) are of this kind.
"""

import csv

from .lab_file import LabFile
from .table import Table, first_headings, tabulated

_LOOKED = 200  # lines in which the headings are looked for
_SEPARATORS = ("\t", ";", ",", None)
_PYVISCO = {"E_stor", "E_loss", "G_stor", "G_loss", "E_relax", "G_relax", "log_aT"}


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if no line looks like headings."""
    found = _headings(file)
    if found is None:
        return None
    return "pyvisco" if _PYVISCO & {heading.strip() for heading in found[2]} else "csv"


def tables(file: LabFile) -> list[Table]:
    """Return the one table of a file.

    Raises
    ------
    ValueError
        If no line looks like headings, or a row does not have a cell for each of them.
    """
    found = _headings(file)
    if found is None:
        first = next((line.strip() for line in file.lines if line.strip()), "")
        raise file.error(
            f"none of the first {_LOOKED} lines looks like headings; expected names such as "
            "\"f, E', E'', T\" with units beside or below them; the file begins "
            f"{first[:60]!r}"
        )
    line, separator, headings = found
    numbered = [
        (number, cells(file, text, number, separator))
        for number, text in enumerate(file.lines[line:], start=line + 1)
        if text.strip() and not _is_comment(text)
    ]
    units = None
    if numbered and not any(_is_number(cell) for cell in numbered[0][1]):
        units = numbered.pop(0)[1]
    return [tabulated(file, headings, units, numbered)]


def cells(file: LabFile, text: str, number: int, separator: str | None) -> list[str]:
    """Return the cells of one line; quoted cells may hold the separator."""
    if separator is None:
        return text.split() or [""]
    if separator == "\t":
        return text.split("\t")
    try:
        row = next(csv.reader([text], delimiter=separator, strict=True, skipinitialspace=True))
        return row or [""]
    except (csv.Error, StopIteration):
        raise file.error("a quotation mark is not closed", number) from None


def _headings(file: LabFile) -> tuple[int, str | None, list[str]] | None:
    """Return the line number, the separator and the cells of the first line of headings."""
    for number, text in enumerate(file.lines[:_LOOKED], start=1):
        for separator in _SEPARATORS:
            if separator is not None and separator not in text:
                continue
            try:
                row = cells(file, text.lstrip("#% "), number, separator)
            except ValueError:
                continue
            if first_headings([row]) is not None:
                return number, separator, row
    return None


def _is_comment(text: str) -> bool:
    return text.lstrip().startswith(("#", "%"))


def _is_number(cell: str) -> bool:
    try:
        float(cell.strip().replace(",", "."))
    except ValueError:
        return False
    return True
