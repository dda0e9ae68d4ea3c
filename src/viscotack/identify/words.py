"""Sentences on fits, forecasts and slow tests, made from their numbers at the end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from viscotack.arrays import Array
from viscotack.model.geometry import Layer
from viscotack.model.materials.passport import Passport
from viscotack.model.materials.passport_uncertainty import allowed
from viscotack.theory.crack.contact.films import ERROR_BY_ZONE
from viscotack.units import readable, readable_interval

from .contact_time import PER_DECADE
from .growth import FoundGrowth
from .likelihood import EVIDENCE, Interval
from .rate_series import DIFFERENT, apart, assumed_temperature, celsius, unshiftable

if TYPE_CHECKING:
    from .edge_fit import EdgeFit
    from .forecasting import RateForecast
    from .rate_fit import RateSeriesFit
    from .search import SeriesFit
    from .slow_tests import ModelFit, SamePull, SlowTestFit

_NAMED = 4  # largest number of tests, or of speeds, that are named one by one
_LEFT = 0.05  # part of the modulus that has not relaxed, from which a caution is given
_CHANCE = 0.01  # accepted probability that a series without growth is reported to need it
_IN_TIME = ("growth of the work of adhesion in a decade of contact time", "")
_LABELS = {
    PER_DECADE: _IN_TIME,
    "work_of_adhesion": ("work of adhesion", "J/m2"),
    "equilibrium_gap": ("range of attraction h0", "m"),
    "strengthening": ("strengthening", ""),
    "exponent": ("exponent of growth", ""),
}
_EDGE_LABELS = {
    PER_DECADE: _IN_TIME,
    "work_of_adhesion": ("work of adhesion w", "J/m2"),
    "reference_speed": ("reference speed v0", "m/s"),
    "exponent": ("exponent n", ""),
}


def fit_words(fit: RateSeriesFit) -> list[str]:
    """Return sentences on a fit that describes its tests, or not."""
    said = [fit.misfit] if fit.misfit else []
    for name, ends in fit.intervals.items():
        label, unit = _LABELS[name]
        if name == "strengthening" and fit.growth is not None:
            label += f" at an opening speed of {_speed(fit.growth.opening_speed)}"
        said += _of_one(label, unit, fit.best.values[name], ends, fit.level)
    if fit.growth is not None:
        said.append(_of_growth(fit.growth))
    said += _of_time(fit)
    if not allowed(fit.passport):
        said.append("the material is assumed exact, because its uncertainty is unknown")
    return [
        *said,
        *_of_approach(fit),
        *_of_scatter(fit),
        *_of_edge(fit),
        *_of_solutions(fit),
        *_of_layer(fit),
        *simulation_words(fit.given.speed, fit.search.model.simulation, fit.simulations),
        *_of_relaxation(fit),
        *_of_shifts(fit),
        *_of_temperature(fit),
        *_of_excluded(fit),
        *(remark for one in fit.series for remark in one.remarks),
    ]


def misfit_words(fit: SeriesFit) -> str:
    """Return a sentence on tests that the fit does not describe."""
    off = fit.given.force / np.array(fit.forces) - 1
    worst = np.sort(np.argsort(np.abs(off))[-_NAMED:])
    tests = ", ".join(f"{_test(fit, i)} {off[i]:+.0%}" for i in worst)
    off_by = (
        f"the fit does not describe these tests: measured over fitted forces are off by {tests}, "
        f"which is {fit.scatter:.2g} times the uncertainty of the tests and the theory"
    )
    if "reference_speed" in fit.best.values:
        return f"{off_by}. No energy w (1 + (v/v0)^n) of the edge explains them"
    if fit.given.growth:
        cure = "even an interface that grows; the material may be wrong, or nonlinear"
    elif isinstance(fit.given.body, Layer):
        cure = "; the material or the thickness may be wrong"
    else:
        cure = (
            "; --growth fits an interface that grows with speed, `viscotack identify edge` the "
            "plain edge law, or the material may be wrong"
        )
    if not fit.trend:
        cure += ", or tests at one speed scatter by as much, which --scatter states"
    return f"{off_by}. No work of adhesion and range of a linear solid explain them{cure}"


def edge_words(fit: EdgeFit) -> list[str]:
    """Return sentences on a fitted edge law."""
    said = []
    for name, ends in fit.intervals.items():
        label, unit = _EDGE_LABELS[name]
        said += _of_one(label, unit, fit.best.values[name], ends, fit.level)
    modulus = readable(fit.passport.material.contact_modulus, "Pa", digits=3)
    return [
        *([fit.misfit] if fit.misfit else []),
        "energy of the edge w (1 + (v/v0)^n) at its speed v, on an elastic solid with a contact "
        f"modulus of {modulus}, to whose cube root v0 is proportional",
        *said,
        *_of_time(fit),
        *_of_scatter(fit),
        f"criterion {fit.criterion:.1f} (BIC; of the same tests the smaller is better)",
        *(remark for one in fit.series for remark in one.remarks),
    ]


def _test(fit: SeriesFit, number: int) -> str:
    """Return speed of a test, and its time in contact where that counts."""
    one = fit.series[number]
    if fit.ageing is None or one.contact_time is None:
        return one.at
    return f"{one.at} after {readable(one.contact_time, 's', digits=2)}"


def _of_time(fit: SeriesFit) -> list[str]:
    """Return sentences on the growth with time in contact, or on what hides it."""
    found, times = fit.ageing, fit.given.contact_times
    if fit.given.confounded:
        return [
            f"times in contact are {_times(times)}, but equal at each speed: a growth of the "
            "interface with time is not separate from that with speed, and is taken as none; other "
            "dwells at the slowest speed would separate them"
        ]
    if found is None:
        return []
    labels = _EDGE_LABELS if "reference_speed" in fit.best.values else _LABELS
    middle = readable(fit.given.middle_time, "s", digits=2)
    said = [
        f"the work of adhesion is that after {middle} in contact, the middle of {_times(times)}; "
        f"without growth in time the misfit is {found.better_by:.1f} larger, with a probability of "
        f"{found.chance:.1%} by chance"
    ]
    if fit.given.work_of_adhesion is not None:
        said.append("the known work of adhesion is taken as that after this time")
    if together := found.together:
        others = " and ".join(labels[name][0] for name in together)
        said.append(
            f"growth with time is hardly separate from {others}: longer and shorter dwells at the "
            "slowest and the fastest speed would separate them"
        )
    if "reference_speed" in fit.best.values:
        said.append("without a spectrum it may be growth by a solid that relaxes in the dwells")
    if rows := fit.unexplained:
        said.append(f"not explained by one interface: {', '.join(_test(fit, i) for i in rows)}")
    return said


def _times(times: Array) -> str:
    return readable(float(times.min()), "s", digits=2, to=float(times.max()))


def _of_edge(fit: RateSeriesFit) -> list[str]:
    """Compare the fit with the edge law, by their criteria."""
    if fit.edge is None:
        return []
    apart = fit.edge.criterion - fit.criterion
    said = f"the plain edge law (`viscotack identify edge`) has a criterion {abs(apart):.1f} "
    said += "higher" if apart > 0 else "lower"
    return [f"{said} ({EVIDENCE:g} is strong evidence for the lower one)"]


def forecast_words(fit: RateSeriesFit, forecast: RateForecast, crack_speed: Array) -> list[str]:
    """Return sentences on a forecast by the theory, with the speeds of its cracks [m/s]."""
    edge = readable(crack_speed.min(), "m/s", digits=2, to=crack_speed.max())
    said = [f"the crack speed at pull-off is {edge}"]
    if not allowed(fit.passport):
        said.append("the band does not include the uncertainty of the material, which is unknown")
    return series_forecast_words(fit, forecast, "the material and the theory") + said


def series_forecast_words(fit: SeriesFit, forecast: RateForecast, rests_on: str) -> list[str]:
    """Return sentences on a forecast by any model; `rests_on` is what it needs elsewhere."""
    said, measured, speed = [], fit.given.speed, forecast.speed
    if forecast.contact_time is not None:
        said.append(
            f"forces are those after {_times(forecast.contact_time)} in contact; that of the tests "
            f"is {_times(fit.given.contact_times)}"
        )
    if speed.min() < 0.5 * measured.min() or speed.max() > 2 * measured.max():
        said.append(
            f"measured speeds range from {_speed(measured.min(), measured.max())}; beyond them the "
            f"prediction depends on {rests_on}"
        )
    if len(fit.solutions) > 1:
        said.append(f"the band covers the {len(fit.solutions)} interfaces that fit the forces")
    if not forecast.posterior.converged:
        said.append(
            "too few independent samples of the posterior: the correlation time is "
            f"{forecast.posterior.correlation_time:.0f} steps"
        )
    if (raised := forecast.raised).size:
        said.append(
            f"at {_speed(raised.min(), raised.max())} the model predicts less than was measured at "
            "a slower speed; there the forecast is the measured force"
        )
    return said


def simulation_words(speed: Array, error: Array, count: int) -> list[str]:
    """Return a sentence on the tests whose forces are simulated, with their errors above 0."""
    speeds = np.sort(speed[error > 0])
    if not speeds.size:
        return []
    at = ", ".join(_speed(one) for one in speeds)
    if speeds.size > _NAMED:
        at = f"{speeds.size} speeds, {_speed(speeds[0], speeds[-1])}"
    return [
        f"forces by simulation at {at}, where the theory does not hold: {count} simulations, "
        f"error of the interpolated force {error.max():.1%}"
    ]


def _speed(value: float, to: float | None = None) -> str:
    return readable(float(value), "m/s", digits=3, to=None if to is None else float(to))


def _of_one(label: str, unit: str, value: float, ends: Interval, level: float) -> list[str]:
    """Return a sentence on one parameter."""
    if ends.told:
        both = readable_interval(ends.low, ends.high, unit)
        said = [f"{label} {readable(value, unit, digits=3)} ({both}, {level:.0%})"]
    elif ends.closed_below:
        low = readable(ends.low, unit, digits=3)
        said = [f"{label} above {low} ({level:.0%}); not identifiable above"]
    elif ends.closed_above:
        high = readable(ends.high, unit, digits=3)
        said = [f"{label} below {high} ({level:.0%}); not identifiable below"]
    else:
        said = [f"{label}: not identifiable from these speeds"]
    if ends.split:
        said.append(
            f"the interval of the {label} consists of separate ranges that fit these forces"
        )
    return said


def _of_growth(found: FoundGrowth) -> str:
    sure = found.chance < _CHANCE
    return (
        f"{'the interface grows with speed' if sure else 'growth is not needed'}: without it "
        f"the misfit is {found.better_by:.1f} larger, with a probability of {found.chance:.1%} "
        "by chance"
    )


def _of_approach(fit: RateSeriesFit) -> list[str]:
    """Return a caution if the approach excludes the fitted range."""
    bound = fit.given.range_bound
    if bound is None or not fit.is_zone_length:
        return []
    return [
        f"the approach bounds the range of attraction at {readable(bound, 'm', digits=2)}, below "
        f"every h0 that fits the forces: the fitted {readable(fit.equilibrium_gap, 'm', digits=3)} "
        "is a length of the crack's zone, not a range of attraction"
    ]


def _of_scatter(fit: SeriesFit) -> list[str]:
    if not fit.between_speeds:
        return []
    if fit.trend:
        return [
            f"forces depart from the model by {fit.between_speeds:.1%} beyond repeated tests and "
            "theory, with a power of the speed; intervals and bands include such a trend, which a "
            "forecast continues beyond the measured speeds"
        ]
    return [
        f"forces scatter by {fit.between_speeds:.1%} from speed to speed beyond repeated tests and "
        "theory; the intervals include this"
    ]


def _of_solutions(fit: RateSeriesFit) -> list[str]:
    if len(fit.solutions) < 2:
        return []
    described = [
        f"{readable(one.values['work_of_adhesion'], 'J/m2', digits=3)} with "
        f"{readable(one.values['equilibrium_gap'], 'm', digits=3)} "
        f"(likelihood {np.exp((fit.solutions[0].misfit - one.misfit) / 2):.2g})"
        for one in fit.solutions
    ]
    return [
        f"{len(described)} interfaces fit these forces: {', '.join(described)}; `viscotack "
        "next-test` ranks tests that distinguish them"
    ]


def _of_layer(fit: RateSeriesFit) -> list[str]:
    """Return a sentence on the error of the theory on a layer."""
    given, solid = fit.given, fit.forward.material
    if not isinstance(given.body, Layer):
        return []
    pulled = fit.forward.pulled(*fit.interface[:2], given.speed, given.load)
    radius, error = pulled.edge_radius, given.theory_error + ERROR_BY_ZONE * pulled.through
    return [
        "on the layer contact radii at pull-off are "
        f"{readable(radius.min(), 'm', digits=2, to=radius.max())}, and the error of the theory is "
        f"{error.min():.1%} to {error.max():.1%}; the Poisson ratio of its material is "
        f"{solid.poisson_ratio:.3g}"
    ]


def _of_relaxation(fit: RateSeriesFit) -> list[str]:
    """Return a caution if approach and dwell, which the fit leaves out, change the forces."""
    given, left_out = fit.given, fit.left_out
    if left_out is None:
        return []
    tests, changed = left_out
    said = [
        f"{_speed(fit.series[i].speed)} after a dwell of {readable(dwell, 's', digits=2)} by "
        f"{ratio - 1:+.0%}"
        for (i, dwell), ratio, holds in zip(
            tests.items(), changed.ratio, changed.holds, strict=True
        )
        if holds and abs(ratio - 1) > given.theory_error
    ]
    if said:
        cure = "" if given.curves or given.growth else "; with --history the forces include them"
        return [
            "the contacts are taken as relaxed, but approach and dwell change the force at "
            f"{' and at '.join(said)}{cure}"
        ]
    dwell, material = min(tests.values()), fit.forward.material
    left = float(material.relaxation(dwell)) / material.rubbery_modulus - 1
    if np.all(changed.holds) or left < _LEFT:
        return []
    return [
        f"the contacts are taken as relaxed, but after a dwell of {readable(dwell, 's', digits=2)} "
        f"the modulus is {left:.0%} above the relaxed one; with --history the forces include "
        "approach and dwell"
    ]


def _of_shifts(fit: RateSeriesFit) -> list[str]:
    """Return a remark on the temperatures of tests that differ from the material's."""
    passport, tests = fit.passport, fit.series
    known = [one.temperature for one in tests if one.temperature is not None]
    if not known:
        return assumed_temperature(passport, known)
    at, low, high = celsius(passport.temperature), min(known), max(known)
    if why := unshiftable(passport, fit.given.growth):
        if not apart(tests, passport):
            return []
        return [f"tests were made at {celsius(low, high)}, but {why}: it is used as at {at}"]
    reference = passport.temperature or 0.0
    if max(abs(low - reference), abs(high - reference)) <= DIFFERENT:
        return []
    factors = [one.shift for one in tests]
    return [
        f"tests at {celsius(low, high)} are taken at the speeds a_T v at {at}, with a_T from "
        f"{min(factors):.3g} to {max(factors):.3g}, and with the same interface at all temperatures"
    ]


