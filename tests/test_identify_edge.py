"""The plain edge law: its pull-offs, found again from a rate series, and its forecast."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import viscotack as vt
from command_line import exit_status, refused
from rate_tests import holds, measured
from viscotack.identify import RateSeries, forecast_edge, identify_edge, identify_rates
from viscotack.theory import edge_law, jkr

RADIUS, MODULUS, WORK, PRELOAD = 5e-3, 2e6, 0.06, 2e-3
SOLID = vt.Elastic(rubbery_modulus=0.75 * MODULUS, poisson_ratio=0.5)
CASE = {"radius": RADIUS, "contact_modulus": MODULUS, "preload": PRELOAD}
SPEEDS = np.geomspace(1e-6, 1e-3, 6)
# computed apart, with noise: R 5 mm, w 60 mJ/m2, v0 50 um/s, n 0.4
GROWING = sorted((Path(__file__).parent / "data" / "growing_tack").glob("tack_*.csv"))
UNMEASURED = {5e-5: 5.511e-3, 2e-3: 13.47e-3}


def pulled(speed, v0=5e-5, n=0.4, work=WORK, **more):
    law = {"work_of_adhesion": work, "reference_speed": v0, "exponent": n}
    return edge_law.pull_off_force(speed, **(CASE | law | more))


def series(forces, relative=0.01, speeds=SPEEDS, **more):
    case = {"material": SOLID, "radius": RADIUS, "preload": PRELOAD, "theory": 0.002} | more
    return RateSeries(measured(forces, relative, speeds), **case)


def integrated(speed, v0, n, stiffness):
    """Return the pull-off force by a general solver of the same equation of motion."""
    spring = 0.0 if stiffness is None else 1 / stiffness
    start = jkr.contact_radius_at_force(
        PRELOAD, radius=RADIUS, contact_modulus=MODULUS, work_of_adhesion=WORK
    )
    first = start**2 / RADIUS - np.sqrt(2 * np.pi * start * WORK / MODULUS) + PRELOAD * spring

    def depth(way, a):
        free = 2 * MODULUS * spring
        return (first - way + free * a**3 / (3 * RADIUS)) / (1 + free * a)

    def rate(way, log_a):
        a = np.exp(log_a[0])
        energy = MODULUS * (a**2 / RADIUS - depth(way, a)) ** 2 / (2 * np.pi * a * WORK)
        return [-v0 * max(energy - 1, 0.0) ** (1 / n) / speed / a]

    def gone(way, log_a):
        return log_a[0] - np.log(0.05 * start)

    gone.terminal = True
    found = solve_ivp(rate, (0, 1e-3), [np.log(start)], "LSODA", rtol=1e-9, atol=1e-11, events=gone)
    a = np.exp(found.y[0])
    return -np.min(2 * MODULUS * (a * depth(found.t, a) - a**3 / (3 * RADIUS)))


@pytest.mark.parametrize(
    ("speed", "v0", "n", "stiffness"),
    [(1e-5, 5e-5, 0.4, None), (1e-3, 5e-5, 0.8, None), (1e-4, 1e-3, 0.3, 500.0)],
)
def test_pull_off_of_an_edge_law_solves_its_equation_of_motion(speed, v0, n, stiffness):
    exact = integrated(speed, v0, n, stiffness)
    assert pulled(speed, v0, n, stiffness=stiffness) == pytest.approx(exact, rel=3e-3)


def test_a_slow_edge_law_is_jkr_and_a_fast_one_a_power_of_the_speed():
    assert pulled(1e-18) == pytest.approx(1.5 * np.pi * RADIUS * WORK, rel=1e-3)
    # fast, and from a large contact, the law counts by w / v0^n alone
    halved = pulled(1.0, v0=1e-9 * 0.5 ** (1 / 0.4), work=WORK / 2, preload=10.0)
    assert halved == pytest.approx(pulled(1.0, v0=1e-9, preload=10.0), rel=0.02)
    # the modulus counts by v0 / E^(1/3) alone
    stiffer = pulled(1e-4, v0=5e-5 * 2, contact_modulus=8 * MODULUS)
    assert stiffer == pytest.approx(pulled(1e-4), rel=1e-9)
    assert pulled(1e-4, stiffness=1e9) == pytest.approx(pulled(1e-4), rel=1e-4)
    assert pulled(1e-4, stiffness=500.0) < 0.95 * pulled(1e-4)


def test_an_edge_law_is_found_again_and_forecast():
    n = 0.8
    fit = identify_edge(series(pulled(SPEEDS, n=n)))
    truth = {"work_of_adhesion": WORK, "reference_speed": 5e-5, "exponent": n}
    for name, value in truth.items():
        assert fit.intervals[name].low < value < fit.intervals[name].high
    assert fit.best.values["exponent"] == pytest.approx(n, abs=0.02)
    assert fit.objective.best(truth).misfit < 0.5
    # up to ten times beyond the measured speeds
    speeds = np.array([1e-7, 3e-5, 8e-3, 1e-2])
    forecast = forecast_edge(fit, speeds)
    assert holds(forecast, pulled(speeds, n=n))
    width = np.log(forecast.high / forecast.low)
    assert width[1] < 0.05 and width[2] > 2 * width[1]
    for speed in (0.9e-7, 1.1e-2):
        with pytest.raises(vt.OutOfRange, match="edge law"):
            forecast_edge(fit, [speed])
    # another preload is another contact
    light = forecast_edge(fit, [3e-3], preload=1e-4)
    assert holds(light, pulled([3e-3], n=n, preload=1e-4))


def test_the_edge_law_of_a_spring_is_found_again():
    forces = pulled(SPEEDS, stiffness=500.0)
    fit = identify_edge(series(forces, stiffness=500.0))
    assert fit.best.values["reference_speed"] == pytest.approx(5e-5, rel=0.2)


def test_what_an_edge_law_does_not_know_is_refused():
    with pytest.raises(vt.InputError, match="growth"):
        identify_edge(series(pulled(SPEEDS), growth=True))
    with pytest.raises(vt.InputError, match="speeds"):
        identify_edge(series(pulled(SPEEDS[:3]), speeds=SPEEDS[:3]))


def test_the_criterion_prefers_the_model_that_made_the_forces():
    rubber = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-2, poisson_ratio=0.5)
    some = SPEEDS[[0, 2, 3, 5]]
    fit = identify_rates(series(pulled(some), speeds=some, material=rubber))
    assert fit.edge is not None and fit.edge.criterion < fit.criterion - 6


def test_from_rig_files_to_a_forecast_by_the_edge_law(tmp_path, capsys, monkeypatch):
    study = str(tmp_path / "edge.toml")
    line = ["--radius", "5 mm", "--contact-modulus", "2 MPa", "--preload", "2 mN", "-o", study]
    assert exit_status(["identify", "edge", *map(str, GROWING), *line, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    truth = {"work_of_adhesion": WORK, "reference_speed": 5e-5, "exponent": 0.4}
    for name, value in truth.items():
        assert found["intervals"][name]["low"] < value < found["intervals"][name]["high"]
    speeds = [x for v in UNMEASURED for x in ("--speed", f"{v!r} m/s")]
    assert exit_status(["forecast", study, *speeds, "--json"]) == 0
    for row, force in zip(
        json.loads(capsys.readouterr().out)["forecast"], UNMEASURED.values(), strict=True
    ):
        assert row["low_N"] < force < row["high_N"] < 1.15 * row["low_N"]
    assert exit_status(["report", study, "-o", str(tmp_path / "page.html")]) == 2
    # refused before the fit
    monkeypatch.setattr("viscotack.identify.identify_edge", None)
    assert "temperature" in refused(["forecast", study, "--temperature", "40 degC"], capsys)
