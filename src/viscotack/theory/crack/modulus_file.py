"""Read a measured complex modulus from a CSV file with units in the column names."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from viscotack.errors import InputError
from viscotack.files.text import read_rows
from viscotack.theory._checks import WIDEST_GAP
from viscotack.units import parse

from .tabulated_modulus import TabulatedModulus

_ANGULAR, _TURNS = "angular_frequency", "frequency"
_MODULI = ("storage", "loss")
_EXAMPLE = "frequency_Hz,storage_MPa,loss_MPa"


def read_modulus(path: str | os.PathLike[str], *, rubbery_modulus: float) -> TabulatedModulus:
    r"""Read the table of a file, for :mod:`viscotack.theory.crack.tabulated_modulus`.

    Parameters
    ----------
    path : path
        First row such as ``frequency_Hz,storage_MPa,loss_MPa``, in any order, then one row per
        frequency, ascending, at most a decade apart. ``angular_frequency_rad/s`` may replace
        ``frequency_Hz``; any suitable unit is allowed. Lines that begin with ``#`` are ignored.
    rubbery_modulus : float
        Rubbery plateau E0 [Pa].

    Returns
    -------
    TabulatedModulus
        Angular frequencies [rad/s], storage and loss modulus [Pa].

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    ValueError
        If the header or a row is not as described; the message names the line.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from viscotack.theory import tabulated_modulus
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "dma.csv"
    ...     _ = file.write_text(
    ...         "angular_frequency_rad/s,storage_MPa,loss_kPa\n"
    ...         "0.1,1.01,30\n1,1.1,200\n10,2,900\n100,4,3000\n"
    ...     )
    ...     rubber = read_modulus(file, rubbery_modulus=1e6)
    >>> low, high = tabulated_modulus.amplification(1.0, modulus=rubber)
    >>> f"{low:.3f} to {high:.3f}"
    '1.357 to 1.374'
    """
    path = Path(path)
    header, rows = read_rows(path)
    factors, order = _columns(path, header)
    table = []
    for line, row in rows:
        try:
            values = [float(x) for x in row]
        except ValueError:
            values = []
        if len(values) != len(order) or not np.all(np.isfinite(values)):
            raise InputError(
                f"{path}, line {line}: a row must be {len(order)} numbers with decimal points, got "
                f"{','.join(row)!r}; remove rows without measurements"
            )
        _check_step(path, line, table[-1][order[0]] if table else None, values[order[0]])
        table.append(values)
    columns = np.reshape(np.array(table, dtype=float), (-1, len(order)))[:, order] * factors
    try:
        return TabulatedModulus(rubbery_modulus, *(tuple(c.tolist()) for c in columns.T))
    except ValueError as error:
        raise InputError(f"{path}: {error}") from None


def _columns(path: Path, header: list[str]) -> tuple[list[float], list[int]]:
    """Return the factors to rad/s and Pa, and the columns of frequency, storage and loss."""
    found: dict[str, tuple[float, int]] = {}
    for place, title in enumerate(header):
        name = next((x for x in (_ANGULAR, _TURNS, *_MODULI) if title.startswith(f"{x}_")), "")
        words = title.removeprefix(f"{name}_").replace("_per_", "/")
        try:
            if name in (_ANGULAR, _TURNS):
                turn = 2 * np.pi if name == _TURNS else 1.0
                found[_TURNS] = (turn * parse(f"1 {words}", "1/s"), place)
            elif name:
                found[name] = (parse(f"1 {words}", "Pa"), place)
        except ValueError as error:
            raise InputError(f"{path}, the column {title}: {error}") from None
    if len(header) != 3 or len(found) != 3:
        raise InputError(
            f"{path}: the first row must name frequency, storage and loss with their units, such "
            f"as '{_EXAMPLE}' or '{_ANGULAR}_rad/s' for the first, got {','.join(header)!r}"
        )
    factors, order = zip(*(found[name] for name in (_TURNS, *_MODULI)), strict=True)
    return list(factors), list(order)


def _check_step(path: Path, line: int, before: float | None, now: float) -> None:
    """Raise an error for a frequency that does not ascend or leaves a gap."""
    if before is None or before <= 0:
        return
    if now <= before:
        raise InputError(
            f"{path}, line {line}: the frequency {now:g} comes after {before:g}; sort the table "
            "and merge overlapping sweeps into one master curve"
        )
    gap = np.log10(now / before)
    if gap > WIDEST_GAP * (1 + 1e-9):
        raise InputError(
            f"{path}, line {line}: a gap of {gap:.2g} decades between the frequencies {before:g} "
            f"and {now:g}; at most {WIDEST_GAP:g} decade may lie between two rows"
        )
