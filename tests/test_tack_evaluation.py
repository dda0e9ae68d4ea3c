"""Cycles of tack tests: found by the signal, corrected, and refused where they say nothing."""

import re
from contextlib import nullcontext
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import rig_signals
import tack_files
from viscotack.errors import InputError
from viscotack.lab import tack
from viscotack.lab.tack import Measured, evaluation
from viscotack.lab.tack.baseline import Baseline, extremum
from viscotack.theory import jkr

PULL_OFF = jkr.pull_off(**tack_files.SPHERE)


def record(test, **more):
    return tack.TackRecord(test.time, test.force, test.drive, **{"into": 1, **more})


def only(test, **more):
    evaluation = tack.evaluate(record(test), **more)
    assert evaluation.refused == ()
    (cycle,) = evaluation.cycles
    return cycle


def test_a_noiseless_test_reproduces_the_theory():
    cycle = only(tack_files.made())
    sphere = tack_files.SPHERE
    # the minimum lies between two points of the test
    assert cycle.pull_off_force.value == pytest.approx(-PULL_OFF.force, rel=5e-4)
    assert cycle.depth_at_pull_off.value == pytest.approx(PULL_OFF.depth, abs=1e-6)
    assert cycle.work_to_pull_off.value == pytest.approx(jkr.work_to_pull_off(**sphere), rel=0.02)
    assert cycle.preload_depth.value == pytest.approx(tack_files.DEEP, rel=0.03)
    assert cycle.speed.value == pytest.approx(tack_files.SPEED, rel=1e-3)
    assert cycle.approach_speed == pytest.approx(tack_files.APPROACH_SPEED, rel=1e-3)
    assert cycle.dwell_time == pytest.approx(tack_files.DWELL, rel=0.01)


def test_a_machine_that_yields_is_taken_off_the_depth():
    true, compliance = only(tack_files.made()), 2e-4
    test = tack_files.made(compliance=compliance)
    cycle = only(test, compliance=compliance)
    assert cycle.depth_at_pull_off.value == pytest.approx(true.depth_at_pull_off.value, abs=3e-7)
    assert cycle.work_to_pull_off.value == pytest.approx(true.work_to_pull_off.value, rel=0.02)
    left = only(test)
    assert abs(left.depth_at_pull_off.value - true.depth_at_pull_off.value) > 0.6e-6
    unsure = only(test, compliance=compliance, compliance_uncertainty=2e-5)
    assert unsure.depth_at_pull_off.uncertainty > cycle.depth_at_pull_off.uncertainty
    assert unsure.work_to_pull_off.uncertainty >= cycle.work_to_pull_off.uncertainty
    # at the end of the dwell by the error of the compliance times the force there
    by_rig = 2e-5 * cycle.force[cycle.segments.retract]
    both = np.hypot(cycle.preload_depth.uncertainty, by_rig)
    assert unsure.preload_depth.uncertainty == pytest.approx(both, rel=1e-6)
    (refusal,) = tack.evaluate(record(test), compliance=1.0).refused
    assert "compliance" in refusal.reason


@pytest.mark.parametrize("force_sign", [1, -1])
@pytest.mark.parametrize("travel_sign", [1, -1])
def test_signs_are_found_from_the_signal(force_sign, travel_sign):
    test = tack_files.made(noise=5e-5)
    turned = replace(test, force=force_sign * test.force, drive=travel_sign * test.drive)
    found = tack.evaluate(record(turned, into=0)).cycles[0]
    assert found.pull_off_force == only(test).pull_off_force
    with pytest.raises(InputError, match="`compression`"):
        tack.evaluate(record(turned, into=0), compression=-force_sign)


def test_every_cycle_of_a_record_is_found():
    test = tack_files.made(noise=5e-5)
    time = np.concatenate([test.time + i * (test.time[-1] + 1) for i in range(3)])
    three = tack.TackRecord(time, np.tile(test.force, 3), np.tile(test.drive, 3), into=1)
    cycles = tack.evaluate(three).cycles
    assert [cycle.number for cycle in cycles] == [1, 2, 3]
    for cycle in cycles:
        assert cycle.pull_off_force.value == pytest.approx(
            only(test).pull_off_force.value, rel=5e-3
        )
        assert cycle.dwell_time == pytest.approx(tack_files.DWELL, rel=0.02)


