"""Simulation of a design, which decides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from viscotack.errors import InputError
from viscotack.model.problem import Problem
from viscotack.model.protocol import Dwell, LoadTo, Retraction
from viscotack.result import Outcome, Result
from viscotack.result.dead_load import time_to_detachment
from viscotack.result.observables import pull_off, work_to_pull_off
from viscotack.simulate import solve

from .fast import FastTier, Pad
from .margins import Candidate, Judge, pad_of
from .space import HOLD, LOAD, RELEASE, WORK

# A dead load is applied within this part of the holding time; the simulation lasts this
# number of holding times.
_APPLIED, _LONGEST = 0.01, 10.0


@dataclass(frozen=True)
class Simulated:
    """Simulated forces of a design.

    Attributes
    ----------
    forces : mapping of str to float
        Of all pads, with the names of :class:`.margins.Candidate`: "hold", "release" [N] and "work"
        [J], and as "dead_load" the load held for the time [N], by the simulated time under the
        predicted load and the slope of the theory. Those of failed runs are missing.
    errors : mapping of str to float
        Relative error estimates.
    margins : mapping of str to float
        Margins of the targets by the simulated forces; empty if a run failed.
    method : str
        "simulation", or "steady cracks" where the simulation hands over to them.
    why : str
        Reason of a failed run.
    time : float or None
        Simulated time to detachment under the predicted dead load [s]; None if there is none, or
        if it is longer than ten holding times.
    """

    forces: Mapping[str, float]
    errors: Mapping[str, float]
    margins: Mapping[str, float]
    method: str
    why: str = ""
    time: float | None = None

    @property
    def margin(self) -> float | None:
        """Margin of the worst target; None if a run failed."""
        return min(self.margins.values(), default=None)

    @property
    def meets(self) -> bool | None:
        """Whether every target is met; None if a run failed."""
        return None if self.margin is None else self.margin >= 0


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
    errors: dict[str, float] = {}
    methods, reasons = [], []
    for name, pads in judge.pads(choice).items():
        # of several speeds that with the worst prediction
        known = [(x, pad) for pad in pads if not isinstance(x := fast.force(pad), str)]
        select, end = (min, "low") if name == HOLD else (max, "high")
        _, pad = select(known, key=lambda pair, end=end: getattr(pair[0], end))
        found = _pulled(fast.problem(pad), accuracy)
        if isinstance(found, str):
            reasons.append(f"{name}: {found}")
            continue
        values, error, method = found
        methods.append(method)
        if judge.targets.work is None or name == RELEASE:
            values = {name: values[HOLD]}
        forces |= {key: choice.pads * value for key, value in values.items()}
        errors |= {key: error[HOLD if key == RELEASE else key] for key in values}
    time = None
    if judge.targets.holding_time is not None:
        held = _held(candidate, fast, judge, accuracy)
        if isinstance(held, str):
            reasons.append(f"{LOAD}: {held}")
        else:
            forces[LOAD], time, method = held
            errors[LOAD] = accuracy
            methods.append(method)
    return Simulated(
        forces,
        errors,
        {} if reasons else judge.margins(choice, forces),
        " and ".join(dict.fromkeys(methods)),
        "; ".join(reasons),
        time,
    )


def _pulled(
    problem: Problem, accuracy: float
) -> tuple[dict[str, float], dict[str, float], str] | str:
    """Return force [N] and work [J] of a pad, their relative errors and the method, or a reason."""
    try:
        found = solve(problem, accuracy=accuracy, until="pull-off", throw=False)
        if found.outcome is Outcome.STOPPED:
            return found.status
        unit = problem.outputs.observables["work_to_pull_off"].unit
        values = {
            HOLD: pull_off(found).force * problem.scales().force,
            WORK: work_to_pull_off(found) * getattr(problem.scales(), unit.scale),
        }
    except InputError as reason:
        return str(reason)
    stated = found.error_estimate or {}
    errors = {HOLD: stated.get("force", accuracy), WORK: stated.get("work", accuracy)}
    return values, errors, found.method


def _held(
    candidate: Candidate, fast: FastTier, judge: Judge, accuracy: float
) -> tuple[float, float | None, str] | str:
    """Return the load held for the time [N], the time under the predicted load, and the method.

    The simulated time becomes a load by the theory: that load times the ratio of the loads that the
    theory has for both times.
    """
    choice, targets = candidate.choice, judge.targets
    assert targets.holding_time is not None, "the caller checks"
    wanted = judge.conditions.holding_time(choice.material, targets.holding_time)
    pad: Pad = pad_of(choice, 1.0, bonded=judge.bonded)
    problem = fast.problem(pad)
    load, longest = candidate.forces[LOAD].value / choice.pads, _LONGEST * wanted
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
    return choice.pads * load * first.value / second.value, time, found.method


def _time(found: Result) -> float:
    """Return the time to detachment [s]; 0 if it is over before the load is."""
    try:
        return time_to_detachment(found)
    except InputError:
        return 0.0
