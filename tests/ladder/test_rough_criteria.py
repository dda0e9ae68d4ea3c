"""Closed measures of stickiness: identities, limits, and pulls on the grid beside them."""

from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from solids import standard_solid
from viscotack.model.surfaces import HeightMap, self_affine, sphere
from viscotack.simulate.grid.plane import Plane
from viscotack.simulate.rough import RoughProblem, pull, stickiness
from viscotack.simulate.rough.criteria import _mean_gap

RUBBER = vt.Elastic(rubbery_modulus=1.5e6, poisson_ratio=0.5)
GAP = 1.5e-6
FLAT = HeightMap(np.zeros((8, 8)), 2e-6, periodic=True)


def problem(surface, work=0.02, law=None):
    law = law or vt.LennardJones(work_of_adhesion=work, equilibrium_gap=GAP)
    test = vt.Retraction(start=vt.AtForce(0.01 * law.strength * surface.area), speed=1e-6)
    return RoughProblem(surface=surface, material=RUBBER, traction=law, protocol=test)


@pytest.mark.parametrize("body", [vt.HalfSpace(), vt.Layer(thickness=30e-6)])
def test_the_work_of_persson_s_pressure_is_the_energy_of_full_contact(body):
    surface = self_affine(48, 5e-6, hurst=0.7, rms_height=1e-6, seed=2, shortest=4e-5)
    plane = Plane((48, 48), surface.pixel, body, periodic=True)
    gap, pressure = _mean_gap(plane, 2e6, surface.heights)
    work = -np.trapezoid(pressure, gap) + pressure[-1] * gap[-1]
    full = 2e6 * np.mean(surface.heights * plane.held(surface.heights)) / 2
    # the last pressure is the rms of full contact, from which the gap closes further
    assert 0.6 * full < work < full
    assert np.all(np.diff(gap) < 0)
    # exponential at small pressures: equal ratios of pressure are equal steps of the gap
    steps = np.diff(gap[:20]) / np.diff(np.log(pressure[:20]))
    assert np.ptp(steps) < 1e-6 * abs(steps[0])


def test_a_rim_around_patches_attracts_as_a_hertzian_edge_opens():
    # the gap beside a Hertzian strip of half width a under a cylinder of slope h' at its edge
    slope, a = 0.1, 20e-6
    x = a * (1 + 1e-5)
    exact = slope * a / 2 * (x / a * np.sqrt((x / a) ** 2 - 1) - np.arccosh(x / a))
    d = 2 * a
    assert exact == pytest.approx(4 / 3 * slope * d * ((x - a) / d) ** 1.5, rel=1e-4)
    # so the criterion is the balance of patch and rim, but for pi (3/16)^(2/3) = 1.03
    given = problem(self_affine(32, 5e-6, hurst=0.8, rms_height=3e-6, seed=1, shortest=4e-5))
    found, spread, law = stickiness(given), given.roughness, given.traction
    reach, d = law.work_of_adhesion / law.strength, 4 * spread.rms_slope / spread.rms_curvature
    opening = 4 / 3 * spread.rms_slope * d
    rim = np.pi * (reach / opening) ** (2 / 3) * law.strength
    patch = spread.rms_slope * RUBBER.contact_modulus / 2
    assert found.pastewka_robbins == pytest.approx(np.pi * (3 / 16) ** (2 / 3) * patch / rim)
    assert found.range_over_gap == pytest.approx(reach / opening)


def test_the_criteria_of_a_wave_are_closed_forms():
    a, wave, work = 0.5e-6, 128e-6, 0.02
    x = np.cos(2 * np.pi * np.arange(64) / 64)
    surface = HeightMap(a * np.add.outer(x, np.zeros(64)), wave / 64, periodic=True)
    solid = standard_solid(1.5e6, 15e6, 1.0, 0.5)
    found = stickiness(replace(problem(surface, work=work), material=solid))
    E, q = solid.contact_modulus, 2 * np.pi / wave
    # Johnson (1995): pressed flat with E q a/2, and a mean square of half the amplitude's
    assert found.full_contact == pytest.approx(E * q * a**2 / (8 * work), rel=1e-3)
    assert found.full_contact_fast == pytest.approx(10 * found.full_contact)
    # rms height a/sqrt(2), and the curvature in both directions is half of that in one
    fuller = E * (a / np.sqrt(2)) ** 1.5 * np.sqrt(a * q**2 / np.sqrt(8)) / work
    assert found.fuller_tabor == pytest.approx(fuller, rel=1e-3)


def test_flat_maps_stick_with_the_strength_and_spheres_have_no_mean_plane():
    flat = stickiness(problem(FLAT))
    assert flat.pastewka_robbins == flat.full_contact == 0
    assert flat.record["range_over_gap_at_patches"] is None
    assert flat.bearing_area_stress == pytest.approx(problem(FLAT).traction.strength)
    assert stickiness(problem(sphere(32, 5e-6, radius=5e-3))).bearing_area_stress is None


@pytest.mark.parametrize(
    ("rms", "work", "within"),
    [
        (7e-6, 0.03, 0.03),  # rigid: the highest summits attract
        (2.4e-6, 0.03, 0.08),
        (1e-6, 0.15, 0.25),  # soft: patches grow
    ],
)
def test_the_bearing_area_is_near_the_grid_for_hard_surfaces(rms, work, within):
    law = vt.LennardJones(work_of_adhesion=work, equilibrium_gap=GAP)
    surface = self_affine(32, 5e-6, hurst=0.8, rms_height=rms, seed=4, shortest=6e-5)
    given = problem(surface, law=law)
    found = pull(given, estimate_error=False, accuracy=0.01)
    assert stickiness(given).bearing_area_stress == pytest.approx(found.pull_off_stress, rel=within)
