"""Repeated tests have one scatter, and outliers are named."""

from dataclasses import replace

import numpy as np
import pytest

from rate_tests import LENS
from viscotack.identify import pull_offs
from viscotack.lab.tack import Measured, survey
from viscotack.lab.tack.repeats import _far, pooled


@pytest.mark.parametrize("far", [3.45, 3.55])
@pytest.mark.parametrize("tests", [3, 6])
def test_a_test_is_far_by_its_distance_from_the_others_over_what_their_mean_adds(tests, far):
    logs = np.append(np.zeros(tests - 1), far * 0.02 * np.sqrt(1 + 1 / (tests - 1)))
    assert _far(logs, 0.02) == ((tests - 1,) if far > 3.5 else ())


def test_the_scatter_of_repeats_is_pooled_and_the_uncertainty_of_means_covers():
    tests = 2
    rng = np.random.default_rng(tests)
    drawn = [
        pooled(np.exp(0.03 * rng.standard_normal((6, tests))))  # type: ignore[arg-type]
        for _ in range(100)
    ]
    assert np.mean([one.scatter for one in drawn]) == pytest.approx(0.03, rel=0.06)
    covered = [
        abs(np.log(mean)) < 1.645 * one.uncertainty(tests) for one in drawn for mean in one.means
    ]
    assert 0.87 < np.mean(covered) < 0.93
    # constants that are fitted to the means take their degrees of freedom
    one, less = drawn[0], drawn[0].less(2)
    assert less.freedom == one.freedom - 2 == 4
    assert less.freedom * less.scatter**2 == pytest.approx(one.freedom * one.scatter**2)
    assert one.less(6).uncertainty(tests) == 0


def test_a_test_far_from_its_repeats_counts_little_and_is_named():
    (cycle,) = survey([LENS[1]]).cycles
    size = cycle.pull_off_force.value
    factors = np.array([[1.0, 1.02, 0.98, 1.4], [1.01, 0.99, 1.02, 0.97], [1.0, 0.98, 1.0, 1.03]])
    cycles = [
        replace(
            cycle,
            speed=Measured((1 + i) * cycle.speed.value, 0.0),
            pull_off_force=Measured(float(factor) * size, 0.01 * size),
        )
        for i, row in enumerate(factors)
        for factor in row
    ]
    found = pull_offs(cycles)
    assert [len(one.remarks) for one in found] == [1, 0, 0]
    # the mean of the other three is that of the file
    assert found[0].force.value == pytest.approx(size, rel=0.02)
