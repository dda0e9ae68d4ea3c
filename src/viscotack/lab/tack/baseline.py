r"""Statistical model of the force out of contact, and of the points at which contact begins.

.. math::

   F_i = b_0 + b_1 x_i + b_2 z_i + \sum_k w_k \sqrt 2 \sin(h_k x_i)
         + \sum_p c_p u_i^p + \sigma \varepsilon_i, \qquad h_k = \pi (k + 1/2)

with zero :math:`b_0`, drift :math:`b_1` over time x and tilt :math:`b_2` over depth z, both over
their spans. The sines are those of a random walk (:math:`w_k \propto q/h_k`) or of
an integrated one (:math:`q/h_k^2`): the wander of the zero. The flank of a contact is a sum of
powers p of the depth u beyond the contact point over its largest value (0 out of contact): 3/2 for
Hertz, 0 for a jump.

Attraction reaches beyond the contact. A sphere at a gap h feels
:math:`-\tfrac83 \pi R \Delta\gamma (h_0/h)^2` by Derjaguin's approximation of Lennard-Jones
forces. The free points of each part therefore have a term :math:`-a (1 + d/s)^{-2}`, where d is the
distance from the innermost of them, a is not negative, and the length s is one of several.

All coefficients have normal priors. So the evidence of a contact point, a set of powers and a
strength q has a closed form, after integration over the noise (inverse gamma, around that of
neighbouring points). First the contact points of both parts are averages over the evidence of all
of these, then the baseline is that over the strengths, drift, tilt and attraction, given the free
points.

The smallest force of a noisy curve, which may end with a jump behind it, is that of parabolas
fitted to windows around the smallest point. A window is valid if its scatter is that of the noise
and polynomials of higher degree contribute no more than the noise. The answer is the mean over the
valid windows whose uncertainty is at most twice the smallest one. No window contains a jump; if the
force falls until the jump, it continues to fall up to the next point.
"""

from dataclasses import dataclass, replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.special import log_ndtr

from viscotack.arrays import Array

Indices = npt.NDArray[np.intp]

# sines of the wander in the search of contact points; fewer would fix the zero between free parts
_FEW_SINES, _SINES = 8, 32
# strengths of the wander, relative to the noise: random walk, integrated
_WANDERS = ((0.0, 0.0), (2.0, 0.0), (8.0, 0.0), (30.0, 0.0), (0.0, 10.0), (0.0, 100.0))
_SLOPES = 0.2  # prior standard deviation of drift and tilt, relative to the range of force
# Prior standard deviation of the attraction on the innermost free point, relative to the range of
# force, and its lengths relative to the longer free part
_ATTRACTION, _LENGTHS = 0.03, (0.03, 0.1, 0.3, 1.0)
_WANDERING = 0.1  # largest strength of a random walk, relative to the range of force
_POWERS = (0.0, 1.0, 1.5, 2.0, 3.0)  # of the flank; 0 is a jump into or out of contact
_FLANKS = ((1.5,), (2,), (1, 2), (1.5, 2, 3), (0,), (0, 1), (0, 1.5, 2), (0, 1, 2, 3))
_SURE = 10.0  # half of the degrees of freedom of the noise of neighbouring points
_BLOCKS = 60  # largest number of blocks of a free part
_LINE, _TILTED = 4, 6.0  # share of a part and its rise over the noise that show a tilt
_STRAIGHT = 2.0  # largest scatter around that tilt, over the noise
_SINGLE = 50  # points next to contact that are not averaged
_CANDIDATES = 28  # contact points compared at a time
_BEYOND = 4  # points of the flank beyond its part in use
_MISFIT = 3.0  # variance of the residuals over that of the noise that a second step may explain
_GAIN = 20.0  # smallest gain of a second step
_UNLIKELY = 8.0  # log evidence below the best one
_UNSURE = 0.05  # largest probability that free points are in contact
_DOUBTED = 4.0  # standard deviations from that of the outer points that make a zero doubtful
_FEW = 6  # smallest number of free points


