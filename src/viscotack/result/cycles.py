r"""Cycles of a test: snap-in, peak compression, pull-off, work and hysteresis of each.

**Hysteresis.** The work at the indenter over a closed loop,

.. math:: H = \oint F \, d\delta = \Delta W - \Delta U_K,

is the work of the drive minus the change of the energy in the machine's spring. If a cycle
begins and ends with the surfaces apart, they still attract each other across a finite gap, and the
change of that energy is not dissipated,

.. math:: H = \Delta W - \Delta U_K - \Delta U_I.

Elastic energy left in the modes of the solid dissipates later and counts as lost.
"""

from contextlib import suppress
from dataclasses import dataclass
from enum import StrEnum
from math import nan

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.text import write_table
from viscotack.files.whole import Target
from viscotack.result import Outcome, Result
from viscotack.result.opening import PullOff, pull_off_in, tension_work
from viscotack.result.parts import Span, move_numbers, moves_of, spans, touches, waits

# Tolerance for the return of depth and force, relative to their range, or the accuracy of the run
# if that is larger.
_RETURNED = 1e-3
# Tolerance for the return of the energy in the contact, relative to the hysteresis.
_SMALL = 0.02


class Loop(StrEnum):
    """State in which the loop of a cycle closed, see :func:`cycles`."""

    APART = "apart"
    """The surfaces are apart at its beginning and at its end."""
    CLOSED = "closed"
    """Depth and force return; for a viscoelastic solid also the energy stored in the contact."""
    DEPTH = "closed in depth only"
    """The depth returns, but the force or the stored energy does not, or is unknown."""
    OPEN = "open"
    """None of these: the hysteresis is undefined."""


def loop_of(result: Result, span: Span) -> Loop:
    """Return the state in which the loop of a cycle closed."""
    ends = [span.first, span.last]
    if not (span.closes and span.opens):
        return Loop.OPEN
    if touches(result, span) and not np.isfinite(result.contact_radius[ends]).any():
        return Loop.APART
    within = max(_RETURNED, result.accuracy or 0.0)
    if not returned(result.depth[span.states], within):
        return Loop.OPEN
    closed = returned(result.force[span.states], within) and _energy_returned(result, span)
    return Loop.CLOSED if closed else Loop.DEPTH


def lost_in(result: Result, span: Span, loop: Loop) -> float:
    """Return the hysteresis of a cycle with a given loop state [unit of work]; nan if open."""
    if loop is Loop.OPEN:
        return float("nan")
    energy = result.energy
    if energy is None:  # a contact whose edge is a steady crack has no forces across a gap
        return work_at_indenter(result.depth[span.states], result.force[span.states])
    indenter = energy.drive - energy.spring
    work = float(indenter[span.last] - indenter[span.first])
    if loop is Loop.APART:
        return work - float(energy.interface[span.last] - energy.interface[span.first])
    return work


def work_at_indenter(depth: npt.NDArray, force: npt.NDArray) -> float:
    """Integrate the force over the depth along a history."""
    return float(np.sum((force[1:] + force[:-1]) / 2 * np.diff(depth)))


def returned(values: npt.NDArray, within: float = _RETURNED) -> bool:
    """Return whether a series ends at its first value, within a fraction of its range."""
    return bool(abs(values[-1] - values[0]) <= within * np.ptp(values))


def _energy_returned(result: Result, span: Span) -> bool:
    """Return whether the energy stored in the contact returns; always true for elastic solids."""
    if result.groups.modulus_ratio >= 1:
        return True
    energy = result.energy
    if energy is None:
        return False
    stored = energy.elastic + energy.interface
    left = float(stored[span.last] - stored[span.first])
    return abs(left) <= _SMALL * abs(lost_in(result, span, Loop.CLOSED))


