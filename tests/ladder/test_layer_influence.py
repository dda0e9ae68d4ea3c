"""The compliance of an elastic layer on the ladder: identities, limits, orders and a peer."""

import itertools

import numpy as np
import pytest
from scipy.special import jv, sici, xlogy

from reference_data import VALUES
from viscotack.model.geometry import Bonded, Frictionless, Layer, half_space
from viscotack.model.geometry.layer import layer_influence
from viscotack.model.geometry.layer_of_revolution import influence
from viscotack.model.geometry.panels import hat_areas
from viscotack.simulate.surface import relaxed_stiffness
from viscotack.theory.punch import crossover

BASES = [Frictionless(), *(Bonded(poisson_ratio=nu) for nu in (0.0, 0.49, 0.5))]
SQUEEZED = Bonded(poisson_ratio=0.5)


def crowded(count, shortest=1e-4):
    """Return nodes whose distances shrink evenly towards the end of a punch of half width 1."""
    growth = np.log(1 / shortest) * np.linspace(0, 1, count)
    return np.expm1(-growth) / np.expm1(-growth[-1])


def compliance(x, thickness, base):
    B = layer_influence(x, thickness, base) / hat_areas(x, "plane")
    return (B + B.T) / 2


def punch_stiffness(x, thickness, base):
    """Return force over depth of a rigid punch, for E* = 1."""
    return float(np.sum(np.linalg.solve(compliance(x, thickness, base), np.ones(len(x)))))


def strip(x, half_width, thickness, base):
    """Return the displacement under uniform pressure, by quadrature of the transfer function."""
    nodes, weights = np.polynomial.legendre.leggauss(30)
    last = 40 / thickness
    edges = np.linspace(0, last, 400)
    half = np.diff(edges)[:, None] / 2
    k = (edges[:-1, None] + half * (1 + nodes)).ravel()
    weight = (half * weights).ravel() * base.transfer(k * thickness) / k**2
    u = 4 / np.pi * np.cos(np.multiply.outer(x, k)) @ (weight * np.sin(k * half_width))
    for c in (half_width + x, half_width - x):  # beyond, where the transfer function is 1
        cosine = np.where(c > 0, sici(np.where(c > 0, c * last, 1.0))[1], 0.0)
        u += 2 / np.pi * (np.sin(c * last) / last - c * cosine)
    return u


# identity
def test_equal_nodes_have_the_hats_of_the_thesis():
    rows = [row for row in VALUES if "(layer)" in row["equation"]]
    assert len(rows) >= 15
    for row in rows:
        ratio, elements, apart = (row["inputs"][name] for name in ("B=b/a", "M", "m-n"))
        x = np.arange(apart + 2) * 2 / elements
        first = layer_influence(x, ratio, Frictionless())[0, apart]
        # away from the middle, a column has the hat on the other side as well
        hat = first / (2 if apart else 1)
        assert -hat == pytest.approx(row["value"], abs=1e-12, rel=0)


@pytest.mark.parametrize("base", BASES, ids=repr)
@pytest.mark.parametrize("thickness", [0.02, 1.9, 2.1, 30.0])
def test_uniform_pressure_moves_the_surface_as_its_fourier_integral_says(thickness, base):
    x = np.concatenate([np.linspace(0, 0.6, 7), [0.7, 0.83, 0.9, 0.97, 1.0]])
    u = layer_influence(x, thickness, base) @ np.ones(len(x))
    assert u == pytest.approx(strip(x, 1.0, thickness, base), abs=1e-12, rel=1e-12)


# limit
@pytest.mark.parametrize("base", BASES, ids=repr)
def test_a_thin_layer_is_a_foundation_with_half_of_it_at_the_end(base):
    x = crowded(60, 1e-3)
    u = layer_influence(x, 0.005, base) @ np.ones(len(x))
    inside = x < 0.7
    assert u[inside] == pytest.approx(0.005 * base.foundation, abs=1e-13, rel=0)
    assert u[-1] == pytest.approx(0.005 * base.foundation / 2, abs=1e-13, rel=0)


