r"""A handful of measured, or finer, pull-off forces move what was learned: what a lab knows better.

What the answers leave over at the measured points, :math:`r = \log_{10} P - \log_{10} \hat P`, is a
Gaussian process of the logarithms of the inputs: a shift for all, which a wrong work of adhesion or
radius makes, and what changes smoothly over the range. How large and how smooth it is follows from
the points themselves, by the largest marginal likelihood over a coarse grid, with a prior that
expects little. Where no point is near, the answer is the learned one with that shift, and the
interval says how little is known (Kennedy and O'Hagan, doi:10.1093/biomet/87.1.1).
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

from . import physics
from .answers import Answers, Intervals
from .model import Surrogate
from .physics import Array
from .trust import CONFIDENCES

# Standard deviations of the shift and of the smooth part [log10], and lengths of the latter in
# halves of the range of an input; the likelihood is multiplied by exp(-deviation/_LITTLE).
_SHIFTS, _SMOOTH, _LENGTHS = (0.003, 0.03, 0.1, 0.3), (0.001, 0.01, 0.03, 0.1), (0.3, 1.0, 3.0)
_LITTLE = 0.1
# Points that are taken: what they cost grows with the cube.
MOST_POINTS = 500
# Standard deviations in half an interval, at the confidences that were measured, of a normal law.
_QUANTILES = (0.674, 0.842, 1.036, 1.282, 1.645, 1.960, 2.326)


@dataclass(frozen=True, eq=False)
class Moved:
    """A surrogate that some points have moved.

    Attributes
    ----------
    surrogate : Surrogate
        As it was learned.
    points : ndarray, shape (m, 5)
        Scaled inputs of the points.
    weights : ndarray, shape (m,)
        What each adds to the logarithm.
    inverse : ndarray, shape (m, m)
        Of the covariance of the points.
    shift, smooth, length : float
        Standard deviations [log10] and length that were found.
    """

    surrogate: Surrogate
    points: Array
    weights: Array
    inverse: Array
    shift: float
    smooth: float
    length: float

    def evaluate(self, groups: npt.ArrayLike) -> Answers:
        """Return force and work; the work is moved by as much as the force."""
        rows = np.asarray(groups, dtype=float)
        said = self.surrogate.evaluate(rows)
        factor = 10 ** (self._near(rows) @ self.weights)
        return replace(
            said,
            pull_off_force=said.pull_off_force * factor,
            work_to_pull_off=said.work_to_pull_off * factor,
        )

    def intervals(
        self, groups: npt.ArrayLike, answers: Answers, *, confidence: float = 0.9
    ) -> Intervals:
        """Return intervals that add what is not known of the shift to those that were measured.

        For a lab whose truth differs as the process expects; that cannot be measured beforehand.
        """
        rows = np.asarray(groups, dtype=float)
        held = self.surrogate.intervals(rows, answers, confidence=confidence)
        near = self._near(rows)
        known = np.einsum("ij,jk,ik->i", near, self.inverse, near)
        unknown = np.sqrt(np.maximum(self.shift**2 + self.smooth**2 - known, 0.0))
        far = _QUANTILES[CONFIDENCES.index(confidence)] * unknown

        def wider(value: Array, pair: Array) -> Array:
            half = np.hypot(np.log10(pair[:, 1] / value), far)
            return np.column_stack([value * 10**-half, value * 10**half])

        return replace(
            held,
            pull_off_force=wider(answers.pull_off_force, held.pull_off_force),
            work_to_pull_off=wider(answers.work_to_pull_off, held.work_to_pull_off),
        )

    def _near(self, rows: Array) -> Array:
        covariance = _covariance(physics.scaled(rows), self.points, self.length)
        return self.shift**2 + self.smooth**2 * covariance


def moved(
    surrogate: Surrogate, groups: npt.ArrayLike, force: npt.ArrayLike, *, error: float
) -> Moved:
    """Return a surrogate moved by measured pull-off forces.

    Parameters
    ----------
    surrogate : Surrogate
        What was learned.
    groups : array_like, shape (m, 5)
        Inputs of the points, in its range.
    force : array_like, shape (m,)
        Their pull-off forces [1.5 pi R dg0].
    error : float
        Relative standard deviation of one of them.

    Raises
    ------
    ValueError
        If the points are not some positive forces, or lie outside.

    Examples
    --------
    >>> from viscotack.surrogate.store import shipped
    >>> points = [[1.0, 0.1, 0.6, 10.0, rate] for rate in (1.0, 1e2, 1e4)]
    >>> measured = 1.2 * shipped().evaluate(points).pull_off_force
    >>> lab = moved(shipped(), points, measured, error=0.01)
    >>> other = [[1.0, 0.1, 0.6, 10.0, 30.0]]
    >>> ratio = lab.evaluate(other).pull_off_force / shipped().evaluate(other).pull_off_force
    >>> bool(abs(ratio[0] - 1.2) < 0.02)
    True
    """
    rows, measured = np.asarray(groups, dtype=float), np.asarray(force, dtype=float)
    if rows.ndim != 2 or rows.shape != (len(measured), len(physics.INPUTS)) or not len(rows):
        raise InputError(
            f"give a row of {len(physics.INPUTS)} inputs for each force, got {rows.shape} and "
            f"{measured.shape}"
        )
    if len(rows) > MOST_POINTS:
        raise InputError(f"at most {MOST_POINTS} points are taken, got {len(rows)}; thin them out")
    if not (np.all(np.isfinite(measured)) and np.all(measured > 0) and error > 0):
        raise InputError("forces and their relative error must be positive numbers")
    if not np.all(inside := surrogate.inside(rows).all(axis=1)):
        raise InputError(
            f"point {int(np.argmin(inside))} lies outside the range that was learned from: "
            f"{rows[int(np.argmin(inside))].tolist()}"
        )
    left = np.log10(measured / surrogate.evaluate(rows).pull_off_force)
    points, noise = physics.scaled(rows), (error / np.log(10)) ** 2
    best: tuple[float, Moved] | None = None
    for shift, smooth, length in itertools.product(_SHIFTS, _SMOOTH, _LENGTHS):
        covariance = shift**2 + smooth**2 * _covariance(points, points, length)
        factor = np.linalg.cholesky(covariance + noise * np.eye(len(left)))
        inverse = np.linalg.inv(factor).T @ np.linalg.inv(factor)
        likely = -0.5 * left @ inverse @ left - np.log(np.diag(factor)).sum()
        likely -= (shift + smooth) / _LITTLE
        if best is None or likely > best[0]:
            found = Moved(surrogate, points, inverse @ left, inverse, shift, smooth, length)
            best = (float(likely), found)
    assert best is not None
    return best[1]


def _covariance(one: Array, other: Array, length: float) -> Array:
    """Return the correlations of points, a Matern process of order 3/2."""
    distance = np.sqrt(((one[:, None] - other[None]) ** 2).sum(axis=2)) * np.sqrt(3) / length
    return (1 + distance) * np.exp(-distance)
