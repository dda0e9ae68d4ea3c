"""The opening part of a cycle as a curve: its force minimum, and the work that it takes.

The curve between two steps is a cubic; where it breaks, at a jump, it is not drawn across. So the
force minimum and the zero crossing are located between steps, and a jump adds no work.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.protocol import Dwell, LoadTo

from . import Event, Outcome, Result
from .parts import Span, move_numbers, moves_of, touches, waits

# Steps of equal length are equal but for round-off.
_EQUAL = 1 + 1e-9
# A force that has risen by this part of its minimum and of the unit of force has left it.
_RISEN = 0.03
# A force of the march is rough by about this part of itself.
_ROUGH = 1e-3
# Steps after the pull-off within which an edge that is gone counts as running out.
_GONE = 3


@dataclass(frozen=True)
class PullOff:
    """A force minimum of a retraction, located between steps; dimensionless as in `Result`.

    Attributes
    ----------
    force : float
        Tension there, a positive number: the pull-off force at the lowest minimum.
    depth, time : float
        Where and when.
    contact_radius : float
        Contact radius there; nan without an edge.
    crack_speed : float
        Speed at which the edge recedes there, positive; nan without an edge.
    """

    force: float
    depth: float
    time: float
    contact_radius: float
    crack_speed: float


@dataclass(frozen=True, eq=False)
class _Piece:
    """Steps over which the depth falls without a break.

    A force that is least at its end is a minimum where it `snaps` there, and one that is least
    at its beginning where it `starts` there: with the test itself, behind dwells at its relaxed
    start, or after a jump that left some contact. Where the machine turns or stops, it is not.
    """

    steps: npt.NDArray[np.intp]
    starts: bool
    snaps: bool
    held: bool

    def has_minimum(self, lowest: int) -> bool:
        """Return whether the force minimum of the contact can be at one of its steps."""
        begins, ends = lowest == 0, lowest == len(self.steps) - 1
        free = not self.held
        return free and (self.starts or not begins) and (self.snaps or not ends)


def pull_off_in(result: Result, span: Span) -> PullOff:
    """Return the state at the force minimum of the opening part of a cycle.

    Raises
    ------
    ValueError
        If there is none: nothing is pulled in it, or the force was lowest where the machine turned
        or stopped, or was itself what the machine set.
    """
    return _located(result, *_valley_of(result, span))


def peaks_in(result: Result, span: Span) -> tuple[PullOff, ...]:
    """Return the states at all peaks of the tension in the opening part of a cycle, in time.

    Between two of them the tension falls by 3 % of the smaller one, and of the unit of force, at
    least. A jump ends a peak as a smooth maximum does.

    Raises
    ------
    ValueError
        If the surfaces were never in contact.
    """
    return tuple(_located(result, *valley) for valley in _valleys(result, span))


def _located(result: Result, steps: npt.NDArray[np.intp], lowest: int) -> PullOff:
    """Return the state at a force minimum, between the steps around the lowest one of a piece."""
    # The motion is a retraction without a break: travel, minus the depth, orders the steps.
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
    """Return the square of the least force over its curvature; 0 where it is least in no valley.

    What the drive does in vain, or saves, where the slope of the force is wrong by a part of the
    least force is this times that part: the minimum moves by slope over curvature.
    """
    steps, i = _valley_of(result, span)
    x, force = -result.depth[steps], result.force[steps]
    if not 0 < i < len(x) - 1 or _smooth(move_numbers(result)[steps], i) is None:
        return 0.0
    return float(force[i] ** 2 / _curvature(x, force, i))


def reach_of_fold(result: Result, span: Span) -> float:
    r"""Return over which depths a growing load finds a contact on the brink [h0].

    Under a load that grows the contact lets go at a fold, where the force :math:`P` of equilibrium
    has no slope over the depth. A march with an error :math:`\epsilon P` ends anywhere where the
    force is that near to the largest one:

    .. math:: \Delta \delta = \sqrt{2 \epsilon P / P''}

    Returned for :math:`\epsilon = 1`, with the curvature of the last three steps; 0 where the
    contact does not let go under such a load.
    """
    steps, i = _valley_of(result, span)
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
    """Return the part of a piece in which one move led on from the lowest step, around it.

    None where that move ended there: the next one may bend the curve.
    """
    within = np.flatnonzero(moves == moves[lowest])
    first, last = int(within[0]), int(within[-1])
    if lowest == last < len(moves) - 1:
        return None
    # a move begins at the last step of the one before
    return slice(max(first - 1, 0), last + 1)


# Steps of a piece, and which of them is the lowest of a valley.
_Valley = tuple[npt.NDArray[np.intp], int]


def _valley_of(result: Result, span: Span) -> _Valley:
    """Return the lowest valley of the force in the opening part of a cycle.

    A piece that is lowest where it ends without a minimum has none: the force falls further.
    """
    found, pieces = None, _opening(result, span)
    for piece in pieces:
        lowest = int(np.argmin(result.force[piece.steps]))
        if _is_valley(result, piece, lowest):
            valley = piece.steps, lowest
            found = valley if found is None else _lower(result, found, valley)
    if found is None:
        raise InputError(_why_none(result, span, pieces))
    return found


def _valleys(result: Result, span: Span) -> list[_Valley]:
    """Return all valleys of the force in tension, in time."""
    found: list[_Valley] = []
    for piece in _opening(result, span):
        for lowest in _minima(result.force[piece.steps]):
            if not _is_valley(result, piece, lowest):
                continue
            valley = piece.steps, lowest
            if found and not _apart(result, found[-1], valley):
                valley = _lower(result, found.pop(), valley)
            found.append(valley)
    return found


def _opening(result: Result, span: Span) -> list[_Piece]:
    if not touches(result, span):
        raise InputError("the surfaces were never in contact, there is no pull-off")
    return _pieces(result, span)


def _is_valley(result: Result, piece: _Piece, lowest: int) -> bool:
    return _force_of(result, (piece.steps, lowest)) < 0 and piece.has_minimum(lowest)


def _lower(result: Result, one: _Valley, other: _Valley) -> _Valley:
    return other if _force_of(result, other) < _force_of(result, one) else one


def _force_of(result: Result, valley: _Valley) -> float:
    steps, lowest = valley
    return float(result.force[steps[lowest]])


def _apart(result: Result, one: _Valley, other: _Valley) -> bool:
    """Return whether the force rises between two valleys, and so much that they are two."""
    first, last = one[0][one[1]], other[0][other[1]]
    higher = max(_force_of(result, one), _force_of(result, other))
    top = min(float(result.force[first : last + 1].max()), 0.0)
    return top - higher > _RISEN * (abs(higher) + 1)


def _minima(force: Array) -> list[int]:
    """Return the lowest steps before each rise of the force that is not noise, and the last one.

    The lowest of all is among them.
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


