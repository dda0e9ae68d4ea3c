"""Derivatives of a simulation: exact relations between them, differences, and refusals."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import viscotack as vt
from synthetic import jkr_result
from viscotack.bem.body import Body
from viscotack.bem.contacts.contact import Relaxed
from viscotack.bem.equilibrium import descend
from viscotack.bem.machine import Hold
from viscotack.bem.memory import step
from viscotack.bem.origin import ByNodes, ByStep
from viscotack.bem.tangent import Tangents
from viscotack.cards import cards
from viscotack.materials import Modes
from viscotack.problem.changed import changed
from viscotack.problem.nouns import own_nouns
from viscotack.protocol import Approach, LoadTo
from viscotack.result import sensitivities
from viscotack.result.sensitivities import Slopes
from viscotack.traction.growing import Eyring

ARMS = vt.Prony(rubbery_modulus=1.0, branches=[(4.0, 0.03), (5.0, 1.0)], poisson_ratio=0.0)
PULL = vt.Groups(tabor=1.5, material=ARMS, start=vt.AtDepth(6.0), rate=8.0)
FORCE, WORK = "pull_off_force", "work_to_pull_off"


def solved(problem, **options):
    return vt.solve(problem, until="pull-off", estimate_error=False, **options)


@pytest.fixture(scope="module")
def pulled():
    return solved(PULL, sensitivities=True)


def test_inputs_have_the_paths_of_campaigns(pulled):
    lens = vt.read_case(Path(__file__).parents[1] / "examples" / "from_toml" / "lens.toml")
    for problem in (PULL, lens):
        names = {one.name for one in changed(problem)}
        assert names and names <= set(vt.campaign.inputs_of(problem))
    assert set(pulled.sensitivities.elasticities[FORCE]) <= set(vt.campaign.inputs_of(PULL))


def test_inputs_of_a_user_defined_law_can_change():
    (morse,) = own_nouns([Path(__file__).parents[1] / "examples" / "own" / "morse.py"])
    law = morse(**{name: 1.0 for name in cards(morse)})
    names = {one.name for one in changed(replace(PULL, traction=law))}
    assert any(name.startswith("traction.") for name in names)


@pytest.mark.parametrize("output", [FORCE, WORK, "depth_at_pull_off"])
def test_only_the_product_of_rate_and_times_matters(pulled, output):
    by = pulled.sensitivities.elasticities[output]
    times = sum(by[f"material.branches.{arm}.1"] for arm in range(2))
    assert times == pytest.approx(by["rate"], rel=1e-3)


@pytest.mark.parametrize("name", ["tabor", "material.branches.0.0", "rate", "start.depth"])
def test_derivatives_are_those_of_simulations_with_changed_inputs(pulled, name, monkeypatch):
    monkeypatch.setattr("viscotack.problem.changed._CHANGE", 0.04)
    (one,) = changed(PULL, [name])
    ends = [vt.summary(solved(x, accuracy=5e-4)) for x in (one.low, one.high)]
    for output in (FORCE, WORK):
        difference = np.log(ends[1][output] / ends[0][output])
        expected = difference / (np.log1p(one.up) - np.log1p(one.down))
        found = pulled.sensitivities.elasticities[output][name]
        assert found == pytest.approx(expected, rel=0.02, abs=1e-3)


def test_derivatives_follow_a_move_that_ends_at_a_force_and_a_dwell(monkeypatch):
    solid = vt.StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    moves = Approach(to=vt.AtForce(6.0), speed=3.0), vt.Dwell(0.5)
    test = vt.Groups(tabor=1.0, material=solid, start=vt.AtForce(1.0), rate=5.0, moves=moves)
    found = solved(test, sensitivities=True).sensitivities.elasticities[FORCE]
    # every time of the problem scaled by one factor changes nothing
    assert found["rate"] + found["moves.0.speed"] == pytest.approx(
        found["material.tau0"] + found["moves.1.duration"], rel=2e-3
    )
    monkeypatch.setattr("viscotack.problem.changed._CHANGE", 0.05)
    for name in ("moves.0.to.force", "moves.0.speed"):
        (one,) = changed(test, [name])
        ends = [vt.summary(solved(x, accuracy=5e-4))[FORCE] for x in (one.low, one.high)]
        expected = np.log(ends[1] / ends[0]) / (np.log1p(one.up) - np.log1p(one.down))
        assert found[name] == pytest.approx(expected, rel=0.02)


def test_in_si_units_of_stress_and_length_do_not_matter():
    rubber = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=8e6, tau0=0.1, poisson_ratio=0.49)
    problem = vt.Problem(
        material=rubber,
        traction=vt.LennardJones(0.1, 1e-6),
        geometry=vt.Sphere(3e-3),
        protocol=vt.Retraction(start=vt.AtForce(2e-3), speed=3e-5),
    )
    by = solved(problem, sensitivities=True).sensitivities.elasticities[FORCE]
    stresses = by["material.rubbery_modulus"] + by["material.glassy_modulus"]
    work, load = by["traction.work_of_adhesion"], by["protocol.start.force"]
    # of force = stress times length squared, work of adhesion = stress times length
    assert stresses + work + load == pytest.approx(1.0, abs=1e-3)
    lengths = by["traction.equilibrium_gap"] + by["geometry.radius"] + by["protocol.speed"]
    assert lengths + work + 2 * load == pytest.approx(2.0, abs=2e-3)


def test_only_named_inputs_are_computed_and_saved(tmp_path):
    result = solved(PULL, accuracy=0.02, sensitivities=["rate"])
    assert set(result.sensitivities.inputs) == {"rate"}
    vt.save(result, tmp_path / "run.npz")
    assert vt.load(tmp_path / "run.npz").sensitivities == result.sensitivities
    with pytest.raises(ValueError, match="the inputs are tabor"):
        solved(PULL, sensitivities=["thickness"])


def test_the_curve_is_the_same_with_derivatives(pulled):
    assert np.array_equal(solved(PULL).force, pulled.force)


def test_a_peak_that_the_machine_sets_has_no_derivative():
    moves = (LoadTo(-20.0, 5.0),)
    test = vt.Groups(tabor=1.5, material=ARMS, start=vt.AtDepth(6.0), rate=None, moves=moves)
    found = solved(test, accuracy=0.01, sensitivities=["tabor"]).sensitivities
    assert not found.elasticities
    assert "set by the machine" in found.refused[FORCE]


def test_an_edge_that_the_nodes_hold_has_no_derivative():
    solid = vt.Elastic(rubbery_modulus=1, poisson_ratio=0)
    test = vt.Groups(tabor=5.0, material=solid, start=vt.AtDepth(5.0), rate=5.0)
    found = solved(test, sensitivities=True).sensitivities
    assert "the nodes hold the edge" in found.refused[WORK]
    assert WORK not in found.elasticities


def test_an_elastic_contact_forgets_its_start_and_knows_no_rate():
    solid = vt.Elastic(rubbery_modulus=1, poisson_ratio=0)
    test = vt.Groups(tabor=10.0, material=solid, start=vt.AtDepth(10.0), rate=5.0)
    by = solved(test, accuracy=5e-4, sensitivities=["start.depth", "rate"])
    by = by.sensitivities.elasticities
    for output in (FORCE, "depth_at_pull_off", "contact_radius_at_pull_off"):
        # with the edge moving past frozen nodes the depth would have 0.04
        assert abs(by[output]["start.depth"]) < 2e-3
        assert abs(by[output]["rate"]) < 1e-6
    assert abs(by[WORK]["rate"]) < 1e-6


def test_growing_interfaces_and_punches_are_refused():
    rest = vt.LennardJones(1.0, 1.0)
    growing = Eyring.of(rest, reference_speed=1.0, sensitivity=0.1)
    aged = vt.Groups(tabor=1.5, material=ARMS, start=vt.AtDepth(6.0), rate=8.0, traction=growing)
    with pytest.raises(ValueError, match="grows or ages"):
        solved(aged, sensitivities=True)
    punch = vt.Groups(
        tabor=None,
        cohesion=0.05,
        geometry=vt.FlatPunch(20.0),
        body=vt.Layer(3.0),
        material=ARMS,
        start=vt.AtDepth(1.0),
        rate=1.0,
    )
    with pytest.raises(ValueError, match="flat punch"):
        solved(punch, sensitivities=True)


def test_the_work_moves_with_its_ends_and_with_the_curve_between_them():
    """Two parabolas with a jump between them; ends and heights move with one input."""
    x = np.concatenate([np.linspace(0, 1, 6), np.linspace(1, 3, 9)])
    first = np.arange(len(x)) < 6
    one, two = Polynomial([-1, 0, -1]), Polynomial([3, -8, 2])
    more_of_one, more_of_two = one, Polynomial([-2, 1])
    force, slope, raised = (
        np.where(first, a(x), b(x))
        for a, b in ((one, two), (one.deriv(), two.deriv()), (more_of_one, more_of_two))
    )
    result = jkr_result(steps=len(x) - 1, depth=-x, force=force, time=np.arange(len(x)) / 7)
    # how the steps move; the last number is what no output depends on
    moved = np.where(first, 0.2 + 0.1 * x, 0.7 - 0.1 * x)
    rows = np.full((len(x) - 2, 4, 2), np.nan)
    rows[:, 1, 0], rows[:, 2, 0] = -moved[:-2], (raised + slope * moved)[:-2]
    # each step may be moved along the curve as well
    along = np.cos(x)[:-2]
    level = rows[:, :, :-1].copy()
    level[:, 1, 0] -= along
    level[:, 2, 0] += slope[:-2] * along
    found = sensitivities._moved_work(result, Slopes((), rows, "", {}), level, vt.pull_off(result))
    curve = more_of_one.integ()(1.0) + more_of_two.integ()(2.0) - more_of_two.integ()(1.0)
    ends = one(1.0) * 0.3 - one(0.0) * 0.2 - two(1.0) * 0.6
    assert found == pytest.approx([-curve - ends], rel=1e-12)


class _Recorded(Tangents):
    """The derivatives of a march, with a list of its steps and nodes."""

    def _follow(self, at):
        self.log = getattr(self, "log", [])
        state, chain = at.state, []
        while state.origin is not None and state.origin.before is not None:
            chain.append((state.origin, state.surface.position))
            state = state.origin.before
        self.log += [*reversed(chain), None]
        super()._follow(at)


def _again(direction, by, recorded, first, stretch, side):
    """Return force and edge of the recorded steps, with an input changed by a little."""
    contact, leg = direction.contacts[side], direction.legs[side][0]
    modes, factor = recorded.body.modes, np.exp(by * direction.times)
    modes = Modes(
        modes.instantaneous + by * direction.instantaneous,
        np.array(modes.weights) + by * direction.weights,
        np.array(modes.times) * factor,
        modes.error,
    )
    body, wider, depth = Body(contact, modes, modes.weights), np.exp(by * first[2]), None
    surface = contact.surface(first[0].position * wider)
    depth = direction.starts[side].depth
    hold = Hold(np.inf, depth)
    gap = descend(surface, contact.law, surface.rigid_gap, 1.0, first[1], hold).gap
    state, rows = body.first(Relaxed(surface, gap, depth, 0.0, np.nan, 0.0)), []
    for origin in recorded.log:
        if origin is None:
            rows.append((state.seen.force, state.seen.edge))
        elif isinstance(origin[0], ByNodes):
            hold = Hold(np.inf, state.seen.depth)
            state = body.remeshed(state, origin[1] * wider, hold)
        else:
            s = step(modes, origin[0].step.length * np.exp(by * stretch))
            hold = Hold(np.inf, depth + leg.rate * (state.seen.time + s.length))
            state = body.after(state, s, hold, 200, 0.0).after
    return np.array(rows)


@pytest.mark.parametrize("name", ["tabor", "material.branches.1.1", "rate", "start.depth"])
def test_derivatives_are_those_of_the_discrete_march(name, monkeypatch):
    # differences of marches that share time steps, and nodes up to their unit of length
    problem = vt.Groups(tabor=0.3, material=ARMS, start=vt.AtDepth(4.0), rate=3.0)
    made = []

    def tangents(*args):
        made.append(_Recorded(*args))
        return made[-1]

    monkeypatch.setattr("viscotack.bem.solver.Tangents", tangents)
    result = solved(problem, accuracy=0.02, sensitivities=[name])
    (found,) = made
    direction, rows = found.directions[0], np.array(found.rows)
    origins = [x[0] for x in found.log if x is not None]
    assert any(isinstance(x, ByNodes) for x in origins)
    assert all(isinstance(x, ByNodes | ByStep) for x in origins)
    assert len(rows) == len(result.time)
    by = direction.step / 2
    first = found.start.surface, found.start.gap, found.moved_nodes[0]
    low, high = (
        _again(direction, way * by, found, first, found.stretch[0], side)
        for side, way in ((0, -1), (1, 1))
    )
    differences = (high - low) / (2 * by)
    scale = np.nanmax(np.abs(rows[:, 2:, 0]), axis=0)
    force, edge = (np.abs(rows[:, 2:, 0] - differences) / scale).T
    assert force.max() < 1e-6
    # in one step the edge passes a node, where its cubic changes
    assert np.sort(edge[np.isfinite(edge)])[-2] < 1e-6
