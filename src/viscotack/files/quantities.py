"""Tables of quantities in CSV files; the unit is the last part of the column's name."""

import os
from collections.abc import Mapping
from pathlib import Path

from viscotack.errors import InputError, placed
from viscotack.units import finite, parse

from .text import read_rows

# Largest number of rows of a tabulated curve; more rows add no information.
MOST_ROWS = 10_000


def read_quantities(
    path: str | os.PathLike[str], units: Mapping[str, str], *, most: int = MOST_ROWS
) -> dict[str, tuple[float, ...]]:
    """Read columns of a CSV file and convert them to SI.

    Parameters
    ----------
    path : path
        The first row has the names of the columns with their units, such as
        ``gap_nm,traction_kPa``; each further row has the numbers of one point. Lines that begin
        with ``#`` are skipped; semicolons and decimal commas are read too.
    units : mapping
        Name of each wanted column, without its unit -> SI unit of the result; "1" for a column of
        pure numbers, whose name may have no unit, and "" for numbers in the unit of the file.
    most : int
        Largest number of rows of numbers.

    Returns
    -------
    dict of str to tuple of float
        The columns by the names in `units`.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    ValueError
        If a column is missing, has no unit or one of another dimension, a row has another length
        than the header or contains text, or there are too many rows. The message contains the
        line.
    """
    path = Path(path)
    rows = [x for x in read_rows(path, comments=True) if any(map(str.strip, x[1]))]
    header = [name.strip() for name in rows[0][1]] if rows else []
    places = {name: _place(path, header, name, unit) for name, unit in units.items()}
    if len(rows) > most + 1:
        raise InputError(
            f"{path}: at most {most:,} rows below the header are allowed, got {len(rows) - 1:,}; "
            "remove rows"
        )
    columns: dict[str, list[float]] = {name: [] for name in units}
    for line, row in rows[1:]:
        with placed(f"{path}, line {line}:"):
            if len(row) != len(header):
                raise InputError(f"{len(row)} entries, but the header has {len(header)}")
            for name, (at, given) in places.items():
                value, unit = finite(name, row[at], given), units[name]
                columns[name].append(parse(f"{value!r} {given}", unit) if unit else value)
    if not rows[1:]:
        raise InputError(f"{path}: no rows below the header")
    return {name: tuple(values) for name, values in columns.items()}


def _place(path: Path, header: list[str], name: str, unit: str) -> tuple[int, str]:
    """Return the index of a column and its unit as written in the file."""
    plain = unit in ("1", "")
    found = [
        i for i, text in enumerate(header) if text.startswith(f"{name}_") or plain and text == name
    ]
    if len(found) != 1:
        raise InputError(
            f"{path}: no column {name} with its unit, such as {name}_{unit or 's'}; the first row "
            f"is {','.join(header)!r}"
        )
    given = header[found[0]].removeprefix(name).removeprefix("_") or "1"
    with placed(f"{path}, unit of column {name}:"):
        parse(f"1 {given}", unit or given)
    return found[0], given
