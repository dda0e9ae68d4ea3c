"""The second code of steady cracks and round contacts, beside the package and beside itself."""

import json

import numpy as np
import pytest

from research.replication.second_code import compare, half_plane, sphere
from research.replication.second_code.__main__ import KEPT
from viscotack.theory import lennard_jones

COARSE = {"elements": 110, "degree": 14, "step": 0.5}


def test_an_elastic_crack_has_the_work_of_adhesion():
    (crack,) = half_plane.cracks(half_plane.Solid(1.0, ()), [0.0], **COARSE)
    assert crack.energy == pytest.approx(1.0, abs=1e-4)


def test_a_power_law_has_the_weights_of_its_spectrum():
    solid = half_plane.Solid.power_law(0.1, 0.6)
    weights, times = np.array(solid.modes).T
    assert solid.instantaneous + weights.sum() == pytest.approx(1.0, rel=1e-12)
    # the mean of the gamma distribution
    assert weights @ times == pytest.approx(0.9 * 0.6, rel=1e-6)


def test_energy_and_zone_agree_with_the_package():
    (row,) = compare.plane(0.1, None, (1.0,), **COARSE)
    assert abs(row["energy_off"]) < 3e-4
    assert row["gap_off"] < 3e-3
    assert row["traction_off"] < 5e-3


def test_the_operator_of_a_sphere_has_the_rise_under_a_hertzian_pressure():
    r, _ = sphere.mesh(1.0, 0.02)
    rise, _ = sphere.operator(r)
    # p = sqrt(1 - r^2): rise pi/4 (2 - r^2) inside
    pressed = rise @ np.sqrt(np.maximum(1 - r**2, 0.0))
    inside = r < 0.9
    assert np.allclose(pressed[inside], np.pi / 4 * (2 - r[inside] ** 2), rtol=3e-3)


def test_an_elastic_pull_off_agrees_with_the_table_of_the_package():
    # of second order in the spacing
    coarse, fine = (sphere.pull_off(5.0, refined=r).force for r in (0.6, 1.2))
    known = lennard_jones.pull_off_ratio(5.0)
    assert abs(fine / known - 1) < 5e-4
    assert abs((4 * fine - coarse) / 3 / known - 1) < 5e-5


def test_the_kept_rows_agree():
    kept = json.loads(KEPT.read_text("utf-8"))
    assert max(abs(row["energy_off"]) for row in kept["plane"]) < 5e-4
    assert max(abs(row["off"]) for row in kept["elastic"]) < 1e-4


@pytest.mark.slow
def test_rows_of_each_table_are_computed_again():
    # `python -m research.replication.second_code` computes all, in three minutes
    kept = json.loads(KEPT.read_text("utf-8"))
    found = {
        "plane": compare.plane(*compare.PLANE[-1]),
        "elastic": [compare.elastic(tabor) for tabor in (20.0, 200.0)],
        "moving": [compare.moving(30.0, 10.0)],
    }
    for name, key, close in (
        ("plane", "energy", 1e-6),
        ("elastic", "force", 2e-5),
        ("moving", "factor", 2e-5),
    ):
        inputs = [k for k in ("modulus_ratio", "exponent", "tabor", "speed") if k in kept[name][0]]
        rows = {tuple(row[k] for k in inputs): row for row in kept[name]}
        for new in found[name]:
            old = rows[tuple(new[k] for k in inputs)]
            assert new[key] == pytest.approx(old[key], rel=close), old
