"""Tests of the yield of arrays with scattered heights and works."""

from math import erf, sqrt

import numpy as np
import pytest

import viscotack as vt
from viscotack.design.arrays import grid

E, R, WORK, LOAD = 2e6, 5e-3, 0.15, 2e-3
PAD = vt.Problem(
    material=vt.Elastic(rubbery_modulus=0.75 * E, poisson_ratio=0.5),
    traction=vt.LennardJones(WORK, 1e-9),
    geometry=vt.Sphere(R),
    protocol=vt.Retraction(vt.AtForce(LOAD), 1e-5),
)
UNIT = 1.5 * np.pi * R * WORK


def array(rows=2, columns=2, **backing):
    return vt.PadArray(PAD, grid(rows, columns, 5e-3), backing=vt.Backing(**backing))


def direct_pull_off(heights, works):
    """Sum JKR curves of pads on a rigid plate, all of which touch."""
    force, levels = 0.0, np.linspace(2e-5, -2e-5, 8000)
    forces = np.zeros(levels.size)
    for height, factor in zip(heights, works, strict=True):
        w = WORK * factor
        least = (np.pi * w * R**2 / (8 * E)) ** (1 / 3)
        a = np.linspace(least, 8 * least, 4000)
        depth = a**2 / R - np.sqrt(2 * np.pi * w * a / E)
        force = 4 * E * a**3 / (3 * R) - np.sqrt(8 * np.pi * w * E * a**3)
        d = levels + height
        forces += np.where(d >= depth[0], np.interp(d, depth, force), 0.0)
    return -forces.min()


def test_the_yield_is_the_count_of_arrays_that_are_pulled_directly():
    scatter, load = vt.Scatter(height=2e-6, work=0.1, seed=3), 3.9 * UNIT
    found = vt.array_yield(array(), scatter, load=load, speed=1e-5, preload=4 * LOAD, draws=60)
    direct = np.array([direct_pull_off(*scatter.drawn(4, i)) for i in range(60)])
    assert found.forces == pytest.approx(np.sort(direct), rel=2e-3)
    near = np.abs(direct / load - 1) < 2e-3
    assert abs(found.share * 60 - np.count_nonzero(direct >= load)) <= np.count_nonzero(near)
    assert 0.05 < found.share < 0.95
    assert found.interval[0] < found.share < found.interval[1]


def test_the_yield_of_one_pad_is_the_normal_distribution_of_its_work():
    scatter = vt.Scatter(work=0.1, seed=5)
    found = vt.array_yield(
        array(1, 1), scatter, load=0.95 * UNIT, speed=1e-5, preload=LOAD, draws=400
    )
    expected = 0.5 * (1 + erf(0.5 / sqrt(2)))
    assert found.interval[0] < expected < found.interval[1]
    assert found.reached_by(0.5) == pytest.approx(UNIT, rel=0.01)
