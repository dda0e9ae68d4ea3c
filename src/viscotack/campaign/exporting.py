"""Tables of a campaign for other programs: CSV, Parquet and MATLAB."""

import csv
import io
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.files.whole import Target, write_whole

from .parts import arrow, write_table


def export(table: Any, path: Target, *, trajectories: bool = True) -> None:
    """Write a table of a store to a file, whole or not at all.

    Parameters
    ----------
    table : pyarrow.Table
        `Store.results` or `Store.failures`.
    path : path or binary file
        Its ending chooses the format: ``.csv``, ``.parquet`` or ``.mat``; an open file gets CSV.
    trajectories : bool
        Whether columns of lists are written as well; in CSV each place of a list is a column,
        ``trajectory_force_01`` and so on, in MATLAB a list is a row of a matrix.

    Raises
    ------
    ValueError
        If the ending is another, or the table is empty.
    """
    suffix = Path(path).suffix if isinstance(path, str | os.PathLike) else ".csv"
    if suffix not in _WRITERS:
        raise InputError(f"{path}: the ending must be one of {', '.join(_WRITERS)}")
    if not table.num_rows:
        raise InputError(f"there is nothing to write to {path}: the table has no rows")
    types = arrow().types
    if not trajectories:
        kept = [f.name for f in table.schema if not types.is_list(f.type)]
        table = table.select(kept)
    _WRITERS[suffix](table, path)


def _write_csv(table: Any, path: Target) -> None:
    columns: dict[str, list[Any]] = {}
    for name in table.column_names:
        values = table.column(name).to_pylist()
        if arrow().types.is_list(table.schema.field(name).type):
            longest = max(len(v or ()) for v in values)
            for i in range(longest):
                columns[f"{name}_{i + 1:02d}"] = [
                    v[i] if v and i < len(v) else None for v in values
                ]
        else:
            columns[name] = values
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(columns)
    rows.writerows(zip(*columns.values(), strict=True))
    write_whole(path, text.getvalue().encode())


def _write_mat(table: Any, path: Target) -> None:
    from scipy.io import savemat

    columns = {name.replace(".", "_"): _array(table.column(name)) for name in table.column_names}
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


_WRITERS: dict[str, Callable[[Any, Target], None]] = {
    ".csv": _write_csv,
    ".parquet": write_table,
    ".mat": _write_mat,
}