@dataclass(frozen=True)
class Baseline:
    """Force out of contact as a law of depth and time, with its uncertainty.

    Parameters
    ----------
    coefficients : ndarray
        Of zero, drift, tilt and the sines of the wander [N].
    covariance : ndarray
        Covariance of the coefficients [N^2].
    noise : float
        Standard deviation of single points [N].
    time, depth : tuple of float
        Origin and span of time [s] and depth [m].
    """

    coefficients: Array
    covariance: Array
    noise: float
    time: tuple[float, float]
    depth: tuple[float, float]

    def at(self, depth: Array, time: Array) -> Array:
        """Force out of contact [N]."""
        return self._terms(depth, time) @ self.coefficients

    def uncertainty(self, depth: Array, time: Array, weights: Array | float = 1.0) -> float:
        """Return the standard uncertainty of the weighted sum of the force out of contact."""
        x = np.sum(np.reshape(weights, (-1, 1)) * self._terms(depth, time), axis=0)
        return float(np.sqrt(max(x @ self.covariance @ x, 0.0)))

    def doubted(self, other: "Baseline", depth: float, time: float) -> "Baseline":
        """Return this baseline with the difference from another one in its uncertainty.

        Only where the difference at a depth and time is improbable by both uncertainties. The other
        one is fitted to the outer halves of the free parts: a weak contact that lasts beyond the
        pull-off, as of fibrils, bends the inner ones like a wander of the zero.
        """
        at, when = np.array([depth]), np.array([time])
        apart = abs(float((self.at(at, when) - other.at(at, when))[0]))
        own, others = (one.uncertainty(at, when) for one in (self, other))
        if apart < max(_DOUBTED * own, _DOUBTED / 2 * others):
            return self
        off = self.coefficients - other.coefficients
        return replace(self, covariance=self.covariance + np.outer(off, off))

    def _terms(self, depth: Array, time: Array) -> Array:
        return _terms(
            (np.atleast_1d(time) - self.time[0]) / self.time[1],
            (np.atleast_1d(depth) - self.depth[0]) / self.depth[1],
            _SINES,
        )


@dataclass(frozen=True)
class Contact:
    """First or last contact of a part of the test.

    Parameters
    ----------
    free : int
        Number of points that are free of contact, counted from the outer end.
    depth : float
        Depth of the drive at the contact point [m].
    uncertainty : float
        Its standard uncertainty [m].
    misfit : float
        Variance of the residuals over that of the noise.
    gain : float
        Logarithm of the evidence relative to that of a part that is free to its last points.
    """

    free: int
    depth: float
    uncertainty: float
    misfit: float
    gain: float


def _terms(time: Array, depth: Array, sines: int) -> Array:
    waves = np.sqrt(2) * np.sin(np.multiply.outer(time, _waves(sines)))
    return np.concatenate([np.stack([np.ones(time.shape), time, depth], axis=-1), waves], axis=-1)


def _waves(count: int) -> Array:
    return np.pi * (np.arange(float(count)) + 0.5)


def _widths(
    size: float, wander: tuple[float, float], slopes: tuple[float, float], sines: int
) -> Array:
    """Prior standard deviations of the coefficients, in units of the noise."""
    straight = size * np.array([3.0, *slopes])
    walk, smooth = min(wander[0], _WANDERING * size), min(wander[1], 2 * _WANDERING * size)
    h = _waves(sines)
    return np.concatenate([straight, walk / h + smooth / h**2])


def point_noise(values: Array) -> float:
    """Return the standard deviation of single points, from second differences (slope-free).

    Differences above 3.5 standard deviations are left out, because they belong to jumps.
    """
    bends = np.abs(np.diff(values, 2))
    scale = np.inf
    for _ in range(20):
        scale = float(np.sqrt(np.mean(bends[bends <= 3.5 * scale] ** 2)))
    return scale / np.sqrt(6)


def rounding(values: Array) -> float:
    """Return the standard deviation of rounding to whole digits; 0 if there are none."""
    steps = np.abs(np.diff(values))
    digit = float(np.min(steps[steps > 1e-9 * np.ptp(values)], initial=np.inf))
    whole = np.isfinite(digit) and np.allclose(steps / digit, np.round(steps / digit), atol=1e-3)
    return digit / np.sqrt(12) if whole else 0.0


