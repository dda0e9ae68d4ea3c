"""Hysteresis on the ladder: what a loop has lost, in which state it closed, and its error."""

from dataclasses import replace

import numpy as np
import pytest

from dimensionless import ELASTIC, SOLID, punch
from dimensionless import sphere as of_solid
from viscotack.model.protocol import Apart, Approach, AtDepth, AtForce, Dwell, Retract
from viscotack.result import load, save
from viscotack.result.cycles import Loop, cycle_rows, cycles
from viscotack.result.observables import work_to_pull_off
from viscotack.simulate import solve
from viscotack.simulate.crack_contact.by_crack import crack_contact

pytestmark = pytest.mark.march


def sphere(start, *moves, tabor=0.5, material=ELASTIC, **more):
    return of_solid(start, *moves, tabor=tabor, material=material, **more)


def only_cycle(groups, accuracy=0.01):
    (cycle,) = cycles(solve(groups, accuracy=accuracy))
    return cycle


LOOP = (Approach(1.0, AtForce(4.0)), Retract(1.0, AtForce(2.0)))
PUNCH = punch(
    AtForce(0.5),
    Approach(1.0, AtForce(1.0)),
    Retract(1.0, AtForce(0.5)),
    material=ELASTIC,
    stiffness=0.1,
)


@pytest.mark.parametrize(
    ("groups", "taken"),
    [
        (sphere(AtForce(2.0), *LOOP, stiffness=0.1), 4.0),
        (sphere(AtForce(2.0), *LOOP, stiffness=1.0), 4.0),
        (PUNCH, 0.5),
    ],
    ids=["soft", "stiffer", "punch"],
)
def test_an_elastic_loop_behind_a_spring_loses_nothing(groups, taken):
    cycle = only_cycle(groups)
    assert cycle.loop is Loop.CLOSED
    assert abs(cycle.hysteresis) < 1e-3 * taken
    assert abs(cycle.hysteresis) <= cycle.hysteresis_error * abs(cycle.hysteresis)


def test_the_hysteresis_is_the_integral_of_the_force_over_the_depth():
    loop = (Approach(5.0, AtDepth(4.0)), Retract(5.0, AtDepth(2.0)))
    result = solve(sphere(AtDepth(2.0), *loop, material=SOLID, stiffness=0.3), accuracy=0.01)
    (cycle,) = cycles(result)
    force, depth = result.force, result.depth
    loop_integral = np.sum((force[1:] + force[:-1]) / 2 * np.diff(depth))
    assert cycle.hysteresis == pytest.approx(loop_integral, rel=2e-3, abs=0)


def test_a_loop_reports_the_returned_work():
    there = Approach(5.0, AtDepth(4.0))
    back = Retract(5.0, AtDepth(2.0))

    def loop(*moves, **more):
        return only_cycle(sphere(AtDepth(2.0), *moves, material=SOLID, **more), 0.02)

    fresh, rested = loop(there, back), loop(there, back, Dwell(50.0, hold="depth"))
    assert fresh.loop is Loop.DEPTH and fresh.hysteresis > 0
    assert rested.loop is Loop.CLOSED
    # after 1 tau0 the force is back within 0.24 %, less than the accuracy; after 0.3, within 6 %
    for rest, ended in ((0.3, Loop.DEPTH), (1.0, Loop.CLOSED)):
        assert loop(there, back, Dwell(rest, hold="depth")).loop is ended
    # what was left in the modes has become heat, and no work was done
    assert rested.hysteresis == pytest.approx(fresh.hysteresis, rel=1e-2, abs=0)
    away = loop(there, Retract(5.0, AtDepth(1.0)))
    assert away.loop is Loop.OPEN and np.isnan(away.hysteresis)


def test_attraction_across_the_gap_at_which_an_elastic_loop_ends_is_not_lost():
    tap = (Approach(5.0, AtDepth(1.0)), Retract(5.0, AtDepth(-4.0)))
    result = solve(sphere(Apart(25.0), *tap), accuracy=0.01)
    (cycle,) = cycles(result)
    assert cycle.loop is Loop.APART
    left = result.energy.interface[-1] - result.energy.interface[0]
    assert abs(cycle.hysteresis) < 0.1 * abs(left)


def test_energy_left_in_the_modes_counts_as_lost():
    tap = (Approach(50.0, AtDepth(20.0)), Dwell(1.0), Retract(1000.0, AtDepth(-25.0)))
    left = solve(sphere(Apart(25.0), *tap, material=SOLID), accuracy=0.01)
    (cycle,), energy = cycles(left), left.energy
    lost = energy.heat[-1] + energy.jumps[-1] + energy.transfer[-1]
    kept = energy.elastic[-1] - energy.elastic[0]
    assert kept > 0.05 * lost
    assert cycle.hysteresis == pytest.approx(lost + kept, rel=5e-3, abs=0)


def test_errors_of_cycles_cover_the_true_values_and_are_kept_in_a_file(tmp_path):
    tap = (Approach(5.0, AtDepth(2.0)), Retract(5.0, AtDepth(-9.0)), Dwell(30.0))
    groups = sphere(Apart(9.0), *2 * tap, material=SOLID, tabor=1.0)
    result = solve(groups, accuracy=0.02)
    found, truth = cycles(result), cycles(solve(groups, accuracy=1e-3, estimate_error=False))
    for cycle, true in zip(found, truth, strict=True):
        off = abs(cycle.hysteresis - true.hysteresis)
        assert off <= cycle.hysteresis_error * cycle.hysteresis < 0.2 * cycle.hysteresis
    assert result.error_estimate["hysteresis"] == max(c.hysteresis_error for c in found)
    save(result, tmp_path / "run.npz")
    rows = cycle_rows(result)
    assert cycle_rows(load(tmp_path / "run.npz")) == rows
    first = rows[0]
    assert first["loop"] == "apart" and first["hysteresis_error"] == found[0].hysteresis_error


def test_a_contact_with_a_steady_crack_has_the_same_hysteresis():
    tap = (Approach(50.0, AtDepth(100.0)), Retract(50.0, AtDepth(-9000.0)))
    groups = sphere(Apart(30.0), *tap, material=SOLID, tabor=300.0)
    answer = crack_contact(groups)
    (cycle,) = cycles(solve(groups))
    assert answer.loop is cycle.loop is Loop.APART
    assert cycle.hysteresis == pytest.approx(answer.hysteresis, rel=1e-12, abs=0)
    rub = (Approach(50.0, AtDepth(150.0)), Retract(50.0, AtDepth(100.0)))
    # after a rest the force has returned too, but what the solid stores is not known
    for moves in (rub, (*rub, Dwell(1e4, hold="depth"))):
        rubbed = sphere(AtDepth(100.0), *moves, material=SOLID, tabor=300.0)
        answer = crack_contact(rubbed)
        (cycle,) = cycles(solve(rubbed))
        assert answer.loop is cycle.loop is Loop.DEPTH
        assert cycle.hysteresis == pytest.approx(answer.hysteresis, rel=1e-12, abs=0)
        assert cycle.hysteresis > 0
    assert abs(answer.force[-1] - answer.force[0]) < 1e-3 * np.ptp(answer.force)


def test_the_work_of_a_punch_is_that_of_its_result():
    result = solve(replace(PUNCH, moves=(), rate=5.0), accuracy=0.01, estimate_error=False)
    (cycle,) = cycles(result)
    assert cycle.work_to_pull_off == pytest.approx(work_to_pull_off(result), rel=1e-9, abs=0)
