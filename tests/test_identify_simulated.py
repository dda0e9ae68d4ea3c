"""The interface where the theory of a steady crack does not hold: its forces are simulated."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from viscotack.errors import InputError
from viscotack.identify import PullOff, forecast_rates, identify_rates, pull_offs
from viscotack.identify import simulations as simulating
from viscotack.identify.computed import Computed
from viscotack.identify.forward import Forward
from viscotack.identify.pull_off import History
from viscotack.identify.simulations import Simulations
from viscotack.identify.smooth_ratio import LENGTHS
from viscotack.identify.tiers import Conditions, Tiers
from viscotack.lab.tack import Measured, survey
from viscotack.protocol import Approach, Dwell

SOLID = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.1, poisson_ratio=0.5)
RADIUS, WORK, PRELOAD = 5e-3, 0.1, 4e-3
FORWARD = Forward(SOLID, RADIUS)
# of a Tabor number of 1
LENGTH = (RADIUS * WORK**2 / SOLID.contact_modulus**2) ** (1 / 3)
SPEEDS = np.array([1e-5, 1e-4, 1e-3])


@cache
def simulated(tabor, speed):
    """Pull-off force [N], more accurate than in a fit."""
    problem = FORWARD.problem(WORK, LENGTH / tabor, PRELOAD, speed)
    found = vt.solve(problem, until="pull-off", accuracy=1e-3, estimate_error=False)
    return vt.pull_off_force(found) * problem.scales().force


def series(tabor, relative):
    forces = [simulated(tabor, float(v)) for v in SPEEDS]
    return [
        PullOff(float(v), Measured(f, relative * f), PRELOAD)
        for v, f in zip(SPEEDS, forces, strict=True)
    ]


@pytest.fixture(scope="module")
def fit():
    around = (LENGTH / 3 / 4, LENGTH / 3 * 4)
    return identify_rates(series(3.0, 0.005), material=SOLID, radius=RADIUS, gaps=around)


@pytest.mark.slow
def test_a_series_at_a_low_tabor_number_gives_back_its_interface(fit):
    assert fit.work_of_adhesion == pytest.approx(WORK, rel=0.01)
    assert fit.equilibrium_gap == pytest.approx(LENGTH / 3, rel=0.03)
    ends = fit.intervals["equilibrium_gap"]
    assert ends.low < LENGTH / 3 < ends.high
    assert np.all(fit.model_error.simulation > 0) and not np.any(fit.model_error.theory)
    assert "forces by simulation at 10 um/s, 100 um/s, 1 mm/s" in " ".join(fit.words)


@pytest.mark.slow
def test_a_forecast_three_times_as_fast_is_simulated(fit):
    found = forecast_rates(fit, [3e-3])
    assert found.low[0] < simulated(3.0, 3e-3) < found.high[0]
    assert found.force == pytest.approx(simulated(3.0, 3e-3), rel=0.01)
    assert "forces by simulation at 3 mm/s" in " ".join(found.words)


@pytest.mark.parametrize("speed", [pytest.param(1e-5, marks=pytest.mark.slow), 1e-4])
def test_theory_and_simulation_agree_within_their_errors_where_both_hold(speed):
    gap = LENGTH / 12
    changed = FORWARD.changed(WORK, gap, np.array([speed]), np.array([PRELOAD]))
    theory = FORWARD.pulled(WORK, gap, speed, PRELOAD).force * changed.ratio
    assert not changed.refused
    assert theory == pytest.approx(simulated(12.0, speed), rel=float(changed.band[0]) + 1e-3)


def test_a_finite_dwell_is_simulated():
    moves = (Approach(1e-4, to=vt.AtForce(PRELOAD)), Dwell(0.2, hold="force"))
    speed = np.array([1e-4])
    with Simulations() as runs:
        tests = Conditions(speed, np.array([PRELOAD]), None, (moves,))
        tiers = Tiers.none(FORWARD, tests, runs).at(np.log([[WORK, LENGTH / 3]]) / LENGTHS)
        assert runs.count == 1
    ratio = float(np.exp(tiers.log_ratio[0, 0]))
    rigid = float(FORWARD.pulled(WORK, LENGTH / 3, speed, PRELOAD).force[0])
    assert ratio * rigid < 0.99 * simulated(3.0, 1e-4)


@pytest.mark.slow
def test_a_series_after_short_dwells_gives_back_its_interface_by_the_history_of_each_test():
    relaxing = History(1e-4, PRELOAD, 0.05)

    def force(speed):
        moves = (Approach(1e-4, to=vt.AtForce(PRELOAD)), Dwell(0.05, hold="force"))
        problem = FORWARD.problem(WORK, LENGTH / 3, PRELOAD, speed, moves=moves)
        found = vt.solve(problem, until="pull-off", accuracy=2e-3, estimate_error=False)
        return vt.pull_off_force(found) * problem.scales().force

    forces = [force(float(v)) for v in SPEEDS[1:]]
    tests = [
        PullOff(float(v), Measured(f, 0.005 * f), PRELOAD, history=relaxing)
        for v, f in zip(SPEEDS[1:], forces, strict=True)
    ]
    case = {"material": SOLID, "radius": RADIUS, "gaps": (LENGTH / 5, LENGTH / 2)}
    found = identify_rates(tests, history=True, **case)
    assert found.work_of_adhesion == pytest.approx(WORK, rel=0.01)
    assert found.equilibrium_gap == pytest.approx(LENGTH / 3, rel=0.03)
    relaxed = identify_rates(tests, **case)
    assert relaxed.work_of_adhesion < 0.97 * found.work_of_adhesion
    assert "taken as relaxed, but after a dwell of 50 ms" in " ".join(relaxed.words)


def test_histories_that_cannot_be_taken_into_account_are_refused():
    case = {"material": SOLID, "radius": RADIUS, "history": True}
    some = [PullOff(v, Measured(1e-3, 1e-5), PRELOAD) for v in (1e-5, 1e-4)]
    with pytest.raises(InputError, match="no speed of their approach"):
        identify_rates(some, **case)
    with pytest.raises(InputError, match="thick samples without growth only"):
        identify_rates(some, curves=True, **case)


def test_the_history_of_a_test_is_that_of_its_file():
    rig = Path(__file__).parents[1] / "examples" / "from_rig" / "lens_30_um_s.csv"
    (one,) = pull_offs(survey([rig]).cycles)
    approach, *rest = one.history.moves(one.preload)
    assert approach.to.force == pytest.approx(1.5e-3, rel=0.05)
    assert approach.speed == pytest.approx(one.history.approach_speed) and one.history.dwell > 0
    assert [move.duration for move in rest] == [one.history.dwell]
    # the force has relaxed where the drive was held
    assert History(1e-6, 2e-3, 1.0).moves(1.5e-3)[1].hold == "drive"
    assert History(1e-6, 1.5e-3, 1.0).moves(1.5e-3)[1].hold == "force"


def test_a_simulated_force_is_computed_once(monkeypatch):
    problems = [FORWARD.problem(WORK, LENGTH / 2, PRELOAD, speed) for speed in (1e-3, 1e-2)]
    computed = Computed()
    with Simulations(computed) as runs:
        first = runs.forces(problems)
    monkeypatch.setattr(simulating, "_force", None)
    with Simulations(computed) as runs:
        assert np.array_equal(runs.forces(problems), first)
        assert runs.count == 2
