"""Answers of a tier as numbers and series, and the comparison of two of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack import CrackContact, InputError, Outcome, Result, crack_contact, solve, summary
from viscotack.methods.by_crack import summary as crack_summary
from viscotack.result.loops import Loop, loop_of, lost_in, returned
from viscotack.result.parts import Span, spans

from .cases import Case

Array = npt.NDArray[np.float64]

# Of the checks: a tenth of a second a simulation, and errors that a comparison can see through.
ACCURACY = 0.01
# A simulation that takes longer than this [s] is not judged.
TIME_LIMIT = 10.0
# Numbers with the error of the force; the others are compared within the valley of the force.
_FORCES = ("pull_off_force", "pull_off_stress")
_WORKS = ("work_to_pull_off", "work_of_separation", "hysteresis")
_SERIES = ("depth", "force", "contact_radius")
_OF_EDGE = ("crack_speed_at_pull_off", "contact_radius_at_pull_off", "ligament_at_pull_off")
# A word that a tolerance decides is in doubt up to this factor from the tolerance.
_DOUBT = 3.0
# Forces of surfaces that never come near each other are far tails, or round-off.
_FAINT = 1e-3
# Of a history of twenty thousand steps so many points are compared.
_MOST_POINTS = 500
# Work has up to five times the error of the force (`solve`), series follow within three times.
_WORK, _CURVE = 5.0, 3.0
_SI_TAILS = ("_N", "_J", "_m", "_Pa", "_s", "_m_per_s", "_J_per_m2")


class Unjudged(Exception):
    """The case cannot be judged: refused by the package, or too long."""


class TooLong(Unjudged):
    """The simulation was not done within `TIME_LIMIT`, which depends on the load of the machine."""


@dataclass(frozen=True)
class Answer:
    """What a tier returns for a case; dimensionless.

    Attributes
    ----------
    numbers : mapping
        Observables and numbers of cycles by name; None where there is none.
    spread : mapping
        By how much each may differ for a relative error of the force of 1, beside `floor`.
    floor : mapping
        By how much each may differ in any case.
    series : mapping
        Time, depth, force and radius, and the number of the move.
    error : float
        Relative error of the force.
    words : mapping
        Words by name: those that the tolerance behind each could choose.
    """

    numbers: Mapping[str, float | None]
    spread: Mapping[str, float]
    floor: Mapping[str, float]
    series: Mapping[str, Array]
    error: float
    result: Any = field(default=None, repr=False)
    words: Mapping[str, frozenset[str]] = field(default_factory=dict)


def by_simulation(case: Any, *, estimate: bool = False, **options: Any) -> Answer:
    """Return the answer of ``solve``."""
    options = {"accuracy": ACCURACY} | options
    result = solved(case, estimate_error=estimate, **options)
    error = (result.error_estimate or {}).get("force", options["accuracy"])
    return of_result(result, max(error, options["accuracy"]))


def solved(case: Any, **options: Any) -> Result:
    """Return the result of ``solve``; Unjudged where it is refused, stopped or too long."""
    options = {"accuracy": ACCURACY, "estimate_error": False} | options
    try:
        result = solve(case, throw=False, time_limit=TIME_LIMIT, **options)
    except InputError as error:
        raise _unjudged(f"refused: {error}") from None
    if result.outcome is Outcome.STOPPED:
        raise _unjudged(result.status)
    return result


def _unjudged(why: str) -> Unjudged:
    return (TooLong if "the time limit of" in why else Unjudged)(why)


def by_crack(case: Any) -> Answer:
    """Return the answer of the contact whose edge is a steady crack."""
    try:
        found = crack_contact(case)
    except InputError as error:
        raise Unjudged(f"refused: {error}") from None
    return of_crack(found)


def of_crack(found: CrackContact) -> Answer:
    """Return the answer of the contact with a steady crack; its steps are of first order."""
    numbers = {n: v for n, v in crack_summary(found).items() if isinstance(v, float)}
    numbers = {n: v for n, v in numbers.items() if n not in ("band", "zones")}
    closes = {f: returned(found.depth, f * 1e-3) for f in (1 / _DOUBT, _DOUBT)}
    doubtful = found.loop is not Loop.APART and len(set(closes.values())) > 1
    loops = {found.loop, Loop.OPEN, Loop.DEPTH} if doubtful else {found.loop}
    return _answer(numbers, found, ACCURACY, {"loop": frozenset(map(str, loops))})


def of_result(result: Result, error: float) -> Answer:
    """Return a result as an answer."""
    said = summary(result)
    inputs = result.groups.inputs
    numbers = {
        name: said[name]
        for name in result.problem.outputs.observables
        if name not in inputs and not isinstance(said[name], str)
    }
    for row in said["cycles"]:
        kept = {n: v for n, v in row.items() if n not in ("cycle", "loop", "hysteresis_error")}
        numbers |= {f"cycle {row['cycle']} {n}": v for n, v in kept.items()}
    numbers = {n: v for n, v in numbers.items() if not n.endswith(_SI_TAILS)}
    words = {f"cycle {i} loop": loops_of(result, span) for i, span in enumerate(spans(result), 1)}
    return _answer(numbers, result, error, words)


def loops_of(result: Result, span: Span) -> frozenset[str]:
    """Return the words for the loop of a cycle at a third of its tolerances, and at three times."""
    within = max(1e-3, result.accuracy or 0.0)
    loops = {
        loop_of(replace(result, accuracy=within * factor), span)
        for factor in (1 / _DOUBT, 1.0, _DOUBT)
    }
    energy = result.energy
    if loops & {Loop.CLOSED, Loop.DEPTH} and energy is not None:
        stored = energy.elastic + energy.interface
        left = abs(float(stored[span.last] - stored[span.first]))
        lost = abs(lost_in(result, span, Loop.CLOSED))
        if 0.02 / _DOUBT * lost < left < 0.02 * _DOUBT * lost:
            loops |= {Loop.CLOSED, Loop.DEPTH}
    return frozenset(map(str, loops))


def _answer(
    numbers: Mapping[str, float | None],
    found: Any,
    error: float,
    words: Mapping[str, frozenset[str]],
) -> Answer:
    """Return an answer with what each of its numbers may differ by."""
    spread, floor = {}, {}
    for name, value in numbers.items():
        if value is not None:
            spread[name], floor[name] = _allowed(name, value, found, error)
    series = {n: np.asarray(getattr(found, n)) for n in ("time", "move", *_SERIES)}
    return Answer(numbers, spread, floor, series, error, found, words)


def _allowed(name: str, value: float, found: Any, error: float) -> tuple[float, float]:
    """Return what a number may differ by, for an error of the force of 1 and in any case.

    The place of a flat minimum is known within the valley in which the force is the minimum up to
    its error: depth, radius, speed and work of the pull-off may differ by the width of the valley.
    """
    key = name.split()[-1]
    gross = float(np.abs(np.diff(found.depth)) @ np.abs(found.force[1:] + found.force[:-1]) / 2)
    if key.endswith(_FORCES) or "force" in key or "stress" in key:
        return max(abs(value), 0.1), 0.0
    if key in _WORKS:
        # the unit of work of a punch is not that of its series
        unit = found.problem.outputs.energy_factor(found.problem.groups())
        valley = _valley(found, error)
        wide = float(np.ptp(found.depth[valley]) * np.max(np.abs(found.force[valley]))) * unit
        return _WORK * max(abs(value), gross * unit if key == "hysteresis" else 0.0), wide
    if key in ("begin", "end", "time_to_detachment", "time_at_pull_off"):
        # a creeping edge lets go at a time that depends on the force by a high power
        valley = _valley(found, error)
        return 20 * abs(value), float(np.ptp(found.time[valley]))
    if key == "effective_surface_energy":
        return 4 * abs(value), 4 * abs(value) * error
    source = "depth" if "depth" in key else "edge_speed" if "speed" in key else "contact_radius"
    values = getattr(found, source)
    if key == "snap_in_depth":
        return 5 * float(np.ptp(found.depth)), 2 * float(np.max(np.abs(np.diff(found.depth))))
    known = values[_valley(found, error)]
    known = known[np.isfinite(known)]
    wide = float(np.ptp(known)) if known.size else np.inf
    scale = float(np.nanmax(np.abs(known))) if known.size else 1.0
    if source == "edge_speed":  # of a punch in another unit than the series
        wide *= abs(value) / max(scale, 1e-300)
        return 10 * abs(value), 2 * wide
    return (1.0 + _CURVE) * max(abs(value), scale * 0.1), wide


def _valley(found: Any, error: float) -> Array:
    """Return the steps in which the force is the least of its opening, up to three errors."""
    part = spans(found)[-1] if isinstance(found, Result) else None
    first = 0 if part is None else part.turn
    force = found.force[first:]
    low = first + int(np.argmin(force))
    # also of a contact that is pushed throughout
    near = np.flatnonzero(force <= found.force[low] + 3 * error * abs(found.force[low])) + first
    return np.arange(max(near.min() - 1, 0), min(near.max() + 2, len(found.force)))


def differences(one: Answer, other: Answer, *, factor: float = 1.0) -> list[str]:
    """Return what differs between two answers by more than both their errors, in words."""
    error = factor * (one.error + other.error)
    found = [
        f"{name} {'/'.join(sorted(one.words[name]))} and {'/'.join(sorted(other.words[name]))}"
        for name in sorted(set(one.words) & set(other.words))
        if not one.words[name] & other.words[name]
    ]
    for name in sorted(set(one.numbers) | set(other.numbers)):
        a, b = one.numbers.get(name), other.numbers.get(name)
        if a is None and b is None:
            continue
        if (a is None or b is None) and name in _OF_EDGE:
            continue  # an edge may be gone a step before the pull-off, or a step after it
        if (a is None or b is None) and name.endswith("hysteresis") and _doubted(name, one, other):
            continue
        if a is None or b is None:
            found.append(f"{name} {_text(a)} and {_text(b)}")
            continue
        spread = max(one.spread[name], other.spread[name])
        allowed = spread * error + factor * max(one.floor[name], other.floor[name])
        if not abs(a - b) <= allowed:
            found.append(f"{name} {a:.6g} and {b:.6g}, allowed {allowed:.2g}")
    return found + curves_apart(one, other, _CURVE * error)


def _doubted(name: str, one: Answer, other: Answer) -> bool:
    """Return whether a tolerance could leave the loop of a hysteresis open."""
    loop = name.removesuffix("hysteresis") + "loop"
    return any(str(Loop.OPEN) in found.words.get(loop, ()) for found in (one, other)) and any(
        len(found.words.get(loop, ())) > 1 for found in (one, other)
    )


def curves_apart(one: Answer, other: Answer, allowed: float) -> list[str]:
    """Return which series of two answers lie apart in the plane of time and value."""
    found = []
    for name in _SERIES:
        apart = max(_apart(one.series, other.series, name), _apart(other.series, one.series, name))
        if apart > allowed:
            found.append(f"series {name} apart by {apart:.2g} of its range, allowed {allowed:.2g}")
    return found


def _apart(one: Mapping[str, Array], other: Mapping[str, Array], name: str) -> float:
    """Return how far points of a curve lie from another curve, in parts of the ranges.

    Each move is a curve of its own, over its own duration: histories have fast and slow parts.
    """
    values = np.concatenate([one[name], other[name]])
    known = values[np.isfinite(values)]
    scale = float(np.ptp(known)) if known.size else 0.0
    if scale <= 1e-9 * max(float(np.max(np.abs(known), initial=0.0)), 1e-300):
        return 0.0
    if name == "force" and scale < _FAINT:
        return 0.0
    worst = 0.0
    shared = sorted(set(one["move"].tolist()) & set(other["move"].tolist()))
    for move in shared:
        a, b = _part(one, name, move), _part(other, name, move)
        if move == shared[-1]:
            # a run may end a little sooner than another: compare what both have
            until = min(a[-1, 0], b[-1, 0])
            a, b = a[a[:, 0] <= until], b[b[:, 0] <= until + np.ptp(b[:, 0]) * 0.2]
        long = float(np.ptp(b[:, 0])) if len(b) else 0.0
        if long <= 1e-9 * float(np.ptp(other["time"])):
            continue  # a move that has nothing to do
        a, b = a[np.isfinite(a[:, 1])], b[np.isfinite(b[:, 1])]
        if name == "contact_radius":
            a = a[:-3]  # where an edge vanishes it runs faster than steps tell
        if len(a) == 0 or len(b) < 2:
            continue
        unit = np.array([long, scale])
        worst = max(worst, float(np.max(_distance(a / unit, b / unit))))
    return worst


def _part(series: Mapping[str, Array], name: str, move: int) -> Array:
    steps = np.flatnonzero(series["move"] == move)
    steps = np.arange(max(steps[0] - 1, 0), steps[-1] + 1)
    time = series["time"][steps]
    return np.column_stack([time - time[0], series[name][steps]])


def _distance(points: Array, line: Array) -> Array:
    """Return how far points are from a polyline, of many points every so many."""
    begin, way = line[:-1], np.diff(line, axis=0)
    length = np.maximum(np.sum(way**2, axis=1), 1e-300)
    some = points[:: 1 + len(points) // _MOST_POINTS]

    def nearest(point: Array) -> float:
        to = point - begin
        share = np.clip(np.sum(to * way, axis=1) / length, 0, 1)
        return float(np.min(np.sum((to - share[:, None] * way) ** 2, axis=1)))

    return np.sqrt([nearest(point) for point in some])


def _text(value: float | None) -> str:
    return "none" if value is None else f"{value:.6g}"


def compared(case: Case, partner: Any, *, crack: bool = False, factor: float = 1.0) -> list[str]:
    """Return what differs between the answers of two cases that must agree.

    What seems to differ at first is judged again with the errors that the simulation states.
    """
    if crack:
        return differences(by_crack(case), by_crack(partner), factor=factor)
    found = differences(by_simulation(case), _partner(partner), factor=factor)
    if not found:
        return []
    one = by_simulation(case, estimate=True)
    return differences(one, _partner(partner, estimate=True), factor=factor)


def _partner(case: Any, **options: Any) -> Answer:
    """Return the answer for the partner; that it is refused alone is a difference.

    That it takes too long is none: a run at the limit is stopped now and then.
    """
    try:
        return by_simulation(case, **options)
    except TooLong:
        raise
    except Unjudged as why:
        raise Broken(f"the partner {case!r} has no answer: {why}") from None


class Broken(Exception):
    """A relation does not hold, in words."""
