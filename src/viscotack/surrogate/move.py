"""Correction of a surrogate by measured forces: a Gaussian process of its inputs.

:func:`.moving.moved` computes it from the points.
"""

from __future__ import annotations

from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

import numpy as np

from viscotack.arrays import Array


@dataclass(frozen=True, eq=False)
class Move:
    """Correction of log10 of force and work by measured forces.

    Attributes
    ----------
    points : ndarray, shape (m, inputs)
        Scaled inputs of the points.
    weights : ndarray, shape (m, 1)
        Contribution of each point.
    inverse : ndarray, shape (m, m)
        Inverse of the covariance of the points.
    shift, smooth, length : float
        Standard deviations [log10] and length of the process.
    """

    points: Array
    weights: Array
    inverse: Array
    shift: float
    smooth: float
    length: float

    def factor(self, scaled: Array) -> Array:
        """Return the factor on force and work at scaled inputs, shape (n,)."""
        return 10 ** (self._near(scaled) @ self.weights)[:, 0]

    def unknown(self, scaled: Array, confidence: float) -> Array:
        """Return the half width [log10] of the interval of the factor alone, shape (n,)."""
        quantile = NormalDist().inv_cdf((1 + confidence) / 2)
        near = self._near(scaled)
        known = (near @ self.inverse * near).mean(axis=1) * len(self.points)
        return quantile * np.sqrt(np.maximum(self.shift**2 + self.smooth**2 - known, 0.0))

    def _near(self, scaled: Array) -> Array:
        return self.shift**2 + self.smooth**2 * correlation(scaled, self.points, self.length)


def correlation(one: Any, other: Array, length: float) -> Any:
    """Return the correlations of points by a Matern process of order 3/2, shape (n, m)."""
    count = other.shape[1]
    squares = (one * one).mean(axis=1)[:, None] + (other * other).mean(axis=1)
    squared = np.maximum(squares - one @ (2 / count * other.T), 0.0) * (3 * count / length**2)
    # at a point of the process the derivative is zero
    distance = np.sqrt(squared + 1e-24)
    return (1 + distance) * np.exp(-distance)
