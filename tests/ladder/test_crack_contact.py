"""Contacts whose edge is a steady crack: limits, twins, published physics, simulation."""

from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from dimensionless import ELASTIC, sphere, standard
from rate_tests import GAP, PRELOAD, RADIUS, RUBBER, WORK
from viscotack.theory import SteadyCrack, profiles
from viscotack.theory.crack.contact import (
    Contact,
    Drive,
    history,
    profile_of,
    radius_at_depth,
    radius_at_force,
    recede,
)

REDUCED = vt.LennardJones(1.0, 1.0)


class Blunt:
    """The paraboloid as a shape that says no more than its gap and its slope."""

    word, symmetry = "blunt", "revolution"

    def gap(self, position):
        return np.asarray(position) ** 2 / 2

    def flank(self, position):
        return np.asarray(position, dtype=float)

    def reduced(self, along, height):
        return self


def test_an_elastic_sphere_is_that_of_jkr():
    found = vt.crack_contact(
        vt.Groups(tabor=1e4, material=ELASTIC, start=vt.AtDepth(1e5), rate=1.0)
    )
    assert found.pull_off_force == pytest.approx(1, rel=2e-4)
    assert found.contact_radius_at_pull_off == pytest.approx((9 / 8) ** (1 / 3), rel=2e-2)
    # its end is a flat minimum
    assert found.work_to_pull_off == pytest.approx(0.80182 * np.pi ** (2 / 3) * 1e4, rel=1e-2)


@pytest.mark.parametrize(
    ("shape", "q", "A"), [(vt.Cone(1.0), 1, 1.0), (vt.PowerLawProfile(0.25, 4.0), 4, 0.25)]
)
def test_elastic_tips_are_those_of_the_theory_of_profiles(shape, q, A):
    found = vt.crack_contact(
        vt.Groups(tabor=1e4, material=ELASTIC, start=vt.AtDepth(3e5), rate=1.0, geometry=shape)
    )
    case = dict(coefficient=A, exponent=q, contact_modulus=1.0, work_of_adhesion=1.0)
    expected = -float(profiles.pull_off(**case).force) / (1.5 * np.pi)
    assert found.pull_off_force == pytest.approx(expected, rel=1e-3)


def test_a_fast_retraction_from_a_large_contact_is_glassy():
    # P = 1/k, a = (9/8k)^(1/3), w = 0.8018 k^(-2/3) mu pi^(2/3), by superposition
    mu, k = 1e5, 0.1
    found = vt.crack_contact(
        vt.Groups(tabor=mu, material=standard(k), start=vt.AtDepth(40 * mu), rate=1e9 * mu)
    )
    assert found.pull_off_force == pytest.approx(1 / k, rel=2e-3)
    assert found.contact_radius_at_pull_off == pytest.approx((9 / (8 * k)) ** (1 / 3), rel=2e-2)
    work = 0.801822 * k ** (-2 / 3) * mu * np.pi ** (2 / 3)
    assert found.work_to_pull_off == pytest.approx(work, rel=1e-2)


def test_both_ways_to_a_receding_contact_agree():
    crack, profile = SteadyCrack(standard(), REDUCED), profile_of(vt.Sphere(1.0))
    a0 = radius_at_depth(profile, 20.0)
    for rate in (1.0, 100.0):
        curve = recede(
            crack, profile, radius=np.array([a0]), rate=np.array([rate]), tabor=np.array([10.0])
        )
        contact = Contact(crack, profile, tabor=10.0, largest=1.05 * a0)
        run = contact.run(contact.relaxed(a0), (Drive("drive", -rate, np.inf),))
        assert run.detached
        assert run.force.min() == pytest.approx(curve.force.min(), rel=2e-3)
        times = run.time[np.argmin(run.force)], curve.time[np.argmin(curve.force[:, 0]), 0]
        assert times[0] == pytest.approx(times[1], rel=0.01)


def test_a_shape_of_the_users_own_is_tabulated():
    own, sphere = profile_of(Blunt()), profile_of(vt.Sphere(1.0))
    radii = np.geomspace(1e-3, 100, 30)
    for name in ("depth", "total", "relaxed_depth", "relaxed_force"):
        assert getattr(own, name)(radii) == pytest.approx(getattr(sphere, name)(radii), rel=1e-6)
    assert radius_at_force(own, 3.0) == pytest.approx(radius_at_force(sphere, 3.0), rel=1e-6)


