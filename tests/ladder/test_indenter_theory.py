"""JKR by quadrature of any profile, against the closed forms of spheres and power laws."""

import numpy as np
import pytest

from viscotack.model.geometry import Cone, PowerLawProfile, Sphere
from viscotack.theory import jkr, profiles
from viscotack.theory.elastic import indenter

SOLID = {"contact_modulus": 2e6, "work_of_adhesion": 0.05}
RADII = np.geomspace(1e-6, 3e-4, 7)
TIPS = [Cone(0.2), PowerLawProfile(7.0, 1.5), PowerLawProfile(5e7, 3.0)]


class Unknown:
    """A shape that says how steep it is, and nothing of its kind."""

    def __init__(self, shape):
        self.gap, self.flank = shape.gap, shape.flank


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
