r"""A Prony series fitted to measured numbers: as many arms as the data can carry.

The relaxation times stand on a logarithmic grid over the measured range, and the moduli, none
negative, make the sum of squares of ln(measured/fitted) smallest: a few steps of Gauss and Newton,
each a linear problem with bounds (:mod:`.nonnegative`). Creep is fitted by
retardation times in the same way, and interconverted exactly. Grids of more and more arms are
tried; the information criterion chooses. Arms that get no modulus are left out.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.materials import Prony
from viscotack.materials.conversion import RetardationSeries, relaxation_series
from viscotack.materials.modes import maxwell

from .fit_report import Interval, Scatter, information_criterion, scatter
from .nonnegative import nonnegative
from .observed import Observed, only

Array = npt.NDArray[np.float64]

_MOST = 60  # arms
_ENOUGH = 40  # points of a curve from which on its scatter is known apart from its shape
_REPEATABLE = 2e-3  # no laboratory finds a modulus again better: finer residuals decide nothing
_FLOOR = 1e-4  # smallest floor (rubbery modulus, glassy compliance) beside the smallest number


@dataclass(frozen=True, eq=False)
class FittedSeries:
    """A fitted Prony series, intervals of its plateaus, and series that the data allow as well."""

    material: Prony
    intervals: tuple[Interval, ...]
    scatter: Scatter
    constants: int
    grid: int
    criterion: float
    compared: tuple[tuple[str, float], ...]
    draws: tuple[Prony, ...]


def fit_series(
    data: Observed, *, arms: int | None, level: float, draws: int, seed: int
) -> FittedSeries:
    """Return a Prony series fitted to measured numbers.

    Parameters
    ----------
    data : Observed
        Measured numbers.
    arms : int or None
        Number of relaxation times on the grid; None for as many as the criterion chooses.
    level : float
        Confidence level of the intervals, in (0, 1).
    draws : int
        How many series to draw by the bootstrap: the fitted numbers with noise of the size of the
        residuals, fitted again on the same times.
    seed : int
        Of the random numbers.
    """
    if arms is not None and not 1 <= arms <= 4 * _MOST:
        raise InputError(f"arms must be between 1 and {4 * _MOST}, got {arms}")
    compared: list[tuple[str, float]] = []
    if arms is None:
        grids = _grids(data)
        if not grids:
            raise InputError(
                f"{data.values.size} numbers are too few to choose how many arms they carry; give "
                "arms, or fit a law of few constants"
            )
        criteria = [_criterion(data, *_fitted(data, grid, data.logs)) for grid in grids]
        chosen = grids[int(np.argmin(criteria))]
        order = np.argsort(criteria)[:4]
        compared = [(f"{grids[i].size} arms", criteria[i]) for i in sorted(order)]
    else:
        chosen = _grid(data, arms)
    times, weights = _fitted(data, chosen, data.logs)
    material = _material(data, times, weights)
    residuals = data.weighed(data.residuals(material))
    constants = int(np.count_nonzero(weights))
    spread = scatter(residuals, constants)
    sample = _bootstrap(data, times, weights, spread, draws, seed)
    return FittedSeries(
        material=material,
        intervals=_plateaus(material, sample, level),
        scatter=spread,
        constants=constants,
        grid=chosen.size,
        criterion=information_criterion(residuals, constants),
        compared=tuple(compared),
        draws=sample,
    )


def with_noise(data: Observed) -> Observed:
    """Return measured numbers that know which of their parts scatters more.

    Storage and loss are fitted apart, each by a series of its own; the scatter about it is its
    noise. At small loss angles the loss modulus is often ten times as noisy as the storage modulus,
    and with equal weights it would drag the fit off it. Parts within a factor of 2 of each other
    count alike, and so do those of few points, which cannot tell noise from shape.
    """
    if data.quantity != "complex modulus" or data.at.size < _ENOUGH:
        return data
    alone = [
        fit_series(only(data, part), arms=None, level=0.9, draws=0, seed=0).scatter.deviation
        for part in data.parts
    ]
    noise = np.maximum(alone, _REPEATABLE)
    noise = noise / np.min(noise)
    return replace(data, noise=noise) if np.max(noise) > 2 else data


def _grid(data: Observed, arms: int) -> Array:
    """Return times over the measured range: the middles of equal cells, that reach over its ends.

    Arms beyond the ends are needed: what relaxes faster than the fastest measurement still
    shows in it.
    """
    slow, fast = data.frequencies
    decades = np.log10(fast / slow)
    ends = np.array([-np.log10(fast) - 0.5, -np.log10(slow) + 0.5])
    cell = (decades + 1) / arms
    return 10 ** np.linspace(ends[0] + cell / 2, ends[1] - cell / 2, arms)


def _grids(data: Observed) -> list[Array]:
    """Return the grids to try: each count where they are few, then one in a few."""
    counts = [n for n in range(1, _MOST + 1) if n <= 12 or n % 2 == 0]
    return [_grid(data, n) for n in counts if n + 3 < data.values.size]


def _basis(data: Observed, times: Array) -> npt.NDArray:
    """Return what each arm of modulus (or compliance) 1 adds to the numbers, floor first."""
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
    """Return the times that got a modulus, and the floor and these moduli, shape (n + 1,)."""
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
        model = np.maximum(model, 1e-3 * values)  # as if: a number no arm reaches yet
        # ln(model + d) to first order in the change: Gauss and Newton, with bounds
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


def _material(data: Observed, times: Array, weights: Array) -> Prony:
    arms = tuple(zip(weights[1:], times, strict=True))
    if not arms:
        raise InputError(
            "the measured modulus does not rise with frequency, or fall with time: there is "
            "nothing that a Prony series could describe"
        )
    if data.quantity == "creep":
        series = RetardationSeries(
            glassy_modulus=1 / weights[0], elements=arms, poisson_ratio=data.poisson_ratio
        )
        return relaxation_series(series)
    return Prony(rubbery_modulus=weights[0], branches=arms, poisson_ratio=data.poisson_ratio)


def _criterion(data: Observed, times: Array, weights: Array) -> float:
    if times.size == 0:
        return float("inf")
    logs = np.log(np.maximum(_basis(data, times) @ weights, 1e-300))
    residuals = data.weighed((data.logs - logs).reshape(data.values.shape))
    # the times of the grid follow from one number, their count
    return information_criterion(residuals, weights.size + 1, floor=_REPEATABLE)


def _bootstrap(
    data: Observed, times: Array, weights: Array, spread: Scatter, count: int, seed: int
) -> tuple[Prony, ...]:
    logs = np.log(_basis(data, times) @ weights)
    noise = np.random.default_rng(seed).normal(size=(count, logs.size))
    noise *= spread.deviation * spread.widening * np.repeat(data.noise, data.at.size)
    found = []
    for each in noise:
        kept, drawn = _fitted(data, times, logs + each)
        if kept.size:
            found.append(_material(data, kept, drawn))
    return tuple(found)


def _plateaus(material: Prony, sample: tuple[Prony, ...], level: float) -> tuple[Interval, ...]:
    part = (1 - level) / 2
    found = []
    for name in ("rubbery_modulus", "glassy_modulus"):
        value = float(getattr(material, name))
        low = high = value
        if sample:
            drawn = [getattr(solid, name) for solid in sample]
            low, high = np.quantile(drawn, [part, 1 - part])
        found.append(Interval(name, value, float(low), float(high), unit="Pa"))
    return tuple(found)
