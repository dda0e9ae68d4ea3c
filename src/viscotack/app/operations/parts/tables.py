"""Writers of outputs: rows as CSV, and text."""

import csv
import io
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from viscotack.files.whole import Target

Writer = Callable[["Target"], None]


def rows_as_csv(rows: Sequence[dict[str, Any]], columns: Sequence[str] = ()) -> Writer:
    """Return a function that writes rows with the same keys as a CSV table with a header.

    The columns are the keys of the first row; a table that may be empty needs them.
    """

    def text() -> str:
        stream = io.StringIO(newline="")
        writer = csv.DictWriter(stream, columns or list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        return stream.getvalue()

    return as_text(text)


def as_text(text: Callable[[], str]) -> Writer:
    """Return a function that creates and writes a text."""

    def write(target: "Target") -> None:
        from viscotack.files.whole import write_whole

        write_whole(target, text().encode())

    return write