def without_spikes(force: Array, noise: float) -> Array:
    """Replace single points far from both neighbours and their extrapolations by the mean."""
    f = np.pad(force, 2, mode="reflect", reflect_type="odd")
    left, right = f[1:-3], f[3:-1]
    beyond = [force - (2 * left - f[:-4]), force - (2 * right - f[4:])]
    near = [force - left, force - right]
    signs = np.sign([*beyond, *near])
    far = np.min(np.abs(beyond), axis=0) > 9 * noise
    spike = far & (np.min(np.abs(near), axis=0) > 6 * noise) & (np.abs(signs.sum(axis=0)) == 4)
    return np.asarray(np.where(spike, (left + right) / 2, force), dtype=np.float64)


def _evidence(X: Array, y: Array, widths: Array) -> tuple[Any, ...]:
    """Return log evidence, root of the precision, its solution, and variance, for each prior.

    Parameters
    ----------
    X, y : ndarray
        Terms (..., n, p) and data (n) in units of their noise.
    widths : ndarray, shape (priors, p)
    """
    gram, moment = np.swapaxes(X, -1, -2) @ X, np.swapaxes(X, -1, -2) @ y
    M = np.eye(widths.shape[1]) + gram[..., None, :, :] * widths[:, :, None] * widths[:, None, :]
    L = np.linalg.cholesky(M)
    v = np.linalg.solve(L, (moment[..., None, :] * widths)[..., None])[..., 0]
    squares = _SURE + np.maximum(y @ y - np.sum(v**2, axis=-1), 0.0) / 2
    logs = np.log(np.diagonal(L, axis1=-2, axis2=-1)).sum(axis=-1)
    return -logs - (_SURE + y.size / 2) * np.log(squares), L, v, squares / (_SURE + y.size / 2)


class _Part(NamedTuple):
    """Averages over blocks of points, from the outer end inwards."""

    first: Indices  # indices of the first points of the blocks
    points: Array
    force: Array
    depth: Array
    time: Array