def _why_none(result: Result, span: Span, pieces: list[_Piece]) -> str:
    steps = np.arange(span.turn, span.last + 1)
    ended = f"the run ended: {result.status}"
    if not span.opens:
        return f"nothing is pulled in the test, there is no pull-off; {ended}"
    if not np.any(result.force[steps] < 0):
        return f"the force is nowhere tensile, there is no pull-off; {ended}"
    if any(p.held for p in pieces):
        return "the force is what the machine held, there is no pull-off force"
    lowest = steps[int(np.argmin(result.force[steps]))]
    if lowest == len(result.force) - 1:
        return (
            f"the force still falls at the end of the run ({result.status}), the pull-off is not "
            "in it; run further"
        )
    return f"the force was least where the machine turned or stopped, not at a pull-off; {ended}"


def tension_work(result: Result, span: Span, found: PullOff, *, until: float) -> float:
    """Return the integral of -force over the travel in tension around the pull-off."""
    total, tension = 0.0, True
    # Backwards from the end, so that the first crossing met before the minimum is the last one.
    parts = [part for piece in _pieces(result, span) for part in _moves_of(result, piece.steps)]
    for steps in reversed(parts):
        if len(steps) < 2:
            continue  # a single step between two jumps spans no work
        x, force = -result.depth[steps], result.force[steps]
        before = x < -found.depth
        if before.any() and force[before][-1] > 0 and x[-1] < -found.depth:
            tension = False  # the crossing was the jump behind this piece
        if not tension:
            break
        begin = x[0]
        positive = np.flatnonzero(before & (force >= 0))
        curve = _curve(x, force)
        if positive.size and positive[-1] + 1 < len(x):
            i = int(positive[-1])
            begin, tension = _root(curve, x[i], x[i + 1]), False
        end = min(x[-1], until)
        if begin < end:
            total -= float(curve.integrate(begin, end))
    return total


