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
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.lab.tack.repeats import SAME
from viscotack.model.geometry import Layer
from viscotack.model.protocol import Move
from viscotack.units import readable

from .covariances import ModelError, SphereTests, joint_covariance, trend_covariance
from .edge_fit import EdgeFit, edge_forces, refuse_far
from .force_ratios import Mixed
from .forward import law_of
from .likelihood import Posterior
from .pull_off import History
from .rate_fit import RateSeriesFit
from .rate_words import forecast_words, series_forecast_words, simulation_words
from .search import LEAST_TABOR
from .series_fit import SeriesFit
from .simulated_tests import by_theory, tested

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
    given, (work, gap, law) = fit.given, fit.interface
    level = fit.level if level is None else level
    load = float(given.load.mean()) if preload is None else preload
    spring = given.stiffness if stiffness is None else stiffness
    _check(v, load, level, spring, dwell, approach_speed)
    spring = None if spring == np.inf else spring
    passport = fit.passport if temperature is None else fit.passport.moved_to(temperature)
    if law is not None and passport.temperature != fit.passport.temperature:
        raise InputError(
            "the temperature dependence of a speed-dependent interface is unknown: forecast at "
            f"the temperature of the series, {fit.passport.temperature:g} K, or measure a series "
            f"at {passport.temperature:g} K"
        )
    known, loaded = fit.forward.beside(passport.material), np.full(v.size, load)
    middle = known.pulled(work, gap, v, load, growth=law)
    pressed: tuple[tuple[Move, ...], ...] = ()
    if dwell is not None and approach_speed is not None:
        pressed = (History(approach_speed, load, dwell).moves(load),) * v.size
    tests = SphereTests(known, passport, v, loaded, spring, pressed)
    changed = tests.changed(fit.interface)
    chain = fit.sampled(seed)
    draws = chain.thinned(_DRAWS)
    theory = fit.theory if theory is None else theory
    if law is not None or isinstance(known.body, Layer):
        _refuse_low_tabor(v, middle.effective_tabor)
        found = by_theory(changed, v, theory)
    else:
        likely = np.log(np.vstack([(work, gap), draws]))
        found = tested(likely, changed, tests, theory)
    moved, left = conditioned(fit, [tests], draws, theory, found.model)
    comparable = passport.temperature == fit.passport.temperature and dwell is None
    band, raised = _banded(
        fit,
        v,
        load,
        moved=moved,
        left=left,
        ratio=found.ratio,
        model=middle.force * np.median(np.atleast_2d(found.ratio), axis=0),
        comparable=comparable and spring == given.stiffness,
        level=level,
        seed=seed,
    )
    return RateForecast(
        **band,
        temperature=passport.temperature,
        dwell=dwell,
        posterior=chain,
        words=(
            *forecast_words(fit, v, middle.crack_speed, chain, raised),
            *simulation_words(v, found.model.simulation, found.simulations),
        ),
    )


def forecast_edge(
    fit: EdgeFit,
    speed: npt.ArrayLike,
    *,
    preload: float | None = None,
    level: float | None = None,
    seed: int = 0,
) -> RateForecast:
    """Predict pull-off forces with a band from a fitted edge law, as :func:`forecast_rates`.

    Raises
    ------
    OutOfRange
        If a speed is more than ten times beyond the measured ones.
    ValueError
        If an argument is invalid.
    """
    v = np.atleast_1d(np.asarray(speed, dtype=float))
    given, own = fit.given, fit.given.speed
    level = fit.level if level is None else level
    load = float(given.load.mean()) if preload is None else preload
    _check(v, load, level, None, None, None)
    refuse_far(given, v)
    chain = fit.sampled(seed)
    names, draws = list(fit.best.values), chain.thinned(_DRAWS)
    laws = {name: draws[:, i : i + 1] for i, name in enumerate(names)}
    both, m = np.concatenate([own, v]), own.size
    loads = np.concatenate([given.load, np.full(v.size, load)])
    forces = edge_forces(given, laws, both, loads)
    spread = ModelError.of_theory(fit.theory, both.size).covariance(both)
    if fit.trend:
        spread = spread + trend_covariance(both, own, fit.between_speeds)
    gain, left = _left_open(fit, spread)
    band, raised = _banded(
        fit,
        v,
        load,
        moved=np.log(forces[:, m:]) + np.log(given.force / forces[:, :m]) @ gain.T,
        left=left,
        ratio=np.ones(v.size),
        model=edge_forces(given, fit.best.values, v, load),
        comparable=True,
        level=level,
        seed=seed,
    )
    return RateForecast(
        **band,
        temperature=fit.passport.temperature,
        dwell=None,
        posterior=chain,
        words=tuple(series_forecast_words(fit, v, chain, raised, "the law alone")),
    )


