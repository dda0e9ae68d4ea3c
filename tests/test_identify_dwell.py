"""Growth of the work of adhesion with contact time from tests after several dwells."""

from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import t as student

import tack_files
import viscotack as vt
from rate_tests import GAP, LENS, PRELOAD, RADIUS, RUBBER, WORK, holds
from viscotack import identify
from viscotack.app.operations.parts.records import forecast_rows
from viscotack.identify.forward import Forward
from viscotack.lab.tack import Measured, survey
from viscotack.theory import edge_law, jkr

TIMES = np.repeat([1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0], 2)
TABLE = """[material]
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
    return identify.identify_dwell(
        times, 1.5 * np.pi * 5e-3 * FORMS[form](times) * scatter, radius=5e-3
    )


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
    found = identify.identify_dwell(t, F, radius=tack_files.SPHERE["radius"], level=level)

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
    with pytest.raises(vt.InputError, match="dwells"):
        identify.identify_dwell(times, np.ones(len(times)), radius=5e-3)


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
    answer = vt.ask("identify dwell", files=files, material=TABLE, radius="5 mm")
    record = answer.record()
    middle = 0.1 * (1 + 0.1 * np.log1p(np.exp(np.log(record["times_s"]).mean()) / 0.01))
    assert record["work_of_adhesion_J_m2"] == pytest.approx(middle, rel=0.01)
    low, high = record["growth_interval"]
    assert low < 0.01 * np.log(10) / middle < high
    assert record["growth_per_decade"] == pytest.approx(0.01 * np.log(10) / middle, rel=0.1)
    assert answer.pictures["plot"]().axes[0].get_xscale() == "log"


def of_design(speeds, times, work, noise=0.015, seed=0, own=1e-3):
    """Return pull-offs of an edge law, evaluated as those of files, one test a speed and time."""
    (cycle,) = survey([LENS[1]]).cycles
    scatter = 1 + noise * np.random.default_rng(seed).standard_normal(len(speeds))
    forces = scatter * edge_law.pull_off_force(speeds, work_of_adhesion=work, **EDGE)
    first = np.arange(cycle.time.size) > cycle.segments.dwell
    return identify.pull_offs(
        [
            replace(
                cycle,
                speed=Measured(float(v), 0.0),
                time=cycle.time
                + np.where(first, t - identify.contact_time.contact_time(cycle), 0.0),
                pull_off_force=Measured(float(F), own * float(F)),
            )
            for v, t, F in zip(speeds, times, forces, strict=True)
        ]
    )


def edge_fit(tests):
    case = {"radius": EDGE["radius"], "preload": EDGE["preload"], "theory": 0.002}
    return identify.identify_edge(identify.RateSeries(tests, material=SOLID, **case))


CASE = Path(__file__).parents[1] / "examples" / "from_toml" / "lens.toml"
EDGE = {"radius": 5e-3, "contact_modulus": 2e6, "preload": 2e-3}
EDGE |= {"reference_speed": 5e-5, "exponent": 0.4}
SOLID = vt.Elastic(rubbery_modulus=1.5e6, poisson_ratio=0.5)
FOUR, DWELLS = np.geomspace(1e-6, 1e-3, 4), np.array([10.0, 100.0, 1000.0])
V, T = (x.ravel() for x in np.meshgrid(FOUR, DWELLS, indexing="ij"))


@pytest.mark.parametrize("growth", [0.06, 0.0])
def test_speeds_and_dwells_together_give_edge_law_and_growth_in_time(growth):
    fit = edge_fit(of_design(V, T, 0.06 * (1 + growth * np.log10(T / 100)), seed=1))
    truth = {"work_of_adhesion": 0.06, "reference_speed": 5e-5, "exponent": 0.4}
    for name, value in (truth | {"growth_per_decade": growth}).items():
        assert fit.intervals[name].low < value < fit.intervals[name].high
    ends = fit.intervals["growth_per_decade"]
    # a slope of 12 tests over two decades, with their scatter of 1.5 %
    assert 0.5 < (ends.high - ends.low) / (2 * 1.645 * 0.015 / np.sqrt(8)) < 2
    assert (fit.ageing.chance < 1e-4) == bool(growth)
    assert fit.given.middle_time == pytest.approx(100) and not fit.ageing.together
    assert fit.describes_tests and not fit.unexplained
    if growth:
        forecast = identify.forecast_edge(fit, [3e-5])
        assert holds(forecast, edge_law.pull_off_force([3e-5], work_of_adhesion=0.06, **EDGE))
        (row,) = forecast_rows(forecast)
        assert row["contact_time_s"] == pytest.approx(100)


@pytest.mark.slow
def test_an_interface_that_grows_with_time_is_found_and_forecast_after_another_dwell(monkeypatch):
    speeds, times = (x.ravel() for x in np.meshgrid([1e-6, 3e-5, 1e-3], DWELLS, indexing="ij"))

    def pulled(speeds, times):
        work = WORK * (1 + 0.06 * np.log10(np.asarray(times) / 100))
        return Forward(RUBBER, RADIUS).pulled(work, GAP, speeds, PRELOAD).force

    noise = 1 + 0.015 * np.random.default_rng(2).standard_normal(9)
    rows = zip(speeds, pulled(speeds, times) * noise, times, strict=True)
    tests = [identify.PullOff(v, Measured(F, 0.015 * F), contact_time=t) for v, F, t in rows]
    case = {"material": RUBBER, "radius": RADIUS, "preload": PRELOAD, "theory": 0.002}
    fit = identify.identify_rates(identify.RateSeries(tests, **case))
    for name, value in (
        ("work_of_adhesion", WORK),
        ("equilibrium_gap", GAP),
        ("growth_per_decade", 0.06),
    ):
        assert fit.intervals[name].low < value < fit.intervals[name].high
    speed = np.array([1e-4])
    assert holds(identify.forecast_rates(fit, speed), pulled(speed, [100.0]))
    later = identify.forecast_rates(fit, speed, dwell=1e4, approach_speed=1e-4)
    assert later.contact_time == pytest.approx([1e4], rel=1e-3)
    assert holds(later, pulled(speed, [1e4])) and later.low > pulled(speed, [300.0])
    monkeypatch.setattr(
        "viscotack.app.operations.uncertainty.fitted", lambda *_: SimpleNamespace(fit=fit)
    )
    known = {"study": "known.toml", "samples": 6}
    told = vt.ask("uncertainty", problem=str(CASE), **known).notes
    assert any("100 s" in note for note in told)


def test_where_the_dwell_goes_with_the_speed_their_effects_are_not_separate():
    speeds = np.geomspace(1e-6, 1e-3, 5)
    times = 1 + 1e-3 / speeds
    tests = of_design(speeds, times, 0.06)
    alone = edge_fit(tests)
    assert alone.given.confounded and alone.ageing is None
    unknown = edge_fit([replace(one, contact_time=None) for one in tests])
    assert not unknown.given.confounded and alone.best == unknown.best
    # one more dwell at the slowest speed separates them a little
    speeds, times = np.append(speeds, 1e-6), np.append(times, 400.0)
    more = edge_fit(of_design(speeds, times, 0.06, own=0.015))
    assert not more.given.confounded and more.ageing.together == ("exponent",)


def test_tests_that_one_interface_does_not_explain_are_named():
    work = 0.06 * (1 + 0.06 * np.log10(T / 100))
    one = work * np.where((V == FOUR[1]) & (T == 100), 1.2, 1)
    fit = edge_fit(of_design(V, T, one, noise=0.0, own=0.01))
    assert [(fit.series[i].speed, fit.series[i].contact_time) for i in fit.unexplained] == [
        pytest.approx((FOUR[1], 100))
    ]


def test_a_series_of_several_dwells_needs_a_relaxed_solid():
    solid = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=3e6, tau0=2.0, poisson_ratio=0.5)
    tests = [
        identify.PullOff(v, Measured(4e-3, 1e-5), 1e-3, contact_time=t)
        for v in (1e-6, 1e-5)
        for t in (1, 9)
    ]
    with pytest.raises(vt.InputError, match="relaxes"):
        identify.RateSeries(tests, material=solid, radius=5e-3)
    identify.RateSeries(tests[::2], material=solid, radius=5e-3)
    # by more than 2 %
    for left, refused in ((1.019, False), (1.021, True)):
        creeping = SimpleNamespace(relaxation=lambda t, left=left: left if t < 5 else 1.0)
        with pytest.raises(vt.InputError, match="2%") if refused else nullcontext():
            identify.contact_time.check_relaxed(creeping, np.array([1.0, 9.0]))


def test_without_an_approach_the_time_in_contact_is_unknown():
    (cycle,) = survey([LENS[1]]).cycles
    bare = replace(cycle, segments=replace(cycle.segments, begin=cycle.segments.dwell))
    assert identify.contact_time.contact_time(cycle) == pytest.approx(60.4, rel=1e-3)
    assert identify.contact_time.contact_time(bare) is None
    with pytest.raises(vt.InputError, match="approach"):
        identify.contact_time.tests_by_dwell([bare])


def test_files_of_several_speeds_and_dwells_give_the_growth_beside_the_edge_law(files):
    names = []
    for speed in (1, 2, 4, 8):
        for number in (0, 4):
            rows = Path(files[number]).read_text().splitlines()
            head, *rows = rows
            table = np.array([[float(x) for x in row.split(",")] for row in rows])
            back = np.argmax(np.diff(table[:, 1]) < 0)
            step = np.diff(table[:, 0], prepend=table[0, 0])
            step[back + 1 :] /= speed
            table[:, 0] = np.cumsum(step)
            table[:, 2] *= np.where(table[:, 2] < 0, 1 + 0.1 * np.log(speed), 1)
            names.append(f"{speed}_{number}.csv")
            np.savetxt(names[-1], table, delimiter=",", header=head, comments="")
    about = {"radius": "5 mm", "contact_modulus": "1 MPa", "preload": "2 mN"}
    found = vt.ask("identify edge", files=names, **about).record()
    middle = 0.1 * (1 + 0.1 * np.log(found["ageing"]["middle_time_s"] / 0.01))
    grown = found["ageing"]["growth_per_decade"]
    # forces of these files are proportional to the work, those of an edge law nearly so
    assert grown == pytest.approx(0.01 * np.log(10) / middle, rel=0.1)
    assert found["ageing"]["separate"] and len(found["series"]) == 8
