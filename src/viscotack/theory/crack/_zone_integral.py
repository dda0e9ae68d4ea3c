r"""Greenwood's law over a table of the loss compliance: kernel, integral and inversion.

With :math:`E_0 C(t) = 1 - \frac{2 E_0}{\pi} \int C''(\omega) \cos \omega t \, d\ln\omega` the
energy of the zone is

.. math:: \frac1\Gamma = 1 - \frac{2 E_0}{\pi} \int_0^\infty C''(\omega) \, Q(\omega A) \,
          d\ln\omega, \quad A = \frac{l \Gamma}{v}, \quad
          Q(y) = \mathrm{Re} \, {}_2F_2(1, 1; \tfrac32, 2; -i y)

with 0 < Q <= 1. On a grid uniform in ln omega and in ln A the integral is a convolution, and
everything is explicit at a given A.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from viscotack.arrays import Array

# Step in ln omega: six nodes per period of Q where Q is last resolved.
_STEP, _FULL = 0.005, 200.0
# Below this Q is 1 - y^2/11.25 to round-off.
_TINY = 1e-4
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


class Bounds(NamedTuple):
    """Passage times A, ascending, with a lower and an upper bound of 1/Gamma."""

    passage: Array
    least: Array
    most: Array


def bounds(frequencies: Array, loss: Array, *, below: tuple[float, float], above: float) -> Bounds:
    """Return bounds of 1/Gamma for passage times between the inverse ends of the table.

    ``below`` are bounds of the integral of E0 C'' over ln omega below the table, ``above`` the
    upper bound above it.
    """
    rows = np.log(frequencies)
    width = rows[-1] - rows[0]
    count = int(np.ceil(width / _STEP))
    x = np.linspace(rows[0], rows[-1], count + 1)
    # a power law between two rows
    inner = np.exp(np.interp(x, rows, np.log(loss))) * (x[1] - x[0])
    inner[[0, -1]] /= 2
    y = np.exp(np.linspace(-width, width, 2 * count + 1))
    Q = kernel(y)
    # entry i belongs to ln A = ln A_0 + i step, and needs Q from i to i + count
    size = Q.size + count
    spectrum = np.fft.rfft(Q, size) * np.fft.rfft(inner[::-1], size)
    table = np.fft.irfft(spectrum, size)[count : 2 * count + 1]
    # the extremes of Q beyond each entry
    nearer = np.minimum.accumulate(Q)[: count + 1]
    beyond = np.maximum.accumulate(Q[::-1])[::-1][count:]
    part = 2 / np.pi
    most = 1 - part * (table + below[0] * nearer)
    least = 1 - part * (table + below[1] + above * beyond)
    # the creep under the zone grows with the passage time, and so does 1/Gamma
    most = np.minimum.accumulate(most[::-1])[::-1]
    least = np.maximum.accumulate(least)
    passage = np.exp(x - rows[0] - rows[-1])
    known = least > 0
    return Bounds(passage[known], least[known], most[known])


def ends(curves: Bounds) -> tuple[float, float]:
    """Return the slowest and the fastest v/l covered by both bounds."""
    speeds = [1 / (inverse * curves.passage) for inverse in (curves.least, curves.most)]
    return float(max(v[-1] for v in speeds)), float(min(v[0] for v in speeds))


def kernel(y: Array) -> Array:
    """Return Q at ascending arguments that are uniform in the logarithm."""
    Q = 1 - y**2 / 11.25
    middle = (y > _TINY) & (y <= _FULL)
    large = y > _FULL
    if np.any(middle):
        # (2/alpha) int_0^sqrt(alpha) D(x) dx on the ray alpha = i y, panel by panel
        s = np.sqrt(np.append(0.0, y[middle]))
        half = np.diff(s) / 2
        at = s[:-1, None] + half[:, None] * (1 + _NODES)
        turn = np.exp(0.25j * np.pi)
        integral = np.cumsum(scipy.special.dawsn(turn * at) @ _WEIGHTS * half) * turn
        Q[middle] = np.real(2 * integral / (1j * y[middle]))
    # neglect the oscillations: they decay as y^(-3/2), and their integral is below y^(-5/2)
    Q[large] = np.pi / (4 * y[large]) + 1 / (4 * y[large] ** 2)
    return Q


def solved(speed: Array, passage: Array, inverse: Array) -> Array:
    """Return Gamma at speeds v/l, for 1/Gamma at passage times: v/l = Gamma/A."""
    gamma = 1 / inverse
    aim = np.log(gamma / passage)
    return np.exp(np.interp(np.log(speed), aim[::-1], np.log(gamma)[::-1]))
