"""Minima of the force in a retraction: their place, and the contact there."""

from types import SimpleNamespace

import numpy as np
import pytest

from viscotack.model.protocol import AtDepth, Retract
from viscotack.result import observables, opening

MOVED = Retract(1.0, AtDepth(-9.0))


@pytest.mark.parametrize(("lower", "equal"), [(4.0, True), (3.0, True), (2.9, False)])
def test_peaks_are_equal_if_their_difference_is_within_their_errors(lower, equal, monkeypatch):
    # a quarter of each: 5 - 1.25 = 3 + 0.75
    result = SimpleNamespace(error_estimate={"force": 0.25})
    other = SimpleNamespace(force=lower)
    monkeypatch.setattr(observables, "pull_off", lambda result: SimpleNamespace(force=5.0))
    monkeypatch.setattr(observables, "other_peak", lambda result: other)
    assert observables.equal_peak(result) is (other if equal else None)


@pytest.mark.parametrize(
    ("force", "minima"),
    [
        ([-1.0, -2.0], [1]),
        # a rise counts from 3 % of one more than the tension: 0.09 at 2
        ([-1.0, -2.0, -1.92, -3.0, 0.0], [3]),
        ([-1.0, -2.0, -1.90, -3.0, 0.0], [1, 3]),
        # and so does the fall after it: 0.075 below 1.5
        ([-2.0, -1.5, -1.57], [0]),
        ([-2.0, -1.5, -1.58], [0, 2]),
        ([-2.0, -1.6, -1.5, -1.58], [0, 3]),
        # compression is no lower tension
        ([-0.02, 5.0, -0.03, 5.0], [2]),
        ([-2.0, 3.0, -0.1, 3.0], [0]),
        # what is lower than all before is a valley of its own, however much was pressed
        ([-0.05, 9.0, -0.06, 9.0], [0, 2]),
    ],
)
def test_minima_lie_before_and_after_rises_that_count(force, minima):
    assert opening._minima(np.array(force)) == minima


@pytest.mark.parametrize(
    ("y", "i", "place", "least"),
    [
        # the line through the points at 0 and 1, and through those at 1 and 3, less 3e-3
        ([-1.0, -1.5, -3.0, -2.0], 2, 2.0, -2.003),
        ([-1.0, -1.5, -3.0, -2.0], 2, 3.0, -2.503),
        ([-1.0, -1.5, -3.0, -2.0], 2, 3.5, -3.378),
        # before it there is no line
        ([-1.0, -2.0, -0.5, 7.0], 1, 0.5, -3.5),
        ([-0.5, -2.0, -1.0, 7.0], 1, 0.5, -3.5),
        # plateaus before, around and after
        ([-1.0, -1.0, -1.0, 0.0], 2, 2.9, -1.000001),
        ([-1.0, -1.0, -1.0, 0.0], 1, 1.1, -1.000001),
        ([0.0, -1.0, -1.0, -1.0], 1, 0.9, -1.000001),
    ],
)
def test_a_valley_lies_above_the_line_through_the_points_before_it(y, i, place, least):
    x = np.array([0.0, 1.0, 3.0, 4.0])
    assert opening.least_between(x, np.array(y), i, place) == pytest.approx(least, rel=1e-12)


def test_the_minimum_of_a_parabola_or_a_cubic_through_uneven_points_is_exact():
    x = np.array([0.0, 1.0, 3.0, 4.0, 6.0])
    place, value = opening._minimum(x, 3 * (x - 1.3) ** 2 - 2, 1)
    assert (place, value) == pytest.approx((1.3, -2.0), rel=1e-12)
    cubic = np.polynomial.Polynomial([-2.0, 0.0, 1.0, 0.1])(x - 2.6)
    assert opening._minimum(x, cubic, 2) == pytest.approx((2.6, -2.0), rel=1e-12)
    # at an end it is the step itself
    assert opening._minimum(x, (x + 1) ** 2, 0) == (0.0, 1.0)
    assert opening._minimum(x, (x - 7) ** 2, 4) == (6.0, 1.0)


@pytest.fixture
def valley(monkeypatch):
    """Make what looks at a valley see an uneven parabola of curvature 6 under one move."""
    x = np.array([0.0, 1.0, 3.0, 4.0, 6.0])

    def made(lowest, kind, steps=5):
        force = 3 * (x[:steps] - 2.8) ** 2 - 8
        monkeypatch.setattr(opening, "_valley_of", lambda *_: (np.arange(steps), lowest, -8.0))
        monkeypatch.setattr(opening, "move_numbers", lambda _: np.zeros(steps, dtype=int))
        monkeypatch.setattr(opening, "moves_of", lambda _: [kind])
        return SimpleNamespace(depth=-x[:steps], force=force)

    return made


def test_what_an_error_of_the_slope_costs_is_the_square_of_the_force_over_the_curvature(valley):
    assert opening.lost_beside(valley(2, MOVED), None) == pytest.approx(7.88**2 / 6, rel=1e-12)
    for end in (0, 4):
        assert opening.lost_beside(valley(end, MOVED), None) == 0.0


def test_a_parabola_is_known_between_its_steps_and_a_bent_curve_is_not(valley):
    result = valley(2, MOVED)
    assert opening.between_steps(result, None) == pytest.approx(0.0, abs=1e-12)
    # bent one step away: the parabola through three steps stays, a cubic does not
    result.force[4] += 1.0
    x, y = -result.depth, result.force
    place, _ = opening._minimum(x, y, 2)
    cubics = [next(opening._lowest(x, y, 2, s))[0] for s in (slice(0, 4), slice(1, 5))]
    far = max(abs(at - place) for at in (2.8, *cubics))
    assert opening.between_steps(result, None) == pytest.approx(far, rel=1e-12)
    assert far > 0.01
    for end in (0, 4):
        assert opening.between_steps(valley(end, MOVED), None) == 0.0
