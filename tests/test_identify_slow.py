"""The interface from a slow test: true values found, models chosen, what is not told said."""

from dataclasses import replace

import numpy as np
import pytest

from picture_units import in_si
from viscotack.app.operations.parts.records import slow_record
from viscotack.errors import InputError
from viscotack.identify import Objective, Parameter, SlowTest, identify_slow
from viscotack.model.materials.library import passport_of
from viscotack.plot.interface import draw_slow_test
from viscotack.theory import jkr, maugis

LENS = {"radius": 5.19e-3, "contact_modulus": 1.944e6, "work_of_adhesion": 0.152}


def of_jkr(seed, points=50, noise=0.02, against="radius", largest=3, sphere=LENS):
    """Return a noisy P(a) or P(depth) of a sphere, up to so many radii of its pull-off."""
    end = jkr.pull_off(**sphere)
    a = np.linspace(end.contact_radius, largest * end.contact_radius, points)
    sigma = noise * abs(end.force)
    force = jkr.force(a, **sphere) + sigma * np.random.default_rng(seed).standard_normal(points)
    at = a if against == "radius" else jkr.depth(a, **sphere) + 1e-6
    return SlowTest(force, at, against, sphere["radius"], sigma)


def of_maugis(tabor, seed, noise=0.005, against="radius"):
    lam = maugis.parameter_from_tabor(tabor)
    case = LENS | {"strength": lam / maugis.maugis_parameter(strength=1.0, **LENS)}
    end = maugis.pull_off(**case)
    state = maugis.curve(1 + np.geomspace(1e-5, 1e3, 3000), **case)
    chosen = (state.contact_radius > end.contact_radius) & (state.contact_radius < 6e-4)
    rows = np.flatnonzero(chosen)[:: max(int(chosen.sum()) // 60, 1)]
    sigma = noise * abs(end.force)
    force = state.force[rows] + sigma * np.random.default_rng(seed).standard_normal(rows.size)
    at = state.contact_radius[rows] if against == "radius" else state.depth[rows] + 2e-6
    return SlowTest(force, at, against, LENS["radius"], sigma)


def test_jkr_recovers_the_work_of_adhesion_from_noisy_forces_at_radii():
    fit = identify_slow(of_jkr(0), models=["jkr", "dmt"])
    assert fit.best.model == "jkr"
    assert fit.best.work_of_adhesion == pytest.approx(0.152, rel=0.02)
    assert fit.best.contact_modulus == pytest.approx(LENS["contact_modulus"], rel=0.02)
    above, below = draw_slow_test(fit).axes
    assert in_si(above.yaxis, above.lines[0].get_ydata()) == pytest.approx(fit.test.force)
    rest = below.lines[0].get_ydata()
    assert np.sqrt(np.mean(rest**2)) * fit.test.force_noise == pytest.approx(fit.best.scatter)


def test_a_range_that_matters_is_found_by_maugis_and_by_carpick():
    tabor = 1.5
    fit = identify_slow(of_maugis(tabor, 2))
    assert fit.best.model == "maugis"
    ends = fit.best.intervals["tabor"]
    assert ends.low < tabor < ends.high and ends.high < 1.2 * ends.low
    carpick = next(one for one in fit.fits if one.model == "carpick")
    # an approximation, which it is known to be within a few per cent
    assert carpick.tabor == pytest.approx(tabor, rel=0.25)
    assert fit.best.work_of_adhesion == pytest.approx(0.152, rel=0.01)
    for other in ("jkr", "dmt"):
        (one,) = (x for x in fit.fits if x.model == other)
        assert one.criterion > fit.best.criterion + 20 and one.intervals == {}


@pytest.mark.parametrize("modulus, contradicts", [(1.5e6, True), (1.95e6, False)])
def test_a_modulus_that_the_test_contradicts_leaves_an_upper_bound(modulus, contradicts):
    fit = identify_slow(of_jkr(1), models=["jkr"], contact_modulus=(modulus, 0.03 * modulus))
    assert bool(fit.upper_bound) == contradicts
    assert fit.work_of_adhesion.closed_below != contradicts
    assert fit.work_of_adhesion.high > LENS["work_of_adhesion"]


def test_a_range_that_the_data_determine_is_not_assumed():
    test = replace(of_maugis(1.5, 1), speed=1e-4, preload=1.5e-3)
    fit = identify_slow(test, models=["maugis"], material=passport_of("pdms-10-1").material)
    assert fit.same_pull.fast and fit.same_pull.assumed is None
    # from 5 % above the slow force on
    near = [replace(fit.same_pull, ratio=ratio).fast for ratio in (1.049, 1.051)]
    assert near == [False, True]


SMALL = {"radius": 5e-3, "contact_modulus": 2e6, "work_of_adhesion": 60.3e-3}


@pytest.mark.parametrize("noise, undetermined", [(0.0125, True), (0.012, False)])
def test_works_of_models_that_the_data_do_not_distinguish_are_all_given(noise, undetermined):
    test = of_jkr(3, 40, noise, "depth", largest=2, sphere=SMALL)
    fit = identify_slow(test, models=["jkr", "dmt"])
    apart = fit.fits[1].criterion - fit.fits[0].criterion
    assert fit.undetermined == undetermined == (apart < 6)
    record = slow_record(fit)
    assert (record["work_of_adhesion_J_m2"] is None) == undetermined
    assert len(record["alike"]) == 1 + undetermined
    for one in fit.alike:
        # of a JKR contact DMT reads a quarter less
        true = {"jkr": 60.3e-3, "dmt": 44.5e-3}[one.model]
        assert one.work_of_adhesion == pytest.approx(true, rel=0.02)
    assert fit.work_of_adhesion.low < 60.3e-3 < fit.work_of_adhesion.high


def test_a_profile_of_a_parabola_is_its_width():
    data = np.array([1.0, 2.0, 4.0])
    mean = Parameter("mean", -100.0, 100.0, 0.0, logarithmic=False)
    objective = Objective(lambda values: (values["mean"] - data) / 0.5, (mean,))
    best = objective.best()
    assert best.values["mean"] == pytest.approx(data.mean(), rel=1e-6)
    ends, half = objective.interval("mean", best, level=0.9), 1.6449 * 0.5 / np.sqrt(3)
    assert (ends.low, ends.high) == pytest.approx(
        (best.values["mean"] - half, best.values["mean"] + half), rel=2e-2
    )
    pulled = Objective(objective.residuals, (replace(mean, prior=(0.0, 0.5)),)).best()
    assert pulled.values["mean"] == pytest.approx(data.sum() / 4, rel=1e-6)


@pytest.mark.parametrize("change", [{"force": np.ones(50)}, {"at": -np.ones(50)}, {"radius": 0.0}])
def test_a_test_without_information_is_refused(change):
    with pytest.raises(InputError):
        replace(of_jkr(0), **change)
