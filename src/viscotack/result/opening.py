"""Opening part of a cycle as a curve: its force minimum and work.

The curve between two steps is a cubic, interrupted at jumps. The force minimum and the zero
crossing are located between steps, and a jump adds no work.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.protocol import Dwell, LoadTo

from . import Outcome, Result
from .parts import Span, move_numbers, moves_of, touches, waits

# Tolerance for equal step lengths.
_EQUAL = 1 + 1e-9
# Rise of the force that ends a minimum, relative to the minimum and to the unit of force.
_RISEN = 0.03
# Relative numerical noise of a simulated force.
_ROUGH = 1e-3
# Differences of the force on a plateau, relative.
_EVEN = 1e-6
# Number of steps after the pull-off within which the edge may vanish.
_GONE = 3


@dataclass(frozen=True)
class PullOff:
    """Force minimum of a retraction, from :func:`viscotack.pull_off`; dimensionless.

    Attributes
    ----------
    force : float
        Tension, positive; at the lowest minimum the pull-off force.
    depth, time : float
        Depth and time of the minimum.
    contact_radius : float
        Contact radius; nan without an edge.
    crack_speed : float
        Receding speed of the edge, positive; nan without an edge.
    """

    force: float
    depth: float
    time: float
    contact_radius: float
    crack_speed: float


class _Valley(NamedTuple):
    """Steps of a piece, the index of the lowest one of a valley, and its force."""

    steps: npt.NDArray[np.intp]
    lowest: int
    force: float


@dataclass(frozen=True, eq=False)
class _Piece:
    """Steps over which the depth decreases without interruption.

    A smallest force at its end is a minimum if the contact `snaps` there; one at its beginning if
    it `starts` there: with the test itself, after dwells at the relaxed start, or after a jump that
    left some contact. It is not a minimum where the machine reverses or stops, or `held` the force.
    """

    steps: npt.NDArray[np.intp]
    starts: bool
    snaps: bool
    held: bool

    def valley(self, force: Array, lowest: int) -> _Valley | None:
        """Return the valley of the force at one of the steps; None if there can be none in tension.

        `force` is that of the whole run.
        """
        begins, ends = lowest == 0, lowest == len(self.steps) - 1
        free = not self.held and (self.starts or not begins) and (self.snaps or not ends)
        least = float(force[self.steps[lowest]])
        return _Valley(self.steps, lowest, least) if free and least < 0 else None


def pull_off_in(result: Result, span: Span) -> PullOff:
    """Return the state at the force minimum of the opening part of a cycle.

    Raises
    ------
    ValueError
        If there is none: there is no tension, or the force was lowest where the machine reversed
        or stopped, or was set by the machine.
    """
    return _located(result, _valley_of(result, span))


def peaks_in(result: Result, span: Span) -> tuple[PullOff, ...]:
    """Return the states at all tension peaks of the opening part of a cycle, in order of time.

    Peaks are separate if the tension between them falls by at least 3 % of the smaller one, and of
    the unit of force. A jump ends a peak like a smooth maximum.

    Raises
    ------
    ValueError
        If the surfaces were never in contact.
    """
    found: list[_Valley] = []
    for piece in _pieces(result, span):
        for lowest in _minima(result.force[piece.steps]):
            valley = piece.valley(result.force, lowest)
            if valley is None:
                continue
            if found and not _apart(result, found[-1], valley):
                valley = min(found.pop(), valley, key=lambda each: each.force)
            found.append(valley)
    return tuple(_located(result, valley) for valley in found)


def _located(result: Result, valley: _Valley) -> PullOff:
    """Return the state at a force minimum, between the steps around the lowest one of a piece."""
    steps, lowest, _ = valley
    # The motion is an uninterrupted retraction, so the travel (minus the depth) orders the steps.
    x = -result.depth[steps]
    smooth = _smooth(move_numbers(result)[steps], lowest)
    if smooth is None:
        place, smallest = float(x[lowest]), float(result.force[steps[lowest]])
    else:
        force = result.force[steps][smooth]
        place, smallest = _minimum(x[smooth], force, lowest - smooth.start)
    edge, time = result.contact_radius[steps], result.time[steps]
    at_edge = _running_out(x, edge, time, place) if result.groups.in_plane_strain else None
    if at_edge is None:
        at_edge = _between(x, edge, place), _between(x, result.edge_speed[steps], place)
    return PullOff(
        force=-smallest,
        depth=-place,
        time=_between(x, time, place),
        contact_radius=at_edge[0],
        crack_speed=at_edge[1],
    )


def lost_beside(result: Result, span: Span) -> float:
    """Return the square of the smallest force over its curvature; 0 unless it is a smooth valley.

    An error of the slope of the force, relative to the smallest force, times this number is the
    error of the work, because the minimum shifts by slope over curvature.
    """
    steps, i, _ = _valley_of(result, span)
    x, force = -result.depth[steps], result.force[steps]
    if not 0 < i < len(x) - 1 or _smooth(move_numbers(result)[steps], i) is None:
        return 0.0
    return float(force[i] ** 2 / _curvature(x, force, i))


def between_steps(result: Result, span: Span) -> float:
    """Return how far the place of the force minimum is known between the steps [h0].

    This is the largest distance between the minimum and those of the parabola through the lowest
    three steps and of the cubics through one more on either side. They differ where the curve bends
    within a step, as at the end of a table of a law; 0 unless the minimum is a smooth valley.
    """
    steps, lowest, _ = _valley_of(result, span)
    smooth = _smooth(move_numbers(result)[steps], lowest)
    if smooth is None:
        return 0.0
    x, y, i = -result.depth[steps][smooth], result.force[steps][smooth], lowest - smooth.start
    if not 0 < i < len(x) - 1:
        return 0.0
    place, _ = _minimum(x, y, i)
    several = (slice(i - 1, i + 2), slice(i - 2, i + 2), slice(i - 1, i + 3))
    others = [s for s in several if s.start >= 0 and s.stop <= len(x)]
    found = [at for points in others for at, _ in _lowest(x, y, i, points)]
    return max((abs(at - place) for at in found), default=0.0)


def reach_of_fold(result: Result, span: Span) -> float:
    r"""Return the range of depths near a fold under growing load [h0].

    Under a growing load the contact detaches at a fold, where the equilibrium force :math:`P` has
    zero slope over the depth. A simulation with an error :math:`\epsilon P` may end anywhere with a
    force this close to the extreme one:

    .. math:: \Delta \delta = \sqrt{2 \epsilon P / P''}

    The result holds for :math:`\epsilon = 1`, with the curvature of the last three steps; it is 0
    if the contact does not detach under such a load.
    """
    steps, i, _ = _valley_of(result, span)
    moves, number = moves_of(result), move_numbers(result)
    if i < 2 or i < len(steps) - 1 or not isinstance(moves[number[steps[i]]], LoadTo):
        return 0.0
    curvature = _curvature(-result.depth[steps], result.force[steps], i - 1)
    return float(np.sqrt(-2 * result.force[steps[i]] / curvature)) if curvature > 0 else 0.0


def _curvature(x: Array, y: Array, i: int) -> float:
    """Return the second derivative of the parabola through a point and its neighbours."""
    before, after = np.diff(y[i - 1 : i + 2]) / np.diff(x[i - 1 : i + 2])
    return float(2 * (after - before) / (x[i + 1] - x[i - 1]))


def _smooth(moves: npt.NDArray[np.intp], lowest: int) -> slice | None:
    """Return the steps of the single move around the lowest step of a piece.

    None if the move ended there, because the next one may have a kink.
    """
    within = np.flatnonzero(moves == moves[lowest])
    first, last = int(within[0]), int(within[-1])
    if lowest == last < len(moves) - 1:
        return None
    # a move begins at the last step of the previous one
    return slice(max(first - 1, 0), last + 1)


def _valley_of(result: Result, span: Span) -> _Valley:
    """Return the lowest valley of the force in the opening part of a cycle.

    A piece that is lowest at its end without a minimum has none, because the force decreases
    further.
    """
    pieces, force = _pieces(result, span), result.force
    valleys = (piece.valley(force, int(np.argmin(force[piece.steps]))) for piece in pieces)
    if found := [valley for valley in valleys if valley is not None]:
        return min(found, key=lambda valley: valley.force)
    steps = np.arange(span.turn, span.last + 1)
    ended = f"the run ended: {result.status}"
    if not span.opens:
        raise InputError(f"the test has no retraction, so there is no pull-off; {ended}")
    if not np.any(force[steps] < 0):
        raise InputError(f"the force is nowhere tensile, so there is no pull-off; {ended}")
    if any(piece.held for piece in pieces):
        raise InputError("the machine held the force, so there is no pull-off force")
    if steps[int(np.argmin(force[steps]))] == len(force) - 1:
        raise InputError(
            f"the force still decreases at the end of the run ({result.status}), so the pull-off "
            "is not reached; run further"
        )
    raise InputError(
        f"the force was smallest where the machine reversed or stopped, not at a pull-off; {ended}"
    )


def _apart(result: Result, one: _Valley, other: _Valley) -> bool:
    """Return whether the force rises enough between two valleys to separate them."""
    first, last = one.steps[one.lowest], other.steps[other.lowest]
    higher = max(one.force, other.force)
    top = min(float(result.force[first : last + 1].max()), 0.0)
    return top - higher > _RISEN * (abs(higher) + 1)


def _minima(force: Array) -> list[int]:
    """Return the lowest steps before each significant rise of the force, and the last one.

    The global minimum is among them.
    """
    found, low, high, rising = [], 0, 0, False
    for i, now in enumerate(force):
        if rising:
            high = i if now > force[high] else high
            if min(force[high], 0.0) - now > _RISEN * (abs(force[high]) + 1) or now < force[low]:
                low, rising = i, False
        elif now < force[low]:
            low = i
        elif min(now, 0.0) - force[low] > _RISEN * (abs(force[low]) + 1):
            found.append(low)
            high, rising = i, True
    return found if rising else [*found, low]


def tension_work(result: Result, span: Span, found: PullOff, *, until: float) -> float:
    """Integrate -force over the travel in tension around the pull-off."""
    work, tension = 0.0, True
    # the curve has a kink where the speed changes: a move begins at the last step of the previous
    # one
    parts, number = [], move_numbers(result)
    for piece in _pieces(result, span):
        ends = np.flatnonzero(np.diff(number[piece.steps])) + 1
        begins = [0, *np.maximum(ends - 1, 0)]
        parts += [piece.steps[i:j] for i, j in zip(begins, [*ends, None], strict=True)]
    # Go backwards from the end to find the last zero crossing before the minimum.
    for steps in reversed(parts):
        if len(steps) < 2:
            continue  # a single step between two jumps has no work
        x, force = -result.depth[steps], result.force[steps]
        before = x < -found.depth
        if before.any() and force[before][-1] > 0 and x[-1] < -found.depth:
            tension = False  # the crossing was the jump after this piece
        if not tension:
            break
        begin = x[0]
        positive = np.flatnonzero(before & (force >= 0))
        slope = np.gradient(force, x, edge_order=2 if len(x) > 2 else 1)
        curve = scipy.interpolate.CubicHermiteSpline(x, force, slope)
        if positive.size and positive[-1] + 1 < len(x):
            i = int(positive[-1])
            begin = float(scipy.optimize.brentq(curve, x[i], x[i + 1]))  # type: ignore[arg-type]
            tension = False
        end = min(x[-1], until)
        if begin < end:
            work -= float(curve.integrate(begin, end))
    return work


def _pieces(result: Result, span: Span) -> list[_Piece]:
    """Split the opening part of a cycle into runs of steps between jumps, stops and reversals."""
    if not touches(result, span):
        raise InputError("the surfaces were never in contact, so there is no pull-off")
    time, depth = result.time, result.depth
    part = depth[span.turn : span.last + 1]
    first = span.turn + int(np.flatnonzero(part == part.max())[-1])
    moves, number = moves_of(result), move_numbers(result)
    waiting = np.array([waits(move) for move in moves])[number]
    # For each step but the last: whether a break, a jump or a new move follows.
    broken = np.diff(depth) >= 0
    jumped = np.zeros(len(broken), dtype=bool)
    for event in result.events:
        if event.kind.startswith("jump"):
            # Several steps may have the time of a jump to the last digit; the depth identifies the
            # step after it. A jump on the way to a later stored step has its own time.
            reached = (time[1:] == event.time) & (depth[1:] == event.depth)
            on_the_way = (time[:-1] < event.time) & (event.time <= time[1:])
            jumped |= reached if reached.any() else on_the_way
    # motion of the drive at constant time is a jump as well
    goes_on = np.append(np.diff(depth)[1:] < 0, False) & ~waiting[1:]
    jumped |= (np.diff(depth) == 0) & goes_on
    stopped = (number[1:] != number[:-1]) & (waiting[1:] | waiting[:-1])
    stopped[: first + 1] = False
    ends = [i for i in range(first, span.last) if broken[i] or jumped[i] or stopped[i]]
    # a dwell at the relaxed start changes nothing: the test begins after it
    rested = all(waits(moves[i]) for i in np.unique(number[1 : first + 1]))
    pieces, begin, starts = [], first, rested and not jumped[:first].any()
    for end in [*ends, span.last]:
        over = end == len(depth) - 1
        snaps = result.outcome is Outcome.JUMPED if over else end < span.last and bool(jumped[end])
        if snaps and not over and isinstance(moves[number[end]], LoadTo | Dwell):
            # under load control, a force that the contact survives is no pull-off
            snaps = bool(np.isnan(result.contact_radius[end + 1]))
        held = end > begin and waits(moves[number[end]], "force")
        pieces.append(_Piece(np.arange(begin, end + 1), starts, snaps, held))
        if not over and end < span.last:
            # after a stop the curve continues with a kink; after a break a new one begins
            bends = stopped[end] and not (broken[end] or jumped[end])
            begin = end + (not bends)
            starts = bool(jumped[end]) and bool(np.isfinite(result.contact_radius[begin]))
    return pieces


def _nearest(x: Array, i: int) -> slice:
    """Return up to four indices around i: its neighbours, and the nearer of the next ones."""
    low, high = max(i - 1, 0), min(i + 2, len(x))
    before = x[i] - x[low - 1] if low > 0 else np.inf
    after = x[high] - x[i] if high < len(x) else np.inf
    if min(before, after) < np.inf:
        # prefer the earlier of two equally distant ones, despite round-off
        low, high = (low - 1, high) if before <= after * _EQUAL else (low, high + 1)
    return slice(low, high)


def _minimum(x: Array, y: Array, i: int) -> tuple[float, float]:
    """Return place and value of the minimum of the curve near its lowest point i."""
    if 0 < i < len(x) - 1:
        for points in (_nearest(x, i), slice(i - 1, i + 2)):
            for place, value in _lowest(x, y, i, points):
                if value >= least_between(x, y, i, place):
                    return place, value
    return float(x[i]), float(y[i])


def _lowest(x: Array, y: Array, i: int, points: slice) -> Iterator[tuple[float, float]]:
    """Yield place and value of the minimum of the polynomial through points next to point i."""
    scale = x[i + 1] - x[i - 1]
    u = (x[points] - x[i]) / scale
    taylor = np.linalg.solve(np.vander(u, increasing=True), y[points])
    at = _lowest_of(*taylor[1:])
    if (x[i - 1] - x[i]) / scale < at < (x[i + 1] - x[i]) / scale:
        yield float(x[i] + scale * at), float(np.polynomial.polynomial.polyval(at, taylor))


def least_between(x: Array, y: Array, i: int, place: float) -> float:
    """Return a lower bound of the curve next to its lowest point i.

    A valley lies above the line through the two points before the place. If the force breaks off
    after the lowest step, a parabola or a cubic would be far below that line. A plateau is lowest
    at its steps; a cubic through its corner would be below it.
    """
    # three steps in a row with the same force, as of an interface that yields at its strength
    rows = range(max(i - 2, 0), min(i, len(y) - 3) + 1)
    if any(np.ptp(y[row : row + 3]) <= _EVEN * abs(y[i]) for row in rows):
        return float(y[i] - _EVEN * abs(y[i]))
    last = i if place > x[i] else i - 1
    if last < 1:
        return float(2 * y[i] - max(y[i - 1], y[i + 1]))
    slope = (y[last] - y[last - 1]) / (x[last] - x[last - 1])
    return float(y[last] + slope * (place - x[last]) - _ROUGH * abs(y[i]))


def _lowest_of(c: float, b: float, a: float = 0.0) -> float:
    """Return the minimum of c u + b u^2 + a u^3 without cancellation for small a, or nan."""
    root = b * b - 3 * a * c
    if root < 0 or (a == 0 and b <= 0):
        return np.nan
    if b > 0:
        return -c / (b + root**0.5)
    return (root**0.5 - b) / (3 * a)


def _between(x: Array, y: Array, at: float) -> float:
    """Interpolate linearly between two steps; nan if one of them is unknown."""
    i = int(np.searchsorted(x, at))
    if x[i] == at:
        return float(y[i])
    return float(np.interp(at, x[i - 1 : i + 1], y[i - 1 : i + 1]))


def _running_out(x: Array, edge: Array, time: Array, at: float) -> tuple[float, float] | None:
    """Return place and speed of an edge that vanishes within a few steps.

    The edge accelerates, so its place is not a smooth function of the travel, but the travel is
    a smooth function of the place: a cubic through the last four points. None if the edge
    continues, or has not moved.
    """
    i = int(np.searchsorted(x, at))
    known = np.isfinite(edge)
    last = i if known[i] else i - 1
    if last < 3 or np.all(known[last : i + 2 + _GONE]):
        return None
    points = slice(last - 3, last + 1)
    # nan where there was no edge, which does not count as a decrease
    if not np.all(np.diff(edge[points]) < 0):
        return None
    scale = edge[last - 3] - edge[last]
    u = (edge[points] - edge[last]) / scale
    travel = np.polynomial.Polynomial(np.linalg.solve(np.vander(u, increasing=True), x[points]))
    roots = (travel - at).roots()
    roots = roots[
        (roots.imag == 0) & (roots.real <= 1) & (edge[last] + scale * roots.real > 0)
    ].real
    roots = roots[travel.deriv()(roots) < 0]
    if not roots.size:
        return None
    nearest = float(roots[np.argmin(np.abs(roots))])
    drive = (x[i] - x[i - 1]) / (time[i] - time[i - 1])
    return float(edge[last] + scale * nearest), float(-scale * drive / travel.deriv()(nearest))