def _moves_of(result: Result, steps: npt.NDArray[np.intp]) -> list[npt.NDArray[np.intp]]:
    """Return the steps of a piece move by move: where the speed changes, the curve has a kink.

    A move begins at the last step of the one before.
    """
    ends = np.flatnonzero(np.diff(move_numbers(result)[steps])) + 1
    begins = np.maximum(ends - 1, 0)
    cuts = zip([0, *begins], [*ends, len(steps)], strict=True)
    return [steps[begin:end] for begin, end in cuts]


def _pieces(result: Result, span: Span) -> list[_Piece]:
    """Return the opening part of a cycle as runs of steps between jumps, stops and turns."""
    part = np.arange(span.turn, span.last + 1)
    depth = result.depth
    first = span.turn + int(np.flatnonzero(depth[part] == depth[part].max())[-1])
    moves, number = moves_of(result), move_numbers(result)
    waiting = np.array([waits(move) for move in moves])[number]
    # Of each step but the last: whether the next one is behind a break, a jump, or another move.
    broken = np.diff(depth) >= 0
    jumped = np.zeros(len(broken), dtype=bool)
    for event in result.events:
        if event.kind.startswith("jump"):
            jumped |= _jump(result, event)
    # where the drive goes on, and only the clock stands still, it is a jump as well
    goes_on = np.append(np.diff(depth)[1:] < 0, False) & ~waiting[1:]
    jumped |= (np.diff(depth) == 0) & goes_on
    stopped = (number[1:] != number[:-1]) & (waiting[1:] | waiting[:-1])
    stopped[: first + 1] = False
    ends = [i for i in range(first, span.last) if broken[i] or jumped[i] or stopped[i]]
    # a dwell at the relaxed start changes nothing: the test begins behind it
    rested = all(waits(moves[i]) for i in np.unique(number[1 : first + 1]))
    pieces, begin, starts = [], first, rested and not jumped[:first].any()
    for end in [*ends, span.last]:
        over = end == len(depth) - 1
        snaps = result.outcome is Outcome.JUMPED if over else end < span.last and bool(jumped[end])
        if snaps and not over and isinstance(moves[number[end]], LoadTo | Dwell):
            # where the machine sets the force, one that is borne on was no pull-off
            snaps = bool(np.isnan(result.contact_radius[end + 1]))
        held = end > begin and waits(moves[number[end]], "force")
        pieces.append(_Piece(np.arange(begin, end + 1), starts, snaps, held))
        if not over and end < span.last:
            # a curve that a stop bends goes on from there; behind a break the next one begins
            bends = stopped[end] and not (broken[end] or jumped[end])
            begin = end + (not bends)
            starts = bool(jumped[end]) and bool(np.isfinite(result.contact_radius[begin]))
    return pieces


def _jump(result: Result, event: Event) -> npt.NDArray[np.bool_]:
    """Return of each step but the last whether an event lies between it and the next one.

    Many steps may have the time of a jump to the last digit: the depth tells which one it led to.
    A jump on the way to a step that is kept later has a time of its own.
    """
    time, depth = result.time, result.depth
    reached = (time[1:] == event.time) & (depth[1:] == event.depth)
    return reached if reached.any() else (time[:-1] < event.time) & (event.time <= time[1:])