def _banded(
    fit: SeriesFit,
    v: Array,
    load: float,
    *,
    moved: Array,
    left: Array,
    ratio: Array,
    model: Array,
    comparable: bool,
    level: float,
    seed: int,
) -> tuple[dict[str, Any], Array]:
    """Return force and band of a forecast, and the speeds where it is a measured force.

    Parameters
    ----------
    fit : SeriesFit
        Fit of the series.
    v, load : ndarray, float
        Speeds [m/s] and preload [N].
    moved, left, ratio : ndarray
        ln of the forces of sampled interfaces, their covariance, and a factor on the forces.
    model : ndarray
        Forces of the model alone [N].
    comparable : bool
        Whether forces of the series at slower speeds are lower bounds.
    level, seed : float, int
        Confidence level, and seed of the random numbers.
    """
    rng = np.random.default_rng(seed)
    noise = rng.standard_normal((_TIMES, *moved.shape)) @ _root(left).T
    sample = (np.exp(moved + noise) * ratio).reshape(-1, v.size)
    slower, uncertain = _slower(fit, v, load, comparable)
    part = (1 - level) / 2
    # only where noise does not explain the larger force, the band rises, too
    surely = slower * (1 - _SURELY * uncertain) > np.median(sample, axis=0)
    floor = slower * (1 + uncertain * rng.standard_normal((len(sample), 1)))
    sample = np.where(surely, np.maximum(sample, floor), sample)
    low, median, high = np.quantile(sample, [part, 0.5, 1 - part], axis=0)
    if not fit.describes_tests:
        # no band excludes the tests that the model does not describe
        least, most = model * _departure(fit, v, part)
        low, high = np.minimum(low, least), np.maximum(high, most)
    raised = v[slower > median]
    median, high = np.maximum(median, slower), np.maximum(high, slower)
    one = _of_one(fit, sample, rng, part)
    band = {
        "speed": v,
        "force": median,
        "low": low,
        "high": high,
        "low_of_one": None if one is None else np.minimum(one[0], low),
        "high_of_one": None if one is None else np.maximum(one[1], high),
        "level": level,
        "preload": load,
    }
    return band, raised


def _departure(fit: SeriesFit, speed: Array, part: float) -> Array:
    """Return limits of measured over fitted force, interpolated by speed, shape (2, n)."""
    order = np.argsort(fit.given.speed)
    force = fit.given.force[order]
    noise = np.array([one.force.uncertainty for one in fit.series])[order]
    off = np.log(force / np.array(fit.forces)[order])
    reach = NormalDist().inv_cdf(1 - part) * noise / force
    wanted, at = np.log(speed), np.log(fit.given.speed[order])
    return np.exp([np.interp(wanted, at, off + sign * reach) for sign in (-1, 1)])


def _of_one(fit: SeriesFit, sample: Array, rng: np.random.Generator, part: float) -> Array | None:
    """Return the limits of single tests [N], shape (2, n), from means; None without a scatter."""
    scatter = max(fit.given.scatter, *(one.between_tests for one in fit.series))
    if not scatter:
        return None
    each = sample * np.exp(scatter * rng.standard_normal(sample.shape))
    return np.quantile(each, [part, 1 - part], axis=0)


def interfaces(fit: RateSeriesFit, count: int, *, seed: int = 0) -> tuple[Any, ...]:
    """Return traction laws of interfaces sampled from the posterior of a series."""
    growth = fit.growth
    laws = []
    for w, gap, *more in fit.sampled(seed).thinned(count).tolist():
        grows = None if growth is None else growth.opening.growth(gap, *more)
        laws.append(law_of(w, gap, grows))
    return tuple(laws)


