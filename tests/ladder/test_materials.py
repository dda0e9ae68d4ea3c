"""The verification ladder of the materials: identities, limits, orders, peers."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import viscotack as vt
from dimensionless import slope
from reference_data import reference
from solids import fractional_zener
from viscotack.model.materials.modes import reciprocal
from viscotack.model.materials.power_law import nodes

# Ordinary numbers: 1 MPa rubber, 1 ms, k from 1e-1 to 1e-6, exponents with both integers.
E0, TAU, NU = 1.2e6, 2e-3, 0.48
POWER_LAWS = [vt.RetardationPowerLaw, vt.RelaxationPowerLaw]


def power_law(kind, *, exponent, k, tau0=TAU):
    return kind(
        rubbery_modulus=E0, glassy_modulus=E0 / k, exponent=exponent, tau0=tau0, poisson_ratio=NU
    )


def standard_solid(k=0.1):
    return vt.StandardSolid(rubbery_modulus=E0, glassy_modulus=E0 / k, tau0=TAU, poisson_ratio=NU)


def fractional(order, k):
    return fractional_zener(E0, E0 / k, order, TAU, NU)


SOLIDS = {
    "elastic": vt.Elastic(rubbery_modulus=E0, poisson_ratio=NU),
    "standard": standard_solid(),
    "prony": vt.Prony(
        rubbery_modulus=E0,
        branches=[(3e7, 1e-6), (4e6, 5e-4), (8e5, 2e-3), (9e5, 0.3)],
        poisson_ratio=NU,
    ),
    "retardation 0.2": power_law(vt.RetardationPowerLaw, exponent=0.2, k=1e-3),
    "retardation 1.6": power_law(vt.RetardationPowerLaw, exponent=1.6, k=1e-6),
    "relaxation 0.5": power_law(vt.RelaxationPowerLaw, exponent=0.5, k=1e-3),
    "relaxation 3": power_law(vt.RelaxationPowerLaw, exponent=3, k=1e-6),
    "fractional 0.2": fractional(0.2, k=1e-3),
    "fractional 0.9": fractional(0.9, k=1e-6),
}
every_solid = pytest.mark.parametrize("solid", SOLIDS.values(), ids=SOLIDS)


# ---- rung 1: identities ------------------------------------------------------------------------
# Plateaus, reciprocals, monotony and units are judged by viscotack.testing (tests/test_testing.py).
RELAXING, CREEPING = vt.RelaxationPowerLaw, vt.RetardationPowerLaw
QUANTITIES = {
    "4.5": (RELAXING, lambda m, x: m.relaxation(x["t_hat"] * TAU) / E0),
    "4.10/35": (CREEPING, lambda m, x: m.creep(x["t_hat"] * TAU) * E0),
    "4.2/12 (E')": (RELAXING, lambda m, x: m.complex_modulus(x["w_tau0"] / TAU).real / E0),
    "4.2/12 (E'')": (RELAXING, lambda m, x: m.complex_modulus(x["w_tau0"] / TAU).imag / E0),
    "4.7/23 (C')": (CREEPING, lambda m, x: m.complex_compliance(x["w_tau0"] / TAU).real * E0),
    "4.7/23 (C'')": (CREEPING, lambda m, x: -m.complex_compliance(x["w_tau0"] / TAU).imag * E0),
}


@pytest.mark.parametrize("row", reference(*QUANTITIES))
def test_power_laws_have_the_verified_value(row):
    kind, quantity = QUANTITIES[row["equation"]]
    solid = power_law(kind, exponent=row["inputs"]["n"], k=row["inputs"]["k"])
    # the values carry 18 digits; the Bessel function of scipy 13 to 14
    assert quantity(solid, row["inputs"]) == pytest.approx(row["value"], rel=1e-13, abs=0)


def log_integral(function, *, first, last, step=0.08):
    """Return the integral of a function that falls off at both ends of ln x."""
    x = np.exp(np.arange(np.log(first), np.log(last), step))
    return step * np.sum(function(x) * x)


@every_solid
def test_complex_modulus_is_the_transform_of_the_relaxation(solid):
    # The Fourier integral tested with t -> exp(-t^2/2a^2) and t exp(-t^2/2a^2), whose cosine and
    # sine transforms are Gaussian too: nothing oscillates, the trapezoidal rule in ln t is exact.
    for a in TAU * np.array([1e-5, 1e-2, 0.3]):

        def gauss(x, a=a):
            return np.exp(-((x / a) ** 2) / 2)

        def transient(t):
            return solid.relaxation(t) - E0

        def spectral(w, a=a):
            return (solid.complex_modulus(w) - E0) * np.exp(-((a * w) ** 2) / 2)

        late = dict(first=a * 1e-22, last=a * 12)
        fast = dict(first=1e-80 / a, last=12 / a)
        even = log_integral(lambda t: transient(t) * gauss(t), **late)
        odd = log_integral(lambda t: transient(t) * t * gauss(t), **late)
        loss = log_integral(lambda w: spectral(w).imag / w, **fast)
        storage = log_integral(lambda w: spectral(w).real, **fast)
        # cancellation of E' - E0 far below the frequency 1/a leaves 1e-16 E0 of each
        assert_allclose(a * np.sqrt(2 / np.pi) * loss, even, rtol=1e-12, atol=1e-12 * E0 * a)
        assert_allclose(
            a**3 * np.sqrt(2 / np.pi) * storage, odd, rtol=1e-12, atol=1e-12 * E0 * a**2
        )


@every_solid
def test_creep_and_relaxation_convolve_to_time(solid):
    # int_0^t R(t - s) C(s) ds = t, with s = t/(1 + exp(-x)), which resolves both ends
    x = np.arange(-60, 60, 0.1)
    early, late = 1 / (1 + np.exp(-x)), 1 / (1 + np.exp(x))
    for t in TAU * np.array([1e-12, 1e-6, 1e-2, 1, 1e2]):
        integrand = solid.relaxation(t * late) * solid.creep(t * early) * early * late
        assert 0.1 * np.sum(integrand) == pytest.approx(1, rel=1e-12)


def pole(branch):
    return 10.0 ** branch[1]


@settings(deadline=None, max_examples=50)
@given(
    st.lists(
        st.tuples(st.floats(-8, 6), st.floats(-15, 10)), min_size=1, max_size=40, unique_by=pole
    )
)
def test_interconversion_is_exact_for_any_branches(branches):
    weights, poles = 10.0 ** np.array(sorted(branches, key=pole)).T
    compliance, zeros = reciprocal(1.0, weights, poles)
    assert np.all(compliance > 0) and np.all(zeros <= poles) and np.all(zeros[1:] >= poles[:-1])
    s = 10.0 ** np.arange(-20, 15, 0.7)  # s C*(s) of the Laplace transform, all terms positive
    modulus = 1 + s[:, None] / (s[:, None] + poles) @ weights
    reciprocal_modulus = 1 / (1 + np.sum(weights)) + zeros / (s[:, None] + zeros) @ compliance
    assert_allclose(modulus * reciprocal_modulus, 1, rtol=1e-12)  # 4e-14 is usual


# ---- rung 2: limits ----------------------------------------------------------------------------
def test_prony_of_one_branch_is_the_standard_solid():
    solid = standard_solid(k=1e-3)
    branch = (solid.glassy_modulus - E0, solid.relaxation_time)
    prony = vt.Prony(rubbery_modulus=E0, branches=[branch], poisson_ratio=NU)
    x = 10.0 ** np.arange(-10, 4, 0.5)
    for method in ("relaxation", "creep"):
        assert_allclose(getattr(prony, method)(x), getattr(solid, method)(x), rtol=1e-13)
    for method in ("complex_modulus", "complex_compliance"):
        assert_allclose(getattr(prony, method)(1 / x), getattr(solid, method)(1 / x), rtol=1e-13)
    window = dict(shortest=1e-6, longest=1.0, tolerance=1e-9)
    one, other = prony.retardation_modes(**window), solid.retardation_modes(**window)
    assert one.weights == pytest.approx(other.weights, rel=1e-13)
    assert one.times == pytest.approx(other.times, rel=1e-13)


@pytest.mark.parametrize("n", [0.3, 1.0, 2.5])
def test_prony_of_many_branches_tends_to_the_relaxation_power_law(n):
    # the spectrum of Eq. 4.1 by the trapezoidal rule, written out
    y = np.arange(-45 / n, 4, 0.15)
    modulus = np.exp(n * y - np.exp(y))
    solid = power_law(vt.RelaxationPowerLaw, exponent=n, k=1e-3)
    modulus *= (solid.glassy_modulus - E0) / np.sum(modulus)
    prony = vt.Prony(
        rubbery_modulus=E0, branches=zip(modulus, TAU * np.exp(-y), strict=True), poisson_ratio=NU
    )
    t = TAU * 10.0 ** np.arange(-6, 6.0)
    assert_allclose(prony.relaxation(t), solid.relaxation(t), rtol=1e-12)
    assert_allclose(prony.creep(t), solid.creep(t), rtol=1e-12)
    assert_allclose(prony.complex_modulus(1 / t), solid.complex_modulus(1 / t), rtol=1e-12)


@pytest.mark.parametrize(
    ("n", "k", "early", "power", "coefficient"),
    [
        # K_n for small argument: t^n Gamma(1 - n)/Gamma(1 + n) below 1, t/(n - 1) above
        (0.2, 1e-6, -20, 0.2, 1.1642297137253 / 0.91816874239976),
        (0.5, 0.1, -9, 0.5, 2.0),
        (2.0, 1e-6, -9, 1.0, 1.0),
        (3.0, 0.1, -7, 1.0, 0.5),
    ],
)
def test_early_creep_is_a_power_of_time(n, k, early, power, coefficient):
    solid = power_law(vt.RetardationPowerLaw, exponent=n, k=k)
    # early enough for the power, late enough that E0 C - k keeps 9 digits
    t = 10.0 ** np.array([early, early + 1])
    crept = (E0 * solid.creep(TAU * t) - k) / (1 - k)
    assert slope(t, crept) == pytest.approx(power, abs=1e-3)
    assert crept[0] / t[0] ** power == pytest.approx(coefficient, rel=1e-3)


@pytest.mark.parametrize("n", [0.3, 1.0, 2.0])
def test_late_relaxation_falls_with_the_exponent(n):
    solid = power_law(vt.RelaxationPowerLaw, exponent=n, k=1e-6)
    t = np.array([1e4, 1e5, 1e6]) * TAU
    assert slope(t, solid.relaxation(t) - E0) == pytest.approx(-n, abs=1e-3)


@pytest.mark.parametrize("kind", [*POWER_LAWS, "standard"])
def test_solids_tend_to_the_elastic_one_as_the_moduli_meet(kind):
    gap = np.array([1e-2, 1e-4, 1e-6])
    away = []
    for x in gap:
        solid = (
            standard_solid(k=1 - x)
            if kind == "standard"
            else power_law(kind, exponent=0.7, k=1 - x)
        )
        away.append([solid.relaxation(TAU) / E0 - 1, 1 - solid.creep(TAU / 50) * E0])
    for distances in np.array(away).T:
        assert slope(gap, distances) == pytest.approx(1, abs=2e-3)


# ---- rung 3: orders ----------------------------------------------------------------------------
def test_error_of_the_spectrum_nodes_falls_exponentially_with_their_distance():
    # The first harmonic of the trapezoidal rule, 2 |Gamma(n + i s)|/Gamma(n) with s = 2 pi/h, is a
    # wave in ln(1 + t) on R - E0; for n = 1/2 it is 2/sqrt(cosh(2 pi^2/h)), that is exp(-pi^2/h).
    n, t = 0.5, np.expm1(np.arange(0, 6, 0.002))
    h = np.array([1.2, 0.9, 0.7, 0.55, 0.45])
    amplitude = []
    for step in h:
        weights, rate = nodes(n, smallest=1e-9, step=step)
        wave = np.sqrt(1 + t) * (np.exp(-t[:, None] * rate) @ weights)  # Eq. 4.4
        amplitude.append((np.max(wave) - np.min(wave)) / 2)
    assert_allclose(amplitude, 2 / np.sqrt(np.cosh(2 * np.pi**2 / h)), rtol=0.01)
    rate = np.polyfit(1 / h, np.log(amplitude), 1)[0]
    assert rate == pytest.approx(-(np.pi**2), abs=0.1), amplitude


WINDOWS = [(1e-9, 1e3), (1e-12, 1e-6), (10.0, 1e6), (1e-15, 1e10)]


BROAD = [
    *(power_law(kind, exponent=n, k=k) for kind in POWER_LAWS
      for n, k in ((0.05, 1e-4), (1.0, 0.5), (3.0, 1e-4))),
    *(fractional(order, k) for order, k in ((0.02, 1e-4), (0.6, 0.5), (0.95, 1e-4))),
]  # fmt: skip


@pytest.mark.parametrize("solid", BROAD)
def test_modes_keep_the_stated_error_over_their_window(solid):
    for shortest, longest in WINDOWS:
        t = TAU * np.geomspace(shortest, longest, 1500)
        exact = E0 * solid.creep(t)
        for tolerance in (1e-2, 1e-4, 1e-7):
            modes = solid.retardation_modes(
                shortest=TAU * shortest, longest=TAU * longest, tolerance=tolerance
            )
            missed = np.max(np.abs(modes.creep(t) - exact))
            assert missed <= modes.error <= tolerance, (shortest, longest, tolerance)
            assert modes.instantaneous + sum(modes.weights) == pytest.approx(1, abs=1e-13)
            assert np.all(np.diff(modes.times) > 0) and min(modes.weights, default=1) > 0
            decades = np.log10(longest / shortest)
            if isinstance(solid, vt.FractionalZener):
                continue
            assert len(modes.times) <= 6 - np.log10(tolerance) + decades * (
                1 - 0.5 * np.log10(tolerance)
            )


# ---- rung 4: peers -----------------------------------------------------------------------------
@pytest.mark.parametrize("n", [0.7, 1 + 1e-6, 3.0])
def test_creep_agrees_with_a_bessel_function_of_many_digits(n):
    k = 1e-6
    solid = power_law(vt.RetardationPowerLaw, exponent=n, k=k, tau0=1.0)
    with mpmath.workdps(60):
        for t in 10.0 ** np.arange(-25, 4, 7):
            order, x = mpmath.mpf(n), mpmath.mpf(t)
            bessel = x ** (order / 2) * mpmath.besselk(order, 2 * mpmath.sqrt(x))
            k_exact = mpmath.mpf(solid.rubbery_modulus) / mpmath.mpf(solid.glassy_modulus)
            exact = 1 - 2 * (1 - k_exact) / mpmath.gamma(order) * bessel
            assert E0 * solid.creep(t) == pytest.approx(float(exact), rel=1e-13)


@pytest.mark.parametrize("n", [0.01, 1.0, 1 + 1e-6, 3.0])
def test_complex_functions_agree_with_an_exponential_integral_of_many_digits(n):
    relaxing = power_law(vt.RelaxationPowerLaw, exponent=n, k=0.5, tau0=1.0)
    creeping = power_law(vt.RetardationPowerLaw, exponent=n, k=0.5, tau0=1.0)
    with mpmath.workdps(50):
        for x in 10.0 ** np.arange(-25, 26, 5):
            s = mpmath.mpc(0, x)
            phi = s * mpmath.exp(s) * mpmath.expint(n, s)  # Eq. 4.2
            E = relaxing.complex_modulus(x) / E0
            C = creeping.complex_compliance(1 / x) * E0
            assert E.imag == pytest.approx(float(phi.imag), rel=1e-13, abs=0)
            assert C.imag == pytest.approx(-float(phi.imag) / 2, rel=1e-13, abs=0)
            assert E.real == pytest.approx(1 + float(phi.real), rel=1e-14)
            assert C.real == pytest.approx(0.5 + float(phi.real) / 2, rel=1e-14)
