"""The simulation as a tier: it answers whatever :func:`viscotack.solve` takes."""

from __future__ import annotations

from viscotack.bem.crack_band import not_measured
from viscotack.errors import InputError, OutOfRange
from viscotack.result import Outcome, Result
from viscotack.result.observables import pull_off_force, work_to_pull_off

from .prediction import MEASURED, NOT_MEASURED, THEORY_CONFIDENCE, Prediction
from .question import Question

SIMULATION = "simulation"


def by_simulation(asked: Question) -> Prediction:
    """Simulate the problem at the default accuracy.

    Raises
    ------
    OutOfRange
        If the run fails, or comes to no pull-off.
    ValueError
        If :func:`viscotack.solve` refuses the problem.
    """
    from viscotack.bem import solve

    result = solve(asked.problem, until="pull-off", throw=False)
    stated = result.error_estimate or {}
    if result.outcome is Outcome.STOPPED or "force" not in stated:
        raise OutOfRange(f"no simulation whose error is known: {result.status}")
    force, work = pull_off_force(result), _work(result)
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
        curve=None,
        curve_band=None,
        problem=asked.problem,
    )


def _work(result: Result) -> float | None:
    """Return the work to pull-off, None where it is not known to half of it."""
    try:
        return work_to_pull_off(result)
    except InputError:
        return None


def _interval(value: float, error: float) -> tuple[float, float]:
    return value * (1 - error), value * (1 + error)
