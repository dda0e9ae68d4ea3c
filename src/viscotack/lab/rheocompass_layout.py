"""Layout of Anton Paar RheoCompass exports: intervals, each with its number of points.

In every language of the instrument, an interval begins with a line of a label and two integers,
its number and its count of points. The headings follow after a second label, then an optional
empty line, the units in square brackets, and the rows. The first column is empty; some
exports omit it in the rows. A line such as ``Temperature: 25.0 °C`` may precede all intervals or
the headings of one interval.
"""

import re
from collections.abc import Sequence

from .lab_file import LabFile
from .plain_layout import cells
from .tables import Row, Table, first_headings, stated_temperature, tabulated, without_waves

_LABEL = re.compile(r"\s*[^\t;,]*[^\W\d][^\t;,]*:\s*")
_WHOLE = re.compile(r"\s*[0-9]+(\.0)?\s*")  # workbooks have floats
_UNITS_WITHIN = 4  # lines below the headings


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if the file has no interval."""
    separator = _separator(file)
    return "rheocompass" if separator is not None else None


def tables(file: LabFile) -> list[Table]:
    """Return the table of each interval.

    Raises
    ------
    ValueError
        If there is no interval, an interval has no headings or units, a row has not one cell
        per heading, or the number of rows differs from the stated count.
    """
    separator = _separator(file)
    if separator is None:
        raise file.error(
            "expected intervals that begin with 'Interval and data points:', a number and a count"
        )
    rows: list[Row] = [
        (number, cells(file, text, number, separator))
        for number, text in enumerate(file.lines, start=1)
    ]
    return intervals(file, rows)


def intervals(file: LabFile, rows: Sequence[Row]) -> list[Table]:
    """Return the table of each interval in the rows of a file or a sheet."""
    starts = [i for i, (_, row) in enumerate(rows) if begins_interval(row)]
    above = (" ".join(row) for _, row in rows[: starts[0]])
    words = " ".join(text for text in above if "geometr" in text.casefold())
    stated = stated_temperature([row for _, row in rows[: starts[0]]])
    return [
        _interval(file, rows[start:end], words, stated)
        for start, end in zip(starts, [*starts[1:], len(rows)], strict=True)
    ]


def _interval(file: LabFile, rows: Sequence[Row], words: str, stated: float | None) -> Table:
    line, first = rows[0]
    count = int(float(first[2]))
    at = first_headings([row for _, row in rows])
    if at is None:
        raise file.error("expected headings below the beginning of the interval", line)
    below = enumerate(rows[at + 1 : at + 1 + _UNITS_WITHIN], start=at + 1)
    bracketed = (i for i, (_, row) in below if any(c.strip().startswith("[") for c in row))
    units = next(bracketed, None)
    if units is None:
        raise file.error("expected units in square brackets below the headings", rows[at][0])
    data: list[Row] = []
    for number, row in rows[units + 1 :]:
        if not any(cell.strip() for cell in row) or _LABEL.fullmatch(row[0]):
            break
        data.append((number, row))
    # skip the label in front of the headings
    headings, unit_cells = ["", *rows[at][1][1:]], rows[units][1]
    if all(len(row) == len(headings) - 1 and row[0].strip() for _, row in data):
        headings, unit_cells = headings[1:], list(unit_cells)[1:]
    own = stated_temperature([row for _, row in rows[:at]])
    kelvins = stated if own is None else own
    table = tabulated(file, headings, unit_cells, data, words=words, temperature=kelvins)
    found = len(without_waves(table).rows)
    if found != count:
        raise file.error(
            f"the interval states {count} points but has {found}; the file is truncated or edited",
            line,
        )
    return table


def _separator(file: LabFile) -> str | None:
    for text in file.lines:
        if ":" not in text:
            continue
        for separator in ("\t", ";", ","):
            if separator in text and begins_interval(text.split(separator)):
                return separator
    return None


def begins_interval(row: Sequence[str]) -> bool:
    """Return whether a row has a label and two integers: an interval and its count of points."""
    return (
        len(row) >= 3
        and _LABEL.fullmatch(row[0]) is not None
        and _WHOLE.fullmatch(row[1]) is not None
        and _WHOLE.fullmatch(row[2]) is not None
        and not any(cell.strip() for cell in row[3:])
    )
