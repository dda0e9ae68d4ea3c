"""Tests of arrays of pads: limits, tilt, order of detachment, energy and yield."""

from dataclasses import replace
from math import erf, sqrt

import numpy as np
import pytest

import viscotack as vt
from viscotack.design.arrays import grid, preload_after
from viscotack.simulate.curve_family import Curve

RUBBER = vt.StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5)
ELASTIC = vt.Elastic(rubbery_modulus=1.5e6, poisson_ratio=0.5)
SPEED, LOAD, WORK = 1e-5, 2e-3, 0.15


JKR = 1.5 * np.pi * 5e-3 * WORK
LENS, PLACES = vt.Sphere(5e-3), grid(3, 4, 5e-3)


def pad(material=ELASTIC, *, gap=1e-9, shape=LENS):
    return vt.Problem(
        material, vt.LennardJones(WORK, gap), shape, vt.Retraction(vt.AtForce(LOAD), SPEED)
    )


def pulled(problem=None, places=PLACES, *, mean_load=LOAD, speed=SPEED, **options):
    backing = vt.Backing(
        **{k: options.pop(k) for k in list(options) if k in vt.Backing.__dataclass_fields__}
    )
    array = vt.PadArray(problem or pad(), places, backing=backing, **options)
    return vt.pull_array(array, speed=speed, preload=len(places) * mean_load, accuracy=0.02)


def alone(problem, stiffness=None):
    protocol = replace(problem.protocol, stiffness=stiffness)
    return vt.crack_contact(replace(problem, protocol=protocol)).pull_off_force * (
        problem.scales().force
    )


def test_one_pad_outside_the_theory_pulls_off_as_its_simulation():
    problem = pad(RUBBER, gap=3e-6)
    expected = vt.solve(problem, accuracy=0.02, estimate_error=False)
    found = pulled(problem, [(0.0, 0.0)])
    assert found.method == "simulation"
    assert found.pull_off_force == pytest.approx(
        vt.pull_off_force(expected) * problem.scales().force, rel=1e-6
    )


@pytest.mark.parametrize("problem", [pad(), pad(RUBBER, gap=6e-7)], ids=["elastic", "rubber"])
def test_equal_pads_on_a_rigid_backing_carry_as_many_times_one_pad(problem):
    for places in (PLACES[:1], PLACES):
        found = pulled(problem, places)
        assert found.pull_off_force == pytest.approx(len(places) * alone(problem), rel=1e-6)
        assert [pads for _, pads in found.jumps] == [len(places)]
        assert found.load_sharing == pytest.approx(1, rel=1e-12)
        assert found.method == "steady cracks"


def test_equal_pads_behind_a_spring_pull_as_one_behind_its_share():
    problem, stiffness = pad(RUBBER, gap=6e-7), 400.0
    found = pulled(problem, PLACES[:4], stiffness=stiffness)
    assert found.pull_off_force == pytest.approx(4 * alone(problem, stiffness / 4), rel=1e-6)
    assert abs(alone(problem, stiffness) / alone(problem, stiffness / 4) - 1) > 0.01


def test_on_a_soft_backing_the_weakest_pad_lets_go_first():
    works, heights = [1.1, 0.9, 1.0, 1.05], [0.0, 2e-6, -1e-6, 1e-6]
    places = grid(1, 4, 5e-3)
    soft = pulled(places=places, works=works, heights=heights, pad_stiffness=5.0)
    assert soft.order == (1, 2, 3, 0)
    rigid = pulled(places=places, works=works, heights=heights)
    # on a rigid backing the reach of a pad decides, its height and its own elongation
    assert rigid.order == (2, 0, 3, 1)


def test_a_dead_load_of_equal_works_falls_when_the_weakest_pad_lets_go():
    works = [1.0, 0.8, 1.2]
    found = pulled(places=grid(1, 3, 5e-3), works=works, pad_stiffness=5.0, stiffness=1e-2)
    # all carry the same force until the weakest cannot
    assert found.pull_off_force == pytest.approx(3 * 0.8 * alone(pad()), rel=6e-3)
    assert max(pads for _, pads in found.jumps) == 3


def jkr_of_depth(count=20_000, w=WORK):
    """Stable branch of JKR's curve, force by depth, written out."""
    E, R = ELASTIC.contact_modulus, 5e-3
    least = (np.pi * w * R**2 / (8 * E)) ** (1 / 3)
    a = np.linspace(least, 8 * least, count)
    depth = a**2 / R - np.sqrt(2 * np.pi * w * a / E)
    return depth, 4 * E * a**3 / (3 * R) - np.sqrt(8 * np.pi * w * E * a**3)


def test_tilted_and_curved_plates_pull_off_as_an_independent_sum_of_jkr_curves():
    tilt, curvature = 3e-4, 0.02
    found = pulled(tilt=tilt, curvature=curvature, tilt_direction=0.3)
    x, y = np.array(PLACES).T - np.array([[7.5e-3], [5e-3]])
    rise = -np.tan(tilt) * (x * np.cos(0.3) + y * np.sin(0.3)) - curvature * (x**2 + y**2) / 2
    depth, force = jkr_of_depth()

    def total(z, touched):
        d = z + rise
        return np.where(touched & (d >= depth[0]), np.interp(d, depth, force), 0.0).sum()

    levels = np.linspace(3e-5, -3e-5, 20_000)
    first = next(z for z in levels if total(z, z + rise >= 0) < 12 * LOAD)
    touched = first + rise >= 0
    expected = -min(total(z, touched) for z in levels[levels < first])
    assert found.pull_off_force == pytest.approx(expected, rel=1e-3)
    assert found.load_sharing < 0.999


