"""The ladder of adhesion for any profile, of the transition equation and of the adhesion map."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from viscotack.theory import (
    adhesion_map,
    dmt,
    hertz,
    jkr,
    lennard_jones,
    maugis,
    profiles,
    transition,
)

RUBBER = dict(contact_modulus=1.3e6, work_of_adhesion=0.05)
TIP = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05)
RADII = np.array([1e-6, 3e-5, 2e-4])
shapes = pytest.mark.parametrize("exponent", [1.0, 1.7, 2.0, 4.0])


def shape(exponent):
    """A tip that is 50 um high at 1 mm from its axis."""
    return dict(exponent=exponent, coefficient=5e-5 / 1e-3**exponent)


def derivative(function, x):
    """Fourth order in the step: round-off over the step is left, 1e-11."""
    h = 1e-3 * x
    steps = [function(x + i * h) for i in (-2, -1, 1, 2)]
    return (steps[0] - 8 * steps[1] + 8 * steps[2] - steps[3]) / (12 * h)


# Profiles -------------------------------------------------------------------------------------
@shapes
def test_every_profile_is_as_stiff_as_a_punch_of_its_radius(exponent):
    # dP1/d(delta1) = 2 E* a, from which the lift of any shape follows
    case = shape(exponent) | dict(contact_modulus=1.3e6, work_of_adhesion=1e-30)
    stiffness = derivative(lambda x: profiles.force(x, **case), RADII) / derivative(
        lambda x: profiles.depth(x, **case), RADII
    )
    assert stiffness[1:] == pytest.approx(2 * 1.3e6 * RADII[1:], rel=1e-9, abs=0)


def test_the_square_profile_is_jkr():
    case = dict(exponent=2.0, coefficient=1 / 2e-3) | RUBBER
    sphere = dict(radius=1e-3) | RUBBER
    assert profiles.force(RADII, **case) == pytest.approx(
        jkr.force(RADII, **sphere), rel=1e-12, abs=0
    )
    assert profiles.depth(RADII, **case) == pytest.approx(
        jkr.depth(RADII, **sphere), rel=1e-12, abs=0
    )
    for ours, theirs in (
        (profiles.pull_off(**case), jkr.pull_off(**sphere)),
        (profiles.instability(**case), jkr.instability(**sphere)),
    ):
        assert ours == pytest.approx(theirs, rel=1e-12, abs=0)


def test_the_cone_is_that_of_sneddon():
    # depth = (pi/2) A a, force = (pi/2) E* A a^2
    case = dict(exponent=1.0, coefficient=0.1, contact_modulus=1.3e6, work_of_adhesion=1e-30)
    assert profiles.depth(1e-4, **case) == pytest.approx(np.pi / 2 * 1e-5, rel=1e-9, abs=0)
    assert profiles.force(1e-4, **case) == pytest.approx(
        np.pi / 2 * 1.3e6 * 0.1 * 1e-8, rel=1e-9, abs=0
    )


@shapes
def test_the_ends_of_a_profile_are_where_force_and_depth_are_least(exponent):
    case = shape(exponent) | RUBBER
    for end, function in (
        (profiles.pull_off(**case), profiles.force),
        (profiles.instability(**case), profiles.depth),
    ):
        a = end.contact_radius
        assert profiles.force(a, **case) == pytest.approx(end.force, rel=1e-11, abs=0)
        assert profiles.depth(a, **case) == pytest.approx(end.depth, rel=1e-10, abs=0)
        near = function(a * np.array([0.999, 1.0, 1.001]), **case)
        assert near[1] < near[0] and near[1] < near[2]


def test_a_steep_profile_tends_to_the_flat_punch():
    # z = (r/b)^q b with q to infinity is a punch of radius b; the rest falls as ln(q)/q
    b, E, w = 1e-3, *RUBBER.values()
    punch = profiles.punch_pull_off(contact_radius=b, **RUBBER)
    q = np.array([1e4, 1e6])
    # A b^q = 1 um, in one power: b^(-q) alone overflows
    ratio = []
    for exponent in q:
        # scale lengths by b, so that the coefficient is 1e-3
        scaled = profiles.pull_off(
            exponent=exponent, coefficient=1e-3, contact_modulus=E * b**2, work_of_adhesion=w * b
        )
        ratio.append(-scaled.force / np.sqrt(8 * np.pi * E * b**3 * w))
    rest = 1 - np.array(ratio)
    assert np.all(np.abs(rest) < 10 * np.log(q) / q)
    assert punch.force == pytest.approx(-np.sqrt(8 * np.pi * E * b**3 * w), rel=1e-13, abs=0)


# Transition -----------------------------------------------------------------------------------
def test_the_transition_equation_is_jkr_at_one_and_dmt_at_zero():
    for theory, alpha in ((jkr, 1.0), (dmt, 0.0)):
        P_end = theory.pull_off_force(radius=1e-6, work_of_adhesion=0.05)
        P = P_end * np.array([-0.9, -0.2, 0.0, 3.0, 50.0])
        found = transition.contact_radius(
            P,
            contact_radius_without_load=theory.contact_radius_at_force(0.0, **TIP),
            pull_off_force=P_end,
            transition=alpha,
        )
        assert found == pytest.approx(theory.contact_radius_at_force(P, **TIP), rel=1e-12, abs=0)


@pytest.mark.parametrize("lam", [0.03, 0.3, 1.0, 3.0])
def test_the_transition_equation_follows_maugis_within_two_per_cent(lam):
    strength = lam / maugis.maugis_parameter(**TIP, strength=1.0)
    P_end = transition.pull_off_force(lam, radius=1e-6, work_of_adhesion=0.05)
    exact = maugis.pull_off_force(**TIP, strength=strength)
    assert P_end == pytest.approx(exact, rel=0.02, abs=0)
    a0 = transition.contact_radius_without_load(lam, **TIP)
    states = maugis.curve(np.geomspace(1.0001, 50, 4000), **TIP, strength=strength)
    at_zero = np.interp(0.0, states.force[::-1], states.contact_radius[::-1])
    assert a0 == pytest.approx(at_zero, rel=0.02, abs=0)


@given(st.floats(1e-3, 3))
def test_transition_number_and_maugis_parameter_are_inverse(lam):
    assert transition.maugis_parameter(transition.transition(lam)) == pytest.approx(
        lam, rel=1e-9, abs=0
    )


# Adhesion map ---------------------------------------------------------------------------------
def test_on_the_hertz_boundary_tension_is_five_per_cent_of_the_load():
    mu, load = 2.0, adhesion_map.hertz_load(2.0)
    lam = maugis.parameter_from_tabor(mu)
    strength = lam / maugis.maugis_parameter(**TIP, strength=1.0)
    states = maugis.curve(1 + np.geomspace(1e-8, 1, 20000), **TIP, strength=strength)
    unit = np.pi * 1e-6 * 0.05
    a = np.interp(load * unit, states.force[::-1], states.contact_radius[::-1])
    bare = hertz.force(a, radius=1e-6, contact_modulus=1e9)
    # linear interpolation between the states
    assert (bare / unit - load) / load == pytest.approx(0.05, rel=1e-4, abs=0)


def test_on_the_jkr_boundary_the_surface_is_lifted_by_twenty_gaps():
    mu = 4.0
    # scales in which R = w = E* = 1: h0 = mu^-1
    h0 = 1 / mu
    unit = dict(radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0)
    strength = maugis.parameter_from_tabor(mu) / maugis.maugis_parameter(**unit, strength=1.0)
    states = maugis.curve(1 + np.geomspace(1e-9, 1, 40000), **unit, strength=strength)
    for load, lift in ((adhesion_map.jkr_load(mu), 20.0),):
        a = np.interp(load * np.pi, states.force[::-1], states.contact_radius[::-1])
        d = np.interp(load * np.pi, states.force[::-1], states.depth[::-1])
        assert (a**2 - d) / h0 == pytest.approx(lift, rel=1e-4, abs=0)


def test_the_rigid_boundary_is_where_dmt_compresses_a_twentieth_of_the_gap():
    mu = 0.02
    load = adhesion_map.rigid_load(mu) * np.pi
    unit = dict(radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0)
    a = dmt.contact_radius_at_force(load, **unit)
    assert dmt.depth(a, radius=1.0) == pytest.approx(0.05 / mu, rel=1e-9, abs=0)


def test_the_map_names_a_regime_everywhere():
    w, h0 = 0.05, 1e-9

    def at(mu, load):
        return adhesion_map.regime(
            load * np.pi * 1e-6 * w,
            radius=1e-6,
            contact_modulus=w * np.sqrt(1e-6 / (mu * h0) ** 3),
            work_of_adhesion=w,
            equilibrium_gap=h0,
        )

    for mu, load, name in (
        (20.0, 10.0, "jkr"),
        (1.0, 10.0, "maugis"),
        (0.005, 20.0, "dmt"),
        (0.005, -1.0, "rigid"),
        (1.0, 5000.0, "hertz"),
    ):
        assert at(mu, load) == name
    lam = adhesion_map.dmt_load(np.array([0.001, 0.05, 10.0]))
    assert lam[2] == pytest.approx(-1.5, rel=0.01, abs=0) and np.all(np.diff(lam[1:]) < 0)


# Lennard-Jones --------------------------------------------------------------------------------

# P/(1.5 pi R w) by an independent simulation of Maghami's equations, to 1e-4
INDEPENDENT = {0.04: 1.3279, 0.16: 1.2936, 0.5: 1.1916, 0.8: 1.1376, 1.504: 1.0764, 3.24: 1.0309}


def test_the_elastic_table_agrees_with_an_independent_simulation():
    for mu, force in INDEPENDENT.items():
        assert lennard_jones.pull_off_ratio(mu) == pytest.approx(force, rel=1.5e-4, abs=0)
    # its work is less certain
    assert lennard_jones.work_ratio(3.24) == pytest.approx(
        0.8441 * 3.24 * np.pi ** (2 / 3), rel=2e-3, abs=0
    )


def test_the_elastic_table_falls_smoothly_from_bradley_to_jkr():
    mu = np.geomspace(1e-5, 1e5, 4001)
    f = lennard_jones.pull_off_ratio(mu)
    assert np.all(np.diff(f) < 0)
    assert f[0] == pytest.approx(4 / 3, rel=1e-6, abs=0)
    assert f[-1] == pytest.approx(1, rel=1e-8, abs=0)
    # the powers of the approach: mu^1.5 below, mu^-2 with a logarithm above
    for side, expected, margin in ((mu[:200], 1.5, 1e-6), (mu[-200:], -2.0, 0.15)):
        rest = (
            4 / 3 - lennard_jones.pull_off_ratio(side)
            if expected > 0
            else (lennard_jones.pull_off_ratio(side) - 1)
        )
        slope = np.polyfit(np.log(side), np.log(rest), 1)[0]
        assert slope == pytest.approx(expected, abs=margin)
    # no step where table and limits join
    for edge in (0.01, 10.0):
        pair = lennard_jones.pull_off_ratio(edge * np.array([1 - 1e-9, 1 + 1e-9]))
        assert pair[0] == pytest.approx(pair[1], rel=1e-8, abs=0)
        pair = lennard_jones.work_ratio(edge * np.array([1 - 1e-9, 1 + 1e-9]))
        assert pair[0] == pytest.approx(pair[1], rel=1e-8, abs=0)


def test_the_elastic_work_goes_from_bradley_to_jkr_and_stays_above_it():
    mu = np.geomspace(1e-4, 1e4, 200)
    work = lennard_jones.work_ratio(mu)
    limit = jkr.work_to_pull_off(radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0)
    # in 1.5 pi R w h0 with h0 = 1/mu
    jkr_work = limit * mu / (1.5 * np.pi)
    assert work[0] == pytest.approx(2 * (8 * 2 ** (1 / 3) - 9) / 10.5, rel=1e-4, abs=0)
    assert work[-1] == pytest.approx(jkr_work[-1], rel=1e-5, abs=0)
    assert np.all(work > jkr_work)
