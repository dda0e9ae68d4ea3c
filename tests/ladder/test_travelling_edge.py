"""The march in the frame of the crack: what a passing profile leaves, and the same contacts.

The peer is the march in the frame of the solid, whose steps are a part of a zone long.
"""

import dataclasses

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from dimensionless import standard
from viscotack.model.materials import Elastic, Modes
from viscotack.model.problem import Groups
from viscotack.model.protocol import Apart, Approach, AtDepth
from viscotack.result.observables import pull_off_force, work_to_pull_off
from viscotack.simulate import Settings, march, solve
from viscotack.simulate.body import Memory, step
from viscotack.simulate.frame import Passage, Way

MODES = Modes(instantaneous=0.1, weights=(0.3, 0.6), times=(0.05, 2.0), error=0.0)
NODES = np.concatenate([np.linspace(0.0, 0.8, 40)[:-1], np.linspace(0.8, 1.2, 401), [1.5, 2.5]])
SPACING = 0.001
# Relative error of the force that the marches are asked for, and of their steps a part of that.
ACCURACY, STEPS = 2e-3, 1e-3


def contact(tabor=10.0, rate=3.0, **changes):
    pulled = Groups(tabor=tabor, material=standard(), start=AtDepth(5 * tabor), rate=rate)
    return dataclasses.replace(pulled, **changes)


def marched(groups, settings=None):
    return solve(
        groups, accuracy=ACCURACY, settings=settings, until="pull-off", estimate_error=False
    )


def at_places(monkeypatch, groups):
    with monkeypatch.context() as patched:
        patched.setattr(march, "ahead", lambda run, at: None)
        return marched(groups)


def bump(x):
    return np.exp(-((x / 0.03) ** 2))


def passage(travel, dt, e0):
    way = Way.of(1.0, travel, dt, travel / dt, dt)
    return Passage.of(MODES, dt, way, CubicSpline(NODES, e0), NODES, SPACING)


# --- identities -----------------------------------------------------------------------------
def test_without_travel_a_passage_is_the_step_of_the_solid():
    rng = np.random.default_rng(5)
    e0, e1, dt = np.sin(NODES), np.cos(3 * NODES), 0.7
    d = rng.normal(size=(2, len(NODES)))
    passed, s = passage(0.0, dt, e0), step(MODES, dt)
    memory = Memory(d, d)
    assert passed.inherited(MODES, d) == pytest.approx(memory.inherited(s, e0), rel=1e-12)
    assert passed.compliance(MODES) == pytest.approx(s.compliance * np.eye(len(NODES)), abs=1e-14)
    expected = memory.advanced(s, e0, e1, e0, e1).displacement
    assert passed.advanced(d, e1) == pytest.approx(expected, rel=1e-12)


def test_what_a_passage_inherits_and_adds_is_what_its_modes_come_to():
    d = np.outer([1.0, 2.0], np.cos(NODES))
    e0, e1 = bump(NODES - 1.0), bump(NODES - 0.95)
    passed = passage(-0.05, 0.1, e0)
    both = passed.inherited(MODES, d) + passed.compliance(MODES) @ e1
    modes = np.asarray(MODES.weights) @ passed.advanced(d, e1) + MODES.instantaneous * e1
    assert both == pytest.approx(modes, rel=1e-12)


# --- limits ---------------------------------------------------------------------------------
@pytest.mark.parametrize("travel", [-0.05, 0.05])
def test_a_profile_that_travels_leaves_what_it_leaves_at_each_place(travel):
    # a whole profile passes, many of its widths a step, as if it had been there in parts
    dt, d = 0.1, np.zeros((2, len(NODES)))
    passed = passage(travel, dt, bump(NODES - 1.0))
    found = passed.advanced(d, bump(NODES - 1.0 - travel))
    theta = np.linspace(0, 1, 20001)
    for node in (230, 239, 250):
        e = bump(NODES[node] - 1.0 - travel * theta)
        for mode, tau in enumerate(MODES.times):
            decay = np.exp(-(1 - theta) * dt / tau) / tau
            assert found[mode, node] == pytest.approx(dt * np.trapezoid(e * decay, theta), rel=5e-3)


# --- order ----------------------------------------------------------------------------------
@pytest.mark.slow
def test_the_error_of_long_steps_falls_at_second_order():
    base = Settings.for_accuracy(ACCURACY)

    def force(s):
        settings = dataclasses.replace(
            base,
            step_error=base.step_error * s * s,
            force_change=base.force_change * s,
            travel=base.travel * s,
            imbalance=base.imbalance * s * s,
        )
        return pull_off_force(marched(contact(tabor=30.0), settings))

    coarse, middle, fine = force(2.0), force(1.0), force(0.35)
    assert abs(middle - fine) < STEPS * fine
    assert abs(coarse - fine) < 4.5 * STEPS * fine


# --- the same contacts ----------------------------------------------------------------------
CONTACTS = {
    "rigid machine": contact(),
    "soft spring": contact(tabor=15.0, stiffness=0.2),
    "approach": contact(
        tabor=15.0, rate=10.0, start=Apart(40.0), moves=(Approach(speed=10.0, to=AtDepth(30.0)),)
    ),
}


@pytest.mark.march
@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.slow] * (name == "soft spring")) for name in CONTACTS],
)
def test_both_marches_find_the_same_forces_and_work(name, monkeypatch):
    followed, placed = marched(CONTACTS[name]), at_places(monkeypatch, CONTACTS[name])
    assert followed.statistics["steps"] < 0.9 * placed.statistics["steps"]
    assert pull_off_force(followed) == pytest.approx(pull_off_force(placed), rel=ACCURACY)
    assert work_to_pull_off(followed) == pytest.approx(work_to_pull_off(placed), rel=5 * ACCURACY)
    assert followed.force.max() == pytest.approx(placed.force.max(), rel=ACCURACY)
    assert (followed.energy_residual or 1.0) < 1e-3


def test_an_elastic_contact_of_short_range_is_that_of_jkr():
    elastic = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    result = marched(contact(tabor=30.0, material=elastic))
    assert pull_off_force(result) == pytest.approx(1.0, abs=ACCURACY)
    assert result.statistics["steps"] < 120
