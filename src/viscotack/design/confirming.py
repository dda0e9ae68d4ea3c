"""Simulation of a design, which decides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from viscotack.errors import InputError
from viscotack.methods import solve
from viscotack.result import Outcome
from viscotack.result.observables import pull_off

from .fast import FastTier, Pad
from .margins import Candidate, margins_of, pads_of
from .space import HOLD, RELEASE, Targets


@dataclass(frozen=True)
class Simulated:
    """Simulated forces of a design.

    Attributes
    ----------
    hold, release : float or None
        Pull-off force of all pads [N]; None if no target depends on it, or if the run failed.
    errors : mapping of str to float
        Relative error estimates of both.
    margins : mapping of str to float
        Margins of the targets by the simulated forces; empty if a run failed.
    method : str
        "simulation", or "steady cracks" where the simulation hands over to them.
    why : str
        Reason of a failed run.
    """

    hold: float | None
    release: float | None
    errors: Mapping[str, float]
    margins: Mapping[str, float]
    method: str
    why: str = ""

    @property
    def margin(self) -> float | None:
        """Margin of the worst target; None if a run failed."""
        return min(self.margins.values(), default=None)

    @property
    def meets(self) -> bool | None:
        """Whether every target is met; None if a run failed."""
        return None if self.margin is None else self.margin >= 0


def simulate(
    candidate: Candidate,
    fast: FastTier,
    targets: Targets,
    *,
    accuracy: float,
) -> Simulated:
    """Simulate one pad of a design at both speeds.

    Parameters
    ----------
    candidate : Candidate
        The design.
    fast : FastTier
        Has materials and interface.
    targets : Targets
        The targets.
    accuracy : float
        Of each simulation, as for :func:`viscotack.solve`.
    """
    forces: dict[str, float] = {}
    errors: dict[str, float] = {}
    methods, reasons = [], []
    for name, pad in pads_of(candidate.choice, targets).items():
        found = _pulled(pad, fast, accuracy)
        if isinstance(found, str):
            reasons.append(f"{name}: {found}")
            continue
        force, errors[name], method = found
        forces[name] = candidate.choice.pads * force
        methods.append(method)
    hold, release = forces.get(HOLD), forces.get(RELEASE)
    return Simulated(
        hold,
        release,
        errors,
        {} if reasons else margins_of(targets, hold, release),
        " and ".join(dict.fromkeys(methods)),
        "; ".join(reasons),
    )


def _pulled(pad: Pad, fast: FastTier, accuracy: float) -> tuple[float, float, str] | str:
    """Return the simulated force of a pad [N], its relative error and method, or a reason."""
    problem = fast.problem(pad)
    try:
        found = solve(problem, accuracy=accuracy, until="pull-off", throw=False)
        if found.outcome is Outcome.STOPPED:
            return found.status
        force = pull_off(found).force * problem.scales().force
    except InputError as reason:
        return str(reason)
    return force, (found.error_estimate or {}).get("force", accuracy), found.method
