"""Tests of rectangular stamps: bounds on a half-space, estimate on a thin layer."""

import numpy as np
import pytest
from scipy import sparse

from viscotack.errors import InputError
from viscotack.model.geometry import Bonded, Frictionless
from viscotack.theory import punch
from viscotack.theory.elastic import disc
from viscotack.theory.punch.rectangle import bounds, film_stresses, on_layer

BONDED = Bonded(poisson_ratio=0.45)
SOLID = {"contact_modulus": 1e6, "work_of_adhesion": 0.05}


def test_a_square_holds_at_least_its_inscribed_disc_and_at_most_the_disc_around_it():
    low, high = bounds(1e-4, half_width=1e-4, **SOLID)
    inside, around = (
        disc.pull_off_force(contact_radius=a, **SOLID) for a in (1e-4, np.sqrt(2) * 1e-4)
    )
    assert low == pytest.approx(inside, rel=1e-12)
    # the area of the square under the stiffness of that disc
    assert high == pytest.approx(around * np.sqrt(2 / np.pi), rel=1e-12)


def test_a_stiffness_of_the_square_from_the_literature_lies_within_that_of_its_ellipses():
    # capacity of a square of side 1: 0.3667896 (Read, J. Comput. Phys. 133 (1997));
    # a disc has 2/pi times its radius
    exact = 0.3667896 * np.pi / 2 * 2  # radius of the equal disc over half the side
    assert 1 < exact < np.sqrt(2)
    low, high = bounds(1.0, half_width=1.0, contact_modulus=1.0, work_of_adhesion=1.0)
    sharper = np.sqrt(4 * 4 * 2 * exact)
    assert low < sharper < high


def compliance(x, y):
    """Return the displacements of square cells of side 1 by unit forces, E* = 1 (Love 1929)."""
    dx, dy = x[:, None] - x[None], y[:, None] - y[None]
    total = 0.0
    for sx in (-1, 1):
        for sy in (-1, 1):
            u, v = dx + sx / 2, dy + sy / 2
            total = total + sx * sy * (
                u * np.arcsinh(v / np.abs(u)) + v * np.arcsinh(u / np.abs(v))
            )
    return total / np.pi


def pulled(x, y):
    """Return the largest tension of cells of even pressure, E* = work of adhesion = 1.

    At a depth the cell that releases most energy opens as soon as this exceeds its work of
    adhesion, and the depth grows until another one does.
    """
    M, live = np.linalg.inv(compliance(x, y)), np.ones(x.size, dtype=bool)
    most, depth = 0.0, 0.0
    while live.any():
        own, even = np.diag(M)[live], M.sum(axis=1)[live]
        critical = np.sqrt(2 * own) / np.abs(even)
        depth = max(depth, critical.min())
        most = max(most, depth * even.sum())
        i = np.flatnonzero(live)[np.argmin(critical)]
        M = M - np.outer(M[:, i], M[i]) / M[i, i]
        live[i] = False
        M[i], M[:, i] = 0.0, 0.0
    return most


def cells(wide, long):
    """Return the places of cells of side 1 in a rectangle centred at 0."""
    x, y = np.meshgrid(np.arange(long) - (long - 1) / 2, np.arange(wide) - (wide - 1) / 2)
    return x.ravel(), y.ravel()


@pytest.mark.parametrize("ratio", [1, 2])
def test_contacts_that_open_cell_by_cell_lie_between_the_bounds(ratio):
    n, unit = 12, {"contact_modulus": 1.0, "work_of_adhesion": 1.0}
    x, y = cells(n, n)
    inside = np.hypot(x, y) < n / 2
    radius = np.sqrt(inside.sum() / np.pi)
    kendall = disc.pull_off_force(contact_radius=radius, **unit)
    # cells overestimate the work of an edge by a factor that a disc of as many shows
    scale = pulled(x[inside], y[inside]) / kendall
    assert scale == pytest.approx(1, abs=0.1)
    low, high = bounds(ratio * n / 2, half_width=n / 2, **unit)
    found = pulled(*cells(n, ratio * n)) / scale
    assert 1.03 * low < found < high / 1.03


def test_on_a_thin_sliding_layer_every_plan_has_the_same_stress():
    low, high = on_layer(3e-4, half_width=1e-4, **SOLID, thickness=1e-6, base=Frictionless())
    stress = punch.thin_layer_pull_off_stress(1e-6, **SOLID, base=Frictionless())
    assert low < high < 1.01 * low
    assert low == pytest.approx(12e-8 * stress, rel=0.01)


@pytest.mark.parametrize(("a", "decay"), [(1.0, 0.0), (2.0, 2.5)])
def test_a_bonded_film_is_bounded_by_its_first_opening_and_by_the_energy_of_its_edge(a, decay):
    """The pressure by finite differences, and the energies that its slopes release."""
    n, h = 60, 2 / 60
    m = round(2 * a / h)

    def second(n):
        return sparse.diags([1.0, -2.0, 1.0], [-1, 0, 1], shape=(n - 1, n - 1)) / h**2

    operator = sparse.kron(second(m), sparse.eye(n - 1)) + sparse.kron(sparse.eye(m - 1), second(n))
    operator -= decay**2 * sparse.eye((m - 1) * (n - 1))
    phi = sparse.linalg.spsolve(operator.tocsc(), -np.ones((m - 1) * (n - 1)))
    phi = phi.reshape(m - 1, n - 1)
    side, end = (2 * x - y / 2 for x, y in ((phi[:, 0], phi[:, 1]), (phi[0], phi[1])))
    T, released = np.sum(phi) * h**2, 2 * (np.sum(side**2) + a * np.sum(end**2)) / h
    low, high = film_stresses(a, half_width=1.0, decay=decay)
    assert 4 * a * low == pytest.approx(T / side.max() * h, rel=4e-3)
    assert 4 * a * high == pytest.approx(np.sqrt(8 * a * T**2 / released), rel=4e-3)


@pytest.mark.parametrize(("nu", "force"), [(0.5, (0.8327, 1.0605)), (0.3, (0.0431, 0.0433))])
def test_a_square_on_a_thin_bonded_layer_opens_in_the_middle_of_its_sides(nu, force):
    t, mu = 0.01, (1 - nu) / 2
    found = on_layer(
        1.0,
        half_width=1.0,
        contact_modulus=1.0,
        work_of_adhesion=1.0,
        thickness=t,
        base=Bonded(poisson_ratio=nu),
    )
    assert np.array(found) / np.sqrt(6 * mu / t**3) == pytest.approx(force, rel=4 * t)
    with pytest.raises(InputError, match="thicker"):
        on_layer(1e-4, half_width=1e-4, **SOLID, thickness=2.1e-5, base=BONDED)


def test_a_layer_thicker_than_half_the_width_is_refused():
    with pytest.raises(InputError, match="thick"):
        on_layer(150e-6, half_width=50e-6, **SOLID, thickness=60e-6, base=BONDED)
