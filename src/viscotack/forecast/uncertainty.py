r"""Uncertainty of a predicted force from tolerances of inputs, and which input matters.

Each input x has the factor :math:`e^{s z}` with its relative standard deviation s and a normal z,
cut at three. The logarithm of the force Y is predicted at drawn points and interpolated by radial
basis functions of z. The errors of the tier and of the interpolation are one more independent
input, so that they are part of the band and of the variance. The first-order and total indices of
Sobol,

.. math:: S_i = \frac{V[E(Y | z_i)]}{V[Y]}, \quad S_{Ti} = \frac{E[V(Y | z_{\sim i})]}{V[Y]},

are those of Saltelli et al. (2010), doi:10.1016/j.cpc.2009.09.018, as computed by SciPy.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.campaign.columns import kind_of_problem
from viscotack.errors import InputError, OutOfRange
from viscotack.problem import Case

from .answer import predict
from .prediction import Prediction
from .tiers import SOON

# Name of the error of tier and interpolation among the inputs.
TIER = "tier"
# Normal deviates of the inputs are cut here.
_CUT = 3.0
# Largest relative standard deviation, for which e^(s z) is still about 1 + s z.
_LARGEST = 0.5
# Points of the indices (a power of 2), and of the band.
_POINTS, _BAND = 2**11, 2**13
# Parts of the drawn points; each is left out once to measure the interpolation.
_FOLDS = 5
# Fewest drawn points per coefficient of a quadratic polynomial.
_PER_COEFFICIENT = 2


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Band of a predicted pull-off force, and the share of each input in its variance.

    Attributes
    ----------
    pull_off_force : float
        Predicted at the stated inputs [N]; for problems without dimensions [1.5 pi R dg0], of a
        punch the stress [Pa] or [sigma0].
    median : float
        Median over the inputs, same unit.
    interval : tuple of float
        Central interval with this confidence, same unit.
    confidence : float
        Fraction inside the interval.
    deviation : float
        Standard deviation of the logarithm of the force.
    first, total : dict of str to float
        Indices of Sobol by the path of the input, and of "tier", the error of prediction and
        interpolation.
    index_error : float
        Largest difference of an index between two sets of points.
    interpolation_error : float
        Root mean square of the relative error at left-out points.
    methods : dict of str to int
        Number of drawn points by tier.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, Groups
    >>> solid = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    >>> groups = Groups(tabor=0.5, material=solid, start=AtDepth(1.0), rate=1.0)
    >>> found = uncertainty(groups, {"tabor": 0.1}, samples=8)
    >>> sorted(found.total), found.pull_off_force < found.interval[1]
    (['tabor', 'tier'], True)
    """

    pull_off_force: float
    median: float
    interval: tuple[float, float]
    confidence: float
    deviation: float
    first: Mapping[str, float]
    total: Mapping[str, float]
    index_error: float
    interpolation_error: float
    methods: Mapping[str, int]


def uncertainty(
    problem: Case,
    deviations: Mapping[str, float],
    *,
    confidence: float = 0.9,
    samples: int = 256,
    seed: int = 0,
    budget: float = SOON,
    also: tuple[Any, ...] = (),
    progress: Callable[[float], None] = lambda share: None,
) -> Uncertainty:
    """Propagate tolerances of inputs to the pull-off force, and attribute its variance to them.

    Parameters
    ----------
    problem : Problem or Groups
        The problem at the stated inputs.
    deviations : mapping of str to float
        Relative standard deviations, independent, by the path of the input as in campaigns
        ("geometry.radius", "material.tau0"); above 0 and at most 0.5.
    confidence : float
        Fraction inside the interval, above 0 and below 1.
    samples : int
        Number of predictions, at least twice the coefficients of a quadratic polynomial.
    seed : int
        Of the points, a scrambled sequence of Sobol.
    budget : float
        Time budget of each prediction [s], as for :func:`viscotack.predict`.
    also : tuple of classes
        User-defined classes that the problem contains.
    progress : callable
        Called with the finished fraction, from 0 to 1.

    Returns
    -------
    Uncertainty
        Band and indices.

    Raises
    ------
    OutOfRange
        If no tier predicts the problem at a drawn point, or only with an interval down to zero.
    ValueError
        If a path is unknown, has no number, or a deviation is out of range; or for too few samples.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, RetardationPowerLaw
    >>> material = RetardationPowerLaw(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> groups = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=316.23)
    >>> found = uncertainty(groups, {"tabor": 0.05, "rate": 0.2}, samples=32)
    >>> found.interval[0] < found.pull_off_force < found.interval[1]
    True
    """
    names = list(deviations)
    s = np.array([deviations[name] for name in names], float)
    _check(deviations, confidence, samples)
    kind = kind_of_problem(problem, set(names), also)
    means = np.array([_number(kind.inputs, name) for name in names])
    z = _normals(len(names), samples, seed)
    pieces = []
    for done, row in enumerate(z):
        inputs = dict(zip(names, (means * np.exp(s * row)).tolist(), strict=True))
        pieces.append(_bounded(predict(kind.problem(inputs), budget=budget)))
        progress((done + 1) / (samples + 1))
    logs = np.log([_in_unit(x) for x in pieces])
    deviate = NormalDist().inv_cdf(0.95)  # of intervals of the tiers, which hold nine of ten
    widths = [np.log(x.interval[1] / x.interval[0]) / (2 * deviate) for x in pieces]
    fitted, missed = _interpolated(z, logs)
    tier = float(np.hypot(np.sqrt(np.mean(np.square(widths))), missed))

    def response(x: Array) -> Array:
        return fitted(x[:-1].T) + tier * x[-1]

    first, total, apart = _indices(response, len(names) + 1, seed)
    band = response(_normals(len(names) + 1, _BAND, seed + 1).T)
    tails = (1 - confidence) / 2, 0.5, (1 + confidence) / 2
    low, median, high = np.exp(np.quantile(band, tails)).tolist()
    every = [*names, TIER]
    return Uncertainty(
        pull_off_force=_in_unit(predict(problem, budget=budget)),
        median=median,
        interval=(low, high),
        confidence=confidence,
        deviation=float(band.std()),
        first=dict(zip(every, first.tolist(), strict=True)),
        total=dict(zip(every, total.tolist(), strict=True)),
        index_error=apart,
        interpolation_error=missed,
        methods=dict(Counter(x.method for x in pieces)),
    )


