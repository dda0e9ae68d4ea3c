"""Tables as a workbook with units in the headings, and the numbers of a drawn curve."""

import io
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack.app.operations.parts.record_words import quantity_of, spelled
from viscotack.errors import InputError, install_command
from viscotack.files.whole import write_whole

if TYPE_CHECKING:
    from viscotack.files.whole import Target

_WIDEST = 60  # characters of a column
# Control characters are not allowed in the XML of a workbook.
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f]")


def write_workbook(sheets: Mapping[str, Mapping[str, Sequence[Any]]], target: "Target") -> None:
    """Write a workbook, whole or not at all, with a sheet for each table of columns."""
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
    write_whole(target, stream.getvalue())


def heading(name: str) -> str:
    """Return the name of a number as words with its unit.

    Examples
    --------
    >>> heading("pull_off_force_N_mean")
    'pull-off force mean [N]'
    """
    quantity, unit, more = quantity_of(name)
    return spelled(name) if unit == "1" else f"{spelled(f'{quantity} {more}')} [{unit}]"


# What a curve is drawn from needs no more digits, and every one of them is sent.
_DRAWN = 7


def drawn(values: Any) -> list[float | None]:
    """Return the numbers of a curve with the digits that a picture needs."""
    return [
        float(f"{x:.{_DRAWN}g}") if np.isfinite(x) else None
        for x in np.asarray(values, dtype=float).tolist()
    ]
