"""Sentences on fits and forecasts of rate series, made from their numbers at the end."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from viscotack.arrays import Array
from viscotack.model.geometry import Layer
from viscotack.model.materials.passport import allowed
from viscotack.theory.crack.contact.recession import ERROR_BY_ZONE
from viscotack.units import readable, readable_interval

from .contact_time import PER_DECADE
from .likelihood import EVIDENCE, Interval
from .rate_series import DIFFERENT, apart, assumed_temperature, celsius, unshiftable

if TYPE_CHECKING:
    from .forecasting import RateForecast
    from .rate_fit import EdgeFit, RateSeriesFit
    from .search import SeriesFit

_speed = partial(readable, unit="m/s", digits=3)
_size = partial(readable, unit="m", digits=3)
_time = partial(readable, unit="s", digits=2)
_NAMED = 4  # largest number of tests, or of speeds, that are named one by one
_LEFT = 0.05  # part of the modulus that has not relaxed, from which a caution is given
_CHANCE = 0.01  # accepted probability that a series without growth is reported to need it
_LABELS = {
    PER_DECADE: ("growth of the work of adhesion in a decade of contact time", ""),
    "work_of_adhesion": ("work of adhesion", "J/m2"),
    "equilibrium_gap": ("range of attraction h0", "m"),
    "strengthening": ("strengthening", ""),
    "reference_speed": ("reference speed v0", "m/s"),
    "exponent": ("exponent n", ""),
}


def fit_words(fit: RateSeriesFit) -> Iterator[str]:
    """Yield sentences on a fit that describes its tests, or not."""
    given, growth = fit.given, fit.growth
    yield from _of_misfit(fit)
    yield from _of_unknowns(fit)
    if growth is not None:
        needed = "grows with speed" if growth.chance < _CHANCE else "needs no growth"
        yield (
            f"the interface {needed}: without growth the misfit is {growth.better_by:.1f} larger, "
            f"with a probability of {growth.chance:.1%} by chance; the strengthening is that at an "
            f"opening speed of {_speed(growth.opening_speed)}"
        )
    yield from _of_time(fit)
    if not allowed(fit.passport):
        yield "the material is assumed exact, because its uncertainty is unknown"
    if fit.is_zone_length:
        yield (
            f"the approach bounds h0 at {_size(given.range_bound or 0.0)}, below every h0 that "
            f"fits the forces: the fitted {_size(fit.equilibrium_gap)} is a length of the crack's "
            "zone, not a range of attraction"
        )
    yield from _of_scatter(fit)
    if fit.edge is not None:
        more = fit.edge.criterion - fit.criterion
        yield (
            f"the plain edge law (`viscotack identify edge`) has a criterion {abs(more):.1f} "
            f"{'higher' if more > 0 else 'lower'} ({EVIDENCE:g} is strong evidence for the lower)"
        )
    if len(fit.solutions) > 1:
        described = ", ".join(
            f"{readable(one.values['work_of_adhesion'], 'J/m2', digits=3)} with "
            f"{_size(one.values['equilibrium_gap'])} "
            f"(likelihood {np.exp((fit.solutions[0].misfit - one.misfit) / 2):.2g})"
            for one in fit.solutions
        )
        yield (
            f"{len(fit.solutions)} interfaces fit these forces: {described}; `viscotack next-test` "
            "ranks tests that distinguish them"
        )
    if isinstance(given.body, Layer):
        pulled = fit.forward.pulled(*fit.interface[:2], given.speed, given.load)
        radius, error = pulled.edge_radius, given.theory_error + ERROR_BY_ZONE * pulled.through
        yield (
            f"contact radii at pull-off are {_size(radius.min(), to=radius.max())}; the error of "
            f"the theory on the layer is {error.min():.1%} to {error.max():.1%}, with a Poisson "
            f"ratio of {fit.forward.material.poisson_ratio:.3g}"
        )
    yield from simulation_words(given.speed, fit.search.model.simulation, fit.simulations)
    yield from _of_relaxation(fit)
    yield from _of_temperatures(fit)
    if fit.excluded:
        speeds = ", ".join(dict.fromkeys(one.at for one, _ in fit.excluded))
        why = fit.excluded[-1][1]
        yield f"excluded, because the theory does not hold there: {speeds} ({why})"
    yield from (remark for one in fit.series for remark in one.remarks)


def edge_words(fit: EdgeFit) -> Iterator[str]:
    """Yield sentences on a fitted edge law."""
    yield from _of_misfit(fit)
    modulus = readable(fit.passport.material.contact_modulus, "Pa", digits=3)
    yield (
        "energy of the edge w (1 + (v/v0)^n) at its speed v, on an elastic solid with a contact "
        f"modulus of {modulus}, to whose cube root v0 is proportional"
    )
    yield from _of_unknowns(fit)
    yield from _of_time(fit)
    yield from _of_scatter(fit)
    yield f"criterion {fit.criterion:.1f} (BIC; of the same tests the smaller is better)"
    yield from (remark for one in fit.series for remark in one.remarks)


def _is_edge(fit: SeriesFit) -> bool:
    return "reference_speed" in fit.best.values


def _of_misfit(fit: SeriesFit) -> Iterator[str]:
    """Yield a sentence on tests that the fit does not describe."""
    if fit.describes_tests:
        return
    off = fit.given.force / np.array(fit.forces) - 1
    worst = np.sort(np.argsort(np.abs(off))[-_NAMED:])
    tests = ", ".join(f"{_test(fit, i)} {off[i]:+.0%}" for i in worst)
    if _is_edge(fit):
        cure = "no edge law explains them"
    elif fit.given.growth:
        cure = "no interface that grows explains them; the material may be wrong, or nonlinear"
    elif isinstance(fit.given.body, Layer):
        cure = "no interface explains them; the material or the thickness may be wrong"
    else:
        cure = (
            "no interface of a linear solid explains them; `growth` fits one that grows with "
            "speed, `viscotack identify edge` the plain edge law, or the material may be wrong"
        )
    if not fit.trend:
        cure += ", or tests at one speed scatter by as much, which `scatter` states"
    yield (
        f"the fit does not describe these tests: measured forces differ from fitted ones by "
        f"{tests}, {fit.scatter:.2g} times the uncertainty of tests and theory; {cure}"
    )


def _of_unknowns(fit: SeriesFit) -> Iterator[str]:
    """Yield a sentence on each unknown."""
    for name, ends in fit.intervals.items():
        label, unit = _LABELS[name]
        yield interval_words(label, unit, fit.best.values[name], ends, fit.level)
        if ends.split:
            yield f"the interval of the {label} consists of separate ranges that fit these forces"


def interval_words(label: str, unit: str, value: float, ends: Interval, level: float) -> str:
    """Return a sentence on a value with its interval, which the data may leave open."""
    if ends.told:
        both = readable_interval(ends.low, ends.high, unit)
        return f"{label} {readable(value, unit, digits=3)} ({both}, {level:.0%})"
    if ends.closed_below or ends.closed_above:
        side, end = ("above", ends.low) if ends.closed_below else ("below", ends.high)
        known = f"{label} {side} {readable(end, unit, digits=3)} ({level:.0%})"
        return f"{known}; not identifiable {side}"
    return f"{label}: not identifiable from these tests"


def _of_time(fit: SeriesFit) -> Iterator[str]:
    """Yield sentences on the growth with time in contact, or on what hides it."""
    given, found = fit.given, fit.ageing
    if given.confounded:
        yield (
            f"times in contact are {_span(given.contact_times)}, but equal at each speed: a "
            "growth of the interface with time is not separate from that with speed, and is taken "
            "as none; other dwells at the slowest speed would separate them"
        )
    if found is None:
        return
    yield (
        f"the work of adhesion is that after {_time(given.middle_time)} in "
        f"contact, the middle of {_span(given.contact_times)}; without growth in time the misfit "
        f"is {found.better_by:.1f} larger, with a probability of {found.chance:.1%} by chance"
    )
    if given.work_of_adhesion is not None:
        yield "the known work of adhesion is taken as that after this time"
    if together := found.together:
        others = " and ".join(_LABELS[name][0] for name in together)
        yield (
            f"growth with time is hardly separate from {others}: longer and shorter dwells at the "
            "slowest and the fastest speed would separate them"
        )
    if _is_edge(fit):
        yield "without a spectrum it may be growth by a solid that relaxes in the dwells"
    if rows := fit.unexplained:
        yield f"not explained by one interface: {', '.join(_test(fit, i) for i in rows)}"


def _of_scatter(fit: SeriesFit) -> Iterator[str]:
    """Yield a sentence on the scatter between speeds that widens the intervals."""
    if fit.between_speeds and fit.trend:
        yield (
            f"forces depart from the model by {fit.between_speeds:.1%} beyond repeated tests and "
            "theory, with a power of the speed; intervals and bands include such a trend, which a "
            "forecast continues beyond the measured speeds"
        )
    elif fit.between_speeds:
        yield (
            f"forces scatter by {fit.between_speeds:.1%} from speed to speed beyond repeated tests "
            "and theory; the intervals include this"
        )


def _of_relaxation(fit: RateSeriesFit) -> Iterator[str]:
    """Yield a caution if approach and dwell, which the fit leaves out, change the forces."""
    given, left_out = fit.given, fit.left_out
    if left_out is None:
        return
    dwells, changed = left_out
    said = [
        f"{_speed(fit.series[i].speed)} after a dwell of {_time(dwell)} by {ratio - 1:+.0%}"
        for (i, dwell), ratio, holds in zip(
            dwells.items(), changed.ratio, changed.holds, strict=True
        )
        if holds and abs(ratio - 1) > given.theory_error
    ]
    cure = "" if given.curves or given.growth else "; with `history` the forces include them"
    taken = "the contacts are taken as relaxed, but"
    shortest, material = min(dwells.values()), fit.forward.material
    left = float(material.relaxation(shortest)) / material.rubbery_modulus - 1
    if said:
        yield f"{taken} approach and dwell change the force at {' and at '.join(said)}{cure}"
    elif not np.all(changed.holds) and left >= _LEFT:
        at = _time(shortest)
        yield f"{taken} {at} after the approach the modulus is {left:.0%} above the relaxed{cure}"


def _of_temperatures(fit: RateSeriesFit) -> Iterator[str]:
    """Yield remarks on temperatures that differ from the material's, and on their uncertainty."""
    given, passport, own = fit.given, fit.passport, fit.passport.temperature
    known = [one.temperature for one in fit.series if one.temperature is not None]
    if not known:
        yield from assumed_temperature(passport, known)
    elif why := unshiftable(passport, given.growth):
        if apart(fit.series, passport):
            both = celsius(min(known), max(known))
            yield f"tests were made at {both}, but {why}: it is used as at {celsius(own)}"
    elif max(abs(one - (own or 0.0)) for one in known) > DIFFERENT:
        factors = [one.shift for one in fit.series]
        yield (
            f"tests at {celsius(min(known), max(known))} are taken at the speeds a_T v at "
            f"{celsius(own)}, with a_T from {min(factors):.3g} to {max(factors):.3g}, and with the "
            "same interface at all temperatures"
        )
    if given.temperature_error and own is not None:
        stated = "assumed" if given.temperature_uncertainty is None else "stated"
        if passport.shift is None:
            effect = "is not in the intervals: the passport has no shift of times with temperature"
        else:
            effect = f"is in the intervals: it changes times by {given.time_error:.1%}"
        kelvins = f"{given.temperature_error:.2g} K"
        yield f"the uncertainty of the temperature of the tests, {kelvins} ({stated}), {effect}"


