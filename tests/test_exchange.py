"""Prony series to and from other programs: each convention, both ways."""

import numpy as np
import pytest
from scipy.constants import gas_constant

from viscotack.model.materials import Prony
from viscotack.model.materials.exchange import CODES, SI, Units, exported, imported
from viscotack.model.materials.shift import WLF, Arrhenius, TabulatedShift

SOLID = Prony(
    rubbery_modulus=1.458e6,
    branches=[(2.5e7, 3.1e-6), (4e6, 2e-3), (1.1e6, 0.7), (3e5, 41.0)],
    poisson_ratio=0.47,
)
every_code = pytest.mark.parametrize("code", CODES)
# what the ratios to the instantaneous modulus lose: round-off over the modulus ratio
LOST = 1e-15 / SOLID.modulus_ratio


@every_code
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
        ("abaqus", ["*ELASTIC, MODULI=LONG TERM", "1000000.0, 0.25", "0.75, 0.75, 0.5"]),
        ("ansys", ["MP,EX,1,4000000.0", "MP,NUXY,1,0.25", "TB,PRONY,1,1,1,SHEAR",
                   "TBDATA,1,0.75,0.5", "TB,PRONY,1,1,1,BULK"]),
        ("comsol", ["% linear elastic material: long-term Young's modulus 1000000.0",
                    "1 1200000.0 0.5"]),
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
    # the number of pairs and the series may be left out
    for start in ("TB,PRONY,1,,2,SHEAR  ! two", "TB,PRONY,1,,2", "TB,PRONY,1,", "TB,PRONY,1"):
        text = f"MP,EX,1,10\nMP,PRXY,1,0.5\n{start}\nTBDATA,1,0.5,0.1,0.4,2\n"
        solid = imported(text, "ansys", units=Units("MPa", "s"))
        assert solid.branches == ((5e6, 0.1), (4e6, 2.0))


# ---- what the programs make of it: other readers, and their own formulas -----------------------


def words_of(line, separator=","):
    return [word.strip() for word in line.split(separator)]


def read_abaqus(text):
    """Return G(0), K(0), g_i, k_i, tau_i, and the row of *TRS."""
    blocks, key = {}, ""
    for line in text.splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            key = line
            blocks[key] = []
        else:
            blocks[key].append([float(w) for w in words_of(line)])
    (E, nu), rows = blocks["*ELASTIC, MODULI=LONG TERM"][0], blocks["*VISCOELASTIC, TIME=PRONY"]
    g, k, tau = np.array(rows).T
    shift = {key: rows[0] for key, rows in blocks.items() if key.startswith("*TRS")}
    # long-term moduli are those left of the instantaneous ones
    return E / 2 / (1 + nu) / (1 - g.sum()), E / 3 / (1 - 2 * nu) / (1 - k.sum()), g, k, tau, shift


def read_ansys(text):
    """Return G(0), K(0), alpha of shear and bulk, tau, and the rows of TB,SHIFT."""
    constants, tables, shift = {}, {"SHEAR": [], "BULK": []}, {}
    rows = None
    for line in text.splitlines():
        words = words_of(line.split("!")[0])
        if words[0] == "MP":
            constants[words[1]] = float(words[3])
        elif words[0] == "TB":
            rows = tables[words[5]] if words[1] == "PRONY" else shift.setdefault(words[5], [])
        elif words[0] == "TBDATA":
            rows += [float(w) for w in words[2:]]
    E, nu = constants["EX"], constants["NUXY"]
    g, tau = np.reshape(tables["SHEAR"], (-1, 2)).T
    k = np.reshape(tables["BULK"], (-1, 2))[:, 0] if tables["BULK"] else 0 * g
    return E / 2 / (1 + nu), E / 3 / (1 - 2 * nu), g, k, tau, shift


def pulled(card, time):
    """Return axial stress of one element pulled at once to a strain of 1 and held, over time [s].

    Free at its sides. Marched: in each step the branches decay exactly and the sideways strain is
    that of no sideways stress, with the recursion of the two programs' manuals, in which a branch
    takes (1 - exp(-dt/tau)) tau/dt of an increment of strain.
    """
    G, K, g, k, tau, _ = card
    shear, bulk = np.zeros_like(g), np.zeros_like(k)  # of each branch: stress deviator, pressure
    d, v, stress, before = 0.0, 0.0, [], 0.0
    rest_g, rest_k = 1 - g.sum(), 1 - k.sum()
    for i, t in enumerate(time):
        dt = t - before
        decay = np.exp(-dt / tau) if i else np.ones_like(tau)
        gain = -np.expm1(-dt / tau) * tau / dt if i else np.ones_like(tau)
        # unknown: strain sideways e; d = (2/3) (1 - e) axial deviator, v = 1 + 2 e volume
        at = []
        for e in (0.0, 1.0):
            new_d, new_v = 2 / 3 * (1 - e), 1 + 2 * e
            s = decay * shear + gain * 2 * G * g * (new_d - d)
            p = decay * bulk + gain * K * k * (new_v - v)
            axial = 2 * G * rest_g * new_d + s.sum()
            pressure = K * rest_k * new_v + p.sum()
            at.append((pressure - axial / 2, axial + pressure, s, p, new_d, new_v))
        e = -at[0][0] / (at[1][0] - at[0][0])
        mix = [(1 - e) * a + e * b for a, b in zip(at[0], at[1], strict=True)]
        stress.append(mix[1])
        shear, bulk, d, v, before = *mix[2:], t
    return np.array(stress)


