"""The verification ladder of time-temperature shifts and of the Kramers-Kronig relation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.constants import gas_constant

from reference_data import VALUES
from viscotack.model.materials import shift

GLASS = 158.15  # PDMS, -115 C
ROOM = 293.15
warm = st.floats(150.0, 400.0)
LAWS = {
    "wlf": shift.WLF.from_glass_transition(GLASS),
    "arrhenius": shift.Arrhenius(ROOM, 90e3),
    "table": shift.TabulatedShift(300.0, (120.0, 180.0, 300.0, 450.0), (14.0, 9.0, 0.5, -2.0)),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


# ---- rung 1: identities ------------------------------------------------------------------------
def test_wlf_gives_the_verified_values():
    found = [v for v in VALUES if v["equation"] == "4.25"]
    valid = [v for v in found if v["inputs"]["T_C"] >= -130]
    assert len(valid) > 5
    for value in valid:
        inputs = value["inputs"]
        law = shift.WLF.from_glass_transition(GLASS)
        if "Tref_C" in inputs:
            law = law.at_reference(inputs["Tref_C"] + 273.15)
        # 293.15 - 20 and the like cost some digits
        assert law.log10_shift(inputs["T_C"] + 273.15) == pytest.approx(
            value["value"], rel=1e-12, abs=1e-12
        )


@every_law
@given(temperature=warm, reference=warm)
def test_a_law_seen_from_elsewhere_differs_by_its_value_there(law, temperature, reference):
    there = law.at_reference(reference)
    assert there.reference_temperature == reference
    # cancels, so absolute: shifts reach 30 decades near the pole
    assert there.log10_shift(temperature) == pytest.approx(
        law.log10_shift(temperature) - law.log10_shift(reference), rel=1e-10, abs=1e-10
    )


def test_arrhenius_is_the_boltzmann_factor():
    law = shift.Arrhenius(ROOM, 90e3)
    factor = np.exp(90e3 / gas_constant / 260.0) / np.exp(90e3 / gas_constant / ROOM)
    assert 10 ** law.log10_shift(260.0) == pytest.approx(factor, rel=1e-12, abs=0)


def test_a_table_passes_through_its_rows():
    law = LAWS["table"]
    values = np.array(law.values) - law.values[2]
    assert_allclose(law.log10_shift(np.array(law.temperature)), values, rtol=1e-14, atol=1e-14)


def test_the_error_of_a_table_is_that_of_its_rows_and_of_its_zero():
    table = shift.TabulatedShift(ROOM, (260.0, 280.0, ROOM), (3.0, 1.0, 0.0), (0.4, 0.3, 0.0))
    assert table.deviation(260.0, ROOM) == pytest.approx(0.4, rel=1e-15)
    assert table.deviation(270.0, ROOM) == pytest.approx(0.35, rel=1e-12)
    # both rows count as if they erred apart
    assert table.deviation(260.0, 280.0) == pytest.approx(0.5, rel=1e-12)
    assert table.deviation(280.0, 280.0) == 0
    assert shift.TabulatedShift(ROOM, (260.0, ROOM), (3.0, 0.0)).deviation(260.0, ROOM) == 0


# ---- rung 2: limits ----------------------------------------------------------------------------
def test_wlf_tends_to_arrhenius_near_its_reference():
    law = shift.WLF(reference_temperature=ROOM, c1=8.9, c2=102.0)
    # the same slope at the reference: c1/c2 = Ea/(R T0^2 ln 10)
    energy = law.c1 / law.c2 * gas_constant * ROOM**2 * np.log(10)
    step = np.array([0.1, 0.2, 0.4])
    gap = law.log10_shift(ROOM + step) - shift.Arrhenius(ROOM, energy).log10_shift(ROOM + step)
    assert np.polyfit(np.log(step), np.log(np.abs(gap)), 1)[0] == pytest.approx(2, abs=0.02)


def test_a_table_goes_on_straight_for_a_kelvin():
    # the chamber was at -0.01 C when it was set to 0 C
    table = shift.TabulatedShift(253.15, (243.15, 253.15, 273.14), (1.5, 0.0, -2.0))
    inside = np.diff(table.log10_shift([273.13, 273.14]))[0]
    beside = np.diff(table.log10_shift([273.15, 273.16]))[0]
    assert beside == pytest.approx(inside, rel=2e-3)
    assert table.log10_shift(273.15) < table.log10_shift(273.14)
    assert table.log10_shift(242.65) > 1.5
    with pytest.raises(ValueError, match="tables are not extrapolated"):
        table.log10_shift(274.2)


def test_a_table_ends_a_kelvin_beside_its_rows_and_a_law_at_its_pole():
    table = shift.TabulatedShift(ROOM, (273.15, ROOM), (2.0, 0.0), vertical=(-0.5, 0.0))
    # straight lines of 0.1 per kelvin
    assert_allclose(table.log10_shift([272.15, 294.15]), [2.1, -0.1], rtol=1e-12)
    assert table.log10_shift(300.0 - 7.0) > 0 and table.log10_shift(ROOM) == 0
    for outside, said in ((272.1, "-1.05 C"), (294.2, "21.05 C")):
        with pytest.raises(ValueError, match=f"covers 273.15 K .0 C. to 293.15 K.*{said}"):
            table.log10_shift([ROOM, outside])
    law = shift.WLF(reference_temperature=300.0, c1=5.0, c2=50.0)
    assert law.pole == 250.0
    assert law.log10_shift(275.0) == pytest.approx(5.0)
    with pytest.raises(ValueError, match="pole at 250 K"):
        law.log10_shift(250.0)
    with pytest.raises(ValueError, match="must lie above the pole"):
        law.at_reference(250.0)
    assert law.at_reference(251.0).c2 == 1.0


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"temperature": (280.0, 280.0)}, "must ascend, each once"),
        ({"values": (1.0, np.inf)}, "values of a table of shifts must be finite"),
        ({"uncertainty": (0.1, -0.1)}, "uncertainty .* not negative"),
    ],
)
def test_a_wrong_table_of_shifts_is_refused(changed, said):
    table = {"temperature": (280.0, ROOM), "values": (1.0, 0.0)}
    assert shift.TabulatedShift(ROOM, **table, uncertainty=(0.0, 0.1)).uncertainty == (0.0, 0.1)
    with pytest.raises(ValueError, match=said):
        shift.TabulatedShift(ROOM, **table | changed)
