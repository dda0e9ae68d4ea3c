"""A bonded layer of Poisson ratio 0.49 beside `tests/hankel_layer.py`, a code of its own.

That code shares nothing with the package: rings of uniform pressure, a transfer function by matrix
exponentials, and the hereditary integral summed over all steps.
"""

import numpy as np
import pytest

import hankel_layer as peer
import viscotack as vt
from dimensionless import ELASTIC, SOLID
from viscotack.theory.elastic import on_layer

pytestmark = pytest.mark.march

BASE = vt.Bonded(poisson_ratio=0.49)


def pulled(shape, thickness, solid, start, rate):
    body = vt.Layer(thickness, BASE)
    groups = vt.Groups(2.0, solid, vt.AtDepth(start), rate, geometry=shape, body=body)
    return vt.solve(groups, until="pull-off", accuracy=2e-3, estimate_error=False)


@pytest.mark.parametrize("s", [0.05, 0.7, 3.0, 11.0])
@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.49])
def test_the_transfer_function_solves_the_equations_of_navier(s, ratio):
    found = vt.Bonded(poisson_ratio=ratio).transfer(s)
    assert found == pytest.approx(peer.surface_compliance(s, ratio), rel=1e-9)


def test_a_disc_on_a_layer_has_the_stiffness_of_the_other_code():
    coarse, fine = (peer.disc_stiffness(0.5, rings) for rings in (100, 200))
    found = on_layer.stiffness(np.array([1.0]), vt.Layer(0.5, BASE))[0]
    assert found == pytest.approx(2 * fine - coarse, rel=1e-3)  # of first order at the edge


@pytest.mark.parametrize(
    ("solid", "rate", "thickness"),
    [(ELASTIC, 1.0, 0.5), (SOLID, 3.0, 0.5), (SOLID, 3.0, 0.2)],
)
def test_a_sphere_on_a_layer_pulls_as_in_the_other_code(solid, rate, thickness):
    ratio = solid.modulus_ratio
    depth, force = peer.sphere(2.0, thickness, ratio, rate, spacing=0.04, travel=0.04)
    result = pulled(vt.Sphere(1.0), thickness, solid, 1.0, rate)
    assert vt.pull_off_force(result) == pytest.approx(peer.pull_off(depth, force), rel=3e-3)
    before = depth > vt.pull_off(result).depth
    found = np.interp(-depth[before], -result.depth, result.force)
    assert found == pytest.approx(force[before], abs=1e-2 * -force.min())


def test_a_disc_on_a_layer_pulls_as_in_the_other_code():
    depth, force = peer.disc(2.0, 0.5, rings=200, travel=0.04)
    found = vt.pull_off_force(pulled(vt.Disc(1.0), 0.5, ELASTIC, 0.0, 1.0))
    assert found == pytest.approx(peer.pull_off(depth, force), rel=5e-3)
