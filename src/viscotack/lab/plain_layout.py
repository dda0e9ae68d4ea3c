"""Layout of plain tables: headings, units beside or below them, rows of cells.

Cells are separated by commas, semicolons, tabs or spaces. The two-row tables of pyvisco
(``f, E_stor, E_loss, T, Set`` above ``Hz, MPa, MPa, C, -``) have this layout.
"""

import csv
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from viscotack.errors import InputError

from .lab_file import LabFile
from .numbers import is_number
from .quantities import is_unit, recognise
from .tables import (
    Row,
    Table,
    by_columns,
    heads,
    holds,
    numbered,
    numeric,
    stated_temperature,
    tabulated,
    under,
)

_LOOKED = 200  # lines searched for the headings
_FEWEST, _MOST_ROWS = 3, 50  # numbers in a row of a table on its side, and its rows
_SEPARATORS = ("\t", ";", ",", None)
_PYVISCO = {"E_stor", "E_loss", "G_stor", "G_loss", "E_relax", "G_relax", "log_aT"}


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if no line looks like headings."""
    found = _headings(file)
    if found is None:
        return None
    return "pyvisco" if _PYVISCO & {heading.strip() for heading in found[2]} else "csv"


def tables(file: LabFile, names: Sequence[str] = ()) -> list[Table]:
    """Return the table of a file, or one table for each line that repeats the headings.

    `names` are the headings or numbers of columns given by the caller.

    Raises
    ------
    ValueError
        If no line looks like headings, or a row has not one cell per heading.
    """
    at = _headings(file, names) or by_number(file, names) or _headings(file)
    if at is None:
        raise _no_headings(file)
    line, separator, headings = at
    words = " ".join(text for text in file.lines[: max(line - 1, 0)] if _speaks_of_geometry(text))
    stated = stated_temperature([text] for text in file.lines[: max(line - 1, 0)])
    found = []
    for lines in repeats(file, line):
        units, rows = below(file, lines, separator)
        found.append(tabulated(file, headings, units, rows, words=words, temperature=stated))
    return found


def _no_headings(file: LabFile) -> InputError:
    """Describe a file in which no line looks like headings."""
    first = next((line.strip() for line in file.lines if line.strip()), "")
    only = recognise(first.lstrip("#% "))
    if only is not None:
        return file.error(f"{first!r} is the only column; a test needs two or more in one file")
    found = first_line(file, _LOOKED, numeric, recognise, sure=True)
    line, _, row = found or (0, None, [])
    choose = file.command(by_columns(numbered(row)))
    if line == 1 and len(row) > 1:
        return file.error(
            f"the file begins with numbers without headings; choose from {len(row)} columns by "
            f"number, {choose}"
        )
    if line == 1:
        return file.error("the file has one column alone; a test needs two or more in one file")
    beside = f"; {len(row)} columns of numbers begin at line {line}: {choose}"
    return file.error(
        f"none of the first {_LOOKED} lines looks like headings; expected names such as "
        "\"f, E', E'', T\" with units beside or below them; the file begins "
        f"{first[:60]!r}{beside * (len(row) > 1)}"
    )


def cells(file: LabFile, text: str, number: int, separator: str | None) -> list[str]:
    """Split a line into cells; quoted cells may contain the separator."""
    if separator is None:
        return text.split() or [""]
    if separator == "\t" or '"' not in text:
        return text.split(separator)
    try:
        row = next(csv.reader([text], delimiter=separator, strict=True, skipinitialspace=True))
        return row or [""]
    except (csv.Error, StopIteration):
        raise file.error("a quotation mark is not closed; add the closing one", number) from None


def first_line(
    file: LabFile,
    looked: int,
    heads: Callable[[list[str]], bool],
    known: Callable[[str], Any],
    sure: bool = False,
) -> tuple[int, str | None, list[str]] | None:
    """Return line number, separator and cells of the first line of headings.

    Parameters
    ----------
    file : LabFile
        Content of the file.
    looked : int
        Number of lines to search.
    heads : callable
        Predicate: whether cells are headings.
    known : callable
        Meaning of a cell, or None. In a line split at spaces, most cells must have a meaning;
        otherwise it is a sentence.
    sure : bool
        Whether `heads` is sufficient without this check.
    """
    for count, text in enumerate(file.lines[:looked], start=1):
        for separator in separators(text):
            try:
                row = cells(file, text.lstrip("#% "), count, separator)
            except ValueError:
                continue
            if not heads(row):
                continue
            if separator or sure or 2 * sum(known(cell) is not None for cell in row) > len(row):
                return count, separator, row
    return None


def upright(
    file: LabFile, heads: Callable[[list[str]], bool], known: Callable[[str], Any]
) -> LabFile:
    """Return a file with columns in place of rows, if its headings stand one below the other."""
    if file.is_workbook or first_line(file, _LOOKED, heads, known) is not None:
        return file
    for separator in filter(None, _SEPARATORS):
        split = [(i, text.split(separator)) for i, text in enumerate(file.lines)]
        rows = [(i, row) for i, row in split if sum(map(is_number, row)) >= _FEWEST]
        if not 1 < len(rows) <= _MOST_ROWS or len({len(row) for _, row in rows}) > 1:
            continue
        columns = [list(column) for column in zip(*(row for _, row in rows), strict=True)]
        if heads(columns[0]):
            above = file.lines[: rows[0][0]]
            lines = (*above, *(separator.join(column) for column in columns))
            notes = (*file.notes, "rows and columns of the table exchanged")
            return replace(file, lines=lines, notes=notes)
    return file


def repeats(file: LabFile, line: int) -> list[range]:
    """Return the ranges of lines (from 0) below each repetition of the headings."""
    # an instrument repeats the headings above each of its intervals
    if not line:
        return [range(len(file.lines))]
    same = file.lines[line - 1].strip()
    starts = [i for i, text in enumerate(file.lines, start=1) if text.strip() == same]
    ends = [*(start - 1 for start in starts[1:]), len(file.lines)]
    return [range(start, end) for start, end in zip(starts, ends, strict=True)]


def below(
    file: LabFile, lines: range, separator: str | None
) -> tuple[Sequence[str] | None, list[Row]]:
    """Return the units, if a row contains them, and the numbered rows (from 0).

    A comment of units below headings in a comment is a row of units.
    """
    commented = lines.start > 0 and is_comment(file.lines[lines.start - 1])
    rows: list[Row] = []
    for i in lines:
        text = file.lines[i]
        if text.strip() and not is_comment(text):
            rows.append((i + 1, cells(file, text, i + 1, separator)))
        elif commented and not rows:
            row = cells(file, text.strip().lstrip("#% "), i + 1, separator)
            if any(is_unit(cell) for cell in row if cell.strip()):
                rows.append((i + 1, row))
    if lines.stop < len(file.lines):
        # text above the next headings: "Result: ...", "Interval: 2"
        while rows and rows[-1][1][0].rstrip().endswith(":"):
            rows.pop()
    return under(rows)


def _headings(file: LabFile, names: Sequence[str] = ()) -> tuple[int, str | None, list[str]] | None:
    return first_line(file, _LOOKED, lambda row: heads(row, names), recognise, bool(names))


def by_number(file: LabFile, names: Sequence[str]) -> tuple[int, str | None, list[str]] | None:
    """Return the line above the first row of numbers, for columns chosen by number."""
    found = first_line(file, _LOOKED, lambda row: holds(row, names), recognise, sure=True)
    return None if found is None else (found[0] - 1, found[1], numbered(found[2]))


def _speaks_of_geometry(text: str) -> bool:
    return any(word in text.casefold() for word in ("geometry", "geometrie", "géométrie"))


def separators(text: str) -> list[str | None]:
    """Return the possible separators of a line; None for spaces."""
    marks: list[str | None] = [m for m in _SEPARATORS if m is not None and m in text]
    # a line with tabs has no other cells between blanks
    return marks if "\t" in text.strip() else [*marks, None]


def is_comment(text: str) -> bool:
    """Return whether a line is a comment."""
    return text.lstrip().startswith(("#", "%"))
