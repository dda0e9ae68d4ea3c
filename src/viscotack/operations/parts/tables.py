"""What outputs are written by: rows as CSV, texts."""

import csv
import io
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from viscotack.files.whole import Target

Writer = Callable[["Target"], None]


def rows_as_csv(rows: Sequence[dict[str, Any]]) -> Writer:
    """Return what writes rows of the same keys as a CSV table with a heading."""

    def text() -> str:
        stream = io.StringIO(newline="")
        writer = csv.DictWriter(stream, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        return stream.getvalue()

    return as_text(text)


def as_text(text: Callable[[], str]) -> Writer:
    """Return what writes a text, made when it is written."""

    def write(target: "Target") -> None:
        from viscotack.files.whole import write_whole

        write_whole(target, text().encode())

    return write
