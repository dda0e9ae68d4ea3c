"""Two deformable bodies as one: creep functions and curvatures add."""

import numpy as np
import pytest

import viscotack as vt
from solids import creep_power_law
from viscotack.model.geometry import effective_sphere
from viscotack.model.materials import effective_solid

TIMES = np.geomspace(1e-4, 1e4, 50)
SOFT = vt.Prony(rubbery_modulus=1e6, branches=[(5e6, 1e-3), (4e6, 1.0)], poisson_ratio=0.5)
STIFF = vt.StandardSolid(rubbery_modulus=3e6, glassy_modulus=2e7, tau0=0.3, poisson_ratio=0.3)
STEEL = vt.Elastic(rubbery_modulus=2e11, poisson_ratio=0.3)


def contact_creep(solid, times):
    return (1 - solid.poisson_ratio**2) * np.asarray(solid.creep(times))


@pytest.mark.parametrize("first", [SOFT, STIFF, STEEL], ids=["prony", "sls", "elastic"])
@pytest.mark.parametrize("second", [SOFT, STIFF, STEEL], ids=["prony", "sls", "elastic"])
def test_creep_functions_add(first, second):
    pair = effective_solid(first, second)
    expected = contact_creep(first, TIMES) + contact_creep(second, TIMES)
    assert contact_creep(pair, TIMES) == pytest.approx(expected, rel=1e-12)
    assert 1 / pair.contact_modulus == pytest.approx(
        1 / first.contact_modulus + 1 / second.contact_modulus, rel=1e-13
    )


def test_two_equal_solids_are_one_of_half_the_modulus():
    half = vt.StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=1e7, tau0=0.3, poisson_ratio=0.3)
    pair = effective_solid(STIFF, STIFF)
    assert pair.relaxation(TIMES) == pytest.approx(half.relaxation(TIMES), rel=1e-12)
    law = vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-6)
    test = vt.Retraction(vt.AtDepth(2e-6), 1e-5)
    forces = [
        vt.solve(
            vt.Problem(solid, law, vt.Sphere(1e-3), test),
            until="pull-off",
            accuracy=1e-2,
            estimate_error=False,
        ).pull_off_force
        for solid in (half, pair)
    ]
    assert forces[1] == pytest.approx(forces[0], rel=1e-10)


def test_curvatures_add():
    found = effective_sphere(vt.Sphere(2e-3), vt.Sphere(3e-3))
    assert found.radius == pytest.approx(1.2e-3)
    r = np.array([1e-5, 1e-4])
    gaps = vt.Sphere(2e-3).gap(r) + vt.Sphere(3e-3).gap(r)
    assert found.gap(r) == pytest.approx(gaps, rel=1e-12)


def test_gap_of_a_sphere_is_that_of_its_osculating_paraboloid():
    R, r = 5.19e-3, np.array([0.0, 1e-6, 10e-6, 100e-6])
    exact = R - np.sqrt(R**2 - r**2)
    # the next term of the sphere's series is r^4/(8 R^3), the one after it 2e-4 of that
    np.testing.assert_allclose(
        exact - vt.Sphere(R).gap(r), r**4 / (8 * R**3), rtol=2e-4, atol=1e-18
    )


def test_other_solids_are_refused_in_words():
    power = creep_power_law(1e6, 1e7, 0.5, 1.0, 0.5)
    with pytest.raises(vt.InputError, match="prony_form approximates it"):
        effective_solid(SOFT, power)
