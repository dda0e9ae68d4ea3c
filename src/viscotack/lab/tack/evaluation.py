"""Evaluate a record: subtract zero, tilt, drift and compliance, and reject bad cycles.

A valid cycle has a retraction that ends free of contact, a pull-off above the noise with more
than one point, no force at the end of the sensor's range, and a zero more certain than the
pull-off. Each rejection states the failed criterion with numbers.

Of many files those that cannot be read are listed with the reason.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from os import fspath
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import celsius
from viscotack.units import readable

from .baseline import (
    Baseline,
    Contact,
    Extremum,
    baseline,
    contact_of,
    extremum,
    point_noise,
    rounding,
    straight,
    without_spikes,
)
from .reading import AnyPath, groups, read
from .record import Cycle, Measured, Segments, TackRecord, depth_of, force_sign, segments

_POINTS = 20  # smallest number of points of a retraction
_FREE = 8  # smallest number of points out of contact at its end
_KEPT = 0.95  # fraction of the free points in use: the rig may oscillate right after a jump
_LEAST = 3e-5  # smallest noise relative to the range of force
_ABOVE = 5.0  # pull-off over standard deviation of the noise, at least
_ZERO = 0.25  # relative to the pull-off: largest uncertainty of the zero
_LONE = 0.5  # relative to the pull-off: a point this far beyond both neighbours is a spike
_CLIPPED = 8  # equal extreme values in a row while the drive moves ...
_ROUNDED = 8.0  # digits by which a rounded extreme changes as far again from it
_MOVED = 0.002  # ... by more than this fraction of its travel
_OUT = 5.0  # standard deviations of the noise that it may reverse in addition
_HELD = 0.2  # share of the pull-off force that a tension behind it has at least
_LASTING = 10.0  # travel of this tension over that to the pull-off above which fibrils hold
_STEADY = 3.0  # K: a larger change within a cycle is noted
_SLIDING = 0.1  # fraction of the travel by which the corrected depth may reverse


class Refusal(NamedTuple):
    """A rejected cycle and the reason."""

    number: int
    reason: str


@dataclass(frozen=True, eq=False)
class Evaluation:
    """The cycles of one record, and the rejected ones."""

    record: TackRecord
    cycles: tuple[Cycle, ...]
    refused: tuple[Refusal, ...]


def evaluate(
    record: TackRecord,
    *,
    compliance: float | None = None,
    compliance_uncertainty: float = 0.0,
    into: int = 0,
    compression: int = 0,
    retraction_only: bool = False,
) -> Evaluation:
    """Evaluate the cycles of a record.

    Parameters
    ----------
    record : TackRecord
        Record from :func:`viscotack.lab.tack.read`.
    compliance : float, optional
        Compliance of frame, load cell and holder [m/N]: motion of the drive per newton at a
        rigid contact. By default the value stated in the file, or 0.
    compliance_uncertainty : float
        Standard uncertainty of the compliance [m/N].
    into : {1, -1, 0}
        Whether larger positions are deeper (1) or shallower (-1); 0 detects it from heading or
        signal.
    compression : {1, -1, 0}
        Sign of compression in the file; 0 detects it from the signal.
    retraction_only : bool
        Accept cycles whose approach does not begin free of contact: then the zero of the force
        follows from the points after pull-off only, and depth is zero where the retraction's force
        is zero.

    Returns
    -------
    Evaluation

    Raises
    ------
    ValueError
        If there is no retraction, or a sign cannot be determined.
    """
    rig = record.compliance if compliance is None else compliance, compliance_uncertainty
    for name, value in zip(("compliance", "compliance_uncertainty"), rig, strict=True):
        if not 0 <= value < np.inf:
            raise InputError(f"{name} must not be negative, got {value!r} m/N")
    try:
        if len(record) < _POINTS:
            raise InputError(f"the record has {len(record)} points; a test needs {_POINTS}")
        drive = depth_of(record, into)
        found = segments(record.time, drive)
        sign = force_sign(without_spikes(record.force, point_noise(record.force)), found)
        if compression and compression != sign:
            raise InputError("the retraction shows the other sign; correct `compression`")
    except InputError as error:
        path = record.source.path
        raise InputError(f"{path}: {error}" if path else str(error)) from None
    cycles, refused = [], []
    for number, part in enumerate(found, start=1):
        try:
            signal = record.time, drive, sign * record.force
            cycles.append(_cycle(record, part, number, signal, rig, retraction_only))
        except InputError as error:
            refused.append(Refusal(number, str(error)))
    return Evaluation(record, tuple(cycles), tuple(refused))


def _cycle(
    record: TackRecord,
    part: Segments,
    number: int,
    signal: tuple[Array, Array, Array],
    rig: tuple[float, float],
    retraction_only: bool,
) -> Cycle:
    """Evaluate one cycle from time, depth and force, with the compliance of the rig."""
    compliance, compliance_uncertainty = rig
    span = slice(part.begin, part.end)
    own = Segments(0, part.dwell - part.begin, part.retract - part.begin, part.end - part.begin)
    time, way, raw = (row[span] for row in signal)
    back = slice(own.retract, own.end)
    if own.end - own.retract < _POINTS:
        points = own.end - own.retract
        raise InputError(f"{points} points in the retraction, fewer than {_POINTS}; record faster")
    # 0 is replaced by a small fraction of the range
    noise = max(point_noise(raw[back]), rounding(raw), _LEAST * float(np.ptp(raw)), 1e-300)
    clean = without_spikes(raw, noise)
    law, touch, leaves = _zero(time, way, clean, own, noise)
    if not (touch or retraction_only):
        raise InputError("no approach free of contact: give the whole test, or `retraction_only`")
    zeros = law.at(way, time)
    force = clean - zeros
    _refuse_clipped(raw[back], force[back], way[back], law.noise)
    _refuse_lone(raw[back] - zeros[back])
    lowest = own.retract + int(np.argmin(force[back]))
    zero = law.uncertainty(way[lowest], time[lowest])
    noise = max(law.noise, _LEAST * float(np.ptp(raw)))
    least = _least(force[back], lowest - own.retract, noise, zero)
    at = own.retract + int(least.at)
    depth = way - compliance * force
    _refuse_compliance(depth[back], way[back], compliance, law.noise)
    notes = [
        f"subtracted from the force: zero {readable(float(zeros[-1]), 'N')} at the end of the test,"
        f" which changed by {readable(float(np.ptp(zeros)), 'N')} during it"
    ]
    if np.any(clean != raw):
        notes.append(f"spikes replaced by the mean of their neighbours: {np.sum(clean != raw)}")
    origin, spread, how = _origin(depth, force, own, touch, law.noise)
    depth = depth - origin
    if touch:
        first = slice(touch.free, touch.free + 1)
        unsure = law.uncertainty(way[first], time[first])
        deep, pressed = float(depth[own.dwell]), float(force[own.dwell])
        if deep > 0 and pressed > 0:
            # shift at which a flank of Hertz exceeds the uncertainty of the zero
            spread = float(np.hypot(spread, deep * min(unsure / pressed, 1.0) ** (2 / 3)))
    notes.append(how)
    if compliance:
        notes.append(f"machine compliance {readable(compliance, 'm/N')} subtracted from the depth")
    # last point in compression before pull-off, or the start of the retraction
    pressed = np.flatnonzero(force[own.retract : at] >= 0)
    crossing = own.retract + (int(pressed[-1]) if pressed.size else 0)
    # at the smallest force the depth goes as the drive; single depths have the noise of the force,
    # and a soft machine may jump behind it
    index = np.arange(way.size) - own.retract
    last = float(np.interp(least.at, index, way)) - compliance * least.value - origin
    flat = least.at_uncertainty * abs(float(way[at + 1] - way[at - 1])) / 2
    place = float(np.hypot(np.hypot(spread, flat), compliance_uncertainty * abs(force[at])))
    deepest = force[: own.retract + 1]
    top = int(np.argmax(deepest))
    noise = float(np.hypot(law.noise, law.uncertainty(way[top], time[top])))
    unsure = float(np.hypot(spread, compliance_uncertainty * abs(force[own.retract])))
    speed = _speed(time, way, crossing, at)
    if speed.uncertainty >= speed.value:
        both = (readable(v, "m/s", digits=2) for v in (speed.value, speed.uncertainty))
        raise InputError(f"the speed is uncertain, {' +- '.join(both)}: uneven, or too few points")
    curve, softness = (time, way, depth, force), compliance_uncertainty
    quarter = slice(own.dwell // 4, 3 * own.dwell // 4 + 1)
    size = record.contact_radius
    temperature, changes = _temperature(record, span)
    return Cycle(
        number=number,
        time=time,
        force=force,
        depth=depth,
        contact_radius=None if size is None else size[span],
        segments=own,
        pull_off_force=Measured(-least.value, float(np.hypot(least.uncertainty, zero))),
        pull_off_raw=-float(raw[lowest]),
        pull_off_at=at,
        depth_at_pull_off=Measured(last, place),
        work_to_pull_off=_work(law, curve, (crossing, at), softness, Measured(last, flat)),
        work_of_separation=_work(law, curve, (crossing, own.end - leaves.free), softness),
        preload=Measured(float(deepest[top]), noise),
        preload_depth=Measured(float(depth[own.retract]), unsure),
        dwell_time=float(time[own.retract] - time[own.dwell]),
        speed=speed,
        mean_speed=_speed(time, way, own.retract, own.end - 1),
        approach_speed=None if own.dwell < 4 else _slope(time[quarter], way[quarter]),
        noise=law.noise,
        source=record.source.noted(*notes, *changes),
        temperature=temperature,
        compliance=compliance,
        cautions=_fibrils(force, way, crossing, at, own.end),
    )


def _fibrils(force: Array, way: Array, crossing: int, at: int, end: int) -> tuple[str, ...]:
    """Return a caution if a tension lasts far behind the pull-off.

    An elastic sphere (JKR) separates within 0.31 of the travel from zero force to the pull-off, and
    a rigid one with Lennard-Jones forces is at a fifth of the peak within 7.5 of it.
    """
    behind = -force[at:end]
    held = np.flatnonzero(behind >= _HELD * behind[0])[-1]
    travel, tail = abs(way[at] - way[crossing]), abs(way[at + held] - way[at])
    if tail <= _LASTING * travel or np.median(behind[: held + 1]) < _HELD * behind[0]:
        return ()
    return (
        f"a tension lasts for {readable(tail, 'm', digits=2)} behind the pull-off, "
        f"{tail / max(travel, 1e-300):.2g} times the travel to it: fibrils or cavities, for which "
        "no theory here holds; do not identify an interface from it",
    )


def _temperature(record: TackRecord, span: slice) -> tuple[float | None, tuple[str, ...]]:
    """Return the mean temperature of a cycle [K], if known, and a note where it changes."""
    rows = np.empty(0) if record.temperature is None else record.temperature[span]
    rows = rows[np.isfinite(rows)]
    if not rows.size:
        return None, ()
    low, high = float(rows.min()), float(rows.max())
    change = f"the temperature changes from {celsius(low)} to {celsius(high)} during the cycle"
    return float(rows.mean()), (change,) if high - low > _STEADY else ()


def _refuse_clipped(raw: Array, force: Array, way: Array, noise: float) -> None:
    """Raise an error if the force stays at an extreme while the drive moves.

    A few digits around a flat extreme are no saturation: as far again from it, the force of a
    parabola that is rounded by a digit at most has changed by eight of them.
    """
    digit = rounding(raw) * np.sqrt(12)
    for word, value in (("tension", raw.min()), ("compression", raw.max())):
        equal = np.flatnonzero(raw == value)
        runs = np.split(equal, np.flatnonzero(np.diff(equal) > 1) + 1)
        longest = max(runs, key=len)
        moved = abs(way[longest[-1]] - way[longest[0]])
        away = abs(force[longest[0]]) > _ABOVE * noise
        ends = longest[0] - len(longest), longest[-1] + len(longest)
        beside = raw[np.clip(ends, 0, raw.size - 1)]
        rounded = np.min(np.abs(beside - value)) <= _ROUNDED * digit
        clipped = len(longest) >= _CLIPPED and not rounded
        if clipped and moved > _MOVED * np.ptp(way) and away:
            stays = f"{len(longest)} points at {readable(value, 'N', digits=6)}, its largest {word}"
            raise InputError(f"the force stays for {stays}: the sensor is saturated")


def _refuse_lone(force: Array) -> None:
    """Raise an error if the smallest force is a single point."""
    at = int(np.clip(np.argmin(force), 1, force.size - 2))
    value, before, behind = (-float(one) for one in force[[at, at - 1, at + 1]])
    if max(before, behind) < (1 - _LONE) * value:
        beside = _force(max(before, behind))
        raise InputError(f"the pull-off of {_force(value)} is a single point beside {beside}")


def _zero(
    time: Array, way: Array, clean: Array, own: Segments, noise: float
) -> tuple[Baseline, Contact | None, Contact]:
    """Return the baseline of the force, and the first contact, if any, and the last one."""
    clock = (time - time[0]) / max(float(np.ptp(time)), 1e-300)
    back, down = slice(own.retract, own.end), slice(own.dwell)
    outer, far = clean[back][::-1], way[back][::-1]
    outwards = contact_of(outer, far, clock[back][::-1], noise, 0.3)
    least = int(np.argmin((outer - straight(outer, far, noise))[::-1]))
    most = own.end - own.retract - least - 1
    if outwards is None or min(outwards.free, most) < _FREE:
        raise InputError(
            "the force does not settle after the pull-off: retract until free of contact"
        )
    inwards = contact_of(clean[down], way[down], clock[down], noise, 0.5)
    free = [slice(own.end - int(_KEPT * min(outwards.free, most)), own.end)]
    if inwards is not None:
        free.insert(0, slice(int(_KEPT * inwards.free)))
    halves = [slice((free[-1].start + own.end) // 2, own.end)]
    if inwards is not None:
        halves.insert(0, slice(free[0].stop // 2))
    law, outermost = (baseline(clean, way, time, parts, noise) for parts in (free, halves))
    lowest = own.retract + least
    law = law.doubted(outermost, float(way[lowest]), float(time[lowest]))
    # a signal without noise still has whole digits
    return replace(law, noise=max(law.noise, rounding(clean))), inwards, outwards


def _least(force: Array, at: int, noise: float, zero: float) -> Extremum:
    """Return the smallest force of the retraction; raise an error if it is no pull-off."""
    value = -float(force[at])
    if value <= _ABOVE * noise:
        raise InputError(f"no pull-off above the noise: {_force(value)} over {_force(noise)}")
    if at <= 1:
        raise InputError("the force is smallest at the start of the retraction: no pull-off")
    if zero > _ZERO * value:
        off = f"uncertain by {_force(zero)}, at a pull-off of {_force(value)}"
        raise InputError(f"the force zero is {off}: tilt or drift")
    found = extremum(force, at, noise)
    if np.hypot(found.uncertainty, zero) > _ZERO * value:
        off = f"uncertain by {_force(found.uncertainty)}"
        raise InputError(f"the pull-off of {_force(value)} is {off}: too few points near it")
    return found


def _force(value: float) -> str:
    return readable(value, "N", digits=3)


def _refuse_compliance(depth: Array, way: Array, compliance: float, noise: float) -> None:
    """Raise an error if the compliance makes the depth increase while the drive retracts."""
    rise = np.max(depth - np.minimum.accumulate(depth))
    if compliance and rise > _SLIDING * np.ptp(way) + _OUT * compliance * noise:
        much = readable(compliance, "m/N")
        raise InputError(f"a compliance of {much} is too large: the depth rises in the retraction")


def _origin(
    depth: Array, force: Array, own: Segments, touch: Contact | None, noise: float
) -> tuple[float, float, str]:
    """Return the depth of first contact, its uncertainty, and the method in words."""
    if touch:
        return touch.depth, touch.uncertainty, "depth is zero at the first contact of the approach"
    back = slice(own.retract, own.end)
    at = own.retract + int(np.argmax(force[back] < 0))
    slope = abs(float(force[at] - force[max(at - 5, 0)]))
    step = abs(float(depth[at] - depth[max(at - 5, 0)]))
    spread = step * min(noise / slope, 1.0) if slope else step
    return (
        float(depth[at]),
        spread + step / 5,
        "no approach before contact: depth is zero where the retraction's force is zero",
    )


def _work(
    law: Baseline,
    curve: tuple[Array, Array, Array, Array],
    ends: tuple[int, int],
    compliance_uncertainty: float,
    stop: Measured | None = None,
) -> Measured:
    """Integrate -force d(depth) between two points, or to a depth near the second [J]."""
    time, way, d, F = (row[ends[0] : ends[1] + 1] for row in curve)
    # weights of the trapezoidal rule
    weights = (np.diff(d, append=d[-1]) + np.diff(d, prepend=d[0])) / 2
    stop = stop or Measured(float(d[-1]), 0.0)
    parts = (
        law.noise * float(np.sqrt(np.sum(weights**2))),
        law.uncertainty(way, time, weights),
        # a compliance c adds c F dF, integrated analytically
        compliance_uncertainty * float(abs(F[-1] ** 2 - F[0] ** 2)) / 2,
        # end of the integral
        stop.uncertainty * float(abs(F[-1])),
    )
    value = float(weights @ F + F[-1] * (stop.value - d[-1]))
    return Measured(value, float(np.sqrt(sum(part**2 for part in parts))))


def _speed(time: Array, way: Array, begin: int, end: int) -> Measured:
    """Return the slope of depth over time [m/s] by a linear fit, and its unevenness."""
    # extend a short interval on both sides beyond the steps of the drive
    while end - begin < 6 and (begin > 0 or end < time.size - 1):
        begin, end = max(begin - 1, 0), min(end + 1, time.size - 1)
    t, x = time[begin : end + 1], -way[begin : end + 1]
    if np.ptp(t) <= 0:
        raise InputError("time does not advance in the retraction, so the speed is undetermined")
    whole = _slope(t, x)
    middle = t.size // 2
    halves = [_slope(t[part], x[part]) for part in (slice(0, middle + 1), slice(middle, None))]
    rest = x - (x.mean() + whole * (t - t.mean()))
    by_line = float(np.sqrt(np.mean(rest**2) / max(t.size - 2, 1)) / max(np.std(t), 1e-300))
    return Measured(whole, float(np.hypot(by_line, abs(halves[1] - halves[0]) / np.sqrt(12))))


def _slope(t: Array, x: Array) -> float:
    u = t - t.mean()
    return float(u @ x / max(u @ u, 1e-300))


class Unread(NamedTuple):
    """An unreadable file (or the first file of a test), and the reason."""

    path: str
    reason: str


@dataclass(frozen=True, eq=False)
class Survey:
    """Evaluated records of many files, and the unreadable files."""

    evaluations: tuple[Evaluation, ...]
    unread: tuple[Unread, ...]

    @property
    def cycles(self) -> tuple[Cycle, ...]:
        """All evaluated cycles."""
        return tuple(cycle for one in self.evaluations for cycle in one.cycles)

    @property
    def cautions(self) -> tuple[tuple[str, str], ...]:
        """File and caution of every cycle whose signal contradicts the theories."""
        return tuple(
            (one.source.path, f"cycle {one.number}: {said}")
            for one in self.cycles
            for said in one.cautions
        )

    @property
    def reasons(self) -> tuple[tuple[str, str], ...]:
        """File and reason of every rejected file and cycle."""
        found = [(path, reason.removeprefix(f"{path}: ")) for path, reason in self.unread]
        for one in self.evaluations:
            path = one.record.source.path
            found += [(path, f"cycle {number}: {reason}") for number, reason in one.refused]
        return tuple(found)


def survey(
    paths: Sequence[AnyPath],
    *,
    reading: Mapping[str, Any] | None = None,
    evaluation: Mapping[str, Any] | None = None,
) -> Survey:
    """Evaluate files of tack tests; an unreadable file does not stop the others.

    Parameters
    ----------
    paths : sequence of path-like
        Files, or folders, of which all files are read but hidden ones and those in folders
        inside; intervals of one test are joined as in :func:`read`.
    reading, evaluation : mapping, optional
        Keyword arguments of :func:`read` and :func:`evaluate`.

    Raises
    ------
    OSError
        If a file cannot be opened.
    ValueError
        If a folder contains no file.
    """
    found: list[Evaluation] = []
    unread: list[Unread] = []
    for group in groups([file for path in paths for file in _files(path)]):
        try:
            records = read(group, **(reading or {}))
        except InputError as error:
            unread.append(Unread(fspath(group[0]), str(error)))
            continue
        for record in records:
            try:
                found.append(evaluate(record, **(evaluation or {})))
            except InputError as error:
                unread.append(Unread(record.source.path, str(error)))
    return Survey(tuple(found), tuple(unread))


def _files(path: AnyPath) -> list[AnyPath]:
    """Return the visible files of a folder by name; a file itself."""
    if not Path(path).is_dir():
        return [path]
    inside = sorted(Path(path).iterdir())
    found: list[AnyPath] = [x for x in inside if x.is_file() and not x.name.startswith(".")]
    if not found:
        raise InputError(f"{path}: the folder contains no file")
    return found
