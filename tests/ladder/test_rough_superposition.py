"""Superposition of asperities: identities, limits, and the grid as a peer."""

import numpy as np
import pytest

import viscotack as vt
from viscotack.model.surfaces import HeightMap, bumps, drawn_asperities, sphere, summits
from viscotack.simulate.rough import RoughProblem, pull, superposed
from viscotack.theory import jkr

PLATEAUS = {"rubbery_modulus": 3e6, "poisson_ratio": 0.5}
ELASTIC = vt.Elastic(**PLATEAUS)
VISCOUS = vt.StandardSolid(**PLATEAUS, glassy_modulus=30e6, tau0=0.05)
LAW = vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-6)


def problem(surface, material=ELASTIC, law=LAW, **more):
    test = vt.Retraction(start=vt.AtForce(1e-5), speed=5e-5, **more)
    return RoughProblem(surface=surface, material=material, traction=law, protocol=test)


def four_bumps(pixels=64, radius=100e-6):
    side = 320e-6
    return bumps(pixels, side / pixels, radius=radius, spacing=side / 2, height=10e-6)


def test_summits_of_a_paraboloid_are_exact():
    x, y = np.arange(40) - 19.3, np.arange(40) - 17.8
    h = 0.3 - np.add.outer(x**2 / 100, y**2 / 160) - 2e-3 * np.outer(x, y)
    found = summits(HeightMap(h, 2.0))
    assert found.positions == pytest.approx(2 * np.array([[19.8, 18.3]]))
    assert found.heights == pytest.approx([0.3])
    assert found.radii == pytest.approx([4 / np.sqrt(1 / 4000 - 4e-6)])


def test_equal_asperities_add_up():
    one, four = (
        superposed(
            problem(four_bumps()),
            asperities=drawn_asperities(n, 1e-5, radius=1e-4, rms_height=1e-15, seed=1),
        )
        for n in (1, 4)
    )
    # all at one height: the start shares the force, and an elastic pull-off does not know it
    assert four.pull_off_force == pytest.approx(4 * one.pull_off_force, rel=1e-3)


def test_asperities_of_random_height_tend_to_fuller_and_tabor_for_short_range():
    # their sum of JKR's forces over Gaussian heights, at its least
    radius, sigma = 200e-6, 1.5e-6
    case = {"radius": radius, "contact_modulus": ELASTIC.contact_modulus, "work_of_adhesion": 0.05}
    asperities = drawn_asperities(300, 1e-2, radius=radius, rms_height=sigma, seed=3)
    end, rises = jkr.instability(**case).depth, asperities.heights - asperities.heights.max()

    def whole(z):
        depth = (z + rises)[z + rises > end]
        return float(np.sum(jkr.force(jkr.contact_radius_at_depth(depth, **case), **case)))

    expected = -min(whole(z) for z in np.linspace(0.0, 8 * sigma, 400))
    off = []
    for gap in (0.1e-6, 0.05e-6):
        law = vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=gap)
        given = RoughProblem(
            surface=four_bumps(),
            material=ELASTIC,
            traction=law,
            protocol=vt.Retraction(start=vt.AtForce(0.05), speed=1e-6),
        )
        found = superposed(given, asperities=asperities, force_outside=True)
        off.append(found.pull_off_force / expected - 1)
    assert 0 < off[1] < 0.1
    assert off[1] / off[0] == pytest.approx(0.5, abs=0.15)  # of first order in the range


@pytest.mark.parametrize(
    ("given", "count", "within"),
    [
        (problem(four_bumps(48), VISCOUS), 4, 0.06),
        (problem(sphere(48, 20e-6 / 3, radius=1e-3)), 1, 5e-3),
    ],
    ids=["bumps far apart", "a smooth sphere"],
)
def test_asperities_pull_off_as_on_the_grid(given, count, within):
    grid, found = pull(given, estimate_error=False), superposed(given, force_outside=count == 1)
    assert found.touching == count and (found.inside or count == 1)
    assert found.pull_off_force == pytest.approx(grid.pull_off_force, rel=within)


def test_neighbours_are_refused_unless_forced():
    law = vt.LennardJones(work_of_adhesion=0.3, equilibrium_gap=3e-6)
    given = problem(four_bumps(radius=1e-3), law=law)
    with pytest.raises(vt.InputError, match="asperities are neighbours; simulate"):
        superposed(given)
    assert not superposed(given, force_outside=True).inside


@pytest.mark.parametrize(("modulus", "is_flattened"), [(0.885e6, True), (4.4e6, False)])
def test_a_map_that_adhesion_flattens_is_refused_unless_forced(modulus, is_flattened):
    """The grid starts in full contact at the lower modulus, and holds 7.0 mN instead of 0.43."""
    law = vt.LennardJones(work_of_adhesion=0.1, equilibrium_gap=0.5e-6)
    solid = vt.Elastic(rubbery_modulus=modulus, poisson_ratio=0.5)
    given = problem(bumps(96, 4.1e-6, radius=38.4e-6, spacing=131.2e-6, height=5.73e-6), solid, law)
    found = superposed(given, force_outside=True)
    assert found.share < 0.15 and found.inside is not is_flattened
    assert found.full_contact == pytest.approx(0.24869 * modulus / 0.885e6, rel=1e-3)
    if is_flattened:
        with pytest.raises(vt.InputError, match="full contact"):
            superposed(given)


def test_other_problems_are_refused():
    surface = four_bumps()
    common = {"surface": surface, "material": ELASTIC, "traction": LAW}
    away = vt.Retraction(start=vt.Apart(5e-6), speed=1e-5, moves=())
    with pytest.raises(vt.InputError, match="relaxed contact"):
        superposed(RoughProblem(**common, protocol=away))
    straight = vt.Retraction(start=vt.AtForce(1e-5), speed=1e-5)
    layer = RoughProblem(**common, protocol=straight, body=vt.Layer(thickness=1e-4))
    with pytest.raises(vt.InputError, match="half-space"):
        superposed(layer)
