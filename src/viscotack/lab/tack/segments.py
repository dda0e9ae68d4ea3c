r"""Approach, dwell and retraction of each cycle, found by the signal and not by any label.

The depth turns where the drive does. From one turn to the next it must move by a tenth of its
whole range, so that creep, noise and steps of a drive make no cycle. A dwell begins at the knee of
depth against time, and ends where the drive leaves its level by more than its scatter.

Which way is into the solid, a gap or a depth says itself. A travel is turned so that the force
changes most at its deep end; a force so that a contact pushed together gives a positive one. Both
are refused where the signal leaves them open.
"""

from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError

from .baseline import point_noise
from .record import TackRecord

_TURN = 0.1  # of the range of depths
_NEAR = 0.01  # of the way of a retraction: certainly begun
_STEP = 2e-4  # of the way of a retraction: no motion yet, a drive's last step
_END = 0.15  # of the range of depths at either end, where forces are compared
_ACTIVE = 3.0  # times more force changes at the end that touches
_DISTINCT = 1.2  # times a force must exceed another to be the larger one


@dataclass(frozen=True)
class Segments:
    """Indices of one cycle in its record, as in a slice: the end is the first one beyond.

    Parameters
    ----------
    begin : int
        Where the approach begins; equal to `dwell` where there is none.
    dwell : int
        Where the approach ends and the dwell begins.
    retract : int
        Where the dwell ends and the retraction begins.
    end : int
        Where the retraction ends.
    """

    begin: int
    dwell: int
    retract: int
    end: int


def depth_of(record: TackRecord, into: int = 0) -> Array:
    """Return the position of the drive, growing into the solid [m].

    Raises
    ------
    ValueError
        If neither the heading, the caller nor the signal says which way that is.
    """
    x, F = record.position, record.force
    if np.ptp(x) == 0:
        raise InputError("the drive does not move: its position is the same in every row")
    sign = into or record.into
    if sign:
        return sign * x
    low, high = x <= x.min() + _END * np.ptp(x), x > x.max() - _END * np.ptp(x)
    if low.sum() < 3 or high.sum() < 3:
        raise InputError("fewer than three rows lie at an end of the travel")
    below, above = (np.subtract(*np.percentile(F[part], (98, 2))) for part in (low, high))
    if max(below, above) < _ACTIVE * min(below, above):
        raise InputError(
            "the force changes as much at one end of the travel as at the other, so that it cannot "
            "be told which end touches; say --into + (larger positions are deeper) or --into -"
        )
    return x if above > below else -x


def segments(time: Array, depth: Array) -> list[Segments]:
    """Return the cycles of a record: those that have a retraction.

    Raises
    ------
    ValueError
        If there is no retraction.
    """
    turns = _turns(depth)
    found = []
    for i, at in enumerate(turns):
        before = turns[i - 1] if i else 0
        after = turns[i + 1] if i + 1 < len(turns) else depth.size - 1
        if at == after or depth[at] <= depth[after]:
            continue
        found.append(_cycle(time, depth, before, at, after))
    if not found:
        raise InputError(
            "there is no retraction: the drive goes into the contact and never back by "
            f"{_TURN:.0%} of its range; give all intervals of the test together"
        )
    return found


def _turns(depth: Array) -> list[int]:
    """Return where the depth turns, the ends of the record among them."""
    least = _TURN * np.ptp(depth)
    turns = [0]
    high = low = 0
    rising = 0
    for i, value in enumerate(depth.tolist()):
        if value > depth[high]:
            high = i
        if value < depth[low]:
            low = i
        if rising >= 0 and depth[high] - value > least:
            if rising or depth[high] - depth[turns[0]] > least:
                turns.append(high)
            else:
                turns[0] = high
            rising, low, high = -1, i, i
        elif rising <= 0 and value - depth[low] > least:
            if rising or depth[turns[0]] - depth[low] > least:
                turns.append(low)
            else:
                turns[0] = low
            rising, low, high = 1, i, i
    last = high if rising > 0 else low
    if last != turns[-1]:
        turns.append(last)
    return turns


def _cycle(time: Array, depth: Array, before: int, at: int, after: int) -> Segments:
    way = depth[at] - depth[after]
    # the last point near the deepest: a dwell may creep, and its deepest point be anywhere in it
    near = depth[at : after + 1] >= depth[at] - _NEAR * way
    retract = at + int(np.flatnonzero(near)[-1])
    arrived = depth[retract : after + 1] <= depth[after] + 1e-9 * way
    end = retract + int(np.flatnonzero(arrived)[0]) + 1
    dwell = _knee(time, depth, before, at, retract)
    return Segments(before, dwell, _departure(time, depth, dwell, at, retract, way), end)


def _knee(time: Array, depth: Array, before: int, at: int, late: int) -> int:
    """Return where the approach ends: farthest above the chord from its middle to the retraction.

    A drive that creeps in the dwell, or slows down before it, has this knee as a clean one has.
    """
    if before == at:
        return at
    half = (depth[before] + depth[at]) / 2
    middle = before + int(np.flatnonzero(depth[before : at + 1] <= half)[-1])
    t, d = time[middle : at + 1], depth[middle : at + 1]
    lasted = max(time[late] - time[middle], 1e-300)
    chord = depth[middle] + (depth[late] - depth[middle]) * (t - time[middle]) / lasted
    return middle + int(np.argmax(d - chord))


def _departure(time: Array, depth: Array, dwell: int, at: int, late: int, way: float) -> int:
    """Return the last point of the dwell: a drive leaves its level, not a part of the way."""
    lasted = time[late] - time[dwell : late + 1]
    held = (lasted < 0.5 * lasted[0]) & (lasted > 0.1 * lasted[0])
    # a drive may overshoot when it arrives, so that its deepest point is not its level
    level = float(np.median(depth[dwell : late + 1][held])) if held.sum() >= 10 else depth[at]
    near = depth[at : late + 1] >= level - 4 * point_noise(depth[dwell:]) - _STEP * way
    return at + int(np.flatnonzero(near)[-1]) if near.any() else at


def force_sign(force: Array, cycles: list[Segments]) -> int:
    """Return the sign that makes a compression positive, by the retractions of a record.

    A contact is pressed when a retraction begins, and is pulled when its force is farthest on the
    other side. Where the pull exceeds the press, the pull tells the sign, else the press.

    Raises
    ------
    ValueError
        If retractions disagree, or no force leaves its level out of contact.
    """
    signs = set()
    for cycle in cycles:
        F = force[cycle.retract : cycle.end]
        tail = F[-max(3, F.size // 20) :]
        level = np.median(tail)
        press = F[0] - level
        pull = F[int(np.argmax(np.abs(F - level)))] - level
        if abs(pull) <= 4 * np.std(tail):
            continue
        larger = abs(pull) > _DISTINCT * abs(press)
        signs.add(int(-np.sign(pull) if larger else np.sign(press)))
    if not signs:
        raise InputError(
            "no force rises above its noise: nothing was touched, or the force is another column"
        )
    if len(signs) > 1:
        raise InputError(
            "the cycles disagree on the sign of a compression; say --compression + or -"
        )
    return signs.pop()
