"""Published materials against values that their sources state."""

import re
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from viscotack.app.operations import operation
from viscotack.app.operations.parts.solid import library
from viscotack.app.operations.request import Caller, request_of
from viscotack.model.materials.library import MATERIALS, passport_of, published

DOCS = Path(__file__).parents[1] / "docs" / "materials.md"
EXAMPLES = DOCS.parents[1] / "examples"


def modulus(name, omega):
    """Return storage and loss modulus [Pa] at an angular frequency [rad/s]."""
    value = complex(np.asarray(published(name).material.complex_modulus(omega)))
    return value.real, value.imag


def maxwell(omega, rubbery, *arms):
    """Return the complex modulus of a Prony series in the unit of its moduli."""
    return rubbery + sum(E * 1j * omega * t / (1 + 1j * omega * t) for E, t in arms)


def test_the_silicone_has_the_plateaus_and_exponent_of_the_thesis():
    # Eq. 4.27: 1.458 MPa, 3089 MPa; the slope between the plateaus is n
    low, _ = modulus("pdms-10-1", 1e-9)
    high, _ = modulus("pdms-10-1", 1e25)
    assert low == pytest.approx(1.458e6, rel=1e-2) and high == pytest.approx(3.089e9, rel=2e-2)
    solid = published("pdms-10-1").material
    creep = np.asarray(solid.creep(solid.tau0 * np.array([1e-12, 1e-11])))
    fast, slow = creep - 1 / 3.089e9
    assert np.log10(slow / fast) == pytest.approx(0.2207, rel=1e-2)


@pytest.mark.parametrize("omega", [2e-3, 0.1, 1.0])
def test_the_tape_has_the_shear_moduli_of_its_sources(omega):
    # shear moduli [kPa] and times [s] of Hossain et al., Table 1, and of Stewart and Anand
    hossain = maxwell(omega, 13.7, (56.4, 0.82), (31.5, 10.7), (19.8, 500.0))
    assert complex(*modulus("vhb-4910", omega)) == pytest.approx(3e3 * hossain, rel=1e-9)
    stewart = maxwell(omega, 15.36, (26.06, 0.6074), (26.53, 6.56), (10.83, 61.25))
    # chains that lock at a stretch of 5.85 are 2 % stiffer than 15.36 kPa from the beginning
    assert complex(*modulus("vhb-4910-stewart", omega)) == pytest.approx(3e3 * stewart, rel=2.1e-2)


# Engineering strain and stress [MPa] at two points of each tensile test.
TENSILE = {
    "ecoflex-00-30": ((0.09084, 0.00343), (0.5, 0.01689)),
    "ecoflex-00-50": ((0.09084, 0.004435), (0.5, 0.022775)),
    "dragon-skin-10": ((0.090842, 0.010128), (0.50001, 0.052996)),
    "dragon-skin-30": ((0.09084, 0.041493), (0.5, 0.21392)),
    "rtv-615": ((0.09084, 0.079613), (0.5, 0.38482)),
}


@pytest.mark.parametrize("name", TENSILE)
def test_the_silicones_have_the_stiffness_of_their_tensile_tests(name):
    (e1, s1), (e2, s2) = TENSILE[name]
    g1, g2 = (1 + e - (1 + e) ** -2 for e in (e1, e2))
    secant = 3e6 * (s2 - s1) / (g2 - g1)
    passport = published(name)
    ((_, low, high),) = passport.evidence.intervals
    assert low <= passport.material.rubbery_modulus <= high
    assert low <= secant <= high


def test_a_published_name_is_a_material_in_every_place(tmp_path):
    solid = published("vhb-4910").material
    asked = request_of(operation("theory greenwood"), {"material": "vhb-4910"})
    assert asked.solid(Caller()) == solid.reduced()
    assert passport_of("vhb-4910") is published("vhb-4910")
    lens = (EXAMPLES / "from_toml" / "lens.toml").read_text(encoding="utf-8")
    table = re.sub(r"(?ms)^\[material\]\n.*?(?=^\[)", '[material]\npassport = "vhb-4910"\n\n', lens)
    (tmp_path / "lens.toml").write_text(table, encoding="utf-8")
    assert vt.read_case(tmp_path / "lens.toml").material == solid
    assert {one["name"] for one in library()} == set(MATERIALS)
    with pytest.raises(ValueError, match="the library has dragon-skin-10"):
        published("sylgard")
