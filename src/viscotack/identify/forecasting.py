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

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.tack.repeats import SAME
from viscotack.model.geometry import Layer

from .contact_time import PER_DECADE
from .covariances import ModelError, SphereTests, joint_covariance, trend_covariance
from .force_ratios import by_theory, tested
from .forward import Interface, law_of
from .likelihood import Posterior
from .pull_off import Trial
from .rate_fit import EdgeFit, RateSeriesFit, edge_forces, refuse_far
from .search import SeriesFit
from .words import forecast_words, simulation_words

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
    contact_time : ndarray or None
        Time in contact [s] where it counts, shape (n,).
    posterior : Posterior
        Sampled interfaces.
    raised : ndarray
        Speeds [m/s] at which the forecast is the force measured at a slower one.
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
    contact_time: Array | None
    posterior: Posterior
    raised: Array
    words: tuple[str, ...] = ()


def forecast_rates(
    fit: RateSeriesFit,
    speed: npt.ArrayLike,
    *,
    preload: float | None = None,
    temperature: float | None = None,
    dwell: float | None = None,
    approach_speed: float | None = None,
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

    Raises
    ------
    OutOfRange
        If neither theory nor simulation holds at a speed, or the temperature is outside the
        passport's range.
    ValueError
        If an argument is invalid.
    """
    trials = _trials(fit, speed, preload, dwell=dwell, approach_speed=approach_speed)
    given, (work, gap, law) = fit.given, fit.interface
    passport = fit.passport if temperature is None else fit.passport.moved_to(temperature)
    if law is not None and passport.temperature != fit.passport.temperature:
        raise InputError(
            "an interface that grows with speed is known at the temperature of the series only, "
            f"{fit.passport.temperature:g} K, not at {passport.temperature:g} K"
        )
    known = fit.forward.beside(passport.material)
    tests = fit.search.tests._replace(forward=known, passport=passport).of(trials)
    v, time, grown = tests.speed, given.middle_times(len(trials)), 1.0
    if time is not None:
        # with the way of the drive from the start of the retraction to its pull-off
        for i, each in enumerate([] if dwell is None else v.tolist()):
            depth, force = known.curve(work, gap, each, float(tests.load[0]), law)
            off = int(np.argmin(force))
            spring = 0.0 if given.stiffness is None else (force[0] - force[off]) / given.stiffness
            time[i] = (dwell or 0.0) + (depth[0] - depth[off] + spring) / each
        grown = 1 + fit.best.values[PER_DECADE] * np.log10(time / given.middle_time)
    middle = tests.pulled(Interface(work * grown, gap, law))
    changed = tests.changed(fit.interface)
    chain = fit.sampled()
    draws = chain.thinned(_DRAWS)
    if law is not None or isinstance(known.body, Layer):
        found = by_theory(changed, v, given.theory_error)
    else:
        columns = draws["work_of_adhesion"], draws["equilibrium_gap"]
        likely = np.log(np.vstack([(work, gap), np.hstack(columns)]))
        found = tested(likely, changed, tests, given.theory_error)
    forecast = _banded(
        fit,
        tests,
        chain,
        conditioned(fit, [tests], draws, found.model, time),
        ratio=found.ratio,
        model=middle.force * np.median(np.atleast_2d(found.ratio), axis=0),
        comparable=passport.temperature == fit.passport.temperature and dwell is None,
        dwell=dwell,
        contact_time=time,
    )
    said = forecast_words(fit, forecast, middle.crack_speed)
    simulated = simulation_words(v, found.model.simulation, found.simulations)
    return replace(forecast, words=(*said, *simulated))


def forecast_edge(
    fit: EdgeFit, speed: npt.ArrayLike, *, preload: float | None = None
) -> RateForecast:
    """Predict pull-off forces with a band from a fitted edge law, as :func:`forecast_rates`.

    Raises
    ------
    OutOfRange
        If a speed is more than ten times beyond the measured ones.
    ValueError
        If an argument is invalid.
    """
    tests = fit.search.tests.of(_trials(fit, speed, preload))
    v, given, own = tests.speed, fit.given, fit.given.speed
    refuse_far(given, v)
    chain = fit.sampled()
    both, loads = np.concatenate([own, v]), np.concatenate([given.load, tests.load])
    decades = None if given.decades is None else np.append(given.decades, np.zeros(v.size))
    forces = edge_forces(given, chain.thinned(_DRAWS), both, loads, decades)
    spread = ModelError.of_theory(given.theory_error, both.size).covariance(both)
    if fit.trend:
        spread = spread + trend_covariance(both, own, fit.between_speeds)
    forecast = _banded(
        fit,
        tests,
        chain,
        _given_series(fit, spread, forces[:, : own.size], forces[:, own.size :]),
        ratio=np.ones(v.size),
        model=edge_forces(given, fit.best.values, v, tests.load),
        comparable=True,
        dwell=None,
        contact_time=given.middle_times(v.size),
    )
    return replace(forecast, words=tuple(forecast_words(fit, forecast)))


def _banded(
    fit: SeriesFit,
    tests: SphereTests,
    chain: Posterior,
    logs: tuple[Array, Array],
    *,
    ratio: Array,
    model: Array,
    comparable: bool,
    **known: Any,
) -> RateForecast:
    """Return a forecast of tests without its words.

    Parameters
    ----------
    fit, tests, chain : SeriesFit, SphereTests, Posterior
        Fit of the series, the tests and the sampled interfaces.
    logs, ratio : (ndarray, ndarray), ndarray
        ln of the forces of sampled interfaces with their covariance, and a factor on the forces.
    model : ndarray
        Forces of the model alone [N].
    comparable : bool
        Whether forces of the series at slower speeds are lower bounds.
    **known
        Dwell and time in contact of the forecast.
    """
    (moved, left), v, preload = logs, tests.speed, float(tests.load[0])
    rng = np.random.default_rng(0)
    # a square root of the covariance, which may be singular
    values, vectors = np.linalg.eigh((left + left.T) / 2)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    noise = rng.standard_normal((_TIMES, *moved.shape)) @ root.T
    sample = (np.exp(moved + noise) * ratio).reshape(-1, v.size)
    slower, uncertain = _slower(fit, v, preload, comparable)
    part = (1 - fit.level) / 2
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
    low_of_one = high_of_one = None
    if scatter := max(fit.given.scatter, *(one.between_tests for one in fit.series)):
        each = sample * np.exp(scatter * rng.standard_normal(sample.shape))
        least, most = np.quantile(each, [part, 1 - part], axis=0)
        low_of_one, high_of_one = np.minimum(least, low), np.maximum(most, high)
    return RateForecast(
        v,
        median,
        low,
        high,
        low_of_one,
        high_of_one,
        level=fit.level,
        preload=preload,
        temperature=tests.passport.temperature,
        posterior=chain,
        raised=raised,
        **known,
    )


def _departure(fit: SeriesFit, speed: Array, part: float) -> Array:
    """Return limits of measured over fitted force, interpolated by speed, shape (2, n)."""
    at, same = np.unique(fit.given.speed, return_inverse=True)
    noise = np.array([one.force.uncertainty for one in fit.series])
    off = np.log(fit.given.force / np.array(fit.forces))
    reach = NormalDist().inv_cdf(1 - part) * noise / fit.given.force
    least, most = np.full(at.size, np.inf), np.full(at.size, -np.inf)
    np.minimum.at(least, same, off - reach)
    np.maximum.at(most, same, off + reach)
    return np.exp([np.interp(np.log(speed), np.log(at), ends) for ends in (least, most)])


def interfaces(fit: RateSeriesFit, count: int, *, seed: int = 0) -> tuple[Any, ...]:
    """Return traction laws of interfaces sampled from the posterior of a series."""
    draws = fit.sampled(seed).thinned(count)
    rows = (dict(zip(draws, row, strict=True)) for row in np.hstack(list(draws.values())).tolist())
    return tuple(law_of(*fit.search.interface(row)) for row in rows)


def conditioned(
    fit: RateSeriesFit,
    asked: Sequence[SphereTests],
    draws: Mapping[str, Array],
    model: ModelError,
    time: Array | None = None,
) -> tuple[Array, Array]:
    """Return ln of the forces of tests for sampled interfaces, given the series, and a covariance.

    Parameters
    ----------
    fit : RateSeriesFit
        Fit of the series.
    asked : sequence of SphereTests
        The n tests.
    draws : mapping
        Sampled unknowns, each of shape (K, 1).
    model : ModelError
        Errors of the forces of the tests.
    time : ndarray, optional
        Time in contact of each test [s]; by default the middle one of the series.

    Returns
    -------
    moved : ndarray, shape (K, n)
        Mean of ln(force) for each interface.
    left : ndarray, shape (n, n)
        Covariance about it, by the errors of theory, material, temperature and machine that the
        series leaves open.
    """
    given, search, own = fit.given, fit.search, fit.search.tests
    speed = np.concatenate([own.speed, *(x.speed for x in asked)])
    # the error by the compliance of the machine, extrapolated to the wanted speeds
    ratio, order = search.ratio, np.argsort(own.speed)
    softer = given.compliance_uncertainty * ratio.log_ratio
    beyond = np.interp(np.log(speed[own.speed.size :]), np.log(own.speed[order]), softer[order])
    trend = np.zeros((speed.size, speed.size))
    if fit.trend:
        trend = trend_covariance(speed, own.speed, fit.between_speeds)
    error, softer = search.model.joined(model), np.append(softer, beyond)
    spread = joint_covariance(given, [own, *asked], fit.interface, error, softer, trend)
    measured = wanted = interface = search.interface(draws)
    if given.decades is not None:
        measured = interface._replace(work=interface.work * search.grown(draws))
        if time is not None:
            more = draws[PER_DECADE] * np.log10(time / given.middle_time)
            wanted = interface._replace(work=interface.work * (1 + more))
    factor = fit.yielding
    if ratio.known is not None:
        factor = ratio({name: x[:, 0] for name, x in draws.items()})
    forces = np.concatenate([x.pulled(wanted).force for x in asked], axis=1)
    return _given_series(fit, spread, own.pulled(measured).force * factor, forces)


def _given_series(fit: SeriesFit, spread: Array, own: Array, others: Array) -> tuple[Array, Array]:
    """Return ln of forces, given the measured ones, and the covariance that these leave.

    `own` and `others` are forces of the model at the measured and at other tests, and `spread` is
    the covariance of the errors of both, without noise.
    """
    m = len(fit.series)
    # covariance of the fit: noise, theory and material of the measured forces
    gain = np.asarray(np.linalg.solve(fit.search.spread, spread[:m, m:]).T, dtype=np.float64)
    logs = np.log(others) + np.log(fit.given.force / own) @ gain.T
    return logs, spread[m:, m:] - gain @ spread[:m, m:]


def _trials(
    fit: SeriesFit, speed: npt.ArrayLike, preload: float | None, **history: float | None
) -> list[Trial]:
    """Return the tests of a forecast; raise an error for numbers that are out of their ranges."""
    v = np.atleast_1d(np.asarray(speed, dtype=float))
    if not (v.ndim == 1 and 0 < v.size <= _MOST):
        raise InputError(f"a forecast needs 1 to {_MOST} speeds [m/s], got {v.size}")
    return [fit.search.tests.stated(Trial(each, preload, **history)) for each in v.tolist()]


def _slower(fit: SeriesFit, speed: Array, preload: float, comparable: bool) -> tuple[Array, Array]:
    """Return the largest force measured at a slower speed, and its relative uncertainty.

    Pull-off forces of a linear solid grow with the speed and do not fall with the preload of a
    relaxed contact. Zero where no such force was measured under the same conditions.
    """
    slower, uncertain = np.zeros(speed.size), np.zeros(speed.size)
    # at the middle time in contact; how much excluded tests grow until then is unknown
    grown = fit.search.grown(fit.best.values)
    rows = [(one, one.force.value) for one in fit.series]
    if grown is not None:
        rows = [(one, force / x) for (one, force), x in zip(rows, grown, strict=True)]
    elif isinstance(fit, RateSeriesFit):
        rows += [(one, one.force.value) for one, _ in fit.excluded]
    for one, force in rows if comparable else ():
        if one.preload is None or one.preload > (1 + SAME) * preload:
            continue
        at = (speed > (1 + SAME) * one.speed) & (force > slower)
        parts = one.force.uncertainty / one.force.value, fit.given.scatter, fit.between_speeds
        slower[at], uncertain[at] = force, np.linalg.norm(parts)
    return slower, uncertain
