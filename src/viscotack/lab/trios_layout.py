"""Layout of TA Instruments TRIOS exports as text and csv: a header, then steps with a table each.

A step begins with a line ``[step]``. Its name, its number of points and its table follow, the
table either named row by row (``Variables``, ``data point 1``) or plain: headings, units, rows.
"""

from .lab_file import LabFile
from .plain_layout import cells
from .table import Table, first_headings, tabulated

_STEP = "[step]"
_COUNTED = "number of points"
Row = tuple[int, list[str]]


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if there is no step."""
    return "trios" if any(_begins_step(text) for text in file.lines) else None


def tables(file: LabFile) -> list[Table]:
    """Return the table of each step that has one.

    Raises
    ------
    ValueError
        If there is no step, a row does not have a cell for each heading, or a step has not as
        many rows as it says.
    """
    starts = [i for i, text in enumerate(file.lines) if _begins_step(text)]
    if not starts:
        raise file.error(f"expected a line {_STEP!r} before each table")
    separator = "\t" if any("\t" in text for text in file.lines) else ","
    words = " ".join(text for text in file.lines[: starts[0]] if "geometry" in text.casefold())
    found = []
    for start, end in zip(starts, [*starts[1:], len(file.lines)], strict=True):
        rows = [
            (number, cells(file, text, number, separator))
            for number, text in enumerate(file.lines[start + 1 : end], start=start + 2)
        ]
        if (table := _table(file, rows, words)) is not None:
            found.append(table)
    return found


def _table(file: LabFile, rows: list[Row], words: str) -> Table | None:
    """Return the table of one step; a step that measured nothing has none."""
    counted = None
    for number, row in rows:
        if row[0].strip().casefold() == _COUNTED and len(row) > 1:
            if not row[1].strip().isdecimal():
                raise file.error(f"expected a number of points, got {row[1]!r}", number)
            counted = int(row[1])
    at = first_headings([row for _, row in rows])
    if at is None:
        if counted:
            raise file.error(f"the step has {counted} points but no headings", rows[0][0])
        return None
    data: list[Row] = []
    for number, row in rows[at + 2 :]:
        if not any(cell.strip() for cell in row):
            if data:
                break
            continue
        data.append((number, row))
    if at + 1 == len(rows):
        raise file.error("expected a row of units below the headings", rows[at][0])
    if counted is not None and counted != len(data):
        raise file.error(
            f"the step says {counted} points and has {len(data)}: the file is cut or edited",
            rows[at][0],
        )
    return tabulated(file, rows[at][1], rows[at + 1][1], data, words=words)


def _begins_step(text: str) -> bool:
    return text.strip().strip('",').casefold() == _STEP
