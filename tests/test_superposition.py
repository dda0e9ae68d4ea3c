"""Shifts of melts, whose plateau misleads storage alone; tests over time; what contradicts."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from melts import CHAMBER, EXPANSION, LAW, REFERENCE, creeps, melt, relaxations, swept, vertical
from viscotack.lab import (
    CreepTest,
    RelaxationTest,
    allow_for_shifts,
    contradiction,
    fit,
    master_curve,
    nearest_law,
    shift_factors,
    superposed,
    superposition,
)
from viscotack.lab.fit.report import issued
from viscotack.model.materials import FractionalZener, StandardSolid
from viscotack.model.materials.passport_file import read_passport, write_passport
from viscotack.model.materials.shift import WLF, TabulatedShift

TRUE, TEN = LAW.log10_shift(CHAMBER), np.geomspace(0.1, 30, 10)
QUANTILE = 1.645  # of a 90 % interval


@cache
def curve_of_melt(seed):
    return master_curve(melt(seed), reference_temperature=REFERENCE)


@pytest.mark.parametrize(
    "keywords",
    [{"vertical": EXPANSION}, {"by": "tan", "vertical": "auto"}],
    ids=str,
)
def test_both_moduli_find_the_shift_of_a_melt(keywords):
    table = master_curve(melt(1), reference_temperature=REFERENCE, **keywords).shifts
    assert_allclose(table.values, TRUE, atol=0.1)
    assert_allclose(table.vertical, -np.log10(vertical(CHAMBER)), atol=0.03)
    assert np.max(table.uncertainty) < 0.06


def test_moduli_do_not_move_unless_asked():
    table = curve_of_melt(1).shifts
    assert table.vertical == ()
    assert_allclose(table.values, TRUE, atol=0.1)
    # sweeps without a vertical shift: a fitted one moves the horizontal shift away from the truth
    solid = FractionalZener(
        rubbery_modulus=1e6, glassy_modulus=1e9, order=0.5, tau0=1.0, poisson_ratio=0.5
    )
    each = [swept(solid, LAW, CHAMBER[:5], TEN, noise=0.01, seed=seed) for seed in range(2)]
    off = {
        keywords.get("vertical"): np.array([
            master_curve(one, reference_temperature=REFERENCE, **keywords).shifts.values
            for one in each
        ]) - TRUE[:5]
        for keywords in ({}, {"vertical": "auto"})
    }  # fmt: skip
    assert np.sqrt(np.mean(off[None] ** 2)) < 0.02
    assert np.sqrt(np.mean(off["auto"] ** 2)) > 1.2 * np.sqrt(np.mean(off[None] ** 2))


def test_shifting_by_storage_alone_has_an_error_for_a_melt_and_reports_it():
    with pytest.raises(ValueError, match="do not determine the shift"):
        master_curve(melt(2), reference_temperature=REFERENCE, by="storage", vertical="none")
    sweeps = melt(2)
    sweeps = sweeps.chosen(sweeps.sweep != 0)
    curve = master_curve(sweeps, reference_temperature=REFERENCE, by="storage", vertical="none")
    off = np.abs(np.array(curve.shifts.values) - TRUE[1:])
    assert np.max(off) > 0.3
    assert np.all(off <= QUANTILE * np.array(curve.shifts.uncertainty) + 1e-9)
    words = " ".join(superposition(sweeps, curve.shifts))
    assert "do not superpose in loss" in words
    assert "other shifts" in words
    assert "Kramers-Kronig" in contradiction(curve)


@pytest.mark.parametrize("draws", [3, pytest.param(20, marks=pytest.mark.slow)])
def test_intervals_hold_the_true_shift(draws):
    tables = [curve_of_melt(seed).shifts for seed in range(draws)]
    off = np.array([table.values for table in tables]) - TRUE
    doubt = np.array([table.uncertainty for table in tables])
    held = np.delete(np.abs(off) <= QUANTILE * doubt, 1, axis=1)  # without the reference
    # the six of a draw have an error in common; of 600 it was 95 %
    assert np.mean(held) > (0.75 if draws < 20 else 0.85)
    score = np.delete(off / np.where(doubt == 0, 1, doubt), 1, axis=1)
    assert 0.4 < np.sqrt(np.mean(score**2)) < 1.4


def test_a_sweep_that_is_off_is_named():
    sweeps = melt(0)
    bad = np.where(sweeps.sweep == 3, np.linspace(0.5, 2.0, len(sweeps)), 1.0)
    spoilt = replace(sweeps, loss=sweeps.loss * np.where(bad == 1, 1, 1.5), storage=sweeps.storage)
    words = " ".join(superposition(spoilt, curve_of_melt(0).shifts))
    assert "do not superpose in loss" in words
    assert "-10 C" in words


def test_a_law_for_the_table_is_found_or_none_is():
    table = shift_factors(melt(0, thermometer=0.0), reference_temperature=REFERENCE)
    found = nearest_law(table, reference_temperature=REFERENCE)
    assert isinstance(found.law, WLF)
    error = np.array([found.law.c1 - LAW.c1, found.law.c2 - LAW.c2]) / found.standard_error
    assert np.all(np.abs(error) < 2)
    stairs = TabulatedShift(REFERENCE, CHAMBER, [3, 2.9, 1.5, 1.4, 0.2, 0.1, -2], np.full(7, 0.02))
    assert nearest_law(stairs, reference_temperature=REFERENCE) is None


def test_uncertain_shifts_widen_intervals_and_go_into_the_passport(tmp_path):
    solid = StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1.0, poisson_ratio=0.5)
    sweeps = swept(solid, LAW, CHAMBER[:5], TEN, noise=0.01)
    curve = master_curve(sweeps, reference_temperature=REFERENCE, vertical="auto")
    plain = fit(curve, poisson_ratio=0.5, model="sls", draws=5)
    report = allow_for_shifts(plain, curve, curve.shifts)
    before, after = (r.interval("tau0") for r in (plain, report))
    assert after.value == before.value
    assert np.log(after.high / after.low) > 1.1 * np.log(before.high / before.low)
    assert any("the uncertainty of the shifts" in words for words in report.cautions)
    # shifts that are certain change nothing
    sure = replace(curve.shifts, uncertainty=np.zeros(5))
    assert allow_for_shifts(plain, curve, sure) is plain

    passport = issued(report, name="x", shift=curve.shifts)
    write_passport(passport, tmp_path / "x.toml")
    back = read_passport(tmp_path / "x.toml")
    assert back == passport
    assert back.shift.uncertainty == curve.shifts.uncertainty
    assert back.shift.vertical == curve.shifts.vertical
    assert isinstance(back.fitted_shift.law, WLF)
    assert back.shift_deviation(CHAMBER[0]) == pytest.approx(curve.shifts.uncertainty[0])


@pytest.mark.parametrize("make", [relaxations, creeps])
def test_tests_over_time_superpose(make):
    tests = make(0, temperatures=CHAMBER[:5])
    curve, table = superposed(tests, reference_temperature=REFERENCE, vertical=EXPANSION)
    assert_allclose(table.values, TRUE[:5], atol=0.1)
    assert np.all(
        np.abs(np.array(table.values) - TRUE[:5]) <= 2.6 * np.array(table.uncertainty) + 1e-9
    )
    assert curve.temperature == REFERENCE
    assert len(curve) == sum(map(len, tests))
    exact, _ = superposed(tests, reference_temperature=REFERENCE, shift=LAW)
    assert_allclose(exact.time[[0, -1]], curve.time[[0, -1]], rtol=0.3)


def test_a_vertical_shift_multiplies_a_modulus_and_divides_a_compliance():
    time, factor = np.geomspace(0.1, 10, 10), 1.2
    table = TabulatedShift(293.15, (293.15, 313.15), (0.0, -1.0), vertical=(0.0, np.log10(factor)))
    found = []
    for kind, power in ((RelaxationTest, 1), (CreepTest, -1)):
        # a solid that is softer by the factor and ten times faster when it is hot
        cold, hot = time**-0.3, (10 * time) ** -0.3 / factor
        tests = [
            kind(time, values**power, "G", temperature=T)
            for T, values in ((293.15, cold), (313.15, hot))
        ]
        curve, _ = superposed(tests, reference_temperature=293.15, shift=table)
        values = curve.modulus if kind is RelaxationTest else 1 / curve.compliance
        assert_allclose(values, curve.time**-0.3, rtol=1e-12)
        found.append(len(curve))
    assert found == [20, 20]
