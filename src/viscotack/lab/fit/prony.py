r"""Fit a Prony series, with the number of arms chosen by an information criterion.

The relaxation times lie on a logarithmic grid over the measured range. The non-negative moduli
minimise the sum of squares of ln(measured/fitted) in a few Gauss-Newton steps, each a linear
problem with bounds (:func:`nonnegative`). Creep is fitted in the same way by retardation times and
interconverted exactly. The number of grid times is increased and the corrected Akaike criterion
chooses. Arms of zero modulus are dropped.

A series with few times restricts its plateaus, and a bootstrap on the same times does not include
the uncertainty of these times. So the plateau is varied; for each value the best non-negative
series on a *dense* grid is computed, until the sum of squares exceeds its limit: the profile of a
linear quantity under bounds (Rust & Burrus, Mathematical Programming and the Numerical Solution of
Linear Equations, 1972). Each step is a linear problem.

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

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq, least_squares, lsq_linear, nnls
from scipy.stats import norm

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials import Prony
from viscotack.model.materials.conversion import relaxation_series
from viscotack.model.materials.modes import maxwell

from .errors import Errors, errors
from .observed import Observed, only
from .report import FitReport, Interval, information_criterion, rated

# Iterations per amplitude. Columns of neighbouring times are nearly parallel, so the active set
# changes often: half of the noisy sweeps need more than the usual 3, and none that converges more
# than 10.
_PATIENCE = 30
# Amplitudes that contribute less than this to every number are zero.
_NOTHING = 1e-9


def nonnegative(columns: npt.NDArray, numbers: Array) -> Array:
    """Return the non-negative amplitudes whose sum of columns is nearest to the numbers.

    Uses the active set of Lawson and Hanson (1974), which is finite in exact
    arithmetic. In floating point it may cycle among columns that are parallel to round-off, in
    about one of fifty noisy sweeps. Such a problem is solved by the reflective trust region of
    Branch, Coleman & Li (1999), doi:10.1137/S1064827595289108, which always converges; negligible
    amplitudes are then set to zero.

    Parameters
    ----------
    columns : ndarray, shape (M, N)
        Contribution of unit amplitudes to the numbers, over their noise.
    numbers : ndarray, shape (M,)
        Numbers over their noise.
    """
    # QR: a small triangular system with the same solution replaces up to 100,000 rows
    if columns.shape[0] > 2 * columns.shape[1]:
        frame, columns = np.linalg.qr(columns)
        numbers = frame.T @ numbers
    try:
        return nnls(columns, numbers, maxiter=_PATIENCE * columns.shape[1])[0]
    except RuntimeError:
        pass
    size = np.linalg.norm(columns, axis=0)
    size[size == 0] = 1.0
    found = lsq_linear(columns / size, numbers, bounds=(0, np.inf), tol=1e-13, max_iter=500).x
    found[found < _NOTHING * np.linalg.norm(numbers)] = 0.0
    return found / size


# ---- intervals of the plateaus -------------------------------------------------------------------

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
        # mean square of the errors per direction that the weights can follow
        size = float(np.mean(self._errors**2))
        guess = self._reached(side, float(norm.isf(tail)) ** 2 * size)
        at = guess if 0 < guess < np.inf else self._middle
        return self._reached(side, self._allowed(at, side, tail))

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


# ---- the series ----------------------------------------------------------------------------------

_MOST = 60  # arms
_ENOUGH = 40  # smallest number of points to separate the scatter of a curve from its shape
_REPEATABLE = 2e-3  # best repeatability of a laboratory; smaller residuals do not count
_DENSE, _DENSEST = 4, 80  # times per decade on the grid of the intervals, and their maximum
_MOVED = 12  # largest number of arms whose times are optimised
_MADE = 120  # synthetic data sets to simulate the growth of the sum of squares
_FLOOR = 1e-4  # smallest floor (rubbery modulus, glassy compliance) relative to the smallest number


def fit_series(
    data: Observed, *, arms: int | None = None, level: float = 0.9, draws: int = 0, seed: int = 0
) -> FitReport:
    """Fit a Prony series to measured numbers.

    Parameters
    ----------
    data : Observed
        Measured numbers.
    arms : int or None
        Number of relaxation times on the grid; None lets the criterion choose.
    level : float
        Confidence level of the intervals, in (0, 1).
    draws : int
        Number of bootstrap samples: the fitted numbers with random errors like the
        residuals, fitted again on the same times. 0: no samples and no intervals.
    seed : int
        Of the random numbers.
    """
    if arms is not None and not 1 <= arms <= 4 * _MOST:
        raise InputError(f"arms must be between 1 and {4 * _MOST}, got {arms}")
    compared: list[tuple[str, float]] = []
    if arms is None:
        counts = [n for n in range(1, _MOST + 1) if n <= 12 or n % 2 == 0]
        grids = [_grid(data, n) for n in counts if n + 3 < data.values.size]
        if not grids:
            raise InputError(f"{data.values.size} numbers are too few to choose `arms`; give them")
        criteria = []
        for grid in grids:
            times, weights = _fitted(data, grid, data.logs)
            logs = np.log(np.maximum(_basis(data, times) @ weights, 1e-300))
            off = data.weighed((data.logs - logs).reshape(data.values.shape))
            each = information_criterion(off, weights.size + 1, floor=_REPEATABLE)
            criteria.append(each if times.size else float("inf"))
        chosen = grids[int(np.argmin(criteria))]
        order = np.argsort(criteria)[:4]
        compared = [(f"{grids[i].size} arms", criteria[i]) for i in sorted(order)]
    else:
        chosen = _grid(data, arms)
    times, weights = _fitted(data, chosen, data.logs)
    if arms is not None and arms <= _MOVED:
        times, weights = _moved(data, chosen, times, weights)
    material = _material(data, times, weights)
    ends = [Interval(name, float(getattr(material, name)), np.nan, np.nan) for name in NAMES]
    found = rated(
        data,
        "prony",
        material,
        int(np.count_nonzero(weights)),
        # a number of grid times that the data choose counts as one constant
        chosen=arms is None,
        grid=chosen.size,
        compared=tuple(compared),
        intervals=tuple(ends),
    )
    if not draws:
        return found
    # derivatives of ln(fitted value) by each weight, over the noise
    basis = _basis(data, times)
    slopes = basis / (basis @ weights * np.repeat(data.noise, data.at.size))[:, None]
    known = errors(data, data.weighed(data.residuals(material)), slopes)
    noise = known.drawn(draws, np.random.default_rng(seed)) * np.repeat(data.noise, data.at.size)
    logs = np.log(basis @ weights)
    again = [_fitted(data, times, logs + each) for each in noise]
    return replace(
        found,
        shared=known.words(),
        intervals=_plateaus(data, material, times, weights, known, level, seed),
        draws=tuple(_material(data, *each) for each in again if each[0].size),
    )


def with_noise(data: Observed) -> Observed:
    """Return a copy with the noise of each part, estimated from a smooth fit.

    Storage and loss modulus are fitted separately by a series each; the scatter about it is the
    noise. At small loss angles the loss modulus is often ten times as noisy as the storage modulus;
    with equal weights it would distort the fit of the storage modulus. Parts within a factor of 2
    of each other have equal weights, and so do curves with few points, where noise and shape cannot
    be separated.
    """
    if data.quantity != "complex modulus" or data.at.size < _ENOUGH:
        return data
    alone = [fit_series(only(data, part)).scatter for part in data.parts]
    noise = np.maximum(alone, _REPEATABLE)
    noise = noise / np.min(noise)
    return replace(data, noise=noise) if np.max(noise) > 2 else data


def _grid(data: Observed, arms: int) -> Array:
    """Return the midpoints of equal logarithmic cells that extend beyond the measured range.

    Arms beyond the ends are needed because faster relaxation than the fastest measurement still
    contributes to it.
    """
    slow, fast = data.frequencies
    decades = np.log10(fast / slow)
    ends = np.array([-np.log10(fast) - 0.5, -np.log10(slow) + 0.5])
    cell = (decades + 1) / arms
    return 10 ** np.linspace(ends[0] + cell / 2, ends[1] - cell / 2, arms)


def _basis(data: Observed, times: Array) -> npt.NDArray:
    """Return the contribution of each arm of unit modulus (or compliance), floor first."""
    if data.in_frequency:
        terms = maxwell(data.at[:, None] * times)
        both = {"storage": (terms.real, 1.0), "loss": (terms.imag, 0.0)}
        arms = np.concatenate([both[part][0] for part in data.parts])
        floor = np.concatenate([np.full(data.at.size, both[part][1]) for part in data.parts])
    else:
        arms = np.exp(-data.at[:, None] / times)
        if data.quantity == "creep":
            arms = -np.expm1(-data.at[:, None] / times)
        floor = np.ones(data.at.size)
    return np.concatenate([floor[:, None], arms], axis=1)


def _fitted(
    data: Observed, times: Array, logs: Array, start: Array | None = None
) -> tuple[Array, Array]:
    """Return the times with a non-zero modulus, and the floor and these moduli, shape (n + 1,)."""
    basis = _basis(data, times)
    floor = _FLOOR * float(np.min(data.values[0]))
    values = np.exp(logs)
    base = floor * basis[:, 0]
    noise = np.repeat(data.noise, data.at.size)
    x = start
    if x is None:
        x = nonnegative(basis / (values * noise)[:, None], (1 - base / values) / noise)
    for _ in range(8):
        model = base + basis @ x
        model = np.maximum(model, 1e-3 * values)  # avoids zero where no arm contributes yet
        # ln(model + d) to first order in the change: Gauss-Newton with bounds
        target = 1 + np.log(values / model) - base / model
        new = nonnegative(basis / (model * noise)[:, None], target / noise)
        change = np.max(np.abs(basis @ (new - x)) / model)
        x = new
        if change < 1e-6:
            break
    weights = x.copy()
    weights[0] += floor
    keep = weights[1:] > 0
    return times[keep], np.concatenate([weights[:1], weights[1:][keep]])


def _moved(data: Observed, grid: Array, times: Array, weights: Array) -> tuple[Array, Array]:
    """Optimise few times and their weights, starting from those on a grid."""
    if not times.size:
        return times, weights
    kept, found = times, weights
    # an arm of zero modulus on the grid may contribute at another time
    least = 1e-2 * float(np.max(weights[1:]))
    times, weights = grid, np.full(grid.size + 1, least)
    weights[0] = found[0]
    weights[1 + np.searchsorted(grid, kept)] = np.maximum(found[1:], least)
    count = times.size
    noise = np.repeat(data.noise, data.at.size)
    slow, fast = data.frequencies
    low = np.concatenate((np.full(count, np.log(0.1 / fast)), np.full(count + 1, -np.inf)))
    high = np.concatenate((np.full(count, np.log(10 / slow)), np.full(count + 1, np.inf)))

    def parts(x: Array) -> tuple[Array, Array]:
        return np.exp(x[:count]), np.exp(np.clip(x[count:], -700, 700))

    def misfit(x: Array) -> Array:
        where, sizes = parts(x)
        model = np.maximum(_basis(data, where) @ sizes, 1e-300)
        return np.clip((np.log(model) - data.logs) / noise, -50, 50)

    start = np.clip(np.log(np.concatenate((times, weights))), low + 1e-9, high - 1e-9)
    where, sizes = parts(least_squares(misfit, start, bounds=(low, high), max_nfev=400).x)
    order = np.argsort(where)
    where = where[order]
    if np.any(np.diff(where) < 1e-3 * where[1:]):  # two times have merged
        return kept, found
    return where, np.concatenate((sizes[:1], sizes[1:][order]))


def _material(data: Observed, times: Array, weights: Array) -> Prony:
    arms = tuple(zip(weights[1:], times, strict=True))
    if not arms:
        raise InputError("a Prony series needs a modulus that falls with time, and moduli do not")
    if data.quantity == "creep":
        return relaxation_series(
            arms, glassy_modulus=1 / weights[0], poisson_ratio=data.poisson_ratio
        )
    return Prony(rubbery_modulus=weights[0], branches=arms, poisson_ratio=data.poisson_ratio)


def _plateaus(
    data: Observed,
    material: Prony,
    times: Array,
    weights: Array,
    known: Errors,
    level: float,
    seed: int,
) -> tuple[Interval, ...]:
    """Return the intervals of the plateaus; one-sided where a plateau was not measured."""
    # with the fitted times, because a dense grid has not that of a single arm, and tails of loss
    # tell the difference
    slow, fast = data.frequencies
    beyond = 10**-0.5 if data.in_frequency else 1.0
    count = int(np.clip(_DENSE * (np.log10(fast / slow) + 1), 8, _DENSEST))
    dense = np.geomspace(beyond / fast, 10**0.5 / slow, count)
    basis = _basis(data, np.union1d(dense, times))
    logs = np.log(_basis(data, times) @ weights)
    noise = np.repeat(data.noise, data.at.size)
    # linearise the logarithm about the fit
    columns = basis / (np.exp(logs) * noise)[:, None]
    numbers = (1 + data.logs - logs) / noise
    drawn = known.drawn(_MADE, np.random.default_rng(seed), sure=False)
    # creep: the weights are compliances, and their sum is the rubbery compliance
    creeping = data.quantity == "creep"
    whole, floor = np.ones(basis.shape[1]), np.eye(basis.shape[1])[0]
    opened = open_ends(data, material)
    found = []
    for name in NAMES:
        quantity = Plateau(
            columns, numbers, whole if (name == "glassy_modulus") != creeping else floor, drawn
        )
        tail = 1 - level if name in opened else (1 - level) / 2
        ends = []
        for side in (-1, 1):
            if name in opened and side == (-1 if name == "rubbery_modulus" else 1):
                ends.append(np.inf if side > 0 else 0.0)  # not measured
            elif creeping:
                compliance = quantity.end(-side, tail)
                ends.append(1 / compliance if compliance > 0 else np.inf)
            else:
                ends.append(quantity.end(side, tail))
        value = float(getattr(material, name))
        found.append(Interval(name, value, min(ends[0], value), max(ends[1], value)))
    return tuple(found)
