"""Baseline of the force out of contact: zero, tilt over depth and drift over time.

If the test is long enough, both ends of a cycle are free of contact: the approach before contact
and the retraction after detachment. Tilt and drift are subtracted only if the free parts
support them, by a Bayesian criterion on block means, whose scatter includes the slow wander of a
sensor.
"""

from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array

_BLOCKS = 12  # number per free part
_OUT = 4.0  # standard deviations of the noise above which contact has begun
_FEW = 8  # smallest number of points of a free part
# factor on the usual penalty, because neighbouring blocks of a wandering sensor correlate
_PENALTY = 2.0


@dataclass(frozen=True)
class Baseline:
    """Force out of contact as a law of depth and time, with its uncertainty.

    Parameters
    ----------
    coefficients : tuple of float
        Of the terms [N, N/m, N/s].
    terms : tuple of str
        Among "zero", "tilt" and "drift".
    covariance : ndarray
        Covariance of the coefficients.
    noise : float
        Standard deviation of single points [N].
    origin : tuple of float
        Depth [m] and time [s] at which the coefficients hold.
    """

    coefficients: tuple[float, ...]
    terms: tuple[str, ...]
    covariance: Array
    noise: float
    origin: tuple[float, float]

    def at(self, depth: Array, time: Array) -> Array:
        """Return the force out of contact [N]."""
        return self._terms(depth, time) @ np.array(self.coefficients)

    def uncertainty(self, depth: float, time: float) -> float:
        """Return the standard uncertainty of the force out of contact [N]."""
        x = self._terms(np.array([depth]), np.array([time]))[0]
        return float(np.sqrt(max(x @ self.covariance @ x, 0.0)))

    def _terms(self, depth: Array, time: Array) -> Array:
        return _terms(self.terms, depth - self.origin[0], time - self.origin[1])


def _terms(terms: tuple[str, ...], depth: Array, time: Array) -> Array:
    columns = {"zero": np.ones(depth.shape), "tilt": depth, "drift": time}
    return np.stack([columns[name] for name in terms], axis=-1)


def free_before(force: Array) -> int:
    """Return the number of points free of contact at the beginning.

    The level is that of the first quarter; contact begins where the force leaves it permanently.
    """
    return free_after(force[::-1])


def free_after(force: Array) -> int:
    """Return the number of points free of contact at the end, by the same criterion."""
    count = max(force.size // 20, _FEW)
    if force.size < 2 * _FEW:
        return 0
    free = count
    # noise of the whole signal: a few quiet points at the end are not representative
    least = max(point_noise(force), 1e-9 * float(np.ptp(force)))
    for _ in range(30):
        part = force[-free:]
        x = np.linspace(-1.0, 0.0, part.size)
        line = np.polynomial.Polynomial.fit(x, part, 1 if free > 4 * _FEW else 0)
        noise = max(least, float(np.std(part - line(x))))
        # extrapolate the line only slightly
        reach = min(force.size, int(1.3 * free) + 1)
        ahead = force[-reach:]
        where = np.linspace(-(reach - 1) / max(part.size - 1, 1), 0.0, reach)
        out = np.abs(ahead - line(where)) > _OUT * noise
        # three consecutive points, because a single outlier may be random
        left = np.flatnonzero(out[:-2] & out[1:-1] & out[2:])
        grown = reach - int(left[-1]) - 3 if left.size else reach
        if grown <= free or reach == force.size:
            return max(grown, 0) if left.size else min(reach, force.size)
        free = grown
    return free


def point_noise(values: Array) -> float:
    """Return the standard deviation of single points, from second differences (slope-free)."""
    return float(1.4826 * np.median(np.abs(np.diff(values, 2))) / np.sqrt(6))


def baseline(
    force: Array, depth: Array, time: Array, before: slice | None, after: slice
) -> Baseline:
    """Fit the baseline to the free parts before contact, if any, and after contact."""
    parts = [part for part in (before, after) if part is not None]
    blocks = [_blocks(force[p], depth[p], time[p]) for p in parts]
    F, d, t = (np.concatenate(column) for column in zip(*blocks, strict=True))
    origin = (float(depth[after][0]), float(time[after][0]))
    choices: list[tuple[str, ...]] = [("zero",)]
    if F.size >= 6:
        choices += [("zero", "tilt")]
        if before is not None:
            choices += [("zero", "drift"), ("zero", "tilt", "drift")]
    fits = [_fit(terms, F, d - origin[0], t - origin[1]) for terms in choices]
    best = min(range(len(choices)), key=lambda i: fits[i][2])
    values, covariance, _ = fits[best]
    law = Baseline(tuple(values.tolist()), choices[best], covariance, 0.0, origin)
    rest = np.concatenate([force[p] - law.at(depth[p], time[p]) for p in parts])
    noise = float(np.std(rest))
    return Baseline(law.coefficients, law.terms, covariance, noise, origin)


def _blocks(force: Array, depth: Array, time: Array) -> list[Array]:
    """Average over blocks of equal numbers of points."""
    cuts = np.array_split(np.arange(force.size), min(_BLOCKS, force.size))
    return [np.array([column[cut].mean() for cut in cuts]) for column in (force, depth, time)]


def _fit(terms: tuple[str, ...], F: Array, depth: Array, time: Array) -> tuple[Array, Array, float]:
    """Return coefficients, their covariance and the criterion."""
    X = _terms(terms, depth, time)
    scale = np.maximum(np.max(np.abs(X), axis=0), 1e-300)
    values, *_ = np.linalg.lstsq(X / scale, F, rcond=None)
    rest = F - X / scale @ values
    # the scatter is at least the round-off of the sum
    least = max(float(np.max(np.abs(F))) * 1e-12, 1e-150) ** 2
    squares = max(float(rest @ rest), least * F.size)
    variance = squares / max(F.size - len(terms), 1)
    covariance = variance * np.linalg.pinv((X / scale).T @ (X / scale)) / np.outer(scale, scale)
    criterion = F.size * np.log(squares / F.size) + len(terms) * np.log(F.size) * _PENALTY
    return values / scale, covariance, float(criterion)
