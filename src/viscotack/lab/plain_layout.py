"""Layout of plain tables: headings, units beside or below them, rows of cells.

Cells are separated by commas, semicolons, tabs or spaces. The two-row tables of pyvisco
(``f, E_stor, E_loss, T, Set`` above ``Hz, MPa, MPa, C, -``) have this layout.
"""

import csv
import re
from collections.abc import Callable
from typing import Any

from .columns import Table, first_headings, stated_temperature, tabulated
from .lab_file import LabFile
from .quantities import recognise

_LOOKED = 200  # lines searched for the headings
_SEPARATORS = ("\t", ";", ",", None)
_PYVISCO = {"E_stor", "E_loss", "G_stor", "G_loss", "E_relax", "G_relax", "log_aT"}


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if no line looks like headings."""
    found = _headings(file)
    if found is None:
        return None
    return "pyvisco" if _PYVISCO & {heading.strip() for heading in found[2]} else "csv"


def tables(file: LabFile) -> list[Table]:
    """Return the table of a file, or one table for each line that repeats the headings.

    Raises
    ------
    ValueError
        If no line looks like headings, or a row has not one cell per heading.
    """
    at = _headings(file)
    if at is None:
        first = next((line.strip() for line in file.lines if line.strip()), "")
        only = recognise(first.lstrip("#% "))
        if only is not None:
            raise file.error(f"{first!r} is the only column; a test needs two or more in one file")
        row = [cell for cell in cells(file, first, 1, separators(first)[0]) if cell.strip()]
        if row and all(map(is_number, row)):
            raise file.error(
                "the file begins with numbers without headings; write headings with "
                "units above them, such as 'time [s], J [1/Pa]' or \"f [Hz], G' [Pa], G'' [Pa]\""
            )
        raise file.error(
            f"none of the first {_LOOKED} lines looks like headings; expected names such as "
            "\"f, E', E'', T\" with units beside or below them; the file begins "
            f"{first[:60]!r}"
        )
    line, separator, headings = at
    words = " ".join(text for text in file.lines[: line - 1] if _speaks_of_geometry(text))
    preamble = [re.split(r"[\t;,]", text) for text in file.lines[: line - 1]]
    stated = stated_temperature(preamble)
    found = []
    for lines in repeats(file, line):
        units, rows = below(file, lines, separator)
        found.append(tabulated(file, headings, units, rows, words=words, temperature=stated))
    return found


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


def repeats(file: LabFile, line: int) -> list[range]:
    """Return the ranges of lines (from 0) below each repetition of the headings."""
    # an instrument repeats the headings above each of its intervals
    same = file.lines[line - 1].strip()
    starts = [i for i, text in enumerate(file.lines, start=1) if text.strip() == same]
    ends = [*(start - 1 for start in starts[1:]), len(file.lines)]
    return [range(start, end) for start, end in zip(starts, ends, strict=True)]


def below(
    file: LabFile, lines: range, separator: str | None
) -> tuple[list[str] | None, list[tuple[int, list[str]]]]:
    """Return the units, if a row contains them, and the numbered rows (from 0)."""
    rows = [
        (i + 1, cells(file, file.lines[i], i + 1, separator))
        for i in lines
        if file.lines[i].strip() and not is_comment(file.lines[i])
    ]
    if lines.stop < len(file.lines):
        # text above the next headings: "Result: ...", "Interval: 2"
        while rows and rows[-1][1][0].rstrip().endswith(":"):
            rows.pop()
    units = None
    while rows and units is None and not any(map(is_number, rows[0][1])):
        above = rows.pop(0)[1]
        units = above if any(cell.strip() for cell in above) else None
    return units, rows


def _headings(file: LabFile) -> tuple[int, str | None, list[str]] | None:
    return first_line(file, _LOOKED, lambda row: first_headings([row]) is not None, recognise)


def _speaks_of_geometry(text: str) -> bool:
    return any(word in text.casefold() for word in ("geometry", "geometrie", "géométrie"))


def separators(text: str) -> list[str | None]:
    """Return the possible separators of a line; None for spaces."""
    return [mark for mark in _SEPARATORS if mark is None or mark in text]


def is_comment(text: str) -> bool:
    """Return whether a line is a comment."""
    return text.lstrip().startswith(("#", "%"))


def is_number(cell: str) -> bool:
    """Return whether a cell looks like a number."""
    try:
        float(cell.strip().replace(",", "."))
    except ValueError:
        return False
    return True