@pytest.mark.parametrize(
    "groups",
    [
        vt.Groups(tabor=10, material=standard(), start=vt.AtDepth(200), rate=300),
        vt.Groups(
            10,
            vt.Prony(rubbery_modulus=1.0, poisson_ratio=0.0, branches=((1.0, 0.05), (3.0, 0.5))),
            vt.AtDepth(100),
            100,
            geometry=vt.PowerLawProfile(0.25, 4.0),
        ),
    ],
)
def test_the_pull_off_is_that_of_a_simulation(groups):
    found = vt.crack_contact(groups)
    result = vt.solve(groups, until="pull-off", estimate_error=False)
    simulated = vt.pull_off(result)
    assert found.pull_off_force == pytest.approx(simulated.force, rel=0.01)
    assert found.pull_off_force == pytest.approx(simulated.force, rel=found.band)
    assert found.time_at_pull_off == pytest.approx(simulated.time, rel=0.03)
    assert found.contact_radius_at_pull_off == pytest.approx(simulated.contact_radius, rel=0.03)
    assert found.work_to_pull_off == pytest.approx(vt.work_to_pull_off(result), rel=0.06)


def test_a_history_is_that_of_a_simulation():
    groups = vt.Groups(
        tabor=4.0,
        material=standard(0.2),
        start=vt.Apart(20.0),
        moves=(vt.Approach(20.0, vt.AtDepth(50.0)), vt.Dwell(0.5, "force")),
        rate=20.0,
    )
    found, result = vt.crack_contact(groups), vt.solve(groups, estimate_error=False, accuracy=0.01)
    assert found.pull_off_force == pytest.approx(vt.pull_off(result).force, rel=found.band)
    assert found.force.max() == pytest.approx(result.force.max(), rel=0.03)
    loop = np.sum((result.force[1:] + result.force[:-1]) / 2 * np.diff(result.depth))
    assert found.hysteresis == pytest.approx(loop, rel=0.03)


def test_a_slow_pull_after_a_fast_approach_is_that_of_a_simulation(monkeypatch):
    # the edge still closes when the drive turns, and both directions hold for a while
    groups = vt.Groups(
        24.0, standard(0.04), vt.Apart(20.0), 9.0, moves=(vt.Approach(110.0, vt.AtDepth(19.0)),)
    )
    found = vt.crack_contact(groups)
    result = vt.solve(groups, until="pull-off", estimate_error=False, accuracy=5e-3)
    assert found.pull_off_force == pytest.approx(vt.pull_off(result).force, rel=found.band)
    monkeypatch.setattr(history, "_GROWTH", 1.07)
    assert vt.crack_contact(groups).pull_off_force == pytest.approx(found.pull_off_force, rel=6e-3)


def test_an_edge_that_turns_after_a_dwell_does_not_depend_on_steps(monkeypatch):
    moves = (vt.Approach(1e-4, vt.AtForce(PRELOAD)), vt.Dwell(0.1, "force"))
    problem = vt.Problem(
        material=RUBBER,
        traction=vt.LennardJones(work_of_adhesion=WORK, equilibrium_gap=GAP),
        geometry=vt.Sphere(RADIUS),
        protocol=vt.Retraction(start=vt.Apart(GAP), moves=moves, speed=1e-5),
    )
    usual = vt.crack_contact(problem)
    monkeypatch.setattr(history, "_GROWTH", 1.04)
    finer = vt.crack_contact(problem)
    assert finer.pull_off_force == pytest.approx(usual.pull_off_force, rel=2e-3)


@pytest.mark.parametrize("hold", ["depth", "force"])
def test_after_a_very_long_dwell_the_contact_has_relaxed(hold):
    # a dwell of a million times, then a jump of a few 1e-10 of one: steps were round-off
    press = vt.Approach(1e4, to=vt.AtForce(20.0)), vt.Dwell(1e6, hold=hold)
    dwelt = vt.Groups(tabor=100.0, material=standard(), start=vt.Apart(5.0), moves=press, rate=1e3)
    found = vt.crack_contact(dwelt)
    start = vt.AtForce(20.0)
    if hold == "depth":
        start = vt.AtDepth(float(found.depth[found.move == 1][-1]))
    rested = vt.crack_contact(vt.Groups(tabor=100.0, material=standard(), start=start, rate=1e3))
    assert found.pull_off_force == pytest.approx(rested.pull_off_force, rel=5e-3)
    assert found.status == "detached"


