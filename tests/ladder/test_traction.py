"""The traction law: identities and limits, exact or to round-off."""

import numpy as np
import pytest
from scipy.integrate import quad

from reference_data import VALUES
from viscotack.model.geometry import Sphere
from viscotack.model.traction import LennardJones

LAW = LennardJones(work_of_adhesion=0.1523, equilibrium_gap=1.55e-6)


def reference(equation):
    found = [row for row in VALUES if row["equation"].startswith(equation)]
    assert found
    return found


def test_energy_is_the_work_against_the_traction_from_far_away():
    h0 = LAW.equilibrium_gap
    for gap in (0.9, 1.0, 1.7):
        work, _ = quad(
            lambda x: float(LAW.traction(x * h0)) * h0, gap, np.inf, epsabs=0, epsrel=1e-11
        )
        assert -work == pytest.approx(float(LAW.energy(gap * h0)), rel=1e-9)


def test_separating_from_the_equilibrium_gap_costs_the_work_of_adhesion():
    assert float(LAW.energy(LAW.equilibrium_gap)) == pytest.approx(-0.1523, rel=1e-14)
    assert float(LAW.traction(LAW.equilibrium_gap)) == pytest.approx(0, abs=1e-9)
    assert float(LAW.stiffness(LAW.equilibrium_gap)) == pytest.approx(
        16 * 0.1523 / 1.55e-6**2, rel=1e-14
    )


def test_far_traction_falls_as_the_cube_of_the_gap():
    x = LAW.equilibrium_gap * np.array([1e3, 1e4])
    slope = np.diff(np.log(LAW.traction(x))) / np.diff(np.log(x))
    assert slope[0] == pytest.approx(-3, abs=1e-9)


def test_the_law_agrees_with_the_reference_values():
    law = LAW.reduced()
    for row in reference("32 "):
        gap = row["inputs"]["h/h0"]
        assert float(law.traction(gap)) == pytest.approx(row["value"], rel=1e-13, abs=1e-13)
    for row in reference("2.1/3.17"):
        assert law.edge_gap == pytest.approx(row["value"], rel=1e-14)


@pytest.mark.parametrize("wrong", [0, -0.05, np.nan, "0.05 J/m2"])
def test_an_impossible_law_is_refused(wrong):
    with pytest.raises(ValueError, match="work_of_adhesion must be"):
        LennardJones(work_of_adhesion=wrong, equilibrium_gap=1e-6)
    with pytest.raises(ValueError, match="equilibrium_gap must be"):
        LennardJones(work_of_adhesion=0.05, equilibrium_gap=wrong)


def test_gap_of_a_sphere_is_that_of_its_osculating_paraboloid():
    R, r = 5.19e-3, np.array([0.0, 1e-6, 10e-6, 100e-6])
    exact = R - np.sqrt(R**2 - r**2)
    # The next term of the sphere's series is r^4/(8 R^3), the one after it 2e-4 of that.
    np.testing.assert_allclose(exact - Sphere(R).gap(r), r**4 / (8 * R**3), rtol=2e-4, atol=1e-18)
