"""The interface where the theory of a steady crack does not hold: its forces are simulated."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import viscotack as vt
from rate_tests import LENS, measured
from viscotack.identify import RateSeries, forecast_rates, identify_rates, pull_offs
from viscotack.identify.covariances import SphereTests
from viscotack.identify.force_ratios import LENGTHS, KnownRatios, Simulations
from viscotack.identify.forward import Forward, Interface
from viscotack.identify.pull_off import History
from viscotack.lab.tack import survey
from viscotack.model.materials import Passport

SOLID = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.1, poisson_ratio=0.5)
RADIUS, WORK, PRELOAD = 5e-3, 0.1, 4e-3
FORWARD = Forward(SOLID, RADIUS)
# of a Tabor number of 1
LENGTH = (RADIUS * WORK**2 / SOLID.contact_modulus**2) ** (1 / 3)
SPEEDS = np.array([1e-5, 1e-4, 1e-3])
CASE = {"material": SOLID, "radius": RADIUS, "preload": PRELOAD}


@cache
def simulated(tabor, speed):
    """Pull-off force [N], more accurate than in a fit."""
    problem = FORWARD.problem(WORK, LENGTH / tabor, PRELOAD, speed)
    found = vt.solve(problem, until="pull-off", accuracy=1e-3, estimate_error=False)
    return vt.pull_off_force(found) * problem.scales().force


@pytest.fixture(scope="module")
def fit():
    around = (LENGTH / 3 / 4, LENGTH / 3 * 4)
    forces = [simulated(3.0, float(v)) for v in SPEEDS]
    return identify_rates(RateSeries(measured(forces, 0.005, SPEEDS), gaps=around, **CASE))


@pytest.mark.slow
def test_a_series_at_a_low_tabor_number_gives_back_its_interface(fit):
    assert fit.work_of_adhesion == pytest.approx(WORK, rel=0.01)
    assert fit.equilibrium_gap == pytest.approx(LENGTH / 3, rel=0.03)
    ends = fit.intervals["equilibrium_gap"]
    assert ends.low < LENGTH / 3 < ends.high
    assert np.all(fit.search.model.simulation > 0) and fit.simulations > 0


@pytest.mark.slow
def test_a_forecast_three_times_as_fast_is_simulated(fit):
    found = forecast_rates(fit, [3e-3])
    assert found.low[0] < simulated(3.0, 3e-3) < found.high[0]
    assert found.force == pytest.approx(simulated(3.0, 3e-3), rel=0.01)


def test_theory_and_simulation_agree_within_their_errors_where_both_hold():
    speed = 1e-4
    gap = LENGTH / 12
    changed = FORWARD.changed(Interface(WORK, gap), np.array([speed]), np.array([PRELOAD]))
    theory = FORWARD.pulled(WORK, gap, speed, PRELOAD).force * changed.ratio
    assert not changed.refused
    assert theory == pytest.approx(simulated(12.0, speed), rel=float(changed.band[0]) + 1e-3)


def test_a_finite_dwell_is_simulated():
    moves = (vt.Approach(1e-4, to=vt.AtForce(PRELOAD)), vt.Dwell(0.2, hold="force"))
    speed = np.array([1e-4])
    with Simulations() as runs:
        passport = Passport(name="", material=SOLID)
        tests = SphereTests(FORWARD, passport, speed, np.array([PRELOAD]), moves=(moves,))
        tiers = KnownRatios.none(tests, runs).adding(np.log([[WORK, LENGTH / 3]]) / LENGTHS)
        assert runs.count == 1
    ratio = float(np.exp(tiers.log_ratio[0, 0]))
    rigid = float(FORWARD.pulled(WORK, LENGTH / 3, speed, PRELOAD).force[0])
    assert ratio * rigid < 0.99 * simulated(3.0, 1e-4)


@pytest.mark.slow
def test_a_series_after_short_dwells_gives_back_its_interface_by_the_history_of_each_test():
    relaxing = History(1e-4, PRELOAD, 0.05)

    def force(speed):
        moves = (vt.Approach(1e-4, to=vt.AtForce(PRELOAD)), vt.Dwell(0.05, hold="force"))
        problem = FORWARD.problem(WORK, LENGTH / 3, PRELOAD, speed, moves=moves)
        found = vt.solve(problem, until="pull-off", accuracy=2e-3, estimate_error=False)
        return vt.pull_off_force(found) * problem.scales().force

    forces = [force(float(v)) for v in SPEEDS[1:]]
    tests = measured(forces, 0.005, SPEEDS[1:], history=relaxing)
    series = RateSeries(tests, gaps=(LENGTH / 5, LENGTH / 2), **CASE)
    found = identify_rates(replace(series, history=True))
    assert found.work_of_adhesion == pytest.approx(WORK, rel=0.01)
    assert found.equilibrium_gap == pytest.approx(LENGTH / 3, rel=0.03)
    relaxed = identify_rates(series)
    assert relaxed.work_of_adhesion < 0.97 * found.work_of_adhesion


def test_the_history_of_a_test_is_that_of_its_file():
    (one,) = pull_offs(survey([LENS[1]]).cycles)
    approach, *rest = one.history.moves(one.preload)
    assert approach.to.force == pytest.approx(1.5e-3, rel=0.05)
    assert approach.speed == pytest.approx(one.history.approach_speed) and one.history.dwell > 0
    assert [move.duration for move in rest] == [one.history.dwell]
    # the force has relaxed where the drive was held
    assert History(1e-6, 2e-3, 1.0).moves(1.5e-3)[1].hold == "drive"
    assert History(1e-6, 1.5e-3, 1.0).moves(1.5e-3)[1].hold == "force"
