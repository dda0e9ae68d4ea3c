from dataclasses import replace

import numpy as np
import pytest

import synthetic
import viscotack as vt
from dimensionless import ELASTIC, punch, standard
from synthetic import (
    GROUPS,
    PULL_OFF_DEPTH,
    PULL_OFF_RADIUS,
    SI,
    WORK_TO_PULL_OFF,
    jkr_crack_speed,
    jkr_detachment,
    jkr_force,
    jkr_result,
)

# Observable, its exact value for a JKR retraction, and its order in the steps.
EXACT = [
    (vt.pull_off_force, 1.0, 4),
    (vt.depth_at_pull_off, PULL_OFF_DEPTH, 3),
    (vt.contact_radius_at_pull_off, PULL_OFF_RADIUS, 2),
    (vt.crack_speed_at_pull_off, jkr_crack_speed(PULL_OFF_RADIUS), 2),
    (vt.work_to_pull_off, WORK_TO_PULL_OFF, 3),
]


@pytest.mark.parametrize(("observable", "exact", "order"), EXACT)
def test_observables_of_a_jkr_retraction_converge_to_its_closed_forms(observable, exact, order):
    levels, shifts = (100, 200, 400), np.arange(16) / 16
    # The worst over where the steps lie beside the minimum: else chance decides the slope.
    errors = [
        max(abs(observable(jkr_result(steps=n, shift=s)) - exact) for s in shifts) for n in levels
    ]
    slopes = -np.diff(np.log2(errors))
    assert slopes == pytest.approx([order, order], abs=0.45), errors
    assert slopes[-1] == pytest.approx(order, abs=0.1), errors
    assert errors[-1] < 5e-5


def test_round_off_does_not_choose_the_points_around_the_minimum():
    # steps of equal length: the next but one before and after the lowest are equally far
    x = np.linspace(-2.0, 2.0, 41)
    force = -np.exp(-((x - 0.02) ** 2))
    random = np.random.default_rng(1)
    found = [
        vt.pull_off_force(jkr_result(steps=40, depth=1e-13 * noise - x, force=force))
        for noise in random.uniform(-1, 1, (10, 41))
    ]
    assert np.ptp(found) < 1e-11


def test_work_starts_with_the_retraction_where_that_is_in_tension():
    # Two routes: from zero force, less the piece from zero force to the start.
    start = 1.4
    late = vt.work_to_pull_off(jkr_result(start=start, steps=400))
    s = np.linspace(start, (9 / 2) ** (1 / 3), 4001)
    force, depth = jkr_force(s), synthetic.jkr_depth(s)
    missed = -float(np.sum((force[1:] + force[:-1]) / 2 * np.diff(depth)))
    assert missed > 0.1
    assert late == pytest.approx(WORK_TO_PULL_OFF - missed, rel=1e-5)


def test_work_counts_from_the_last_of_several_zero_crossings():
    # In tension from 0.1 to 0.3, and deeper from 0.5 to 1.
    quartic = np.polynomial.Polynomial.fromroots([0.1, 0.3, 0.5, 1.0])
    x = np.linspace(0, 1, 401)
    result = plain(-x, quartic(x))
    lowest = quartic.deriv().roots().real.max()
    area = quartic.integ()
    exact = -(area(lowest) - area(0.5))
    assert vt.work_to_pull_off(result) == pytest.approx(exact, rel=1e-6)


def plain(depth, force, **changes):
    """Return a result in which nothing but depth and force matters."""
    nothing = np.full(len(depth), np.nan)
    parts = dict(
        problem=GROUPS,
        time=np.linspace(0, 1, len(depth)),
        depth=depth,
        force=force,
        contact_radius=nothing,
        edge_speed=nothing,
        status="detached",
    )
    return vt.Result(**(parts | changes))


@pytest.mark.parametrize("width", [0.0, 0.2])
def test_a_jump_adds_no_work(width):
    """From compression into tension, at once or over a short motion of the drive."""
    y = np.linspace(0, 2, 13)
    x = np.concatenate([np.linspace(-1, 0, 5), width + y])
    force = np.concatenate([np.ones(5), (y - 1) ** 2 - 2])
    jump = vt.Event("jump into tension", time=x[5] + 1, depth=-x[5], force=1, energy=0)
    result = plain(-x, force, time=x + 1, events=(jump,) if width else ())
    # The pieces are parabolas, which the rule integrates exactly.
    assert vt.work_to_pull_off(result) == pytest.approx(5 / 3, rel=1e-12)
    assert vt.work_of_separation(result) == pytest.approx(10 / 3, rel=1e-12)


