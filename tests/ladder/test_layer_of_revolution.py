"""The compliance of a layer under pressure of revolution: identities, limits and orders."""

import numpy as np
import pytest
from scipy.special import jv

from viscotack.model.geometry import Bonded, Frictionless, Layer, half_space
from viscotack.model.geometry.layer_of_revolution import influence
from viscotack.simulate.surface import relaxed_stiffness

BASES = [Frictionless(), *(Bonded(poisson_ratio=nu) for nu in (0.0, 0.49, 0.5))]
SQUEEZED = Bonded(poisson_ratio=0.5)


def graded(edge, finest, outer, growth=0.08, widest=np.inf):
    """Return nodes that are dense around an edge, and at most so far apart inside it."""
    steps = finest * (1 + growth) ** np.arange(200)
    inner, away = np.cumsum(np.minimum(steps, widest)), np.cumsum(steps)
    inner = np.append(inner, np.arange(inner[-1] + widest, edge, widest) if widest < 1 else [])
    nodes = np.concatenate([edge - inner, [edge], edge + away])
    return np.append(0.0, np.sort(nodes[(nodes > finest) & (nodes < outer)]))


def by_waves(r, thickness, base):
    """Return the influence matrix, each hat by its Hankel transform as a difference of caps."""
    y = r / thickness
    nodes, weights = np.polynomial.legendre.leggauss(20)
    edges = np.linspace(0.0, 20.0, 10 + int(4 * y[-1]))
    half = np.diff(edges)[:, None] / 2
    t = (edges[:-1, None] + half * (1 + nodes)).ravel()
    weight = 2 * (half * weights).ravel() * (base.transfer(t) - 1)
    x = np.multiply.outer(t, y)
    small, large = np.minimum(x, 0.3), np.maximum(x, 0.3)
    series = 1 / 4 - small**2 / 48 + small**4 / 1536 - small**6 / 92160 + small**8 / 8847360
    cap = y**4 * np.where(x < 0.3, series, 2 * jv(2, large) / large**2)
    ramps = np.diff(cap, axis=1) / np.diff(y * y)
    last = y[-1] ** 2 * jv(1, x[:, -1]) / x[:, -1] - ramps[:, -1]
    hats = np.column_stack([ramps[:, 0], np.diff(ramps, axis=1), last])
    moved = (jv(0, x.T) * weight) @ hats
    return half_space.influence(r) + thickness * moved


# identity


@pytest.mark.parametrize("base", BASES, ids=repr)
@pytest.mark.parametrize("thickness", [0.1, 1.0, 300.0])
def test_hats_move_the_surface_as_their_hankel_transforms_say(thickness, base):
    r = graded(1.5, 0.01, 2.2)
    found, exact = influence(r, thickness, base), by_waves(r, thickness, base)
    assert np.max(np.abs(found - exact) / np.diag(exact)[:, None]) < 1e-7
    pressure = np.maximum(4 - r * r, 0.0)
    assert found @ pressure == pytest.approx(exact @ pressure, abs=1e-7 * np.max(exact @ pressure))


@pytest.mark.parametrize("base", BASES, ids=repr)
@pytest.mark.parametrize("thickness", [0.05, 0.3])
def test_the_compliance_has_a_stiffness(thickness, base):
    for edge, finest, outer in ((0.4, 0.01, 20.0), (4.0, 0.003, 10.0)):
        # what is squeezed out needs nodes that tell thicknesses apart
        widest = 0.3 * thickness if base.foundation < 0.2 else edge / 24
        nodes = graded(edge, min(finest, thickness / 10), outer, growth=0.07, widest=widest)
        S = relaxed_stiffness(Layer(thickness, base), "revolution", nodes, 24.0)
        np.linalg.cholesky(S)


# limit


@pytest.mark.parametrize("base", BASES, ids=repr)
def test_a_thick_layer_is_a_half_space_as_a_over_b(base):
    r = graded(1.0, 0.02, 2.0)
    exact, error = half_space.influence(r), []
    for thickness in (100.0, 200.0, 400.0):
        found = influence(r, thickness, base)
        error.append(np.max(np.abs((found - exact) @ np.ones(len(r)))))
    assert np.polyfit(np.log([100.0, 200.0, 400.0]), np.log(error), 1)[0] == pytest.approx(
        -1, abs=0.01
    )
    assert error[-1] < 0.02 * np.max(exact @ np.ones(len(r)))


@pytest.mark.parametrize("base", BASES[:3], ids=repr)
def test_a_thin_layer_is_a_foundation(base):
    r = np.linspace(0.0, 1.0, 201)
    moved = influence(r, 0.02, base) @ (1 - r * r)
    inside = (r > 0.1) & (r < 0.6)
    c = base.foundation
    # u = c b p + e b^3 laplacian(p), the second of which is known where c is 0
    assert moved[inside] == pytest.approx(0.02 * c * (1 - r * r)[inside], abs=8 * 0.02**3)


def test_an_incompressible_thin_layer_is_squeezed_out():
    # u = -(4/3) b^3 laplacian(p)/E*
    r = np.linspace(0.0, 1.0, 401)
    moved = influence(r, 0.02, SQUEEZED) @ (1 - r * r)
    assert moved[(r > 0.1) & (r < 0.6)] == pytest.approx(16 / 3 * 0.02**3, rel=2e-3)


def test_a_contact_that_is_too_wide_for_the_table_is_refused_in_words():
    r = np.linspace(0.0, 400.0, 801)
    with pytest.raises(ValueError, match="out to 400 thicknesses"):
        influence(r, 1.0, Frictionless())
