"""The verification ladder of fractional laws: identities, limits, modes, peers."""

import mpmath
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import erfcx, rgamma

from dimensionless import slope
from viscotack.model.materials import FractionalZener, StandardSolid
from viscotack.model.materials.fractional import passed, remaining

E0, TAU, NU = 1.2e6, 2e-3, 0.48


def zener(order, k=1e-3):
    return FractionalZener(
        rubbery_modulus=E0, glassy_modulus=E0 / k, order=order, tau0=TAU, poisson_ratio=NU
    )


# ---- rung 1: identities ------------------------------------------------------------------------
def test_the_function_of_order_one_half_is_an_error_function():
    # E_1/2(-z) = exp(z^2) erfc(z), with z^2 = x
    log_x = np.linspace(-60, 60, 400)
    assert_allclose(remaining(0.5, log_x), erfcx(np.exp(log_x / 2)), rtol=1e-13)


# ---- rung 2: limits ----------------------------------------------------------------------------
@pytest.mark.parametrize("order", [0.2, 0.5, 0.9])
def test_creep_begins_and_ends_as_powers_of_time(order):
    solid = zener(order, k=1e-6)
    early, late = 10.0 ** np.array([-12.0, -11]), 10.0 ** np.array([10.0, 11])
    assert E0 * solid.creep(0) == 1e-6
    exact = passed(order, np.log(early) / order)
    assert_allclose(exact, early * rgamma(1 + order), rtol=1e-9)
    left = remaining(order, np.log(late) / order)
    assert_allclose(left, rgamma(1 - order) / late, rtol=1e-9)


def test_the_modulus_tends_to_the_standard_solid_with_the_order():
    standard = StandardSolid(
        rubbery_modulus=E0, glassy_modulus=E0 / 0.1, tau0=TAU, poisson_ratio=NU
    )
    away = 1 - np.array([0.95, 0.94, 0.93])
    omega = 3.0 / TAU
    off = [
        abs(zener(1 - x, k=0.1).complex_modulus(omega) - standard.complex_modulus(omega))
        for x in away
    ]
    assert slope(away, off) == pytest.approx(1, abs=0.05)


def test_a_solid_that_does_not_relax_has_no_modes():
    modes = zener(0.6, k=1.0).retardation_modes(shortest=1e-6, longest=1.0, tolerance=1e-3)
    assert modes.weights == ()


# ---- rung 4: peers -----------------------------------------------------------------------------
@pytest.mark.parametrize("order", [0.2, 0.6, 0.95])
def test_relaxation_agrees_with_an_inverse_laplace_transform_of_many_digits(order):
    solid = zener(order)
    with mpmath.workdps(30):
        a, time = mpmath.mpf(order), mpmath.mpf(solid.relaxation_time)

        def modulus(s):
            z = (s * time) ** a
            return (E0 + (solid.glassy_modulus - E0) * z / (1 + z)) / s

        for t in TAU * np.array([1e-6, 1e-2, 1.0, 1e3]):
            assert solid.relaxation(t) == pytest.approx(
                float(mpmath.invertlaplace(modulus, t)), rel=1e-11
            )
