"""The ladder of the viscoelastic crack: identities, limits with their exponents."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import gamma as gamma_function

import viscotack as vt
from dimensionless import last_slope
from solids import creep_power_law
from viscotack.theory import CrackLaw, greenwood, persson_brener
from viscotack.theory.crack.law import THEORIES

MODULI = dict(rubbery_modulus=1.2e6, glassy_modulus=3e7, poisson_ratio=0.5)
SOLIDS = [
    vt.StandardSolid(**MODULI, tau0=0.02),
    vt.Prony(
        rubbery_modulus=1.2e6, branches=((2e6, 1.0), (8e6, 1e-2), (1.9e7, 1e-5)), poisson_ratio=0.5
    ),
    vt.RetardationPowerLaw(**MODULI, exponent=0.22, tau0=0.019),
    vt.RetardationPowerLaw(**MODULI, exponent=1.6, tau0=0.019),
    vt.RelaxationPowerLaw(**MODULI, exponent=0.6, tau0=1e-3),
    vt.FractionalZener(**MODULI, order=0.4, tau0=1e-3),
]
NAMES = ["standard", "prony", "broad", "narrow", "relaxation", "fractional"]
solids = pytest.mark.parametrize("material", SOLIDS, ids=NAMES)
theories = pytest.mark.parametrize("theory", [persson_brener, greenwood])
SPEEDS = [1e-3, 0.3, 20.0, 1e5]


def narrow(exponent, modulus_ratio):
    return creep_power_law(1e6, 1e6 / modulus_ratio, exponent, 1e-3, 0.5)


@solids
@pytest.mark.parametrize("speed", SPEEDS)
def test_persson_brener_balances_the_loss_at_all_frequencies_below_the_cut_off(material, speed):
    # Eq. 2.18: 1/Gamma = 1 - E0 (2/pi) int_0^1 sqrt(1 - x^2)/x C''(x omega_c) dx, x = 1/cosh s;
    # trapezoidal, because C'' of any spectrum is analytic for |Im s| < pi/2
    amplification = persson_brener.amplification(speed, material=material)
    cut_off = 2 * np.pi * speed / amplification / material.time_unit
    s = 0.1 * np.arange(1, 1000)
    loss = -np.imag(material.complex_compliance(cut_off / np.cosh(s)))
    lost = 2 / np.pi * material.rubbery_modulus * 0.1 * np.sum(np.tanh(s) ** 2 * loss)
    assert 1 / amplification == pytest.approx(1 - lost, rel=1e-11, abs=0)


@solids
@pytest.mark.parametrize("speed", SPEEDS)
def test_greenwood_closes_the_work_of_the_zone_with_the_creep_under_it(material, speed):
    # Eq. 3.32 by parts: 1/Gamma = (1/2) int_0^1 H'(xi) E0 C(l Gamma (1 - xi)/v) dxi,
    # H' = ln[(1 + sqrt xi)/(1 - sqrt xi)], which is 2 s at sqrt xi = tanh s; trapezoidal, because
    # C is analytic there for |Im s| < pi/2
    amplification = greenwood.amplification(speed, material=material)
    passage = amplification / speed * material.time_unit
    s = 0.1 * np.arange(1, 400)
    closed = 1 / np.cosh(s) ** 2
    terms = 2 * s * np.tanh(s) * closed * material.creep(passage * closed)
    total = 0.1 * np.sum(terms)
    assert 1 / amplification == pytest.approx(material.rubbery_modulus * total, rel=1e-9, abs=0)


@pytest.mark.parametrize("ratio", [1e-3, 0.999, 1.001, 49.99, 50.01])
def test_zone_response_is_the_integral_of_the_opening_kernel(ratio):
    def kernel(x):
        # H of Eq. 3.33
        root = np.sqrt(x)
        H = 2 * root - (1 - x) * np.log((1 + root) / (1 - root)) if x < 1 else 2.0
        return ratio / 2 * H * np.exp(-ratio * (1 - x))

    split = [max(0.5, 1 - 10 / ratio)]
    expected = quad(kernel, 0, 1, points=split, epsabs=0, epsrel=1e-12, limit=200)[0]
    assert greenwood.zone_response(ratio) == pytest.approx(expected, rel=1e-10, abs=0)


def test_zone_response_tends_to_a_third_and_to_one():
    assert greenwood.zone_response(1e-9) == pytest.approx(1e-9 / 3, rel=1e-8, abs=0)
    large = np.array([1e2, 1e4, 1e6])
    rest = 1 - greenwood.zone_response(large) - (np.log(4 * large) + np.euler_gamma) / (2 * large)
    # the next term is -1/(4 alpha^2)
    assert last_slope(large[:2], rest[:2]) == pytest.approx(-2, abs=0.01)


@solids
@theories
def test_speed_and_amplification_are_inverse(theory, material):
    speed = np.geomspace(1e-4, 1e4, 9)
    gamma = theory.amplification(speed, material=material)
    # at the ends the speed follows from a small difference of Gamma from 1 or from 1/k
    margin = (gamma - 1) * (1 / material.modulus_ratio - gamma) * material.modulus_ratio / gamma
    found = theory.speed(gamma, material=material)
    assert np.all(np.abs(found / speed - 1) * margin < 1e-12)


@solids
@theories
def test_amplification_rises_from_one_to_the_ratio_of_the_moduli(theory, material):
    speed = np.geomspace(1e-30, 1e90, 481)
    gamma = theory.amplification(speed, material=material)
    # a plateau between two modes is flat to round-off
    assert np.all(np.diff(gamma) >= -1e-12 * gamma[1:])
    assert gamma[0] == pytest.approx(1, abs=1e-9)
    assert gamma[-1] == pytest.approx(1 / material.modulus_ratio, rel=1e-12, abs=0)
    assert theory.amplification(0.0, material=material) == 1


@theories
def test_an_elastic_crack_takes_the_work_of_adhesion_at_any_speed(theory):
    solid = vt.Elastic(rubbery_modulus=1e6, poisson_ratio=0.5)
    np.testing.assert_array_equal(theory.amplification([0, 1e-3, 1e9], material=solid), 1)


@pytest.mark.parametrize("exponent", [0.3, 0.6, 1.6])
def test_fast_crack_approaches_the_ratio_of_the_moduli_as_the_spectrum_falls(exponent):
    # 1 - I -> 2^-n Gamma(1 - n/2) / [(1 - n) Gamma(1 + n/2)] A^n for n < 1, A/(n - 1) for n > 1
    material = narrow(exponent, 0.1)
    speed = np.array([1e6, 1e8, 1e10]) ** (1 / min(exponent, 1))
    missing = 10 - persson_brener.amplification(speed, material=material)
    power = min(exponent, 1)
    assert last_slope(speed, missing) == pytest.approx(-power, abs=1e-3)
    A = 10 / (2 * np.pi * speed[-1])
    if exponent < 1:
        half = exponent / 2
        factor = gamma_function(1 - half) / gamma_function(1 + half)
        part = 2**-exponent / (1 - exponent) * factor * A**exponent
    else:
        part = A / (exponent - 1)
    assert missing[-1] == pytest.approx(100 * 0.9 * part, rel=1e-3, abs=0)


def test_lengths_of_the_two_theories_differ_by_the_ratio_of_their_conventions():
    case = dict(contact_modulus=1.9e6, work_of_adhesion=0.2, strength=5e6)
    zone = greenwood.cohesive_zone_length(**case)
    tip = persson_brener.crack_tip_length(**case, strength_ratio=np.pi / 9)
    assert zone / tip == pytest.approx(np.pi**2 * (np.pi / 9) ** 2 / 4, rel=1e-14, abs=0)
    # the stress of the slow crack, K = sqrt(2 E* w), at the distance l0 is alpha sigma_0
    K = np.sqrt(2 * 1.9e6 * 0.2)
    assert K / np.sqrt(2 * np.pi * tip) == pytest.approx(np.pi / 9 * 5e6, rel=1e-14, abs=0)
    # a Dugdale zone cancels K = sqrt(8/pi) sigma_0 sqrt(l)
    assert np.sqrt(8 / np.pi * zone) * 5e6 == pytest.approx(K, rel=1e-14, abs=0)


laws = pytest.mark.parametrize("name", THEORIES)


@laws
@solids
def test_a_law_of_a_crack_is_its_theory_with_a_length_and_the_time_of_the_solid(name, material):
    law = CrackLaw(theory=name, material=material, tip_length=3e-7)
    assert law.speed_unit == pytest.approx(3e-7 / material.time_unit, rel=1e-15, abs=0)
    v = np.array([0.0, *SPEEDS])
    gamma = THEORIES[name].amplification(v, material=material)
    np.testing.assert_allclose(law.amplification(v * law.speed_unit), gamma, rtol=1e-13)
    np.testing.assert_array_equal(law.reduced().amplification(v), gamma)
    assert np.all(gamma < law.largest)
    gamma = 1 + (law.largest - 1) * np.array([0.0, 0.1, 0.9])
    speed = law.speed(gamma)
    np.testing.assert_allclose(law.amplification(speed), gamma, rtol=1e-11)
    np.testing.assert_allclose(law.reduced().speed(gamma) * law.speed_unit, speed, rtol=1e-14)


@laws
@solids
def test_a_limited_crack_is_slowed_in_proportion_at_the_same_passage(name, material):
    law = CrackLaw(theory=name, material=material, tip_length=3e-7)
    k, end = material.modulus_ratio, 4 * material.modulus_ratio
    limited = law.limited(modulus_ratio=end)
    assert limited.largest == pytest.approx(law.largest / 4, rel=1e-15, abs=0)
    whole = 1 + (law.largest - 1) * np.array([0.01, 0.3, 0.9])
    gamma = 1 / (end + (1 - end) * (1 / whole - k) / (1 - k))
    # the same l Gamma/(v tau) feels the same part of the creep
    np.testing.assert_allclose(
        limited.amplification(law.speed(whole) * gamma / whole), gamma, rtol=1e-11
    )
    # and a limit beyond the glassy end is none
    assert law.limited(modulus_ratio=k / 2) == law
