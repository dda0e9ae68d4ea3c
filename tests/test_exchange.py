"""Prony series to and from other programs: each convention, both ways."""

import numpy as np
import pytest

from viscotack.materials import Prony
from viscotack.materials.exchange import CODES, SI, Units, exported, imported

SOLID = Prony(
    rubbery_modulus=1.458e6,
    branches=[(2.5e7, 3.1e-6), (4e6, 2e-3), (1.1e6, 0.7), (3e5, 41.0)],
    poisson_ratio=0.47,
)
every_code = pytest.mark.parametrize("code", CODES)
# what the ratios to the instantaneous modulus lose: round-off over the modulus ratio
LOST = 1e-15 / SOLID.modulus_ratio


@every_code
@pytest.mark.parametrize("units", [SI, Units("MPa", "s"), Units("kPa", "ms")])
@pytest.mark.parametrize("nu", [0.3, 0.47, 0.5])
def test_a_series_comes_back_as_it_went(code, units, nu):
    solid = Prony(rubbery_modulus=SOLID.rubbery_modulus, branches=SOLID.branches, poisson_ratio=nu)
    back = imported(exported(solid, code, units=units, notes=("a name", "two\nlines")), code)
    # the columns of Radioss hold 13 digits
    allowed = 1e-12 if code == "radioss" else 2 * LOST
    assert back.poisson_ratio == nu
    assert back.rubbery_modulus == pytest.approx(solid.rubbery_modulus, rel=allowed, abs=0)
    np.testing.assert_allclose(back.branches, solid.branches, rtol=allowed)


@pytest.mark.parametrize("code", ["comsol", "tamaas"])
def test_absolute_moduli_lose_nothing(code):
    back = imported(exported(SOLID, code), code)
    assert back.rubbery_modulus == SOLID.rubbery_modulus
    np.testing.assert_allclose(back.branches, SOLID.branches, rtol=4e-16)


ONE = Prony(rubbery_modulus=1e6, branches=[(3e6, 0.5)], poisson_ratio=0.25)
G = 3e6 / 2.5


@pytest.mark.parametrize(
    ("code", "lines"),
    [
        ("abaqus", ["*ELASTIC, MODULI=LONG TERM", "1000000.0, 0.25", "0.75, 0.75, 0.5"]),
        ("ansys", ["MP,EX,1,4000000.0", "MP,NUXY,1,0.25", "TB,PRONY,1,1,1,SHEAR",
                   "TBDATA,1,0.75,0.5", "TB,PRONY,1,1,1,BULK"]),
        ("comsol", ["% linear elastic material: long-term Young's modulus 1000000.0",
                    "1 1200000.0 0.5"]),
        ("radioss", ["/VISC/PRONY/1", f"{1:10d}{'':10}{0.0:20.12E}{0:10d}{0:10d}",
                     f"{G:20.12E}{2.0:20.12E}{3e6 / 1.5:20.12E}{2.0:20.12E}"]),
        ("tamaas", ["model.E = 1000000.0", "model.nu = 0.25", "shear_moduli = [1200000.0]",
                    "characteristic_times = [0.5]"]),
    ],
)  # fmt: skip
def test_each_convention_by_hand(code, lines):
    written = exported(ONE, code).splitlines()
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
    text = "MP,EX,1,10\nMP,PRXY,1,0.5\nTB,PRONY,1,,2,SHEAR  ! two\nTBDATA,1,0.5,0.1,0.4,2\n"
    solid = imported(text, "ansys", units=Units("MPa", "s"))
    assert solid.branches == ((5e6, 0.1), (4e6, 2.0))


UNITS, ANSYS, COMSOL, HASH = (
    f"{mark} units: pressure Pa, time s\n" for mark in ("**", "!", "%", "#")
)


@pytest.mark.parametrize(
    ("code", "text", "words"),
    [
        ("abaqus", "*ELASTIC\n1,0.3\n", "does not say its units"),
        ("abaqus", UNITS + "*ELASTIC\n1,0.3\n*VISCOELASTIC, TIME=PRONY\n.5,0.,1\n",
         "line 5: shear and bulk relax differently"),
        ("abaqus", UNITS + "*ELASTIC\n1,0.3\n*VISCOELASTIC, TIME=PRONY\n.5,x,1\n",
         "line 5: a value must be a number, got 'x'"),
        ("abaqus", UNITS + "*ELASTIC\n1,0.3\n*VISCOELASTIC, TIME=PRONY\n1.,1.,1\n",
         "sum to 1: a solid needs less"),
        ("abaqus", UNITS + "*ELASTIC\n1,0.3\n", "no branch"),
        ("abaqus", UNITS + "*VISCOELASTIC, TIME=PRONY\n.5,.5,1\n", r"no \*ELASTIC"),
        ("ansys", ANSYS + "MP,EX,1,1\nMP,NUXY,1,.3\nTB,PRONY,1,,1,SHEAR\n"
         "TBDATA,1,.5,1\n", "shear and bulk relax differently"),
        ("ansys", ANSYS + "MP,EX,1,1\nMP,NUXY,1,.5\nTB,PRONY,1,,1,SHEAR\n"
         "TBDATA,1,.5\n", "TB says 1 pairs, and 1 numbers follow"),
        ("comsol", COMSOL + "1 2 3\n", "does not say the long-term"),
        ("radioss", HASH + "/VISC/PRONY/1\n         1\n", "give both"),
        ("tamaas", HASH + "model.E = 1\n", "model.nu and shear_moduli"),
        ("tamaas", HASH + "model.E = open('x')\n", "must be plain numbers"),
        ("nastran", "", "must be one of abaqus"),
    ],
)  # fmt: skip
def test_what_cannot_be_understood_is_refused_with_its_line(code, text, words):
    with pytest.raises(ValueError, match=words):
        imported(text, code)


@every_code
def test_cut_or_scrambled_text_never_crashes(code):
    text = exported(SOLID, code)
    rng = np.random.default_rng(7)
    for cut in range(0, len(text), 7):
        _read_or_refuse(text[:cut], code)
    for _ in range(60):
        letters = list(text)
        for place in rng.integers(0, len(text), 5):
            letters[place] = chr(rng.integers(32, 127))
        _read_or_refuse("".join(letters), code)


def _read_or_refuse(text, code):
    try:
        assert isinstance(imported(text, code), Prony)
    except ValueError as error:
        assert str(error)
