"""The ladder of crack regimes, tables, rates, unloading curves, bounds and empirical laws."""

import warnings

import numpy as np
import pytest

from dimensionless import last_slope
from solids import creep_power_law
from viscotack import theory
from viscotack.model.materials import StandardSolid

LENS = dict(radius=5e-3, contact_modulus=2e6, work_of_adhesion=0.15)
FORCE = theory.jkr.pull_off_force(radius=5e-3, work_of_adhesion=0.15)
SOLID = StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5)


def rubber(exponent, modulus_ratio):
    return creep_power_law(1.5e6, 1.5e6 / modulus_ratio, exponent, 0.02, 0.5)


# Regimes of the crack -------------------------------------------------------------------------
@pytest.mark.parametrize("exponent", [0.4, 1.0, 2.6])
def test_slow_cracks_dissipate_in_proportion_to_their_speed(exponent):
    v = np.array([1e-3, 1e-4])
    exact = theory.persson_brener.amplification(v, material=rubber(exponent, 0.1))
    slow = theory.persson_brener.slow_amplification(v, modulus_ratio=0.1, exponent=exponent)
    assert slow == pytest.approx(exact, rel=1e-5, abs=0)
    assert last_slope(v, exact - slow) == pytest.approx(3, abs=0.02)


@pytest.mark.parametrize("exponent", [0.3, 0.6, 1.7])
def test_the_steepest_slope_tends_to_that_of_the_intermediate_regime(exponent):
    limit = theory.persson_brener.intermediate_exponent(exponent)
    rest = [
        limit - theory.persson_brener.steepest(material=rubber(exponent, k)).exponent
        for k in (1e-2, 1e-4, 1e-12)
    ]
    assert rest[0] > rest[1] > abs(rest[2])
    assert rest[2] == pytest.approx(0, abs=2e-3)


def test_the_power_law_of_the_intermediate_range_is_a_tangent():
    material = rubber(0.6, 0.1)
    law = theory.persson_brener.steepest(material=material)
    gamma = theory.persson_brener.amplification(law.speed, material=material)
    assert law.coefficient * law.speed**law.exponent == pytest.approx(gamma, rel=1e-12, abs=0)
    found = theory.persson_brener.local_exponent(
        law.speed * np.array([0.3, 1.0, 3.0]), material=material
    )
    assert found[1] == pytest.approx(law.exponent, rel=1e-9, abs=0)
    assert found[1] > found[0] and found[1] > found[2]
    with pytest.raises(ValueError, match="elastic"):
        theory.persson_brener.steepest(material=rubber(0.6, 1.0))


def test_local_exponent_is_the_integral_back_to_the_amplification():
    x, weights = np.polynomial.legendre.leggauss(60)
    low, high = np.log(1e-2), np.log(1e3)
    v = np.exp((low + high) / 2 + (high - low) / 2 * x)
    rise = (
        np.sum(theory.persson_brener.local_exponent(v, material=SOLID) * weights) * (high - low) / 2
    )
    ends = np.log(theory.persson_brener.amplification(np.exp([low, high]), material=SOLID))
    assert rise == pytest.approx(ends[1] - ends[0], rel=1e-9, abs=0)


# Rate -----------------------------------------------------------------------------------------
def test_the_fit_warns_away_from_its_tabor_number():
    with pytest.warns(UserWarning, match="this one is 0.8"):
        theory.rate.crack_speed(1.0, tabor=0.8)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        theory.rate.crack_speed(1.0, tabor=3.0)
    with pytest.raises(ValueError, match="not negative"):
        theory.rate.crack_speed(-1.0, tabor=3.24)


# Unloading ------------------------------------------------------------------------------------
def pulled(speed, material=SOLID, depth=5e-5):
    law = theory.CrackLaw(theory="persson-brener", material=material, tip_length=1e-6)
    return theory.unloading.retraction(depth, law, speed=speed, **LENS)


