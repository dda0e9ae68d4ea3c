"""The traction law: identities and limits, exact or to round-off."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from reference_data import VALUES
from viscotack.geometry import Sphere
from viscotack.traction import LennardJones

LAW = LennardJones(work_of_adhesion=0.1523, equilibrium_gap=1.55e-6)
# From crushed to nearly out of range.
GAPS = LAW.equilibrium_gap * np.array([0.8, 0.95, 1.0, 1.1, 1.2009, 2.0, 5.0, 40.0])


def derivative(function, x):
    """Return a central difference of fourth order; for these laws its error is some 1e-8."""
    d = 1e-3 * x
    near, far = function(x + d) - function(x - d), function(x + 2 * d) - function(x - 2 * d)
    return (8 * near - far) / (12 * d)


def reference(equation):
    found = [row for row in VALUES if row["equation"].startswith(equation)]
    assert found
    return found


def test_traction_is_the_derivative_of_the_energy():
    np.testing.assert_allclose(
        LAW.traction(GAPS), derivative(LAW.energy, GAPS), rtol=1e-7, atol=1e-7 * LAW.strength
    )


def test_energy_is_the_work_against_the_traction_from_far_away():
    h0 = LAW.equilibrium_gap
    for gap in (0.9, 1.0, 1.7):
        work, _ = quad(
            lambda x: float(LAW.traction(x * h0)) * h0, gap, np.inf, epsabs=0, epsrel=1e-11
        )
        assert -work == pytest.approx(float(LAW.energy(gap * h0)), rel=1e-9)


def test_energy_beyond_a_gap_is_what_the_energy_adds_up_to():
    size = LAW.work_of_adhesion
    np.testing.assert_allclose(
        LAW.energy(GAPS), -derivative(LAW.energy_beyond, GAPS), rtol=1e-7, atol=1e-7 * size
    )
    # and nothing is left at infinity
    assert abs(float(LAW.energy_beyond(1e12 * LAW.equilibrium_gap))) < 1e-11 * size * 1.55e-6


def test_stiffness_is_the_derivative_of_the_traction():
    size = 16 * LAW.work_of_adhesion / LAW.equilibrium_gap**2
    np.testing.assert_allclose(
        LAW.stiffness(GAPS), derivative(LAW.traction, GAPS), rtol=1e-7, atol=1e-7 * size
    )


def test_separating_from_the_equilibrium_gap_costs_the_work_of_adhesion():
    assert float(LAW.energy(LAW.equilibrium_gap)) == pytest.approx(-0.1523, rel=1e-14)
    assert float(LAW.traction(LAW.equilibrium_gap)) == pytest.approx(0, abs=1e-9)
    assert float(LAW.stiffness(LAW.equilibrium_gap)) == pytest.approx(
        16 * 0.1523 / 1.55e-6**2, rel=1e-14
    )


def test_tension_is_largest_at_the_edge_gap():
    assert float(LAW.stiffness(LAW.edge_gap)) == pytest.approx(0, abs=1e-3)
    assert float(LAW.traction(LAW.edge_gap)) == pytest.approx(LAW.strength, rel=1e-14)
    assert np.all(LAW.traction(LAW.edge_gap * np.array([0.99, 1.01])) < LAW.strength)


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


@given(st.floats(-9, 9), st.floats(-9, 9), st.floats(0.7, 30))
def test_the_law_does_not_depend_on_the_units(length, load, x):
    L, M = 10**length, 10**load
    new = LennardJones(work_of_adhesion=0.1523 * M / L, equilibrium_gap=1.55e-6 * L)
    h = x * 1.55e-6
    cases = (
        (new.traction(L * h), LAW.traction(h), M / L**2, LAW.strength),
        (new.energy(L * h), LAW.energy(h), M / L, 0.1523),
        (new.stiffness(L * h), LAW.stiffness(h), M / L**3, LAW.strength / 1.55e-6),
        (new.energy_beyond(L * h), LAW.energy_beyond(h), M, 0.1523 * 1.55e-6),
        (new.strength, LAW.strength, M / L**2, LAW.strength),
        (new.edge_gap, LAW.edge_gap, L, 1.55e-6),
    )
    for got, old, factor, size in cases:
        assert float(got) == pytest.approx(factor * float(old), rel=1e-9, abs=1e-9 * factor * size)


def test_reduced_law_is_the_law_in_its_own_units():
    x = np.array([0.9, 1.3, 4.0])
    np.testing.assert_allclose(
        LAW.reduced().traction(x), LAW.traction(x * 1.55e-6) * 1.55e-6 / 0.1523, rtol=1e-12
    )


@pytest.mark.parametrize("gap", [0.0, -1e-6, [1e-6, -1e-9]])
def test_surfaces_cannot_pass_through_each_other(gap):
    for formula in (LAW.traction, LAW.energy, LAW.energy_beyond, LAW.stiffness):
        with pytest.raises(ValueError, match="gap must be positive"):
            formula(gap)


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


@pytest.mark.parametrize("radius", [0, -1e-3, np.nan])
def test_an_impossible_sphere_is_refused(radius):
    with pytest.raises(ValueError, match="radius must be"):
        Sphere(radius=radius)