def _of_temperature(fit: RateSeriesFit) -> list[str]:
    """Return a sentence on the uncertainty of the temperature."""
    given, passport = fit.given, fit.passport
    if not given.temperature_error or passport.temperature is None:
        return []
    if passport.shift is None:
        return [
            "the uncertainty of the temperature of the tests is not in the intervals, because the "
            "passport has no shift of times with temperature"
        ]
    known = "assumed" if given.temperature_uncertainty is None else "stated"
    return [
        f"the temperature of the tests has a standard uncertainty of {given.temperature_error:.2g} "
        f"K ({known}), by which the times of the material change by {given.time_error:.1%}; it is "
        "in the intervals"
    ]


def _of_excluded(fit: RateSeriesFit) -> list[str]:
    if not fit.excluded:
        return []
    speeds = ", ".join(dict.fromkeys(one.at for one, _ in fit.excluded))
    why = fit.excluded[-1][1]
    return [f"excluded, because the theory does not hold there: {speeds} ({why})"]


def upper_bound_words(fit: SlowTestFit) -> list[str]:
    """Return the reasons why the work of a fit is an upper bound; empty for a slow test."""
    said = []
    if fit.inelastic:
        said.append(
            f"residuals are {fit.residual:.2g} times the noise: no elastic law fits. If the test "
            "was not slow, energy dissipated at a viscoelastic edge appears as a longer range; use "
            "a slower test, or `viscotack identify rates`"
        )
    if fit.modulus is not None and fit.contradicts_modulus:
        modulus, uncertainty = (readable(x, "Pa") for x in fit.modulus)
        said.append(
            f"the fitted E0* {readable(fit.best.contact_modulus, 'Pa')} is {fit.modulus_apart:.2g} "
            f"standard deviations from the given {modulus} +- {uncertainty}: the contact was not "
            "that of the relaxed solid, or the given modulus or the compliance of the rig is wrong"
        )
    if fit.same_pull is not None and fit.same_pull.fast:
        said.append(
            f"{_of_pull(fit, fit.same_pull)}: the test was not slow. Use a slower test, or "
            "`viscotack identify rates`"
        )
    return said


