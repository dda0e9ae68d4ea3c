"""Tables of laboratory files as text: headings, units near them, rows of cells.

Readers of all formats produce a :class:`Table`. A row is a line number with its cells.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import PurePath
from typing import Any

from viscotack.errors import InputError

from .file import LabFile
from .headings import (
    WORDS,
    Vocabulary,
    bare,
    in_kelvin,
    is_unit,
    no_unit,
    recognise,
    unquoted,
)
from .numbers import is_number

_STATED = re.compile(r'([+-]?[0-9]+(?:[.,][0-9]*)?)[\s;,"]*([^\t;,"]*).*')
# "Temperature,25.0 degC", "Temp. [C] = 25,0", "Test temperature 25 °C"
_LABELLED = re.compile(r'"?([^:=;,\t"]*[^:=;,\t"\s0-9+-])"?\s*[:=;,\t\s]+\s*"?([+-]?[0-9].*)')
_ALONE = re.compile(r'"?([+-]?[0-9]+(?:[.,][0-9]*)?)\s*([^\s;,"0-9]+)[\s;,"]*')
_OF_TEST = set(WORDS["temperatures"]["test"].split())
_ABOVE = 4  # rows of words above the numbers
_ONE = ("1", "1.0")
_SEGMENT = re.compile(r"[0-9]+\|[0-9]+")  # segment and point of HAAKE RheoWin
_COUNTERS = 3  # columns, from the left, that may number the points

Row = tuple[int, Sequence[str]]
Rows = tuple[tuple[int, tuple[str, ...]], ...]


@dataclass(frozen=True)
class Table:
    """Headings, units and rows of cells, as text.

    Parameters
    ----------
    headings, units : tuple of str
        One per column; an empty unit where the file states none.
    rows : tuple of (int, tuple of str)
        Line number in the file, and cells, one per heading.
    words : str
        Text around the table: geometry, step name.
    temperature : float or None
        Temperature stated once for all rows [K].
    levels : dict of str to float
        Other values stated once for all rows: the step of ``strain`` [-] or ``stress`` [Pa].
    label : str
        Text above the columns of one of several tables side by side, such as a temperature.
    sheet : str
        Name of the sheet in a workbook.
    number : int
        Number of the table in the file, from 1.
    before : Table or None
        Table before this one in the file or sheet.
    notes : tuple of str
        Decisions of the layout's reader.
    """

    headings: tuple[str, ...]
    units: tuple[str, ...]
    rows: Rows
    words: str = ""
    temperature: float | None = None
    notes: tuple[str, ...] = ()
    levels: Mapping[str, float] = field(default_factory=dict)
    label: str = ""
    sheet: str = ""
    number: int = 0
    before: "Table | None" = None

    @property
    def place(self) -> str:
        """Sheet, first row and headings, to identify the table in a message."""
        known = ", ".join(filter(None, self.headings))
        line = f"row {self.rows[0][0]}: " if self.rows else ""
        return f"{self.sheet + ', ' if self.sheet else ''}{line}{known:.60}"


def tabulated(
    file: LabFile,
    vocabulary: Vocabulary,
    headings: Sequence[str],
    units: Sequence[str] | None,
    rows: Iterable[Row],
    **stated: Any,
) -> Table:
    """Return a table; raise an error that names the first row of another length.

    `stated` are the other fields of :class:`Table`. In a workbook a cell cannot shift, so that
    cells beside the headings are ignored.
    """
    width = max((i + 1 for i, cell in enumerate(headings) if cell.strip()), default=0)
    chosen = []
    for line, cells in rows:
        cells = tuple(map(str.strip, cells))
        if len(cells) < width or (any(cells[width:]) and not file.is_workbook):
            raise file.error(f"{len(cells)} cells under {width} headings; truncated?", line)
        if any(cells[:width]) or not file.is_workbook:
            chosen.append((line, cells[:width]))
    names = tuple(map(unquoted, headings[:width]))
    beside = [bare(unquoted(unit)) for unit in [*(units or ()), *[""] * width][:width]]
    given = [vocabulary.recognise(name, "") for name in names]
    # a row of units counts only where the heading itself has no unit
    own = [(heading and heading.unit) or unit for heading, unit in zip(given, beside, strict=True)]
    return Table(names, tuple(own), tuple(chosen), **stated)


def under(rows: Sequence[Row]) -> tuple[Sequence[str] | None, list[Row]]:
    """Split the rows below headings into units, if there are any, and data.

    Above the first row with a number there may be blank rows, a row of units and a row of words
    such as ``Waveform``; the row with most units is that of the units.
    """
    filled = [row for row in rows if any(map(str.strip, row[1]))]
    number = (i for i, (_, row) in enumerate(filled) if any(map(is_number, row)))
    above = [row for _, row in filled[: min(next(number, _ABOVE), _ABOVE)]]
    if not above:
        return None, filled
    units = [sum(not no_unit(cell) and is_unit(cell) for cell in row) for row in above]
    at = units.index(max(units))
    return above[at], filled[at + 1 :]


def pieces(table: Table, words: Vocabulary) -> list[Table]:
    """Return the tables within a table: side by side, or one below the other; without raw waves."""
    blocks = _side_by_side(table, words)
    return [without_waves(part) for block in blocks for part in _stacked(block, words)]


def _side_by_side(table: Table, words: Vocabulary) -> list[Table]:
    """Return the tables that stand side by side, each with the same headings."""
    names = [heading.casefold() for heading in table.headings]
    first = next((i for i, name in enumerate(names) if name), 0)
    starts = [i for i, name in enumerate(names) if name and name == names[first]]
    # a column without a heading, left of each table, may number its points
    starts = [i - 1 if first and not names[i - 1] else i for i in starts]
    blocks = list(zip(starts, [*starts[1:], len(names)], strict=True))
    shown = [[name for name in names[a:b] if name] for a, b in blocks]
    if len(blocks) < 2 or any(block != shown[0] for block in shown):
        return [table]
    a, b = blocks[0]
    if not words.heads([heading for heading in table.headings[a:b] if heading]):
        return [table]
    parts = []
    for a, b in blocks:
        note = f"the columns {a + 1} to {b} are one of {len(blocks)} tables side by side"
        parts.append(of_columns(table, range(a, b), range(a, b), notes=(*table.notes, note)))
    return parts


def of_columns(table: Table, columns: Sequence[int], own: Sequence[int], **changes: Any) -> Table:
    """Return some columns of a table, in the rows that have a cell in its own ones."""
    rows = ((line, row) for line, row in table.rows if any(row[i] for i in own))
    return replace(
        table,
        headings=tuple(table.headings[i] for i in columns),
        units=tuple(table.units[i] for i in columns),
        rows=tuple((line, tuple(row[i] for i in columns)) for line, row in rows),
        **changes,
    )


def _stacked(table: Table, words: Vocabulary) -> list[Table]:
    """Return the parts of a table whose points are numbered from 1 again, or as ``2|1``."""
    for counter in range(min(_COUNTERS, len(table.headings))):
        cells = [row[counter] for _, row in table.rows]
        if words.recognise(table.headings[counter], "") is not None:
            continue
        if cells and all(map(_SEGMENT.fullmatch, cells)):
            keys = [cell.partition("|")[0] for cell in cells]
            starts = [i for i, key in enumerate(keys) if not i or key != keys[i - 1]]
        else:
            starts = [i for i, cell in enumerate(cells) if cell in _ONE]
        # numbers that begin again in each row are those of samples, not of points
        if len(starts) < 2 or starts[0] or any(b - a < 2 for a, b in pairwise(starts)):
            continue
        parts = [table.rows[a:b] for a, b in pairwise([*starts, len(cells)])]
        if all(_counts([row[counter] for _, row in part if row[counter]]) for part in parts):
            return [
                replace(table, rows=part, notes=(*table.notes, f"part {i} of {len(parts)}"))
                for i, part in enumerate(parts, start=1)
            ]
    return [table]


def where(file: LabFile, tables: Sequence[Table], conditions: str | None) -> list[Table]:
    """Return the tables with the rows that meet conditions such as ``"Sample=A; Position=2"``."""
    found = list(tables)
    for condition in filter(str.strip, (conditions or "").split(";")):
        name, equals, value = (part.strip() for part in condition.partition("="))
        if not equals or not name:
            raise InputError(f'`where` must be like "Sample=A", got {condition.strip()!r}')
        chosen, known = [], {}
        for table in found:
            places = [i for i, h in enumerate(table.headings) if _is(h, name)]
            cells = [row[places[0]] for _, row in table.rows] if places else []
            known |= dict.fromkeys(cells)
            rows = [row for row, cell in zip(table.rows, cells, strict=False) if _is(cell, value)]
            if rows:
                chosen.append(replace(table, rows=tuple(rows)))
        if not chosen:
            there = ", ".join(f'"{name}={cell}"' for cell in list(known)[:12])
            headings = ", ".join(dict.fromkeys(h for table in found for h in table.headings if h))
            has = f"there are {there}" if known else f"the headings are {headings}"
            raise file.error(f'no row has "{condition.strip()}" (`where`); {has}')
        found = chosen
    return found


def _is(cell: str, value: str) -> bool:
    if is_number(cell) and is_number(value):
        return float(cell.replace(",", ".")) == float(value.replace(",", "."))
    return unquoted(cell).casefold() == unquoted(value).casefold()


def without_waves(table: Table) -> Table:
    """Remove samples of raw waves between the numbered points of a rheometer, and their columns.

    Only the points are numbered (1, 2, 3, ...); a sample fills the columns of waves, and leaves
    others empty that every point fills. There are at least as many samples as points.
    """
    rows = table.rows
    for counter in range(min(_COUNTERS, len(table.headings))):
        points = [row for _, row in rows if row[counter]]
        if not 0 < len(points) < len(rows) or not _counts([row[counter] for row in points]):
            continue
        others = (i for i in range(len(table.headings)) if i != counter)
        full = [i for i in others if all(row[i] for row in points)]
        samples = {line for line, row in rows if not row[counter] and not all(row[i] for i in full)}
        # a row of sums below the points is no sample
        if len(samples) < max(len(rows) - len(points), len(points)):
            continue
        waves = {i for line, row in rows if line in samples for i, cell in enumerate(row) if cell}
        note = f"{len(samples)} samples of raw waves between the points are not used"
        return replace(
            table,
            headings=tuple("" if i in waves else h for i, h in enumerate(table.headings)),
            rows=tuple(row for row in rows if row[0] not in samples),
            notes=(*table.notes, note),
        )
    return table


def _counts(cells: Sequence[str]) -> bool:
    """Return whether cells are 1, 2, 3, ... or ``4|1``, ``4|2``, ``4|3``, ..."""
    try:
        found = [float(cell.rpartition("|")[2]) for cell in cells]
    except ValueError:
        return False
    return found == list(range(1, len(cells) + 1))


def stated_temperature(rows: Iterable[Sequence[str]]) -> float | None:
    """Return the temperature stated above a table [K]; None if there is none or more than one.

    The unit stands behind the number, in brackets behind the word, or in the next cell. Number and
    unit may also stand alone.

    Examples
    --------
    >>> stated_temperature([["Temperature", "25 °C"]]), stated_temperature([["Temp: 300 K"]])
    (298.15, 300.0)
    >>> stated_temperature([["Temperature (°C),25.0"]]), stated_temperature([["Temp [C];25,0"]])
    (298.15, 298.15)
    """
    found = set()
    for row in rows:
        text = "\t".join(cell.strip() for cell in row).strip("\t# ")
        match, number, heading = _LABELLED.fullmatch(text), _ALONE.fullmatch(text), None
        if match:
            # "Test temperature (°C)" is that of the test
            first, _, rest = match[1].strip().partition(" ")
            heading = recognise(rest if first.casefold() in _OF_TEST else match[1])
        if match and heading and heading.quantity == "temperature":
            number = _STATED.fullmatch(match[2])
        else:
            heading = None
        if not number:
            continue
        unit = number[2].strip() or (heading.unit if heading else "")
        with suppress(InputError):
            found.add(in_kelvin(float(number[1].replace(",", ".")), unit))
    return found.pop() if len(found) == 1 else None


# ---- temperatures in the names of files ----------------------------------------------------------

_IN_NAME = re.compile(
    r"(?<![0-9.A-SU-Za-su-z])(?P<number>[+-]?[0-9]+(?:\.[0-9]+)?) ?(?P<unit>degC|°C|C|K)"
    r"(?![A-Za-z0-9])"
)
_HYPHEN = re.compile(r"[A-Za-z0-9](-[0-9.]+ ?(?:degC|°C|C|K))(?![A-Za-z0-9])")


def kelvins_in_name(path: str) -> set[float]:
    """Return the temperatures in the name of a file [K].

    Examples
    --------
    >>> kelvins_in_name("probe_300K_2.csv"), kelvins_in_name("probe_2.csv")
    ({300.0}, set())
    """
    found = set()
    for one in _IN_NAME.finditer(PurePath(path).stem):
        with suppress(InputError):
            found.add(in_kelvin(float(one["number"]), one["unit"]))
    return found


def kelvin_in_name(file: LabFile) -> float:
    """Return the single temperature in the name of a file [K].

    Examples
    --------
    >>> round(kelvin_in_name(LabFile("data/foam_dma_-25C.csv", b"", (), ())), 2)
    248.15
    """
    stem = PurePath(file.path).stem
    if match := _HYPHEN.search(stem):
        raise file.error(
            f"{match[1]!r} in the name has a minus sign or a hyphen; write '_' for one"
        )
    found = kelvins_in_name(file.path)
    if len(found) != 1:
        raise file.error(
            f"`temperature_in_name` needs one temperature such as '25C', found {len(found)}"
        )
    return found.pop()