def conditioned(
    fit: RateSeriesFit,
    asked: Sequence[SphereTests],
    draws: Array,
    theory: float,
    model: ModelError,
) -> tuple[Array, Array]:
    """Return ln of the forces of tests for sampled interfaces, given the series, and a covariance.

    Parameters
    ----------
    fit : RateSeriesFit
        Fit of the series.
    asked : sequence of SphereTests
        The n tests.
    draws : ndarray, shape (K, parameters)
        Sampled interfaces.
    theory : float
        Relative standard error of the forward model at the measured speeds.
    model : ModelError
        Errors of the forces of the tests.

    Returns
    -------
    moved : ndarray, shape (K, n)
        Mean of ln(force) for each interface.
    left : ndarray, shape (n, n)
        Covariance about it, by the errors of theory, material, temperature and machine that the
        series leaves open.
    """
    given, m = fit.given, len(fit.series)
    own = fit.found.search.tests
    speed = np.concatenate([own.speed, *(x.speed for x in asked)])
    simulation = fit.found.search.model.simulation
    measured = ModelError(np.where(simulation > 0, 0.0, theory), simulation)
    springy = np.concatenate([np.full(x.speed.size, x.stiffness is not None) for x in asked])
    softer = _softer(fit, speed[m:], springy)
    trend = np.zeros((speed.size, speed.size))
    if fit.trend:
        trend = trend_covariance(speed, own.speed, fit.between_speeds)
    tests, error = [own, *asked], measured.joined(model)
    spread = joint_covariance(given, tests, fit.interface, error, softer, trend)
    gain, left = _left_open(fit, spread)
    works, gaps, laws = draws[:, :1], draws[:, 1:2], None
    if fit.growth is not None:
        laws = fit.growth.opening.growth(gaps, draws[:, 2:3], draws[:, 3:])
    at, *others = (
        x.forward.pulled(works, gaps, x.speed, x.load, growth=laws).force for x in (own, *asked)
    )
    ratio = fit.yielding
    if isinstance(fit.found.search.ratio, Mixed):
        values = {"work_of_adhesion": draws[:, 0], "equilibrium_gap": draws[:, 1]}
        ratio = fit.found.search.ratio(values)
    forecast: Array = np.log(np.concatenate(others, axis=1))
    return forecast + np.log(given.force / (at * ratio)) @ gain.T, left


def _left_open(fit: SeriesFit, spread: Array) -> tuple[Array, Array]:
    """Return the gain by the measured forces, and the covariance of others that they leave.

    `spread` is the covariance of the errors of the measured forces, without noise, and the others.
    """
    m = len(fit.series)
    # covariance of the fit: noise, theory and material of the measured forces
    gain = np.asarray(np.linalg.solve(fit.covariance, spread[:m, m:]).T, dtype=np.float64)
    return gain, spread[m:, m:] - gain @ spread[:m, m:]


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


def _slower(fit: SeriesFit, speed: Array, preload: float, comparable: bool) -> tuple[Array, Array]:
    """Return the largest force measured at a slower speed, and its relative uncertainty.

    Pull-off forces of a linear solid grow with the speed and do not fall with the preload of a
    relaxed contact. Zero where no such force was measured under the same conditions.
    """
    slower, uncertain = np.zeros(speed.size), np.zeros(speed.size)
    excluded = fit.excluded if isinstance(fit, RateSeriesFit) else ()
    for one in (*fit.series, *(one for one, _ in excluded)) if comparable else ():
        if one.preload is None or one.preload > (1 + SAME) * preload:
            continue
        at = (speed > (1 + SAME) * one.speed) & (one.force.value > slower)
        parts = one.force.uncertainty / one.force.value, fit.given.scatter, fit.between_speeds
        slower[at], uncertain[at] = one.force.value, np.linalg.norm(parts)
    return slower, uncertain


def _refuse_low_tabor(speed: Array, effective: Array) -> None:
    bad = effective < LEAST_TABOR
    if np.any(bad):
        raise OutOfRange(
            f"at {readable(speed[bad].min(), 'm/s', digits=3)} the cohesive zone is as "
            "large as the contact, so the theory does not hold; choose slower speeds, or simulate"
        )


def _softer(fit: RateSeriesFit, wanted: Array, springy: npt.NDArray[np.bool_]) -> Array:
    """Return the error of ln(force) by the compliance of the machine, at both sets of speeds.

    It counts at the wanted speeds where the machine is springy.
    """
    ratio, measured = fit.found.search.ratio, fit.given.speed
    yielding = ratio.others if isinstance(ratio, Mixed) else ratio
    error, order = fit.given.compliance_error * yielding.log_ratio, np.argsort(measured)
    beyond = np.interp(np.log(wanted), np.log(measured[order]), error[order])
    return np.concatenate([error, beyond * springy])


def _root(covariance: Array) -> Array:
    """Return a square root of a covariance that may be singular."""
    values, vectors = np.linalg.eigh((covariance + covariance.T) / 2)
    return vectors * np.sqrt(np.maximum(values, 0.0))
