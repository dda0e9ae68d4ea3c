"""Shifts from overlap, master curves, laws of shift, and the Kramers-Kronig check."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from melts import ROOM, swept
from reference_data import DMA
from solids import creep_power_law
from viscotack.lab import (
    FrequencySweeps,
    contradiction,
    fit_arrhenius,
    fit_wlf,
    master_curve,
    nearest_law,
    read_dma,
    shift_factors,
)
from viscotack.lab.fit.master_curve import causal_misfit
from viscotack.lab.fit.overlap import Curve, Hold, step_between
from viscotack.model.materials.shift import WLF, Arrhenius, TabulatedShift

TEN = np.geomspace(0.1, 100, 10)
# the thesis's PDMS (Eq. 4.27) and its shift (Eq. 4.25)
PDMS = creep_power_law(1.458e6, 3.089e9, 0.2207, 0.01876, 0.5)
SHIFT = WLF.from_glass_transition(158.15).at_reference(ROOM)
# every ten kelvin where the shift is slow, closer towards the glass
CHAMBER = np.array([176, 179, 182, 186, 190, 195, 200, 210, 225, 240, 260, 280, ROOM])


def measured(temperature=CHAMBER, hertz=TEN, *, law=SHIFT, solid=PDMS, **more):
    """Return sweeps of a known solid with a known shift."""
    return swept(solid, law, temperature, hertz, **more)


@pytest.mark.parametrize("by", ["loss", "both"])
def test_exact_data_give_back_the_shift(by):
    found = shift_factors(measured(), reference_temperature=ROOM, by=by, vertical="none")
    assert_allclose(found.temperature, CHAMBER)
    # pieces of a curve that is no polynomial
    assert_allclose(found.values, SHIFT.log10_shift(CHAMBER), atol=3e-3)
    assert found.vertical == ()
    # a thermometer that is off by 0.2 K, here and at the reference
    slope = SHIFT.c1 * SHIFT.c2 / (SHIFT.c2 + CHAMBER - ROOM) ** 2
    kelvins = np.where(CHAMBER == ROOM, 0.0, 0.2 * np.hypot(slope, slope[-1]))
    assert_allclose(found.uncertainty, kelvins, rtol=0.15, atol=5e-3)


def test_the_variance_of_a_shift_is_a_jackknife_over_four_blocks():
    # a line of slope 1, and errors that are equal within each block of the overlap: without block k
    # the shift changes by -error_k/3, so that the variance is 3/4 * 4 * (error/3)^2
    x, error = np.linspace(0, 2, 41), 0.01
    blocks = error * np.array([1.0, -1.0, -1.0, 1.0])
    off = np.append(np.repeat(blocks, 10), blocks[-1])
    step = step_between(Curve(x, (x,)), Curve(x, (x + 0.5 + off,)), Hold())
    assert step.shift == pytest.approx(0.5, abs=0.01)
    assert step.variance == pytest.approx(error**2 / 3, rel=0.3)


def test_a_first_point_that_lags_behind_its_temperature_hardly_counts():
    sweeps = measured()
    first = np.isin(np.arange(len(sweeps)) % 10, [0])
    lagging = replace(sweeps, storage=np.where(first, 0.93, 1) * sweeps.storage)
    found = shift_factors(lagging, reference_temperature=ROOM)
    assert_allclose(found.values, SHIFT.log10_shift(CHAMBER), atol=0.1)


def test_a_vertical_shift_is_found_with_the_horizontal_one():
    # near the rubbery plateau the shape fixes both directions; along a power law it would not
    solid = creep_power_law(1e6, 1e8, 0.8, 2e-2, 0.5)
    law = Arrhenius(ROOM, 60e3)
    chamber = np.array([275.0, 280.0, 285.0, 290.0, ROOM])
    sweeps = measured(chamber, up=5e-4, law=law, solid=solid)
    found = shift_factors(sweeps, reference_temperature=ROOM, by="both", vertical="free")
    assert_allclose(found.values, law.log10_shift(chamber), atol=5e-3)
    assert_allclose(found.vertical, 5e-4 * (chamber - ROOM), atol=1e-3)
    curve = master_curve(sweeps, reference_temperature=ROOM, by="both", vertical="free")
    exact = solid.complex_modulus(curve.angular_frequency)
    assert_allclose(curve.storage, exact.real, rtol=0.01)


def test_the_reference_may_lie_between_two_temperatures():
    found = shift_factors(measured(), reference_temperature=270.0)
    there = SHIFT.at_reference(270.0).log10_shift(CHAMBER)
    # a cubic between rows 20 K apart
    assert_allclose(found.values, there, atol=0.02)


def test_the_ramp_of_the_thesis_becomes_the_curve_of_its_material():
    ramp = measured(np.arange(-130, 21, 10) + 273.15, [1.0])
    curve = master_curve(ramp, reference_temperature=ROOM, shift=WLF.from_glass_transition(158.15))
    exact = PDMS.complex_modulus(curve.angular_frequency)
    assert_allclose(curve.storage, exact.real, rtol=1e-10)
    assert_allclose(curve.loss, exact.imag, rtol=1e-10)
    assert np.all(np.diff(curve.angular_frequency) > 0)
    # the coldest point, 15 K below the glass transition
    assert curve.temperature[-1] == pytest.approx(143.15)
    assert np.log10(curve.angular_frequency[-1] / 2 / np.pi) == pytest.approx(19.765, abs=1e-3)
    assert len(curve.shifts) == 16
    assert "WLF with c1 = 17.44, c2 = 51.6 K at 158.15 K" in curve.source.notes[-1]


def test_a_table_shifts_the_points_near_its_rows_and_interpolates_between():
    sweeps = measured([275.3, 284.0, 294.8], hertz=[1.0, 10.0])
    rows = np.array([275.0, 280.0, 290.0, 295.0])
    table = TabulatedShift(295.0, rows, (2.0, 1.5, 0.5, 0.0), vertical=(0.1, 0.1, 0.1, 0.0))
    curve = master_curve(sweeps, reference_temperature=295.0, shift=table)
    by_row = TabulatedShift(295.0, tuple(rows), (2.0, 1.5, 0.5, 0.0))
    for celsius, shift in ((275.3, 2.0), (284.0, by_row.log10_shift(284.0)), (294.8, 0.0)):
        found = curve.angular_frequency[curve.temperature == celsius]
        assert_allclose(found, 2 * np.pi * np.array([1, 10]) * 10**shift)
    seen_from_280 = master_curve(sweeps, reference_temperature=280.0, shift=table)
    assert_allclose(seen_from_280.angular_frequency, curve.angular_frequency * 10**-1.5)
    assert_allclose(seen_from_280.storage, curve.storage * 10**-0.1)
    cold = curve.temperature == 275.3
    expected = np.sort(sweeps.storage[sweeps.temperature == 275.3] * 10**0.1)
    assert_allclose(curve.storage[cold], expected)
    with pytest.raises(ValueError, match="table of shifts covers 275 K"):
        master_curve(measured([250.0], [1.0, 2.0]), reference_temperature=295.0, shift=table)


@pytest.mark.parametrize(
    ("sweeps", "keywords", "words"),
    [
        (measured(), {"reference_temperature": None}, "reference_temperature"),
        (measured(hertz=[1.0]), {}, "a temperature ramp at one frequency has no overlap"),
        (measured([120.0 + 273.15]), {}, "two or more temperatures"),
        (
            FrequencySweeps([np.nan], [1], [1e6], [1e5], "G", [0]),
            {"shift": SHIFT},
            "temperature of some points is unknown",
        ),
    ],
)
def test_what_cannot_be_shifted_is_refused(sweeps, keywords, words):
    with pytest.raises(ValueError, match=words):
        master_curve(sweeps, **{"reference_temperature": ROOM, **keywords})


# log10 a_T that pyvisco 2.1.3 (BSD-3) finds from the published sweeps, reference -5 C, for
# -50, -42, -35, -27, -20, -12, -5, 3, 10, 18, 25, 32, 40, 47, 55, 62, 70, 77, 85, 92, 100 C.
PYVISCO = np.array(
    [10.2363, 9.3633, 7.8398, 6.0950, 4.2639, 1.9905, 0.0, -1.9106, -3.4089, -5.0334, -6.6891,
     -8.4451, -10.3053, -12.1011, -13.4251, -14.5105, -15.4572, -16.3060, -17.0672, -17.7498,
     -18.3450]
)  # fmt: skip


def test_an_independent_code_finds_the_same_shifts_from_the_published_sweeps():
    # storage alone, as that code does
    found = shift_factors(
        read_dma(DMA / "freq_user_raw.csv"),
        reference_temperature=298.15,
        by="storage",
        vertical="none",
    )
    difference = np.abs(np.diff(found.values) - np.diff(PYVISCO))
    # 18 of 20 steps, of 0.6 to 2.3 decades each; all above 3 C
    assert np.sum(difference < 0.1) >= 18
    assert np.max(difference[7:]) < 0.1
    # in the glass storage hardly rises and its first points lag: -50 to -42 C and -5 to 3 C
    assert np.max(difference) < 0.3


def test_the_law_behind_a_table_is_found():
    table = TabulatedShift(ROOM, CHAMBER, SHIFT.log10_shift(CHAMBER))
    for reference in (ROOM, 220.0):
        found = fit_wlf(table, reference_temperature=reference)
        exact = SHIFT.at_reference(reference)
        assert found.law.c1 == pytest.approx(exact.c1, rel=1e-6)
        assert found.law.c2 == pytest.approx(exact.c2, rel=1e-6)
        assert found.misfit < 1e-6
    law = Arrhenius(ROOM, 75e3)
    rows = np.array([250.0, 270.0, 290.0, 310.0])
    found = fit_arrhenius(
        TabulatedShift(ROOM, rows, law.log10_shift(rows) + 0.7), reference_temperature=ROOM
    )
    assert found.law.activation_energy == pytest.approx(75e3, rel=1e-10)
    # a straight line over 1/T: the error of its slope, 0.01 decades of scatter added to the stated
    doubted = TabulatedShift(ROOM, rows, law.log10_shift(rows), np.full(4, 0.02))
    unit = Arrhenius(ROOM, 1.0).log10_shift(rows)
    expected = np.hypot(0.02, 0.01) / np.sqrt(np.sum((unit - unit.mean()) ** 2))
    found = fit_arrhenius(doubted, reference_temperature=ROOM)
    assert found.standard_error == pytest.approx([expected], rel=1e-9)


@pytest.mark.parametrize(("share", "kind"), [(0.9, Arrhenius), (1.1, WLF)])
def test_one_constant_more_is_taken_where_it_gains_the_logarithm_of_the_number_of_rows(share, kind):
    rows = np.linspace(270.0, 320.0, 60)
    exact, line = SHIFT.log10_shift(rows), Arrhenius(ROOM, 1.0).log10_shift(rows)
    bent = exact - np.polyval(np.polyfit(line, exact, 1), line)
    # the square of the deviation of a straight line, over that of a row
    error = np.sqrt(bent @ bent / (share * np.log(60)) - 0.01**2)
    table = TabulatedShift(ROOM, rows, exact, np.full(60, error))
    assert isinstance(nearest_law(table, reference_temperature=ROOM).law, kind)


def test_the_errors_of_a_law_are_those_of_repeated_tables():
    rng = np.random.default_rng(0)
    rows = np.linspace(200, 330, 12)
    wlf, arrhenius = [], []
    activated = Arrhenius(ROOM, 75e3)
    for _ in range(20):
        noise = 0.05 * rng.standard_normal(rows.size)
        error = np.full(rows.size, 0.05)
        one = TabulatedShift(ROOM, rows, SHIFT.log10_shift(rows) + noise, error)
        wlf.append(fit_wlf(one, reference_temperature=ROOM))
        other = TabulatedShift(ROOM, rows, activated.log10_shift(rows) + noise, error)
        arrhenius.append(fit_arrhenius(other, reference_temperature=ROOM))
    for fits, truth in (
        (wlf, lambda law: (law.c1 - SHIFT.c1, law.c2 - SHIFT.c2)),
        (arrhenius, lambda law: (law.activation_energy - 75e3,)),
    ):
        scores = np.array([np.array(truth(fit.law)) / np.array(fit.standard_error) for fit in fits])
        assert np.all(np.abs(np.std(scores, axis=0) - 1) < 0.35)


def test_only_the_right_glass_transition_makes_the_ramp_of_the_thesis_causal():
    ramp = measured(np.arange(-130, 21, 10) + 273.15, [1.0], noise=0.02)
    off = {}
    for celsius in (-125, -115, -105):
        law = WLF.from_glass_transition(celsius + 273.15)
        curve = master_curve(ramp, reference_temperature=ROOM, shift=law)
        off[celsius] = max(causal_misfit(curve))
    assert off[-115] < 0.012
    assert min(off[-125], off[-105]) > 0.03


def test_a_loss_of_another_solid_is_a_contradiction():
    curve = master_curve(measured(), reference_temperature=ROOM, shift=SHIFT)
    assert contradiction(replace(curve, loss=1.5 * curve.loss))
    assert not contradiction(replace(curve, loss=1.05 * curve.loss))