def test_the_true_speed_is_not_the_nominal_one():
    test = tack_files.made()
    slow = replace(test, time=1.13 * test.time)
    assert only(slow).speed.value == pytest.approx(tack_files.SPEED / 1.13, rel=1e-3)
    # a drive that still speeds up says so
    late = test.time - test.time[560]
    uneven = np.where(late > 0, test.time[560] + late / (1 + 0.3 * late / late[-1]), test.time)
    cycle = only(replace(test, time=uneven))
    assert cycle.speed.uncertainty > 0.005 * cycle.speed.value


def cut_at(test, stop):
    return replace(test, time=test.time[:stop], force=test.force[:stop], drive=test.drive[:stop])


def bad():
    test = tack_files.made(noise=5e-5)
    least = int(np.argmin(test.force))
    clipped = replace(test, force=np.maximum(test.force, -2e-3))
    spike = test.force.copy()
    spike[900] = -0.05
    hard = test.force.copy()
    hard[hard < -2e-4] = 0.0
    swinging = test.force + 0.005 * np.sin(np.arange(test.force.size) / 40)
    return {
        "cut at the pull-off": (cut_at(test, least + 3), "does not settle"),
        "still in contact": (cut_at(test, 620), "does not settle"),
        "clipped": (clipped, "is saturated"),
        "a spike": (replace(test, force=spike), "a single point"),
        "no adhesion": (replace(test, force=np.maximum(hard, 0)), "no pull-off above the noise"),
        "a swinging zero": (replace(test, force=swinging), "noise|known within|rest|free of"),
        "no approach": (
            replace(test, time=test.time[560:], force=test.force[560:], drive=test.drive[560:]),
            "`retraction_only`",
        ),
    }


@pytest.mark.parametrize("what", bad())
def test_a_bad_curve_is_refused_with_the_reason(what):
    test, words = bad()[what]
    evaluation = tack.evaluate(record(test))
    assert evaluation.cycles == ()
    (refusal,) = evaluation.refused
    assert re.search(words, refusal.reason), refusal.reason


def test_a_retraction_alone_is_taken_where_that_is_said():
    forces = []
    for seed in range(4):
        test = tack_files.made(noise=5e-5, seed=seed)
        half = replace(test, time=test.time[560:], force=test.force[560:], drive=test.drive[560:])
        cycle = only(half, retraction_only=True)
        assert "no approach before contact" in " ".join(cycle.source.notes)
        forces.append(cycle.pull_off_force)
    # the noise is 1.4 % of the force, so one test is within 0.7 %
    off = np.array([(one.value + PULL_OFF.force) / one.uncertainty for one in forces])
    assert np.all(np.abs(off) < 3)
    assert np.mean([one.value for one in forces]) == pytest.approx(-PULL_OFF.force, rel=0.005)


def test_textbook_signals_are_evaluated_within_their_uncertainties():
    found = [
        rig_signals.judged(*rig_signals.textbook(np.random.default_rng([2, i]))) for i in range(40)
    ]
    assert [one for one in found if isinstance(one, str)] == []
    errors, ratios = np.moveaxis(np.array(found), -1, 0)
    assert np.max(np.abs(ratios)) < rig_signals.WRONG
    force, work, depth = np.sqrt(np.mean(errors**2, axis=0))
    assert force < 0.02 and work < 0.08 and depth < 0.05
    # neither too certain nor too careful
    assert np.all((np.std(ratios, axis=0) > 0.5) & (np.std(ratios, axis=0) < 1.5))


def test_single_spikes_are_left_out():
    test = tack_files.made(noise=5e-5)
    force = test.force.copy()
    force[[40, 300, 700, 1200]] += [3e-3, -2e-3, 2.5e-3, 1e-3]
    cycle, true = only(replace(test, force=force)), only(test)
    assert cycle.pull_off_force.value == pytest.approx(true.pull_off_force.value, rel=1e-3)
    assert "spikes replaced by the mean of their neighbours: 4" in cycle.source.notes


