r"""How soft and how stiff a solid may be whose spectrum nobody knows: intervals of its plateaus.

A series of arms says of a plateau what its few times allow, and a bootstrap on the same times
cannot know that others would do as well. Here the plateau is moved, and at each place the best
series on a *dense* grid is sought, none of its moduli negative, until the sum of squares has grown
too far: the profile of a linear quantity under bounds (Rust & Burrus, Mathematical Programming and
the Numerical Solution of Linear Equations, 1972). Each step is a linear problem.

How far is too far no table says: under bounds the growth follows no chi square (Batlle, Stanley,
Patil, Kuusela & Owhadi, arXiv:2310.02461). It is measured. Moduli are made from the series at the
end, with errors such as the residuals have (:mod:`.fit_errors`), and it is counted how far the sum
of squares grows when such numbers are asked for the plateau that they were made with: the way of
Feldman & Cousins, doi:10.1103/PhysRevD.57.3873, on each side by itself.

What is sought is the modulus at the ends of the grid, half a decade beyond the measurement (in a
test over time not before its first point: a creep that has ended by then is no creep that anybody
saw); what the solid does further out no measurement can say, and a modulus that still changes there
is a bound only (:func:`open_ends`).
"""

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq
from scipy.stats import norm

from viscotack.arrays import Array

from .nonnegative import nonnegative
from .observed import Observed

# A modulus that changes by more than this share a decade is on no plateau.
PLATEAU = 0.05
_HELD = 1e3  # weight of the plateau that is held, beside numbers of about 0.01
_ENDLESS = 1e4  # times the fitted plateau from which on there is no end
NAMES = ("rubbery_modulus", "glassy_modulus")


def change(data: Observed, material: Any, name: str) -> float:
    """Return by which share a decade the modulus still changes at the end next to a plateau."""
    slow = name == "rubbery_modulus"
    if data.in_frequency:
        modulus = complex(material.complex_modulus(data.frequencies[0 if slow else 1]))
        # d ln E'/d ln omega is about 2/pi times the loss angle
        return float(10 ** (2 / np.pi * np.angle(modulus)) - 1)
    end = data.at[-1] if slow else data.at[0]
    ratio = data.predicted(material, [end / np.sqrt(10), end * np.sqrt(10)])[0]
    return float(np.exp(abs(np.log(ratio[1] / ratio[0]))) - 1)


def open_ends(data: Observed, material: Any) -> tuple[str, ...]:
    """Return the plateaus that were not measured."""
    return tuple(name for name in NAMES if change(data, material, name) > PLATEAU)


class Plateau:
    """A linear quantity of the weights on a dense grid, and how far the numbers let it move.

    Parameters
    ----------
    columns : ndarray, shape (M, n)
        What each weight of 1 adds to the numbers, over model and noise.
    numbers : ndarray, shape (M,)
        The numbers, in the same way.
    sums : ndarray, shape (n,)
        The quantity is ``sums @ weights``.
    errors : ndarray, shape (B, M)
        Errors drawn at random, over their noise.
    """

    def __init__(self, columns: npt.NDArray, numbers: Array, sums: Array, errors: Array):
        # one triangle stands for all numbers
        frame, self._columns = np.linalg.qr(columns)
        self._sums, self._numbers, self._errors = sums, frame.T @ numbers, errors @ frame
        self._least, best = self._nearest(self._numbers)
        self._middle = float(sums @ best)

    def end(self, side: int, tail: float) -> float:
        """Return the quantity beyond which the numbers are as unlikely as the tail, on a side.

        0 or inf where the sum of squares never grows so much.
        """
        if self._middle <= 0:
            return 0.0 if side < 0 else np.inf
        # first as if a chi square did, then as numbers made there do
        guess = self._reached(side, float(norm.isf(tail)) ** 2 * self._size)
        at = guess if 0 < guess < np.inf else self._middle
        return self._reached(side, self._allowed(at, side, tail))

    @property
    def _size(self) -> float:
        """Mean square of the errors in each direction that the weights can follow."""
        return float(np.mean(self._errors**2))

    def _nearest(self, numbers: Array, value: float | None = None) -> tuple[float, Array]:
        """Return the smallest sum of squares, with the quantity held or not, and its weights."""
        columns, wanted = self._columns, numbers
        if value is not None:
            row = _HELD * self._sums / value
            columns, wanted = np.vstack((columns, row)), np.append(numbers, _HELD)
        found = nonnegative(columns, wanted)
        return float(np.sum((self._columns @ found - numbers) ** 2)), found

    def _allowed(self, value: float, side: int, tail: float) -> float:
        """Return by how much the sum of squares grows by chance where the quantity has a value."""
        made = self._columns @ self._nearest(self._numbers, value)[1]
        growth = []
        for each in self._errors:
            least, best = self._nearest(made + each)
            grown = max(self._nearest(made + each, value)[0] - least, 0.0)
            # the end on the left is where numbers made there lie to the right by chance
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
