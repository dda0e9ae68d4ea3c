"""Two deformable bodies as one: creep functions and curvatures add."""

import numpy as np
import pytest

import viscotack as vt
from viscotack.model.geometry import effective_sphere
from viscotack.model.materials import effective_solid
from viscotack.model.materials.two_bodies import _merged

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


def test_a_pair_does_not_depend_on_the_order():
    pair, turned = effective_solid(SOFT, STIFF), effective_solid(STIFF, SOFT)
    assert pair.relaxation(TIMES) == pytest.approx(turned.relaxation(TIMES), rel=1e-13)


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


def test_a_rigid_body_beside_a_soft_one_changes_nothing():
    rigid = vt.Elastic(rubbery_modulus=1e30, poisson_ratio=0.5)
    pair = effective_solid(SOFT, rigid)
    assert pair.relaxation(TIMES) == pytest.approx(SOFT.relaxation(TIMES), rel=1e-12)


def test_curvatures_add():
    found = effective_sphere(vt.Sphere(2e-3), vt.Sphere(3e-3))
    assert found.radius == pytest.approx(1.2e-3)
    r = np.array([1e-5, 1e-4])
    gaps = vt.Sphere(2e-3).gap(r) + vt.Sphere(3e-3).gap(r)
    assert found.gap(r) == pytest.approx(gaps, rel=1e-12)


def test_other_solids_are_refused_in_words():
    power = vt.RetardationPowerLaw(
        rubbery_modulus=1e6, glassy_modulus=1e7, exponent=0.5, tau0=1.0, poisson_ratio=0.5
    )
    with pytest.raises(vt.InputError, match="prony_form approximates it"):
        effective_solid(SOFT, power)


def test_elements_of_one_time_are_one_element_whose_compliance_is_the_sum():
    near, far = 1.0 + 5e-13, 1.0 + 2e-12
    assert _merged([(2.0, 1.0), (3.0, near), (4.0, 0.5)]) == ((4.0, 0.5), (5.0, 1.0))
    assert _merged([(2.0, far), (3.0, 1.0)]) == ((3.0, 1.0), (2.0, far))