@pytest.mark.parametrize("jump", [True, False])
def test_the_smallest_force_is_estimated_without_bias(jump):
    x = np.linspace(-1, 1, 301)
    # the smallest of noisy points is too small by three times the noise
    for count, places in ((200, 0.0), (160, 0.05)):
        force = np.where(jump & (np.arange(x.size) > count), 0.0, (x - places) ** 2 - 1)
        least = float(force.min())
        found = []
        for seed in range(60):
            noisy = force + 0.01 * np.random.default_rng(seed).standard_normal(x.size)
            found.append(extremum(noisy, int(np.argmin(noisy)), 0.01))
        off = np.array([(one.value - least) / one.uncertainty for one in found])
        assert abs(np.mean([one.value for one in found]) - least) < 0.002
        assert np.max(np.abs(off)) < 4 and 0.5 < np.std(off) < 1.5


def test_whole_digits_of_a_signal_without_noise_are_in_its_uncertainty():
    test = tack_files.made(noise=0.0)
    true, digit = -float(test.force.min()), 1e-4
    rounded = np.round(test.force / digit) * digit
    (cycle,) = tack.evaluate(tack.TackRecord(test.time, rounded, test.drive, into=1)).cycles
    assert cycle.noise >= digit / np.sqrt(12) * 0.99
    assert abs(cycle.pull_off_force.value - true) < 3 * cycle.pull_off_force.uncertainty


def test_attraction_out_of_contact_does_not_bend_the_zero():
    # DMT's sphere in Lennard-Jones forces: the pull-off is the force at contact
    reach, size = 3e-6, 1e-3
    way = np.linspace(-60e-6, 8e-6, 800)
    depth = np.concatenate([way, way[::-1]])
    force = 20 * size * np.maximum(depth / 8e-6, 0) ** 1.5
    force -= size * (1 + np.maximum(-depth, 0) / reach) ** -2.0
    time, errors = np.arange(depth.size) * 0.01, []
    for seed in range(3):
        noise = 2e-3 * size * np.random.default_rng(seed).standard_normal(force.size)
        noisy = force + noise + 2e-2 * size * time / time[-1]
        (cycle,) = tack.evaluate(tack.TackRecord(time, noisy, depth, into=1)).cycles
        found = cycle.pull_off_force
        errors.append(found.value / size - 1)
        assert abs(found.value - size) < 4 * found.uncertainty
    assert abs(np.mean(errors)) < 0.015


def test_noise_behind_a_soft_machine_makes_no_work_certain_by_chance():
    # a flat smallest force; the noise times the compliance is four steps of the depth
    compliance, noise, found = 0.2, 0.02, []
    down, up = np.linspace(-1.5, 1, 600), np.linspace(1, -2, 3000)
    back = np.where(up > -0.3, 3 * ((up + 0.3) / 1.3) ** 2 - 1, ((up + 0.3) / 0.6) ** 2 - 1)
    pure = np.concatenate([2 * np.maximum(down, 0) ** 1.5, np.where(up < -0.9, 0.0, back)])
    drive = np.concatenate([down, up]) + compliance * pure
    for seed in range(5):
        force = pure + noise * np.random.default_rng(seed).standard_normal(pure.size)
        test = tack.TackRecord(np.arange(pure.size) * 0.01, force, drive, into=1)
        (cycle,) = tack.evaluate(test, compliance=compliance).cycles
        found.append(cycle.work_to_pull_off)
    uncertainty = np.array([one.uncertainty for one in found])
    assert uncertainty.max() < 4 * uncertainty.min()
    away = np.where((back < 0) & (up >= -0.3), -back, 0.0)
    true = -float(np.trapezoid(away, up))
    assert np.all(np.abs([one.value - true for one in found]) < 3 * uncertainty)


def test_the_wander_of_the_zero_is_in_the_uncertainties_of_force_and_depth():
    ratios = []
    for seed in range(10):
        rng = np.random.default_rng([9, seed])
        test = rig_signals.pure(rng)
        steps = np.sqrt(np.gradient(test.time) / np.ptp(test.time))
        walk = np.cumsum(steps * rng.standard_normal(test.time.size))
        noise = 0.002 * rng.standard_normal(test.time.size)
        force = test.force + test.range * (0.02 * walk + noise)
        record = tack.TackRecord(test.time, force, test.depth, into=1)
        ratios.append([ratio for _, ratio in rig_signals.judged(record, test.truth)])
    size = np.sqrt(np.mean(np.square(ratios), axis=0))
    assert np.all((0.4 < size) & (size < 1.1))


