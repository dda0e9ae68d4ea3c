"""Identification from rate series at several temperatures, each test at its own."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from picture_units import in_si
from viscotack.errors import InputError
from viscotack.identify import PullOff, forecast_rates, identify_rates
from viscotack.identify.forward import Forward
from viscotack.identify.pull_off import History
from viscotack.identify.temperatures import shifted
from viscotack.lab.tack import Measured
from viscotack.materials import Passport, StandardSolid
from viscotack.materials.shift import WLF, TabulatedShift
from viscotack.operations.parts.records import rates_record
from viscotack.plot.interface import draw_rate_series

RADIUS, WORK, PRELOAD = 5.19e-3, 0.1523, 1.5e-3
RUBBER = StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-2, poisson_ratio=0.5)
WARM = WLF(reference_temperature=293.15, c1=5.0, c2=150.0)
PASSPORT = Passport(name="rubber", material=RUBBER, temperature=293.15, shift=WARM)
GAP, SPEEDS = 200e-9, np.geomspace(1e-6, 1e-4, 3)
CASE: dict[str, Any] = {"radius": RADIUS, "preload": PRELOAD, "theory": 2e-3}


def measured_at(temperature, relative=1e-3):
    """Return the pull-offs of the solid at a temperature."""
    solid = PASSPORT.at_temperature(temperature)
    forces = Forward(solid, RADIUS).pulled(WORK, GAP, SPEEDS, PRELOAD).force
    rows = zip(SPEEDS, forces, strict=True)
    return [
        PullOff(float(v), Measured(float(P), relative * float(P)), temperature=temperature)
        for v, P in rows
    ]


SERIES = [*measured_at(278.15), *measured_at(308.15)]


@pytest.fixture(scope="module")
def fit():
    return identify_rates(SERIES, material=PASSPORT, **CASE)


def test_each_test_counts_at_its_own_temperature(fit):
    assert fit.work_of_adhesion == pytest.approx(WORK, rel=5e-3)
    assert fit.equilibrium_gap == pytest.approx(GAP, rel=0.03)
    assert fit.scatter < 0.5
    assert [one.speed for one in fit.series] == sorted(one.speed for one in fit.series)
    # all at the temperature of the material, they contradict each other
    blind = [replace(one, temperature=None) for one in SERIES]
    assert identify_rates(blind, material=PASSPORT, **CASE).scatter > 2


def test_a_forecast_at_another_temperature_is_that_of_the_solid_there(fit):
    solid = PASSPORT.at_temperature(303.15)
    true = Forward(solid, RADIUS).pulled(WORK, GAP, SPEEDS[1], PRELOAD).force
    found = forecast_rates(fit, SPEEDS[1], temperature=303.15)
    assert found.force[0] == pytest.approx(float(true), rel=5e-3)
    assert found.low[0] < true < found.high[0]


def test_a_shifted_test_has_the_speed_and_history_of_the_reference_temperature():
    history = History(1e-3, 2e-3, 10.0)
    one = PullOff(1e-5, Measured(5e-3, 1e-5), PRELOAD, history=history, temperature=278.15)
    (found,), _ = shifted([one], PASSPORT)
    factor = PASSPORT.shift_factor(278.15)
    assert factor > 2
    assert (found.speed, found.shift) == pytest.approx((factor * 1e-5, factor))
    assert found.true_speed == pytest.approx(1e-5)
    assert found.conditions() == "5 C, 10 um/s"
    assert found.history is not None
    assert found.history.approach_speed == pytest.approx(factor * 1e-3)
    assert found.history.dwell == pytest.approx(10 / factor)
    assert found.force == one.force and found.history.peak == history.peak


@pytest.mark.slow
def test_errors_of_temperature_and_of_the_table_of_shifts_are_in_the_covariance(fit):
    uncertain = fit.uncertain
    # a WLF law is steeper where it is colder
    cold, warm = uncertain.shifts([replace(one, shift=2.0) for one in (SERIES[0], SERIES[-1])])
    assert cold > 1 > warm
    kelvins = (273.15, 293.15, 313.15)
    rows = tuple(np.asarray(WARM.log10_shift(kelvins)).tolist())
    table = replace(PASSPORT, shift=TabulatedShift(293.15, kelvins, rows))
    doubted = replace(PASSPORT, shift=TabulatedShift(293.15, kelvins, rows, (0.1, 0.0, 0.1)))
    sure, wide = (
        identify_rates(SERIES, material=one, temperature_uncertainty=0.0, **CASE)
        for one in (table, doubted)
    )
    more = wide.covariance - sure.covariance
    at = np.array([one.temperature for one in wide.series])
    assert np.all(np.diag(more) > 0)
    # at different temperatures the errors of the table are independent
    assert np.all(np.abs(more[at[:, None] != at]) < 1e-12)
    both = more[np.ix_(at == 278.15, at == 278.15)]
    # the interfaces of the two fits, at which covariances are computed, differ a little
    assert both[0, 1] ** 2 == pytest.approx(both[0, 0] * both[1, 1], rel=0.02)


def test_a_series_whose_temperatures_are_not_usable_is_refused():
    bare = Passport(name="", material=RUBBER)
    for series, passport, more, words in (
        (SERIES, bare, {}, "shift"),
        ([*SERIES[:5], replace(SERIES[5], temperature=None)], PASSPORT, {}, "is unknown"),
        (SERIES, PASSPORT, {"growth": True}, "speed-dependent interface"),
        (SERIES, replace(PASSPORT, temperatures=(290.0, 300.0)), {}, "was measured from"),
    ):
        with pytest.raises(InputError, match=words):
            shifted(series, passport, **more)
    # a single temperature without a shift counts at that of the material, with a remark
    same, said = shifted(SERIES[:3], replace(PASSPORT, shift=None))
    assert same == SERIES[:3] and "no shift" in said[0]


def test_the_record_has_true_and_shifted_speeds(fit):
    rows = rates_record(fit)["series"]
    assert {row["temperature_K"] for row in rows} == {278.15, 308.15}
    for row in rows:
        factor = PASSPORT.shift_factor(row["temperature_K"])
        assert row["shifted_speed_m_s"] == pytest.approx(factor * row["speed_m_s"])
    axes = draw_rate_series(fit).axes[0]
    measured = axes.containers[0].lines[0]
    assert in_si(axes.xaxis, measured.get_xdata()) == pytest.approx([x.speed for x in fit.series])
    forces = [x.force.value for x in fit.series]
    assert in_si(axes.yaxis, measured.get_ydata()) == pytest.approx(forces)