def test_a_dwell_at_the_relaxed_start_keeps_the_pull_off_there():
    """A start beyond the force minimum: the force is least where the retraction begins."""
    from viscotack.model.protocol import Dwell

    force = np.array([-1.0, -0.9, -0.7, -0.4, -0.1])
    depth = -np.arange(5.0)
    wait = replace(GROUPS, moves=(Dwell(2.0),))
    held = dict(problem=wait, move=[0, 0, 0, 1, 1, 1, 1])
    rested = plain(np.append([0.0, 0.0], depth), np.append([-1.0, -1.0], force), **held)
    assert vt.pull_off(rested).force == vt.pull_off(plain(depth, force)).force == 1
    assert vt.work_of_separation(rested) == vt.work_of_separation(plain(depth, force))
    # a dwell at that force during which the contact jumps is no relaxed start
    borne = replace(wait, moves=(Dwell(2.0, hold="force"),))
    jump = vt.Event("jump", time=1 / 6, depth=0.0, force=-1.0, energy=1)
    held |= dict(problem=borne, events=(jump,))
    with pytest.raises(ValueError, match="smallest where the machine reversed or stopped"):
        vt.pull_off(plain(np.append([-3.0, 0.0], depth), np.append([-1.0, -1.0], force), **held))


def test_a_minimum_at_a_jump_is_not_drawn_past_it():
    x = np.array([0.0, 1.0, 2.0, 3.0, 3.0, 4.0])
    force = np.array([1.0, -1.0, -3.0, -5.0, -0.5, -0.3])
    result = plain(-x, force, status="jumped at depth -3")
    assert vt.pull_off_force(result) == pytest.approx(5, rel=1e-12)
    assert vt.depth_at_pull_off(result) == -3
    assert vt.work_to_pull_off(result) == pytest.approx(0.5 * 2.5 * 5, rel=1e-12)


def test_a_run_that_ends_in_its_minimum_by_a_jump_has_a_pull_off():
    x = np.linspace(0, 3, 7)
    falling = 1 - x
    assert vt.pull_off_force(plain(-x, falling, status="jumped at depth -3")) == pytest.approx(2)
    with pytest.raises(ValueError, match="still decreases at the end"):
        vt.pull_off_force(plain(-x, falling, status="detached"))


def test_work_of_separation_goes_past_the_jump_to_infinity():
    for far in (5.0, 40.0):
        result = jkr_detachment(far=far, steps=400)
        exact = synthetic.work_of_separation(result.events[0].depth)
        assert vt.work_of_separation(result) == pytest.approx(exact, rel=1e-5)
    # and is more than the work to the instability alone, by the far attraction
    assert vt.work_of_separation(result) - synthetic.WORK_TO_INSTABILITY > 0.2


def test_a_failed_run_has_no_observables():
    failed = jkr_result(status="stopped because the step became too small")
    with pytest.raises(ValueError, match="the run failed.*step became too small"):
        vt.pull_off_force(failed)
    answer = vt.summary(failed)
    assert answer["status"] == "stopped because the step became too small"
    assert answer["outcome"] == "stopped"
    names = [name for name in answer if "pull_off" in name or "work_" in name]
    assert all(answer[name] is None for name in names if not name.endswith("_note"))
    assert "the run failed" in answer["work_to_pull_off_note"]


def test_only_the_retraction_counts_when_there_is_an_approach():
    result = jkr_result()
    depth = np.concatenate([np.linspace(-8, result.depth[0], 50)[:-1], result.depth])
    # A deep jump-in on approach is no pull-off.
    force = np.concatenate([np.full(49, -5.0), result.force])
    both = plain(depth, force, status="still in contact")
    assert vt.pull_off_force(both) == pytest.approx(1, rel=1e-6)
    assert vt.work_to_pull_off(both) == pytest.approx(WORK_TO_PULL_OFF, rel=1e-5)


@pytest.mark.parametrize("error", [0.4, 0.6])
def test_a_work_with_an_error_above_half_its_value_is_omitted(error):
    result = jkr_result(error_estimate={"force": 1e-3, "work": error})
    answer = vt.summary(result)
    if error < 0.5:
        assert answer["work_to_pull_off"] == pytest.approx(WORK_TO_PULL_OFF, rel=1e-3)
        assert answer["work_to_pull_off_note"] is None
    else:
        assert answer["work_to_pull_off"] is None
        assert "is half of it or more, because the" in answer["work_to_pull_off_note"]
        assert answer["pull_off_force"] == pytest.approx(1.0, rel=1e-3)


