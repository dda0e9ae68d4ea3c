r"""Surrogate moved by the measured, or finer simulated, pull-off forces of a lab.

The residuals :math:`r = \log_{10} P - \log_{10} \hat P` at the measured points are a Gaussian
process of the logarithms of the inputs: a common shift, as by a wrong work of adhesion or radius,
and a part that changes smoothly over the range. Their sizes and the length of the smooth part
maximise the marginal likelihood of the points over a coarse grid, with a prior for small ones. Far
from all points the prediction is the learned one with the shift, and its interval contains the
uncertainty of the rest (Kennedy and O'Hagan, doi:10.1093/biomet/87.1.1).
"""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError

from .model import Surrogate

# Standard deviations of the shift and of the smooth part [log10], and lengths of the latter in
# halves of the range of an input; the likelihood is multiplied by exp(-deviation/_LITTLE).
_SHIFTS, _SMOOTH, _LENGTHS = (0.003, 0.03, 0.1, 0.3), (0.001, 0.01, 0.03, 0.1), (0.3, 1.0, 3.0)
_LITTLE = 0.1
# Largest number of points; the time increases with its cube.
MOST_POINTS = 500
# A point is suspect if its force over the learned one is this many times, or this part of, 1 or the
# median of all points.
_SUSPECT = 5.0
# Column of the measured numbers of each contact, as in a table of predictions.
MEASURED = {"sphere": "pull_off_force", "punch": "pull_off_stress"}


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


def moved(surrogate: Surrogate, columns: Mapping[str, npt.ArrayLike], *, error: float) -> Surrogate:
    """Return a surrogate moved by measured pull-off forces.

    Force and work are multiplied by the same factor, and so is a curve in tension. The result
    serves :func:`viscotack.predict` and :func:`viscotack.predict_table` as ``model``, the export to
    ONNX, and :meth:`.Surrogate.slopes`.

    Parameters
    ----------
    surrogate : Surrogate
        Of spheres on power laws or of punches.
    columns : mapping of str to array_like, shape (m,)
        The inputs of the surrogate, as in a table of cases, and `pull_off_force` [1.5 pi R dg0],
        for punches `pull_off_stress` [sigma0].
    error : float
        Relative standard deviation of a measured force.

    Raises
    ------
    ValueError
        If a column is missing or unknown, a number is not positive, a point is outside the training
        range, or there are more than ``MOST_POINTS``.

    Warns
    -----
    UserWarning
        If the force of a point over the learned one is beyond a factor of 5 from 1, or from the
        median of all points, as by a wrong unit. It is used all the same.

    Examples
    --------
    >>> from viscotack.prediction.surrogate.store import shipped
    >>> held = {"tabor": [1.0] * 3, "modulus_ratio": [0.1] * 3, "exponent": [0.6] * 3}
    >>> points = held | {"preload": [10.0] * 3, "rate": [1.0, 1e2, 1e4]}
    >>> learned = shipped().evaluate(np.column_stack(list(points.values()))).pull_off_force
    >>> lab = moved(shipped(), points | {"pull_off_force": 1.2 * learned}, error=0.01)
    >>> other = [[1.0, 0.1, 0.6, 10.0, 30.0]]
    >>> ratio = lab.evaluate(other).pull_off_force / shipped().evaluate(other).pull_off_force
    >>> bool(abs(ratio[0] - 1.2) < 0.02)
    True
    """
    rows, measured = _points(surrogate, columns)
    if not error > 0:
        raise InputError(f"error must be a positive part of the force, got {error!r}")
    surrogate = replace(surrogate, move=None)
    tests = surrogate.tests(rows)
    left = np.log10(measured / surrogate.evaluate(tests).pull_off_force)
    points, noise = tests.scaled, (error / np.log(10)) ** 2
    best: tuple[float, Move] | None = None
    for shift, smooth, length in itertools.product(_SHIFTS, _SMOOTH, _LENGTHS):
        covariance = shift**2 + smooth**2 * correlation(points, points, length)
        factor = np.linalg.cholesky(covariance + noise * np.eye(len(left)))
        half = np.linalg.inv(factor)
        inverse = half.T @ half
        likely = -0.5 * left @ inverse @ left - np.log(np.diag(factor)).sum()
        likely -= (shift + smooth) / _LITTLE
        if best is None or likely > best[0]:
            move = Move(points, (inverse @ left)[:, None], inverse, shift, smooth, length)
            best = (float(likely), move)
    assert best is not None, "there are several hyperparameters"
    _warn(left, measured)
    return replace(surrogate, move=best[1])


def _points(surrogate: Surrogate, columns: Mapping[str, npt.ArrayLike]) -> tuple[Array, Array]:
    """Return the inputs of the points, shape (m, inputs), and their measured forces."""
    contact = surrogate.contact
    if contact.name not in MEASURED:
        raise InputError(
            f"only surrogates of spheres on power laws and of punches can be moved, got one of the "
            f"contact {contact.name!r}"
        )
    wanted = (*contact.inputs, MEASURED[contact.name])
    if set(columns) != set(wanted):
        raise InputError(f"columns must be {', '.join(wanted)}; got {', '.join(columns)}")
    given = [np.asarray(columns[name], dtype=float) for name in wanted]
    shapes = {each.shape for each in given}
    if len(shapes) > 1 or given[0].ndim != 1 or not 0 < len(given[0]) <= MOST_POINTS:
        raise InputError(
            f"columns must be arrays of one length from 1 to {MOST_POINTS}, got shapes {shapes}"
        )
    *inputs, measured = given
    if not (np.all(np.isfinite(measured)) and np.all(measured > 0)):
        raise InputError(f"{wanted[-1]} must be positive numbers, got {measured.tolist()}")
    rows = np.column_stack(inputs)
    inside = surrogate.inside(rows)
    if not inside.all():
        i, j = np.argwhere(~inside)[0].tolist()
        name, (low, high) = wanted[j], surrogate.limits_of(rows[i])[wanted[j]]
        raise InputError(
            f"point {i} is outside the training range: {name} {rows[i, j]:g}, range {low:g} to "
            f"{high:g}"
        )
    return rows, measured


def _warn(left: Array, measured: Array) -> None:
    """Warn about points far from the learned ones, or from the others."""
    usual = float(np.median(left))
    odd = np.maximum(np.abs(left), np.abs(left - usual)) > np.log10(_SUSPECT)
    for i in np.flatnonzero(odd).tolist():
        warnings.warn(
            f"point {i} has a force of {measured[i]:.4g}, {10 ** left[i]:.3g} times the learned "
            f"one, where the median of the points is {10**usual:.3g} times; check its unit and "
            "inputs",
            UserWarning,
            stacklevel=3,
        )
