"""Tables of campaigns as CSV, Parquet and MATLAB files."""

import csv
import io
import os
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.files.arrow import arrow
from viscotack.files.text import cell
from viscotack.files.whole import Target, write_whole, writing_whole

# Rows that are held at a time.
_ROWS = 10_000
Row = Mapping[str, Any]


def export(rows: Iterable[Row], path: Target, *, trajectories: bool = True) -> None:
    """Write rows to a file, complete or not at all.

    Parameters
    ----------
    rows : iterable of mapping
        `Store.results` or `Store.failures`, or a list; they are gone through twice.
    path : path or binary file
        Its ending chooses the format: ``.csv``, ``.parquet`` or ``.mat``; an open file gets CSV.
    trajectories : bool
        Whether columns of lists are written as well; in CSV each place of a list is a column,
        ``trajectory_force_01`` and so on, in MATLAB a list is a row of a matrix.

    Raises
    ------
    ValueError
        If the ending is unknown, or there are no rows.

    Examples
    --------
    >>> import io
    >>> file = io.BytesIO()
    >>> export([{"name": "a", "pull_off_force": 0.5}], file)
    >>> file.getvalue().decode().split()
    ['name,pull_off_force', 'a,0.5']
    """
    suffix = Path(path).suffix if isinstance(path, str | os.PathLike) else ".csv"
    if suffix not in _WRITERS:
        raise InputError(f"{path}: the ending must be one of {', '.join(_WRITERS)}")
    # length of the longest list of each column; 0 for columns of single values
    widths: dict[str, int] = {}
    for row in rows:
        for name, value in row.items():
            width = len(value) if isinstance(value, list) else 0
            widths[name] = max(width, widths.get(name, 0))
    if not widths:
        raise InputError(f"there is nothing to write to {path}: the table has no rows")
    if not trajectories:
        widths = {name: width for name, width in widths.items() if not width}
    _WRITERS[suffix](rows, widths, path)


def _write_csv(rows: Iterable[Row], widths: Mapping[str, int], path: Target) -> None:
    header = [
        name if place is None else f"{name}_{place + 1:02d}"
        for name, width in widths.items()
        for place in (range(width) if width else [None])
    ]
    with writing_whole(path) as file:
        text = io.TextIOWrapper(file, encoding="utf-8", newline="", write_through=True)
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(map(cell, header))
        writer.writerows(list(_cells(row, widths)) for row in rows)
        text.detach()


def _cells(row: Row, widths: Mapping[str, int]) -> Iterator[Any]:
    for name, width in widths.items():
        value = row.get(name)
        if width:
            yield from (list(value or ()) + [None] * width)[:width]
        else:
            yield cell(value) if isinstance(value, str) else value


def _write_parquet(rows: Iterable[Row], widths: Mapping[str, int], path: Target) -> None:
    pa = arrow()
    schema = pa.unify_schemas(
        [table.schema for table in _tables(rows, widths)], promote_options="permissive"
    )
    with writing_whole(path) as file, pa.parquet.ParquetWriter(file, schema) as writer:
        for table in _tables(rows, widths):
            both = [schema.empty_table(), table]
            writer.write_table(pa.concat_tables(both, promote_options="permissive"))


def _tables(rows: Iterable[Row], widths: Mapping[str, int]) -> Iterator[Any]:
    """Yield rows as tables of some of them; a column without a value has no type yet."""
    pa, left = arrow(), iter(rows)
    lists = pa.list_(pa.float64())
    while some := list(islice(left, _ROWS)):
        yield pa.table(
            {
                name: pa.array([row.get(name) for row in some], lists if width else None)
                for name, width in widths.items()
            }
        )


def _write_mat(rows: Iterable[Row], widths: Mapping[str, int], path: Target) -> None:
    from scipy.io import savemat

    held = list(rows)
    columns = {
        name.replace(".", "_"): _array([row.get(name) for row in held], width)
        for name, width in widths.items()
    }
    content = io.BytesIO()
    savemat(content, columns, do_compression=True, oned_as="column")
    write_whole(path, content.getvalue())


def _array(values: list[Any], width: int) -> Any:
    """Return a column as numbers, a matrix with a row per list, or cells of words."""
    if width:
        empty = [np.nan] * width
        return np.array([(list(v or ()) + empty)[:width] for v in values], dtype=float)
    if any(isinstance(v, str) for v in values):
        return np.array([v or "" for v in values], dtype=object)
    return np.array([np.nan if v is None else v for v in values], dtype=float)


_WRITERS = {".csv": _write_csv, ".parquet": _write_parquet, ".mat": _write_mat}
