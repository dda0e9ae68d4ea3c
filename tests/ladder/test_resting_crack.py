"""Contacts with a steady crack for their edge: rest, dwells, turns and held tensions."""

import numpy as np
import pytest

import viscotack as vt
from dimensionless import sphere, standard
from viscotack.theory.crack.contact import history


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
    at_once = vt.Groups(
        tabor=30.0, material=standard(), start=start, rate=300.0, stiffness=stiffness
    )
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
    [
        (vt.Dwell(0.1),),
        (vt.Retract(5.0, vt.AtDepth(40.0)), vt.Approach(100.0, vt.AtDepth(100.0))),
    ],
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
