"""The JKR contact of a start: of every shape by one function, and none beyond the ends of JKR."""

import numpy as np
import pytest

import viscotack as vt
from viscotack.model.geometry import Cone, PowerLawProfile, Sphere
from viscotack.theory import jkr, profiles, wavy
from viscotack.theory.elastic import indenter, relaxed

LENS = {"contact_modulus": 2e6, "work_of_adhesion": 0.15}
SPHERE = {"radius": 5e-3, **LENS}


class Unknown:
    """A shape that says how steep it is, and nothing of its kind: it has no closed forms."""

    def __init__(self, shape):
        self.gap, self.flank = shape.gap, shape.flank


SHAPES = [
    vt.Sphere(5e-3),
    vt.PowerLawProfile(exponent=2.0, coefficient=100.0),
    Unknown(vt.Sphere(5e-3)),
]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("radius", [2.2e-4, 2e-3])
def test_a_start_by_depth_force_or_radius_is_one_contact_for_every_form_of_a_shape(shape, radius):
    d, P = jkr.depth(radius, **SPHERE), jkr.force(radius, **SPHERE)
    for start in (vt.AtDepth(d), vt.AtForce(P), vt.AtRadius(radius)):
        np.testing.assert_allclose(
            relaxed.contact(start, shape=shape, **LENS), (radius, d, P), rtol=1e-9
        )


FOLD, END = jkr.instability(**SPHERE), jkr.pull_off(**SPHERE)


@pytest.mark.parametrize("shape", SHAPES)
def test_every_form_of_a_shape_lets_go_at_the_same_contacts(shape):
    np.testing.assert_allclose(relaxed.ends(shape, **LENS), (FOLD, END), rtol=2e-5)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(
    "inside, outside",
    [
        (vt.AtDepth(0.99 * FOLD.depth), vt.AtDepth(1.000001 * FOLD.depth)),
        (vt.AtForce(0.99 * END.force), vt.AtForce(1.000001 * END.force)),
        (vt.AtRadius(1.05 * FOLD.contact_radius), vt.AtRadius(0.95 * FOLD.contact_radius)),
    ],
)
def test_a_start_beyond_the_end_of_its_branch_has_no_contact(shape, inside, outside):
    assert relaxed.contact(inside, shape=shape, **LENS) is not None
    assert relaxed.contact(outside, shape=shape, **LENS) is None
    assert relaxed.contact(vt.Apart(1e-6), shape=shape, **LENS) is None


@pytest.mark.parametrize(
    "shape", [vt.Cone(slope=0.1), vt.PowerLawProfile(exponent=3.0, coefficient=1e3)]
)
def test_a_power_law_starts_on_its_closed_form(shape):
    of = {"exponent": shape.exponent, "coefficient": shape.coefficient, **LENS}
    depth, force = relaxed.curve(shape, **LENS)
    assert force(relaxed.largest_radius(force, 1e-3, length=1e-4)) == pytest.approx(1e-3, rel=1e-9)
    assert relaxed.largest_radius(depth, -1.0, length=1e-4) is None
    for start in (vt.AtDepth(2e-5), vt.AtForce(1e-3)):
        found = relaxed.contact(start, shape=shape, **LENS)
        assert profiles.depth(found.contact_radius, **of) == pytest.approx(found.depth, rel=1e-9)
        assert profiles.force(found.contact_radius, **of) == pytest.approx(found.force, rel=1e-9)


WORN = vt.MeasuredProfile(((0.0, 0.0), (1e-4, 0.0), (2e-4, 1e-6), (3e-4, 3e-6)))


@pytest.mark.parametrize("start", [vt.AtDepth(1e-7), vt.AtRadius(1.5e-4)])
def test_a_worn_tip_on_a_thin_layer_has_a_contact_at_its_start(start):
    layer = vt.Layer(1e-5, vt.Bonded(poisson_ratio=0.3))
    case = dict(shape=WORN, body=layer, contact_modulus=1e6, work_of_adhesion=0.05)
    found = relaxed.contact(start, **case)
    assert found.depth == pytest.approx(indenter.depth(found.contact_radius, **case), rel=1e-8)
    assert found.force == pytest.approx(indenter.force(found.contact_radius, **case), rel=1e-8)
    (wanted,) = vars(start).values()
    assert wanted in found


