"""Behaviour of the materials: what they refuse, and shapes of what they return."""

import math

import numpy as np
import pytest

import viscotack as vt
from viscotack.model.materials.modes import compressed

ELASTIC = dict(rubbery_modulus=1e6, poisson_ratio=0.5)
STANDARD = dict(ELASTIC, glassy_modulus=1e7, tau0=1e-3)
POWER_LAW = dict(STANDARD, exponent=0.6)
FRACTIONAL = dict(STANDARD, order=0.6)
PRONY = dict(ELASTIC, branches=[(4e6, 1.0), (5e6, 1e-3)])
CASES = [
    (vt.Elastic, ELASTIC),
    (vt.StandardSolid, STANDARD),
    (vt.Prony, PRONY),
    (vt.RetardationPowerLaw, POWER_LAW),
    (vt.RelaxationPowerLaw, POWER_LAW),
    (vt.FractionalZener, FRACTIONAL),
]
every_class = pytest.mark.parametrize(
    ("kind", "numbers"), CASES, ids=[c.__name__ for c, _ in CASES]
)
METHODS = ["relaxation", "creep", "complex_modulus", "complex_compliance"]


@every_class
@pytest.mark.parametrize("wrong", [-0.1, 0.51])
def test_poisson_ratio_must_be_between_0_and_a_half(kind, numbers, wrong):
    with pytest.raises(ValueError, match="poisson_ratio"):
        kind(**(numbers | dict(poisson_ratio=wrong)))


@pytest.mark.parametrize("kind", [vt.StandardSolid, vt.RetardationPowerLaw, vt.RelaxationPowerLaw])
def test_glassy_modulus_and_time_are_checked(kind):
    numbers = STANDARD if kind is vt.StandardSolid else POWER_LAW
    with pytest.raises(
        ValueError, match="999999 Pa < 1e.06 Pa; check whether they are interchanged"
    ):
        kind(**(numbers | dict(glassy_modulus=999999)))
    with pytest.raises(ValueError, match="tau0 must be positive, got -100 ms"):
        kind(**(numbers | dict(tau0=-0.1)))
    with pytest.raises(ValueError, match="glassy_modulus must be finite"):
        kind(**(numbers | dict(glassy_modulus=math.nan)))


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ([], "branches must be 1 to 10,000 pairs, .*Elastic"),
        (5e6, "branches must be pairs of numbers"),
        ([(5e6, 0.0)], "a time of branches must be positive"),
        ([(5e6, 1.0), (4e6, 2.0), (3e6, 1.0)], "times of branches must differ"),
    ],
)
def test_branches_are_pairs_of_positive_numbers_with_different_times(wrong, sentence):
    with pytest.raises(ValueError, match=sentence):
        vt.Prony(**(ELASTIC | dict(branches=wrong)))


@every_class
@pytest.mark.parametrize("method", METHODS)
def test_numbers_give_numbers_and_arrays_give_arrays(kind, numbers, method):
    function = getattr(kind(**numbers), method)
    number = complex if method.startswith("complex") else float
    for one in (1, 1e-3, np.float64(0.2), np.array(0.2), 0, math.inf):
        assert type(function(one)) is number
    many = [[1e-9, 0.0, 1.0], [math.inf, 3.0, 1e3]]
    values = function(many)
    assert isinstance(values, np.ndarray) and values.shape == (2, 3)
    assert values.dtype == number
    for i, j in np.ndindex(2, 3):
        assert function(many[i][j]) == pytest.approx(values[i, j], rel=1e-13)
    assert function([]).shape == (0,)
    assert function(np.ones((2, 0, 3))).shape == (2, 0, 3)


@every_class
def test_negative_times_and_frequencies_are_refused(kind, numbers):
    for method in METHODS:
        name = "omega" if method.startswith("complex") else "time"
        for wrong in (math.nan, [1.0, -2.0]):
            with pytest.raises(ValueError, match=name):
                getattr(kind(**numbers), method)(wrong)


@every_class
def test_extreme_times_and_frequencies_do_not_overflow(kind, numbers):
    solid = kind(**numbers)
    for x in (1e-290, 1e-100, 1e100, 1e250):
        for method in METHODS:
            assert np.isfinite(getattr(solid, method)(x))
    assert solid.relaxation(1e-290) == pytest.approx(solid.glassy_modulus, rel=1e-9)
    assert solid.creep(1e250) == pytest.approx(1e-6, rel=1e-12)


FAST = {"shortest": 2.0, "longest": 1e4, "error": 0.25}
# what the two fastest of the modes (0.01, 1), (0.02, 2) lose at a time of 2
LOST = np.cumsum([0.01 * np.exp(-2.0), 0.02 * np.exp(-1.0)])


@pytest.mark.parametrize(
    ("tolerance", "fast"),
    [(1.999 * LOST[0], 0), (2.001 * LOST[0], 1), (1.999 * LOST[1], 1), (2.001 * LOST[1], 2)],
)
def test_modes_are_instantaneous_while_half_of_the_tolerance_lasts(tolerance, fast):
    weights, times = np.array([0.01, 0.02, 0.5]), np.array([1.0, 2.0, 100.0])
    modes = compressed(0.47, weights, times, tolerance=tolerance, **FAST)
    assert modes.weights == tuple(weights[fast:]) and modes.times == tuple(times[fast:])
    assert modes.instantaneous == pytest.approx(0.47 + sum(weights[:fast]), rel=1e-14)
    assert modes.error == pytest.approx(0.25 + (LOST[fast - 1] if fast else 0), rel=1e-14)


def test_slow_modes_are_one_while_half_of_the_tolerance_lasts():
    # the modes 0.2 in 100 and 0.3 in 300 have the weight 0.5 and the rate 0.003
    weights, times = np.array([0.4, 0.2, 0.3]), np.array([5.0, 100.0, 300.0])
    window = {"shortest": 1.0, "longest": 20.0, "error": 0.25}
    both = 0.2 * -np.expm1(-20 / 100) + 0.3 * -np.expm1(-20 / 300)
    excess = 0.5 * -np.expm1(-20 * 0.003 / 0.5) - both
    for tolerance, merged in ((1.99 * excess, False), (2.01 * excess, True)):
        modes = compressed(0.1, weights, times, tolerance=tolerance, **window)
        kept = (
            ((0.4, 0.5), (5.0, 0.5 / 0.003)) if merged else ((0.4, 0.2, 0.3), (5.0, 100.0, 300.0))
        )
        assert modes.weights == pytest.approx(kept[0], rel=1e-14)
        assert modes.times == pytest.approx(kept[1], rel=1e-14)
        assert modes.error == pytest.approx(0.25 + excess * merged, rel=1e-9)
