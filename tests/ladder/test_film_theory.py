"""JKR on a film: half-space and thin limits, a disc by its compliance, when a film is thick."""

import numpy as np
import pytest

import viscotack as vt
from dimensionless import SOLID
from viscotack.model.geometry import Bonded, Frictionless, HalfSpace, Layer, Sphere
from viscotack.theory import SteadyCrack, disc, film, indenter, jkr
from viscotack.theory.crack.contact import profile_on, recede
from viscotack.theory.elastic import on_body, on_layer

UNITS = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}
BASES = [Frictionless(), *(Bonded(poisson_ratio=nu) for nu in (0.0, 0.3, 0.5))]
SQUEEZED = BASES[-1]
BALL = Sphere(1.0)


@pytest.mark.parametrize("base", BASES, ids=repr)
def test_a_thick_film_pulls_off_as_a_half_space_does(base):
    thick = Layer(100.0, base)
    end = film.pull_off(shape=BALL, body=thick, **UNITS)
    assert end.force == pytest.approx(jkr.pull_off(radius=1.0, **UNITS).force, rel=1e-4)
    fold = film.instability(shape=BALL, body=thick, **UNITS)
    assert fold.depth == pytest.approx(jkr.instability(radius=1.0, **UNITS).depth, rel=1e-2)
    a = np.array([0.5, 2.0])
    stiff = indenter.stiffness(a, contact_modulus=1.0, body=Layer(1e5, base))
    assert stiff == pytest.approx(2 * a, rel=1e-4)
    kendall = disc.pull_off_force(contact_radius=a, body=Layer(1e5, base), **UNITS)
    assert kendall == pytest.approx(np.sqrt(8 * np.pi * a**3), rel=1e-4)


@pytest.mark.parametrize(
    ("base", "thickness"), [*((base, 0.003) for base in BASES[:3]), (SQUEEZED, 2e-4)], ids=repr
)
def test_a_thin_film_pulls_off_at_two_or_three_pi_r_dg(base, thickness):
    end = film.pull_off(shape=BALL, body=Layer(thickness, base), **UNITS)
    limit = film.thin_limit(radius=1.0, work_of_adhesion=1.0, base=base)
    assert limit == pytest.approx((3 if base == SQUEEZED else 2) * np.pi)
    assert -end.force == pytest.approx(limit, rel=1e-2)


@pytest.mark.parametrize("base", BASES, ids=repr)
def test_a_disc_releases_the_energy_of_its_compliance(base):
    a, layer = np.array([0.05, 0.3, 2.0]), Layer(0.2, base)
    inverse = [
        1 / np.asarray(indenter.stiffness(a * x, contact_modulus=3.0, body=layer))
        for x in (0.999, 1.001)
    ]
    force = -0.7 * np.asarray(indenter.stiffness(a, contact_modulus=3.0, body=layer))
    slope = (inverse[1] - inverse[0]) / (0.002 * a)
    found = disc.energy_release_rate(-0.7, contact_radius=a, contact_modulus=3.0, body=layer)
    assert found == pytest.approx(-(force**2) * slope / (4 * np.pi * a), rel=1e-4)


def test_kendall_on_a_thin_film_is_that_of_springs_or_of_a_squeezed_film():
    a = 1.0
    for base in BASES[:3]:
        b = 0.01
        springs = np.pi * a**2 * np.sqrt(2 / (base.foundation * b))
        found = disc.pull_off_force(contact_radius=a, body=Layer(b, base), **UNITS)
        assert found == pytest.approx(springs, rel=1e-2)
    thin = [
        disc.pull_off_force(contact_radius=a, body=Layer(b, SQUEEZED), **UNITS)
        / (np.pi * a**3 * np.sqrt(3 / (32 * b**3)))
        for b in (0.0404, 0.0202, 0.0101)
    ]
    assert np.all(np.diff(thin) < 0) and thin[-1] == pytest.approx(1.0, rel=0.05)
    # the correction is of first order in b/a
    assert 2 * thin[2] - thin[1] == pytest.approx(1.0, rel=1e-2)


def test_the_integral_equation_and_the_influence_matrix_have_the_same_stiffness():
    layer, a = Layer(0.4, BASES[2]), np.array([0.3, 1.0])
    found = indenter.stiffness(a, body=layer, contact_modulus=2.0)
    assert found == pytest.approx(2 * on_body.stiffness(a, layer), rel=5e-4)


def receding(body, rates, start=4.0):
    crack = SteadyCrack(SOLID, vt.LennardJones(1.0, 1.0))
    given = dict(radius=np.full(len(rates), start), rate=np.array(rates), tabor=np.array(8.0))
    found = recede(crack, profile_on(BALL, body), **given)
    return -found.force.min(axis=0)


def test_a_crack_that_recedes_on_a_thick_layer_is_that_on_a_half_space():
    rates = (0.01, 1.0, 100.0)
    thick = receding(Layer(1e4, SQUEEZED), rates)
    assert thick == pytest.approx(receding(HalfSpace(), rates), rel=1e-3)


def test_a_crack_that_recedes_on_a_layer_has_the_limits_of_jkr():
    layer = Layer(0.3, BASES[2])
    slow, fast = receding(layer, (1e-7, 1e8))
    for found, work in ((slow, 1.0), (fast, 10.0)):
        solid = {"contact_modulus": 1.0, "work_of_adhesion": work}
        force = -film.pull_off(shape=BALL, body=layer, **solid).force
        assert found == pytest.approx(force, rel=2e-3)


def test_the_smallest_depth_on_a_thin_incompressible_film_is_found_far_below_beta():
    body = Layer(1e-3, SQUEEZED)
    fold = film.instability(shape=BALL, body=body, **UNITS)
    near = fold.contact_radius * np.array([0.97, 1.03])
    beside = indenter.depth(near, shape=BALL, body=body, **UNITS)
    assert np.all(beside > fold.depth) and fold.depth < -0.03


def test_what_the_theory_of_films_does_not_know_is_refused():
    nearly = Layer(1e-3, Bonded(poisson_ratio=0.499))
    with pytest.raises(ValueError, match="nearly incompressible layer is too wide"):
        film.pull_off(shape=BALL, body=nearly, **UNITS)
    assert on_layer.is_power(Layer(1.0, SQUEEZED)) and not on_layer.is_power(nearly)
    on_layer.check_disc(0.1, Layer(1e-3))
    with pytest.raises(ValueError, match="1000 thicknesses"):
        on_layer.check_disc(1.0, Layer(1e-3))
    with pytest.raises(ValueError, match="use theory.disc"):
        film.instability(shape=vt.Disc(1.0), body=Layer(1.0), **UNITS)
