"""Layout of wide tables: the sweeps of several temperatures side by side.

The temperature is in a line above its columns (``20 °C`` above ``G', G''``), or in each heading
(``G' 20 °C [Pa]``). Columns without a temperature, such as the frequency, are common to all
sweeps.
"""

import re
from collections.abc import Sequence

from .lab_file import LabFile
from .numbers import is_number
from .plain_layout import cells, is_comment, separators
from .quantities import recognise
from .tables import Table, tabulated

_LOOKED = 200  # lines searched for the headings
_WITHIN = re.compile(
    r"(?P<before>.*?[^\s,;@_-])[\s,;@_]*(?:at\s+|T\s*=\s*)?"
    r"(?P<label>[+-]?[0-9]+(?:[.,][0-9]+)?\s*(?:°C|ºC|℃|oC|degC|C|K))(?P<after>[\s\[(/].*)?"
)
Row = list[str]
# line of the headings, separator, headings without temperatures, label of each column ("": common)
Found = tuple[int, str | None, Row, Row]


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if there are no side-by-side sweeps."""
    return "wide" if _found(file) is not None else None


def tables(file: LabFile) -> list[Table]:
    """Return a table for each temperature.

    Raises
    ------
    ValueError
        If there are no side-by-side columns of several temperatures, or a row has not one cell
        per heading.
    """
    found = _found(file)
    if found is None:
        raise file.error("expected columns of several temperatures side by side, under '20 °C'")
    line, separator, headings, labels = found
    rows = [
        (number, cells(file, text, number, separator))
        for number, text in enumerate(file.lines[line:], start=line + 1)
        if text.strip() and not is_comment(text)
    ]
    units: Row | None = None
    while rows and not any(map(is_number, rows[0][1])):
        units = rows.pop(0)[1] if any(map(str.strip, rows[0][1])) else rows.pop(0) and units
    whole = tabulated(file, headings, units, rows)
    shared = [i for i, label in enumerate(labels) if not label]
    return [
        _one(whole, [*shared, *(i for i, own in enumerate(labels) if own == label)], label)
        for label in dict.fromkeys(filter(None, labels))
    ]


def _one(whole: Table, columns: Sequence[int], label: str) -> Table:
    """Return the columns of one temperature; rows where all of them are empty are dropped."""
    own = columns[-1]
    rows = tuple(
        (line, tuple(cells[i] for i in columns))
        for line, cells in whole.rows
        if any(cells[i] for i in columns if i == own or i > columns[0])
    )
    return Table(
        tuple(whole.headings[i] for i in columns),
        tuple(whole.units[i] for i in columns),
        rows,
        label=label,
        notes=(f"the columns under {label!r} are a separate sweep",),
    )


def _found(file: LabFile) -> Found | None:
    above: dict[str | None, Row] = {}
    for number, text in enumerate(file.lines[:_LOOKED], start=1):
        for separator in separators(text):
            if separator is None:
                continue
            try:
                row = [cell.strip() for cell in cells(file, text.lstrip("#% "), number, separator)]
            except ValueError:
                continue
            for headings, labels in (_within(row), (row, _above(row, above.get(separator, [])))):
                if _side_by_side(headings, labels):
                    return number, separator, headings, labels
            if any(row):
                above[separator] = row
    return None


def _within(row: Row) -> tuple[Row, Row]:
    """Split headings into the part without temperature, and the temperatures."""
    headings, labels = [], []
    for cell in row:
        match = _WITHIN.fullmatch(cell)
        bare = f"{match['before']} {(match['after'] or '').strip()}".strip() if match else cell
        known = match is not None and recognise(cell) is None and recognise(bare) is not None
        headings.append(bare if known else cell)
        labels.append(match["label"].strip() if match is not None and known else "")
    return headings, labels


def _above(row: Row, labels: Row) -> Row:
    """Return the label above each column, or above the nearest column to the left."""
    found, current = [], ""
    for i in range(len(row)):
        current = (labels[i] if i < len(labels) else "") or current
        found.append(current)
    return found


def _side_by_side(headings: Row, labels: Row) -> bool:
    """Return whether every temperature has its own columns, all with the same quantities."""
    columns: dict[str, list[str]] = {}
    for heading, label in zip(headings, labels, strict=True):
        known = recognise(heading)
        if known is not None:
            columns.setdefault(label, []).append(known.quantity)
        elif heading and label:
            return False
    columns.pop("", None)
    groups = list(columns.values())
    return (
        len(groups) > 1
        and all(group == groups[0] for group in groups)
        and len(set(groups[0])) == len(groups[0])
    )