def forecast_words(
    fit: SeriesFit, forecast: RateForecast, crack_speed: Array | None = None
) -> Iterator[str]:
    """Yield sentences on a forecast, by the theory with the speeds of its cracks [m/s]."""
    measured, speed = fit.given.speed, forecast.speed
    if forecast.contact_time is not None:
        yield (
            f"forces are those after {_span(forecast.contact_time)} in contact; that of the tests "
            f"is {_span(fit.given.contact_times)}"
        )
    if speed.min() < 0.5 * measured.min() or speed.max() > 2 * measured.max():
        needed = "the law alone" if _is_edge(fit) else "the material and the theory"
        yield (
            f"measured speeds are {_speed(measured.min(), to=measured.max())}; beyond them the "
            f"prediction depends on {needed}"
        )
    if len(fit.solutions) > 1:
        yield f"the band covers the {len(fit.solutions)} interfaces that fit the forces"
    if not forecast.posterior.converged:
        yield (
            "too few independent samples of the posterior: the correlation time is "
            f"{forecast.posterior.correlation_time:.0f} steps"
        )
    if (raised := forecast.raised).size:
        yield (
            f"at {_speed(raised.min(), to=raised.max())} the model predicts less than a slower "
            "test; there the forecast is the measured force"
        )
    if crack_speed is not None:
        edge = readable(crack_speed.min(), "m/s", digits=2, to=crack_speed.max())
        yield f"the crack speed at pull-off is {edge}"
        if not allowed(fit.passport):
            yield "the band does not include the uncertainty of the material, which is unknown"


def simulation_words(speed: Array, error: Array, count: int) -> Iterator[str]:
    """Yield a sentence on the tests whose forces are simulated, with their errors above 0."""
    speeds = np.sort(speed[error > 0])
    if speeds.size:
        at = ", ".join(_speed(one) for one in speeds)
        if speeds.size > _NAMED:
            at = f"{speeds.size} speeds, {_speed(speeds[0], to=speeds[-1])}"
        yield (
            f"forces by simulation at {at}, where the theory does not hold: {count} simulations, "
            f"error of the interpolated force {error.max():.1%}"
        )


def _test(fit: SeriesFit, number: int) -> str:
    """Return speed of a test, and its time in contact where that counts."""
    one = fit.series[number]
    if fit.ageing is None or one.contact_time is None:
        return one.at
    return f"{one.at} after {_time(one.contact_time)}"


def _span(times: Array) -> str:
    return _time(times.min(), to=times.max())
