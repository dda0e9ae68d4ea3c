r"""Data of one tack test in SI, its segments, and the results of a cycle.

Approach, dwell and retraction of each cycle are detected from the signal, not from labels. Depth
reverses where the drive does. Between two reversals it must move by a tenth of its range, so that
creep, noise and steps of the drive do not create cycles. A dwell begins at the knee of depth over
time, and ends where the drive leaves its level by more than its scatter.

The direction into the solid is known for a gap or a depth. A travel is oriented such that the force
changes most at its deep end; a force such that compression is positive. Both raise an error if
the signal is ambiguous.

In results force is positive in compression. Depth is positive into the solid and zero at first
contact. The pull-off force is positive. Uncertainties are standard uncertainties (68 %).
"""

from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import Source, array, store

from .baseline import point_noise

# beyond the range of all rigs: a damaged number or a wrong unit
_LIMITS = {
    "time": ("s", -1e10, 1e10), "force": ("N", -1e8, 1e8), "position": ("m", -1e4, 1e4),
    "contact_radius": ("m", 0.0, 1e4), "temperature": ("K", 1e-300, 1e4),
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class TackRecord:
    """One continuous record of a tack test.

    Parameters
    ----------
    time : array_like, shape (N,)
        Time since any origin [s]; strictly increasing.
    force : array_like, shape (N,)
        Force with the sign of the file [N].
    position : array_like, shape (N,)
        Position of the drive [m], with the sign of the file: gap, depth or travel.
    into : {1, -1, 0}
        1 if a larger position is deeper in the solid, -1 if it is further away, 0 if unknown.
    compliance : float
        Compliance between drive and contact [m/N], of a cantilever stated in the file; 0 otherwise.
    contact_radius : array_like, shape (N,), optional
        Measured by a camera [m]; nan where unknown.
    temperature : array_like, shape (N,), optional
        Temperature of the test [K]; nan where unknown.
    source : Source
        Origin of the numbers.

    Raises
    ------
    ValueError
        If lengths differ, a number is not finite, time does not increase or there are too few
        points.
    """

    time: Array
    force: Array
    position: Array
    into: int = 0
    compliance: float = 0.0
    contact_radius: Array | None = None
    temperature: Array | None = None
    source: Source = Source()

    def __post_init__(self):
        length = None
        for name, (unit, least, most) in _LIMITS.items():
            if getattr(self, name) is None:
                continue
            row = array(name, getattr(self, name), unit, length)
            length = row.size
            unknown = np.isnan(row) & (name in ("contact_radius", "temperature"))
            wrong = row[~((row >= least) & (row <= most) | unknown)]
            if wrong.size:
                limits = f"{name} must lie between {least:g} and {most:g} {unit}"
                raise InputError(f"{limits}, got {wrong[0]:g}; check its unit")
            store(self, name, row)
        steps = np.diff(self.time)
        if np.any(steps < 0):
            at = int(np.argmin(steps))
            after, before = self.time[at + 1], self.time[at]
            raise InputError(f"time must increase, but {after:g} s follows {before:g} s")
        if self.into not in (-1, 0, 1):
            raise InputError(f"into must be 1, -1 or 0, got {self.into!r}")
        if not 0 <= self.compliance < np.inf:
            raise InputError(f"compliance must not be negative [m/N], got {self.compliance!r}")

    def __len__(self) -> int:
        return self.time.size


_TURN = 0.1  # fraction of the range of depths
_NEAR = 0.01  # fraction of the retraction's travel: certainly begun
_STEP = 2e-4  # fraction of the retraction's travel: last step of the drive, not motion
_END = 0.15  # fraction of the range of depths at either end in which forces are compared
_ACTIVE = 3.0  # ratio of force changes that identifies the end in contact
_DISTINCT = 1.2  # ratio of forces that identifies the larger one


@dataclass(frozen=True)
class Segments:
    """Indices of one cycle in its record; as in a slice, `end` is exclusive.

    Parameters
    ----------
    begin : int
        Start of the approach; equal to `dwell` if there is none.
    dwell : int
        End of the approach and start of the dwell.
    retract : int
        End of the dwell and start of the retraction.
    end : int
        End of the retraction.
    """

    begin: int
    dwell: int
    retract: int
    end: int


def depth_of(record: TackRecord, into: int = 0) -> Array:
    """Return the position of the drive, increasing into the solid [m].

    Raises
    ------
    ValueError
        If neither heading, caller nor signal determines the direction.
    """
    x, F = record.position, record.force
    if np.ptp(x) == 0:
        raise InputError("the drive does not move: its position is equal in all rows")
    sign = into or record.into
    if sign:
        return sign * x
    low, high = x <= x.min() + _END * np.ptp(x), x > x.max() - _END * np.ptp(x)
    if low.sum() < 3 or high.sum() < 3:
        raise InputError("fewer than three rows at an end of the travel: which end is in contact?")
    below, above = (np.subtract(*np.percentile(F[part], (98, 2))) for part in (low, high))
    if max(below, above) < _ACTIVE * min(below, above):
        raise InputError("the force changes alike at both ends; set `into`, + if larger is deeper")
    return x if above > below else -x


def segments(time: Array, depth: Array) -> list[Segments]:
    """Return the cycles of a record that have a retraction.

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
            f"the drive never moves back by {_TURN:.0%}: no retraction; give all intervals"
        )
    return found


def _turns(depth: Array) -> list[int]:
    """Return the indices where the depth reverses, including the ends of the record."""
    least = _TURN * np.ptp(depth)
    turns = [0]
    high = low = 0
    rising = 0
    for i, value in enumerate(depth.tolist()):
        high = i if value > depth[high] else high
        low = i if value < depth[low] else low
        # a rise turns at its highest point, a fall at its lowest
        for way, end in ((1, high), (-1, low)):
            if rising != -way and way * (depth[end] - value) > least:
                if rising or way * (depth[end] - depth[turns[0]]) > least:
                    turns.append(end)
                else:
                    turns[0] = end
                rising, low, high = -way, i, i
                break
    last = high if rising > 0 else low
    if last != turns[-1]:
        turns.append(last)
    return turns


def _cycle(time: Array, depth: Array, before: int, at: int, after: int) -> Segments:
    way = depth[at] - depth[after]
    # last point near the deepest one, which may be anywhere in a creeping dwell
    near = depth[at : after + 1] >= depth[at] - _NEAR * way
    retract = at + int(np.flatnonzero(near)[-1])
    arrived = depth[retract : after + 1] <= depth[after] + 1e-9 * way
    end = retract + int(np.flatnonzero(arrived)[0]) + 1
    dwell = _knee(time, depth, before, at, retract)
    # the dwell ends where the drive departs from its level by more than its scatter
    lasted = time[retract] - time[dwell : retract + 1]
    held = (lasted < 0.5 * lasted[0]) & (lasted > 0.1 * lasted[0])
    # the drive may overshoot on arrival, so the deepest point is not the level
    waited = depth[dwell : retract + 1][held]
    level = float(np.median(waited)) if held.sum() >= 10 else depth[at]
    noise = point_noise(depth[dwell:]) if depth.size > dwell + 2 else 0.0
    last = np.flatnonzero(depth[at : retract + 1] >= level - 4 * noise - _STEP * way)
    return Segments(before, dwell, at + int(last[-1]) if last.size else at, end)


def _knee(time: Array, depth: Array, before: int, at: int, late: int) -> int:
    """Return the end of the approach: the point farthest above a chord.

    The chord runs from the middle of the approach to the retraction. The knee also exists if the
    drive creeps in the dwell, or decelerates before it.
    """
    if before == at:
        return at
    half = (depth[before] + depth[at]) / 2
    middle = before + int(np.flatnonzero(depth[before : at + 1] <= half)[-1])
    t, d = time[middle : at + 1], depth[middle : at + 1]
    lasted = max(time[late] - time[middle], 1e-300)
    chord = depth[middle] + (depth[late] - depth[middle]) * (t - time[middle]) / lasted
    return middle + int(np.argmax(d - chord))


def force_sign(force: Array, cycles: list[Segments]) -> int:
    """Return the sign that makes compression positive, from the retractions of a record.

    A retraction begins in compression and reaches tension later. The larger of the two extremes
    determines the sign.

    Raises
    ------
    ValueError
        If retractions disagree, or no force exceeds its noise.
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
        raise InputError("no force rises above its noise: no contact, or another column")
    if len(signs) > 1:
        raise InputError("the cycles disagree on the sign of a compression; set `compression`")
    return signs.pop()


@dataclass(frozen=True)
class Measured:
    """A number with its standard uncertainty, in the same unit."""

    value: float
    uncertainty: float


@dataclass(frozen=True, eq=False)
class Cycle:
    """One approach, dwell and retraction.

    Parameters
    ----------
    number : int
        Counted from 1, in the order of the record.
    time, force, depth : ndarray, shape (N,)
        Data of the whole cycle [s, N, m], corrected for zero, tilt, drift and compliance.
    contact_radius : ndarray or None
        Measured by a camera [m].
    segments : Segments
        Indices where approach, dwell and retraction begin in these arrays.
    pull_off_force : Measured
        Largest tension of the retraction [N].
    pull_off_raw : float
        The same from the uncorrected force of the file [N].
    pull_off_at : int
        Index of the pull-off in the arrays.
    depth_at_pull_off : Measured
        Depth at pull-off [m].
    work_to_pull_off, work_of_separation : Measured
        Integral of -force d(depth) from the last zero crossing of the force to the pull-off and
        to the end of the contact [J].
    preload : Measured
        Largest force before the retraction [N].
    preload_depth : Measured
        Depth where the retraction begins [m].
    dwell_time : float
        Time between approach and retraction [s].
    speed : Measured
        True speed of the drive between the zero crossing of the force and the pull-off [m/s];
        the uncertainty is its unevenness.
    mean_speed : Measured
        Speed over the whole retraction [m/s].
    approach_speed : float or None
        Speed in the middle of the approach [m/s].
    noise : float
        Standard deviation of the force out of contact [N].
    source : Source
        Origin of the numbers; its notes list all decisions.
    temperature : float or None
        Mean temperature of the cycle [K]; None where the file states none.
    compliance : float
        Compliance of the rig between drive and contact, subtracted from the depth [m/N].
    cautions : tuple of str
        Signs that the theories of a closing edge do not hold.
    """

    number: int
    time: Array
    force: Array
    depth: Array
    contact_radius: Array | None
    segments: Segments
    pull_off_force: Measured
    pull_off_raw: float
    pull_off_at: int
    depth_at_pull_off: Measured
    work_to_pull_off: Measured
    work_of_separation: Measured
    preload: Measured
    preload_depth: Measured
    dwell_time: float
    speed: Measured
    mean_speed: Measured
    approach_speed: float | None
    noise: float
    source: Source
    temperature: float | None = None
    compliance: float = 0.0
    cautions: tuple[str, ...] = ()

    @property
    def retraction(self) -> slice:
        """Slice of the points of the retraction."""
        return slice(self.segments.retract, self.segments.end)