def work_of_drive(found):
    """Work of the drive over the whole pull."""
    F, z = found.force, found.drive
    return np.sum((F[1:] + F[:-1]) / 2 * np.diff(z))


def test_a_jump_behind_a_spring_loses_what_the_drive_put_in_and_the_pads_did_not_take():
    K = 1e3
    soft, rigid = pulled(tilt=2e-4, stiffness=K), pulled(tilt=2e-4)
    first = soft.force[0] ** 2 / (2 * K)
    # what the drive put in and the spring had at first has gone into the pads and into jumps
    assert work_of_drive(soft) + first == pytest.approx(work_of_drive(rigid) + soft.lost, rel=1e-6)
    assert soft.lost > 0.1 * soft.work
    assert rigid.lost == 0
    largest = [max(pads for _, pads in found.jumps) for found in (soft, rigid)]
    assert largest == [12, 3]


def test_a_curve_behind_a_spring_jumps_where_the_force_falls_faster_than_the_spring():
    x = np.linspace(0.0, -2.0, 2001)
    bump = Curve(np.append(x, -2.0), np.append(-np.sin(np.pi * np.minimum(-x, 1.0)), 0.0))
    behind = bump.behind(1.0)
    # tangent of slope -1 against the fall
    at = 1 - np.arccos(1 / np.pi) / np.pi
    z = behind.position
    assert np.all(np.diff(z) <= 0)
    before = behind.force[np.flatnonzero(np.diff(z) == 0)[0]]
    assert -before == pytest.approx(np.sin(np.pi * at), rel=3e-4)
    assert behind.lost > 0
    assert bump.behind(10.0).lost == 0


def test_a_preload_held_in_place_relaxes_to_the_contact_at_rest_there():
    problem, load = pad(RUBBER, gap=6e-7), LOAD
    array = vt.PadArray(problem, grid(1, 2, 5e-3))
    left = preload_after(array, 20.0, preload=2 * load, speed=1e-4, accuracy=5e-3)
    # the depth at which the approach has reached the load
    moves = (vt.Approach(1e-4, to=vt.AtForce(load)),)
    start = vt.Retraction(vt.Apart(2e-5), None, moves=moves)
    pressed = vt.solve(replace(problem, protocol=start), accuracy=5e-3, estimate_error=False)
    depth = float(pressed.depth[-1]) * problem.scales().length
    rest = vt.solve(
        replace(problem, protocol=vt.Retraction(vt.AtDepth(depth), SPEED)),
        accuracy=5e-3,
        estimate_error=False,
        until="pull-off",
    )
    assert left == pytest.approx(2 * float(rest.force[0]) * problem.scales().force, abs=0.02 * load)
    assert left < load
    # a softer backing follows
    soft = vt.PadArray(problem, grid(1, 2, 5e-3), backing=vt.Backing(pad_stiffness=300.0))
    assert left < preload_after(soft, 20.0, preload=2 * load, speed=1e-4) < 2 * load
    assert preload_after(vt.PadArray(pad(), [(0.0, 0.0)]), 1.0, preload=load, speed=1e-4) == load


def direct_pull_off(heights, works):
    """Sum JKR curves of pads on a rigid plate, all of which touch."""
    levels = np.linspace(2e-5, -2e-5, 8000)
    forces = np.zeros(levels.size)
    for height, factor in zip(heights, works, strict=True):
        depth, force = jkr_of_depth(4000, WORK * factor)
        d = levels + height
        forces += np.where(d >= depth[0], np.interp(d, depth, force), 0.0)
    return -forces.min()


def test_the_yield_is_the_count_of_arrays_that_are_pulled_directly():
    scatter, load = vt.Scatter(height=2e-6, work=0.1, seed=3), 3.9 * JKR
    found = vt.array_yield(
        vt.PadArray(pad(), grid(2, 2, 5e-3)),
        scatter,
        load=load,
        speed=1e-5,
        preload=4 * LOAD,
        draws=30,
    )
    direct = np.array([direct_pull_off(*scatter.drawn(4, i)) for i in range(30)])
    assert found.forces == pytest.approx(np.sort(direct), rel=2e-3)
    near = np.abs(direct / load - 1) < 2e-3
    assert abs(found.share * 30 - np.count_nonzero(direct >= load)) <= np.count_nonzero(near)
    assert 0.05 < found.share < 0.95
    assert found.interval[0] < found.share < found.interval[1]


def test_the_yield_of_one_pad_is_the_normal_distribution_of_its_work():
    scatter = vt.Scatter(work=0.1, seed=5)
    found = vt.array_yield(
        vt.PadArray(pad(), [(0.0, 0.0)]),
        scatter,
        load=0.95 * JKR,
        speed=1e-5,
        preload=LOAD,
        draws=150,
    )
    expected = 0.5 * (1 + erf(0.5 / sqrt(2)))
    assert found.interval[0] < expected < found.interval[1]
    assert np.median(found.forces) == pytest.approx(JKR, rel=0.01)
