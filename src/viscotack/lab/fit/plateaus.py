r"""Intervals of the rubbery and glassy plateau of a solid with an unknown spectrum.

A Prony series with few times restricts its plateaus, and a bootstrap on the same times does not
include the uncertainty of these times. Here the plateau is varied; for each value the best
non-negative series on a *dense* grid is computed, until the sum of squares exceeds its limit: the
profile of a linear quantity under bounds (Rust & Burrus, Mathematical Programming and
the Numerical Solution of Linear Equations, 1972). Each step is a linear problem.

Under bounds the growth does not follow a chi-square distribution (Batlle, Stanley,
Patil, Kuusela & Owhadi, arXiv:2310.02461), so the limit is simulated: synthetic moduli are
generated from the series at the end of the interval, with the errors of the residuals
(:mod:`.errors`), and the growth of their sum of squares at the true plateau is recorded
(Feldman & Cousins, doi:10.1103/PhysRevD.57.3873), separately on each side.

The quantity is the modulus at the ends of the grid, half a decade beyond the measurement (for a
test over time, not before its first point, because earlier creep is not observed). Response
further out cannot be determined. A modulus that still changes at an end gives only a bound
(:func:`open_ends`).
"""

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq
from scipy.stats import norm

from viscotack.arrays import Array

from .nonnegative import nonnegative
from .observed import Observed

# A modulus that changes by more than this fraction per decade has not reached a plateau.
PLATEAU = 0.05
_HELD = 1e3  # weight that fixes the plateau; the numbers are about 0.01
_ENDLESS = 1e4  # ratio to the fitted plateau above which there is no bound
NAMES = ("rubbery_modulus", "glassy_modulus")


def change(data: Observed, material: Any, name: str) -> float:
    """Return the relative change of the modulus per decade at the end next to a plateau."""
    slow = name == "rubbery_modulus"
    if data.in_frequency:
        modulus = complex(material.complex_modulus(data.frequencies[0 if slow else 1]))
        # d ln E'/d ln omega is about 2/pi times the loss angle
        return float(10 ** (2 / np.pi * np.angle(modulus)) - 1)
    end = data.at[-1] if slow else data.at[0]
    ratio = data.predicted(material, [end / np.sqrt(10), end * np.sqrt(10)])[0]
    return float(np.exp(abs(np.log(ratio[1] / ratio[0]))) - 1)


def open_ends(data: Observed, material: Any) -> tuple[str, ...]:
    """Return the names of the plateaus that the measurement does not reach."""
    return tuple(name for name in NAMES if change(data, material, name) > PLATEAU)


class Plateau:
    """A linear quantity of the weights on a dense grid, with its profile.

    Parameters
    ----------
    columns : ndarray, shape (M, n)
        Contribution of a unit weight to each number, over model and noise.
    numbers : ndarray, shape (M,)
        The numbers, scaled in the same way.
    sums : ndarray, shape (n,)
        The quantity is ``sums @ weights``.
    errors : ndarray, shape (B, M)
        Random errors, over their noise.
    """

    def __init__(self, columns: npt.NDArray, numbers: Array, sums: Array, errors: Array):
        # QR: a triangular matrix replaces all rows
        frame, self._columns = np.linalg.qr(columns)
        self._sums, self._numbers, self._errors = sums, frame.T @ numbers, errors @ frame
        self._least, best = self._nearest(self._numbers)
        self._middle = float(sums @ best)

    def end(self, side: int, tail: float) -> float:
        """Return the end of the interval on one side, at a tail probability.

        The end is 0 or inf if the sum of squares never reaches its limit.
        """
        if self._middle <= 0:
            return 0.0 if side < 0 else np.inf
        # first with the chi-square limit, then with the simulated one
        guess = self._reached(side, float(norm.isf(tail)) ** 2 * self._size)
        at = guess if 0 < guess < np.inf else self._middle
        return self._reached(side, self._allowed(at, side, tail))

    @property
    def _size(self) -> float:
        """Mean square of the errors per direction that the weights can follow."""
        return float(np.mean(self._errors**2))

    def _nearest(self, numbers: Array, value: float | None = None) -> tuple[float, Array]:
        """Return the smallest sum of squares, optionally at a fixed quantity, and its weights."""
        columns, wanted = self._columns, numbers
        if value is not None:
            row = _HELD * self._sums / value
            columns, wanted = np.vstack((columns, row)), np.append(numbers, _HELD)
        found = nonnegative(columns, wanted)
        return float(np.sum((self._columns @ found - numbers) ** 2)), found

    def _allowed(self, value: float, side: int, tail: float) -> float:
        """Return the simulated limit on the growth of the sum of squares at a value."""
        made = self._columns @ self._nearest(self._numbers, value)[1]
        growth = []
        for each in self._errors:
            least, best = self._nearest(made + each)
            grown = max(self._nearest(made + each, value)[0] - least, 0.0)
            # at the lower end, only synthetic estimates above the value count
            growth.append(np.sqrt(grown) * np.sign(float(self._sums @ best) - value) * -side)
        return max(float(np.quantile(growth, 1 - tail)), 0.0) ** 2

    def _reached(self, side: int, allowed: float) -> float:
        def excess(way: float) -> float:
            value = self._middle * np.exp(side * way)
            return self._nearest(self._numbers, value)[0] - self._least - allowed

        if allowed <= 0 or excess(0.0) >= 0:
            return self._middle
        near, step = 0.0, 0.02  # in the logarithm of the quantity
        while excess(near + step) <= 0:
            near, step = near + step, 1.8 * step
            if near > np.log(_ENDLESS):
                return np.inf if side > 0 else 0.0
        way: Any = brentq(excess, near, near + step, xtol=1e-3 * step)
        return float(self._middle * np.exp(side * way))
