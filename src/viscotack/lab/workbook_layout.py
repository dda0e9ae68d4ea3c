"""Layout of workbooks: Netzsch Gabo Eplexor's ``Exported Data``, or a similar first sheet.

A row of headings, a row of units, then rows of numbers. Old workbooks (.xls) need xlrd, new ones
(.xlsx) need openpyxl; both are installed by the extra ``lab``.
"""

import io
import re
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from importlib import import_module
from typing import Any

from viscotack.errors import InputError, install_command

from .lab_file import LabFile, refuse_huge
from .numbers import is_number
from .rheocompass_layout import begins_interval, intervals
from .tables import (
    Table,
    by_columns,
    first_headings,
    heads,
    holds,
    numbered,
    numeric,
    stated_temperature,
    tabulated,
    under,
)

_SHEET = "Exported Data"
_LOOKED = 50  # rows in which the headings are looked for
# Largest sheet; one stray cell in the last row would otherwise make a million empty rows.
MOST_ROWS, MOST_COLUMNS, MOST_CELLS = 200_000, 500, 5_000_000
_FORMULA = re.compile(rb"<(\w+:)?f[ />]")
Cells = list[list[str]]


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if the file is not a workbook."""
    if not file.is_workbook:
        return None
    # old workbooks store sheet names as plain bytes, new ones compressed
    return "eplexor" if _SHEET.encode() in file.content else "workbook"


def tables(file: LabFile, names: Sequence[str] = ()) -> list[Table]:
    """Return the tables of all sheets, first that of the sheet ``Exported Data``.

    `names` are the headings or numbers of columns given by the caller.

    Raises
    ------
    ValueError
        If the workbook cannot be read, or no sheet has headings.
    ImportError
        If the library for workbooks is not installed.
    """
    found = sheets(file)
    # a sheet of details states the geometry
    top = (row for rows in found.values() for row in rows[:_LOOKED] if row)
    words = " ".join(" ".join(row) for row in top if "geometry" in row[0].casefold())
    tables = []
    for title in sorted(found, key=lambda title: title != _SHEET):
        parts = _of_sheet(file, found[title], names)
        tables += [replace(each, sheet=title, words=each.words or words) for each in parts]
    if not tables:
        raise file.error(
            f"no sheet has headings such as \"f, T, E', E''\" in its first {_LOOKED} rows; the "
            f"sheets are {', '.join(map(repr, found))}{_by_number(file, found)}"
        )
    return tables


def _of_sheet(file: LabFile, rows: Cells, names: Sequence[str]) -> list[Table]:
    numbered_rows = list(enumerate(rows, start=1))
    at = first_headings(rows[:_LOOKED], names)
    if at and begins_interval(rows[at - 1]):
        return intervals(file, numbered_rows)
    if at is None:
        first = next((i for i, row in enumerate(rows[:_LOOKED]) if holds(row, names)), None)
        if first is None:
            return _of_sheet(file, rows, ()) if names else []
        return [tabulated(file, numbered(rows[first]), None, numbered_rows[first:])]
    stated = stated_temperature(rows[:at])
    # further rows of headings begin further tables
    starts = [at, *(i for i in range(at + 1, len(rows)) if _heads_again(rows[i]))]
    found = []
    for start, end in zip(starts, [*starts[1:], len(rows)], strict=True):
        block = numbered_rows[start + 1 : end]
        while end < len(rows) and block and not any(map(is_number, block[-1][1])):
            block.pop()
        units, data = under(block)
        found.append(tabulated(file, rows[start], units, data, temperature=stated))
    return found


def _heads_again(row: Sequence[str]) -> bool:
    return sum(map(bool, row)) > 1 and not any(map(is_number, row)) and heads(row)


def _by_number(file: LabFile, found: dict[str, Cells]) -> str:
    rows = (row for rows in found.values() for row in rows[:_LOOKED] if numeric(row))
    first = next(rows, None)
    if first is None or len(first) < 2:
        return ""
    return f"; choose columns by number, {file.command(by_columns(numbered(first)))}"


def sheets(file: LabFile) -> dict[str, Cells]:
    """Return the rows of every sheet of a workbook, as text.

    Raises
    ------
    ValueError
        If the workbook cannot be read.
    ImportError
        If the library for workbooks is not installed.
    """
    if not file.is_workbook:
        raise file.error("expected an Excel workbook")
    old = file.content.startswith(b"\xd0\xcf")
    try:
        return dict(_old(file.content) if old else _new(file.content))
    except ImportError as error:
        raise ImportError(
            f"workbooks need {error.name}; install it with: {install_command('lab')}"
        ) from None
    except MemoryError:
        raise
    except Exception as error:
        # The library raises many undocumented errors for damaged workbooks.
        raise file.error(
            f"the workbook cannot be read; it may be truncated or damaged: {error}"
        ) from None


def _old(content: bytes) -> Iterator[tuple[str, Cells]]:
    xlrd = import_module("xlrd")
    book = xlrd.open_workbook(file_contents=content, logfile=io.StringIO())
    for sheet in book.sheets():
        _check_size(sheet.nrows, sheet.ncols)
        yield sheet.name, [[_text(v) for v in sheet.row_values(r)] for r in range(sheet.nrows)]


def _new(content: bytes) -> Iterator[tuple[str, Cells]]:
    openpyxl = import_module("openpyxl")
    with zipfile.ZipFile(io.BytesIO(content)) as parts:
        refuse_huge(parts)
        sheets = [name for name in parts.namelist() if name.startswith("xl/worksheets/")]
        formulas = any(_FORMULA.search(parts.read(name)) for name in sheets)
    book = openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)
    # read again to find formulas without values
    beside = openpyxl.load_workbook(io.BytesIO(content), read_only=True) if formulas else None
    for sheet in book.worksheets:
        rows = [[_text(v) for v in row] for row in _rows(sheet)]
        if beside is not None:
            _name_formulas(rows, _rows(beside[sheet.title]))
        width = max(map(len, rows), default=0)
        yield sheet.title, [row + [""] * (width - len(row)) for row in rows]


def _rows(sheet: Any) -> Iterator[tuple[Any, ...]]:
    """Yield the rows of a sheet, whatever size it states, and refuse it where it is too large."""
    sheet.reset_dimensions()
    width = 0
    for count, row in enumerate(sheet.iter_rows(values_only=True), start=1):
        width = max(width, len(row))
        _check_size(count, width)
        yield row


def _check_size(rows: int, columns: int) -> None:
    if rows > MOST_ROWS or columns > MOST_COLUMNS or rows * columns > MOST_CELLS:
        raise InputError(
            f"a sheet has more than {MOST_ROWS:,} rows, {MOST_COLUMNS} columns or {MOST_CELLS:,} "
            "cells; export the relevant part as CSV"
        )


def _name_formulas(rows: Cells, beside: Iterable[tuple[Any, ...]]) -> None:
    """Insert formulas where the workbook contains no value.

    Programs that write workbooks without computing them omit the values; an empty cell would
    otherwise be interpreted as a missing point.
    """
    for row, cells in zip(rows, beside, strict=False):
        for i, formula in enumerate(cells[: len(row)]):
            if not row[i] and isinstance(formula, str) and formula.startswith("="):
                row[i] = formula


def _text(value: Any) -> str:
    """Return a cell as text that reads back as the same number."""
    if value is None:
        return ""
    return repr(float(value)) if isinstance(value, int | float) else str(value)
