"""Prony series to and from other programs: each convention, both ways."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.constants import gas_constant

from viscotack.model.materials import Prony
from viscotack.model.materials.exchange import SI, Units, exported, imported
from viscotack.model.materials.shift import WLF, Arrhenius, TabulatedShift

SOLID = Prony(
    rubbery_modulus=1.458e6,
    branches=[(2.5e7, 3.1e-6), (4e6, 2e-3), (1.1e6, 0.7), (3e5, 41.0)],
    poisson_ratio=0.47,
)
# what the ratios to the instantaneous modulus lose: round-off over the modulus ratio
LOST = 1e-15 / SOLID.modulus_ratio


@pytest.mark.parametrize("code", ["abaqus", "ansys"])
@pytest.mark.parametrize(
    ("units", "nu"), [(SI, 0.3), (Units("MPa", "s"), 0.47), (Units("kPa", "ms"), 0.5)]
)
def test_a_series_comes_back_as_it_went(code, units, nu):
    solid = Prony(rubbery_modulus=SOLID.rubbery_modulus, branches=SOLID.branches, poisson_ratio=nu)
    bulk = 2e9 if nu == 0.5 else None
    text = exported(solid, code, units=units, notes=("a name", "two\nlines"), bulk_modulus=bulk)
    back = imported(text, code)
    assert back.poisson_ratio == nu
    assert back.rubbery_modulus == pytest.approx(solid.rubbery_modulus, rel=2 * LOST, abs=0)
    np.testing.assert_allclose(back.branches, solid.branches, rtol=2 * LOST)


ONE = Prony(rubbery_modulus=1e6, branches=[(3e6, 0.5)], poisson_ratio=0.25)


@pytest.mark.parametrize(
    ("code", "lines"),
    [
        # ratios to the instantaneous moduli E0 + E1, of shear and bulk alike
        ("abaqus", ["*ELASTIC, MODULI=LONG TERM", "1000000.0, 0.25", "0.75, 0.75, 0.5",
                    "*TRS, DEFINITION=WLF", "293.15, 8.0, 100.0"]),
        ("ansys", ["MP,EX,1,4000000.0", "MP,NUXY,1,0.25", "TB,PRONY,1,1,1,SHEAR",
                   "TBDATA,1,0.75,0.5", "TB,PRONY,1,1,1,BULK", "TB,SHIFT,1,1,3,WLF",
                   "TBDATA,1,293.15,8.0,100.0"]),
        ("comsol", ["% linear elastic material: long-term Young's modulus 1000000.0",
                    "1 1200000.0 0.5"]),
    ],
)  # fmt: skip
def test_each_convention_by_hand(code, lines):
    written = exported(
        ONE, code, shift=WLF(reference_temperature=293.15, c1=8.0, c2=100.0)
    ).splitlines()
    for line in lines:
        assert line in written
    assert any("units: pressure Pa, time s" in line for line in written)


def test_what_an_analyst_typed_is_read():
    text = """*Heading
 a model
*Material, name=steel
*Elastic
 210000., 0.3
*Material, name=rubber
*Density
 1.1e-9,
*Elastic, moduli=INSTANTANEOUS
 10., 0.5
*Viscoelastic, time=PRONY
 0.5, 0., 0.1
 0.4, , 2.
*Material, name=glass
*Elastic
 70000., 0.2
"""
    solid = imported(text, "abaqus", units=Units("MPa", "s"))
    assert solid.rubbery_modulus == pytest.approx(1e6)
    assert solid.branches == ((5e6, 0.1), (4e6, 2.0))
    # the number of pairs and the series may be left out
    for start in ("TB,PRONY,1,,2,SHEAR  ! two", "TB,PRONY,1,,2", "TB,PRONY,1,", "TB,PRONY,1"):
        text = f"MP,EX,1,10\nMP,PRXY,1,0.5\n{start}\nTBDATA,1,0.5,0.1,0.4,2\n"
        solid = imported(text, "ansys", units=Units("MPa", "s"))
        assert solid.branches == ((5e6, 0.1), (4e6, 2.0))


def floats(text):
    """Return the decimal numbers in what is no comment."""
    lines = [line for line in text.splitlines() if not line.startswith(("**", "!"))]
    return [float(number) for number in re.findall(r"\d+\.\d+", "\n".join(lines))]


@pytest.mark.parametrize(("code", "modulus"), [("abaqus", 1e6), ("ansys", 4e6)])
def test_an_incompressible_solid_needs_a_bulk_modulus_that_does_not_relax(code, modulus):
    solid = replace(ONE, poisson_ratio=0.5)
    with pytest.raises(ValueError, match=f"{code} forbids a Poisson ratio of 0.5; give the bulk"):
        exported(solid, code)
    text = exported(solid, code, bulk_modulus=2e9)
    # at rest for one program and at once for the other, with the shear modulus of the solid
    G, K = modulus / 3, 2e9
    given = 9 * K * G / (3 * K + G), (3 * K - 2 * G) / (6 * K + 2 * G)
    assert floats(text)[:2] == pytest.approx(given, rel=1e-12)
    assert floats(text)[2:] == ([0.75, 0.0, 0.5] if code == "abaqus" else [0.75, 0.5])
    assert "at short times is 0.022 % below" in text
    with pytest.raises(ValueError, match="must exceed the glassy shear modulus"):
        exported(solid, code, bulk_modulus=1e6)


def test_shift_laws_go_along():
    law = Arrhenius(293.15, 1e5)
    assert floats(exported(ONE, "abaqus", shift=law))[-2:] == [293.15, 1e5]
    # Ansys has A = 1/a_T, ln A = H/R (1/T0 - 1/T)
    at = [293.15, 1e5 / gas_constant]
    assert floats(exported(ONE, "ansys", shift=law))[-2:] == pytest.approx(at)
    table = TabulatedShift(293.15, (253.15, 293.15), (5.0, 0.0))
    for code in ("abaqus", "ansys"):
        text = exported(SOLID, code, shift=table)
        assert "fit a WLF or Arrhenius law" in text
        assert imported(exported(SOLID, code, shift=law), code) == imported(text, code)
    assert "has no temperature shift" in exported(SOLID, "comsol", shift=law)


UNITS, ANSYS = (f"{mark} units: pressure Pa, time s\n" for mark in ("**", "!"))


@pytest.mark.parametrize(
    ("code", "text", "words"),
    [
        ("abaqus", "*ELASTIC\n1,0.3\n", "does not state its units"),
        ("abaqus", UNITS + "*ELASTIC\n1,0.3\n*VISCOELASTIC, TIME=PRONY\n.5,0.,1\n",
         "line 5: shear and bulk relax differently"),
        ("abaqus", UNITS + "*VISCOELASTIC, TIME=PRONY\n.5,.5,1\n", r"no \*ELASTIC"),
        ("ansys", ANSYS + "MP,EX,1,1\nMP,NUXY,1,.5\nTB,PRONY,1,,1,SHEAR\n"
         "TBDATA,1,.5\n", "TB states 1 pairs, but 1 numbers follow"),
        ("ansys", ANSYS + "MP,EX,1,1\nTB,PRONY,1,,1,SHEAR\nTBDATA,1,.5,2\n", "lacks Young's"),
        ("comsol", UNITS + "1 2 3\n", "program must be one of abaqus, ansys"),
    ],
)  # fmt: skip
def test_what_cannot_be_understood_is_refused_with_its_line(code, text, words):
    with pytest.raises(ValueError, match=words):
        imported(text, code)
