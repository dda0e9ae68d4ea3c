"""Profiles of any form: tables of heights, waves, worn tips, cups; several edges."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.special import struve

import viscotack as vt
from stated import case_text
from viscotack.simulate.contacts.shape import ShapeContact
from viscotack.simulate.settings import Settings
from viscotack.simulate.solver import contact_of
from viscotack.theory.elastic import indenter

ELASTIC = vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
RELAXING = vt.StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
RADII = np.linspace(0.0, 6.0, 241)
WAVY = vt.WavySphere(1.0, 0.06, 0.5)
SOLID: Any = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}
ROUGHLY: Any = {"accuracy": 1e-2, "estimate_error": False}


def reduced(height):
    """Return the dimensionless profile of a formula, of equivalent radius 1."""
    shape = vt.MeasuredProfile.sampled(height, RADII)
    return shape.reduced(1.0, 1 / shape.equivalent_radius(1.0))


def worn(r):
    return max(r * r - 0.49, 0.0) / 2


def test_a_paraboloid_by_its_heights_is_one_everywhere():
    shape = vt.MeasuredProfile.sampled(lambda r: r * r / 2 + 3, [0.0, 0.1, 0.5, 0.6, 2.0])
    r = np.linspace(0, 5, 77)
    assert shape.gap(r) == pytest.approx(r * r / 2, abs=1e-12)
    assert shape.flank(r) == pytest.approx(r, rel=1e-12)
    assert shape.equivalent_radius(1e-9) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ([(0, 0), (1, 1)], "3 to 10,000 pairs"),
        ([(0.1, 0), (1, 1), (2, 4)], "ascend from 0"),
        ([(0, 0), (1, np.nan), (2, 4)], "finite"),
        ([(0, 1), (1, 4), (2, 0)], "rise at the last row"),
        ([(0, 9), (1, 4), (2, 1), (3, 0), (4, 1)], "rise outwards as a whole"),
    ],
)
def test_rows_that_are_no_profile_are_refused(points, words):
    with pytest.raises(vt.InputError, match=words):
        vt.MeasuredProfile(tuple(points))


def test_depth_under_waves_is_that_of_struve():
    # int_0^(pi/2) sin(k a sin t) dt = pi/2 H_0(k a)
    a, k = np.array([0.3, 1.0, 5.0, 20.0]), 2 * np.pi / WAVY.wavelength
    exact = a * a + WAVY.amplitude * k * a * np.pi / 2 * struve(0, k * a)
    assert indenter.bare_depth(a, shape=WAVY) == pytest.approx(exact, rel=1e-12)


def test_a_sphere_by_its_heights_pulls_as_the_sphere_does():
    sphere = vt.Groups(tabor=2.0, material=RELAXING, start=vt.AtDepth(6.0), rate=3.0)
    table = replace(sphere, geometry=reduced(lambda r: r * r / 2))
    forces = [vt.solve(one, until="pull-off", **ROUGHLY).pull_off_force for one in (sphere, table)]
    assert forces[1] == pytest.approx(forces[0], rel=1e-3)


def test_a_start_has_the_largest_of_several_radii():
    contact = ShapeContact(4.0, vt.LennardJones(1.0, 1.0), WAVY)
    a = np.linspace(0.05, 4.0, 2000)
    depth = 4.0 * np.asarray(indenter.depth(a, shape=WAVY, **SOLID))
    for wanted in (-4.0, 0.0, 5.0):
        last = np.flatnonzero(depth < wanted)[-1]
        crossing = np.interp(wanted, depth[last : last + 2], a[last : last + 2])
        assert contact.jkr_radius(wanted) == pytest.approx(crossing, abs=1e-5)
    force = np.asarray(indenter.force(a, shape=WAVY, **SOLID))
    least = contact.jkr_radius_at_force(-1e9)
    assert indenter.force(least, shape=WAVY, **SOLID) == pytest.approx(force.min(), rel=1e-3)


@pytest.mark.parametrize("height", [worn, WAVY.gap], ids=["worn", "waves"])
def test_energies_of_any_profile_are_accounted_for(height):
    shape = reduced(height)
    groups = vt.Groups(tabor=2.0, material=ELASTIC, start=vt.AtDepth(6.0), rate=1.0, geometry=shape)
    result = vt.solve(groups, **ROUGHLY)
    assert result.energy_residual is not None and result.energy_residual < 1e-3
    a = np.linspace(0.05, 5, 2000)
    most = -np.min(indenter.force(a, shape=shape, **SOLID)) / (1.5 * np.pi)
    assert result.pull_off_force == pytest.approx(most, rel=0.06)


def test_a_contact_beyond_the_last_row_is_refused():
    short = vt.MeasuredProfile.sampled(lambda r: r * r / 2, np.linspace(0, 1.5, 31))
    groups = vt.Groups(2.0, ELASTIC, vt.AtDepth(12.0), 1.0, geometry=short)
    with pytest.raises(vt.InputError, match="than the profile is known"):
        vt.solve(groups)
    apart = replace(
        groups, start=vt.Apart(5.0), moves=(vt.Approach(1.0, vt.AtDepth(8.0)),), rate=None
    )
    with pytest.raises(vt.SimulationError, match="profile is known to"):
        vt.solve(apart, **ROUGHLY)


def test_nodes_of_a_tip_grow_slowly_away_from_its_kinks():
    # panels of seven times the length beside those of the kink had no positive definite compliance
    shape = vt.MeasuredProfile.sampled(lambda r: max(r * r - 0.694, 0.0) / 2, RADII[::2])
    shape = shape.reduced(1.0, 1 / shape.equivalent_radius(1.0))
    law = vt.Dugdale(1.0, 1.0, rise=0.04, fall=0.95)
    groups = vt.Groups(5.27, ELASTIC, vt.AtDepth(49.3), 1.0, geometry=shape, traction=law)
    contact, settings = contact_of(groups), Settings.for_accuracy(2e-3)
    assert contact.relaxed(groups.start, settings).edge > 3.0
    panels = np.diff(contact.grading(settings, 49.3).own)
    assert np.max(np.abs(np.diff(np.log(panels)))) < np.log(1.35)


def case_of(table, keys):
    pressed = 'preload_depth = "2 um"\nspeed = "10 um/s"'
    return case_text(shape=f"[{table}]\n{keys}", protocol=pressed)


@pytest.mark.parametrize("table", ["profile", "measured-profile"])
def test_a_case_file_names_the_table(tmp_path, table):
    (tmp_path / "tip.csv").write_text("radius_um,height_nm\n0,5\n50,505\n100,2005\n400,32005\n")
    path = tmp_path / "case.toml"
    path.write_text(case_of(table, 'file = "tip.csv"'))
    shape = vt.read_case(path).geometry
    assert isinstance(shape, vt.MeasuredProfile)
    assert shape.gap(1e-4) == pytest.approx(2e-6, rel=1e-9)
    points = (
        '[["0 um", "5 nm"], ["50 um", "505 nm"], ["100 um", "2005 nm"], ["400 um", "32005 nm"]]'
    )
    path.write_text(case_of("measured-profile", f"points = {points}"))
    typed = vt.read_case(path).geometry
    assert isinstance(typed, vt.MeasuredProfile)
    assert np.array(typed.points) == pytest.approx(np.array(shape.points), rel=1e-9, abs=1e-18)


def ring(r):
    return r * r / 2 + 8 * np.exp(-r * r)


def approached(height, depth, material=ELASTIC, rate=None):
    """Return the result of an approach from apart, and of a retraction at a rate."""
    moves = (vt.Approach(1.0, vt.AtDepth(depth)),)
    start, shape = vt.Apart(12.0), reduced(height)
    groups = vt.Groups(4.0, material, start, rate, moves=moves, geometry=shape)
    return vt.solve(groups, **ROUGHLY)


def test_both_edges_of_a_ring_are_reported():
    ring_result = approached(ring, 5.0, rate=1.0)
    touching = np.isfinite(ring_result.contact_radius)
    assert np.all(ring_result.rings[touching] == 1) and np.all(ring_result.rings[~touching] == 0)
    assert np.all(np.isnan(ring_result.inner_radius[~touching]))
    inner, outer = ring_result.inner_radius[touching], ring_result.contact_radius[touching]
    # the lowest place is between them
    lowest = RADII[np.argmin([ring(r) for r in RADII])] / np.pi ** (1 / 3)
    assert np.all((inner > 0) & (inner < lowest) & (lowest < outer))
    # it opens from inside as well as from outside
    after = ring_result.move[touching] == 1
    assert inner[after][-1] > 1.1 * inner[after][0]


def test_parts_of_a_contact_that_comes_together_are_counted():
    # a groove around a tip: it closes with a jump on the way in, whose energy is booked
    def groove(r):
        return r * r / 2 + 0.8 * np.exp(-(((r - 1) / 0.25) ** 2))

    result = approached(groove, 8.0, RELAXING)
    assert result.rings is not None and result.rings.max() == 2 and result.rings[-1] == 1
    assert result.energy_residual is not None and result.energy_residual < 5e-3
