"""The simulation as a tier, for every problem that :func:`viscotack.solve` accepts."""

from __future__ import annotations

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.prediction.surrogate.line import Curves
from viscotack.result import Outcome, Result
from viscotack.result.observables import PullOff, pull_off, work_to_pull_off
from viscotack.simulate.crack_contact.by_crack import not_measured

from .prediction import MEASURED, NOT_MEASURED, THEORY_CONFIDENCE, Prediction
from .tier import SIMULATION, Question


def by_simulation(asked: Question) -> Prediction:
    """Simulate the problem at the default accuracy.

    Raises
    ------
    OutOfRange
        If the run fails, or reaches no pull-off.
    ValueError
        If :func:`viscotack.solve` rejects the problem.
    """
    from viscotack.simulate import solve

    result = solve(asked.problem, until="pull-off", throw=False)
    stated = result.error_estimate or {}
    if result.outcome is Outcome.STOPPED or "force" not in stated:
        raise OutOfRange(f"the simulation has no error estimate: {result.status}")
    found, work = pull_off(result), _work(result)
    force, depth = found.force, stated.get("depth")
    handed_over = result.method != SIMULATION
    measured = not (handed_over and not_measured(asked.groups))
    return Prediction(
        pull_off_force=force,
        interval=_interval(force, stated["force"]),
        work_to_pull_off=work,
        work_interval=_interval(work, stated["work"]) if work and "work" in stated else None,
        confidence=THEORY_CONFIDENCE if measured else None,
        band=MEASURED if measured else NOT_MEASURED,
        method=result.method,
        inside=not handed_over,
        why=result.status,
        curve=_curve(result, found),
        problem=asked.problem,
        depth_interval=None if depth is None else (found.depth - depth, found.depth + depth),
    )


def _curve(result: Result, found: PullOff) -> Curves:
    """Return the unloading curve to the pull-off, at the points of a predicted curve."""
    from viscotack.result.curve import curve

    row, kind, groups = curve(result, found), result.problem.outputs, result.groups

    def column(name: str) -> Array:
        values = np.array(row[f"trajectory_{kind.name_of(name)}"], dtype=float)
        return values / kind.of(name).factor(groups)

    depth = np.array(row["trajectory_depth"])
    return Curves(depth, column("force"), column("contact_radius"))


def _work(result: Result) -> float | None:
    """Return the work to pull-off; None if its error exceeds half of it."""
    try:
        return work_to_pull_off(result)
    except InputError:
        return None


def _interval(value: float, error: float) -> tuple[float, float]:
    return value * (1 - error), value * (1 + error)


TIERS = {SIMULATION: ((), by_simulation)}
