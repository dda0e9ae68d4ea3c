"""Persson-Brener integral over a table of the loss compliance, and its inversion.

The loss compliance is a power law between two rows, so I, its integral over ln omega, is explicit;
the integral of I(omega_c sin theta) sin theta is smooth between the angles of the rows.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from viscotack.arrays import Array
from viscotack.theory._roots import regula_falsi

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_CLOSE = 1e-13
_BLOCK = 2**18


class Table(NamedTuple):
    """Frequencies, E0 C'' there, I at the first row, and whether I falls to zero with omega."""

    frequencies: Array
    loss: Array
    start: float
    linear_below: bool


def rest(cutoff: Array, table: Table) -> Array:
    """Return 1/Gamma at cut-offs within the table."""
    w, loss, start, linear_below = table
    width = np.diff(np.log(w))
    slope = np.diff(np.log(loss)) / width
    total = start + np.append(0.0, np.cumsum(loss[:-1] * width * _mean(slope * width)))
    edges = np.arcsin(np.minimum(w / cutoff[:, None], 1.0))
    # rows above the cut-off contribute nothing
    half = np.diff(edges)[..., None] / 2
    angle = edges[:, :-1, None] + half * (1 + _NODES)
    x = np.log(cutoff[:, None, None] * np.sin(angle) / w[:-1, None])
    inside = total[:-1, None] + loss[:-1, None] * x * _mean(slope[:, None] * x)
    found = np.sum(inside * np.sin(angle) * half * _WEIGHTS, axis=(1, 2))
    first = edges[:, 0]
    if linear_below:
        found += start * (first / 2 - np.sin(2 * first) / 4) / np.sin(first)
    else:
        found += start * (1 - np.cos(first))
    return 1 - 2 / np.pi * found


def solved(speed: Array, table: Table) -> Array:
    """Return Gamma at speeds v/l0 whose cut-offs lie in the table, in blocks."""
    flat = np.ravel(speed)
    size = max(1, _BLOCK // (_NODES.size * table.loss.size))
    blocks = [_solved(flat[i : i + size], table) for i in range(0, flat.size, size)]
    return np.concatenate([*blocks, []]).reshape(np.shape(speed))


def _mean(y: Array) -> Array:
    """Return (e^y - 1)/y, the mean of a power law over a panel."""
    return np.where(np.abs(y) < 1e-8, 1 + y / 2, np.expm1(y) / np.where(y == 0, 1.0, y))


def _solved(speed: Array, table: Table) -> Array:
    """Return Gamma at speeds; the speed rises with the cut-off, so two rows bracket it."""
    rows = table.frequencies
    aim = np.log(2 * np.pi * speed)
    at_rows = np.log(rows / rest(rows, table))
    i = np.clip(np.searchsorted(at_rows, aim) - 1, 0, rows.size - 2)

    def miss(log_cutoff: Array) -> Array:
        return log_cutoff - np.log(rest(np.exp(log_cutoff), table)) - aim

    found = regula_falsi(miss, np.log(rows[i]), np.log(rows[i + 1]), noise=_CLOSE)
    return 1 / rest(np.exp(found), table)
