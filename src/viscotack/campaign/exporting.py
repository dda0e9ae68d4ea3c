"""Tables of campaigns as CSV, Parquet and MATLAB files."""

import csv
import io
import os
from collections.abc import Iterable, Mapping
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.files.frame import arrow
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
    suffix = Path(path).suffix.lower() if isinstance(path, str | os.PathLike) else ".csv"
    if suffix not in _WRITERS:
        raise InputError(f"{path}: the ending must be one of {', '.join(_WRITERS)}")
    # kinds of values of each column, and the length of its longest list
    columns: dict[str, tuple[set[type], int]] = {}
    for row in rows:
        for name, value in row.items():
            kinds, width = columns.get(name, (set(), 0))
            if isinstance(value, list):
                width = max(width, len(value))
            columns[name] = kinds | {type(value)} - {type(None)}, width
    if not columns:
        raise InputError(f"there is nothing to write to {path}: the table has no rows")
    if not trajectories:
        columns = {name: kept for name, kept in columns.items() if list not in kept[0]}
    _WRITERS[suffix](rows, columns, path)


_Columns = Mapping[str, tuple[set[type], int]]


def _write_csv(rows: Iterable[Row], columns: _Columns, path: Target) -> None:
    header: list[str] = []
    for name, (_, width) in columns.items():
        header += [f"{name}_{place + 1:02d}" for place in range(width)] or [name]

    def cells(row: Row) -> list[Any]:
        found: list[Any] = []
        for name, (_, width) in columns.items():
            value = row.get(name)
            found += (list(value or ()) + [None] * width)[:width] if width else [value]
        return [cell(value) if isinstance(value, str) else value for value in found]

    with writing_whole(path) as file:
        text = io.TextIOWrapper(file, encoding="utf-8", newline="", write_through=True)
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(map(cell, header))
        writer.writerows(map(cells, rows))
        text.detach()


def _write_parquet(rows: Iterable[Row], columns: _Columns, path: Target) -> None:
    pa = arrow()
    of = {list: pa.list_(pa.float64()), str: pa.string(), float: pa.float64(), int: pa.int64()}
    of[bool] = pa.bool_()
    # a column of whole and other numbers has the others; one without a value has no type
    types = {
        name: next((made for kind, made in of.items() if kind in kinds), pa.null())
        for name, (kinds, _) in columns.items()
    }
    schema, left = pa.schema(types.items()), iter(rows)
    with writing_whole(path) as file, pa.parquet.ParquetWriter(file, schema) as writer:
        while some := list(islice(left, _ROWS)):
            writer.write_table(pa.Table.from_pylist(some, schema=schema))


def _write_mat(rows: Iterable[Row], columns: _Columns, path: Target) -> None:
    from scipy.io import savemat

    held, arrays = list(rows), {}
    for name, (kinds, width) in columns.items():
        values = [row.get(name) for row in held]
        if width:  # a matrix with a row per list
            empty = [np.nan] * width
            array = np.array([(list(v or ()) + empty)[:width] for v in values], dtype=float)
        elif str in kinds:
            array = np.array([v or "" for v in values], dtype=object)
        else:
            array = np.array(values, dtype=float)
        arrays[name.replace(".", "_")] = array
    content = io.BytesIO()
    savemat(content, arrays, do_compression=True, oned_as="column")
    write_whole(path, content.getvalue())


_WRITERS = {".csv": _write_csv, ".parquet": _write_parquet, ".mat": _write_mat}
