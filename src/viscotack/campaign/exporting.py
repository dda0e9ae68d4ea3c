"""Export of campaign tables to CSV, Parquet and MATLAB files."""

import csv
import io
import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import IO, Any

import numpy as np

from viscotack.errors import InputError
from viscotack.files.arrow import arrow
from viscotack.files.text import cell
from viscotack.files.whole import Target, write_whole, writing_whole

from .ordering import Ordered, measured
from .parts import write_parquet

# What a MATLAB file may have [bytes]: it is made in memory, and its format ends at twice as much.
_MOST_MAT = 1e9
# Rows of a CSV file that are made at a time.
_ROWS = 1000


def export(table: Any, path: Target, *, trajectories: bool = True) -> None:
    """Write a table of a store to a file, complete or not at all.

    Parameters
    ----------
    table : pyarrow.Table or Ordered
        `Store.results` or `Store.failures`; or what `Store.ordered_results` holds, of which only
        some rows are in memory at a time.
    path : path or binary file
        Its ending chooses the format: ``.csv``, ``.parquet`` or ``.mat``; an open file gets CSV.
    trajectories : bool
        Whether columns of lists are written as well; in CSV each place of a list is a column,
        ``trajectory_force_01`` and so on, in MATLAB a list is a row of a matrix.

    Raises
    ------
    ValueError
        If the ending is unknown, the table is empty, or it is too large for MATLAB.

    Examples
    --------
    >>> import io
    >>> import pyarrow
    >>> file = io.BytesIO()
    >>> export(pyarrow.table({"name": ["a"], "pull_off_force": [0.5]}), file)
    >>> file.getvalue().decode().split()
    ['name,pull_off_force', 'a,0.5']
    """
    suffix = Path(path).suffix if isinstance(path, str | os.PathLike) else ".csv"
    if suffix not in _WRITERS:
        raise InputError(f"{path}: the ending must be one of {', '.join(_WRITERS)}")
    rows = table if isinstance(table, Ordered) else _whole(table)
    if not rows.rows:
        raise InputError(f"there is nothing to write to {path}: the table has no rows")
    types = arrow().types
    names = [f.name for f in rows.schema if trajectories or not types.is_list(f.type)]
    _WRITERS[suffix](rows, names, path)


def _whole(table: Any) -> Ordered:
    return Ordered(table.schema, table.num_rows, measured(table), lambda: iter([table]))


def _write_csv(rows: Ordered, names: list[str], path: Target) -> None:
    # of a list a column for each place
    widths = {name: range(width) for name, width in rows.widths.items()}
    places = [(name, i) for name in names for i in widths.get(name, [None])]
    header = [name if i is None else f"{name}_{i + 1:02d}" for name, i in places]
    with writing_whole(path) as file:
        _write_rows(file, [map(cell, header)])
        for table in rows.chunks():
            # as words and numbers of Python's a row is ten times as large
            for begin in range(0, table.num_rows, _ROWS):
                some = table.slice(begin, _ROWS).select(names).to_pydict()
                columns = (_entries(some[name], i) for name, i in places)
                _write_rows(file, zip(*columns, strict=True))


def _write_rows(file: IO[bytes], rows: Iterable[Iterable[Any]]) -> None:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    file.write(text.getvalue().encode())


def _entries(values: list[Any], place: int | None) -> list[Any]:
    """Return a column in CSV; of lists the entries at a place."""
    if place is None:
        return [cell(v) if isinstance(v, str) else v for v in values]
    return [v[place] if v and place < len(v) else None for v in values]


def _write_parquet(rows: Ordered, names: list[str], path: Target) -> None:
    schema = arrow().schema([rows.schema.field(name) for name in names])
    with writing_whole(path) as file:
        write_parquet(file, schema, (table.select(names) for table in rows.chunks()))


def _write_mat(rows: Ordered, names: list[str], path: Target) -> None:
    from scipy.io import savemat

    size = 8 * rows.rows * sum(rows.widths.get(name, 1) for name in names)
    if size > _MOST_MAT:
        raise InputError(
            f"{path}: {rows.rows} rows are {size / 1e6:.0f} MB, more than the "
            f"{_MOST_MAT / 1e6:.0f} MB that a MATLAB file is made of; write --parquet or --csv"
        )
    table = rows.table()
    columns = {name.replace(".", "_"): _array(table.column(name)) for name in names}
    content = io.BytesIO()
    savemat(content, columns, do_compression=True, oned_as="column")
    write_whole(path, content.getvalue())


def _array(column: Any) -> Any:
    """Return a column as numbers, a matrix with a row per list, or cells of words."""
    types, values = arrow().types, column.to_pylist()
    if types.is_list(column.type):
        longest = max(len(v or ()) for v in values)
        empty = [np.nan] * longest
        return np.array([(list(v or ()) + empty)[:longest] for v in values], dtype=float)
    if types.is_string(column.type):
        return np.array([v or "" for v in values], dtype=object)
    return np.array([np.nan if v is None else v for v in values], dtype=float)


_WRITERS: dict[str, Callable[[Ordered, list[str], Target], None]] = {
    ".csv": _write_csv,
    ".parquet": _write_parquet,
    ".mat": _write_mat,
}
