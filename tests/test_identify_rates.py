"""The interface from a rate series: the truth found, intervals honest, limits stated."""

import json
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status
from rate_tests import (
    GAP,
    LENS,
    PRELOAD,
    RADIUS,
    RUBBER,
    SPEEDS,
    WORK,
    fitted,
    holds,
    linear,
    measured,
    of_other,
    of_single_cracks,
)
from viscotack.identify import RateSeries, forecast_rates, identify_rates, pull_offs
from viscotack.identify.covariances import SphereTests
from viscotack.identify.force_ratios import yielding_near
from viscotack.identify.forward import Forward, Interface
from viscotack.identify.pull_off import History, travels
from viscotack.lab.tack import survey
from viscotack.model.materials import Passport
from viscotack.model.materials.library import published

PDMS = published("pdms-10-1").material


@pytest.fixture(scope="module")
def forces():
    return of_single_cracks(Forward(RUBBER, RADIUS), (WORK, GAP, PRELOAD), SPEEDS)


@pytest.fixture(scope="module")
def fit(forces):
    return fitted(forces, 0.03, theory=0.0)


def test_forces_of_single_cracks_give_back_the_interface(forces, fit):
    assert fit.forces == pytest.approx(forces, rel=1e-3)
    assert fit.work_of_adhesion == pytest.approx(WORK, rel=5e-3)
    assert fit.equilibrium_gap == pytest.approx(GAP, rel=0.02)
    # (R w^2/E0*^2)^(1/3)/h0
    assert fit.tabor == pytest.approx(20.4, rel=0.02)


@pytest.mark.parametrize(("dwell", "relaxed"), [(0.1, False), (1e6, True)])
def test_a_caution_says_where_approach_and_dwell_change_the_force(fit, dwell, relaxed):
    # the bulk has long relaxed; the edge still closes
    assert RUBBER.relaxation(0.1) / RUBBER.rubbery_modulus < 1.001
    past = History(1e-4, PRELOAD, dwell)
    tests = [replace(one, history=past) for one in fit.series]
    series = replace(fit.given, tests=tests, theory=0.003)
    told = replace(fit, search=replace(fit.search, series=series)).words
    assert any("`history`" in one for one in told) is not relaxed


def test_the_effect_of_a_machine_follows_powers_of_work_and_range():
    def ratio(work, gap):
        return np.array([1.3, 1.6]) * (work / 0.05) ** 0.2 * (gap / 1e-8) ** -0.4

    def changed(interface, speed, load, **more):
        return SimpleNamespace(ratio=ratio(*interface[:2]), holds=np.array([True, True]))

    forward: Any = SimpleNamespace(changed=changed)
    speed, passport = np.array([1e-6, 1e-4]), Passport(name="", material=RUBBER)
    tests = SphereTests(forward, passport, speed, np.ones(2), stiffness=100.0)
    found, _ = yielding_near(tests, Interface(0.05, 1e-8, None))
    at = {"work_of_adhesion": 0.07, "equilibrium_gap": 3e-8}
    assert found(at) == pytest.approx(ratio(0.07, 3e-8), rel=1e-9)


def test_an_approach_that_excludes_the_fitted_range_makes_it_a_zone_length(fit):
    for bound, is_zone in ((0.5 * GAP, True), (2 * GAP, False)):
        known = of_other(fit, range_bound=bound)
        assert known.is_zone_length is is_zone
        assert known.equilibrium_gap == fit.equilibrium_gap
        assert len(known.words) == len(fit.words) + is_zone


def test_a_slow_test_beside_the_series_narrows_the_range(forces, fit):
    known = fitted(forces, 0.03, theory=0.0, work_of_adhesion=(WORK, 0.01 * WORK))
    ends = [one.intervals["equilibrium_gap"] for one in (fit, known)]
    assert ends[1].high / ends[1].low < 0.8 * ends[0].high / ends[0].low


def test_intervals_are_as_wide_as_the_slopes_of_the_forces_and_the_noise_make_them(fit):
    forces = [linear(), linear(gap=1.05 * GAP)]
    found = Forward(RUBBER, RADIUS).pulled(1.01 * WORK, GAP, SPEEDS, PRELOAD).force
    slopes = [
        np.log(found / forces[0]) / np.log(1.01),
        np.log(forces[1] / forces[0]) / np.log(1.05),
    ]
    rows = np.array(slopes) / 0.03
    deviations = np.sqrt(np.diag(np.linalg.inv(rows @ rows.T)))
    ends = [fit.intervals[name] for name in ("work_of_adhesion", "equilibrium_gap")]
    half = [np.log(each.high / each.low) / 2 for each in ends]
    assert half == pytest.approx(1.645 * deviations, rel=0.05)


@pytest.mark.slow
def test_speeds_at_which_the_theory_does_not_hold_are_excluded():
    solid = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=3e8, tau0=1e-2, poisson_ratio=0.5)
    speeds = np.array([1e-5, 1e-3, 1.0])
    # a Tabor number of 400, too large to simulate
    force = linear(speeds, solid, 10e-9)
    # at 1 m/s the edge has no way to become a steady crack, and another force
    force[-1] *= 1.5
    fit = fitted(force, 0.01, speeds, material=solid, gaps=(2e-9, 2e-8))
    assert [one.speed for one in fit.series] == speeds[:-1].tolist()
    assert [one.speed for one, why in fit.excluded if why] == [1.0]
    assert fit.equilibrium_gap == pytest.approx(10e-9, rel=0.02)
    with pytest.raises(vt.OutOfRange, match="2 m/s"):
        fitted(force[-2:], 0.01, [1.0, 2.0], material=solid, gaps=(2e-9, 2e-8))


