"""Layout of workbooks: Netzsch Gabo Eplexor's ``Exported Data``, or a similar first sheet.

A row of headings, a row of units, then rows of numbers. Old workbooks (.xls) need xlrd, new ones
(.xlsx) need openpyxl; both are installed by the extra ``lab``.
"""

import io
import zipfile
from collections.abc import Iterable, Iterator
from importlib import import_module
from typing import Any

from viscotack.errors import InputError

from .columns import Table, first_headings, stated_temperature, tabulated
from .lab_file import LabFile, huge
from .plain_layout import is_number
from .workbook_bounds import check_size, has_formulas

_SHEET = "Exported Data"
_LOOKED = 50  # rows in which the headings are looked for
Cells = list[list[str]]


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if the file is not a workbook."""
    if not file.is_workbook:
        return None
    # old workbooks store sheet names as plain bytes, new ones compressed
    return "eplexor" if _SHEET.encode() in file.content else "workbook"


def tables(file: LabFile) -> list[Table]:
    """Return the table of the sheet ``Exported Data``, or of the first sheet with a table.

    Raises
    ------
    ValueError
        If the workbook cannot be read, or no sheet has headings and units.
    ImportError
        If the library for workbooks is not installed.
    """
    found = sheets(file)
    for title in sorted(found, key=lambda title: title != _SHEET):
        rows = found[title]
        at = first_headings(rows[:_LOOKED])
        if at is not None:
            units, data = under(rows, at)
            words = " ".join(" ".join(row) for row in rows[:at] if "geometry" in row[0].casefold())
            stated = stated_temperature(rows[:at])
            return [tabulated(file, rows[at], units, data, words=words, temperature=stated)]
    raise file.error(
        f"no sheet has headings such as \"f, T, E', E''\" in its first {_LOOKED} rows; "
        f"the sheets are {', '.join(map(repr, found))}"
    )


def under(rows: Cells, at: int) -> tuple[list[str] | None, list[tuple[int, list[str]]]]:
    """Return the units below a row of headings, if there are any, and the numbered rows."""
    data = [(number, row) for number, row in enumerate(rows[at + 1 :], start=at + 2) if any(row)]
    # a row with a number is a data point; the headings then contain the units
    has_units = data and not any(map(is_number, data[0][1]))
    return data.pop(0)[1] if has_units else None, data


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
            f"workbooks need {error.name}, which is not installed: pip install viscotack[lab]"
        ) from None
    except Exception as error:
        # The library raises many undocumented errors for damaged workbooks.
        raise file.error(
            f"the workbook cannot be read; it may be truncated or damaged: {error}"
        ) from None


def _old(content: bytes) -> Iterator[tuple[str, Cells]]:
    xlrd = import_module("xlrd")
    book = xlrd.open_workbook(file_contents=content, logfile=io.StringIO())
    for sheet in book.sheets():
        check_size(sheet.nrows, sheet.ncols)
        yield sheet.name, [[_text(v) for v in sheet.row_values(r)] for r in range(sheet.nrows)]


def _new(content: bytes) -> Iterator[tuple[str, Cells]]:
    openpyxl = import_module("openpyxl")
    with zipfile.ZipFile(io.BytesIO(content)) as parts:
        if huge(parts):
            raise InputError("it unpacks to more than 200 MB")
        formulas = has_formulas(parts)
    book = openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)
    # read again to find formulas without values
    beside = openpyxl.load_workbook(io.BytesIO(content), read_only=True) if formulas else None
    for sheet in book.worksheets:
        rows = [[_text(v) for v in row] for row in sheet.iter_rows(values_only=True)]
        if beside is not None:
            _name_formulas(rows, beside[sheet.title].iter_rows(values_only=True))
        width = max(map(len, rows), default=0)
        yield sheet.title, [row + [""] * (width - len(row)) for row in rows]


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
