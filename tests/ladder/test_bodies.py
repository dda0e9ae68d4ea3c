"""Bodies: JKR on any of them by its influence matrix, and simulations of springs side by side."""

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import viscotack as vt
from dimensionless import ELASTIC
from viscotack.model.problem.nouns import own_nouns
from viscotack.simulate.settings import Settings
from viscotack.theory.elastic import indenter, on_body

pytestmark = pytest.mark.march

OWN = Path(__file__).resolve().parents[2] / "examples" / "own"
(FOUNDATION,) = own_nouns([OWN / "foundation.py"])
LAW = vt.LennardJones(1.0, 1.0)
RADII = np.geomspace(1e-3, 300, 7)
SOLID = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}


@pytest.mark.parametrize("shape", [vt.Sphere(1.0), vt.Cone(1.0)], ids=["sphere", "cone"])
def test_the_matrix_of_the_half_space_gives_its_closed_forms(shape):
    theory = {"shape": shape, **SOLID}
    depth = np.asarray(indenter.bare_depth(RADII, shape=shape))
    force = np.asarray(indenter.force(RADII, **theory))
    assert on_body.bare_depth(RADII, shape, vt.HalfSpace()) == pytest.approx(depth, rel=1e-4)
    scale = np.abs(force) + np.asarray(indenter.force(RADII, **theory | {"work_of_adhesion": 0.0}))
    found = on_body.force(RADII, shape, vt.HalfSpace(), 1.0)
    assert np.max(np.abs(found - force) / scale) < 2e-4
    drawn = np.sqrt(2 * np.pi * RADII)
    assert on_body.drawn(RADII, shape, vt.HalfSpace(), 1.0) == pytest.approx(drawn, rel=1e-5)


def test_jkr_on_a_foundation_is_each_spring_for_itself():
    # a spring detaches when it holds the work of adhesion: b w = (E*/2) drawn^2
    b, theory = 0.3, {"shape": vt.Sphere(1.0), "body": FOUNDATION(0.3), **SOLID}
    drawn = np.sqrt(2 * b)
    depth = RADII**2 / 2 - drawn
    assert np.asarray(indenter.depth(RADII, **theory)) == pytest.approx(depth, rel=1e-9)
    force = np.pi / b * (depth * RADII**2 - RADII**4 / 4)
    assert np.asarray(indenter.force(RADII, **theory)) == pytest.approx(force, rel=1e-3)
    # at the least 2 pi R dg, whatever the thickness
    a = np.sqrt(2 * drawn)
    assert indenter.force(a, **theory) == pytest.approx(-2 * np.pi, rel=1e-4)


def pulled(tabor, thickness):
    """Find the work of opening one spring behind the law, from rest until it is free.

    A sphere on springs pulls off with 2 pi R times that, as Derjaguin's approximation is exact.
    """
    give = tabor**2 * thickness  # displacement [h0] under 1 dg/h0

    def opening(gap):
        return 1 + give * LAW.stiffness(gap)

    gap = np.linspace(1.0, 12.0, 20001)
    falls = np.flatnonzero(opening(gap) < 0)
    if not falls.size:
        return 1.0
    last = brentq(opening, gap[falls[0] - 1], gap[falls[0]])
    place = last + give * LAW.traction(last)
    # the gap at which the spring, having detached, comes to rest
    free = brentq(lambda g: g + give * LAW.traction(g) - place, gap[falls[-1]] + 1e-3, 1e3)
    energy = [LAW.energy(g) + give * LAW.traction(g) ** 2 / 2 for g in (last, free)]
    return 1.0 + float(energy[0] - energy[1])


def on_springs(tabor, thickness, accuracy, estimate_error=False):
    depth = 4 * tabor**2 * thickness
    groups = vt.Groups(tabor, ELASTIC, vt.AtDepth(depth), 1.0, body=FOUNDATION(thickness))
    return vt.solve(groups, accuracy=accuracy, until="pull-off", estimate_error=estimate_error)


@pytest.mark.parametrize(("tabor", "thickness"), [(0.5, 0.3), (0.5, 3.0)])
def test_a_sphere_on_stiff_springs_pulls_off_with_the_work_of_adhesion(tabor, thickness):
    assert pulled(tabor, thickness) == 1.0
    force = vt.pull_off_force(on_springs(tabor, thickness, 1e-2))
    assert force == pytest.approx(4 / 3, rel=0.01)


@pytest.mark.slow
def test_a_sphere_on_springs_that_snap_pulls_off_with_the_work_of_one_of_them():
    # they snap one by one, so that the force has an error of first order in their distance
    known = on_springs(1.0, 2.0, 1e-2, estimate_error=True)
    force, finer = vt.pull_off_force(on_springs(1.0, 2.0, 2e-2)), vt.pull_off_force(known)
    nodes, more = (Settings.for_accuracy(x).nodes_per_zone for x in (2e-2, 1e-2))
    limit, exact = finer - (force - finer) / (more / nodes - 1), 4 / 3 * pulled(1.0, 2.0)
    assert pulled(1.0, 2.0) > 1.3
    assert limit == pytest.approx(exact, rel=5e-3)
    assert finer - exact < known.error_estimate["force"] * exact < 5 * (finer - exact)


@pytest.mark.parametrize(("rate", "least", "most"), [(1e-4, 0.99, 1.01), (1.0, 1.2, 5.0)])
def test_a_viscoelastic_foundation_that_is_pulled_slowly_is_the_relaxed_one(rate, least, most):
    solid = vt.StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
    groups = vt.Groups(0.5, solid, vt.AtDepth(3.0), rate, body=FOUNDATION(3.0))
    result = vt.solve(groups, accuracy=1e-2, estimate_error=False)
    assert least < vt.pull_off_force(result) * 0.75 < most
    assert abs(result.energy_residual) < 2e-3


def test_a_punch_on_a_foundation_is_one_spring():
    # every point alike: the strength, at a rigid machine's last hold
    groups = vt.Groups(
        None,
        ELASTIC,
        vt.AtDepth(0.5),
        1.0,
        geometry=vt.FlatPunch(4.0),
        body=FOUNDATION(0.2),
        cohesion=0.05,
    )
    result = vt.solve(groups, accuracy=1e-2)
    assert vt.pull_off_stress(result) == pytest.approx(1.0, rel=1e-3)
    give = np.pi / (2 * LAW.strength) * 0.2
    assert vt.depth_at_pull_off(result) == pytest.approx(1 - LAW.edge_gap - give, rel=1e-2)