def test_after_a_dwell_the_force_is_smooth_in_the_work_of_adhesion():
    # with the steps of a dwell too long near its end, forces scattered by 10 %
    press = (vt.Approach(1e-4, to=vt.AtForce(2e-3)), vt.Dwell(10.0, hold="force"))

    def pulled(work):
        law = vt.LennardJones(work_of_adhesion=work, equilibrium_gap=20e-9)
        pull = vt.Retraction(start=vt.Apart(60e-9), moves=press, speed=1e-4)
        solid = replace(standard(), rubbery_modulus=1e6, glassy_modulus=1e7, poisson_ratio=0.5)
        sphere = vt.Sphere(radius=5e-3)
        problem = vt.Problem(material=solid, traction=law, geometry=sphere, protocol=pull)
        return vt.crack_contact(problem).pull_off_force

    force = np.array([pulled(work) for work in (0.057, 0.0585, 0.06, 0.0615)])
    assert np.max(np.abs(np.diff(force, 2))) < 0.01 * force[0]
    assert np.all(np.diff(force) < 0)


def test_cycles_that_do_not_relax_have_a_bell():
    # Afferrante and Violano: loaded and unloaded at one speed, slow and fast contacts are elastic
    # ones, rubbery and glassy, and JKR's force knows no modulus
    mu = 100.0
    forces = []
    for rate in (1e-7, 1.0, 1e7):
        groups = vt.Groups(
            tabor=mu,
            material=standard(),
            start=vt.Apart(20.0),
            moves=(vt.Approach(rate * mu, vt.AtDepth(10 * mu)),),
            rate=rate * mu,
        )
        forces.append(vt.crack_contact(groups).pull_off_force)
    slow, between, fast = forces
    assert slow == pytest.approx(1, rel=0.05)
    assert fast == pytest.approx(1, rel=0.05)
    assert between > 2


def test_jkr_overestimates_the_work_of_a_contact_that_had_relaxed():
    # Carbone: with the energy of the edge in JKR the bulk is taken for relaxed while it is glassy
    mu = 100.0
    found = vt.crack_contact(
        vt.Groups(tabor=mu, material=standard(), start=vt.AtDepth(2e3), rate=1e4)
    )
    gamma = found.amplification_at_pull_off
    jkr = 0.801822 * gamma ** (5 / 3) * mu * np.pi ** (2 / 3)
    assert gamma > 5
    assert found.work_to_pull_off < 0.3 * jkr
    # and its work is the area of the curve in tension
    until = slice(int(found.force.argmin()), None, -1)
    x = np.linspace(found.depth[until][0], found.depth[0], 1_000_001)
    tension = np.minimum(np.interp(x, found.depth[until], found.force[until]), 0)
    assert found.work_to_pull_off == pytest.approx(-np.trapezoid(tension, x), rel=1e-5)
    # while its force is that of the energy
    assert found.pull_off_force == pytest.approx(gamma, rel=0.02)


def test_moves_end_where_they_are_told():
    moves = (
        vt.Approach(100.0, vt.AtForce(2.0)),
        vt.Dwell(0.3, "depth"),
        vt.LoadTo(3.0, 0.2),
        vt.Dwell(0.2, "force"),
        vt.MoveTo(30.0, 0.5),
        vt.Retract(50.0, vt.AtRadius(1.2)),
    )
    groups = vt.Groups(20.0, standard(), vt.Apart(10.0), None, moves=moves)
    found = vt.crack_contact(groups)
    last = [np.flatnonzero(found.move == i)[-1] for i in range(len(moves))]
    assert found.force[last[0]] == pytest.approx(2.0, rel=1e-4)
    assert found.depth[last[1]] == found.depth[last[0]]
    assert found.force[last[1]] < 2.0
    assert found.force[[last[2], last[3]]] == pytest.approx(3.0, rel=1e-6)
    assert found.depth[last[4]] == pytest.approx(30.0, rel=1e-6)
    assert found.contact_radius[last[5]] == pytest.approx(1.2, rel=1e-4)
    assert found.status == "still in contact"
    assert np.diff(found.time[last]) == pytest.approx(
        [0.3, 0.2, 0.2, 0.5, np.diff(found.time[last])[4]]
    )


