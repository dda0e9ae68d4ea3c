"""Measured points move what was learned: towards a lab's truth, and no further than they tell."""

import numpy as np
import pytest

from viscotack.surrogate.moving import moved
from viscotack.surrogate.store import shipped

SOLID = [1.0, 0.05, 0.6]


def rows_of(rates, depth=20.0):
    return np.array([[*SOLID, depth, rate] for rate in rates])


def test_ten_points_halve_the_error_of_a_lab_whose_solid_and_adhesion_differ():
    rates = np.geomspace(0.3, 1e6, 10)
    random = np.random.default_rng(2)

    def truth(rows):
        other = rows * [0.9, 1.2, 1.0, 1.0, 4.0]
        return 1.15 * shipped().evaluate(other).pull_off_force

    measured = truth(rows_of(rates)) * np.exp(0.03 * random.normal(size=10))
    lab = moved(shipped(), rows_of(rates), measured, error=0.03)
    other = rows_of(np.geomspace(0.5, 5e5, 40), depth=40.0)
    before = np.log(shipped().evaluate(other).pull_off_force / truth(other))
    said = lab.evaluate(other)
    after = np.log(said.pull_off_force / truth(other))
    assert np.sqrt(np.mean(after**2)) < 0.5 * np.sqrt(np.mean(before**2))
    held = lab.intervals(other, said).pull_off_force
    assert np.mean((held[:, 0] <= truth(other)) & (truth(other) <= held[:, 1])) > 0.8


def test_points_that_agree_change_nothing_and_far_from_them_less_is_known():
    rates = np.geomspace(1.0, 1e3, 6)
    lab = moved(
        shipped(), rows_of(rates), shipped().evaluate(rows_of(rates)).pull_off_force, error=0.01
    )
    other = rows_of([30.0])
    said = lab.evaluate(other)
    assert said.pull_off_force == pytest.approx(shipped().evaluate(other).pull_off_force, rel=2e-3)
    before = shipped().intervals(other, said).pull_off_force
    assert np.ptp(lab.intervals(other, said).pull_off_force) > np.ptp(before)
    shifted = moved(
        shipped(), rows_of(rates), [1, 1.2, 0.8, 1.1, 1.3, 0.9] * said.pull_off_force, error=0.01
    )
    far = np.array([[0.02, 0.5, 1.9, 0.01, 0.02]])
    widths = [
        np.ptp(np.log(shifted.intervals(rows, shifted.evaluate(rows)).pull_off_force))
        for rows in (rows_of(rates[2:3]), far)
    ]
    assert widths[1] > 1.5 * widths[0]


@pytest.mark.parametrize(
    ("groups", "force", "error", "words"),
    [
        (np.ones((2, 4)), [1.0, 1.0], 0.1, "a row of 5 inputs for each force"),
        (np.ones((0, 5)), [], 0.1, "a row of 5 inputs"),
        (rows_of([1.0]), [-1.0], 0.1, "positive numbers"),
        (rows_of([1.0]), [1.0], 0.0, "positive numbers"),
        (rows_of([1e-9]), [1.0], 0.1, "point 0 lies outside the range"),
        (rows_of(np.geomspace(1, 1e3, 501)), np.ones(501), 0.1, "at most 500 points"),
    ],
)
def test_points_that_tell_nothing_are_refused(groups, force, error, words):
    with pytest.raises(ValueError, match=words):
        moved(shipped(), groups, force, error=error)
