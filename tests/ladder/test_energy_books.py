"""Energy books on the ladder: each term derived a second way, from series, law and spring."""

from dataclasses import replace

import numpy as np
import pytest

from dimensionless import ELASTIC, SOLID, power_law, punch
from viscotack.model.geometry import Cone
from viscotack.model.problem import Groups
from viscotack.model.protocol import Approach, AtDepth, AtForce, Dwell, LoadTo, Retract
from viscotack.model.traction import Exponential
from viscotack.simulate import solve

pytestmark = pytest.mark.march

LOOP = (Approach(1.0, AtForce(4.0)), Retract(1.0, AtForce(2.0)))


def sphere(*moves, tabor=0.5, material=ELASTIC, **more):
    start = more.pop("start", AtForce(2.0))
    return Groups(tabor, material, start, moves=moves, **{"rate": None} | more)


def run(groups, **options):
    return solve(groups, accuracy=0.01, **({"estimate_error": False} | options))


PRESSED = {
    "sphere": sphere(*LOOP, stiffness=0.1),
    "cone": sphere(*LOOP, stiffness=0.1, geometry=Cone(1.0), tabor=1.0),
    "punch": punch(
        AtForce(0.5),
        Approach(1.0, AtForce(1.0)),
        Retract(1.0, AtForce(0.5)),
        material=ELASTIC,
        stiffness=0.1,
    ),
    "held load": sphere(LoadTo(3.0, 1.0), *LOOP, stiffness=0.1, material=SOLID),
    "held depth": sphere(
        Dwell(1.0, hold="depth"), Retract(5.0, AtDepth(-3.0)), stiffness=0.5, material=SOLID
    ),
}


@pytest.mark.parametrize("groups", PRESSED.values(), ids=PRESSED)
def test_books_begin_with_the_energy_of_the_spring_and_gain_what_the_drive_does(groups):
    result = run(groups)
    energy, K, force = result.energy, groups.stiffness, result.force
    assert energy.drive[0] == 0
    assert energy.spring[0] == pytest.approx(result.force[0] ** 2 / (2 * K), rel=1e-12, abs=0)
    # nothing is added when the machine takes hold: the drive has moved by a small step only
    travel = np.diff(result.depth[:2] + result.force[:2] / K)[0]
    round_off = 1e-14 * energy.spring[0]  # of a drive that follows a held depth
    assert abs(energy.drive[1]) <= 1.01 * max(result.force[:2]) * abs(travel) + round_off
    drive = result.depth + force / K
    work = np.cumsum([0, *((force[1:] + force[:-1]) / 2 * np.diff(drive))])
    assert np.max(np.abs(energy.drive - work)) < 1e-3 * np.max(np.abs(energy.drive))
    assert energy.spring == pytest.approx(force**2 / (2 * K), rel=1e-9)


def test_a_soft_spring_does_not_hide_missing_energy():
    # the spring holds 2e6, and the contact takes some 10
    result = run(sphere(*LOOP, stiffness=1e-6, material=SOLID, tabor=2.0))
    energy = result.energy
    assert energy.spring[0] > 1e6
    contact = energy.drive - (energy.spring - energy.spring[0])
    spent = energy.elastic + energy.interface + energy.heat + energy.jumps + energy.transfer
    missing = contact - (spent - spent[0])
    largest = np.max(np.abs(energy.elastic - energy.elastic[0]))
    assert np.max(np.abs(missing)) < 1e-3 * largest
    assert result.energy_residual > 0.1 * np.max(np.abs(missing)) / largest


DEEPER = sphere(
    Approach(3.0, AtForce(5.0)),
    start=AtForce(1.0),
    tabor=5.0,
    material=replace(power_law(), glassy_modulus=80.0),
    traction=Exponential(1.0, 1.0, decay=0.157),
)


def test_a_mesh_that_grows_with_the_depth_stores_nothing_beyond_the_old_one():
    energy = run(DEEPER).energy
    assert np.max(np.abs(energy.transfer)) < 2e-4 * np.ptp(energy.elastic)


def test_a_step_that_would_create_energy_is_cut():
    # the load changes by a sixth of the pull-off force in the first step of its ramp
    loaded = sphere(
        LoadTo(-824.3, 3.864e-3),
        start=AtForce(0.0),
        tabor=1.378,
        material=replace(power_law(), glassy_modulus=798.8, exponent=1.489),
    )
    energy = solve(loaded, estimate_error=False).energy
    assert np.min(np.diff(energy.jumps)) > -1e-3 * abs(energy.interface[0])
