"""Repeated tests have one scatter, outliers are named, forecasts exceed what was measured."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from viscotack.identify import PullOff, forecast_rates, identify_rates, pull_offs
from viscotack.identify.forward import Forward
from viscotack.identify.repeats import _far, pooled
from viscotack.lab.tack import Measured, survey

RIG = Path(__file__).parents[1] / "examples" / "from_rig"
RUBBER = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-2, poisson_ratio=0.5)
RADIUS, WORK, GAP, PRELOAD = 5.19e-3, 0.15, 200e-9, 1.5e-3
SPEEDS = np.geomspace(1e-6, 1e-3, 6)
TRUE = Forward(RUBBER, RADIUS).pulled(WORK, GAP, SPEEDS, PRELOAD).force


def series(values, relative):
    pairs = zip(SPEEDS, values, strict=True)
    return [PullOff(float(v), Measured(float(P), relative * float(P)), PRELOAD) for v, P in pairs]


@pytest.mark.parametrize("far", [3.45, 3.55])
@pytest.mark.parametrize("tests", [3, 6])
def test_a_test_is_far_by_its_distance_from_the_others_over_what_their_mean_adds(tests, far):
    logs = np.append(np.zeros(tests - 1), far * 0.02 * np.sqrt(1 + 1 / (tests - 1)))
    assert _far(logs, 0.02) == ((tests - 1,) if far > 3.5 else ())


@pytest.mark.parametrize("tests", [2, 3, pytest.param(5, marks=pytest.mark.slow)])
def test_the_scatter_of_repeats_is_pooled_and_the_uncertainty_of_means_covers(tests):
    rng = np.random.default_rng(tests)
    drawn = [
        pooled(np.exp(0.03 * rng.standard_normal((6, tests))))  # type: ignore[arg-type]
        for _ in range(300)
    ]
    assert np.mean([one.scatter for one in drawn]) == pytest.approx(0.03, rel=0.06)
    covered = [
        abs(np.log(mean)) < 1.645 * one.uncertainty(tests) for one in drawn for mean in one.means
    ]
    assert 0.87 < np.mean(covered) < 0.93


def test_a_test_far_from_its_repeats_counts_little_and_is_named():
    (cycle,) = survey([RIG / "lens_30_um_s.csv"]).cycles
    size = cycle.pull_off_force.value
    factors = np.array([[1.0, 1.02, 0.98, 1.4], [1.01, 0.99, 1.02, 0.97], [1.0, 0.98, 1.0, 1.03]])
    cycles = [
        replace(
            cycle,
            speed=Measured((1 + i) * cycle.speed.value, 0.0),
            pull_off_force=Measured(float(factor) * size, 0.01 * size),
        )
        for i, row in enumerate(factors)
        for factor in row
    ]
    found = pull_offs(cycles)
    assert len(found) == 3
    (remark,) = found[0].remarks
    assert "one of 4 tests at 30" in remark and "counts little" in remark
    assert not found[1].remarks and not found[2].remarks
    # the mean of the other three is that of the file
    assert found[0].force.value == pytest.approx(size, rel=0.02)


@pytest.mark.slow
def test_scatter_from_speed_to_speed_widens_intervals_to_hold_the_truth():
    noise = np.array([1.09, 0.92, 1.08, 0.93, 1.08, 0.91])
    case = {"material": RUBBER, "radius": RADIUS, "theory": 0.005}
    found = identify_rates(series(TRUE * noise, 0.005), **case)
    assert 0.05 < found.between_speeds < 0.15
    assert found.scatter > 5  # before
    assert "from speed to speed" in " ".join(found.words)
    ends = found.intervals["work_of_adhesion"]
    assert ends.low < WORK < ends.high and ends.high > 1.1 * ends.low
    quiet = identify_rates(series(TRUE, 0.005), **case)
    assert quiet.between_speeds == 0.0


@pytest.mark.slow
def test_a_forecast_is_not_below_a_force_measured_at_a_slower_speed():
    # the fastest force is far above what a linear solid with this interface gives
    raised = TRUE * np.array([1, 1, 1, 1, 1, 1.6])
    found = identify_rates(series(raised, 0.02), material=RUBBER, radius=RADIUS)
    forecast = forecast_rates(found, [1.2e-3, 1e-4])
    assert forecast.force[0] >= raised[-1]
    assert forecast.high[0] >= forecast.force[0] >= forecast.low[0]
    assert "less than was measured at a slower speed" in " ".join(forecast.words)
    # another preload or temperature is no slower test of the same contact
    lighter = forecast_rates(found, 1.2e-3, preload=0.5 * PRELOAD)
    assert lighter.force[0] < raised[-1]
