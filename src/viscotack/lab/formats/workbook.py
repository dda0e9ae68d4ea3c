"""Layout of workbooks: Netzsch Gabo Eplexor, Zwick testXpert, and similar sheets.

A row of headings, a row of units, then rows of numbers. Old workbooks (.xls) need xlrd, new ones
(.xlsx) need openpyxl; both are installed by the extra ``lab``.
"""

import io
from collections.abc import Iterator, Sequence
from dataclasses import replace
from importlib import import_module
from itertools import zip_longest
from typing import Any

from viscotack.errors import InputError, install_command
from viscotack.files.archive import check_unpacked

from .file import LARGEST_UNPACKED, LabFile
from .headings import MATERIAL, Vocabulary
from .tables import Table
from .text import begins_interval, geometry, headed, in_rows, intervals, on_its_side

_SHEET = "Exported Data"
_LOOKED = 50  # rows in which the headings are looked for
# Largest sheet; one stray cell in the last row would otherwise make a million empty rows.
MOST_ROWS, MOST_COLUMNS, MOST_CELLS = 200_000, 500, 5_000_000
Cells = list[list[str]]


def tables(file: LabFile, words: Vocabulary, names: Sequence[str] = ()) -> list[Table] | None:
    """Return the tables of all sheets, first that of ``Exported Data``; None for other files.

    `names` are the headings or numbers of columns given by the caller.

    Raises
    ------
    ValueError
        If the workbook cannot be read, or no sheet has headings.
    ImportError
        If the library for workbooks is not installed.
    """
    if not file.is_workbook:
        return None
    found = sheets(file)
    # a sheet of details states the geometry
    details = geometry([row for rows in found.values() for row in rows[:_LOOKED]])
    tables = []
    for title in sorted(found, key=lambda title: title != _SHEET):
        parts = _of_sheet(file, words, found[title], names)
        tables += [replace(each, sheet=title, words=each.words or details) for each in parts]
    if not tables:
        raise file.error(
            f"no sheet has headings such as {words.usual} in its first {_LOOKED} rows; the sheets "
            f"are {', '.join(map(repr, found))}; choose columns by their number, such as "
            f"{words.columns}"
        )
    return tables


def _of_sheet(file: LabFile, words: Vocabulary, rows: Cells, names: Sequence[str]) -> list[Table]:
    found = headed([(i, "", row) for i, row in enumerate(rows[:_LOOKED], start=1)], words, names)
    if found is None:
        return on_its_side(file, words, rows) or []
    at, _, headings = found
    numbered, above = list(enumerate(rows, start=1)), rows[: max(at - 1, 0)]
    if above and words is MATERIAL and begins_interval(above[-1]):
        return intervals(file, numbered)
    return in_rows(file, words, headings, numbered[at:], above, above[-1] if above else ())


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
        command = install_command("lab")
        raise ImportError(f"workbooks need {error.name}; install it with: {command}") from None
    except MemoryError:
        raise
    except Exception as error:
        # The library raises many undocumented errors for damaged workbooks.
        raise file.error(f"the workbook may be truncated or damaged: {error}") from None


def _old(content: bytes) -> Iterator[tuple[str, Cells]]:
    xlrd = import_module("xlrd")
    book = xlrd.open_workbook(file_contents=content, logfile=io.StringIO())
    for sheet in book.sheets():
        _check_size(sheet.nrows, sheet.ncols)
        yield sheet.name, [[_text(v) for v in sheet.row_values(r)] for r in range(sheet.nrows)]


def _new(content: bytes) -> Iterator[tuple[str, Cells]]:
    openpyxl = import_module("openpyxl")
    check_unpacked(io.BytesIO(content), LARGEST_UNPACKED)
    # Programs that write workbooks without computing them omit the values of formulas; an empty
    # cell would otherwise be interpreted as a missing point.
    values, formulas = (
        openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=only)
        for only in (True, False)
    )
    for sheet in values.worksheets:
        pairs = zip_longest(_rows(sheet), _rows(formulas[sheet.title]), fillvalue=())
        rows = [
            [_text(formula if v is None else v) for v, formula in zip(*pair, strict=False)]
            for pair in pairs
        ]
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
            f"a sheet exceeds {MOST_ROWS:,} rows or {MOST_COLUMNS} columns; export CSV"
        )


def _text(value: Any) -> str:
    """Return a cell as text that reads back as the same number."""
    if value is None:
        return ""
    return repr(float(value)) if isinstance(value, int | float) else str(value)
