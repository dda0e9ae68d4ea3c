"""Tests of pads that interact through a common base, against direct solutions."""

import numpy as np
import pytest
import scipy

import viscotack as vt
from viscotack.design.arrays.interacting import interactions

HEXAGON = [(0.0, 0.0), *((np.cos(k * np.pi / 3), np.sin(k * np.pi / 3)) for k in range(6))]
PAIR = [(0.0, 0.0), (1.0, 0.0)]
E, R, WORK = 2e6, 1e-3, 0.05


def meshed_discs(centres, rings=8):
    """Return centres and areas of elements on discs of radius 1, and the disc of each."""
    points, areas, own = [], [], []
    edges = np.sin(np.linspace(0, np.pi / 2, rings + 1))
    for number, centre in enumerate(centres):
        for inner, outer in zip(edges[:-1], edges[1:], strict=True):
            many = max(4, round(np.pi * (inner + outer) / (outer - inner) / 2))
            angle = 2 * np.pi * (np.arange(many) + 0.5) / many
            middle = (inner + outer) / 2
            points.append(np.column_stack([np.cos(angle), np.sin(angle)]) * middle + centre)
            areas.append(np.full(many, np.pi * (outer**2 - inner**2) / many))
            own.append(np.full(many, number))
    return np.concatenate(points), np.concatenate(areas), np.concatenate(own)


def forces_of_discs(centres):
    """Solve rigid discs of radius 1 at depth 1 on a half-space with E* = 1 directly."""
    points, areas, own = meshed_discs(centres)
    distance = np.linalg.norm(points[:, None] - points[None], axis=-1)
    np.fill_diagonal(distance, 1.0)
    matrix = areas / (np.pi * distance)
    # centre of a circle of the same area under even pressure
    np.fill_diagonal(matrix, 2 * np.sqrt(areas / np.pi))
    pressure = np.linalg.solve(matrix, np.ones(areas.size))
    return np.bincount(own, weights=pressure * areas)


@pytest.mark.parametrize("places, spacing", [(PAIR, 3.0), (PAIR, 4.0), (HEXAGON, 4.0)])
def test_point_loads_give_the_forces_of_discs_on_a_half_space_to_one_percent(places, spacing):
    places = spacing * np.array(places)
    alone = forces_of_discs(places[:1])[0]
    direct = forces_of_discs(places) / alone
    # depth 1 = F/2 + sum c F, and a disc alone carries 2
    c = interactions(places, 1.0, radius=0.0)
    points = np.linalg.solve(np.eye(len(places)) / 2 + c, np.ones(len(places))) / 2
    assert points == pytest.approx(direct, rel=0.01)
    assert direct.max() < 0.95


def jkr(radius):
    force = 4 * E * radius**3 / (3 * R) - np.sqrt(8 * np.pi * WORK * E * radius**3)
    return force, radius**2 / R - np.sqrt(2 * np.pi * WORK * radius / E)


def pads(places, modulus=E / 4):
    problem = vt.Problem(
        material=vt.Elastic(rubbery_modulus=0.75 * E, poisson_ratio=0.5),
        traction=vt.LennardJones(WORK, 1e-9),
        geometry=vt.Sphere(R),
        protocol=vt.Retraction(vt.AtForce(1e-4), 1e-5),
    )
    return vt.PadArray(problem, places, backing=vt.Backing(base_modulus=modulus))


@pytest.mark.parametrize("places", [PAIR, HEXAGON], ids=["2", "7"])
def test_interacting_pads_pull_off_as_the_solved_equations_say(places):
    places = 0.6e-3 * np.array(places)
    array = pads([tuple(p) for p in places])
    found = vt.pull_array(array, speed=1e-5, preload=1e-4 * len(places))
    c = interactions(places, E / 4, radius=0.0)
    # by symmetry the middle pad and the six around it have two radii
    n = min(len(places) - 1, 6)
    around = c[1, 1:].sum()

    def missing(state, z):
        (F0, d0), (F1, d1) = jkr(abs(state[0])), jkr(abs(state[1]))
        return [d0 + n * c[0, 1] * F1 - z, d1 + c[1, 0] * F0 + around * F1 - z]

    solved, state = [], np.full(2, 1.3e-4)
    for z in np.linspace(2e-6, -6e-6, 1500):
        state, _, ok, _ = scipy.optimize.fsolve(missing, state, (z,), full_output=True)
        if ok != 1:
            break
        solved.append((z, jkr(abs(state[0]))[0] + n * jkr(abs(state[1]))[0]))
    z, force = np.array(solved).T
    assert found.pull_off_force == pytest.approx(-force.min(), rel=1e-3)
    # travel in which half of that tension builds up, which the other pads lengthen
    parts = [0.0, -0.5 * found.pull_off_force]
    expected = np.interp(parts, force[::-1], z[::-1])
    before = slice(np.argmin(found.force) + 1)
    travel = np.interp(parts, found.force[before][::-1], found.drive[before][::-1])
    assert np.diff(travel) == pytest.approx(np.diff(expected), rel=5e-3)


def test_pads_closer_than_four_radii_are_refused():
    with pytest.raises(vt.InputError, match="stand too close"):
        vt.pull_array(pads([(0.0, 0.0), (2e-4, 0.0)]), speed=1e-5, preload=2e-4)
