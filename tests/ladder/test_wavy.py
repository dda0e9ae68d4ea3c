"""A sphere with waves: Guduru's theory against quadrature, its limits, and simulations."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import viscotack as vt
from viscotack.result import observables
from viscotack.theory import jkr, wavy
from viscotack.theory.elastic import indenter

SPHERE = {"radius": 0.2}
WAVES = {"amplitude": 1e-6, "wavelength": 1e-3}
SOLID: Any = {"contact_modulus": 1e6, "work_of_adhesion": 0.05}
A = np.linspace(2e-4, 2e-2, 60)
# In groups: R, E0* and dg are 1.
SHAPE = {"radius": 1.0, "amplitude": 0.06, "wavelength": 0.5}
UNITS: Any = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}


# --- 1 identity -----------------------------------------------------------------------------------
def test_depth_and_force_are_those_of_the_profile_by_quadrature():
    shape = vt.WavySphere(**SPHERE, **WAVES)
    case = SPHERE | WAVES | SOLID
    depth, force = np.asarray(wavy.depth(A, **case)), np.asarray(wavy.force(A, **case))
    summed = indenter.depth(A, shape=shape, **SOLID)
    assert depth == pytest.approx(summed, rel=1e-10, abs=1e-12 * abs(depth).max())
    summed = indenter.force(A, shape=shape, **SOLID)
    assert force == pytest.approx(summed, rel=1e-10, abs=1e-12 * abs(force).max())


# --- 2 limit --------------------------------------------------------------------------------------
def test_long_waves_are_the_curvature_of_a_sphere():
    h, wave = 1e-6, 10.0
    curved = 1 / (1 / SPHERE["radius"] + h * (2 * np.pi / wave) ** 2)
    long = wavy.force(A, amplitude=h, wavelength=wave, **SPHERE, **SOLID)
    assert long == pytest.approx(np.asarray(jkr.force(A, radius=curved, **SOLID)), rel=1e-6)


@pytest.mark.parametrize(("amplitude", "wavelength"), [(0.3, 0.2), (2.0, 3.0)])
def test_the_pull_off_is_the_least_of_all_minima(amplitude, wavelength):
    case = {"radius": 1.0, "amplitude": amplitude, "wavelength": wavelength, **UNITS}
    a = np.linspace(0, 8, 40_001)
    force = np.asarray(wavy.force(a, **case))
    end = wavy.pull_off(**case)
    assert end.force == pytest.approx(force.min(), rel=1e-4)
    assert end.contact_radius == pytest.approx(a[force.argmin()], abs=2e-4)


# --- 4 peer: the simulation -----------------------------------------------------------------------
def groups(tabor, material, rate, depth=3.0):
    return vt.Groups(
        tabor, material, vt.AtDepth(depth * tabor), rate, geometry=vt.WavySphere(**SHAPE)
    )


def test_simulations_of_short_range_pull_like_guduru():
    elastic = vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    theory = -wavy.pull_off(**SHAPE, **UNITS).force / (1.5 * np.pi)
    result = vt.solve(groups(8.0, elastic, 1.0), accuracy=1e-2, estimate_error=False)
    assert theory == pytest.approx(1.189, rel=1e-3)
    assert result.pull_off_force == pytest.approx(theory, rel=0.01)
    # a snap from crest to crest, and what it sets free is booked
    jumps = [event for event in result.events if event.kind == "jump"]
    assert len(jumps) >= 2 and all(event.energy > 0 for event in jumps)
    assert result.energy_residual is not None and result.energy_residual < 1e-3
    assert len(observables.peaks(result)) > 2


def test_the_gain_by_waves_fades_with_the_speed():
    solid = vt.StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
    gain = []
    for rate in (1e-3, 30.0):
        wavy_groups = groups(4.0, solid, rate)
        both = [
            vt.solve(each, accuracy=1e-2, until="pull-off", estimate_error=False).pull_off_force
            for each in (wavy_groups, replace(wavy_groups, geometry=vt.Sphere(1.0)))
        ]
        gain.append(both[0] / both[1])
    assert gain[0] > 1.1 and gain[0] > gain[1] + 0.02