@pytest.mark.parametrize(
    ("material", "speed"),
    [(SOLID, 1e-6), (SOLID, 1.0), (rubber(0.22, 1e-3), 1e-3), (rubber(1.0, 0.9), 1e-9)],
)
def test_every_state_of_the_unloading_is_a_moving_crack_in_a_relaxed_solid(material, speed):
    curve = pulled(speed, material)
    E, w, R = LENS["contact_modulus"], LENS["work_of_adhesion"], LENS["radius"]
    a, d, P = curve.contact_radius, curve.depth, curve.force
    G = E / (2 * np.pi * a) * (a**2 / R - d) ** 2
    assert curve.amplification * w == pytest.approx(G, rel=1e-9, abs=0)
    assert P == pytest.approx(
        4 * E * a**3 / (3 * R) - np.sqrt(8 * np.pi * E * a**3 * G), rel=1e-7, abs=1e-9
    )
    # the law of the crack where it is neither at rest nor at the wall
    free = (curve.amplification > 1.0001) & (
        curve.amplification < 1 + 0.99 * (1 / material.modulus_ratio - 1)
    )
    v = curve.edge_speed[free] * material.time_unit / 1e-6
    law = theory.persson_brener.amplification(v, material=material)
    assert curve.amplification[free] == pytest.approx(law, rel=1e-5, abs=0)
    # and the edge moves with that speed: a over time, second order in the steps
    t = curve.time[free]
    if np.sum(free) > 20 and np.all(np.diff(t[:20]) > 0):
        x = a[free]
        assert -(x[12] - x[10]) / (t[12] - t[10]) == pytest.approx(
            curve.edge_speed[free][11], rel=0.05, abs=0
        )


@pytest.mark.parametrize("depth", [-1e-6, 5e-5, 5e-4])
def test_slow_unloading_is_jkr(depth):
    curve = pulled(1e-14, depth=depth)
    assert curve.pull_off_force == pytest.approx(FORCE, rel=5e-5, abs=0)
    held = curve.depth > theory.jkr.instability(**LENS).depth * 0.9
    expected = theory.jkr.force(
        theory.jkr.contact_radius_at_depth(curve.depth[held], **LENS), **LENS
    )
    assert np.max(np.abs(curve.force[held] - expected)) < 1e-4 * FORCE


def test_unloading_leaves_jkr_in_proportion_to_the_rate():
    r = np.array([3e-9, 1e-9])
    rest = [pulled(x).pull_off_force / FORCE - 1 for x in r]
    # the crack's own law is linear there; the next order is some per cent of it
    assert last_slope(r, rest) == pytest.approx(1, abs=0.05)


def test_fast_unloading_of_a_large_contact_takes_the_glassy_energy():
    assert pulled(1.0, depth=5e-4).pull_off_force / FORCE == pytest.approx(10, rel=2e-3, abs=0)


def test_unloading_refuses_an_elastic_solid_and_a_lost_contact():
    with pytest.raises(ValueError, match="elastic"):
        pulled(1e-6, rubber(0.6, 1.0))
    with pytest.raises(ValueError, match="the contact detaches even from a rigid drive"):
        pulled(1e-6, depth=-1e-3)
    with pytest.raises(ValueError, match="speed must be positive"):
        pulled(0.0)


@pytest.mark.slow
def test_unloading_agrees_with_the_simulation_where_the_bulk_is_relaxed():
    import viscotack as vt

    # what is left is the Tabor number (3 % at rest)
    mu, alpha = 3.24, np.pi / 9
    material = creep_power_law(1.0, 10.0, 1.6, 1.0, 0.0)
    for speed, margin in ((0.1, 0.05), (10.0, 0.04)):
        groups = vt.Groups(tabor=mu, material=material, start=vt.AtDepth(73.0), rate=speed)
        simulated = vt.pull_off_force(
            vt.solve(groups, until="pull-off", accuracy=5e-3, estimate_error=False)
        )
        # R = w = E* = 1
        h0 = 1 / mu
        strength = 16 / (9 * np.sqrt(3)) / h0
        l0 = theory.persson_brener.crack_tip_length(
            contact_modulus=1.0, work_of_adhesion=1.0, strength=strength, strength_ratio=alpha
        )
        curve = theory.unloading.retraction(
            73 * h0,
            theory.CrackLaw(theory="persson-brener", material=material, tip_length=l0),
            speed=speed * h0,
            radius=1.0,
            contact_modulus=1.0,
            work_of_adhesion=1.0,
        )
        assert curve.pull_off_force / (1.5 * np.pi) == pytest.approx(simulated, rel=margin, abs=0)