READERS = {"abaqus": read_abaqus, "ansys": read_ansys}
TIMES = np.concatenate(([0.0], np.geomspace(1e-7, 1e3, 400)))


@pytest.mark.parametrize("code", READERS)
@pytest.mark.parametrize("nu", [0.3, 0.47])
def test_one_element_relaxes_as_the_material_in_the_programs_formulas(code, nu):
    solid = Prony(rubbery_modulus=SOLID.rubbery_modulus, branches=SOLID.branches, poisson_ratio=nu)
    stress = 1e6 * pulled(READERS[code](exported(solid, code, units=Units("MPa", "s"))), TIMES)
    np.testing.assert_allclose(stress, solid.relaxation(TIMES), rtol=1e-9)


@pytest.mark.parametrize("code", READERS)
def test_an_incompressible_solid_needs_a_bulk_modulus_and_relaxes_with_it(code):
    solid = Prony(rubbery_modulus=1e6, branches=SOLID.branches, poisson_ratio=0.5)
    with pytest.raises(ValueError, match=f"{code} forbids a Poisson ratio of 0.5; give the bulk"):
        exported(solid, code)
    text = exported(solid, code, bulk_modulus=2e9)
    card = READERS[code](text)
    assert card[1] == pytest.approx(2e9, rel=1e-6) and not np.any(card[3])
    stress = pulled(card, TIMES)
    # E = 9 K G/(3 K + G), at short times 0.17 % less than 3 G: that is said
    np.testing.assert_allclose(stress, solid.relaxation(TIMES), rtol=2e-3)
    assert stress[0] / solid.glassy_modulus - 1 == pytest.approx(-1.741e-3, rel=1e-3)
    assert "at short times is 0.17 % below" in text
    with pytest.raises(ValueError, match="must exceed the glassy shear modulus"):
        exported(solid, code, bulk_modulus=1e6)


def test_shift_laws_go_along():
    law, cold = WLF(reference_temperature=293.15, c1=8.0, c2=100.0), 273.15
    assert read_abaqus(exported(SOLID, "abaqus", shift=law))[5] == {
        "*TRS, DEFINITION=WLF": [293.15, 8.0, 100.0]
    }
    T, c1, c2 = read_ansys(exported(SOLID, "ansys", shift=law))[5]["WLF"]
    # Ansys has A = 1/a_T
    assert c1 * (cold - T) / (c2 + cold - T) == pytest.approx(-law.log10_shift(cold))
    law = Arrhenius(293.15, 1e5)
    T, energy = read_abaqus(exported(SOLID, "abaqus", shift=law))[5]["*TRS, DEFINITION=ARRHENIUS"]
    decades = energy / gas_constant * (1 / cold - 1 / T) / np.log(10)
    assert decades == pytest.approx(law.log10_shift(cold))
    T, ratio = read_ansys(exported(SOLID, "ansys", shift=law))[5]["TN"]
    assert ratio * (1 / T - 1 / cold) / np.log(10) == pytest.approx(-law.log10_shift(cold))
    table = TabulatedShift(293.15, (253.15, 293.15), (5.0, 0.0))
    for code in ("abaqus", "ansys"):
        text = exported(SOLID, code, shift=table)
        assert "fit a WLF or Arrhenius law" in text
        assert imported(exported(SOLID, code, shift=law), code) == imported(text, code)
    assert "has no temperature shift" in exported(SOLID, "comsol", shift=law)


UNITS, ANSYS, COMSOL = (f"{mark} units: pressure Pa, time s\n" for mark in ("**", "!", "%"))


@pytest.mark.parametrize(
    ("code", "text", "words"),
    [
        ("abaqus", "*ELASTIC\n1,0.3\n", "does not state its units"),
        ("abaqus", UNITS + "*ELASTIC\n1,0.3\n*VISCOELASTIC, TIME=PRONY\n.5,0.,1\n",
         "line 5: shear and bulk relax differently"),
        ("abaqus", UNITS + "*ELASTIC\n1,0.3\n*VISCOELASTIC, TIME=PRONY\n1.,1.,1\n",
         "sum to 1; a solid needs a sum below 1"),
        ("abaqus", UNITS + "*VISCOELASTIC, TIME=PRONY\n.5,.5,1\n", r"no \*ELASTIC"),
        ("ansys", ANSYS + "MP,EX,1,1\nMP,NUXY,1,.5\nTB,PRONY,1,,1,SHEAR\n"
         "TBDATA,1,.5\n", "TB states 1 pairs, but 1 numbers follow"),
        ("comsol", COMSOL + "1 2 3\n", "lacks the long-term"),
    ],
)  # fmt: skip
def test_what_cannot_be_understood_is_refused_with_its_line(code, text, words):
    with pytest.raises(ValueError, match=words):
        imported(text, code)