@pytest.mark.parametrize(("apart", "other", "doubted"), [(3.9, 1, 0), (4.1, 1, 1), (4.1, 2.1, 0)])
def test_a_zero_is_doubted_by_that_of_the_outer_points_from_four_deviations_on(
    apart, other, doubted
):
    def flat(level, error):
        first = np.eye(35)[0]
        return Baseline(level * first, error**2 * np.outer(first, first), 0.0, (0, 1), (0, 1))

    # four of its own, or two of those of the other
    found = flat(0.0, 1.0).doubted(flat(apart, other), 0.0, 0.5)
    expected = np.hypot(1.0, doubted * apart)
    assert found.uncertainty(np.zeros(1), np.zeros(1)) == pytest.approx(expected)


def pulled_film(tail, step):
    """Return a test of a thin film: a peak 5 um behind zero force, then a plateau of a third."""
    down = np.arange(-200e-6, 10e-6, 1e-6)
    up = np.arange(10e-6, -1e-3, -step)
    way = np.concatenate([down, np.full(20, 10e-6), up])
    time = 0.05 * np.arange(down.size + 20.0)
    travel = 10e-6 - up
    time = np.concatenate([time, time[-1] + 1e-3 + travel / 1e-3])
    ends = [0, 5e-6, 10e-6, 30e-6, 30e-6 + tail]
    ramp = np.where(travel > ends[-1], 0.0, np.interp(travel, ends, [0.5, 0, -0.5, -0.17, -0.17]))
    force = np.concatenate([0.5 * (np.maximum(down, 0) / 1e-5) ** 1.5, np.full(20, 0.5), ramp])
    noise = 2e-3 * np.random.default_rng(1).standard_normal(force.size)
    return tack.TackRecord(time, force + noise, way)


def test_a_tension_that_lasts_behind_the_pull_off_is_a_sign_of_fibrils():
    (fibrils,) = tack.evaluate(pulled_film(5e-4, 5e-7), into=1).cycles
    assert "fibrils or cavities" in fibrils.cautions[0]
    (sphere,) = tack.evaluate(pulled_film(1e-6, 5e-7), into=1).cycles
    assert sphere.cautions == ()
    for held, many in ((0.19, 0), (0.21, 1)):
        force = -np.append([0.0, 1.0], np.full(98, held))
        assert len(evaluation._fibrils(force, -np.arange(100.0), 0, 1, 100)) == many


def test_a_speed_that_changes_is_as_uncertain_as_one_anywhere_between_those_of_the_halves():
    time = np.linspace(0.0, 2.0, 2001)
    drive = 1e-6 * np.where(time < 1, time, 3 * time - 2)
    for way, uncertainty in ((-drive, 2e-6 / np.sqrt(12)), (-2e-6 * time, 0.0)):
        found = evaluation._speed(time, way, 0, 2000)
        assert found.value == pytest.approx(2e-6, rel=1e-3)
        assert found.uncertainty == pytest.approx(uncertainty, rel=0.01, abs=1e-12)


def test_a_work_reaches_to_the_depth_at_which_it_ends_between_two_points():
    exact = SimpleNamespace(noise=0.0, uncertainty=lambda *where: 0.0)
    x = np.array([0.0, 1.0, 2.0])
    found = evaluation._work(exact, (x, x, x, x), (0, 2), 0.0, Measured(2.5, 0.1))
    # a triangle, a half step at the last force, and its uncertainty at that force
    assert (found.value, found.uncertainty) == pytest.approx((3.0, 0.2))


def test_no_minimum_is_placed_better_than_between_two_points():
    force = 1e-3 * (np.arange(21.0) - 10.3) ** 2 - 1
    found = extremum(force, 10, 1e-5)
    assert found.at == pytest.approx(10.3, abs=0.1)
    assert found.at_uncertainty == pytest.approx(np.sqrt(1 / 12), rel=0.05)


@pytest.mark.parametrize(
    "noise, zero, words",
    [(0.19, 0.0, ""), (0.21, 0.0, "above the noise"), (0.01, 0.24, ""), (0.01, 0.26, "tilt or")],
)
def test_a_pull_off_is_five_times_the_noise_and_four_times_the_doubt_of_the_zero(
    noise, zero, words
):
    force = 1e-3 * (np.arange(61.0) - 30) ** 2 - 1
    with pytest.raises(InputError, match=words) if words else nullcontext():
        assert evaluation._least(force, 30, noise, zero).value == pytest.approx(-1)
