"""Rows as an XLSX workbook with units in the headings, and the numbers of a drawn curve."""

import io
import re
from collections.abc import Callable, Mapping, Sequence
from statistics import median
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack.app.operations.parts.record_words import quantity_of, spelled
from viscotack.errors import InputError, install_command
from viscotack.units import prefixed

if TYPE_CHECKING:
    from viscotack.files.whole import Target

Rows = Sequence[Mapping[str, Any]]
_WIDEST = 60  # characters of a column
# Control characters are not allowed in the XML of a workbook.
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f]")


def as_workbook(sheets: Mapping[str, Rows]) -> Callable[["Target"], None]:
    """Return a function that writes a workbook with a sheet for each table that has rows.

    Numbers are in SI; a column whose name ends with a unit is divided by the prefix of its median,
    together with its uncertainty, mean and deviation.
    """

    def write(target: "Target") -> None:
        write_workbook({title: headed(rows) for title, rows in sheets.items() if rows}, target)

    return write


def write_workbook(sheets: Mapping[str, Mapping[str, Sequence[Any]]], target: "Target") -> None:
    """Write a workbook, whole or not at all, with a sheet for each table of columns."""
    from viscotack.files.whole import write_whole

    write_whole(target, _content(sheets))


def _content(sheets: Mapping[str, Mapping[str, Sequence[Any]]]) -> bytes:
    try:
        from openpyxl import Workbook
        from openpyxl.styles import Font
    except ImportError as error:
        raise InputError(
            f"a workbook needs openpyxl; install it with: {install_command('lab')}, or write "
            "a CSV table"
        ) from error
    book = Workbook()
    del book["Sheet"]
    for title, columns in sheets.items():
        sheet = book.create_sheet(title)
        sheet.freeze_panes = "A2"
        for number, (heading, values) in enumerate(columns.items(), start=1):
            for line, value in enumerate((heading, *values), start=1):
                cell = sheet.cell(line, number)
                text = isinstance(value, str)
                cell.value = _CONTROL.sub("?", value) if text else value
                if text:
                    # text that begins with = is no formula
                    cell.data_type = "s"
            head = sheet.cell(1, number)
            head.font = Font(bold=True)
            longest = max(len(x) for x in (heading, *values) if isinstance(x, str))
            sheet.column_dimensions[head.column_letter].width = min(longest + 2, _WIDEST)
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def headed(rows: Rows) -> dict[str, list[Any]]:
    """Return the columns of a table by headings with units, numbers divided by their prefixes."""
    columns = {name: [row[name] for row in rows] for name in rows[0]}
    found = {}
    for name, values in columns.items():
        quantity, unit, more = quantity_of(name)
        if unit == "1":
            found[spelled(name)] = values
            continue
        factor, written = prefixed(_size(columns, name.removesuffix(f"_{more}")), unit)
        scaled = [None if value is None else value / factor for value in values]
        found[f"{spelled(f'{quantity} {more}')} [{written}]"] = scaled
    return found


def _size(columns: Mapping[str, list[Any]], quantity: str) -> float:
    """Return the median size of the first column of a quantity, rounded; 0 without a number."""
    values = next(values for name, values in columns.items() if name.startswith(quantity))
    sizes = [abs(value) for value in values if value]
    # 999.9997 nm/s is written as 1 um/s
    return float(f"{median(sizes):.3g}") if sizes else 0.0


# What a curve is drawn from needs no more digits, and every one of them is sent.
_DRAWN = 7


def drawn(values: Any) -> list[float | None]:
    """Return the numbers of a curve with the digits that a picture needs."""
    return [
        float(f"{x:.{_DRAWN}g}") if np.isfinite(x) else None
        for x in np.asarray(values, dtype=float).tolist()
    ]
