"""Layout of TA Instruments TRIOS exports as text and csv: a header, then steps with a table each.

A step begins with a line ``[step]``. Its name, its number of points and its table follow. The
table is either labelled row by row (``Variables``, ``data point 1``) or plain: headings, units,
rows. An export of one step may lack ``[step]``; it begins with ``Filename`` and has ``Variables``.
Exports of all variables have eighty columns; unknown ones are ignored.
"""

from .lab_file import LabFile
from .plain_layout import cells
from .tables import Table, first_headings, stated_temperature, tabulated

_STEP = "[step]"
_LOOKED = 500  # lines searched for the table of an export of one step
_COUNTED = "number of points"
Row = tuple[int, list[str]]


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if the file has no step."""
    return "trios" if _starts(file) else None


def tables(file: LabFile) -> list[Table]:
    """Return the table of each step that has one.

    Raises
    ------
    ValueError
        If there is no step, a row has not one cell per heading, or the number of rows of a step
        differs from the stated count.
    """
    starts = _starts(file)
    if not starts:
        raise file.error(f"expected a line {_STEP!r} before each table")
    separator = "\t" if any("\t" in text for text in file.lines) else ","
    before = starts[0] or _LOOKED
    words = " ".join(text for text in file.lines[:before] if "geometry" in text.casefold())
    stated = stated_temperature(text.split(separator) for text in file.lines[:before])
    found = []
    for start, end in zip(starts, [*starts[1:], len(file.lines)], strict=True):
        rows = [
            (number, cells(file, text, number, separator))
            for number, text in enumerate(file.lines[start + 1 : end], start=start + 2)
        ]
        if (table := _table(file, rows, words, stated)) is not None:
            found.append(table)
    return found


def _table(file: LabFile, rows: list[Row], words: str, temperature: float | None) -> Table | None:
    """Return the table of one step, or None for a step without data."""
    counted = None
    for number, row in rows:
        if row[0].strip().casefold() == _COUNTED and len(row) > 1:
            if not row[1].strip().isdecimal():
                raise file.error(f"expected the number of points, got {row[1]!r}", number)
            counted = int(row[1])
    at = first_headings([row for _, row in rows])
    if at is None:
        if counted:
            raise file.error(f"the step has {counted} points but no headings", rows[0][0])
        return None
    if at + 1 == len(rows):
        raise file.error("expected a row of units below the headings", rows[at][0])
    headings, units = rows[at][1], rows[at + 1][1]
    data: list[Row] = []
    for number, row in rows[at + 2 :]:
        if any(cell.strip() for cell in row):
            data.append((number, row))
        elif data:
            break
    if counted is not None and counted != len(data):
        raise file.error(
            f"the step states {counted} points but has {len(data)}; the file is truncated or "
            "edited",
            rows[at][0],
        )
    notes = ()
    if data and 1 < len(data[0][1]) < len(headings):
        # at the time of the step, ratios are undefined and the last cells are missing
        notes = (f"line {data.pop(0)[0]} rejected: it lacks cells at the beginning of the step",)
    stated = {"words": words, "temperature": temperature, "notes": notes}
    return tabulated(file, headings, units, data, **stated)


def _starts(file: LabFile) -> list[int]:
    """Return the lines after which a step begins."""
    starts = [i for i, text in enumerate(file.lines) if _begins_step(text)]
    if not starts and file.lines and _cell(file.lines[0]) == "filename":
        starts = [0 for text in file.lines[:_LOOKED] if _cell(text) == "variables"][:1]
    return starts


def _cell(text: str) -> str:
    """Return the first cell of a line in lower case."""
    return text.replace(",", "\t").partition("\t")[0].strip().casefold()


def _begins_step(text: str) -> bool:
    return "[" in text and text.strip().strip('",').casefold() == _STEP
