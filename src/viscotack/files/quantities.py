"""Tables of quantities in CSV files, each with its unit at the end of the column's name."""

import os
from collections.abc import Mapping
from pathlib import Path

from viscotack.errors import InputError
from viscotack.units import finite, parse

from .text import read_rows

# Rows of a table that states a curve; more of them say no more.
MOST_ROWS = 10_000


def read_quantities(
    path: str | os.PathLike[str], units: Mapping[str, str], *, most: int = MOST_ROWS
) -> dict[str, tuple[float, ...]]:
    """Return the columns of a CSV file in SI.

    Parameters
    ----------
    path : path
        A first row with the names of the columns and their units, such as ``gap_nm,traction_kPa``,
        then a row of numbers for each point. Lines that begin with ``#`` are skipped.
    units : mapping
        Name of each wanted column, without its unit -> SI unit of the answer.
    most : int
        How many rows of numbers there may be.

    Returns
    -------
    dict of str to tuple of float
        The columns, by the names of `units`.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If a column is missing, has no unit or the wrong one, a row is not as long as the header
        or has something that is not a number, or there are too many rows; with the line.
    """
    path = Path(path)
    header, rows = read_rows(path)
    places = {name: _place(path, header, name, unit) for name, unit in units.items()}
    if len(rows) > most:
        raise InputError(
            f"{path}: at most {most:,} rows below the header are taken, got {len(rows):,}; leave "
            "out rows"
        )
    columns: dict[str, list[float]] = {name: [] for name in units}
    for line, row in rows:
        try:
            if len(row) != len(header):
                raise InputError(f"{len(row)} entries, and the header has {len(header)}")
            for name, (at, given) in places.items():
                value = finite(name, row[at], given)
                columns[name].append(parse(f"{value!r} {given}", units[name]))
        except ValueError as error:
            raise InputError(f"{path}, line {line}: {error}") from None
    if not rows:
        raise InputError(f"{path}: there are no rows below the header")
    return {name: tuple(values) for name, values in columns.items()}


def _place(path: Path, header: list[str], name: str, unit: str) -> tuple[int, str]:
    """Return where a column is, and its unit as the file states it."""
    found = [i for i, text in enumerate(header) if text.startswith(f"{name}_")]
    if len(found) != 1:
        raise InputError(
            f"{path}: one column must be {name} with its unit, such as {name}_{unit}; the first "
            f"row is {','.join(header)!r}"
        )
    given = header[found[0]].removeprefix(f"{name}_")
    try:
        parse(f"1 {given}", unit)
    except ValueError as error:
        raise InputError(f"{path}, the name of the column {name}: {error}") from None
    return found[0], given