def test_summary_in_si_adds_the_same_names_with_units():
    answer = vt.summary(jkr_result(problem=SI))
    unit = SI.scales()
    pairs = {
        "pull_off_force_N": ("pull_off_force", unit.force),
        "work_to_pull_off_J": ("work_to_pull_off", unit.work),
        "depth_at_pull_off_m": ("depth_at_pull_off", unit.length),
        "contact_radius_at_pull_off_m": ("contact_radius_at_pull_off", unit.radius),
        "crack_speed_at_pull_off_m_per_s": ("crack_speed_at_pull_off", unit.edge_speed),
    }
    for name, (plain_name, scale) in pairs.items():
        assert answer[name] == pytest.approx(answer[plain_name] * scale, rel=1e-15)
    # 1.5 pi R dg0
    assert answer["pull_off_force_N"] == pytest.approx(3.7248e-3, rel=1e-4)
    assert answer["work_of_separation_J"] is None


def test_a_held_force_is_no_pull_off_however_round_off_lets_it_tremble():
    from viscotack.model.protocol import AtForce, Dwell, LoadTo

    hang = (LoadTo(-1.0, 1.0), Dwell(9.0, hold="force"))
    groups = replace(GROUPS, start=AtForce(0.0), rate=None, moves=hang)
    move = [0, 0, 0, 1, 1, 1, 1]
    force = np.array([0.0, -0.5, -1.0, -1.0, -1.0 - 1e-9, -1.0, -1.0])
    parts = dict(problem=groups, status="jumped at depth -6", move=move)
    for lowest in (4, 6):
        force[-1] = -1.0 if lowest == 4 else -1.0 - 2e-9
        with pytest.raises(ValueError, match="the machine held the force"):
            vt.pull_off(plain(-np.arange(7.0), force, **parts))


def test_a_force_that_relaxes_behind_a_spring_that_stops_is_no_pull_off():
    pull = vt.Retract(1.0, vt.AtDepth(-3.0))
    groups = replace(GROUPS, rate=None, stiffness=2.0, moves=(pull, vt.Dwell(9.0)))
    # the spring shortens while the machine waits, so the contact goes on opening
    depth, force = -np.array([0.0, 1.0, 2.0, 3.0, 3.2, 3.3]), -np.array([0.0, 1, 2, 3, 2.5, 2.2])
    result = plain(depth, force, problem=groups, move=[0, 0, 0, 0, 1, 1])
    with pytest.raises(ValueError, match="smallest where the machine reversed or stopped"):
        vt.pull_off(result)
    # in one move the same force is
    assert vt.pull_off(replace(result, move=[0] * 6)).force == pytest.approx(3.0, abs=0.1)


@pytest.mark.parametrize("steps_left", [1, 4])
def test_the_edge_of_a_punch_that_runs_out_soon_is_not_interpolated_by_a_line(steps_left):
    x, lowest = np.arange(16.0), 6.4
    end = 6.2 + steps_left
    # the travel is a parabola of the place, which a cubic has exactly
    edge = np.where(x < end, np.sqrt(np.maximum(end - x, 0.0)), np.nan)
    problem = punch(vt.AtDepth(1.0), rate=1.0, material=ELASTIC)
    result = plain(-x, (x - lowest) ** 2 - 50.0, problem=problem, contact_radius=edge)
    exact = np.sqrt(end - lowest)
    assert vt.pull_off(result).contact_radius == pytest.approx(exact, rel=1e-9, abs=0)


def test_a_pull_off_is_not_drawn_below_steps_between_which_the_force_breaks_off():
    press = vt.Approach(1.0, vt.AtDepth(50.14))
    wide = {"size": 4.0, "thickness": 20.0, "cohesion": 0.03, "material": standard(1 / 19.2)}
    problem = punch(vt.AtForce(0.0), press, rate=2e5, **wide)
    result = vt.solve(problem, accuracy=0.01, until="pull-off", estimate_error=False)
    # 1.21 where a run five times as accurate has 0.977
    assert vt.pull_off_stress(result) == pytest.approx(-result.force.min(), rel=0.03)
