r"""Ratios of pull-off forces to those of a relaxed contact and a rigid machine by theory.

Tables of forces (:mod:`.interpolated_forces`) are for relaxed contacts and rigid machines. While
the tension grows, a compliant machine stretches, so the sphere moves more slowly than the drive:
:class:`Yielding` is the effect near one interface. The logarithm of this ratio is nearly
proportional to the compliance, so its product with the relative uncertainty of the compliance is an
error common to all forces.

Where tests are simulated, the ratio is known at a few interfaces. :class:`SmoothRatio` interpolates
by a Gaussian process in :math:`x = (\ln w, \ln h_0)`, scaled, with the covariance

.. math:: k(x, y) = a^2 + b^2\, x\cdot y + c^2 e^{-|x - y|^2/2} ,

a plane with a smooth deviation from it. Its error is that of each point when it is left out
(Rasmussen and Williams, Gaussian Processes for Machine Learning (2006), Eq. 5.12).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array

from .forward import Changed, Forward, Interface
from .rate_series import RateSeries

# |ln ratio| above which derivatives are computed, and steps in ln of work and range.
_FAR, _WORK, _GAP = 0.1, 0.1, -0.3
# Lengths in ln of work and range over which the deviation from a plane changes.
LENGTHS = np.array([0.5, 1.2])
# Standard deviations of ln(ratio): constant, slopes, deviation, and scatter of single values.
_CONSTANT, _SLOPE, _DEVIATION, _SCATTER = 0.5, 0.3, 0.1, 1e-3


@dataclass(frozen=True, eq=False)
class Yielding:
    """Ratio of forces with a compliant machine to those with a rigid one.

    Parameters
    ----------
    log_ratio : ndarray, shape (S,)
        ln of the ratio at the reference interface; of tests without an answer by theory that of the
        nearest speeds with one.
    slopes : ndarray, shape (2, S)
        Derivatives with respect to ln of the work of adhesion and of the range.
    work, gap : float
        Reference interface [J/m2] and [m].
    """

    log_ratio: Array
    slopes: Array
    work: float = 1.0
    gap: float = 1.0

    @classmethod
    def of_a_rigid_machine(cls, speeds: int) -> "Yielding":
        """Return the ratios of a rigid machine, which are 1."""
        return cls(np.zeros(speeds), np.zeros((2, speeds)))

    def __call__(self, values: Mapping[str, Any]) -> Array:
        """Return the ratios of one interface, shape (S,), or of many, shape (N, S)."""
        if not self.slopes.any():
            shape = (*np.shape(values["work_of_adhesion"]), self.log_ratio.size)
            return np.broadcast_to(np.exp(self.log_ratio), shape)
        work, gap = (np.asarray(values[x]) for x in ("work_of_adhesion", "equilibrium_gap"))
        away = np.stack([np.log(work / self.work), np.log(gap / self.gap)], axis=-1)
        return np.exp(self.log_ratio + away @ self.slopes)


def yielding_near(
    series: RateSeries, forward: Forward, interface: Interface
) -> tuple[Yielding, Changed]:
    """Compute the effect of the machine near an interface, and at the interface."""
    work, gap, growth = interface
    speed, load, stiffness = series.speed, series.load, series.stiffness

    def log_ratio(w: float, h0: float) -> tuple[Array, Changed]:
        found = forward.changed(w, h0, speed, load, stiffness=stiffness, growth=growth)
        return np.log(found.ratio), found

    middle, changed = log_ratio(work, gap)
    slopes = np.zeros((2, speed.size))
    if np.max(np.abs(middle)) > _FAR:
        beside = (
            (log_ratio(work * np.exp(_WORK), gap), _WORK),
            (log_ratio(work, gap * np.exp(_GAP)), _GAP),
        )
        for row, ((other, there), step) in zip(slopes, beside, strict=True):
            row[there.holds] = (other - middle)[there.holds] / step
    told = [i for i in np.argsort(speed) if changed.holds[i]]
    if told:
        middle = np.interp(np.log(speed), np.log(speed[told]), middle[told])
    return Yielding(middle, slopes, work, gap), changed


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

    def at(self, points: Array) -> Array:
        """Return the ratios at points, shape (M, tests)."""
        middle = self.points.mean(axis=0)
        return np.exp(_kernel(points - middle, self.points - middle) @ self.weights)


@dataclass(frozen=True, eq=False)
class Mixed:
    """Ratios of all tests: some interpolated between interfaces, the others of a machine.

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
        x = scaled(values["work_of_adhesion"], values["equilibrium_gap"])
        found[..., self.mixed] = self.ratio.at(x.reshape(-1, 2)).reshape(*x.shape[:-1], -1)
        return found
