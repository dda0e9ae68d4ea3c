"""Read a Prony series from a CSV file."""

import os
from pathlib import Path

from viscotack.errors import InputError
from viscotack.files.text import read_rows
from viscotack.units import parse, positive


def read_prony(path: str | os.PathLike[str]) -> tuple[tuple[tuple[float, float], ...], str]:
    """Read the branches of a Prony series from a CSV file, and the unit of their times.

    Parameters
    ----------
    path : path
        First row ``modulus_ratio,relaxation_time_s``, then one row per branch: its modulus over the
        rubbery modulus, and its relaxation time. The unit ``s`` may be any unit of time (``ms``,
        ``h``); ``relaxation_time`` without a unit means dimensionless times. Lines that begin with
        ``#`` are ignored.

    Returns
    -------
    tuple of (float, float), str
        Branches as (modulus ratio, relaxation time in the file's unit), and that unit ("1" for
        pure numbers).

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    ValueError
        If the header or a row is not as described; the message names the line.
    """
    path = Path(path)
    header, rows = read_rows(path)
    if (
        len(header) != 2
        or header[0] != "modulus_ratio"
        or not header[1].startswith("relaxation_time")
    ):
        raise InputError(
            f"{path}: the first row must be 'modulus_ratio,relaxation_time_s' (or another unit of "
            f"time), got {','.join(header)!r}"
        )
    unit = header[1].removeprefix("relaxation_time").removeprefix("_") or "1"
    if unit != "1":
        try:
            parse(f"1 {unit}", "s")
        except ValueError as error:
            raise InputError(f"{path}, the name of the second column: {error}") from None
    branches = []
    for line, row in rows:
        try:
            if len(row) != 2:
                raise InputError(f"a row must be a modulus ratio and a time, got {','.join(row)!r}")
            ratio, time = row
            branches.append((positive("modulus_ratio", ratio, "1"), positive("time", time, unit)))
        except ValueError as error:
            raise InputError(f"{path}, line {line}: {error}") from None
    if not branches:
        raise InputError(f"{path}: the file has no branch below the header")
    return tuple(branches), unit