def _check(deviations: Mapping[str, float], confidence: float, samples: int) -> None:
    """Raise an error for deviations, confidence or samples that cannot be."""
    if not deviations:
        raise InputError('give the deviation of an input, for example {"geometry.radius": 0.02}')
    for name, value in deviations.items():
        if not 0 < value <= _LARGEST:
            raise InputError(
                f"the relative standard deviation of {name} must be above 0 and at most "
                f"{_LARGEST:g}, got {value:g}"
            )
    if not 0 < confidence < 1:
        raise InputError(f"the confidence must lie between 0 and 1, got {confidence:g}")
    d = len(deviations)
    least = _PER_COEFFICIENT * (d + 1) * (d + 2) // 2
    if samples < least:
        raise InputError(f"{d} inputs need at least {least} samples, got {samples}")


def _number(inputs: Mapping[str, Any], name: str) -> float:
    """Return the stated value of an input."""
    value = inputs[name].value
    if value is None or not value:
        raise InputError(f"{name} is not stated or zero, and has no relative deviation")
    return float(value)


def _normals(count: int, points: int, seed: int) -> Array:
    """Return scrambled points of Sobol as cut normal deviates, shape (points, count)."""
    from scipy.stats import qmc, truncnorm

    whole = 1 << (points - 1).bit_length()
    drawn = qmc.Sobol(count, rng=np.random.default_rng(seed)).random(whole)[:points]
    return truncnorm.ppf(drawn, -_CUT, _CUT)


def _bounded(found: Prediction) -> Prediction:
    """Return a prediction whose interval has logarithms; raise an error for another."""
    if not 0 < found.interval[0] < np.inf:
        raise OutOfRange(
            f"the interval of the tier {found.method!r} reaches down to {found.interval[0]:g}, so "
            "that its width is unknown; give more budget or smaller deviations"
        )
    return found


def _in_unit(found: Prediction) -> float:
    """Return the force in SI where the problem is."""
    scales = found.problem.scales()
    kind = found.problem.outputs
    unit = kind.observables[f"pull_off_{kind.name_of('force')}"].unit
    return found.pull_off_force * (1.0 if scales is None else getattr(scales, unit.scale))


def _interpolated(z: Array, logs: Array) -> tuple[Callable[[Array], Array], float]:
    """Return the interpolation of logarithms, and its error at left-out points."""
    from scipy.interpolate import RBFInterpolator

    errors = np.empty(len(z))
    for fold in range(_FOLDS):
        out = np.arange(len(z)) % _FOLDS == fold
        fitted = RBFInterpolator(z[~out], logs[~out], kernel="cubic", degree=1)
        errors[out] = fitted(z[out]) - logs[out]
    whole = RBFInterpolator(z, logs, kernel="cubic", degree=1)
    return whole, float(np.sqrt(np.mean(errors**2)))


def _indices(
    response: Callable[[Array], Array], count: int, seed: int
) -> tuple[Array, Array, float]:
    """Return first-order and total indices, and how far two sets of points are apart."""
    from scipy.stats import sobol_indices, truncnorm

    both = [
        sobol_indices(
            func=response,
            n=_POINTS,
            dists=[truncnorm(-_CUT, _CUT)] * count,
            rng=np.random.default_rng([seed, number]),
        )
        for number in (1, 2)
    ]
    first, total = (
        np.array([np.ravel(getattr(x, name)) for x in both])
        for name in ("first_order", "total_order")
    )
    apart = max(float(np.ptp(x, axis=0).max()) for x in (first, total))
    return first.mean(axis=0), total.mean(axis=0), apart
