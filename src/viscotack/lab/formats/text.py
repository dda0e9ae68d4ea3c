"""Layouts of text files: where headings, units and rows of cells are.

Cells are separated by commas, semicolons, tabs or spaces. A plain table has headings, units beside
or below them, and rows; the instrument may repeat the headings above each of its intervals. The
two-row tables of pyvisco (``f, E_stor, E_loss, T, Set`` above ``Hz, MPa, MPa, C, -``), exports of
Anton Paar (one file per interval), Instron Bluehill, Zwick testXpert, texture analysers and
nanoindenters are plain. Others consist of blocks, each with a count of points, headings, units and
rows:

- TA TRIOS: steps after a line ``[step]``, with ``Number of points``, and rows labelled
  (``Variables``, ``data point 1``) or not. An export of one step may lack ``[step]``; it begins
  with ``Filename``.
- Anton Paar RheoCompass: intervals, which in every language of the instrument begin with a line of
  a label and two integers, number and count of points. The headings follow after a second label.
  The first column is empty; some exports omit it in the rows.

Tables, also of workbooks, may have the sweeps of several temperatures side by side; the temperature
is in a row above its columns (``20 °C`` above ``G', G''``), or in each heading (``G' 20 °C [Pa]``).
They may also stand on their side, with the headings in the first column.
"""

import csv
import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import accumulate, pairwise

from viscotack.errors import InputError

from .file import LabFile
from .headings import MATERIAL, Vocabulary, are_columns, is_unit, recognise
from .numbers import is_number
from .tables import Row, Table, of_columns, stated_temperature, tabulated, under, without_waves

LOOKED = 300  # lines searched for the headings
_FEWEST, _MOST_ROWS = 3, 50  # numbers in a row of a table on its side, and its rows
_SEPARATORS = ("\t", ";", ",", None)
_STEP, _COUNTED, _STEP_LOOKED = "[step]", "number of points", 500
_LABEL = re.compile(r"\s*[^\t;,]*[^\W\d][^\t;,]*:\s*")
_WHOLE = re.compile(r"\s*[0-9]+(\.0)?\s*")  # workbooks have floats
_GEOMETRY = re.compile("g[eé]om[eé]tr", re.IGNORECASE)
_WITHIN = re.compile(
    r"(?P<before>.*?[^\s,;@_-])[\s,;@_]*(?:at\s+|T\s*=\s*)?"
    r"(?P<label>[+-]?[0-9]+(?:[.,][0-9]+)?\s*(?:°C|ºC|℃|oC|degC|C|K))(?P<after>[\s\[(/].*)?"
)
# number, separator and cells of a line
Line = tuple[int, str | None, Sequence[str]]


def cells(file: LabFile, text: str, number: int, separator: str | None) -> list[str]:
    """Split a line into cells; quoted cells may contain the separator."""
    if separator is None:
        return text.split() or [""]
    if separator == "\t" or '"' not in text:
        return text.split(separator)
    try:
        row = next(csv.reader([text], delimiter=separator, strict=True, skipinitialspace=True))
        return row or [""]
    except (csv.Error, StopIteration):
        raise file.error("a quotation mark is not closed; add the closing one", number) from None


def is_comment(text: str) -> bool:
    """Return whether a line is a comment."""
    return text.lstrip().startswith(("#", "%"))


def geometry(rows: Sequence[Sequence[str]]) -> str:
    """Return the rows that describe the geometry, as text."""
    texts = (" ".join(row) for row in rows)
    return " ".join(text for text in texts if _GEOMETRY.search(text))


# ---- plain tables ------------------------------------------------------------------------------


