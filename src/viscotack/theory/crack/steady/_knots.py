"""Interpolation between computed cracks that depends on a fixed number of neighbours only.

Cracks are computed on demand, from the slowest on. A cubic spline through all computed ones would
change everywhere with each further crack, so an answer would depend on earlier calls. Here each
piece is a cubic with given values and slopes at its ends, and each slope is that of the polynomial
of fourth degree through five neighbours. A piece is final when :data:`AHEAD` more cracks are known.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from threading import RLock
from typing import Any

import numpy as np
import scipy

from viscotack.arrays import Array

# Cracks that must be known above a speed for the value there, and for its stated error.
AHEAD, AHEAD_FOR_ERROR = 3, 5
# Slopes at each of five equidistant knots from the values at all of them.
_SLOPES = (
    np.array(
        [
            [-25, 48, -36, 16, -3],
            [-3, -10, 18, -6, 1],
            [1, -8, 0, 8, -1],
            [-1, 6, -18, 10, 3],
            [3, -16, 36, -48, 25],
        ]
    )
    / 12
)
# Stated multiple of the leading term of the interpolation error, and the knots on either side
# from which the largest is taken.
_STATED, _NEAR = 4, 3
# Points of an inverse between two knots.
FINE = 16
# One thread at a time computes further cracks. Not in the objects, which can be pickled.
_LOCK = RLock()


def alone(method: Callable[..., Any]) -> Callable[..., Any]:
    """Let one thread at a time call the decorated methods, which extend shared cracks."""

    @wraps(method)
    def locked(*arguments: Any, **options: Any) -> Any:
        with _LOCK:
            return method(*arguments, **options)

    return locked


def between(x: Array) -> Array:
    """Return 16 points from each knot to the next, and the last knot."""
    place = np.arange(FINE * (x.size - 1) + 1) / FINE
    return np.interp(place, np.arange(x.size), x)


def curve(x: Array, y: Array) -> Any:
    """Return the interpolation of values at equidistant knots.

    Examples
    --------
    A further knot does not change a piece that three knots follow.

    >>> x = np.arange(8.0)
    >>> float(curve(x, x**5)(3.5) - curve(x[:7], x[:7] ** 5)(3.5))
    0.0
    """
    n = x.size
    if n < 5:
        return scipy.interpolate.CubicSpline(x, y)
    first = np.clip(np.arange(n) - 2, 0, n - 5)
    row = np.arange(n) - first
    slope = sum(_SLOPES[row, j] * y[first + j] for j in range(5)) / (x[1] - x[0])
    return scipy.interpolate.CubicHermiteSpline(x, y, slope)


def stated(y: Array, place: Array) -> Array:
    """Return the stated interpolation error at places in the list of knots, such as 3.5.

    The error of a piece is its fourth difference over 384; the largest nearby is multiplied by 4.

    Examples
    --------
    >>> y = np.arange(9.0) ** 4
    >>> float(stated(y, np.array(4.5))), abs(float(curve(np.arange(9.0), y)(4.5)) - 4.5**4)
    (0.25, 0.0625)
    """
    fourth = np.abs(np.diff(y, 4)) / 384
    at = np.arange(fourth.size) + 2.0
    near = [float(np.max(fourth[np.abs(at - u) < _NEAR], initial=0.0)) for u in place.flat]
    return _STATED * np.reshape(near, place.shape)
