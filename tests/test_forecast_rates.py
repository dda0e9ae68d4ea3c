"""A forecast from a rate series: held where it was measured, honest elsewhere; and its report."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status
from rate_tests import LENS, holds, measured, of_other
from solids import creep_power_law, standard_solid
from viscotack.identify import RateSeries, forecast_rates, identify_rates, posterior
from viscotack.identify.covariances import SphereTests
from viscotack.identify.forward import Forward, Interface
from viscotack.model.materials import Passport, write_passport
from viscotack.model.materials.conversion import slowed
from viscotack.model.materials.passport import Evidence, allowed
from viscotack.model.materials.shift import WLF

SOLID = creep_power_law(1e6, 1e7, 0.5, 1e-2, 0.5)
RADIUS, WORK, GAP, PRELOAD = 5e-3, 0.1, 50e-9, 1e-3
SPEEDS = np.geomspace(1e-6, 1e-3, 4)
RUBBER = Passport(
    name="rubber",
    material=SOLID,
    temperature=293.15,
    shift=WLF(reference_temperature=293.15, c1=5.0, c2=150.0),
    evidence=Evidence(numbers=50, constants=4, level=0.9, intervals=(("tau0", 5e-3, 2e-2),)),
)
# With three allowed solids, as wide as the interval: the 24 that it is else drawn into take longer.
THREE = replace(RUBBER, allowed=tuple(replace(SOLID, tau0=1.5**n * 1e-2) for n in (-1, 0, 1)))
# Soon fitted, and near the solid of the files.
QUICK = standard_solid(1.458e6, 4.374e6, 1e-3, 0.5)


@pytest.fixture(scope="module")
def forward():
    return Forward(SOLID, RADIUS)


def fitted(forces, relative, material, **more):
    tests = measured(forces, relative, SPEEDS, preload=PRELOAD)
    return identify_rates(RateSeries(tests, material=material, radius=RADIUS, **more))


@pytest.fixture(scope="module")
def noisy(forward):
    noise = 1 + 0.02 * np.random.default_rng(1).standard_normal(SPEEDS.size)
    return forward.pulled(WORK, GAP, SPEEDS, PRELOAD).force * noise


@pytest.fixture(scope="module")
def fit(noisy):
    return fitted(noisy, 0.02, THREE)


@pytest.mark.parametrize("speed", [1e-6, 1e-3])
def test_a_computed_curve_has_the_pull_off_and_the_travel_to_zero_force(forward, speed):
    pulled = forward.pulled(WORK, GAP, speed, PRELOAD)
    depth, force = forward.curve(WORK, GAP, speed, PRELOAD)
    assert force[0] == pytest.approx(PRELOAD)
    assert force.min() == pytest.approx(-float(pulled.force))
    zero = np.interp(0.0, -force[: int(np.argmin(force))], depth[: int(np.argmin(force))])
    assert depth[0] - zero == pytest.approx(float(pulled.travels[..., 0]), rel=1e-3)


def test_a_forecast_covers_the_true_value_and_widens_away_from_the_data(fit, forward):
    speed = np.array([3e-5, 1e-1])
    found = forecast_rates(fit, speed)
    assert holds(found, forward.pulled(WORK, GAP, speed, PRELOAD).force)
    width = np.log(found.high / found.low)
    assert width[1] > 1.5 * width[0]
    assert found.low_of_one is None
    # a warmer contact is no slower test of the same
    warm = forecast_rates(fit, 1.1e-3, temperature=303.15)
    assert warm.high < fit.forces[-1]
    # a single test scatters about the mean of many
    single = forecast_rates(of_other(fit, scatter=0.1), speed[:1])
    assert single.low == pytest.approx(found.low[:1], rel=2e-3)
    wide = np.log(single.high_of_one / single.low_of_one)
    assert wide == pytest.approx(np.hypot(width[:1], 2 * 1.645 * 0.1), rel=0.05)


def test_doubt_about_the_material_widens_the_interval(noisy, fit):
    ends = [x.intervals["equilibrium_gap"] for x in (fitted(noisy, 0.02, SOLID), fit)]
    narrow, wide = (np.log(one.high / one.low) for one in ends)
    assert wide > 1.05 * narrow


@pytest.mark.slow
def test_the_temperature_of_the_tests_is_in_intervals_and_bands():
    sure = replace(RUBBER, evidence=None)
    warm, v = Forward(slowed(SOLID, RUBBER.shift_factor(295.15)), RADIUS), np.array([3e-3])
    force = warm.pulled(WORK, GAP, SPEEDS, PRELOAD).force
    fits = [
        fitted(force, 2e-3, sure, theory=2e-3, temperature_uncertainty=kelvin)
        for kelvin in (0.0, 2.0)
    ]
    truth = {"work_of_adhesion": WORK, "equilibrium_gap": GAP}
    off = [one.objective.best(truth).misfit - one.best.misfit for one in fits]
    assert off[0] > 10 and off[1] < 3
    assert holds(forecast_rates(fits[1], v), warm.pulled(WORK, GAP, v, PRELOAD).force)


def test_times_in_doubt_are_speeds_in_doubt(forward):
    # tau -> c tau is v -> c v: the scatter of ln(force) is the slope times that of ln(tau)
    speed = np.array([1e-5, 1.1e-5])
    tests = SphereTests(forward, RUBBER, speed, np.full(2, PRELOAD))
    rows = tests.log_forces(allowed(RUBBER), Interface(WORK, GAP))
    force = forward.pulled(WORK, GAP, speed, PRELOAD).force
    slope = np.diff(np.log(force)) / np.log(1.1)
    scatter = np.std([np.log(one.tau0) for one in allowed(RUBBER)], ddof=1)
    assert np.std(rows[:, 0], ddof=1) == pytest.approx(slope[0] * scatter, rel=0.1)
    slower = tests.slower(0.05, Interface(WORK, GAP))
    assert slower == pytest.approx(0.05 * np.repeat(slope, 2), rel=0.1)


def test_the_posterior_agrees_with_the_profile(fit):
    chain = posterior(fit.objective, fit.best)
    ends = np.quantile(np.log(chain.values[:, 0]), [0.05, 0.95])
    told = fit.intervals["work_of_adhesion"]
    assert np.diff(ends)[0] == pytest.approx(np.log(told.high / told.low), rel=0.3)
    assert chain.converged


def test_what_cannot_be_forecast_is_refused(fit):
    with pytest.raises(vt.InputError, match="dwell"):
        forecast_rates(fit, [1e-4], dwell=1.0)
    passport = replace(RUBBER, shift=None)
    bare = of_other(fit, material=passport)
    with pytest.raises(vt.InputError, match="temperature"):
        forecast_rates(bare, [1e-4], temperature=310.0)


@pytest.mark.slow
def test_from_rig_files_to_a_report_in_three_commands(tmp_path, capsys):
    solid = tmp_path / "solid.toml"
    write_passport(Passport(name="rubber", material=QUICK), solid)
    study, page = tmp_path / "study.toml", tmp_path / "report.html"
    words = ["--material", str(solid), "--radius", "5.19 mm", "-o", str(study)]
    assert exit_status(["identify", "rates", *LENS, *words]) == 0
    capsys.readouterr()
    assert exit_status(["forecast", str(study), "--speed", "10 um/s", "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)["forecast"]
    assert row["low_N"] < row["pull_off_force_N"] < row["high_N"]
    speeds = ["--speed", "1 um/s", "--speed", "1 mm/s"]
    assert exit_status(["report", str(study), *speeds, "-o", str(page)]) == 0
    content = page.read_text()
    assert "4.21 mN" in content and content.count("<svg") == 4
    # no link leads out of the page
    links = re.findall(r'(?:src|href)="([^"]*)"', content)
    assert all(link.startswith(("#", "data:image/png", "data:text/csv")) for link in links)