@dataclass(frozen=True)
class Cycle:
    """One cycle of closing and opening, from :func:`cycles`; dimensionless as in `Result`.

    The first cycle may begin in contact, and the last one may not open; a pure retraction is
    one cycle. Undefined numbers are nan.

    Attributes
    ----------
    begin, end : float
        Time at the beginning and at the end.
    snap_in_depth : float
        Depth at which contact is made, after the jump if there is one.
    snap_in_force : float
        Largest tension of the closing part after snap-in, positive; 0 without tension.
    peak_force : float
        Largest compression; 0 without compression.
    pull_off_force, depth_at_pull_off : float
        Force minimum of the opening part, as a positive number, and its depth.
    work_to_pull_off : float
        Integral of -force over depth, from the last zero crossing of the opening part to that
        minimum.
    hysteresis : float
        Loop integral of F d(indenter depth); for loops that begin and end apart, without the change
        of the interface energy across the gap. nan if the loop is open.
    hysteresis_error : float
        Estimated relative error of the hysteresis; nan if unknown.
    loop : Loop
        State in which the loop closed.
    time_to_detachment : float
        Time from the start of a force hold to detachment, see :func:`time_to_detachment`.
    """

    begin: float
    end: float
    snap_in_depth: float
    snap_in_force: float
    peak_force: float
    pull_off_force: float
    depth_at_pull_off: float
    work_to_pull_off: float
    hysteresis: float
    hysteresis_error: float
    loop: Loop
    time_to_detachment: float


def cycles(result: Result) -> tuple[Cycle, ...]:
    """Return the cycles of a test.

    A cycle begins where the machine reverses to close the contact again.

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    tuple of Cycle
        In order of time.

    Raises
    ------
    InputError
        If the run failed.

    Examples
    --------
    >>> from viscotack import Apart, AtDepth, Groups, StandardSolid, solve
    >>> from viscotack.model.protocol import Approach, Retract
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> tap = (Approach(5.0, AtDepth(3.0)), Retract(5.0, AtDepth(-20.0)))
    >>> groups = Groups(
    ...     tabor=2.0, material=solid.reduced(), start=Apart(20.0), rate=None, moves=2 * tap
    ... )
    >>> first, second = cycles(solve(groups, accuracy=0.01, estimate_error=False))
    >>> f"{first.pull_off_force:.2f} {second.pull_off_force:.2f}"
    '2.36 2.36'
    """
    if result.outcome is Outcome.STOPPED:
        raise InputError(f"the run failed and has no cycles: {result.status}")
    found, parts = [], spans(result)
    errors = result.hysteresis_errors or (nan,) * len(parts)
    energy = result.problem.outputs.energy_factor(result.groups)
    for span, at, error in zip(parts, pull_offs(result), errors, strict=True):
        # snap-in: the first state with an edge in the closing part
        edge = np.isfinite(result.contact_radius[span.closing])
        made = span.first + 1 + np.flatnonzero(edge[1:] & ~edge[:-1])
        after = result.force[made[0] : span.turn + 1] if made.size else None
        held = nan
        if span.last == len(result.time) - 1:  # a run ends when a held contact detaches
            with suppress(ValueError):
                held = time_held(result)
        loop = loop_of(result, span)
        found.append(
            Cycle(
                begin=float(result.time[span.first]),
                end=float(result.time[span.last]),
                snap_in_depth=nan if after is None else float(result.depth[made[0]]),
                snap_in_force=nan if after is None else max(-float(after.min()), 0.0),
                peak_force=max(float(result.force[span.states].max()), 0.0),
                pull_off_force=nan if at is None else at.force,
                depth_at_pull_off=nan if at is None else at.depth,
                work_to_pull_off=(
                    nan if at is None else energy * tension_work(result, span, at, until=-at.depth)
                ),
                hysteresis=energy * lost_in(result, span, loop),
                hysteresis_error=error,
                loop=loop,
                time_to_detachment=held,
            )
        )
    return tuple(found)


def pull_offs(result: Result) -> list[PullOff | None]:
    """Return the state at the pull-off of each cycle, or None."""
    found: list[PullOff | None] = []
    for span in spans(result):
        try:
            found.append(pull_off_in(result, span))
        except ValueError:
            found.append(None)
    return found


