"""Minima of the force in a retraction: smooth or not, their place, and jumps before them."""

from types import SimpleNamespace

import numpy as np
import pytest

from viscotack.protocol import AtDepth, LoadTo, Retract
from viscotack.result import observables, opening, sensitivities

MOVED, LOADED = Retract(1.0, AtDepth(-9.0)), LoadTo(-1.0, 1.0)


@pytest.mark.parametrize(
    ("moves", "numbers", "lowest", "smooth"),
    [
        ([MOVED], [0] * 5, 2, True),
        ([MOVED], [0] * 5, 0, False),
        ([MOVED], [0] * 5, 4, False),
        # a move ends at the minimum, and the next may have a kink
        ([MOVED, MOVED], [0, 0, 0, 1, 1], 2, False),
        ([MOVED, MOVED], [0, 0, 0, 1, 1], 3, True),
        ([LOADED], [0] * 5, 2, False),
        ([LOADED, MOVED], [0, 0, 1, 1, 1], 3, True),
    ],
)
def test_a_minimum_is_smooth_within_a_move_of_the_drive(
    moves, numbers, lowest, smooth, monkeypatch
):
    steps = np.arange(len(numbers))
    monkeypatch.setattr(opening, "_valley_of", lambda result, span: (steps, lowest))
    monkeypatch.setattr(opening, "move_numbers", lambda result: np.array(numbers))
    monkeypatch.setattr(opening, "moves_of", lambda result: moves)
    assert opening.is_smooth(None, None) is smooth


@pytest.mark.parametrize(
    ("c", "b", "a", "place"),
    [
        (-1.0, 1.0, 0.0, 0.5),
        # nearly a parabola: the other root of the slope is far away
        (-1.0, 1.0, 1e-17, 0.5),
        # slope 3 (u - 1) (u - 2)
        (6.0, -4.5, 1.0, 2.0),
        # no minimum: a slope without roots, a parabola that is open below, a line
        (1.0, 0.0, 1.0, np.nan),
        (1.0, -1.0, 0.0, np.nan),
        (1.0, 0.0, 0.0, np.nan),
    ],
)
def test_the_minimum_of_a_cubic_is_found_without_cancellation(c, b, a, place):
    assert opening._valley(c, b, a) == pytest.approx(place, rel=1e-14, nan_ok=True)


@pytest.mark.parametrize(
    ("kind", "time", "refused"),
    [
        ("jump into contact", 0.5, False),
        ("jump out of contact", 1.0, True),
        ("jump out of contact", 2.5, True),
        ("jump out of contact", 2.8, False),
        ("turn", 2.0, False),
    ],
)
def test_a_jump_between_the_turn_and_the_pull_off_refuses_the_slope_of_the_work(
    kind, time, refused, monkeypatch
):
    events = [SimpleNamespace(kind=kind, time=time)]
    result = SimpleNamespace(time=np.arange(4.0), events=events)
    monkeypatch.setattr(sensitivities, "_never", lambda result, slopes: "")
    monkeypatch.setattr(sensitivities, "pull_off", lambda result: SimpleNamespace(time=2.5))
    monkeypatch.setattr(sensitivities, "spans", lambda result: [SimpleNamespace(turn=1)])
    found = sensitivities._refused(result, None, ["pull_off_force", "work_to_pull_off"])
    assert list(found) == ["work_to_pull_off"] * refused


def test_the_ligament_of_a_punch_that_opens_at_once_is_the_one_just_before(monkeypatch):
    radius = np.array([8.0, 6.0, 4.0, np.nan])
    result = SimpleNamespace(time=np.arange(4.0), contact_radius=radius)
    punch = SimpleNamespace(geometry=SimpleNamespace(half_width=10.0))
    monkeypatch.setattr(observables, "_punch", lambda result: punch)
    for time, expected in ((2.0, 0.4), (3.0, 0.4), (1.5, 0.6)):
        found = SimpleNamespace(time=time, contact_radius=np.nan)
        monkeypatch.setattr(observables, "pull_off", lambda result, found=found: found)
        assert observables.ligament_at_pull_off(result) == expected


@pytest.mark.parametrize(("lower", "equal"), [(4.0, True), (3.0, True), (2.9, False)])
def test_peaks_are_equal_if_their_difference_is_within_their_errors(lower, equal, monkeypatch):
    # a quarter of each: 5 - 1.25 = 3 + 0.75
    result = SimpleNamespace(error_estimate={"force": 0.25})
    other = SimpleNamespace(force=lower)
    monkeypatch.setattr(observables, "pull_off", lambda result: SimpleNamespace(force=5.0))
    monkeypatch.setattr(observables, "other_peak", lambda result: other)
    assert observables.equal_peak(result) is (other if equal else None)
