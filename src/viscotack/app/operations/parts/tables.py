"""Writers of outputs: rows as CSV, and text."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from viscotack.files.text import write_table

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