# Bounds ---------------------------------------------------------------------------------------
def test_the_glassy_force_goes_from_jkr_to_dmt_with_the_tabor_number_of_the_glass():
    short, long = LENS | dict(equilibrium_gap=1e-12), LENS | dict(equilibrium_gap=1e3)
    assert theory.bounds.glassy_force(**short, modulus_ratio=0.1) / FORCE == pytest.approx(
        10, rel=1e-6, abs=0
    )
    assert theory.bounds.glassy_force(**long, modulus_ratio=0.1) / FORCE == pytest.approx(
        40 / 3, rel=1e-6, abs=0
    )
    # mu k^(1/3) = 1.504 at mu = 3.24 and k = 0.1; an independent simulation has 1.0764
    h0 = theory.lennard_jones.tabor_number(**LENS, equilibrium_gap=1.0) / 3.24
    found = theory.bounds.glassy_force(**LENS, equilibrium_gap=h0, modulus_ratio=0.1) / FORCE
    assert found == pytest.approx(10.764, rel=1e-4, abs=0)


def test_the_glassy_force_of_a_small_contact_is_the_fast_limit_by_superposition():
    # P = 4/3 E0* a^3/R - sqrt(8 pi E0* a^3 w/k) below the radius of its minimum
    k = 0.1
    glass = dict(radius=5e-3 / k, contact_modulus=2e6 / k, work_of_adhesion=0.15)
    full = theory.bounds.smallest_full_radius(**LENS, modulus_ratio=k)
    assert full == pytest.approx(theory.jkr.pull_off(**glass).contact_radius, rel=1e-12, abs=0)
    a = full * np.array([0.3, 0.999, 1.0, 2.0])
    found = theory.bounds.glassy_force_at_radius(a, **LENS, modulus_ratio=k)
    assert found[:3] == pytest.approx(-theory.jkr.force(a[:3], **glass), rel=1e-12, abs=0)
    assert found[3] == found[2] == pytest.approx(10 * FORCE, rel=1e-12, abs=0)


def test_the_glassy_work_tends_to_that_of_jkr_and_its_estimate_to_nearly_twice_that():
    k = 0.1
    short = LENS | dict(equilibrium_gap=1e-12)
    expected = k ** (-2 / 3) * theory.jkr.work_to_pull_off(**LENS)
    work = theory.bounds.glassy_work(**short, modulus_ratio=k)
    assert work == pytest.approx(expected, rel=1e-6, abs=0)
    a = theory.bounds.smallest_full_radius(**LENS, modulus_ratio=k)
    estimate = theory.bounds.glassy_work_estimate(a, **LENS)
    assert estimate == pytest.approx(2 * np.pi * a**2 * 0.15, rel=1e-12, abs=0)
    assert estimate / work == pytest.approx(1.80, rel=2e-3, abs=0)


def test_below_the_elastic_force_there_is_no_threshold_radius():
    with pytest.raises(ValueError, match="below the elastic force"):
        theory.bounds.threshold_contact_radius(np.pi * 5e-3 * 0.15, **LENS)


def test_the_readings_of_the_rate_agree_where_they_should():
    mu = 3.24
    # h0 for this Tabor number
    h0 = theory.lennard_jones.tabor_number(**LENS, equilibrium_gap=1.0) / mu
    published = theory.rate.rate_as_published(1e-4 * 0.02 / h0)
    own = theory.rate.rate_in_contact_heights(1e-4, time_unit=0.02, **LENS)
    assert own == pytest.approx(published, rel=1e-12, abs=0)
    height = (np.pi**2 * 0.15**2 * 5e-3 / 2e6**2) ** (1 / 3)
    printed = theory.rate.rate_in_tip_lengths(1e-4, time_unit=0.02, tip_length=height)
    assert printed == pytest.approx(own, rel=1e-12, abs=0)
