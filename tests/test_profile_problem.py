import math
from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest

from stated import numbers
from viscotack.model.geometry import (
    Cone,
    Disc,
    HalfSpace,
    Layer,
    PowerLawProfile,
    Sphere,
    WavySphere,
)
from viscotack.model.materials import Elastic, StandardSolid
from viscotack.model.problem import Groups, Problem
from viscotack.model.protocol import (
    Apart,
    Approach,
    AtDepth,
    AtForce,
    AtRadius,
    Dwell,
    Retract,
    Retraction,
)
from viscotack.model.traction import LennardJones
from viscotack.prediction.advice import advise
from viscotack.simulate import solve
from viscotack.theory import jkr, profiles
from viscotack.theory.elastic import indenter, on_layer
from viscotack.theory.elastic.relaxed import ends

SOLID = StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5)
LAW = LennardJones(work_of_adhesion=0.15, equilibrium_gap=0.1e-6)
MOVES = (Approach(1e-6, AtForce(1e-6)), Dwell(3.0, hold="depth"), Retract(2e-6, AtDepth(0.0)))


CONE, START = Cone(slope=0.2), AtForce(1e-6)


def problem(profile=CONE, start=START, **others):
    parts = dict(speed=10e-6) | others
    return Problem(SOLID, LAW, profile, Retraction(start=start, **parts))


def test_gaps_follow_their_powers():
    r = np.array([0.0, 1e-4, 2e-4])
    assert Cone(0.1).gap(r) == pytest.approx(0.1 * r, rel=1e-15)
    assert PowerLawProfile(3.0, 1.5).gap(r) == pytest.approx(3 * r**1.5, rel=1e-15)
    paraboloid = PowerLawProfile(1 / (2 * 5e-3), exponent=2)
    assert paraboloid.gap(r) == pytest.approx(Sphere(5e-3).gap(r), rel=1e-14)


@pytest.mark.parametrize("exponent", [0.9, 10.5, -1, float("nan")])
def test_an_impossible_exponent_is_refused(exponent):
    with pytest.raises(ValueError, match="exponent"):
        PowerLawProfile(1.0, exponent)


@pytest.mark.parametrize("start", [AtForce(1e-3), AtDepth(2e-6), AtRadius(2e-4), Apart(5e-6)])
def test_the_paraboloid_has_the_groups_and_the_scales_of_its_sphere(start):
    R, law = 5e-3, LennardJones(work_of_adhesion=0.15, equilibrium_gap=1.5e-6)
    protocol = Retraction(start=start, speed=1e-4, moves=MOVES, stiffness=20.0)
    sphere = Problem(SOLID, law, Sphere(R), protocol)
    square = Problem(SOLID, law, PowerLawProfile(1 / (2 * R), 2), protocol)
    assert square.radius == pytest.approx(R, rel=1e-14)
    assert square.groups().geometry == PowerLawProfile(0.5, 2)
    expected = numbers(sphere.groups())
    found = numbers(replace(square.groups(), geometry=Sphere(1.0)))
    assert found == pytest.approx(expected, rel=1e-12)
    assert vars(square.scales()) == pytest.approx(vars(sphere.scales()), rel=1e-12)


@pytest.mark.parametrize("exponent", [1.0, 1.5, 4.0])
def test_scales_are_those_of_jkr_and_the_tabor_number_is_the_depth_over_the_range(exponent):
    A = 0.1 * 1e-4 ** (1 - exponent)  # 10 um high at 0.1 mm
    given = problem(PowerLawProfile(A, exponent), AtDepth(1e-8))
    elastic = dict(contact_modulus=SOLID.contact_modulus, work_of_adhesion=0.15)
    end = profiles.pull_off(exponent=exponent, coefficient=A, **elastic)
    plain = dict(contact_modulus=1.0, work_of_adhesion=1.0)
    unit = profiles.pull_off(exponent=exponent, coefficient=1 / exponent, **plain)
    s = given.scales()
    assert end.force / s.force == pytest.approx(unit.force / (1.5 * math.pi), rel=1e-12)
    assert end.contact_radius / s.radius == pytest.approx(
        unit.contact_radius / math.pi ** (1 / 3), rel=1e-12
    )
    assert end.depth / s.length == pytest.approx(given.tabor * unit.depth, rel=1e-12)


def test_a_tip_that_is_steep_where_the_forces_end_is_refused():
    # of a sphere, sqrt(2 h0/R)
    with pytest.raises(ValueError, match="too steep: its slope is 0.535 where the gap is"):
        problem(PowerLawProfile(1 / (2 * 0.7e-6), 2), Apart(1e-6))
    # of waves as high as the gap, 2 pi amplitude/wavelength, 0.45 and 0.63
    assert problem(WavySphere(1e-3, 5e-8, 7e-7), Apart(1e-6)).geometry.detail == 3.5e-7
    with pytest.raises(ValueError, match="too steep: its slope is 0.6"):
        problem(WavySphere(1e-3, 5e-8, 5e-7), Apart(1e-6))


