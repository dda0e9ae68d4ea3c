"""Tests of rectangular stamps: bounds on a half-space, estimate on a thin layer."""

import sys
from pathlib import Path

import numpy as np
import pytest

from viscotack.errors import InputError
from viscotack.geometry import Bonded, Frictionless
from viscotack.operations import ask
from viscotack.theory.elastic import disc
from viscotack.theory.punch import laws
from viscotack.theory.punch.rectangle import bounds, on_layer

BONDED = Bonded(poisson_ratio=0.45)
SOLID = {"contact_modulus": 1e6, "work_of_adhesion": 0.05}
STAMP = {
    "length": "300 um",
    "width": "100 um",
    "contact_modulus": "1 MPa",
    "work_of_adhesion": "50 mJ/m^2",
}


def test_a_square_holds_at_least_its_inscribed_disc_and_at_most_the_disc_around_it():
    low, high = bounds(1e-4, half_width=1e-4, **SOLID)
    inside, around = (
        disc.pull_off_force(contact_radius=a, **SOLID) for a in (1e-4, np.sqrt(2) * 1e-4)
    )
    assert low == pytest.approx(inside, rel=1e-12)
    # the area of the square under the stiffness of that disc
    assert high == pytest.approx(around * np.sqrt(2 / np.pi), rel=1e-12)


def test_bounds_scale_as_length_to_three_halves_and_know_no_order_of_the_sides():
    one = np.array(bounds(3e-4, half_width=1e-4, **SOLID))
    assert np.array(bounds(12e-4, half_width=4e-4, **SOLID)) == pytest.approx(8 * one, rel=1e-12)
    assert np.array(bounds(1e-4, half_width=3e-4, **SOLID)) == pytest.approx(one, rel=1e-12)


def test_a_stiffness_of_the_square_from_the_literature_lies_within_that_of_its_ellipses():
    # capacity of a square of side 1: 0.3667896 (Read, J. Comput. Phys. 133 (1997));
    # a disc has 2/pi times its radius
    exact = 0.3667896 * np.pi / 2 * 2  # radius of the equal disc over half the side
    assert 1 < exact < np.sqrt(2)
    low, high = bounds(1.0, half_width=1.0, contact_modulus=1.0, work_of_adhesion=1.0)
    sharper = np.sqrt(4 * 4 * 2 * exact)
    assert low < sharper < high


@pytest.mark.parametrize("ratio", [1, 2])
def test_contacts_that_open_cell_by_cell_lie_between_the_bounds(ratio, monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[2] / "benchmarks"))
    sys.modules.pop("rectangle", None)
    import rectangle

    n, unit = 12, {"contact_modulus": 1.0, "work_of_adhesion": 1.0}
    x, y = rectangle.cells(n, n)
    inside = np.hypot(x, y) < n / 2
    radius = np.sqrt(inside.sum() / np.pi)
    kendall = disc.pull_off_force(contact_radius=radius, **unit)
    scale = rectangle.pulled(x[inside], y[inside], 1.0) / kendall
    assert scale == pytest.approx(1, abs=0.1)
    low, high = bounds(ratio * n / 2, half_width=n / 2, **unit)
    found = rectangle.pulled(*rectangle.cells(n, ratio * n), 1.0) / scale
    assert 1.03 * low < found < high / 1.03


def test_on_a_thin_sliding_layer_every_plan_has_the_same_stress():
    low, high = on_layer(3e-4, half_width=1e-4, **SOLID, thickness=1e-6, base=Frictionless())
    stress = laws.thin_layer_pull_off_stress(1e-6, **SOLID, base=Frictionless())
    assert low < high < 1.01 * low
    assert low == pytest.approx(12e-8 * stress, rel=0.01)


def test_on_a_bonded_layer_the_estimate_ranges_from_strip_to_disc():
    low, high = on_layer(3e-4, half_width=1e-4, **SOLID, thickness=2e-5, base=BONDED)
    assert 1 < high / low < 1.5


@pytest.mark.parametrize(
    "given, words",
    [
        ({"thickness": "60 um"}, "thicker than half the width"),
        ({"strength": "50 kPa"}, "zone of attraction at an edge is 15.71 um"),
        ({"bonded": 0.3}, "bonded needs a layer"),
        ({"modulus_ratio": 2}, "modulus_ratio must lie in"),
    ],
)
def test_what_has_no_bound_is_refused_with_the_reason(given, words):
    with pytest.raises(InputError, match=words):
        ask("theory rectangle", **STAMP, **given)


def test_the_operation_states_bounds_slow_and_fast():
    record = ask("theory rectangle", **STAMP, modulus_ratio=0.04).record()
    low, high = bounds(150e-6, half_width=50e-6, **SOLID)
    assert record["kind"] == "bounds"
    assert record["least_pull_off_force_N"] == pytest.approx(low)
    assert record["most_pull_off_force_N"] == pytest.approx(high)
    assert record["fastest_most_pull_off_force_N"] == pytest.approx(5 * high)
    film = ask("theory rectangle", **STAMP, thickness="20 um").record()
    assert film["kind"] == "estimate"
    strong = ask("theory rectangle", **STAMP, strength="0.5 MPa", modulus_ratio=1e-4).record()
    assert strong["fastest_most_pull_off_force_N"] == pytest.approx(3e-8 * 0.5e6)