def plain(file: LabFile, words: Vocabulary, names: Sequence[str] = ()) -> list[Table]:
    """Return the tables of a file.

    `names` are the headings or numbers of columns given by the caller.

    Raises
    ------
    ValueError
        If no line looks like headings, or a row has not one cell per heading.
    """
    lines: list[Line] = []
    for count, text in enumerate(file.lines[:LOOKED], start=1):
        marks = [mark for mark in _SEPARATORS if mark is None or mark in text]
        # a line with tabs has no other cells between blanks
        for separator in marks[:-1] if "\t" in text.strip() else marks:
            with suppress(InputError):
                row = cells(file, text.lstrip("#% "), count, separator)
                lines.append((count, separator, row))
    found = headed(lines, words, names)
    if found:
        line, separator, headings = found
        above = [[text.lstrip("#% ")] for text in file.lines[: max(line - 1, 0)]]
        before = next((row[0] for row in reversed(above) if row[0].strip()), "").split(separator)
        return in_rows(file, words, headings, _rows(file, line, separator), above, before)
    for separator in filter(None, _SEPARATORS):
        if tables := on_its_side(file, words, [text.split(separator) for text in file.lines]):
            return tables
    first = next((line.strip() for line in file.lines if line.strip()), "")
    if words.recognise(first.lstrip("#% "), "") is not None:
        raise file.error(f"{first!r} is the only column; a test needs two or more in one file")
    raise file.error(
        f"none of the first {LOOKED} lines looks like headings such as {words.usual} with units "
        f"beside or below them; the file begins {first[:60]!r}; choose columns by their "
        f"number, such as {words.columns}"
    )


def headed(rows: Sequence[Line], words: Vocabulary, names: Sequence[str]) -> Line | None:
    """Return the first row that heads a table, or that above the columns chosen by number.

    A line split at spaces is a sentence unless most of its words have a meaning.
    """
    for number, separator, row in rows:
        if heads(words, row, names):
            known = sum(words.recognise(cell, "") is not None for cell in _within(row)[0])
            if separator is not None or names or 2 * known > len(row):
                return number, separator, row
    for number, separator, row in rows:
        filled = [cell for cell in row if cell.strip()]
        if names and filled and all(map(is_number, filled)) and are_columns(names, row):
            return number - 1, separator, [str(i) for i in range(1, len(row) + 1)]
    return headed(rows, words, ()) if names else None


def heads(words: Vocabulary, row: Sequence[str], names: Sequence[str] = ()) -> bool:
    """Return whether a row heads a table, perhaps with temperatures within its headings."""
    return words.heads(row, names) or words.heads(_within(row)[0])


def on_its_side(
    file: LabFile, words: Vocabulary, rows: Sequence[Sequence[str]]
) -> list[Table] | None:
    """Return the tables whose headings stand one below the other, in the first column."""
    full = [i for i, row in enumerate(rows) if sum(map(is_number, row)) >= _FEWEST]
    if not 1 < len(full) <= _MOST_ROWS or len({len(rows[i]) for i in full}) > 1:
        return None
    headings, *columns = zip(*(rows[i] for i in full), strict=True)
    if not words.heads(headings):
        return None
    found = in_rows(file, words, headings, list(enumerate(columns, start=1)), rows[: full[0]])
    note = "rows and columns of the table exchanged"
    return [replace(table, notes=(*table.notes, note)) for table in found]


def _rows(file: LabFile, begin: int, separator: str | None) -> list[Row]:
    """Return the rows from a line on (from 0), without comments.

    A comment that repeats the headings, or has units below headings in a comment, is a row.
    """
    same = file.lines[begin - 1].strip() if begin and is_comment(file.lines[begin - 1]) else ""
    rows: list[Row] = []
    below = bool(same)
    for number, text in enumerate(file.lines[begin:], start=begin + 1):
        if not is_comment(text):
            if text.strip():
                rows.append((number, cells(file, text, number, separator)))
                below = False
        elif text.strip() == same or below:
            row = cells(file, text.strip().lstrip("#% "), number, separator)
            below = text.strip() == same
            if below or any(is_unit(cell) for cell in row if cell.strip()):
                rows.append((number, row))
    return rows


