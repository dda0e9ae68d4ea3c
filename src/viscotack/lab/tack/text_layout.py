"""Layout of text exports: any lines, one of headings, units beside or below them, rows.

So write Anton Paar rheometers (one file per interval), Instron Bluehill (a block of parameters
above quoted columns), Zwick testXpert, Stable Micro Systems texture analysers (forces in grams)
and nanoindenters (tabs, micronewtons in Latin-1).
"""

from collections.abc import Sequence

from viscotack.lab.lab_file import LabFile
from viscotack.lab.plain_layout import cells, is_comment, is_number, separators

from .grid import Grid, grid, heads_columns
from .headings import recognise

_LOOKED = 300  # lines in which the headings are looked for


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if no line looks like headings."""
    return None if _headings(file) is None else "text"


def grids(file: LabFile, names: Sequence[str] = ()) -> list[Grid]:
    """Return the table of a file, or one for each line that repeats the headings.

    `names` are headings that the caller names, by which their line is found.

    Raises
    ------
    ValueError
        If no line looks like headings, or a row does not have a cell for each of them.
    """
    found = _headings(file, names)
    if found is None:
        first = next((line.strip() for line in file.lines if line.strip()), "")
        raise file.error(
            f"none of the first {_LOOKED} lines names the columns of a tack test, such as "
            f'"Time [s], Gap [mm], Normal Force [N]"; the file begins {first[:60]!r}'
        )
    line, separator, headings = found
    same = file.lines[line - 1].strip()
    starts = [i for i, text in enumerate(file.lines, start=1) if text.strip() == same]
    ends = [*(start - 1 for start in starts[1:]), len(file.lines)]
    return [
        _below(file, headings, separator, range(start, end), f"table {count}")
        for count, (start, end) in enumerate(zip(starts, ends, strict=True), start=1)
    ]


def _below(
    file: LabFile, headings: list[str], separator: str | None, lines: range, label: str
) -> Grid:
    """Return the table below one line of headings; `lines` counts from 0."""
    rows = [
        (i + 1, cells(file, file.lines[i], i + 1, separator))
        for i in lines
        if file.lines[i].strip() and not is_comment(file.lines[i])
    ]
    units = None
    while rows and not any(map(is_number, rows[0][1])):
        units = rows.pop(0)[1]
        if any(cell.strip() for cell in units):
            break
    return grid(file, headings, units, rows, label)


def _headings(file: LabFile, names: Sequence[str] = ()) -> tuple[int, str | None, list[str]] | None:
    """Return the line number, the separator and the cells of the first line of headings."""
    for count, text in enumerate(file.lines[:_LOOKED], start=1):
        for separator in separators(text):
            try:
                row = cells(file, text.lstrip("#% "), count, separator)
            except ValueError:
                continue
            if heads_columns(row, names) and (separator or names or _mostly_headings(row)):
                return count, separator, row
    return None


def _mostly_headings(row: list[str]) -> bool:
    """Return whether words with spaces between them are headings and no sentence."""
    return 2 * sum(recognise(cell) is not None for cell in row) > len(row)
