"""Tests that a fit does not describe: reported first, with bands that hold the tests."""

import json
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from command_line import exit_status
from rate_tests import PRELOAD, RADIUS, SPEEDS, WORK, fitted, holds, linear
from viscotack.identify import forecast_rates
from viscotack.identify.covariances import trend_covariance
from viscotack.identify.forecasting import _departure
from viscotack.lab import tack
from viscotack.lab.tack import Measured

# Computed tests of an interface that grows with speed: R 5 mm, E* 2 MPa, noise 10 uN, five speeds.
GROWING = sorted((Path(__file__).parent / "data" / "growing_tack").glob("tack_*.csv"))
MEASURED = {1e-6: 2.413, 5e-6: 3.238, 2e-5: 4.403, 1e-4: 6.55, 5e-4: 9.737}  # mN
TRUE = {5e-5: 5.511, 2e-3: 13.47}  # mN, not measured
ZIGZAG = np.array([1.09, 0.92, 1.08, 0.93, 1.08, 0.91])


def test_every_speed_of_the_series_is_read():
    # the fast test has few points, and the outer quarter of its retraction reaches into the flank
    records = [record for path in GROWING for record in tack.read(path)]
    cycles = [tack.evaluate(record).cycles[0] for record in records]
    found = sorted(1e3 * cycle.pull_off_force.value for cycle in cycles)
    assert found == pytest.approx(list(MEASURED.values()), rel=1e-3)


@pytest.mark.slow
def test_a_forecast_from_tests_that_no_linear_solid_explains_holds_them(tmp_path, capsys):
    study = str(tmp_path / "study.toml")
    line = ["--material", "pdms-10-1", "--radius", "5 mm", "--preload", "2 mN"]
    assert exit_status(["identify", "rates", *map(str, GROWING), *line, "-o", study]) == 0
    first = capsys.readouterr().out.splitlines()[0]
    assert "--growth" in first
    first = first.replace("--growth", "`growth`")
    speeds = [x for v in (*MEASURED, *TRUE) for x in ("--speed", f"{v!r} m/s")]
    assert exit_status(["forecast", study, *speeds, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["describes_tests"] is False and answer["words"][0] == first
    for row, force in zip(answer["forecast"], [*MEASURED.values(), *TRUE.values()], strict=True):
        assert row["low_N"] < 1e-3 * force < row["high_N"] < 1.7 * row["low_N"]


@cache
def scatter_of_zigzag():
    assert fitted(linear(), 0.01, theory=0.0).between_speeds == 0.0
    return fitted(linear() * ZIGZAG, 0.01, theory=0.0).scatter


@pytest.mark.slow
@pytest.mark.parametrize("misfit", [1.9, 2.1])
def test_scatter_from_speed_to_speed_widens_intervals_and_bands_to_hold_the_truth(misfit):
    forces = linear() * ZIGZAG
    fit = fitted(forces, 0.01 * scatter_of_zigzag() / misfit, theory=0.0)
    assert fit.scatter == pytest.approx(misfit, rel=0.01)
    assert fit.describes_tests == (misfit < 2)
    # scatter without a trend is smoothed, not followed
    assert not fit.trend and 0.05 < fit.between_speeds < 0.15
    ends = fit.intervals["work_of_adhesion"]
    assert ends.low < WORK < ends.high and ends.high > 1.1 * ends.low
    assert holds(forecast_rates(fit, SPEEDS), linear())


@pytest.mark.slow
def test_a_departure_by_a_power_of_the_speed_is_continued_beyond_the_tests():
    def departed(speeds):
        return linear(speeds) * (np.asarray(speeds) / SPEEDS[0]) ** 0.1

    fit = fitted(departed(SPEEDS), 0.01)
    assert fit.trend and not fit.describes_tests
    forecast = forecast_rates(fit, [*SPEEDS, 4e-3])
    assert holds(forecast, departed([*SPEEDS, 4e-3]))
    # the linear solid alone gives a force that the band excludes
    assert 1.1 * linear([4e-3])[0] < forecast.low[-1]
    assert forecast.high[-1] < 2 * forecast.low[-1]


def test_a_bent_departure_is_held_where_it_was_measured():
    # growth that sets in at the fastest speeds is no power of the speed
    forces = linear() * (1 + np.sqrt(SPEEDS / 1e-4))
    fit = fitted(forces, 0.01)
    assert not fit.describes_tests
    assert holds(forecast_rates(fit, SPEEDS), forces)


def test_a_departure_reaches_as_far_as_the_noise_of_the_tests_at_each_speed():
    given = SimpleNamespace(speed=np.array([1.0, 1.0, 9.0]), force=np.array([0.9, 1.1, 2.4]))
    series = [SimpleNamespace(force=Measured(force, 0.01)) for force in given.force]
    fit = SimpleNamespace(given=given, series=series, forces=(1.0, 1.0, 2.0))
    found = np.log(_departure(fit, np.array([1.0, 3.0, 9.0]), 0.05))
    off, reach = np.log([[0.9, 1.2], [1.1, 1.2]]), 1.6449 * 0.01
    ends = off + reach * np.array([[-1 / 0.9, -1 / 2.4], [1 / 1.1, 1 / 2.4]])
    assert found == pytest.approx(np.insert(ends, 1, ends.mean(axis=1), axis=1), rel=1e-3)


@pytest.mark.slow
def test_two_speeds_that_no_interface_fits_widen_the_band():
    fit = fitted([1e-3, 30e-3], 0.01, [1e-6, 1e-3], radius=RADIUS)
    assert not fit.describes_tests and fit.between_speeds > 0.1
    assert holds(forecast_rates(fit, [1e-6, 1e-3]), [1e-3, 30e-3])


@pytest.mark.slow
def test_a_forecast_is_not_below_a_force_measured_at_a_slower_speed():
    # the fastest force is far above what a linear solid with this interface gives
    raised = linear() * np.array([1, 1, 1, 1, 1, 1.6])
    fit = fitted(raised, 0.02)
    forecast = forecast_rates(fit, [1.2e-3, 1e-4])
    assert forecast.force[0] >= raised[-1]
    assert forecast.high[0] >= forecast.force[0] >= forecast.low[0]
    # another preload is no slower test of the same contact
    assert forecast_rates(fit, 1.2e-3, preload=0.5 * PRELOAD).force[0] < raised[-1]


def test_a_trend_has_its_part_of_the_variance_at_the_tests_and_grows_twice_as_fast_beyond():
    logs = np.array([0.0, 1.0, 2.0, 3.0])  # standard deviation sqrt(5)/2
    at_tests = trend_covariance(np.exp(logs), np.exp(logs), 0.1)
    assert np.diag(at_tests).mean() == pytest.approx(0.8 * 0.1**2)
    assert np.linalg.matrix_rank(at_tests, tol=1e-12) == 1
    # two e-foldings beyond: 3.5 from the middle, and 2 of a power of twice 0.1 over the deviation
    (beyond,) = trend_covariance(np.exp([5.0]), np.exp(logs), 0.1)
    assert beyond[0] == pytest.approx(0.01 / 1.25 * (0.8 * 3.5**2 + 4 * 2**2))
