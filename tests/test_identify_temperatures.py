"""Identification from rate series at several temperatures, each test at its own."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from picture_units import in_si
from rate_tests import GAP, PRELOAD, RADIUS, RUBBER, WORK, holds, linear, measured
from viscotack.app.operations.parts.records import rates_record
from viscotack.errors import InputError
from viscotack.identify import PullOff, RateSeries, forecast_rates, identify_rates
from viscotack.identify.covariances import shift_covariance
from viscotack.identify.pull_off import History
from viscotack.identify.rate_series import shifted
from viscotack.lab.tack import Measured
from viscotack.model.materials import Passport
from viscotack.model.materials.shift import WLF, TabulatedShift
from viscotack.plot.interface import draw_rate_series

WARM = WLF(reference_temperature=293.15, c1=5.0, c2=150.0)
PASSPORT = Passport(name="rubber", material=RUBBER, temperature=293.15, shift=WARM)
SPEEDS = np.array([1e-6, 1e-4])
CASE: dict[str, Any] = {"radius": RADIUS, "preload": PRELOAD, "theory": 2e-3}


def measured_at(temperature):
    """Return the pull-offs of the solid at a temperature."""
    forces = linear(SPEEDS, PASSPORT.at_temperature(temperature))
    return measured(forces, 1e-3, SPEEDS, temperature=temperature)


SERIES = [*measured_at(278.15), *measured_at(308.15)]


@pytest.fixture(scope="module")
def fit():
    return identify_rates(RateSeries(SERIES, material=PASSPORT, **CASE))


def test_each_test_counts_at_its_own_temperature(fit):
    assert fit.work_of_adhesion == pytest.approx(WORK, rel=5e-3)
    assert fit.equilibrium_gap == pytest.approx(GAP, rel=0.03)
    assert fit.scatter < 0.5
    assert [one.speed for one in fit.series] == sorted(one.speed for one in fit.series)
    # all at the temperature of the material, they contradict each other
    blind = [replace(one, temperature=None) for one in SERIES]
    assert identify_rates(RateSeries(blind, material=PASSPORT, **CASE)).scatter > 2


def test_a_forecast_at_another_temperature_is_that_of_the_solid_there(fit):
    true = linear(SPEEDS[1:2], PASSPORT.at_temperature(303.15))
    found = forecast_rates(fit, SPEEDS[1], temperature=303.15)
    assert found.force == pytest.approx(true, rel=5e-3)
    assert holds(found, true)


def test_a_shifted_test_has_the_speed_and_history_of_the_reference_temperature():
    history = History(1e-3, 2e-3, 10.0)
    one = PullOff(1e-5, Measured(5e-3, 1e-5), PRELOAD, history=history, temperature=278.15)
    (found,) = shifted([one], PASSPORT)
    assert shifted([found], PASSPORT) == [found]
    factor = PASSPORT.shift_factor(278.15)
    assert factor > 2
    assert (found.speed, found.shift) == pytest.approx((factor * 1e-5, factor))
    assert found.true_speed == pytest.approx(1e-5)
    assert found.history is not None
    assert found.history.approach_speed == pytest.approx(factor * 1e-3)
    assert found.history.dwell == pytest.approx(10 / factor)
    assert found.force == one.force and found.history.peak == history.peak


@pytest.mark.slow
def test_errors_of_temperature_and_of_the_table_of_shifts_are_in_the_covariance(fit):
    # a WLF law is steeper where it is colder
    errors = dict(zip(fit.given.temperatures, fit.given.time_errors(), strict=True))
    assert errors[278.15] > 1 > errors[308.15]
    kelvins = (273.15, 293.15, 313.15)
    rows = tuple(np.asarray(WARM.log10_shift(kelvins)).tolist())
    table = replace(PASSPORT, shift=TabulatedShift(293.15, kelvins, rows))
    doubted = replace(PASSPORT, shift=TabulatedShift(293.15, kelvins, rows, (0.1, 0.0, 0.1)))
    sure, wide = (
        identify_rates(RateSeries(SERIES, material=one, temperature_uncertainty=0.0, **CASE))
        for one in (table, doubted)
    )
    more = wide.search.spread - sure.search.spread
    at = np.array([one.temperature for one in wide.series])
    assert np.all(np.diag(more) > 0)
    # at different temperatures the errors of the table are independent
    assert np.all(np.abs(more[at[:, None] != at]) < 1e-12)
    both = more[np.ix_(at == 278.15, at == 278.15)]
    # the interfaces of the two fits, at which covariances are computed, differ a little
    assert both[0, 1] ** 2 == pytest.approx(both[0, 0] * both[1, 1], rel=0.02)


def test_errors_of_shifts_are_one_at_one_temperature_and_independent_between_them():
    series: Any = SimpleNamespace(
        shift_deviations=lambda: np.array([0.1, 0.1, 0.2]), temperatures=(278.15, 278.15, 308.15)
    )
    # of tests whose ln(force) grows by 1, 2 and 3 times the error of all times
    own: Any = SimpleNamespace(slower=lambda error, interface: error * np.array([1.0, 2.0, 3.0]))
    found = shift_covariance(series, own, None)
    expected = np.array([[0.01, 0.02, 0.0], [0.02, 0.04, 0.0], [0.0, 0.0, 0.36]])
    assert found == pytest.approx(expected, abs=1e-15)


def test_a_series_whose_temperatures_are_not_usable_is_refused():
    bare = Passport(name="", material=RUBBER)
    for series, passport, more, words in (
        (SERIES, bare, {}, "shift"),
        ([*SERIES[:3], replace(SERIES[3], temperature=None)], PASSPORT, {}, "is unknown"),
        (SERIES, PASSPORT, {"growth": True}, "speed-dependent interface"),
        (SERIES, replace(PASSPORT, temperatures=(290.0, 300.0)), {}, "was measured from"),
    ):
        with pytest.raises(InputError, match=words):
            shifted(series, passport, **more)
    # a single temperature without a shift counts at that of the material
    assert shifted(SERIES[:2], replace(PASSPORT, shift=None)) == SERIES[:2]


def test_the_record_and_the_picture_have_true_and_shifted_speeds(fit):
    rows = rates_record(fit)["series"]
    for row in rows:
        factor = PASSPORT.shift_factor(row["temperature_K"])
        assert row["shifted_speed_m_s"] == pytest.approx(factor * row["speed_m_s"])
    axes = draw_rate_series(fit).axes[0]
    points = axes.containers[0].lines[0]
    shifted_speeds = [row["shifted_speed_m_s"] for row in rows]
    assert in_si(axes.xaxis, points.get_xdata()) == pytest.approx(shifted_speeds)
    assert in_si(axes.yaxis, points.get_ydata()) == pytest.approx(fit.given.force)