def test_what_the_theory_cannot_answer_is_refused_with_the_reason():
    solid = standard()
    with pytest.raises(vt.OutOfRange, match="cohesive zone is too large"):
        vt.crack_contact(vt.Groups(tabor=1.0, material=solid, start=vt.AtDepth(20), rate=10))
    with pytest.raises(vt.OutOfRange, match="preload is too small"):
        vt.crack_contact(vt.Groups(tabor=10, material=solid, start=vt.AtRadius(1.3), rate=1e4))
    with pytest.raises(ValueError, match="no relaxed contact"):
        vt.crack_contact(vt.Groups(tabor=10, material=solid, start=vt.AtDepth(-100), rate=1))
    pad = vt.Problem(
        material=solid,
        traction=vt.LennardJones(work_of_adhesion=1e-3, equilibrium_gap=1e-4),
        geometry=vt.FlatPunch(1e-1),
        body=vt.Layer(1e-2),
        protocol=vt.Retraction(start=vt.AtDepth(1e-4), speed=1e-3),
    )
    with pytest.raises(vt.OutOfRange, match="flat punch"):
        vt.crack_contact(pad)


def test_a_retraction_in_two_moves_takes_the_work_of_one():
    """Of an elastic solid, whatever the speed of the first; the last one begins in tension."""
    rest = vt.Groups(tabor=200.0, material=ELASTIC, start=vt.AtForce(0.0), rate=3.0)
    split = replace(rest, moves=(vt.Retract(1.0, vt.AtDepth(40.0)),))
    one, two = vt.crack_contact(rest), vt.crack_contact(split)
    assert two.pull_off_force == pytest.approx(one.pull_off_force, rel=1e-4)
    # its place, at a flat minimum, is known to a step
    assert two.work_to_pull_off == pytest.approx(one.work_to_pull_off, rel=0.02)


def test_a_stop_on_the_way_out_is_no_pull_off_and_ends_no_work():
    """Pulled fast, stopped, and pulled off slowly: the tension is largest at the stop."""
    moves = (vt.Retract(300.0, vt.AtDepth(-200.0)), vt.Dwell(300.0))
    groups = vt.Groups(100.0, standard(), vt.AtDepth(300.0), 0.3, moves=moves)
    found = vt.crack_contact(groups)
    at_stop = -found.force[found.move == 0][-1]
    slowly = found.force[found.move == 2]
    assert at_stop > 2 * found.pull_off_force
    assert found.pull_off_force == pytest.approx(-slowly.min(), rel=1e-4)
    pulled = (found.move > 0) & (found.depth > found.depth_at_pull_off)
    alone = np.trapezoid(-found.force[pulled], -found.depth[pulled])
    assert found.work_to_pull_off > 1.2 * alone


# Contacts with a steady crack for their edge: rest, dwells, turns and held tensions.
def pressed(*moves, rate=20.0, tabor=10.0, k=0.1):
    approach = vt.Approach(20.0, vt.AtDepth(10 * tabor))
    return sphere(vt.Apart(30.0), approach, *moves, tabor=tabor, material=standard(k), rate=rate)


@pytest.mark.parametrize(
    ("tabor", "hold", "stiffness"),
    [(12.0, "drive", None), (1e5, "depth", None), (1e3, "force", None), (1e5, "drive", 0.1)],
)
def test_a_relaxed_contact_rests(tabor, hold, stiffness):
    rest = sphere(
        vt.AtForce(2.0),
        vt.Dwell(3.0, hold),
        tabor=tabor,
        material=standard(0.05),
        stiffness=stiffness,
    )
    found = vt.crack_contact(rest)
    for series in (found.force, found.contact_radius, found.depth):
        np.testing.assert_allclose(series, series[0], rtol=1e-9)
    assert found.force[0] == pytest.approx(2.0, rel=1e-9)