def slow_words(fit: SlowTestFit) -> list[str]:
    """Return sentences on the result and on what the data do not determine."""
    alike, reasons, level = fit.alike, fit.upper_bound, fit.level
    names = [one.model.upper() for one in alike]
    if reasons:
        most = readable(fit.work_of_adhesion.high, "J/m2")
        said = [
            f"the work of adhesion is at most {most} ({level:.0%}), an upper bound: an elastic fit "
            "does not determine it from this test",
            *reasons,
        ]
    elif fit.undetermined:
        works = [_work(one, one.intervals["work_of_adhesion"], level) for one in alike]
        by_each = " or ".join(f"{x} by {name}" for x, name in zip(works, names, strict=True))
        apart = alike[1].criterion - alike[0].criterion
        said = [
            f"the work of adhesion is undetermined between models: {by_each} (criteria "
            f"{apart:.1f} apart, {EVIDENCE:g} would be evidence); contact radii from a camera, "
            "or E0* with its uncertainty, distinguish them"
        ]
    else:
        work = _work(alike[0], fit.work_of_adhesion, level)
        said = [f"work of adhesion {work} by {' and '.join(names)}"]
    if len(names) > 1 and (reasons or not fit.undetermined):
        others = " and ".join(names[1:])
        said.append(
            f"the data do not distinguish {names[0]} from {others} (criteria within {EVIDENCE:g})"
        )
    ranged = next((one for one in fit.fits if "tabor" in one.intervals), None)
    if ranged is not None and not reasons:
        said.append(_of_range(ranged, names, level))
    if fit.test.against == "depth":
        said.append(
            "the zero of depth was also fitted; without a camera the range is poorly determined"
        )
    if fit.same_pull is None and fit.material is not None:
        said.append("without speed and preload the material cannot show whether the test was slow")
    if fit.same_pull is not None and not fit.same_pull.fast:
        said.append(_of_pull(fit, fit.same_pull))
    if isinstance(fit.material, Passport):
        known = () if fit.test.temperature is None else (fit.test.temperature,)
        said += assumed_temperature(fit.material, known)
    return said


