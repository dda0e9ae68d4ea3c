"""The JKR contact of a start: of every shape by one function, and none beyond the ends of JKR."""

import numpy as np
import pytest

from viscotack import (
    Apart,
    AtDepth,
    AtForce,
    AtRadius,
    Bonded,
    Cone,
    Layer,
    MeasuredProfile,
    PowerLawProfile,
    Sphere,
    WavySphere,
)
from viscotack.theory import jkr, profiles, wavy
from viscotack.theory.elastic import indenter
from viscotack.theory.elastic.relaxed import (
    contact,
    contact_in_groups,
    curve,
    ends,
    largest_radius,
    radius_without_adhesion,
    strongest,
)

LENS = {"contact_modulus": 2e6, "work_of_adhesion": 0.15}
SPHERE = {"radius": 5e-3, **LENS}


class Paraboloid:
    """A shape without closed forms: that of the lens."""

    def gap(self, position):
        return np.asarray(position) ** 2 / 1e-2

    def flank(self, position):
        return np.asarray(position) / 5e-3


SHAPES = [Sphere(5e-3), PowerLawProfile(exponent=2.0, coefficient=100.0), Paraboloid()]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("radius", [2.2e-4, 2e-3])
def test_a_start_by_depth_force_or_radius_is_one_contact_for_every_form_of_a_shape(shape, radius):
    d, P = jkr.depth(radius, **SPHERE), jkr.force(radius, **SPHERE)
    for start in (AtDepth(d), AtForce(P), AtRadius(radius)):
        np.testing.assert_allclose(contact(start, shape=shape, **LENS), (radius, d, P), rtol=1e-9)


FOLD, END = jkr.instability(**SPHERE), jkr.pull_off(**SPHERE)


@pytest.mark.parametrize("shape", SHAPES)
def test_every_form_of_a_shape_lets_go_at_the_same_contacts(shape):
    np.testing.assert_allclose(ends(shape, **LENS), (FOLD, END), rtol=2e-5)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(
    "inside, outside",
    [
        (AtDepth(0.99 * FOLD.depth), AtDepth(1.000001 * FOLD.depth)),
        (AtForce(0.99 * END.force), AtForce(1.000001 * END.force)),
        (AtRadius(1.05 * FOLD.contact_radius), AtRadius(0.95 * FOLD.contact_radius)),
    ],
)
def test_a_start_beyond_the_end_of_its_branch_has_no_contact(shape, inside, outside):
    assert contact(inside, shape=shape, **LENS) is not None
    assert contact(outside, shape=shape, **LENS) is None
    assert contact(Apart(1e-6), shape=shape, **LENS) is None


@pytest.mark.parametrize("shape", [Cone(slope=0.1), PowerLawProfile(exponent=3.0, coefficient=1e3)])
def test_a_power_law_starts_on_its_closed_form(shape):
    of = {"exponent": shape.exponent, "coefficient": shape.coefficient, **LENS}
    depth, force = curve(shape, **LENS)
    assert force(largest_radius(force, 1e-3, length=1e-4)) == pytest.approx(1e-3, rel=1e-9)
    assert largest_radius(depth, -1.0, length=1e-4) is None
    for start in (AtDepth(2e-5), AtForce(1e-3)):
        found = contact(start, shape=shape, **LENS)
        assert profiles.depth(found.contact_radius, **of) == pytest.approx(found.depth, rel=1e-9)
        assert profiles.force(found.contact_radius, **of) == pytest.approx(found.force, rel=1e-9)


WORN = MeasuredProfile(((0.0, 0.0), (1e-4, 0.0), (2e-4, 1e-6), (3e-4, 3e-6)))


@pytest.mark.parametrize("start", [AtDepth(1e-7), AtRadius(1.5e-4)])
def test_a_worn_tip_on_a_thin_layer_has_a_contact_at_its_start(start):
    layer = Layer(1e-5, Bonded(poisson_ratio=0.3))
    case = dict(shape=WORN, body=layer, contact_modulus=1e6, work_of_adhesion=0.05)
    found = contact(start, **case)
    assert found.depth == pytest.approx(indenter.depth(found.contact_radius, **case), rel=1e-8)
    assert found.force == pytest.approx(indenter.force(found.contact_radius, **case), rel=1e-8)
    (wanted,) = vars(start).values()
    assert wanted in found


def test_a_wavy_sphere_lets_go_at_the_lowest_of_its_minima():
    waves = dict(amplitude=2e-7, wavelength=4e-5)
    end = wavy.pull_off(radius=5e-3, **waves, **LENS)
    assert end.force < 1.25 * jkr.pull_off(**SPHERE).force
    _, found = ends(WavySphere(5e-3, **waves), **LENS)
    assert found.force == pytest.approx(end.force, rel=1e-6)


def test_the_strongest_contact_is_the_pull_off_or_the_start_itself():
    end = jkr.pull_off(**SPHERE)
    found = strongest(Sphere(5e-3), largest=3 * end.contact_radius, **LENS)
    assert found.force == pytest.approx(end.force, rel=1e-8)
    small = 0.5 * end.contact_radius
    found = strongest(Sphere(5e-3), largest=small, **LENS)
    assert found == pytest.approx((small, jkr.depth(small, **SPHERE), jkr.force(small, **SPHERE)))


def test_dimensionless_starts_are_those_of_the_same_test_in_si():
    h0 = 1e-6
    mu = (5e-3 * (0.15 / 2e6) ** 2 / h0**3) ** (1 / 3)
    beta = (5e-3**2 * 0.15 / 2e6) ** (1 / 3)
    load = 1.5 * np.pi * 5e-3 * 0.15
    for groups, si in (
        (AtDepth(20.0), AtDepth(20.0 * h0)),
        (AtForce(-0.5), AtForce(-0.5 * load)),
        (AtRadius(2.0), AtRadius(2.0 * np.pi ** (1 / 3) * beta)),
    ):
        found, same = contact_in_groups(groups, tabor=mu), contact(si, shape=Sphere(5e-3), **LENS)
        units = (beta, beta**2 / 5e-3, 5e-3 * 0.15)
        np.testing.assert_allclose(np.multiply(found, units), same, rtol=1e-12)


def test_large_starts_have_the_radius_without_adhesion_at_any_depth():
    for start in (AtDepth(1e8), AtDepth(1e90), AtDepth(1e250), AtForce(1e8), AtForce(1e250)):
        found = contact_in_groups(start, tabor=3.0).contact_radius / np.pi ** (1 / 3)
        assert found == pytest.approx(radius_without_adhesion(start, tabor=3.0), rel=1e-3)
