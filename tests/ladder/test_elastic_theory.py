"""The ladder of the elastic theories: identities, and limits with their exponents."""

import mpmath as mp
import numpy as np
import pytest
from scipy.special import ellipe

from dimensionless import last_slope
from viscotack.theory import bradley, dmt, hertz, jkr, maugis

# A glass bead of 1 mm on soft rubber; a 1 um tip on a stiffer one, in the middle of Maugis' range.
BEAD = dict(radius=1e-3, contact_modulus=1.3e6, work_of_adhesion=0.05)
TIP = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, strength=2e7)
RIGID = dict(radius=1e-6, work_of_adhesion=0.05, equilibrium_gap=3e-10)

NODES, WEIGHTS = np.polynomial.legendre.leggauss(80)


def integral(function, low, high):
    """Gauss quadrature after x = sin: exact to round-off with inverse roots at both ends."""
    angle = np.pi / 2 * NODES
    x = (low + high) / 2 + (high - low) / 2 * np.sin(angle)
    return np.sum(function(x) * WEIGHTS * np.cos(angle)) * np.pi / 2 * (high - low) / 2


def disc_displacement(pressure, edge, position, contact_modulus):
    """Displacement under a pressure on a disc, by Sneddon's pair of Abel transforms."""

    def inner(x):
        reach = np.sqrt(edge**2 - x**2)
        return integral(lambda y: pressure(np.hypot(x, y)), 0, reach)

    def outer(x):
        return np.array([inner(point) for point in x]) / np.sqrt(position**2 - x**2)

    return 4 / (np.pi * contact_modulus) * integral(outer, 0, min(position, edge))


def uniform_displacement(r, c, strength, contact_modulus):
    """Displacement inside a disc under uniform pressure."""
    return 4 * strength * c / (np.pi * contact_modulus) * ellipe((r / c) ** 2)


# Hertz and JKR --------------------------------------------------------------------------------
# The quadrature loses digits where the tension of JKR grows without bound.
@pytest.mark.parametrize(
    ("theory", "form", "stiff", "within"),
    [(hertz, ["radius"], ["radius", "contact_modulus"], 1e-11), (jkr, [*BEAD], [*BEAD], 3e-9)],
    ids=["hertz", "jkr"],
)
@pytest.mark.parametrize("position", [1e-6, 0.999e-4, 1.7e-4])
def test_a_surface_is_what_its_pressure_does_to_the_half_space(
    theory, form, stiff, within, position
):
    shape, solid = ({name: BEAD[name] for name in names} for names in (form, stiff))
    u = disc_displacement(
        lambda r: theory.pressure(r, contact_radius=1e-4, **solid), 1e-4, position, 1.3e6
    )
    found = theory.surface_displacement(position, contact_radius=1e-4, **shape)
    assert found == pytest.approx(u, rel=within, abs=0)
    opening = position**2 / 2e-3 - theory.depth(1e-4, **shape) + u
    gap = theory.gap(position, contact_radius=1e-4, **shape)
    assert gap == pytest.approx(opening, rel=1e-9, abs=1e-16)


def test_hertz_force_is_the_derivative_of_its_energy():
    # U = (8/15) E* sqrt(R) depth^(5/2), so that P = 5 U / (2 depth)
    a = np.array([1e-6, 1e-4, 2e-4])
    d = hertz.depth(a, radius=1e-3)
    energy = 8 / 15 * 1.3e6 * np.sqrt(1e-3) * d**2.5
    P = hertz.force(a, radius=1e-3, contact_modulus=1.3e6)
    np.testing.assert_allclose(P, 2.5 * energy / d, rtol=1e-14)


def test_jkr_gap_opens_as_a_crack():
    # Irwin: one face moves by (4 K / E*) sqrt(x / 2 pi), K = sqrt(2 E* w); the other is rigid
    step = np.array([1e-8, 1e-10, 1e-12])
    gap = jkr.gap(1e-4 * (1 + step), contact_radius=1e-4, **BEAD)
    assert last_slope(step, gap) == pytest.approx(0.5, abs=1e-4)
    irwin = 4 / 1.3e6 * np.sqrt(2 * 1.3e6 * 0.05) * np.sqrt(1e-4 * step / (2 * np.pi))
    np.testing.assert_allclose(gap[-1], irwin[-1], rtol=1e-4)


