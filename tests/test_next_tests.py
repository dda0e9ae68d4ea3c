"""The next test: what it leaves of the uncertainty, before and after it is made."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import viscotack as vt
from picture_units import in_si
from rate_tests import measured
from solids import creep_power_law
from viscotack.identify import RateSeries, Trial, forecast_rates, identify_rates, next_tests
from viscotack.identify.forward import Forward
from viscotack.identify.ranked_tests import noise_of
from viscotack.model.materials import Passport
from viscotack.model.materials.shift import WLF
from viscotack.plot.interface import draw_next_tests

SOLID = creep_power_law(1e6, 1e7, 0.5, 1e-2, 0.5)
RUBBER = Passport(
    name="rubber",
    material=SOLID,
    temperature=293.15,
    shift=WLF(reference_temperature=293.15, c1=5.0, c2=150.0),
    allowed=tuple(replace(SOLID, tau0=1.5**n * 1e-2) for n in (-1, 0, 1)),
)
RADIUS, PRELOAD, NOISE = 5e-3, 1e-3, 0.02
SPEEDS, WANTED = np.geomspace(1e-6, 1e-4, 3), Trial(3e-2)
FORWARD = Forward(SOLID, RADIUS)


def made(speeds):
    """Return tests of an interface of 0.1 J/m2 and 50 nm."""
    forces = FORWARD.pulled(0.1, 50e-9, np.asarray(speeds), PRELOAD).force
    return measured(forces, NOISE, speeds, preload=PRELOAD)


def fitted(speeds):
    return identify_rates(RateSeries(made(speeds), material=RUBBER, radius=RADIUS))


@pytest.fixture(scope="module")
def fit():
    return fitted(SPEEDS)


@pytest.fixture(scope="module")
def found(fit):
    some = [Trial(v) for v in (1e-5, 1e-3, 3e-2)]
    return next_tests(fit, some, wanted=[WANTED], count=3)


def test_a_test_of_the_wanted_force_leaves_the_variance_of_its_noise(found):
    """V - V^2/(V + s^2) = V s^2/(V + s^2)."""
    best = found.ranked[0]
    assert best.trial.speed == WANTED.speed
    assert best.uncertain == pytest.approx(found.now, rel=1e-9)
    V, noise = found.now**2, found.noise**2
    assert best.left == pytest.approx(np.sqrt(V * noise / (V + noise)), rel=1e-6)


def test_tests_are_in_order_and_each_leaves_less(found):
    left = [one.left for one in found.ranked]
    assert left == sorted(left) and left[-1] <= found.now
    steps = [found.now, *(one.left for one in found.sequence)]
    assert np.all(np.diff(steps) < 0) and len(found.sequence) == 3
    # a repeated test is one of less noise
    assert found.sequence[0] == found.ranked[0]


def test_a_hundred_repeats_of_ten_times_the_noise_are_one_test(fit, found):
    several = next_tests(fit, [Trial(1e-3)], wanted=[WANTED], noise=10 * found.noise, repeats=100)
    alone = next(one for one in found.ranked if one.trial.speed == 1e-3)
    assert several.ranked[0].left == pytest.approx(alone.left, rel=1e-5)
    assert noise_of(fit) == pytest.approx(NOISE, rel=0.3)


def test_the_deviation_today_is_that_of_the_forecast(fit, found):
    band = forecast_rates(fit, [WANTED.speed])
    # each is of about 300 independent samples, which differ by the last digits of a processor
    assert found.now == pytest.approx(np.log(band.high / band.low)[0] / 2 / 1.645, rel=0.25)


@pytest.mark.slow
def test_a_test_that_is_made_leaves_about_what_was_predicted(found):
    one = found.ranked[1]
    band = forecast_rates(fitted([*SPEEDS, one.trial.speed]), [WANTED.speed])
    after = np.log(band.high / band.low)[0] / 2 / 1.645
    assert one.left == pytest.approx(after, rel=0.25)


@pytest.mark.slow
def test_the_interface_may_be_wanted_and_a_dwell_be_a_test(fit):
    dwelt = Trial(1e-3, dwell=1.0, approach_speed=1e-5)
    found = next_tests(fit, [Trial(1e-3), dwelt, Trial(1e-3, radius=2 * RADIUS)])
    assert {one.trial.radius for one in found.ranked} == {RADIUS, 2 * RADIUS}
    force = {one.trial.dwell: one.force for one in found.ranked if one.trial.radius == RADIUS}
    assert force[1.0] != force[None] and force[1.0] == pytest.approx(force[None], rel=0.3)
    assert all(one.left < found.now for one in found.ranked)


@pytest.mark.slow
def test_a_test_beyond_the_theory_is_not_ranked(fit):
    soft = Trial(1e-3, radius=1e-9)
    found = next_tests(fit, [Trial(1e-3), soft], wanted=[WANTED])
    assert len(found.ranked) == 1
    assert [one.radius for one, _ in found.refused] == [1e-9]
    with pytest.raises(vt.OutOfRange):
        next_tests(fit, [Trial(1e-3)], wanted=[soft])


def test_the_operation_ranks_every_combination(tmp_path, fit, monkeypatch):
    study = SimpleNamespace(fit=fit, survey=SimpleNamespace(reasons=(), cautions=()), cautions=())
    monkeypatch.setattr("viscotack.app.operations.forecast.fitted", lambda *given: study)
    (tmp_path / "study.toml").write_text("")
    asked = {"study": str(tmp_path / "study.toml"), "speed": ["1 mm/s", "10 um/s"]}
    answer = vt.ask("next-test", **asked, forecast_speed=["30 mm/s"], preload=["1 mN", "4 mN"])
    record = answer.record()
    assert len(record["tests"]) == 4 and record["tests"][0]["speed_m_per_s"] == 1e-3
    answer.write("csv", tmp_path / "tests.csv")
    assert (tmp_path / "tests.csv").read_text().count("\n") == 5
    left, _ = draw_next_tests(answer.found).axes
    assert in_si(left.xaxis, left.lines[0].get_xdata()) == pytest.approx([1e-5, 1e-3])
    with pytest.raises(vt.InputError, match="forecast_speed"):
        vt.ask("next-test", **asked, forecast_preload="1 mN")


@pytest.mark.parametrize(
    ("numbers", "field"),
    [
        ({"preload": 0.0}, "preload"),
        ({"approach_speed": 1e-5}, "dwell"),
        ({"dwell": 1.0}, "approach_speed"),
        ({"dwell": -1.0, "approach_speed": 1e-5}, "dwell"),
    ],
)
def test_a_test_that_cannot_be_made_is_refused(numbers, field):
    with pytest.raises(vt.InputError) as refused:
        Trial(1e-3, **numbers)
    assert refused.value.field == field