@pytest.mark.slow
def test_a_soft_machine_gives_back_the_interface():
    speeds = np.geomspace(1e-5, 1e-1, 3)
    forward, loads = Forward(RUBBER, RADIUS), np.full(3, PRELOAD)
    soft = forward.changed(Interface(WORK, 50e-9), speeds, loads, stiffness=20.0)
    assert soft.ratio.min() < 0.8 and soft.holds.all()
    fit = fitted(linear(speeds, gap=50e-9) * soft.ratio, 0.01, speeds, stiffness=20.0)
    assert fit.work_of_adhesion == pytest.approx(WORK, rel=0.01)
    assert fit.equilibrium_gap == pytest.approx(50e-9, rel=0.03)


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"temperature_uncertainty": 275.15}, "temperature"),
        ({"scatter": 1.0}, "scatter"),
        ({"gaps": (2e-9, 1e-9)}, "gaps"),
        ({"preload": None}, "preload"),
        ({"curves": True}, "curves"),
        ({"history": True}, "history"),
        ({"tests": measured([4e-3], 0.01, [1e-6])}, "two or more speeds"),
    ],
)
def test_a_series_without_information_is_refused(change, name):
    tests = measured([4e-3, 5e-3], 0.01, SPEEDS[:2])
    series = RateSeries(tests, material=RUBBER, radius=RADIUS, preload=PRELOAD)
    unloaded = {"tests": tests} | change
    with pytest.raises(vt.InputError, match=name):
        replace(series, **unloaded)


# A solid like that of the files is soon fitted; theirs takes seconds and gives their interface.
LIKE = '[material]\nmodel = "sls"\nrubbery_modulus = "1.458 MPa"\nglassy_modulus = "4.374 MPa"\n'
LIKE += 'tau0 = "1 ms"\npoisson_ratio = 0.5\n'


@pytest.mark.parametrize(
    ("material", "near"), [(LIKE, 0.5), pytest.param("pdms-10-1", 0.08, marks=pytest.mark.slow)]
)
def test_files_of_a_rig_give_the_interface(material, near, tmp_path, capsys):
    command = ["identify", "rates", *LENS, "--material", material, "--radius", "5.19 mm"]
    picture = tmp_path / "rates.png"
    assert exit_status([*command, "--preload", "1.5 mN", "--json", "--plot", picture]) == 0
    found = json.loads(capsys.readouterr().out)
    speeds = [row["speed_m_s"] for row in found["series"]]
    assert speeds == pytest.approx([1e-6, 3e-5, 1e-3], rel=0.01)
    assert found["work_of_adhesion_J_m2"] == pytest.approx(WORK, rel=near)
    if material == "pdms-10-1":
        assert found["equilibrium_gap_m"] == pytest.approx(GAP, rel=0.35)
    assert picture.stat().st_size > 10_000
    assert exit_status([*command, "--work-of-adhesion", "152 mJ/m2"]) == 2


@pytest.mark.slow
def test_whole_curves_narrow_a_series():
    tests = pull_offs(survey([LENS[0], LENS[2]]).cycles)
    alone, whole = (
        identify_rates(
            RateSeries(tests, material=PDMS, radius=RADIUS, preload=PRELOAD, curves=curves)
        )
        for curves in (False, True)
    )
    # two pull-offs leave two ranges, a hundred times apart; both are in the interval
    ends = alone.intervals["equilibrium_gap"]
    assert ends.split and ends.low < 1e-9 and ends.high > GAP
    # a slower test distinguishes them, so its forecast covers both
    slow = np.array(
        [alone.forward.pulled(*x.values.values(), 1e-7, PRELOAD).force for x in alone.solutions]
    )
    assert max(slow) > 1.2 * min(slow)
    assert holds(forecast_rates(alone, 1e-7), slow)
    ends = whole.intervals["equilibrium_gap"]
    assert not ends.split and 150e-9 < ends.low < GAP < ends.high < 260e-9


def test_travels_of_a_cycle_are_those_of_its_curve_within_their_uncertainty():
    (cycle,) = survey([LENS[2]]).cycles
    read = [one.value for one in travels(cycle)]
    true = Forward(PDMS, RADIUS).pulled(WORK, GAP, 1e-3, PRELOAD).travels
    assert read == pytest.approx(true, rel=2e-3)
    # noise added to the forces scatters the travel to zero force as stated
    rng, sigma = np.random.default_rng(0), 0.005 * cycle.pull_off_force.value
    drawn = [
        travels(replace(cycle, force=cycle.force + sigma * rng.standard_normal(cycle.force.size)))
        for _ in range(200)
    ]
    stated = travels(replace(cycle, noise=sigma))[0].uncertainty
    # of a parabola, in whose middle a point scatters 1.5 times as much as a mean
    assert np.std([one[0].value for one in drawn]) == pytest.approx(1.5 * stated, rel=0.3)