def test_a_wavy_sphere_lets_go_at_the_lowest_of_its_minima():
    waves = dict(amplitude=2e-7, wavelength=4e-5)
    end = wavy.pull_off(radius=5e-3, **waves, **LENS)
    assert end.force < 1.25 * jkr.pull_off(**SPHERE).force
    _, found = relaxed.ends(vt.WavySphere(5e-3, **waves), **LENS)
    assert found.force == pytest.approx(end.force, rel=1e-6)


def test_the_strongest_contact_is_the_pull_off_or_the_start_itself():
    end = jkr.pull_off(**SPHERE)
    found = relaxed.strongest(vt.Sphere(5e-3), largest=3 * end.contact_radius, **LENS)
    assert found.force == pytest.approx(end.force, rel=1e-8)
    small = 0.5 * end.contact_radius
    found = relaxed.strongest(vt.Sphere(5e-3), largest=small, **LENS)
    assert found == pytest.approx((small, jkr.depth(small, **SPHERE), jkr.force(small, **SPHERE)))


def test_dimensionless_starts_are_those_of_the_same_test_in_si():
    h0 = 1e-6
    mu = (5e-3 * (0.15 / 2e6) ** 2 / h0**3) ** (1 / 3)
    beta = (5e-3**2 * 0.15 / 2e6) ** (1 / 3)
    load = 1.5 * np.pi * 5e-3 * 0.15
    for groups, si in (
        (vt.AtDepth(20.0), vt.AtDepth(20.0 * h0)),
        (vt.AtForce(-0.5), vt.AtForce(-0.5 * load)),
        (vt.AtRadius(2.0), vt.AtRadius(2.0 * np.pi ** (1 / 3) * beta)),
    ):
        found, same = (
            relaxed.contact_in_groups(groups, tabor=mu),
            relaxed.contact(si, shape=vt.Sphere(5e-3), **LENS),
        )
        units = (beta, beta**2 / 5e-3, 5e-3 * 0.15)
        np.testing.assert_allclose(np.multiply(found, units), same, rtol=1e-12)


def test_large_starts_have_the_radius_without_adhesion_at_any_depth():
    for start in (
        vt.AtDepth(1e8),
        vt.AtDepth(1e90),
        vt.AtDepth(1e250),
        vt.AtForce(1e8),
        vt.AtForce(1e250),
    ):
        found = relaxed.contact_in_groups(start, tabor=3.0).contact_radius / np.pi ** (1 / 3)
        assert found == pytest.approx(relaxed.radius_without_adhesion(start, tabor=3.0), rel=1e-3)


# JKR by quadrature of any profile, against the closed forms of spheres and power laws.
SOLID = {"contact_modulus": 2e6, "work_of_adhesion": 0.05}
RADII = np.geomspace(1e-6, 3e-4, 7)
TIPS = [Cone(0.2), PowerLawProfile(7.0, 1.5), PowerLawProfile(5e7, 3.0)]


def test_a_sphere_has_the_depth_the_force_and_the_gap_of_jkr():
    sphere = {"radius": 1e-3, **SOLID}
    shape = Unknown(Sphere(1e-3))
    for name in ("depth", "force"):
        found = getattr(indenter, name)(RADII, shape=shape, **SOLID)
        scale = np.abs(getattr(jkr, name)(RADII, **sphere)).max()
        np.testing.assert_allclose(
            found, getattr(jkr, name)(RADII, **sphere), rtol=1e-12, atol=1e-13 * scale
        )
    r = 1e-4 * np.array([0.5, 1.0, 1.001, 1.1, 2.0, 30.0])
    found = indenter.gap(r, contact_radius=1e-4, shape=shape, **SOLID)
    exact = jkr.gap(r, contact_radius=1e-4, **sphere)
    np.testing.assert_allclose(found, exact, rtol=1e-9, atol=1e-12 * exact.max())


@pytest.mark.parametrize("tip", TIPS, ids=["cone", "1.5", "cubic"])
def test_power_laws_have_their_closed_forms(tip):
    closed = {"exponent": tip.exponent, "coefficient": tip.coefficient, **SOLID}
    for name in ("depth", "force"):
        exact = getattr(profiles, name)(RADII, **closed)
        found = getattr(indenter, name)(RADII, shape=Unknown(tip), **SOLID)
        np.testing.assert_allclose(found, exact, rtol=1e-6, atol=1e-6 * np.abs(exact).max())
