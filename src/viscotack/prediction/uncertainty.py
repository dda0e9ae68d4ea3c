r"""Uncertainty of a predicted force from tolerances of inputs, and which input matters.

Each input x has the factor :math:`e^{s z}` with its relative standard deviation s and a normal z,
cut at three. A part of the problem that is known by equally likely samples, such as the solids of a
passport or the interfaces of a posterior, is one input with all its correlations: the samples are
ordered by the force that each gives at the stated other inputs, and drawn by their number. The
logarithm of the force Y is predicted at drawn points and interpolated by radial basis functions of
z, and of the logarithms of those forces. The errors of the tier and of the interpolation are one
more independent input, so that they are part of the band and of the variance. The first-order and
total indices of Sobol,

.. math:: S_i = \frac{V[E(Y | z_i)]}{V[Y]}, \quad S_{Ti} = \frac{E[V(Y | z_{\sim i})]}{V[Y]},

are those of Saltelli et al. (2010), doi:10.1016/j.cpc.2009.09.018, as computed by SciPy.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.model.materials.conversion import slowed
from viscotack.model.problem import Case
from viscotack.model.problem.rows import kind_of_problem

from .predict import predict
from .prediction import Prediction
from .tiers import SOON

# Name of the error of tier and interpolation among the inputs.
TIER = "tier"
# Parts of a problem that samples may replace, and largest number of these samples.
_SAMPLED, _MOST_SAMPLES = ("material", "traction"), 64
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
        Indices of Sobol by the path of the input, the name of a sampled part ("material",
        "traction") or of an error of the times, and of "tier", the error of prediction and
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
    deviations: Mapping[str, float] | None = None,
    *,
    sampled: Mapping[str, Sequence[Any]] | None = None,
    times: Mapping[str, float] | None = None,
    confidence: float = 0.9,
    samples: int = 256,
    seed: int = 0,
    budget: float = SOON,
    progress: Callable[[float], None] = lambda share: None,
) -> Uncertainty:
    """Propagate uncertainties of inputs to the pull-off force, and attribute its variance to them.

    Parameters
    ----------
    problem : Problem or Groups
        The problem at the stated inputs.
    deviations : mapping of str to float
        Relative standard deviations, independent, by the path of the input as in campaigns
        ("sphere.radius", "material.tau0"); above 0 and at most 0.5.
    sampled : mapping of str to sequence
        Equally likely values of "material" (:attr:`viscotack.model.materials.Passport.allowed`) or
        "traction", in place of the stated one; up to 64 of them are used.
    times : mapping of str to float
        Standard deviations of ln of all times of the material, by a name such as "temperature".
    confidence : float
        Fraction inside the interval, above 0 and below 1.
    samples : int
        Number of predictions, at least twice the coefficients of a quadratic polynomial.
    seed : int
        Of the points, a scrambled sequence of Sobol.
    budget : float
        Time budget of each prediction [s], as for :func:`viscotack.predict`.
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
    deviations, times, sampled = deviations or {}, times or {}, sampled or {}
    scattered = {**deviations, **times}
    every = [*scattered, *sampled]
    _check(deviations, times, sampled, confidence, samples)
    kind_of_problem(problem, set(deviations))  # names the unknown path

    def posed(z: Mapping[str, float], parts: Mapping[str, Any]) -> Case:
        """Return the problem with normal deviates of its numbers and with samples of its parts."""
        whole = replace(problem, **parts)
        if times:
            slower = float(np.exp(sum(s * z[name] for name, s in times.items())))
            whole = replace(whole, material=slowed(whole.material, slower))
        kind = kind_of_problem(whole, set(deviations))
        inputs = {
            name: _number(kind.inputs, name) * float(np.exp(s * z[name]))
            for name, s in deviations.items()
        }
        return kind.problem(inputs) if inputs else whole

    count = samples + sum(min(len(x), _MOST_SAMPLES) for x in sampled.values()) + 1
    done = 0

    def predicted(case: Case) -> Prediction:
        nonlocal done
        done += 1
        progress(done / count)
        return _bounded(predict(case, budget=budget))

    stated = dict.fromkeys(scattered, 0.0)
    ordered = {
        name: _ordered(values, lambda x, name=name: _in_unit(predicted(posed(stated, {name: x}))))
        for name, values in sampled.items()
    }

    def drawn(u: Array) -> tuple[Array, list[Any]]:
        """Return normal deviates of numbers, and numbers of samples, by uniform deviates."""
        columns = zip(ordered.values(), u[:, len(scattered) :].T, strict=True)
        return _normals(u[:, : len(scattered)]), [x.numbers(column) for x, column in columns]

    points = _points(len(every), samples, seed)
    z, numbers = drawn(points)
    pieces = []
    for i, row in enumerate(z.tolist()):
        chosen = zip(ordered.items(), numbers, strict=True)
        parts = {name: x.values[number[i]] for (name, x), number in chosen}
        pieces.append(predicted(posed(dict(zip(scattered, row, strict=True)), parts)))
    logs = np.log([_in_unit(x) for x in pieces])
    deviate = NormalDist().inv_cdf(0.95)  # of intervals of the tiers, which hold nine of ten
    widths = [np.log(x.interval[1] / x.interval[0]) / (2 * deviate) for x in pieces]

    def features(u: Array) -> Array:
        z, numbers = drawn(u)
        both = zip(ordered.values(), numbers, strict=True)
        return np.column_stack([z, *(x.places[number] for x, number in both)])

    fitted, missed = _interpolated(features(points), logs)
    tier = float(np.hypot(np.sqrt(np.mean(np.square(widths))), missed))

    def response(u: Array) -> Array:
        return fitted(features(u[:-1].T)) + tier * _normals(u[-1])

    first, total, apart = _indices(response, len(every) + 1, seed)
    band = response(_points(len(every) + 1, _BAND, seed + 1).T)
    tails = (1 - confidence) / 2, 0.5, (1 + confidence) / 2
    low, median, high = np.exp(np.quantile(band, tails)).tolist()
    every.append(TIER)
    return Uncertainty(
        pull_off_force=_in_unit(predicted(problem)),
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


def _check(
    deviations: Mapping[str, float],
    times: Mapping[str, float],
    sampled: Mapping[str, Sequence[Any]],
    confidence: float,
    samples: int,
) -> None:
    """Raise an error for deviations, samples of parts, confidence or samples that cannot be."""
    if not (deviations or times or sampled):
        raise InputError("give the deviation of an input, such as sphere.radius, or sampled ones")
    for name, value in deviations.items():
        if not 0 < value <= _LARGEST:
            raise InputError(
                f"the relative standard deviation of {name} must be above 0 and at most "
                f"{_LARGEST:g}, got {value:g}"
            )
    for name, value in times.items():
        if not 0 < value < np.inf:
            raise InputError(
                f"the standard deviation of ln(times) by {name} must be positive, got {value:g}"
            )
    for name, values in sampled.items():
        if name not in _SAMPLED or len(values) < 2:
            raise InputError(
                f"samples replace {' or '.join(_SAMPLED)}, two or more of them; got "
                f"{len(values)} of {name!r:.60}"
            )
    if not 0 < confidence < 1:
        raise InputError(f"the confidence must lie between 0 and 1, got {confidence:g}")
    d = len(deviations) + len(times) + len(sampled)
    least = _PER_COEFFICIENT * (d + 1) * (d + 2) // 2
    if samples < least:
        raise InputError(f"{d} inputs need at least {least} samples, got {samples}")


@dataclass(frozen=True, eq=False)
class _Ordered:
    """Samples of a part of the problem in the order of the forces that they give.

    Attributes
    ----------
    values : tuple
        The samples.
    places : ndarray
        ln of their forces over the mean, in standard deviations.
    """

    values: tuple[Any, ...]
    places: Array

    def numbers(self, u: Array) -> Any:
        """Return the numbers of the samples at uniform deviates."""
        return np.minimum((u * len(self.values)).astype(int), len(self.values) - 1)


def _ordered(values: Sequence[Any], force: Callable[[Any], float]) -> _Ordered:
    """Return samples, evenly thinned, in the order of their forces."""
    thin = np.linspace(0, len(values) - 1, min(len(values), _MOST_SAMPLES)).astype(int)
    known = [values[i] for i in thin]
    logs = np.log([force(x) for x in known])
    order = np.argsort(logs, kind="stable")
    spread = float(np.std(logs))
    return _Ordered(tuple(known[i] for i in order), (logs - logs.mean())[order] / (spread or 1.0))


def _number(inputs: Mapping[str, Any], name: str) -> float:
    """Return the stated value of an input."""
    value = inputs[name].value
    if value is None or not value:
        raise InputError(f"{name} is not stated or zero, and has no relative deviation")
    return float(value)


def _points(count: int, points: int, seed: int) -> Array:
    """Return scrambled points of Sobol between 0 and 1, shape (points, count)."""
    from scipy.stats import qmc

    whole = 1 << (points - 1).bit_length()
    return qmc.Sobol(count, rng=np.random.default_rng(seed)).random(whole)[:points]


def _normals(u: Array) -> Array:
    """Return the cut normal deviates of uniform ones."""
    from scipy.stats import truncnorm

    return truncnorm.ppf(u, -_CUT, _CUT)


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
    errors = np.empty(len(z))
    for fold in range(_FOLDS):
        out = np.arange(len(z)) % _FOLDS == fold
        errors[out] = _through(z[~out], logs[~out])(z[out]) - logs[out]
    return _through(z, logs), float(np.sqrt(np.mean(errors**2)))


def _through(z: Array, logs: Array) -> Callable[[Array], Array]:
    """Return the interpolation through points, of which samples of a part repeat some."""
    from scipy.interpolate import RBFInterpolator

    first = np.sort(np.unique(z, axis=0, return_index=True)[1])
    return RBFInterpolator(z[first], logs[first], kernel="cubic", degree=1)


def _indices(
    response: Callable[[Array], Array], count: int, seed: int
) -> tuple[Array, Array, float]:
    """Return first-order and total indices, and how far two sets of points are apart."""
    from scipy.stats import sobol_indices, uniform

    both = [
        sobol_indices(
            func=response,
            n=_POINTS,
            dists=[uniform()] * count,
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
