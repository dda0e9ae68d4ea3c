r"""Solids of few constants fitted to measured numbers: both power laws and the standard solid.

The sum of squares of ln(measured/fitted) is made smallest by :func:`scipy.optimize.least_squares`
over the logarithms of the constants, from the best places of a coarse search. Intervals are those
of the linearised problem; where a constant is poorly determined, those of the profile: the
constant is moved and all others refitted, until the sum of squares has grown by as much as the
confidence level allows (Venzon & Moolgavkar, Applied Statistics 37 (1988) 87-94). A profile that
never grows so far has no end on that side: the data set no bound. How much the level allows is said
by the residuals (:mod:`.fit_errors`): errors that points have in common count as what they are.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from viscotack.arrays import Array

from .fit_errors import errors
from .fit_report import Fitted, Interval, information_criterion, scatter, unit_of
from .fit_search import Search
from .observed import Observed

_POOR = 0.25  # half an interval of ln(constant) from which on the profile is asked


def fit_constants(
    data: Observed, *, model: str, known: Mapping[str, float], level: float, draws: int, seed: int
) -> Fitted:
    """Return a power law or a standard solid fitted to measured numbers.

    Parameters
    ----------
    data : Observed
        Measured numbers.
    model : str
        "power-law", "relaxation-power-law" or "sls".
    known : mapping
        Constants that are given and not fitted, by name, in SI.
    level : float
        Confidence level of the intervals, in (0, 1).
    draws : int
        How many allowed solids to draw.
    seed : int
        Of the random numbers.

    Raises
    ------
    ValueError
        If a known constant is none of the model's or impossible, or nothing is left to fit.
    """
    search = Search.of(data, model, known)
    best = search.minimum()
    residuals = data.weighed(data.residuals(search.solid(best.x)))
    known_errors = errors(data, residuals, best.jac)
    spread = scatter(residuals, len(search.free), known_errors.words())
    influences = np.linalg.pinv(best.jac)
    half = known_errors.half_width(influences, level)
    poor = bool(np.any(half > _POOR) or np.any(search.at_bound(best.x)))
    # linearised, or by the profile where a straight line is no good picture of the sum of squares
    ends = np.array([best.x - half, best.x + half]).T
    if poor:
        # an error that moves the constant by so much costs so much; what no error moves, nothing
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
    """Return the fitted solid and how many constants it took, without intervals."""
    search = Search.of(data, model, known)
    return search.solid(search.minimum().x), len(search.free)


def _draws(
    search: Search, x: Array, covariance: Array, ends: Array, count: int, seed: int
) -> tuple[Any, ...]:
    """Return solids drawn from the normal distribution of the constants, inside their bounds."""
    if not count:
        return ()
    # a constant without bound would be drawn from everywhere: it stays within its interval
    low = np.maximum(search.low, np.where(np.isfinite(ends[:, 0]), -np.inf, x - 1.0)) + 1e-9
    high = np.minimum(search.high, np.where(np.isfinite(ends[:, 1]), np.inf, x + 1.0)) - 1e-9
    # by its own axes: a constant that nothing tells makes the matrix indefinite by round-off
    value, axes = np.linalg.eigh((covariance + covariance.T) / 2)
    along = np.random.default_rng(seed).normal(size=(count, x.size))
    drawn = x + along * np.sqrt(np.maximum(value, 0.0)) @ axes.T
    return tuple(search.solid(np.clip(each, low, high)) for each in drawn)
