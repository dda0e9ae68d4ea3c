r"""Predict pull-off forces from a rate series at other speeds, loads and temperatures.

Interfaces are sampled from the posterior of the series. For each sample, the errors of theory and
material in ln of the measured forces (m) and predicted forces (f) have the covariance

.. math:: C = \begin{pmatrix} C_{mm} + N & C_{mf} \\ C_{fm} & C_{ff} \end{pmatrix} ,

where N is the noise of the measured forces. Given their residuals r, the prediction is normal with
mean :math:`C_{fm} (C_{mm} + N)^{-1} r` and covariance
:math:`C_{ff} - C_{fm} (C_{mm} + N)^{-1} C_{mf}`. Near measured speeds it follows the data, far from
them the model. Where the forces depart from the model by a power of the speed, the forecast
continues it; where the fit does not describe the tests, the band is widened to hold them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.geometry import Layer
from viscotack.materials import Passport
from viscotack.materials.conversion import slowed
from viscotack.materials.passport_uncertainty import allowed
from viscotack.protocol import Move
from viscotack.units import readable

from .covariances import (
    ModelError,
    covariance,
    log_forces,
    temperature_effect,
    trend_covariance,
)
from .forward import Forward, law_of
from .pull_off import SAME, History
from .rate_series import RateSeriesFit
from .sampling import Posterior, posterior
from .search import LEAST_TABOR
from .smooth_ratio import Mixed
from .tiers import Conditions, by_theory, tested

_MOST = 200  # largest number of speeds
_SURELY = 2.0  # standard deviations of a measured force
_DRAWS, _TIMES = 200, 10  # number of sampled interfaces, and of forces per interface


@dataclass(frozen=True, eq=False)
class RateForecast:
    """Predicted pull-off forces with a band.

    Parameters
    ----------
    speed : ndarray, shape (n,)
        Retraction speed [m/s].
    force, low, high : ndarray, shape (n,)
        Median and limits of the band [N], for the mean of many tests, without the noise of a single
        one.
    low_of_one, high_of_one : ndarray, shape (n,), or None
        Limits for a single test [N], with the scatter between tests; None if no repeats show it.
    level : float
        Confidence level of the band.
    preload, temperature : float, float or None
        Preload [N] and temperature [K] of the prediction.
    dwell : float or None
        Time under the preload [s]; None for a contact that has relaxed.
    posterior : Posterior
        Sampled interfaces.
    words : tuple of str
        Remarks on the validity.
    """

    speed: Array
    force: Array
    low: Array
    high: Array
    low_of_one: Array | None
    high_of_one: Array | None
    level: float
    preload: float
    temperature: float | None
    dwell: float | None
    posterior: Posterior
    words: tuple[str, ...]


def forecast_rates(
    fit: RateSeriesFit,
    speed: npt.ArrayLike,
    *,
    preload: float | None = None,
    temperature: float | None = None,
    dwell: float | None = None,
    approach_speed: float | None = None,
    stiffness: float | None = None,
    theory: float | None = None,
    level: float | None = None,
    seed: int = 0,
) -> RateForecast:
    """Predict pull-off forces with a band from a fitted rate series.

    Parameters
    ----------
    fit : RateSeriesFit
        Fit of the series.
    speed : array_like, shape (n,)
        Retraction speed [m/s].
    preload : float, optional
        Force under which the contact relaxes [N]; by default the mean preload of the series.
    temperature : float, optional
        Temperature [K]; by default that of the series. The passport must contain a shift.
    dwell : float, optional
        Time under the preload [s], after an approach at `approach_speed`; by default the contact
        relaxes fully.
    approach_speed : float, optional
        Approach speed [m/s]; required with `dwell`.
    stiffness : float, optional
        Stiffness of the machine [N/m], inf for a rigid one; by default that of the series.
    theory : float, optional
        Relative standard uncertainty of the forward model; by default that of the fit.
    level : float, optional
        Confidence level of the band; by default that of the fit.
    seed : int
        Seed of the random numbers.

    Raises
    ------
    OutOfRange
        If neither theory nor simulation holds at a speed, or the temperature is outside the
        passport's range.
    ValueError
        If an argument is invalid.
    """
    v = np.atleast_1d(np.asarray(speed, dtype=float))
    level = fit.level if level is None else level
    loads = np.array([one.preload for one in fit.series], dtype=float)
    load = float(loads.mean()) if preload is None else preload
    spring = fit.stiffness if stiffness is None else stiffness
    _check(v, load, level, spring, dwell, approach_speed)
    passport = fit.passport if temperature is None else fit.passport.moved_to(temperature)
    _check_growth(fit, passport)
    known = fit.forward.beside(passport.material)
    w, gap = fit.work_of_adhesion, fit.equilibrium_gap
    law = None if fit.growth is None else fit.growth.law
    middle = known.pulled(w, gap, v, load, growth=law)
    pressed: tuple[tuple[Move, ...], ...] = ()
    if dwell is not None and approach_speed is not None:
        pressed = (History(approach_speed, load, dwell).moves(load),) * v.size
    spring = None if spring == np.inf else spring
    loaded = np.full(v.size, load)
    changed = known.changed(w, gap, v, loaded, stiffness=spring, moves=pressed, growth=law)
    chain = posterior(fit.objective, fit.best, others=fit.solutions[1:], seed=seed)
    draws = chain.thinned(_DRAWS)
    theory = fit.theory if theory is None else theory
    if law is not None or isinstance(known.body, Layer):
        _refuse(v, middle.effective_tabor)
        found = by_theory(changed, theory)
    else:
        interfaces = np.log(np.vstack([(w, gap), draws]))
        found = tested(interfaces, changed, known, Conditions(v, loaded, spring, pressed), theory)
    for i, why in found.refused.items():
        raise OutOfRange(f"at {readable(v[i], 'm/s', digits=3)}: {why}")

    asked = [Tests(known, passport, v, loaded)]
    moved, left = conditioned(fit, asked, draws, theory, found.model, spring is not None)
    root = _root(left)
    rng = np.random.default_rng(seed)
    noise = rng.standard_normal((_TIMES, *moved.shape)) @ root.T
    sample = (np.exp(moved + noise) * found.ratio).reshape(-1, v.size)
    slower, uncertain = _slower(fit, v, load, passport, spring, dwell)
    part = (1 - level) / 2
    # only where noise does not explain the larger force, the band rises, too
    surely = slower * (1 - _SURELY * uncertain) > np.median(sample, axis=0)
    floor = slower * (1 + uncertain * rng.standard_normal((len(sample), 1)))
    sample = np.where(surely, np.maximum(sample, floor), sample)
    low, median, high = np.quantile(sample, [part, 0.5, 1 - part], axis=0)
    if fit.misfit:
        # no band excludes the tests that the model does not describe
        model = middle.force * np.median(np.atleast_2d(found.ratio), axis=0)
        least, most = model * _departure(fit, v, part)
        low, high = np.minimum(low, least), np.maximum(high, most)
    raised = slower > median
    median, high = np.maximum(median, slower), np.maximum(high, slower)
    one = _of_one(fit, sample, rng, part)
    return RateForecast(
        v,
        median,
        low,
        high,
        None if one is None else np.minimum(one[0], low),
        None if one is None else np.maximum(one[1], high),
        level,
        load,
        passport.temperature,
        dwell,
        chain,
        tuple(
            [
                *_words(fit, v, middle.crack_speed, chain),
                *found.words,
                *_raised_words(v[raised]),
            ]
        ),
    )


def _departure(fit: RateSeriesFit, speed: Array, part: float) -> Array:
    """Return limits of measured over fitted force, interpolated by speed, shape (2, n)."""
    order = np.argsort([one.speed for one in fit.series])
    at, force, noise = np.array(
        [(one.speed, one.force.value, one.force.uncertainty) for one in fit.series]
    )[order].T
    off = np.log(force / np.array(fit.forces)[order])
    reach = NormalDist().inv_cdf(1 - part) * noise / force
    wanted, at = np.log(speed), np.log(at)
    return np.exp([np.interp(wanted, at, off + sign * reach) for sign in (-1, 1)])


def _of_one(
    fit: RateSeriesFit, sample: Array, rng: np.random.Generator, part: float
) -> Array | None:
    """Return the limits of single tests [N], shape (2, n), from means; None without a scatter."""
    scatter = max(fit.between_tests, *(one.between_tests for one in fit.series))
    if not scatter:
        return None
    each = sample * np.exp(scatter * rng.standard_normal(sample.shape))
    return np.quantile(each, [part, 1 - part], axis=0)


def interfaces(fit: RateSeriesFit, count: int, *, seed: int = 0) -> tuple[Any, ...]:
    """Return traction laws of interfaces sampled from the posterior of a series."""
    chain = posterior(fit.objective, fit.best, others=fit.solutions[1:], seed=seed)
    draws = chain.thinned(count)
    growth = fit.growth
    laws = []
    for w, gap, *more in draws.tolist():
        grows = None if growth is None else growth.opening.growth(gap, *more)
        laws.append(law_of(w, gap, grows))
    return tuple(laws)


class Tests(NamedTuple):
    """Tests of one sphere at one temperature whose forces are predicted.

    Attributes
    ----------
    forward : Forward
        Forward model of the sphere and the material.
    passport : Passport
        The material at the temperature of the tests.
    speed, load : ndarray, shape (n,)
        Retraction speed [m/s] and preload [N].
    """

    forward: Forward
    passport: Passport
    speed: Array
    load: Array


def conditioned(
    fit: RateSeriesFit,
    asked: Sequence[Tests],
    draws: Array,
    theory: float,
    model: ModelError,
    springy: bool,
) -> tuple[Array, Array]:
    """Return ln of the forces of tests for sampled interfaces, given the series, and a covariance.

    Parameters
    ----------
    fit : RateSeriesFit
        Fit of the series.
    asked : sequence of Tests
        The n tests.
    draws : ndarray, shape (K, parameters)
        Sampled interfaces.
    theory : float
        Relative standard error of the forward model at the measured speeds.
    model : ModelError
        Errors of the forces of the tests.
    springy : bool
        Whether the compliance of the machine counts at the tests.

    Returns
    -------
    moved : ndarray, shape (K, n)
        Mean of ln(force) for each interface.
    left : ndarray, shape (n, n)
        Covariance about it, by the errors of theory, material, temperature and machine that the
        series leaves open.
    """
    measured = np.array([one.speed for one in fit.series])
    loads = np.array([one.preload for one in fit.series], dtype=float)
    m = measured.size
    own = Tests(fit.forward, fit.passport, measured, loads)
    spread = _together(fit, (own, *asked), _model(fit, theory).joined(model), springy)
    # covariance of the fit: noise, theory and material of the measured forces
    gain = np.linalg.solve(fit.covariance, spread[:m, m:]).T
    left = spread[m:, m:] - gain @ spread[:m, m:]
    works, gaps = draws[:, :1], draws[:, 1:2]
    laws = None
    if fit.growth is not None:
        laws = fit.growth.opening.growth(gaps, draws[:, 2:3], draws[:, 3:])
    forecast: Array = np.concatenate(
        [np.log(x.forward.pulled(works, gaps, x.speed, x.load, growth=laws).force) for x in asked],
        axis=1,
    )
    at = fit.forward.pulled(works, gaps, measured, loads, growth=laws).force
    ratio = fit.yielding
    if isinstance(fit.ratio, Mixed):
        ratio = fit.ratio({"work_of_adhesion": draws[:, 0], "equilibrium_gap": draws[:, 1]})
    force = np.array([one.force.value for one in fit.series])
    return forecast + np.log(force / (at * ratio)) @ gain.T, left


def _check(
    speed: Array,
    preload: float,
    level: float,
    stiffness: float | None,
    dwell: float | None,
    approach: float | None,
) -> None:
    if not (speed.ndim == 1 and 0 < speed.size <= _MOST and np.all(speed > 0)):
        raise InputError(f"a forecast needs 1 to {_MOST} positive speeds [m/s], got {speed!r}")
    if not (preload > 0 and 0 < level < 1):
        raise InputError(
            f"preload must be positive and level between 0 and 1, got {preload} N and {level}"
        )
    if stiffness is not None and not stiffness > 0:
        raise InputError(f"the stiffness of a machine must be positive, got {stiffness} N/m")
    if (dwell is None) != (approach is None):
        raise InputError("dwell and approach_speed must be given together")
    if dwell is not None and approach is not None and not (dwell >= 0 and approach > 0):
        raise InputError(
            f"dwell must not be negative and approach_speed must be positive, got {dwell} s, "
            f"{approach} m/s"
        )


def _slower(
    fit: RateSeriesFit,
    speed: Array,
    preload: float,
    passport: Passport,
    stiffness: float | None,
    dwell: float | None,
) -> tuple[Array, Array]:
    """Return the largest force measured at a slower speed, and its relative uncertainty.

    Pull-off forces of a linear solid grow with the speed and do not fall with the preload of a
    relaxed contact. Zero where no such force was measured under the same conditions.
    """
    same = passport.temperature == fit.passport.temperature and dwell is None
    slower, uncertain = np.zeros(speed.size), np.zeros(speed.size)
    if not same or stiffness != fit.stiffness:
        return slower, uncertain
    for one in (*fit.series, *fit.excluded):
        if one.preload is None or one.preload > (1 + SAME) * preload:
            continue
        at = (speed > (1 + SAME) * one.speed) & (one.force.value > slower)
        parts = one.force.uncertainty / one.force.value, fit.between_tests, fit.between_speeds
        slower[at], uncertain[at] = one.force.value, np.linalg.norm(parts)
    return slower, uncertain


def _raised_words(speed: Array) -> list[str]:
    if not speed.size:
        return []
    at = readable(float(speed.min()), "m/s", digits=3, to=float(speed.max()))
    return [
        f"at {at} the model predicts less than was measured at a slower speed; there the forecast "
        "is the measured force"
    ]


def _check_growth(fit: RateSeriesFit, passport: Passport) -> None:
    if fit.growth is not None and passport.temperature != fit.passport.temperature:
        raise InputError(
            "the temperature dependence of a speed-dependent interface is unknown: forecast at "
            f"the temperature of the series, {fit.passport.temperature:g} K, or measure a series "
            f"at {passport.temperature:g} K"
        )


def _refuse(speed: Array, effective: Array) -> None:
    bad = effective < LEAST_TABOR
    if np.any(bad):
        raise OutOfRange(
            f"at {readable(speed[bad].min(), 'm/s', digits=3)} the cohesive zone is as "
            "large as the contact, so the theory does not hold; choose slower speeds, or simulate"
        )


def _model(fit: RateSeriesFit, theory: float) -> ModelError:
    """Return the errors of the measured forces, for this error of the theory."""
    simulation = fit.model_error.simulation
    return ModelError(np.where(simulation > 0, 0.0, theory), simulation)


def _together(
    fit: RateSeriesFit, tests: Sequence[Tests], model: ModelError, springy: bool
) -> Array:
    """Return the joint covariance of model, material and machine over all tests.

    Where the forces depart from the model by a power of the speed, that is in it too. The first are
    those of the series; the machine counts at the others if it is `springy` there.
    """
    speed = np.concatenate([x.speed for x in tests])
    m = tests[0].speed.size
    w, gap = fit.work_of_adhesion, fit.equilibrium_gap
    more = [x.forward.layer_error(w, gap, x.speed, x.load) for x in tests]
    spread = replace(model, theory=model.theory + np.concatenate(more)).covariance(speed)
    law = None if fit.growth is None else fit.growth.law
    # one thermometer and one machine for all tests
    shifts = [replace(fit.uncertain, passport=x.passport).shift for x in tests]
    warmer = np.concatenate(
        [
            temperature_effect(x.forward, error, w, gap, x.speed, x.load, law)
            for x, error in zip(tests, shifts, strict=True)
        ]
    )
    warmer[:m] *= fit.uncertain.shifts(fit.series)
    softer = _softer(fit, speed[:m], speed[m:], springy)
    spread = spread + np.outer(warmer, warmer) + np.outer(softer, softer)
    if fit.trend:
        spread = spread + trend_covariance(speed, speed[:m], fit.between_speeds)
    solids = allowed(fit.passport)
    if not solids:
        return spread
    rows = []
    for x in tests:
        known = x.passport is fit.passport or x.passport.allowed
        moved = allowed(x.passport) if known else _slowed(fit.passport, x.passport, solids)
        rows.append(log_forces(x.forward, moved, w, gap, x.speed, x.load, law))
    return spread + covariance(np.concatenate(rows, axis=1))


def _softer(fit: RateSeriesFit, measured: Array, wanted: Array, springy: bool) -> Array:
    """Return the error of ln(force) by the compliance of the machine, at both sets of speeds."""
    yielding = fit.ratio.others if isinstance(fit.ratio, Mixed) else fit.ratio
    error, order = fit.uncertain.compliance * yielding.log_ratio, np.argsort(measured)
    beyond = np.interp(np.log(wanted), np.log(measured[order]), error[order])
    return np.concatenate([error, beyond * springy])


def _slowed(first: Passport, second: Passport, solids: Sequence[object]) -> Sequence[object]:
    """Return solids sampled from a passport's intervals at another temperature."""
    if second.temperature == first.temperature or second.temperature is None:
        return solids
    factor = first.shift_factor(second.temperature)
    return [slowed(solid, factor) for solid in solids]


def _root(covariance: Array) -> Array:
    """Return a square root of a covariance that may be singular."""
    values, vectors = np.linalg.eigh((covariance + covariance.T) / 2)
    return vectors * np.sqrt(np.maximum(values, 0.0))


def _words(fit: RateSeriesFit, speed: Array, crack: Array, chain: Posterior) -> list[str]:
    said = []
    measured = [one.speed for one in fit.series]
    if speed.min() < 0.5 * min(measured) or speed.max() > 2 * max(measured):
        said.append(
            "measured speeds range from "
            f"{readable(min(measured), 'm/s', digits=3, to=max(measured))}; beyond them the "
            "prediction depends on the material and the theory"
        )
    said.append(
        f"the crack speed at pull-off is {readable(crack.min(), 'm/s', digits=2, to=crack.max())}"
    )
    if len(fit.solutions) > 1:
        said.append(f"the band covers the {len(fit.solutions)} interfaces that fit the forces")
    if not chain.converged:
        said.append(
            "too few independent samples of the posterior: the correlation time is "
            f"{chain.correlation_time:.0f} steps"
        )
    if not allowed(fit.passport):
        said.append("the band does not include the uncertainty of the material, which is unknown")
    return said