def test_an_incompressible_bonded_layer_is_squeezed_out_with_an_error_of_third_order():
    # u = -(4/3) p'' b^3/E*
    b, counts = 0.03, np.array([26, 51, 101, 201])
    error = []
    for count in counts:
        x = np.linspace(0, 1, count)
        u = layer_influence(x, b, SQUEEZED)[0] @ (1 - x**2)
        error.append(u / (8 / 3 * b**3) - 1)
    slope = np.polyfit(np.log(counts - 1), np.log(error), 1)[0]
    assert slope == pytest.approx(-3, abs=0.02)
    assert error[-1] < 1e-4


@pytest.mark.parametrize("base", BASES, ids=repr)
def test_differences_of_displacement_tend_to_the_half_plane_as_the_square_of_a_over_b(base):
    x = np.linspace(0, 1, 11)

    def F(s):
        return -xlogy(s * s, np.abs(s)) / np.pi

    def hat(at, top):
        return (F(at - top - 0.1) - 2 * F(at - top) + F(at - top + 0.1)) / 0.1

    half_plane = hat(x, 0.5) + hat(x, -0.5)
    error = []
    for b in (10.0, 20.0, 40.0, 80.0):
        u = layer_influence(x, b, base)[:, 5]
        error.append(np.max(np.abs(u - u[0] - (half_plane - half_plane[0]))))
    slope = np.polyfit(np.log([10.0, 20.0, 40.0, 80.0]), np.log(error), 1)[0]
    assert slope == pytest.approx(-2, abs=0.02)


def test_a_thick_layer_sinks_by_the_logarithm_of_its_thickness():
    x = np.linspace(0, 1, 11)
    for base in BASES:
        low, high = (layer_influence(x, b, base) / hat_areas(x, "plane") for b in (300.0, 900.0))
        assert high - low == pytest.approx(2 / np.pi * np.log(3), abs=1e-4, rel=0)


@pytest.mark.parametrize("base", BASES, ids=repr)
def test_the_symmetric_compliance_is_positive_definite(base):
    for thickness, x in itertools.product(
        (0.005, 0.05, 0.5, 1.99, 2.01, 10.0, 100.0), (crowded(150), np.linspace(0, 1, 101))
    ):
        np.linalg.cholesky(compliance(x, thickness, base))


# order, and a peer: the same punch from its integral equation, by Chebyshev polynomials
@pytest.mark.parametrize(
    ("thickness", "base"), [(0.2, BASES[1]), (1.0, BASES[2]), (20.0, BASES[0])]
)
def test_the_stiffness_of_a_punch_is_first_order_in_the_nodes_distance(thickness, base):
    exact = crossover.stiffness(thickness, half_width=1.0, contact_modulus=1.0, base=base)
    found = np.array([punch_stiffness(np.linspace(0, 1, n), thickness, base) for n in LEVELS])
    error = found / exact - 1
    slope = np.polyfit(np.log(LEVELS - 1), np.log(np.abs(error)), 1)[0]
    assert slope == pytest.approx(-1, abs=0.1)
    assert 2 * found[-1] - found[-2] == pytest.approx(exact, rel=2e-4)


LEVELS = np.array([41, 81, 161, 321])


@pytest.mark.parametrize("base", [Frictionless(), SQUEEZED], ids=repr)
@pytest.mark.parametrize("thickness", [0.3, 5.0])
def test_the_displacement_under_smooth_pressure_is_second_order(thickness, base):
    def middle(count):
        x = np.linspace(0, 1, count)
        return layer_influence(x, thickness, base)[0] @ (1 - x**2) ** 2

    values = np.array([middle(n) for n in (21, 41, 81, 161)])
    order = np.log2(np.diff(values)[:-1] / np.diff(values)[1:])
    assert order == pytest.approx(2, abs=0.1)


# The compliance of a layer under pressure of revolution: identities, limits and orders.
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