def _nearest(x: Array, i: int) -> slice:
    """Return the up to four entries around number i: its neighbours, and the nearer of the next."""
    low, high = max(i - 1, 0), min(i + 2, len(x))
    before = x[i] - x[low - 1] if low > 0 else np.inf
    after = x[high] - x[i] if high < len(x) else np.inf
    if min(before, after) < np.inf:
        # of two equally far the earlier, and not that which round-off makes the nearer
        low, high = (low - 1, high) if before <= after * _EQUAL else (low, high + 1)
    return slice(low, high)


def _minimum(x: Array, y: Array, i: int) -> tuple[float, float]:
    """Return where the curve is lowest, near the lowest of its points i, and its value there."""
    if 0 < i < len(x) - 1:
        scale = x[i + 1] - x[i - 1]
        for points in (_nearest(x, i), slice(i - 1, i + 2)):
            u = (x[points] - x[i]) / scale
            taylor = np.linalg.solve(np.vander(u, increasing=True), y[points])
            at = _valley(*taylor[1:])
            if (x[i - 1] - x[i]) / scale < at < (x[i + 1] - x[i]) / scale:
                value = float(np.polynomial.polynomial.polyval(at, taylor))
                place = float(x[i] + scale * at)
                if value >= least_between(x, y, i, place):
                    return place, value
    return float(x[i]), float(y[i])


def least_between(x: Array, y: Array, i: int, place: float) -> float:
    """Return the least value that a curve may have beside its lowest point i.

    A valley lies above the line through the two points before the place. Where the force breaks off
    behind the lowest step, a parabola or a cubic would go far below that line.
    """
    last = i if place > x[i] else i - 1
    if last < 1:
        return float(2 * y[i] - max(y[i - 1], y[i + 1]))
    slope = (y[last] - y[last - 1]) / (x[last] - x[last - 1])
    return float(y[last] + slope * (place - x[last]) - _ROUGH * abs(y[i]))


def _valley(c: float, b: float, a: float = 0.0) -> float:
    """Return the minimum of c u + b u^2 + a u^3 without cancellation for small a; nan for none."""
    root = b * b - 3 * a * c
    if root < 0 or (a == 0 and b <= 0):
        return np.nan
    if b > 0:
        return -c / (b + root**0.5)
    return (root**0.5 - b) / (3 * a)


def _between(x: Array, y: Array, at: float) -> float:
    """Return a value between two steps by a straight line; nan where one of them is unknown."""
    i = int(np.searchsorted(x, at))
    if x[i] == at:
        return float(y[i])
    return float(np.interp(at, x[i - 1 : i + 1], y[i - 1 : i + 1]))


def _running_out(x: Array, edge: Array, time: Array, at: float) -> tuple[float, float] | None:
    """Return place and speed of an edge that is gone within a few steps.

    It runs faster and faster, so that its place is no smooth function of the travel; but the travel
    is one of the place: a cubic through the last four up to there. None where the edge goes on, or
    has not moved.
    """
    i = int(np.searchsorted(x, at))
    known = np.isfinite(edge)
    last = i if known[i] else i - 1
    if last < 3 or np.all(known[last : i + 2 + _GONE]):
        return None
    points = slice(last - 3, last + 1)
    # nan where there was no edge, which is no fall either
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


def _curve(x: Array, y: Array) -> "scipy.interpolate.CubicHermiteSpline":
    """Return the cubics through the points, with slopes of second order."""
    slope = np.gradient(y, x, edge_order=2 if len(x) > 2 else 1) if len(x) > 1 else np.zeros(1)
    return scipy.interpolate.CubicHermiteSpline(x, y, slope)


def _root(curve: "scipy.interpolate.CubicHermiteSpline", low: float, high: float) -> float:
    return float(scipy.optimize.brentq(curve, low, high))  # type: ignore[arg-type]
