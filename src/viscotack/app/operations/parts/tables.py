"""Writers of outputs: rows as CSV, and text."""

import csv
import io
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack.files.text import cell

if TYPE_CHECKING:
    from viscotack.files.whole import Target

Writer = Callable[["Target"], None]


def rows_as_csv(rows: Sequence[dict[str, Any]], columns: Sequence[str] = ()) -> Writer:
    """Return a function that writes rows with the same keys as a CSV table with a header.

    The columns are the keys of the first row; a table that may be empty needs them.
    """

    def write(target: "Target") -> None:
        names = columns or list(rows[0])
        write_table({name: [row.get(name) for row in rows] for name in names}, target)

    return write


def as_text(text: Callable[[], str]) -> Writer:
    """Return a function that creates and writes a text."""

    def write(target: "Target") -> None:
        from viscotack.files.whole import write_whole

        write_whole(target, text().encode())

    return write


def write_table(table: Mapping[str, Any], path: "Target") -> None:
    """Write columns as CSV, whole or not at all; an unknown number is an empty cell."""
    from viscotack.files.whole import write_whole

    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(map(cell, table))
    rows.writerows(zip(*(_cells(values) for values in table.values()), strict=True))
    write_whole(path, text.getvalue().encode())


def _cells(values: Any) -> list[Any]:
    if not isinstance(values, np.ndarray) or values.dtype.kind not in "fb":
        return [cell(value) if isinstance(value, str) else value for value in values]
    if values.dtype.kind == "b":
        return ["true" if value else "false" for value in values.tolist()]
    return ["" if value != value else value for value in values.tolist()]
