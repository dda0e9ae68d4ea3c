"""Layout of TA Instruments TRIOS exports as JSON.

Results are either rows of named cells, with headers that give each column its words and unit
(``Results / Original / ColumnHeaders, Rows``), or tables with a list of columns and a list of rows
(``Experiment / Results / DataSet / Data``). The rows of one step form one table.
"""

import json
from collections.abc import Iterator
from typing import Any

from .file import LabFile
from .headings import MATERIAL
from .tables import Table, tabulated

_STEPS = ("Results Step Id", "Procedure Step Id")


def tables(file: LabFile, *_: object) -> list[Table] | None:
    """Return the table of each step that has one; None unless the text begins like JSON.

    Raises
    ------
    ValueError
        If the text is not JSON, or contains no table of a TRIOS export.
    """
    if not file.is_record:
        return None
    # keep numbers as written, so that damaged ones are detected as in text files
    text = "\n".join(file.lines) + file.rest
    record = json.loads(text, parse_float=str, parse_int=str)
    found: list[Table] = []
    words = " ".join(_geometry(record))
    results = record.get("Experiment", record).get("Results")
    if not results:
        raise file.error("the file has no Results; expected a TRIOS export as JSON")
    if isinstance(results, list):
        for data in (data["Data"] for result in results for data in result["DataSet"]):
            columns = data["columns"]
            names = [column["name"] for column in columns]
            units = [column.get("unit") or "" for column in columns]
            rows = [(i, list(map(_text, row))) for i, row in enumerate(data["values"], start=1)]
            found.append(tabulated(file, MATERIAL, names, units, rows, words=words))
        return found
    # prefer original to user-processed results, as TRIOS does
    section = results.get("Original") or results.get("Processed") or results
    headers = section["ColumnHeaders"]
    steps: dict[str, list[tuple[int, dict[str, str]]]] = {}
    for number, row in enumerate(section["Rows"], start=1):
        if unknown := row.keys() - headers.keys():
            raise file.error(f"a cell {min(unknown)!r} without an entry in ColumnHeaders", number)
        step = next((str(row[key]) for key in _STEPS if key in row), "")
        cells = {key: _text(row.get(key)) for key in headers}
        steps.setdefault(step, []).append((number, cells))
    for step in steps.values():
        # drop columns that the step did not measure
        own = [key for key in headers if any(cells[key] for _, cells in step)]
        names = [headers[key].get("DisplayName") or key for key in own]
        units = [(headers[key].get("Unit") or {}).get("Name") or "" for key in own]
        rows = [(number, [cells[key] for key in own]) for number, cells in step]
        found.append(tabulated(file, MATERIAL, names, units, rows, words=words))
    return found


def _text(cell: Any) -> str:
    if isinstance(cell, dict | list):
        raise TypeError("each cell must be a number or a text")
    return "" if cell is None else str(cell)


def _geometry(record: Any) -> Iterator[str]:
    """Yield the words on the geometry, from anywhere in the configuration."""
    if isinstance(record, dict):
        for key, value in record.items():
            if key.startswith("Geometry"):
                found = value.get("Name") if isinstance(value, dict) else value
                yield found if isinstance(found, str) else ""
            elif key not in ("Rows", "values"):
                yield from _geometry(value)
    elif isinstance(record, list):
        for value in record:
            yield from _geometry(value)