@pytest.mark.parametrize(("by", "fits"), [(0.999, True), (1.001, False)])
def test_a_sphere_is_in_contact_and_attracted_up_to_half_its_radius(by, fits):
    sphere = Sphere(1e-3)
    # sqrt(2 R h0) = R/2, and a relaxed contact radius of R/2 by radius, by load and by depth
    short, long = LAW, LennardJones(0.15, by * 1e-3 / 8)
    state = dict(radius=1e-3, contact_modulus=SOLID.contact_modulus, work_of_adhesion=0.15)
    a = by * 0.5e-3
    for law, start, words in (
        (short, AtRadius(a), "exceeds small strain"),
        (short, AtForce(jkr.force(a, **state)), "exceeds small strain"),
        (short, AtDepth(jkr.depth(a, **state)), "exceeds small strain"),
        (long, Apart(1e-3), "too steep"),
    ):
        with nullcontext() if fits else pytest.raises(ValueError, match=words):
            Problem(SOLID, law, sphere, Retraction(start=start, speed=1e-6))


@pytest.mark.parametrize(("by", "fits"), [(0.999, True), (1.001, False)])
@pytest.mark.parametrize("thickness", [None, 1.5e-3, 0.4e-3])
def test_a_disc_is_pressed_to_half_its_radius_or_half_the_layer(by, fits, thickness):
    disc, body = Disc(1e-3), HalfSpace() if thickness is None else Layer(thickness)
    most = by * min(0.5e-3, (thickness or 1.0) / 2)
    stiffness = 2e-3 if thickness is None else float(on_layer.stiffness(np.array(1e-3), body))
    words = "half its radius" if thickness is None or thickness > 1e-3 else "half the thickness"
    for start in (AtDepth(most), AtForce(most * stiffness * SOLID.contact_modulus)):
        with nullcontext() if fits else pytest.raises(ValueError, match=f"deeper than {words}"):
            Problem(SOLID, LAW, disc, Retraction(start=start, speed=1e-6), body=body)


@pytest.mark.parametrize(("by", "fits"), [(0.999, True), (1.001, False)])
def test_a_cone_is_pressed_to_half_the_layer_however_flat_it_is(by, fits, monkeypatch):
    # that the depth is the slope times the radius saves the solution of the layer
    monkeypatch.setattr(indenter, "bare_depth", lambda r, **_: 0.2 * r)
    start = AtRadius(by * 0.5e-4 / 0.2)
    with nullcontext() if fits else pytest.raises(ValueError, match="0.5 thicknesses of the layer"):
        Problem(SOLID, LAW, CONE, Retraction(start=start, speed=1e-6), body=Layer(1e-4))


def test_a_contact_beyond_small_strain_is_refused():
    A = 1 / (2 * 1e-4)  # a sphere of 0.1 mm: contacts up to 50 um
    for start, unit in ((AtRadius(51e-6), "5e-05 m"), (AtDepth(30e-6), "m"), (AtForce(1.0), "N")):
        with pytest.raises(ValueError, match=f"exceeds small strain.*may be up to .*{unit}"):
            problem(PowerLawProfile(A, 2), start)
    with pytest.raises(ValueError, match="exceeds small strain"):
        problem(PowerLawProfile(A, 2), AtDepth(1e-6), moves=(Approach(1e-6, AtForce(1.0)),))
    assert problem(PowerLawProfile(A, 2), AtRadius(49e-6)).geometry.exponent == 2


def test_advice_on_a_cone_is_that_of_the_cone():
    case = problem()
    found = advise(case)
    interface = {"contact_modulus": SOLID.contact_modulus, "work_of_adhesion": LAW.work_of_adhesion}
    _, end = ends(CONE, **interface)
    slow = found.contact.slow_force * found.force_scale
    assert slow == pytest.approx(-end.force, rel=1e-6)
    assert found.contact.slow_force < found.pull_off_force < found.contact.fast_force


def test_a_tabor_number_that_the_mesh_cannot_serve_is_answered_by_theory_or_refused():
    material = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    result = solve(Groups(1e4, material, AtForce(0.0), 1.0, geometry=Cone(1.0)))
    assert result.method == "crack contact"
    with pytest.raises(ValueError, match="Tabor number must be between"):
        solve(Groups(1e-9, material, AtForce(0.0), 1.0, geometry=Cone(1.0)))