def test_jkr_branches_return_depth_and_force():
    end, fold = jkr.pull_off(**BEAD), jkr.instability(**BEAD)
    d = np.concatenate([fold.depth * np.array([1, 0.999, 0.5, 1e-9]), [0, 1e-12, 1e-5, 1e-2]])
    a = jkr.contact_radius_at_depth(d, **BEAD)
    np.testing.assert_allclose(jkr.depth(a, **BEAD), d, rtol=1e-12, atol=1e-14 * abs(fold.depth))
    assert np.all(a >= fold.contact_radius * (1 - 1e-12))
    P = np.concatenate([end.force * np.array([1, 0.999, 0.5, 1e-9]), [0, 1e-12, 1e-3]])
    a = jkr.contact_radius_at_force(P, **BEAD)
    np.testing.assert_allclose(jkr.force(a, **BEAD), P, rtol=1e-12, atol=1e-14 * abs(end.force))
    assert np.all(a >= end.contact_radius * (1 - 1e-12))


# DMT and Bradley ------------------------------------------------------------------------------
def test_dmt_force_is_the_derivative_of_its_energy():
    # U = (8/15) E* sqrt(R) depth^(5/2) - 2 pi R w depth
    R, E, w = BEAD.values()
    a = np.geomspace(1e-6, 3e-4, 5)
    d = dmt.depth(a, radius=R)
    slope_of_energy = 4 / 3 * E * np.sqrt(R) * d**1.5 - 2 * np.pi * R * w
    np.testing.assert_allclose(dmt.force(a, **BEAD), slope_of_energy, rtol=1e-12)
    np.testing.assert_allclose(dmt.contact_radius_at_depth(d, radius=R), a, rtol=1e-14)
    found = dmt.contact_radius_at_force(dmt.force(a, **BEAD), **BEAD)
    np.testing.assert_allclose(found, a, rtol=1e-6)
    np.testing.assert_allclose(found[2:], a[2:], rtol=1e-12)
    end = -dmt.pull_off_force(radius=R, work_of_adhesion=w)
    assert dmt.contact_radius_at_force(end, **BEAD) == 0


def test_bradley_force_is_the_integral_of_the_traction():
    R, w, h0 = RIGID.values()
    for depth in (-5e-10, -1e-10, 0.0, 5e-11):
        # r dr = R dh over the gap h, and u = (h0/h)^2 makes the range finite
        def pull(u):
            traction = 8 * w / (3 * h0) * (u**1.5 - u**4.5)
            return 2 * np.pi * R * traction * h0 / (2 * u**1.5)

        total = integral(pull, 0, (h0 / (h0 - depth)) ** 2)  # noqa: B023
        assert bradley.force(depth, **RIGID) == pytest.approx(-total, rel=1e-12, abs=0)


# Maugis ---------------------------------------------------------------------------------------
@pytest.mark.parametrize("ratio", [1.2, 1.7, 4.0])
def test_maugis_state_solves_the_contact_problem(ratio):
    R, E, w, s = TIP.values()
    state = maugis.curve(ratio, **TIP)
    a, c = state.contact_radius, state.cohesive_radius
    known = dict(contact_radius=a, cohesive_radius=c, radius=R, contact_modulus=E, strength=s)

    def pressed(r):
        return maugis.pressure(r, **known) + s

    # uniform tension on the whole disc c, the rest on the contact
    load = integral(lambda r: 2 * np.pi * r * pressed(r), 0, a) - np.pi * c**2 * s
    assert load == pytest.approx(state.force, rel=1e-11, abs=0)
    for r in (0.3 * a, 0.9 * a):
        u = disc_displacement(pressed, a, r, E) - uniform_displacement(r, c, s, E)
        assert u == pytest.approx(state.depth - r**2 / (2 * R), rel=1e-9, abs=0)
    u = disc_displacement(pressed, a, c, E) - uniform_displacement(c, c, s, E)
    gap = c**2 / (2 * R) - state.depth + u
    assert gap * s == pytest.approx(w, rel=1e-9, abs=0)
    assert maugis.pressure(0.5 * (a + c), **known) == -s
    assert maugis.pressure(1.01 * c, **known) == 0