def straight(force: Array, depth: Array, noise: float) -> Array:
    """Return the line through the outer quarter of a part, its level where there is no tilt.

    A tilt is no flank of a contact, and a quarter that reaches into the flank is no line.
    """
    outer = slice(max(force.size // _LINE, _FEW))
    line = np.polynomial.Polynomial.fit(depth[outer], force[outer], 1)
    rise = abs(float(line(depth[outer][-1]) - line(depth[0])))
    if rise > _TILTED * noise and np.std(force[outer] - line(depth[outer])) < _STRAIGHT * noise:
        return np.asarray(line(depth))
    return np.full(force.size, float(np.median(force[: max(force.size // 10, _FEW)])))


def _part(force: Array, depth: Array, time: Array, noise: float, share: float) -> _Part:
    """Return the part up to a fraction of its flank, the force in units of the noise."""
    level = float(np.median(force[: max(force.size // 10, _FEW)]))
    change = np.abs(force - straight(force, depth, noise))
    beyond = change > np.clip(60 * noise, 0.1 * change.max(), share * change.max())
    stop = min(int(np.argmax(beyond)) + _BEYOND, force.size) if beyond.any() else force.size
    # single points at the inner end, where a jump may be
    outer = max(stop - _SINGLE, 0)
    first = np.concatenate([_cuts(outer, 2 * _BLOCKS), np.arange(outer, stop)])
    return _averaged(first, (force[:stop] - level) / noise, depth[:stop], time[:stop])


def _cuts(size: int, most: int) -> Indices:
    """Return the first points of blocks of equal numbers of points."""
    return np.unique(np.linspace(0, size, min(most, size), endpoint=False).round().astype(int))


def _averaged(first: Indices, force: Array, depth: Array, time: Array) -> _Part:
    points = np.diff(first, append=force.size)
    return _Part(
        first, points, *(np.add.reduceat(row, first) / points for row in (force, depth, time))
    )


def _contact_evidence(part: _Part, begins: Indices, widths: Array) -> tuple[Array, Array]:
    """Log evidence and variance of contact from these blocks (rows) under each prior (columns)."""
    z = part.depth
    u = np.maximum(z - z[begins - 1][:, None], 0.0)
    u /= np.maximum(u.max(axis=1, keepdims=True), 1e-300)
    inside = np.arange(z.size) >= begins[:, None]
    powers = np.stack([np.where(inside, u**p, 0.0) for p in _POWERS], axis=-1)
    base = _terms(part.time, (z - z[0]) / max(float(np.ptp(z)), 1e-300), _FEW_SINES)
    X = np.concatenate([np.broadcast_to(base, (begins.size, *base.shape)), powers], axis=-1)
    weight = np.sqrt(part.points)
    logs, _, _, variance = _evidence(X * weight[:, None], part.force * weight, widths)
    return logs, variance


def contact_of(
    force: Array, depth: Array, time: Array, noise: float, share: float
) -> Contact | None:
    """Return the contact point of a part that is ordered from its outer end inwards.

    A contact may end in several steps, of which the model has one. So the free points are searched
    again as long as the model does not fit them.

    Parameters
    ----------
    force, depth, time : ndarray, shape (N,)
        Force [N], depth [m], and time over the duration of the test.
    noise : float
        Standard deviation of single points [N].
    share : float
        Fraction of the largest change of force up to which the flank is used.

    Returns
    -------
    Contact or None
        None if the part does not begin free of contact.
    """
    found = _contact(force, depth, time, noise, share)
    while found and found.misfit > _MISFIT:
        # with the last step, or without it where it is so large that it hides the others
        stops = (found.free + _BEYOND, found.free)
        with_step, without = (
            _contact(force[:stop], depth[:stop], time[:stop], noise, share) for stop in stops
        )
        least = force.size // 30
        if with_step and with_step.misfit < found.misfit / 2 and with_step.free >= least:
            found = with_step
        elif without and without.gain > _GAIN and without.free >= least:
            found = without
        else:
            break
    return found


def _contact(force: Array, depth: Array, time: Array, noise: float, share: float) -> Contact | None:
    """Return the contact point with one step or flank; see :func:`contact_of`."""
    if force.size < 2 * _FEW:
        return None
    part = _part(force, depth, time, noise, share)
    size, last = float(np.ptp(part.force)), part.force.size - 1
    wanders = [_widths(size, wander, (_SLOPES, _SLOPES), _FEW_SINES) for wander in _WANDERS]
    flanks = [[size * (p in flank) for p in _POWERS] for flank in _FLANKS]
    widths = np.array([[*wander, *flank] for wander in wanders for flank in flanks])
    coarse = _between(1, last)
    logs, _ = _contact_evidence(part, coarse, widths)
    gain = float(logs.max() - logs[-1].max())
    likely = logs > logs.max() - _UNLIKELY
    near = np.flatnonzero(likely.any(axis=1))
    begins = _between(
        int(coarse[max(near[0] - 1, 0)]), int(coarse[min(near[-1] + 1, coarse.size - 1)])
    )
    logs, variance = _contact_evidence(part, begins, widths[likely.any(axis=0)])
    weights = np.exp(logs - logs.max()).sum(axis=1)
    # a candidate represents the points around it
    weights *= np.gradient(part.first[begins].astype(float)) if begins.size > 1 else 1.0
    weights /= weights.sum()
    outer = min(max(_FEW, force.size // 8), 16)
    if weights[part.first[begins] < outer].sum() > _UNSURE:
        return None
    z = part.depth
    # a soft machine may jump back at the contact
    steps = np.maximum(
        np.abs(z[begins - 1] - z[np.maximum(begins - 2, 0)]), z[begins] - z[begins - 1]
    )
    places = z[begins - 1] + steps / 2
    mean = float(weights @ places)
    spread = float(np.sqrt(weights @ ((places - mean) ** 2 + steps**2 / 12)))
    free = begins[int(np.argmax(np.cumsum(weights) > _UNSURE))]
    misfit = float(variance.flat[int(np.argmax(logs))])
    return Contact(int(part.first[free]), mean, spread, misfit, gain)


def _between(low: int, high: int) -> Indices:
    """Return whole numbers between two, with both."""
    return np.unique(np.linspace(low, high, _CANDIDATES).round().astype(int))


def baseline(force: Array, depth: Array, time: Array, free: list[slice], noise: float) -> Baseline:
    """Fit the baseline to the free parts of a test."""
    origin = float(time[0]), max(float(np.ptp(time)), 1e-300)
    place = float(depth[free[-1]][0]), max(float(np.ptp(depth)), 1e-300)
    rows = [(force[p], depth[p], time[p]) for p in free]
    blocks = [_averaged(_cuts(row[0].size, _BLOCKS), *row) for row in rows]
    _, points, F, z, t = (np.concatenate(column) for column in zip(*blocks, strict=True))
    level = float(np.median(F))
    weight = np.sqrt(points)
    X = _terms((t - origin[0]) / origin[1], (z - place[0]) / place[1], _SINES)
    size = float(np.ptp(force)) / noise
    slopes = ((0.0, 0.0), (_SLOPES, 0.0), (0.0, _SLOPES), (_SLOPES, _SLOPES))
    widths = np.array(
        [_widths(size, wander, slope, _SINES) for wander in _WANDERS for slope in slopes]
    )
    pulls, own = _attraction(blocks), X.shape[-1]
    X = np.concatenate([np.broadcast_to(X, (len(pulls), *X.shape)), pulls], axis=-1)
    widths = np.pad(widths, ((0, 0), (0, len(blocks))), constant_values=_ATTRACTION * size)
    logs, L, v, scale = _evidence(X * weight[:, None], (F - level) / noise * weight, widths)
    likely = logs > logs.max() - _UNLIKELY
    widths = np.broadcast_to(widths, (len(pulls), *widths.shape))[likely]
    root = np.linalg.solve(L[likely], np.eye(L.shape[-1]) * widths[:, None, :])
    each = np.einsum("hij,hi->hj", root, v[likely])
    spread = np.einsum("h,hij,hik->hjk", scale[likely], root, root)
    # part of each posterior in which the forces attract
    pull, variance = each[:, own:], np.diagonal(spread, axis1=1, axis2=2)
    sure = pull / np.sqrt(np.maximum(variance[:, own:], 1e-300))
    weights = np.exp(logs[likely] - logs.max() + np.sum(log_ndtr(sure) + np.log(2), axis=1))
    weights /= weights.sum()
    each, spread = each[:, :own], spread[:, :own, :own]
    mean = weights @ each
    off = each - mean
    covariance = np.einsum("h,hij->ij", weights, spread) + (weights[:, None] * off).T @ off
    mean, covariance = noise * mean, noise**2 * covariance
    mean[0] += level
    law = Baseline(mean, covariance, 0.0, origin, place)
    rest = np.concatenate([force - law.at(depth, time) for force, depth, time in rows])
    return replace(law, noise=float(np.std(rest)))


def _attraction(blocks: list[_Part]) -> Array:
    """Return a term for each free part (last axis) by length (first axis), 0 for the first."""
    depths = [block.depth for block in blocks]
    span = max(float(np.ptp(depth)) for depth in depths)
    lengths = np.array(_LENGTHS)[:, None] * max(span, 1e-300)
    found = np.zeros((1 + len(_LENGTHS), sum(map(len, depths)), len(depths)))
    begin = 0
    for part, depth in enumerate(depths):
        rows = slice(begin, begin := begin + len(depth))
        found[1:, rows, part] = -((1 + (depth.max() - depth) / lengths) ** -2)
    return found


_REACH = (0, 1, 2, 3, 4, 6, 8, 11, 16, 22, 30, 42, 60)  # points on either side
_ASYMMETRY = 4  # largest ratio of the points on both sides
_SCATTER = 2.0  # standard deviations of chi-square up to which a window is valid
_SHAPE = 0.5  # the same for the terms of higher degree
_WORSE = 2.0  # largest ratio of uncertainties in the mean
_JUMP = (10.0, 0.1)  # smallest step of a jump, relative to the noise and to the smallest force
_HIGHEST = 6  # degree of the polynomials that test a parabola


class Extremum(NamedTuple):
    """Smallest force [N] and its place (an index, not a whole number), with uncertainties."""

    value: float
    uncertainty: float
    at: float
    at_uncertainty: float


def extremum(force: Array, at: int, noise: float) -> Extremum:
    """Estimate the smallest force.

    Parameters
    ----------
    force : ndarray
        Force, corrected for the baseline [N].
    at : int
        Index of its smallest point.
    noise : float
        Standard deviation of single points [N].
    """
    near = min(float(force[at - 1]), float(force[min(at + 1, force.size - 1)]))
    between = max(near - float(force[at]), 0.0) / 2
    point = Extremum(float(force[at]), float(np.hypot(noise, between)), at, 0.5)
    jumps = np.diff(force[at:]) > max(_JUMP[0] * noise, _JUMP[1] * abs(float(force[at])))
    last = int(np.argmax(jumps)) if jumps.any() else force.size - at
    windows = [
        (before, behind)
        for before in _REACH
        for behind in {*_REACH, last}
        if before <= at and behind <= min(last, force.size - at - 1) and before + behind >= 4
        if behind == last or max(before, behind) <= _ASYMMETRY * (min(before, behind) + 1)
    ]
    found = [_parabola(force, at, window, noise, window[1] == last) for window in windows]
    valid = [one for one in found if one is not None]
    least = min((one.uncertainty for one in valid), default=np.inf)
    if least >= point.uncertainty:
        return point
    rows = np.array([one for one in valid if one.uncertainty <= _WORSE * least])
    weights = rows[:, 1] ** -2 / np.sum(rows[:, 1] ** -2)
    mean = weights @ rows
    spread = np.sqrt(weights @ (rows - mean) ** 2)
    return Extremum(
        float(mean[0]),
        float(np.hypot(mean[1], spread[0])),
        float(mean[2]),
        # no curve is resolved between its points
        float(np.sqrt(mean[3] ** 2 + spread[2] ** 2 + 1 / 12)),
    )


@cache
def _polynomials(count: int) -> tuple[Any, ...]:
    """Orthonormal polynomials at the points of a window, and on a fine grid with slopes."""
    degree = min(_HIGHEST, count - 2)
    x, fine = np.linspace(-1, 1, count), np.linspace(-1, 1, 8 * count - 7)
    Q, R = np.linalg.qr(np.polynomial.legendre.legvander(x, degree))
    on_grid = np.linalg.solve(R.T, np.polynomial.legendre.legvander(fine, degree).T).T
    return Q, on_grid, 8 * np.gradient(on_grid, axis=0)


def _parabola(
    force: Array, at: int, window: tuple[int, int], noise: float, jump: bool
) -> Extremum | None:
    """Fit a parabola to a window of points before and behind; None if it is not valid.

    At a jump behind the window the force may fall until any place up to the next point.
    """
    F = force[at - window[0] : at + window[1] + 1]
    Q, on_grid, slopes = _polynomials(F.size)
    c = Q.T @ F
    free, more = F.size - 3, c.size - 3
    scatter = (F @ F - c[:3] @ c[:3]) / noise**2
    if scatter > free + _SCATTER * np.sqrt(2 * free):
        return None
    if c[3:] @ c[3:] > noise**2 * (more + _SHAPE * np.sqrt(2 * more)):
        return None
    course = on_grid[:, :3] @ c[:3]
    i = int(np.argmin(course))
    other = on_grid[:, :5] @ c[:5]
    bias = float(other.min() - course[i])
    value = float(np.hypot(noise * np.linalg.norm(on_grid[i, :3]), bias))
    slope = noise * np.linalg.norm(slopes[i, :3])
    bend = abs(slopes[-1, :3] @ c[:3] - slopes[0, :3] @ c[:3]) / F.size
    place = min(float(slope / max(bend, 1e-300)), F.size / 2)
    place = float(np.hypot(place, (np.argmin(other) - i) / 8))
    first = at - window[0] + i / 8
    if jump and i == course.size - 1:
        further = float(slopes[-1, :3] @ c[:3])
        value, place = np.hypot(value, further / np.sqrt(12)), np.hypot(place, np.sqrt(1 / 12))
        return Extremum(float(course[i]) + further / 2, float(value), first + 0.5, float(place))
    return Extremum(float(course[i]), value, first, place)