@pytest.mark.parametrize(("start", "stiffness"), [(vt.AtForce(6.0), None), (vt.AtForce(-0.7), 0.1)])
def test_a_dwell_at_rest_changes_neither_pull_off_nor_band(start, stiffness):
    at_once = vt.Groups(30.0, standard(), start, 300.0, stiffness=stiffness)
    told = vt.crack_contact(at_once)
    for moves in ((vt.Dwell(1e-3),), (vt.Dwell(5.0, "force"), vt.Dwell(0.3))):
        found = vt.crack_contact(
            sphere(start, *moves, tabor=30.0, material=standard(), rate=300.0, stiffness=stiffness)
        )
        assert found.pull_off_force == pytest.approx(told.pull_off_force, rel=1e-8)
        assert found.band == pytest.approx(told.band, rel=1e-6)
        assert found.inside == told.inside
        waited = sum(move.duration for move in moves)
        assert found.time_at_pull_off - waited == pytest.approx(told.time_at_pull_off, rel=1e-6)
        assert np.all(np.diff(found.time) >= 0) and found.move[-1] == len(moves)


def test_a_longer_dwell_after_an_approach_never_lowers_the_pull_off():
    forces = [
        vt.crack_contact(pressed(vt.Dwell(duration), rate=100.0, tabor=20.0)).pull_off_force
        for duration in (1e-3, 10.0)
    ]
    assert forces[1] > forces[0]


@pytest.mark.parametrize(
    "moves",
    [(vt.Dwell(0.1),), (vt.Retract(5.0, vt.AtDepth(40.0)), vt.Approach(100.0, vt.AtDepth(100.0)))],
    ids=["dwell", "reversal"],
)
def test_shorter_steps_neither_chatter_nor_tell_another_force(monkeypatch, moves):
    case = pressed(*moves, rate=2.0)
    usual = vt.crack_contact(case)
    monkeypatch.setattr(history, "_TRAVEL", history._TRAVEL / 2)
    monkeypatch.setattr(history, "_DRIVE", history._DRIVE / 2)
    finer = vt.crack_contact(case)
    assert finer.pull_off_force == pytest.approx(usual.pull_off_force, rel=2e-3)
    for found in (usual, finer):
        way = np.sign(found.edge_speed)
        turns = np.count_nonzero(np.diff(way[way != 0]))
        assert turns <= 1 + len(moves)


def test_steps_are_of_second_order(monkeypatch):
    forces = []
    for factor in (1, 2, 4):
        monkeypatch.setattr(history, "_TRAVEL", 0.016 / factor)
        monkeypatch.setattr(history, "_DRIVE", 0.14 / factor)
        forces.append(vt.crack_contact(pressed(vt.Dwell(1.0))).pull_off_force)
    assert abs(forces[1] / forces[2] - 1) < 2e-4
    assert abs(forces[0] - forces[1]) > 2.5 * abs(forces[1] - forces[2])


@pytest.mark.parametrize("stiffness", [None, 0.1])
def test_a_held_tension_equals_the_given_one(stiffness):
    held = sphere(
        vt.AtForce(-0.5),
        vt.LoadTo(-1.5, 0.2),
        vt.Dwell(0.5, "force"),
        tabor=12.0,
        material=standard(0.2),
        rate=30.0,
        stiffness=stiffness,
    )
    found = vt.crack_contact(held)
    assert found.force[0] == pytest.approx(-0.5, rel=1e-9)
    np.testing.assert_allclose(found.force[found.move == 1], -1.5, rtol=1e-9)


def test_a_contact_that_lets_go_where_it_starts_is_answered_where_zones_are_short():
    # smaller than the glassy contact at pull-off: the tension is largest before the edge has moved
    case = dict(tabor=1e3, material=standard(0.05), rate=1e8)
    moves = (vt.Approach(1e4, vt.AtForce(20.0)), vt.Dwell(1e3))
    after = vt.crack_contact(vt.Groups(start=vt.Apart(20.0), moves=moves, **case))
    rested = vt.crack_contact(vt.Groups(start=vt.AtDepth(8438.61), **case))
    assert after.zones > 10 and rested.zones > 10
    assert 0.9 / 0.05 < after.pull_off_force < rested.pull_off_force < 1 / 0.05
    with pytest.raises(vt.OutOfRange, match="the preload is too small for this rate"):
        vt.crack_contact(vt.Groups(10.0, standard(0.03), vt.AtDepth(60.0), 1e5))


@pytest.mark.parametrize(
    ("case", "words"),
    [
        (pressed(tabor=100.0), "tabor is 100, verified from 8 to 60"),
        (pressed(vt.MoveTo(50.0, 1.0)), "moves of type MoveTo were not compared"),
    ],
)
def test_a_history_of_a_kind_that_was_not_simulated_has_a_note(case, words):
    found = vt.crack_contact(case)
    assert not found.inside
    assert words in found.why