@pytest.mark.parametrize("strength", [2e5, 2e7, 2e9])
def test_maugis_state_keeps_its_digits_from_a_thin_ring_to_a_point(strength):
    # the equations as printed by Maugis, in 50 digits, at the state found
    mp.mp.dps = 50
    case = TIP | dict(strength=strength)
    R, E, w, s = (mp.mpf(x) for x in case.values())
    K = 4 * E / 3
    lam = 2 * s * mp.cbrt(R / (mp.pi * w * K**2))
    for ratio in (1 + 1e-8, 1 + 1e-5, 1.002, 1.0198, 1.0199, 1.03, 3.0, 1e3):
        state = maugis.curve(ratio, **case)
        m = mp.mpf(ratio)
        root, angle = mp.sqrt(m**2 - 1), mp.asec(m)
        A = lam / 2 * (root + (m**2 - 2) * angle)
        B = 4 * lam**2 / 3 * (root * angle - m + 1)
        a = 2 / (B + mp.sqrt(B**2 + 4 * A))
        P = a**3 - lam * a**2 * (root + m**2 * angle)
        d = a**2 - 4 * lam / 3 * a * root
        radius, load = a * mp.cbrt(mp.pi * w * R**2 / K), P * mp.pi * w * R
        depth = d * mp.cbrt(mp.pi**2 * w**2 * R / K**2)
        assert state.contact_radius == pytest.approx(float(radius), rel=1e-13, abs=0)
        assert state.force == pytest.approx(float(load), rel=1e-12, abs=0)
        assert state.depth == pytest.approx(float(depth), rel=1e-12, abs=0)


def test_maugis_state_without_contact_solves_its_problem():
    R, E, w, s = TIP.values()
    touching = maugis.touching_radius(**TIP)
    for c in touching * np.array([0.2, 0.7, 1.0]):
        state = maugis.curve_without_contact(c, **TIP)
        centre = -state.depth - uniform_displacement(0, c, s, E)
        edge = c**2 / (2 * R) - state.depth - uniform_displacement(c, c, s, E)
        assert edge * s == pytest.approx(w, rel=1e-12, abs=0)
        assert state.force == pytest.approx(-np.pi * c**2 * s, rel=1e-14, abs=0)
        assert centre >= -1e-12 * edge
    assert centre == pytest.approx(0, abs=1e-12 * edge)


def test_maugis_curves_join_where_the_contact_is_a_point():
    joint = maugis.curve_without_contact(maugis.touching_radius(**TIP), **TIP)
    ratio = np.array([1e3, 1e4, 1e5])
    state = maugis.curve(ratio, **TIP)
    assert last_slope(ratio, state.cohesive_radius - joint.cohesive_radius) == pytest.approx(
        -2, abs=0.01
    )
    assert last_slope(ratio, state.force - joint.force) == pytest.approx(-2, abs=0.01)
    np.testing.assert_allclose(state.depth[-1], joint.depth, rtol=1e-4)
    np.testing.assert_allclose(state.force[-1], joint.force, rtol=1e-8)


@pytest.mark.parametrize("strength", [2e5, 2e7, 2e9])
def test_maugis_pull_off_is_the_minimum_of_its_curve(strength):
    case = TIP | dict(strength=strength)
    end = maugis.pull_off(**case)
    excess = end.cohesive_radius / end.contact_radius - 1
    below, here, above = maugis.curve(1 + excess * np.array([0.999, 1, 1.001]), **case).force
    assert here == pytest.approx(end.force, rel=1e-12, abs=0)
    assert below > here < above
    everywhere = maugis.curve(1 + np.geomspace(1e-7, 1e7, 400), **case).force
    assert np.all(everywhere >= end.force)
    assert maugis.pull_off_force(**case) == -end.force
    assert np.sum(np.diff(np.sign(np.diff(everywhere))) != 0) == 1


def test_maugis_tends_to_jkr_with_the_square_of_its_parameter():
    strength = np.array([1e9, 4e9, 16e9])
    end = maugis.pull_off(**TIP | dict(strength=strength))
    case = {name: TIP[name] for name in ("radius", "contact_modulus", "work_of_adhesion")}
    goal = jkr.pull_off(**case)
    for name in ("contact_radius", "depth", "force"):
        rest = getattr(end, name) - getattr(goal, name)
        assert last_slope(strength, rest) == pytest.approx(-2, abs=1e-3), name
    work = maugis.work_to_pull_off(**TIP | dict(strength=strength)) - jkr.work_to_pull_off(**case)
    assert last_slope(strength, work) == pytest.approx(-2, abs=2e-3)
