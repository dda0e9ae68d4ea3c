"""What each cycle of a test did: snap-in, peak compression, pull-off, work and hysteresis."""

import csv
import io
from dataclasses import dataclass

import numpy as np

from viscotack.errors import InputError
from viscotack.files.whole import Target, write_whole
from viscotack.renamed import Renamed

from . import Outcome, Result
from .dead_load import time_held
from .loops import Loop, loop_of, lost_in
from .opening import PullOff, pull_off_in, tension_work
from .parts import Span, spans


@dataclass(frozen=True)
class Cycle:
    """One cycle: the machine closes the contact and opens it; dimensionless as in `Result`.

    The first one may begin in contact, and the last one may not open; a test that only pulls is
    one cycle. nan is what a cycle has not.

    Attributes
    ----------
    begin, end : float
        When it begins and ends.
    snap_in_depth : float
        Depth at which contact is made: after the jump where there is one.
    snap_in_force : float
        Largest tension of the closing part from there on, a positive number; 0 where there is none.
    peak_force : float
        Peak compression, the largest force; 0 where nothing is pressed.
    pull_off_force, depth_at_pull_off : float
        Force minimum of the opening part, a positive number, and where.
    work_to_pull_off : float
        Integral of -force from the last zero crossing of the opening part to that minimum.
    hysteresis : float
        Loop integral of F d(indenter depth); from apart to apart without the change of the
        interface energy across the gap. nan where the loop is open.
    hysteresis_error : float
        Its estimated error, relative; nan where it is not known.
    loop : Loop
        In which state the loop closed.
    time_to_detachment : float
        How long the contact bore a held force before it let go, :mod:`.dead_load`.
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

    pull_off_depth = Renamed("depth_at_pull_off")


def cycles(result: Result) -> tuple[Cycle, ...]:
    """Return what each cycle of a test did.

    A cycle begins where the machine turns to close the contact again.

    Raises
    ------
    ValueError
        If the run stopped.

    Examples
    --------
    >>> from viscotack import Apart, AtDepth, Groups, StandardSolid, solve
    >>> from viscotack.protocol import Approach, Retract
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
    found = spans(result)
    errors = result.hysteresis_errors or (float("nan"),) * len(found)
    ends = zip(found, pull_offs(result), errors, strict=True)
    return tuple(_cycle(result, span, at, error) for span, at, error in ends)


def pull_offs(result: Result) -> list[PullOff | None]:
    """Return the state at the pull-off of each cycle, None where it has none."""
    found: list[PullOff | None] = []
    for span in spans(result):
        try:
            found.append(pull_off_in(result, span))
        except ValueError:
            found.append(None)
    return found


def cycle_rows(result: Result) -> list[dict[str, float | str | None]]:
    """Return the cycles with names and units of the geometry, in SI as well where the problem is.

    Names and signs are those of :mod:`viscotack.problem.outputs`; None is what a cycle has not.
    `loop` is one of the words of :class:`.loops.Loop`.
    """
    outputs, scales = result.problem.outputs.cycles, result.scales
    rows = []
    for number, cycle in enumerate(cycles(result), 1):
        values = {
            name: _known(getattr(cycle, output.source) * output.factor(result.groups))
            for name, output in outputs.items()
        }
        row: dict[str, float | str | None] = {"cycle": number, **values, "loop": str(cycle.loop)}
        if scales is not None:
            for name, output in outputs.items():
                if output.unit.scale:
                    value, scale = values[name], getattr(scales, output.unit.scale)
                    row[f"{name}_{output.unit.tail}"] = None if value is None else value * scale
        rows.append(row)
    return rows


def write_cycles(result: Result, path: Target) -> None:
    """Write `cycle_rows` as a comma-separated table, whole or not at all; empty is not known."""
    rows, text = cycle_rows(result), io.StringIO()
    table = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    write_whole(path, text.getvalue().encode())


def _known(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _cycle(result: Result, span: Span, found: PullOff | None, error: float) -> Cycle:
    depth, tension = _snap_in(result, span)
    none, loop = float("nan"), loop_of(result, span)
    return Cycle(
        begin=float(result.time[span.first]),
        end=float(result.time[span.last]),
        snap_in_depth=depth,
        snap_in_force=tension,
        peak_force=max(float(result.force[span.first : span.last + 1].max()), 0.0),
        pull_off_force=none if found is None else found.force,
        depth_at_pull_off=none if found is None else found.depth,
        work_to_pull_off=(
            none if found is None else tension_work(result, span, found, until=-found.depth)
        ),
        hysteresis=lost_in(result, span, loop),
        hysteresis_error=error,
        loop=loop,
        time_to_detachment=_time_held(result, span),
    )


def _snap_in(result: Result, span: Span) -> tuple[float, float]:
    """Return the depth at which contact is made in the closing part, and the tension it brings."""
    edge = np.isfinite(result.contact_radius[span.closing])
    made = np.flatnonzero(edge[1:] & ~edge[:-1])
    if not made.size:
        return float("nan"), float("nan")
    at = int(made[0]) + 1
    force = result.force[span.closing]
    return float(result.depth[span.closing][at]), max(-float(force[at:].min()), 0.0)


def _time_held(result: Result, span: Span) -> float:
    if span.last < len(result.time) - 1:
        return float("nan")  # a run ends where a held contact lets go
    try:
        return time_held(result)
    except ValueError:
        return float("nan")