def in_rows(
    file: LabFile,
    words: Vocabulary,
    headings: Sequence[str],
    rows: Sequence[Row],
    above: Sequence[Sequence[str]],
    before: Sequence[str] = (),
) -> list[Table]:
    """Return the tables below a row of headings; another one below numbers begins another table.

    `above` are the rows above the headings, and `before` is the last of them that is not empty.
    """
    starts, filled = [-1], False
    for i, (_, row) in enumerate(rows):
        if any(map(is_number, row)):
            filled = True
        elif filled and (list(row) == list(headings) or heads(words, row)):
            starts.append(i)
            filled = False
    found, shape, temperature = [], "", None
    for start, end in zip(starts, [*starts[1:], len(rows)], strict=True):
        # what stands above a table holds for the next ones, unless these state their own
        shape, temperature = geometry(above) or shape, stated_temperature(above) or temperature
        own, labels = _labels(headings if start < 0 else rows[start][1], before)
        block = list(rows[start + 1 : end])
        # text above the next headings: "Result: ...", "Temperature: 40 °C"
        texts: list[Sequence[str]] = []
        while end < len(rows) and block:
            last = block[-1][1]
            if any(map(is_number, last)) and not last[0].rstrip().endswith(":"):
                break
            texts.insert(0, block.pop()[1])
        above, before = texts, next(filter(any, reversed(texts)), ())
        units, data = under(block)
        whole = tabulated(file, words, own, units, data, words=shape, temperature=temperature)
        if not labels:
            found.append(whole)
        # one table for each temperature; columns without one are common to all
        labels = labels[: len(whole.headings)]
        for label in dict.fromkeys(filter(None, labels)):
            own = [i for i, other in enumerate(labels) if other == label]
            shared = [i for i, other in enumerate(labels) if not other]
            notes = (f"the columns under {label!r} are a separate sweep",)
            found.append(of_columns(whole, [*shared, *own], own, label=label, notes=notes))
    return found


