"""Tests that a fit does not describe: said first, by all doors, with bands that hold the tests."""

import json
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status
from viscotack.identify import PullOff, forecast_rates, identify_rates
from viscotack.identify.forward import Forward
from viscotack.lab import tack
from viscotack.lab.tack import Measured

# Computed tests of an interface that grows with speed: R 5 mm, E* 2 MPa, noise 10 uN, five speeds.
GROWING = sorted((Path(__file__).parent / "data" / "growing_tack").glob("tack_*.csv"))
MEASURED = {1e-6: 2.413, 5e-6: 3.238, 2e-5: 4.403, 1e-4: 6.55, 5e-4: 9.737}  # mN
TRUE = {5e-5: 5.511, 2e-3: 13.47}  # mN, not measured
RUBBER = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-2, poisson_ratio=0.5)
RADIUS, WORK, GAP, PRELOAD = 5.19e-3, 0.15, 200e-9, 1.5e-3
SPEEDS = np.geomspace(1e-6, 1e-3, 6)
FAST = 4e-3
LINEAR = Forward(RUBBER, RADIUS)
ZIGZAG = np.array([1.09, 0.92, 1.08, 0.93, 1.08, 0.91])


def linear(speeds):
    return LINEAR.pulled(WORK, GAP, np.asarray(speeds), PRELOAD).force


def found(forces, relative, theory=0.0):
    series = [
        PullOff(float(v), Measured(float(P), relative * float(P)), PRELOAD)
        for v, P in zip(SPEEDS, forces, strict=True)
    ]
    return identify_rates(series, material=RUBBER, radius=RADIUS, theory=theory)


def test_every_speed_of_the_series_is_read():
    # the fast test has few points, and the outer quarter of its retraction reaches into the flank
    records = [record for path in GROWING for record in tack.read(path)]
    cycles = [tack.evaluate(record).cycles[0] for record in records]
    found = sorted(1e3 * cycle.pull_off_force.value for cycle in cycles)
    assert found == pytest.approx(list(MEASURED.values()), rel=1e-3)


@pytest.mark.slow
def test_a_forecast_from_tests_that_no_linear_solid_explains_holds_them_and_says_so(
    tmp_path, capsys
):
    study = str(tmp_path / "study.toml")
    line = ["--material", "pdms-10-1", "--radius", "5 mm", "--preload", "2 mN"]
    files = [str(path) for path in GROWING]
    assert exit_status(["identify", "rates", *files, *line, "-o", study]) == 0
    first = capsys.readouterr().out.splitlines()[0]
    assert "--growth" in first
    speeds = [x for v in (*MEASURED, *TRUE) for x in ("--speed", f"{v!r} m/s")]
    assert exit_status(["forecast", study, *speeds]) == 0
    assert capsys.readouterr().out.splitlines()[0] == first
    assert exit_status(["forecast", study, *speeds, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["describes_tests"] is False and answer["words"][0] == first
    for row, force in zip(answer["forecast"], [*MEASURED.values(), *TRUE.values()], strict=True):
        assert row["low_N"] < 1e-3 * force < row["high_N"] < 1.7 * row["low_N"]


@pytest.mark.slow
@pytest.mark.parametrize("misfit", [1.9, 2.1])
def test_a_misfit_above_twice_the_uncertainty_is_said_first(misfit):
    forces = linear(SPEEDS) * ZIGZAG
    fit = found(forces, 0.01 * found(forces, 0.01).scatter / misfit)
    assert fit.scatter == pytest.approx(misfit, rel=0.01)
    assert bool(fit.misfit) == (misfit > 2)
    assert (fit.words[0] == fit.misfit) == (misfit > 2)
    # scatter without a trend is smoothed, not followed
    assert not fit.trend
    forecast = forecast_rates(fit, SPEEDS)
    true = linear(SPEEDS)
    assert np.all((forecast.low < true) & (true < forecast.high))


@pytest.mark.slow
def test_a_departure_by_a_power_of_the_speed_is_continued_beyond_the_tests():
    def departed(speeds):
        return linear(speeds) * (np.asarray(speeds) / SPEEDS[0]) ** 0.1

    fit = found(departed(SPEEDS), 0.01, theory=0.02)
    assert fit.trend and fit.misfit
    forecast = forecast_rates(fit, [*SPEEDS, FAST])
    true = departed([*SPEEDS, FAST])
    assert np.all((forecast.low < true) & (true < forecast.high))
    # the linear solid alone gives a force that the band excludes
    assert 1.1 * linear([FAST])[0] < forecast.low[-1]
    assert forecast.high[-1] < 2 * forecast.low[-1]


def test_a_bent_departure_is_held_where_it_was_measured():
    # growth that sets in at the fastest speeds is no power of the speed
    forces = linear(SPEEDS) * (1 + np.sqrt(SPEEDS / 1e-4))
    fit = found(forces, 0.01, theory=0.02)
    assert fit.misfit
    forecast = forecast_rates(fit, SPEEDS)
    assert np.all((forecast.low < forces) & (forces < forecast.high))


@pytest.mark.slow
def test_two_speeds_that_no_interface_fits_widen_the_band():
    series = [PullOff(v, Measured(P, 0.01 * P), PRELOAD) for v, P in ((1e-6, 1e-3), (1e-3, 30e-3))]
    fit = identify_rates(series, material=RUBBER, radius=RADIUS)
    assert fit.misfit and fit.between_speeds > 0.1
    forecast = forecast_rates(fit, [1e-6, 1e-3])
    assert np.all((forecast.low < [1e-3, 30e-3]) & ([1e-3, 30e-3] < forecast.high))
