"""Growth of the work of adhesion with contact time from tests after several dwells."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import t as student

import tack_files
import viscotack as vt
from viscotack.app.operations import ask
from viscotack.errors import InputError
from viscotack.identify import identify_dwell
from viscotack.identify.contact_time import check_relaxed
from viscotack.theory import jkr

TIMES = np.repeat([1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0], 2)
RUBBER = """[material]
model = "elastic"
rubbery_modulus = "0.75 MPa"
poisson_ratio = 0.5
"""
FORMS = {
    "logarithmic": lambda t: 0.05 * (1 + 0.3 * np.log1p(t / 10)),
    "saturating": lambda t: 0.05 * (1 + 1.5 * -np.expm1(-t / 20)),
    "old": lambda t: 0.05 * (1 + 0.1 * np.log1p(t / 0.01)),
    "none": lambda t: 0.05 + 0 * t,
}


def fitted(form, noise=0.005, seed=0, times=TIMES):
    scatter = 1 + noise * np.random.default_rng(seed).standard_normal(times.size)
    return identify_dwell(times, 1.5 * np.pi * 5e-3 * FORMS[form](times) * scatter, radius=5e-3)


@pytest.mark.parametrize(
    "form, size", [("logarithmic", "sensitivity"), ("saturating", "largest_growth")]
)
def test_a_law_whose_time_lies_among_the_dwells_is_found_with_its_constants(form, size):
    found = fitted(form)
    assert found.law == f"{form}-ageing"
    time = {"logarithmic": 10.0, "saturating": 20.0}[form]
    low, high = found.reference_time
    assert low < time < high < 3 * low
    assert found.parameters["work_of_adhesion"] == pytest.approx(0.05, rel=0.03)
    assert found.parameters[size] == pytest.approx({"logarithmic": 0.3}.get(form, 1.5), rel=0.1)


def test_of_an_old_logarithm_only_work_and_growth_are_determined():
    found = fitted("old")
    assert found.law == "logarithmic-ageing"
    assert found.reference_time[0] == 0
    # the stated constants reproduce the works at the times of the tests
    law = vt.LogarithmicAgeing(equilibrium_gap=1.0, **found.parameters)
    works = law.work_of_adhesion * (1 + law.growth_after(TIMES))
    assert works == pytest.approx(FORMS["old"](TIMES), rel=0.01)


def test_without_growth_no_law_is_stated_in_nearly_all_series():
    laws = [fitted("none", 0.02, seed).law for seed in range(40)]
    assert sum(law is not None for law in laws) <= 2


@pytest.mark.parametrize("level", [0.8, 0.9])
def test_intervals_of_growth_and_reference_time_are_those_of_student(level):
    t, count = TIMES, TIMES.size
    F = 1e-3 * (1 + 0.3 * np.log1p(t / 10)) * (1 + 0.08 * np.cos(3 * np.arange(count) ** 2))
    found = identify_dwell(t, F, radius=tack_files.SPHERE["radius"], level=level)

    def line(shape):
        """Return b over a of the fit a + b shape, and its relative misfit."""
        rows = np.column_stack([np.ones(count), shape]) / F[:, None]
        least, miss = np.linalg.lstsq(rows, np.ones(count))[:2]
        return least[1] / least[0], float(miss[0])

    x = np.log10(t) - np.log10(t).mean()
    slope, miss = line(x)
    # about the geometric mean of the times
    wide = student.ppf((1 + level) / 2, count - 2) * np.sqrt(miss / (count - 2) / np.sum(x**2))
    assert found.interval == pytest.approx((slope - wide, slope + wide), rel=1e-3)
    trial = np.geomspace(0.05, 200, 4000)
    misfits = np.array([line(np.log1p(t / t0))[1] for t0 in trial])
    limit = misfits.min() * (1 + student.ppf((1 + level) / 2, count - 3) ** 2 / (count - 3))
    ends = trial[misfits < limit][[0, -1]]
    # its points are a twentieth of a decade apart
    assert np.log10(found.reference_time) == pytest.approx(np.log10(ends), abs=0.06)


@pytest.mark.parametrize("times", [[1.0, 1.0, 10.0, 10.0], [1.0, 2.0, 3.0, 4.0]])
def test_too_few_dwells_are_refused(times):
    with pytest.raises(InputError, match="dwells"):
        identify_dwell(times, np.ones(len(times)), radius=5e-3)


def test_a_solid_that_relaxes_between_the_dwells_is_refused():
    solid = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=3e6, tau0=2.0, poisson_ratio=0.5)
    check_relaxed(solid, np.array([50.0, 1e3]))
    with pytest.raises(InputError, match="the modulus relaxes by"):
        check_relaxed(solid, np.array([1.0, 1e3]))


@pytest.fixture
def files(tmp_path, monkeypatch):
    """Write tests after five dwells on an interface whose work grows by their logarithm."""
    monkeypatch.chdir(tmp_path)
    names = []
    for number, dwell in enumerate([10.0, 30.0, 100.0, 300.0, 1000.0]):
        sphere = tack_files.SPHERE
        pulled = (tack_files.DEEP - jkr.instability(**sphere).depth) / tack_files.SPEED
        work = 0.1 * (1 + 0.1 * np.log1p((dwell + pulled) / 0.01))
        test = tack_files.made(2e-6, sphere=sphere | {"work_of_adhesion": work}, seed=number)
        later = np.clip(np.arange(test.time.size) - 499, 0, 60) / 60 * (dwell - tack_files.DWELL)
        names.append(f"dwell_{number}.csv")
        Path(names[-1]).write_bytes(tack_files.plain(replace(test, time=test.time + later)))
    return names


def test_files_of_several_dwells_give_the_growth(files):
    answer = ask("identify dwell", files=files, material=RUBBER, radius="5 mm")
    record = answer.record()
    middle = 0.1 * (1 + 0.1 * np.log1p(np.exp(np.log(record["times_s"]).mean()) / 0.01))
    assert record["work_of_adhesion_J_m2"] == pytest.approx(middle, rel=0.01)
    low, high = record["growth_interval"]
    assert low < 0.01 * np.log(10) / middle < high
    assert record["growth_per_decade"] == pytest.approx(0.01 * np.log(10) / middle, rel=0.1)
    assert answer.pictures["plot"]().axes[0].get_xscale() == "log"


def test_a_rate_series_with_growing_forces_of_several_dwells_is_refused(files):
    with pytest.raises(InputError, match="these tests are no repeats"):
        ask("identify rates", files=files, material=RUBBER, radius="5 mm")
