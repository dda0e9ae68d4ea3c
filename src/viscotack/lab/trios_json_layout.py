"""Layout of TA Instruments TRIOS exports as JSON.

Results are either rows of named cells, with headers that give each column its words and unit
(``Results / Original / ColumnHeaders, Rows``), or tables with a list of columns and a list of rows
(``Experiment / Results / DataSet / Data``). The rows of one step form one table.
"""

import json
from collections.abc import Iterator
from typing import Any

from viscotack.errors import InputError

from .lab_file import LabFile
from .tables import Table, tabulated

_STEPS = ("Results Step Id", "Procedure Step Id")
_DEEPEST = 50  # levels of nesting; exports have ten


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if the text does not begin like JSON."""
    return "trios-json" if file.is_record else None


def tables(file: LabFile) -> list[Table]:
    """Return the table of each step that has one.

    Raises
    ------
    ValueError
        If the text is not JSON, or contains no table of a TRIOS export.
    """
    record = _parsed(file)
    try:
        return list(_tables(file, record))
    except (KeyError, TypeError, AttributeError, IndexError) as error:
        raise file.error(
            f"expected tables of a TRIOS export, Results with ColumnHeaders and Rows; {error!r} is "
            "missing or has another type"
        ) from None


def _parsed(file: LabFile) -> dict[str, Any]:
    # keep numbers as written, so that damaged ones are detected as in text files
    text = "\n".join(file.lines) + file.rest
    try:
        record = json.loads(text, parse_float=str, parse_int=str)
    except (ValueError, RecursionError) as error:
        raise file.error(
            f"the JSON cannot be read; it may be truncated or damaged: {error}"
        ) from None
    if not isinstance(record, dict):
        raise file.error("expected a JSON object, as in TRIOS exports")
    return record


def _tables(file: LabFile, record: dict[str, Any]) -> Iterator[Table]:
    words = _geometry(record)
    record = record.get("Experiment", record)
    results = record.get("Results")
    if not results:
        raise file.error("the file has no Results; expected a TRIOS export as JSON")
    if isinstance(results, list):
        for result in results:
            for data in result["DataSet"]:
                yield _of_lists(file, data["Data"], words)
        return
    # prefer original to user-processed results, as TRIOS does
    section = results.get("Original") or results.get("Processed") or results
    yield from _of_rows(file, section["ColumnHeaders"], section["Rows"], words)


def _of_lists(file: LabFile, data: dict[str, Any], words: str) -> Table:
    columns = data["columns"]
    return tabulated(
        file,
        [column["name"] for column in columns],
        [column.get("unit") or "" for column in columns],
        [(i, [_text(cell) for cell in row]) for i, row in enumerate(data["values"], start=1)],
        words=words,
    )


def _of_rows(
    file: LabFile, headers: dict[str, Any], rows: list[dict[str, Any]], words: str
) -> Iterator[Table]:
    keys = list(headers)
    names = [headers[key].get("DisplayName") or key for key in keys]
    units = [(headers[key].get("Unit") or {}).get("Name") or "" for key in keys]
    steps: dict[str, list[tuple[int, list[str]]]] = {}
    for number, row in enumerate(rows, start=1):
        unknown = set(row) - set(keys)
        if unknown:
            raise file.error(f"a cell {min(unknown)!r} without an entry in ColumnHeaders", number)
        step = next((str(row[key]) for key in _STEPS if key in row), "")
        steps.setdefault(step, []).append((number, [_text(row.get(key)) for key in keys]))
    for step in steps.values():
        # drop columns that the step did not measure
        own = [i for i in range(len(keys)) if any(cells[i] for _, cells in step)]
        yield tabulated(
            file,
            [names[i] for i in own],
            [units[i] for i in own],
            [(number, [cells[i] for i in own]) for number, cells in step],
            words=words,
        )


def _text(cell: Any) -> str:
    if isinstance(cell, dict | list):
        raise InputError("each cell must be a number or a text")
    return "" if cell is None else str(cell)


def _geometry(record: Any, depth: int = 0) -> str:
    """Return the words on the geometry, from anywhere in the configuration."""
    found = []
    if depth < _DEEPEST and isinstance(record, dict):
        for key, value in record.items():
            if key.startswith("Geometry"):
                name = value.get("Name") if isinstance(value, dict) else value
                found.append(name if isinstance(name, str) else "")
            elif key not in ("Rows", "values"):
                found.append(_geometry(value, depth + 1))
    elif depth < _DEEPEST and isinstance(record, list):
        found += [_geometry(value, depth + 1) for value in record]
    return " ".join(filter(None, found))
