r"""Interpolate ratios of forces over work of adhesion and range, from few interfaces.

A Gaussian process in :math:`x = (\ln w, \ln h_0)`, scaled, with the covariance

.. math:: k(x, y) = a^2 + b^2\, x\cdot y + c^2 e^{-|x - y|^2/2} ,

a plane with a smooth deviation from it. It passes through any number of points. The error is that
of each point when it is left out (Rasmussen and Williams, Gaussian Processes for Machine Learning
(2006), Eq. 5.12).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array

from .machine_compliance import Yielding

# Lengths in ln of work and range over which the deviation changes.
LENGTHS = np.array([0.5, 1.2])
# Standard deviations of ln(ratio): constant, slopes, deviation, and scatter of single values.
_CONSTANT, _SLOPE, _DEVIATION, _SCATTER = 0.5, 0.3, 0.1, 1e-3


def scaled(work: Any, gap: Any) -> Array:
    """Return interfaces as points, shape (..., 2), from work [J/m2] and range [m]."""
    return np.stack([np.log(work), np.log(gap)], axis=-1) / LENGTHS


def _kernel(x: Array, y: Array) -> Array:
    square = np.sum((x[..., :, None, :] - y) ** 2, axis=-1)
    return _CONSTANT**2 + _SLOPE**2 * x @ y.T + _DEVIATION**2 * np.exp(-square / 2)


@dataclass(frozen=True, eq=False)
class SmoothRatio:
    """Ratios of forces of several tests as functions of the interface.

    Parameters
    ----------
    points : ndarray, shape (N, 2)
        Interfaces at which the ratios are known, from :func:`scaled`.
    weights : ndarray, shape (N, tests)
        Weights of the points; 0 where a ratio is not known.
    left_out : ndarray, shape (N, tests)
        Error of ln(ratio) at each point when it is left out; nan where it is not known.
    """

    points: Array
    weights: Array
    left_out: Array

    @classmethod
    def through(cls, points: Array, log_ratio: Array) -> "SmoothRatio":
        """Interpolate ln(ratio), shape (N, tests), nan where it is not known."""
        middle = points.mean(axis=0)
        weights, left_out = np.zeros(log_ratio.shape), np.full(log_ratio.shape, np.nan)
        for test, column in enumerate(log_ratio.T):
            at = np.flatnonzero(np.isfinite(column))
            near = points[at] - middle
            inverse = np.linalg.inv(_kernel(near, near) + _SCATTER**2 * np.eye(at.size))
            weights[at, test] = inverse @ column[at]
            left_out[at, test] = weights[at, test] / np.diag(inverse)
        return cls(points, weights, left_out)

    def __call__(self, values: Mapping[str, Any]) -> Array:
        """Return the ratios of one interface, shape (tests,), or of many, shape (M, tests)."""
        x = scaled(values["work_of_adhesion"], values["equilibrium_gap"])
        return self.at(x.reshape(-1, 2)).reshape(*x.shape[:-1], -1)

    def at(self, points: Array) -> Array:
        """Return the ratios at points, shape (M, tests)."""
        middle = self.points.mean(axis=0)
        return np.exp(_kernel(points - middle, self.points - middle) @ self.weights)


@dataclass(frozen=True, eq=False)
class Mixed:
    """Ratios of all tests: some interpolated between tiers, the others of a compliant machine.

    Parameters
    ----------
    others : Yielding
        Ratios by theory near one interface.
    mixed : ndarray of int
        Indices of the tests that are interpolated.
    ratio : SmoothRatio
        Their ratios.
    """

    others: Yielding
    mixed: npt.NDArray[np.intp]
    ratio: SmoothRatio

    def __call__(self, values: Mapping[str, Any]) -> Array:
        """Return the ratios of one interface, shape (S,), or of many, shape (N, S)."""
        found = np.array(self.others(values))
        found[..., self.mixed] = self.ratio(values)
        return found
