"""The manuscript: a changed kept number stops the build."""

import numpy as np
import pytest

from research.paper import closed_forms, numbers
from viscotack.theory import persson_brener


def test_a_kept_number_that_differs_stops_the_build():
    numbers.check("same", 1.0, 1.0 + 1e-9, 1e-6)
    with pytest.raises(numbers.Stale, match="kept 1, computed 1.001"):
        numbers.check("energy", 1.0, 1.001, 1e-6)


def test_a_changed_row_of_the_second_code_is_found(monkeypatch):
    rows = [{"modulus_ratio": 0.1, "exponent": None, "speed": 1.0, "package": 1.9}]
    monkeypatch.setattr(numbers, "kept", lambda name: {"plane": rows})
    with pytest.raises(numbers.Stale, match="energy at 1.0"):
        numbers.checked()


def test_closed_forms_have_their_limits_and_that_of_the_package():
    q = np.array([1e-6, 1e6])
    for form in closed_forms.FORMS.values():
        assert form(q) == pytest.approx([0.0, 1.0], abs=2e-5)
    crack = numbers.crack(0.1)
    length = closed_forms.length_of_strength("Persson-Brener", crack.traction.reduced().strength)
    speed = np.array([0.1, 1.0, 10.0])
    own = closed_forms.energies("Persson-Brener", speed, crack, length)
    assert own == pytest.approx(
        np.asarray(persson_brener.amplification(speed / length, material=crack.material)), rel=1e-4
    )


def test_the_line_energy_of_dugdales_law_is_that_of_maugis():
    # f = 1 + l/6a, with an error of the next order
    assert numbers.dugdale(40.0)[1] == pytest.approx(1 / 6, rel=1e-3)
    assert numbers.dugdale(10.0)[1] == pytest.approx(1 / 6, rel=1e-2)


def test_the_derived_factor_is_the_better_one_between_the_elastic_ends():
    data = numbers.factors()
    off = {
        name: np.abs(data[name] / data["simulated"] - 1)[data["inside"]]
        for name in ("rule", "bounded")
    }
    assert data["inside"].sum() >= 36
    assert np.median(off["bounded"]) < 0.6 * np.median(off["rule"])
    assert off["bounded"].max() < 0.6 * off["rule"].max()
