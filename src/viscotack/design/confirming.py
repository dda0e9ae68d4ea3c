"""Simulation of a design, which decides."""

from __future__ import annotations

from dataclasses import replace

from viscotack.errors import InputError
from viscotack.model.problem import Problem
from viscotack.model.protocol import Dwell, LoadTo, Retraction
from viscotack.result import Outcome, Result
from viscotack.result.cycles import time_to_detachment
from viscotack.result.observables import pull_off, work_to_pull_off
from viscotack.simulate import solve

from .fast import FastTier, Pad
from .margins import Candidate, Judge, Simulated, pad_of

# A dead load is applied within this part of the holding time; the simulation lasts this
# number of holding times.
_APPLIED, _LONGEST = 0.01, 10.0


def simulate(candidate: Candidate, fast: FastTier, judge: Judge, *, accuracy: float) -> Simulated:
    """Simulate one pad of a design at the conditions of its targets.

    Parameters
    ----------
    candidate : Candidate
        The design.
    fast : FastTier
        Has materials and interface.
    judge : Judge
        Targets and conditions.
    accuracy : float
        Of each simulation, as for :func:`viscotack.solve`.
    """
    choice = candidate.choice
    forces: dict[str, float] = {}
    reasons = []
    for name, pads in judge.pads(choice).items():
        # of several speeds that with the worst prediction
        known = [(x, pad) for pad in pads if not isinstance(x := fast.force(pad), str)]
        select, end = (min, "low") if name == "hold" else (max, "high")
        _, pad = select(known, key=lambda pair, end=end: getattr(pair[0], end))
        found = _pulled(fast.problem(pad), accuracy)
        if isinstance(found, str):
            reasons.append(f"{name}: {found}")
            continue
        if judge.targets.work is None or name == "release":
            found = {name: found["hold"]}
        forces |= {key: choice.pads * value for key, value in found.items()}
    time = None
    if judge.targets.holding_time is not None:
        held = _held(candidate, fast, judge, accuracy)
        if isinstance(held, str):
            reasons.append(f"dead_load: {held}")
        else:
            forces["dead_load"], time = held
    margins = {} if reasons else judge.margins(choice, forces)
    return Simulated(forces, margins, "; ".join(reasons), time)


def _pulled(problem: Problem, accuracy: float) -> dict[str, float] | str:
    """Return force [N] and work [J] of a pad, or a reason."""
    try:
        found = solve(problem, accuracy=accuracy, until="pull-off", throw=False)
        if found.outcome is Outcome.STOPPED:
            return found.status
        unit = problem.outputs.observables["work_to_pull_off"].unit
        return {
            "hold": pull_off(found).force * problem.scales().force,
            "work": work_to_pull_off(found) * getattr(problem.scales(), unit.scale),
        }
    except InputError as reason:
        return str(reason)


def _held(
    candidate: Candidate, fast: FastTier, judge: Judge, accuracy: float
) -> tuple[float, float | None] | str:
    """Return the load held for the time [N], and the time under the predicted load [s].

    The simulated time becomes a load by the theory: that load times the ratio of the loads that the
    theory has for both times.
    """
    choice, targets = candidate.choice, judge.targets
    assert targets.holding_time is not None, "the caller checks"
    wanted = judge.conditions.holding_time(choice.material, targets.holding_time)
    pad: Pad = pad_of(choice, 1.0, bonded=judge.bonded)
    problem = fast.problem(pad)
    load, longest = candidate.forces["dead_load"].value / choice.pads, _LONGEST * wanted
    moves = (LoadTo(-load, duration=_APPLIED * wanted), Dwell(longest, hold="force"))
    held = Retraction(problem.protocol.start, None, moves)  # type: ignore[arg-type]
    try:
        found = solve(replace(problem, protocol=held), accuracy=accuracy, throw=False)
        if found.outcome is Outcome.STOPPED:
            return found.status
        gone = found.outcome in (Outcome.JUMPED, Outcome.DETACHED)
        time = _time(found) if gone else None  # type: ignore[arg-type]
    except InputError as reason:
        return str(reason)
    shown = longest if time is None else max(time, _APPLIED * wanted)
    first, second = (fast.held(pad, x) for x in (wanted, shown))
    if isinstance(first, str) or isinstance(second, str):
        return str(first)
    return choice.pads * load * first.value / second.value, time


def _time(found: Result) -> float:
    """Return the time to detachment [s]; 0 if it is over before the load is."""
    try:
        return time_to_detachment(found)
    except InputError:
        return 0.0