def cycle_rows(result: Result) -> list[dict[str, float | str | None]]:
    """Return the cycles as rows with the names and units of the geometry, and in SI if possible.

    Names and signs are those of :mod:`viscotack.model.problem.outputs`; undefined numbers are None.
    `loop` is one of the values of :class:`Loop`.
    """
    outputs, scales = result.problem.outputs.cycles, result.scales
    rows = []
    for number, cycle in enumerate(cycles(result), 1):
        values: dict[str, float | None] = {}
        for name, output in outputs.items():
            value = getattr(cycle, output.source) * output.factor(result.groups)
            values[name] = float(value) if np.isfinite(value) else None
        row: dict[str, float | str | None] = {"cycle": number, **values, "loop": str(cycle.loop)}
        if scales is not None:
            for name, output in outputs.items():
                if output.unit.scale:
                    value, scale = values[name], getattr(scales, output.unit.scale)
                    row[f"{name}_{output.unit.tail}"] = None if value is None else value * scale
        rows.append(row)
    return rows


def write_cycles(result: Result, path: Target) -> None:
    """Write `cycle_rows` as a comma-separated table, atomically; undefined numbers are empty.

    Parameters
    ----------
    result : Result
        Result of a simulation.
    path : path or binary file
        Output file.

    Raises
    ------
    InputError
        If the run failed.
    NotWritten
        If the file cannot be written; an existing file is then unchanged.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> import io
    >>> file = io.BytesIO()
    >>> write_cycles(result, file)
    >>> file.getvalue().decode().split(",")[:3]
    ['cycle', 'begin', 'end']
    """
    rows = cycle_rows(result)
    write_table({name: [row[name] for row in rows] for name in rows[0]}, path)


# For results without recorded moves: the hold begins where the force is within this fraction of the
# held force, relative to the held force and the unit of force.
_HELD = 1e-3


def time_to_detachment(result: Result) -> float:
    """Return the time from the start of a hold at constant force to detachment.

    Parameters
    ----------
    result : Result
        Test that ends with a ``Dwell(duration, hold="force")`` as its last move.

    Returns
    -------
    float
        Time to the jump out of contact: in seconds for a problem in SI, in the time unit for
        groups.

    Raises
    ------
    ValueError
        If the test ends otherwise, or the contact detached before the hold, or not at all.

    Notes
    -----
    A load below the elastic pull-off force is held for ever; one above the glassy pull-off force
    not at all. Between them the edge is a slow crack, and the time depends strongly on the load.

    Examples
    --------
    >>> from viscotack import AtForce, Groups, StandardSolid, solve
    >>> from viscotack.model.protocol import Dwell, LoadTo
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> hang = (LoadTo(force=-1.5, duration=1e-3), Dwell(duration=1e4, hold="force"))
    >>> groups = Groups(
    ...     tabor=2.0, material=solid.reduced(), start=AtForce(0.0), rate=None, moves=hang
    ... )
    >>> f"{time_to_detachment(solve(groups, estimate_error=False)):.1f} tau0"
    '11.6 tau0'
    """
    scales = result.scales
    return time_held(result) * (1.0 if scales is None else scales.time)


def time_held(result: Result) -> float:
    """Return the dimensionless time, in the time unit of the groups."""
    moves, number = moves_of(result), move_numbers(result)
    last, gone = int(number[-1]), result.outcome in (Outcome.JUMPED, Outcome.DETACHED)
    if not waits(moves[last], "force"):
        if gone and any(waits(move, "force") for move in moves[last:]):
            raise InputError(
                "the contact detached before the hold; reduce the force, or load more slowly"
            )
        raise InputError(
            "the test must end with a dwell at constant force: Dwell(duration, hold='force') as "
            "the last move, and no speed"
        )
    if not gone:
        raise InputError(
            f"the contact did not detach, and the run ended: {result.status}; dwell longer, or "
            "increase the tension above the elastic pull-off force"
        )
    if result.move is None:
        held = float(result.force[-1])
        before = np.flatnonzero(np.abs(result.force - held) > _HELD * (abs(held) + 1))
        begin = int(before[-1]) + 1 if before.size else 0
    else:
        begin = max(int(np.searchsorted(number, last)) - 1, 0)
    return float(result.time[-1] - result.time[begin])
