"""Elastic theories and the grid against ContactEngineering's Adhesion (MIT), an independent code.

Left out where it is not installed: `pip install -e ".[peers]"`. Its closed forms are right to
round-off. Its `JKR.contact_radius(penetration=...)` is not: the radius at the depth minimum is
(pi w R^2 / (6 K))^(1/3), K = 4/3 E*, and the code has `/ 6 * K`, which multiplies by K. The slip
cancels for K = 1, the default there. For a smaller modulus the depth down to which it sees a
contact is too shallow by K^(4/3), and it says 0 for contacts that exist; for a larger one only
the start of the iteration is off. Which of the two happens depends on the units, so it is shown
below on one contact in two systems of units.
"""

import numpy as np
import pytest

from viscotack.model.traction import LennardJones
from viscotack.simulate.grid.descent import equilibrium
from viscotack.simulate.grid.plane import Plane
from viscotack.simulate.machine import Hold

ROUND_OFF = 1e-12


def grid_and_peer(many, tabor, monkeypatch):
    """Return the plane and heights of an elastic sphere, and the system of the peer for it."""
    system = pytest.importorskip("Adhesion.System")
    interactions = pytest.importorskip("Adhesion.Interactions")
    mechanics = pytest.importorskip("ContactMechanics")
    topography = pytest.importorskip("SurfaceTopography")
    # the peer has no correction for tractions that vary over a pixel
    monkeypatch.setattr("viscotack.simulate.grid.plane._WITHIN_PIXEL", np.inf)
    half, radius = 6.0 * tabor**1.5, tabor**3
    x = (np.arange(many) + 0.5) * 2 * half / many - half
    heights = -np.add.outer(x**2, x**2) / (2 * radius)
    sides = (2 * half, 2 * half)
    substrate = mechanics.FreeFFTElasticHalfSpace((many, many), 1.0, sides)
    surface = topography.Topography(heights, physical_sizes=sides)
    peer = system.SmoothContactSystem(substrate, interactions.Lj82(1.0, 1.0), surface)
    return Plane((many, many), 2 * half / many), heights, peer


def balanced(plane, heights, depth, moved):
    """Return the equilibrium of the grid at a depth."""
    law, hold = LennardJones(1.0, 1.0), Hold(np.inf, depth=depth)
    found = equilibrium(
        plane, law, 1 - heights.ravel(), 1.0, moved, hold, tolerance=1e-9, most_iterations=200
    )
    assert found.stable
    return found


@pytest.mark.parametrize("tabor", [0.5, 1.0, 2.0])
def test_the_solution_of_the_grid_is_an_equilibrium_of_the_peer(tabor, monkeypatch):
    """Same law (8-2), same pressed squares: energy, force, balance at the displacements found."""
    plane, heights, peer = grid_and_peer(32, tabor, monkeypatch)
    found = balanced(plane, heights, 1.0, np.zeros(plane.domain))
    energy, gradient = peer.objective(0.0, gradient=True)(found.moved.ravel())
    area = plane.pixel**2
    elastic = 0.5 * area * float(np.vdot(found.moved, plane.held(found.moved)))
    assert energy == pytest.approx(elastic + area * found.energy, rel=ROUND_OFF)
    assert peer.compute_normal_force() == pytest.approx(-area * found.tension.sum(), rel=1e-9)
    assert np.abs(gradient).sum() < 1e-8 * area * np.abs(found.tension).sum()


@pytest.mark.parametrize("tabor", [0.5, 1.0])
def test_the_peer_pulls_a_sphere_off_along_the_same_curve(tabor, monkeypatch):
    """Both descend from depth to depth, from one state in contact, through the jump out of it."""
    plane, heights, peer = grid_and_peer(24, tabor, monkeypatch)
    found = balanced(plane, heights, 1.0, np.zeros(plane.domain))
    ours, theirs, moved = [], [], found.moved
    for depth in np.linspace(1.0, -2.4, 18):
        found = balanced(plane, heights, depth, found.moved)
        # its default tolerance ends far from the equilibrium
        exact = dict(gtol=1e-6 * plane.pixel**2, ftol=0, maxcor=10, maxiter=5000, maxfun=10000)
        solution = peer.minimize_proxy(
            offset=depth - 1, initial_displacements=moved, method="L-BFGS-B", options=exact
        )
        moved = solution.x.reshape(plane.domain)
        ours.append(-(plane.pixel**2) * found.tension.sum())
        theirs.append(peer.compute_normal_force())
    assert theirs == pytest.approx(np.array(ours), abs=1e-5 * max(map(abs, ours)))
    assert ours[-1] > 0.5 * min(ours)