def _of_pull(fit: SlowTestFit, pull: SamePull) -> str:
    """Return whether the test was slow on its material."""
    at = (
        f"at {readable(fit.test.speed or 0.0, 'm/s')}, {readable(pull.work, 'J/m2')} and a range "
        f"of {readable(pull.gap, 'm', digits=2)}"
    )
    if pull.assumed is not None:
        at += (
            f", assumed at a Tabor number of {pull.assumed:g} because the data do not determine it"
        )
    if pull.error:
        return f"whether the test was slow is not checked {at}: {pull.error}"
    if pull.ratio is None:
        return f"whether the test was slow is not known {at}: simulate this pull"
    said = f"the material gives {pull.ratio:.4g} times the slow force {at}"
    return said if pull.fast else f"{said}: the test was slow"


def _work(fit: ModelFit, ends: Interval, level: float) -> str:
    both = readable_interval(ends.low, ends.high, "J/m2")
    return f"{readable(fit.work_of_adhesion, 'J/m2')} ({both}, {level:.0%})"


def _of_range(fit: ModelFit, alike: list[str], level: float) -> str:
    """Describe the range; `alike` are the models that the data do not distinguish."""
    ends, name = fit.intervals["tabor"], fit.model.upper()
    if ends.told:
        both = f"({ends.low:.3g} to {ends.high:.3g}, {level:.0%})"
        return f"Tabor number {fit.tabor:.3g} {both} by {name}"
    if ends.closed_below and "DMT" not in alike:
        return (
            f"the Tabor number is above {ends.low:.3g} ({level:.0%}, {name}); these data give no "
            "upper bound, hence no range of attraction: JKR is sufficient"
        )
    if ends.closed_above and "JKR" not in alike:
        return (
            f"the Tabor number is below {ends.high:.3g} ({level:.0%}, {name}); these data give no "
            "lower bound: DMT is sufficient"
        )
    return f"these data do not determine the range of attraction ({name})"