def _labels(headings: Sequence[str], before: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return headings without temperatures and the label of each column; none if they have none.

    Labels stand within the headings, or above the columns, each also for those to its right; one of
    them begins with a number. Every label has columns of its own, all with the same quantities.
    """
    row = [cell.strip() for cell in headings]
    padded = [*map(str.strip, before), *[""] * len(row)][: len(row)]
    for own, labels in (
        _within(row),
        (row, list(accumulate(padded, lambda left, label: label or left))),
    ):
        told = {*filter(None, labels)}
        if len(told) < 2 and not any(label[:1] in "+-0123456789" for label in told):
            continue
        columns: dict[str, list[str | None]] = {}
        for heading, label in zip(own, labels, strict=True):
            if heading and label:
                known = recognise(heading)
                columns.setdefault(label, []).append(known and known.quantity)
        first, *others = columns.values() or [[]]
        alike = all(each == first for each in others) and len({*first}) == len(first)
        if others and alike and None not in first:
            return own, labels
    return row, []


def _within(row: Sequence[str]) -> tuple[list[str], list[str]]:
    """Split headings into the part without temperature, and the temperatures."""
    headings, labels = [], []
    for cell in row:
        match = _WITHIN.fullmatch(cell)
        bare = f"{match['before']} {(match['after'] or '').strip()}".strip() if match else cell
        known = match is not None and recognise(cell) is None and recognise(bare) is not None
        headings.append(bare if known else cell)
        labels.append(match["label"].strip() if match is not None and known else "")
    return headings, labels


# ---- blocks with a count of points: TRIOS, RheoCompass -----------------------------------------


def trios(file: LabFile, *_: object) -> list[Table] | None:
    """Return the table of each step of a TRIOS export that has one; None for other files."""
    first = [re.split("[,\t]", text, maxsplit=1)[0].strip('" ').casefold() for text in file.lines]
    # lines after which a step begins
    starts = [i for i, text in enumerate(first) if text == _STEP]
    if not starts and first[:1] == ["filename"] and "variables" in first[:_STEP_LOOKED]:
        starts = [0]
    if not starts:
        return None
    separator = "\t" if any("\t" in text for text in file.lines) else ","
    rows: list[Row] = [
        (number, cells(file, text, number, separator) if number > starts[0] else [text])
        for number, text in enumerate(file.lines, start=1)
    ]
    above = [text.split(separator) for text in file.lines[: starts[0] or _STEP_LOOKED]]
    return _blocks(file, rows, starts, above)


def rheocompass(file: LabFile, *_: object) -> list[Table] | None:
    """Return the table of each interval of a RheoCompass export; None for other files."""
    for text in filter(lambda text: ":" in text, file.lines):
        for separator in ("\t", ";", ","):
            if separator in text and begins_interval(text.split(separator)):
                lines = enumerate(file.lines, start=1)
                return intervals(file, [(i, cells(file, x, i, separator)) for i, x in lines])
    return None


def intervals(file: LabFile, rows: Sequence[Row]) -> list[Table]:
    """Return the table of each interval in the rows of a file or a sheet."""
    starts = [i for i, (_, row) in enumerate(rows) if begins_interval(row)]
    return _blocks(file, rows, starts, [row for _, row in rows[: starts[0]]])


def begins_interval(row: Sequence[str]) -> bool:
    """Return whether a row has a label and two integers: an interval and its count of points."""
    first = zip((_LABEL, _WHOLE, _WHOLE), row, strict=False)
    fits = len(row) >= 3 and all(pattern.fullmatch(cell) for pattern, cell in first)
    return fits and not any(cell.strip() for cell in row[3:])


def _blocks(
    file: LabFile, rows: Sequence[Row], starts: Sequence[int], above: Sequence[Sequence[str]]
) -> list[Table]:
    """Return the table of each block that has one; `above` is the text before all blocks.

    Raises
    ------
    ValueError
        If a block has points but no headings or units, a row has not one cell per heading, or the
        number of rows differs from the stated count.
    """
    shared = {"words": geometry(above), "temperature": stated_temperature(above)}
    blocks = (rows[start:end] for start, end in pairwise([*starts, len(rows)]))
    return [table for block in blocks if (table := _block(file, block, shared)) is not None]


def _block(file: LabFile, rows: Sequence[Row], shared: dict[str, object]) -> Table | None:
    line, begin = rows[0]
    counted = begin[2] if begins_interval(begin) else None
    for _, row in rows:
        if row[0].strip().casefold() == _COUNTED and len(row) > 1:
            counted = row[1]
    if counted is not None and _WHOLE.fullmatch(counted) is None:
        raise file.error(f"expected the number of points, got {counted!r}", line)
    count = None if counted is None else int(float(counted))
    at = next((i for i, (_, row) in enumerate(rows) if MATERIAL.heads(row)), None)
    if at is None:
        if count:
            raise file.error(f"expected headings above the {count} points", line)
        return None
    below: list[Row] = []
    for number, row in rows[at + 1 :]:
        if any(map(str.strip, row)) and not _LABEL.fullmatch(row[0]):
            below.append((number, row))
        elif below and any(map(is_number, below[-1][1])):
            break
    units, data = under(below)
    headings, beside = list(rows[at][1]), list(units or ())
    if _LABEL.fullmatch(headings[0]):
        # skip the label in front of the headings
        headings[0] = ""
        if data and all(len(row) == len(headings) - 1 and row[0].strip() for _, row in data):
            headings, beside = headings[1:], beside[1:]
    notes = ()
    found = len(data)
    if data and 1 < len(data[0][1]) < len(headings):
        # at the time of the step, ratios are undefined and the last cells are missing
        notes = (f"line {data.pop(0)[0]} rejected: it lacks cells at the beginning of the step",)
    stated = shared | {"notes": notes}
    own = stated_temperature([row for _, row in rows[:at]])
    stated |= {} if own is None else {"temperature": own}
    table = tabulated(file, MATERIAL, headings, beside, data, **stated)
    found -= len(data) - len(without_waves(table).rows)
    if count not in (None, found):
        raise file.error(f"the block states {count} points but has {found}; truncated?", line)
    return table
