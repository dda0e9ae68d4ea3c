"""Advice on films, discs and profiles: limits by theory, thickness of a half-space, saturation."""

import numpy as np
import pytest

import viscotack as vt
from dimensionless import SOLID
from viscotack.prediction import other_contacts
from viscotack.theory import disc, film

GLUED = vt.Bonded(poisson_ratio=0.49)
UNITS = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}
LOAD = 1.5 * np.pi


def groups(body, *, tabor=50.0, rate=10.0, start=None, **more):
    return vt.Groups(tabor, SOLID, start or vt.AtRadius(4.0), rate, body=body, **more)


def row(advice, tier):
    return next(e for e in advice.estimates if e.tier == tier)


def test_a_film_in_si_is_as_thick_in_the_groups_as_in_radii_of_the_contact():
    film_of_gel = vt.Problem(
        vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1.0, poisson_ratio=0.49),
        vt.LennardJones(0.05, 1e-6),
        vt.Sphere(2e-3),
        vt.Retraction(vt.AtDepth(1e-6), 1e-5),
        body=vt.Layer(60e-6, GLUED),
    )
    beta = (2e-3**2 * 0.05 / film_of_gel.material.contact_modulus) ** (1 / 3)
    body = film_of_gel.groups().body
    assert (body.thickness, body.base) == (pytest.approx(60e-6 / beta), GLUED)


@pytest.fixture(scope="module", autouse=True)
def one_tolerance():
    """Look for one thickness of a half-space, which takes most of the time of an advice."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(other_contacts, "TOLERANCES", (0.05,))
        other_contacts._thicknesses_of.cache_clear()
        yield
    other_contacts._thicknesses_of.cache_clear()


@pytest.fixture(scope="module")
def thin():
    return vt.advise(groups(vt.Layer(0.5, GLUED)))


def test_the_limits_of_a_film_are_those_of_jkr(thin):
    layer, contact = vt.Layer(0.5, GLUED), thin.contact
    for work, found in ((1.0, contact.slow_force), (10.0, contact.fast_force)):
        solid = {"contact_modulus": 1.0, "work_of_adhesion": work}
        force = -film.pull_off(shape=vt.Sphere(1.0), body=layer, **solid).force
        assert found == pytest.approx(force / LOAD, rel=1e-4)
    # the thickness of a half-space by its definition
    (thick,) = contact.half_space_thickness
    forces = [
        film.pull_off(shape=vt.Sphere(1.0), body=body, **UNITS).force
        for body in (vt.Layer(thick, GLUED), vt.HalfSpace())
    ]
    assert abs(forces[0] / forces[1] - 1) == pytest.approx(0.05, rel=1e-3)


def test_a_film_that_cannot_be_compressed_is_sheared_by_what_flows_out_under_the_sphere(thin):
    # the slope at the base of the parabola that carries the displaced volume sideways
    a, b = 4 * np.pi ** (1 / 3), 0.5
    r = np.linspace(1e-3, a, 10_000)
    volume = np.pi * r**2 * (a**2 - r**2) / 4
    strain = np.max(3 * volume / (2 * np.pi * r * b**2))
    assert thin.contact.film_strain == pytest.approx(strain, rel=1e-6)


def test_a_thick_film_saturates_as_a_half_space_and_a_thin_one_sooner(thin):
    thick = vt.advise(groups(vt.Layer(100.0, GLUED))).contact
    assert thick.over_half_space == pytest.approx(1.0, rel=1e-4)
    assert thick.saturation_rate == pytest.approx(thick.half_space_saturation_rate, rel=1e-2)
    rate = thin.contact.half_space_saturation_rate
    assert rate == pytest.approx(thick.half_space_saturation_rate, rel=1e-6)
    assert thin.contact.saturation_rate < 0.6 * rate


def test_the_receding_crack_on_a_film_meets_its_limits_in_speed(thin):
    slow, fast = (vt.advise(groups(vt.Layer(0.5, GLUED), rate=rate)) for rate in (1e-6, 1e8))
    found = [slow, thin, fast]
    forces = [row(each, "receding crack").pull_off_force for each in found]
    assert forces[0] == pytest.approx(found[0].contact.slow_force, rel=1e-2)
    assert forces[2] == pytest.approx(found[2].contact.fast_force, rel=1e-2)
    regimes = [each.rate_regime for each in found]
    assert regimes == ["quasi-static", "rate-dependent", "glassy"]


@pytest.mark.parametrize("base", [GLUED, pytest.param(vt.Frictionless(), marks=pytest.mark.slow)])
def test_what_is_said_to_apply_on_a_film_is_as_good_as_it_is_said_to_be(base):
    case = groups(vt.Layer(1.0, base), tabor=8.0, rate=2.4, start=vt.AtRadius(2.7))
    advice = vt.advise(case)
    result = vt.solve(case, until="pull-off", accuracy=5e-3, estimate_error=False)
    receding = row(advice, "receding crack")
    assert receding.applies and receding.error < 0.07
    assert receding.pull_off_force == pytest.approx(vt.pull_off_force(result), rel=receding.error)
    assert advice.contact.slow_force < vt.pull_off_force(result) < advice.contact.fast_force


def test_a_film_too_thin_for_the_range_of_the_forces_is_left_to_the_simulation():
    advice = vt.advise(groups(vt.Layer(0.1, GLUED), tabor=8.0))
    receding = row(advice, "receding crack")
    assert not receding.applies
    assert advice.use == "simulation" and advice.rate_regime == "unknown"
    assert advice.adhesion == "transition" and advice.contact.reaches_through


def test_a_disc_has_kendall_and_its_strength_as_limits():
    layer = vt.Layer(0.5, GLUED)
    for body in (vt.HalfSpace(), layer):
        case = groups(body, tabor=8.0, geometry=vt.Disc(1.0), start=vt.AtDepth(0.0))
        contact = vt.advise(case).contact
        kendall = disc.pull_off_force(contact_radius=1.0, body=body, **UNITS)
        strength = np.pi * 8.0 * case.traction.strength
        assert contact.slow_force == pytest.approx(kendall / LOAD)
        assert contact.strength_force == pytest.approx(strength / LOAD)
        expected = min(kendall * np.sqrt(10.0), strength) / LOAD
        assert contact.fast_force == pytest.approx(expected)
        simulated = vt.solve(case, until="pull-off", accuracy=2e-2, estimate_error=False)
        assert 0.9 * contact.slow_force < simulated.pull_off_force < contact.fast_force
