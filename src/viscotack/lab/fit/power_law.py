r"""Fit solids with few constants: both power laws, the fractional solids and the standard solid.

:func:`scipy.optimize.least_squares` minimises the sum of squares of ln(measured/fitted)
over the logarithms of the constants, from the best starts of a coarse search. Intervals are those
of the linearised problem; for a poorly determined constant, those of the profile: the
constant is varied and all others refitted, until the sum of squares exceeds the limit of the
confidence level (Venzon & Moolgavkar, Applied Statistics 37 (1988) 87-94). If the profile never
reaches the limit, the interval has no bound on that side. The limit follows from the residuals,
including correlated errors (:mod:`.errors`).
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from viscotack.arrays import Array

from .errors import errors
from .observed import Observed
from .report import Fitted, Interval, information_criterion, scatter, unit_of
from .search import Search

_POOR = 0.25  # half-width of the interval of ln(constant) above which the profile is computed


def fit_constants(
    data: Observed, *, model: str, known: Mapping[str, float], level: float, draws: int, seed: int
) -> Fitted:
    """Fit a power law or a standard solid to measured numbers.

    Parameters
    ----------
    data : Observed
        Measured numbers.
    model : str
        "power-law", "relaxation-power-law" or "sls".
    known : mapping
        Constants that are given, not fitted, by name, in SI.
    level : float
        Confidence level of the intervals, in (0, 1).
    draws : int
        Number of solids to sample.
    seed : int
        Of the random numbers.

    Raises
    ------
    ValueError
        If a known constant is unknown to the model or impossible, or nothing is left to fit.
    """
    search = Search.of(data, model, known)
    best = search.minimum()
    residuals = data.weighed(data.residuals(search.solid(best.x)))
    known_errors = errors(data, residuals, best.jac)
    spread = scatter(residuals, len(search.free), known_errors.words())
    influences = np.linalg.pinv(best.jac)
    half = known_errors.half_width(influences, level)
    poor = bool(np.any(half > _POOR) or np.any(search.at_bound(best.x)))
    # linearised, or by the profile where the linearisation is poor
    ends = np.array([best.x - half, best.x + half]).T
    if poor:
        # limit on the sum of squares; zero for a constant without influence
        moved = np.sum(influences**2, axis=1)
        more = np.divide(half**2, moved, out=np.full(half.size, np.inf), where=moved > 0)
        allowed = 2 * best.cost + more
        ends = np.array(
            [
                [search.profile_end(best.x, i, side, half[i], allowed[i]) for side in (-1, 1)]
                for i in range(len(search.free))
            ]
        )
    material = search.solid(best.x)
    found = dict(zip(search.free, np.exp(ends), strict=True))
    intervals = tuple(
        Interval(name, value, *map(float, found[name]), unit=unit_of(name))
        if name in found
        else Interval(name, value, value, value, unit=unit_of(name), known=True)
        for name in search.names
        for value in [float(getattr(material, name))]
    )
    sample = _draws(search, best.x, known_errors.covariance(influences), ends, draws, seed)
    criterion = information_criterion(residuals, len(search.free))
    return Fitted(material, intervals, spread, len(search.free), criterion, sample)


def fitted_constants(data: Observed, *, model: str, known: Mapping[str, float]) -> tuple[Any, int]:
    """Return the fitted solid and its number of constants, without intervals."""
    search = Search.of(data, model, known)
    return search.solid(search.minimum().x), len(search.free)


def _draws(
    search: Search, x: Array, covariance: Array, ends: Array, count: int, seed: int
) -> tuple[Any, ...]:
    """Sample solids from the normal distribution of the constants, within their bounds."""
    if not count:
        return ()
    # the spread of an unbounded constant is limited to its interval
    low = np.maximum(search.low, np.where(np.isfinite(ends[:, 0]), -np.inf, x - 1.0)) + 1e-9
    high = np.minimum(search.high, np.where(np.isfinite(ends[:, 1]), np.inf, x + 1.0)) - 1e-9
    # by eigenvectors: an undetermined constant makes the matrix indefinite by round-off
    value, axes = np.linalg.eigh((covariance + covariance.T) / 2)
    along = np.random.default_rng(seed).normal(size=(count, x.size))
    drawn = x + along * np.sqrt(np.maximum(value, 0.0)) @ axes.T
    return tuple(search.solid(np.clip(each, low, high)) for each in drawn)
