"""Time integration of a soft body through the legs of a loading history.

A leg begins with the machine attached to the contact in its present state. The time loop then tries
a step and shortens it until it is accepted. Steps are taken in the frame of the moving crack where
the edge travels (:mod:`.travelling`), otherwise in the frame of the solid (:mod:`.steps`). If even
the shortest step fails, the solver treats it as a jump (:mod:`.jumps`). After each step the solver
checks whether the leg or the whole run has ended, and whether the fine nodes must follow the edge
(:mod:`.steps`). Module :mod:`.history` defines the recorded quantities.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import isfinite, isinf
from typing import Any

import numpy as np

from viscotack.clock import TimeUp
from viscotack.errors import InputError
from viscotack.model.materials import Modes
from viscotack.simulate.body import Body, step
from viscotack.simulate.contacts.contact import Contact, Relaxed
from viscotack.simulate.history import SMALLEST_ENERGY, EnergyTerms, History, Lowest, Snapshot
from viscotack.simulate.jumps import followed, shortest_step
from viscotack.simulate.machine import Leg
from viscotack.simulate.mesh import Grading, Mesh
from viscotack.simulate.settings import Settings
from viscotack.simulate.steps import (
    MarchState,
    Run,
    arrived,
    clipped,
    is_shortest,
    opening,
    over,
    shortened,
    tried,
    weighed,
)
from viscotack.simulate.surface import separated
from viscotack.simulate.travelling import ahead, travelled

# Absolute tolerance within which a target depth, force or edge counts as reached, in its unit.
_MET = 1e-9
# Relative change of a dead load in its first step if it begins at a limit point.
_NOTICED = 1e-3
# Part of the mesh up to which an edge may grow: at its end the forces of an elastic sphere are 2 %
# off, up to here 0.1 %.
_INSIDE = 0.95


@dataclass(frozen=True, eq=False)
class Part:
    """A contact with its relaxed start, modes and grading, ready for a run.

    The traction law of the contact is that at rest; `growing` is the law itself if its tension
    grows with the opening speed or the time in contact, otherwise None.
    """

    contact: Contact
    start: Relaxed
    modes: Modes
    grading: Grading
    growing: Any = None


def march(
    part: Part,
    legs: tuple[Leg, ...],
    settings: Settings,
    *,
    until: str,
    stiffness: float | None = None,
    profiles: bool = False,
    progress: Callable[[float], None] | None = None,
    watch: Callable[[Snapshot], None] | None = None,
) -> History:
    """Integrate a relaxed body through all legs and return the history.

    `until` is "pull-off" (stop after the largest tension of the last leg, :func:`.steps.over`) or
    "detached" (stop when the surfaces have separated). `stiffness` is the spring stiffness of the
    machine [output force/h0].

    The outcome is one of these words:

    - "pull-off", "detached" or "end" (of the last leg): the run is complete;
    - "steps" or "time": the limit on steps or on wall time was reached;
    - "shut": the surfaces were pressed together harder than the law can repel;
    - "lost": no equilibrium was found;
    - "unheld": no contact exists that can carry the dead load.
    """
    run, at = begun_run(part, legs, settings, stiffness, profiles)
    return through(run, at, until, progress, watch)


def through(
    run: Run,
    at: MarchState,
    until: str,
    progress: Callable[[float], None] | None = None,
    watch: Callable[[Snapshot], None] | None = None,
) -> History:
    """Integrate through all legs of a run from a relaxed place; see :func:`march`.

    A run that has a history continues from a place after a step.
    """
    history, continues = run.history, bool(run.history.snapshots)
    if not continues:
        run.keep(at)
    try:
        at = _judged(run, at, until) if continues else _begun(run, at, 0)
        while not history.outcome:
            told = len(history.snapshots)
            at = _stepped(run, at)
            if not history.outcome:
                at = _judged(run, at, until)
            if progress is not None:
                progress(_share(run, at))
            if watch is not None:
                for snapshot in history.snapshots[told:]:  # empty if no further step was found
                    watch(snapshot)
    except TimeUp as limit:
        history.outcome, history.reason = "time", str(limit)
    return history


def advanced(run: Run, at: MarchState, leg: Leg) -> MarchState:
    """Return the place at the end of a leg that continues smoothly from a place of another run."""
    at = replace(at, leg=leg, number=0, began=at.seen)
    while not run.history.outcome:
        at = _stepped(run, at)
        if not run.history.outcome:
            at = _judged(run, at, "detached")
    return at


def begun_run(
    part: Part,
    legs: tuple[Leg, ...],
    settings: Settings,
    stiffness: float | None = None,
    profiles: bool = False,
) -> tuple[Run, MarchState]:
    """Return a run, and its place at the relaxed start, before the machine is attached."""
    contact, start = part.contact, part.start
    body = Body(contact, part.modes, np.asarray(part.modes.weights), part.growing)
    history = History(SMALLEST_ENERGY * contact.span, stiffness)
    state, leg = body.first(start), legs[0]
    mesh = Mesh(
        finest=part.grading,
        opening=opening(state, contact),
        lattice=start.lattice,
        grading=part.grading,
        edge=0.0 if np.isnan(start.edge) else start.edge,
        narrows=body.runs,
    )
    books = EnergyTerms(0.0, np.zeros(len(body.weights)))
    at = MarchState(state, books, mesh, leg, 0, state.seen, leg.least_step, Lowest())
    return Run(body, settings, legs, profiles, history), at


def _begun(run: Run, at: MarchState, number: int) -> MarchState:
    """Begin a leg: attach the machine to the contact in its present state."""
    before = at.seen
    leg = _noticed(run.legs[number].beginning(before), before)
    begun = replace(
        at,
        state=run.body.at_rest(at.state),
        leg=leg,
        number=number,
        began=before,
        dt=leg.least_step,
        lowest=Lowest(),
    )
    if leg.dead_load and leg.rate == 0 and not before.edge > 0:
        run.history.outcome = "unheld"  # unstable: attraction grows as the surfaces approach
        return begun
    turns = number > 0 and leg.outwards and not at.leg.outwards
    if turns and begun.seen.edge > 0:
        lattice = replace(begun.mesh, lattice=begun.seen.edge)
        return followed(run, replace(begun, mesh=lattice))
    return begun


def _noticed(leg: Leg, before: Snapshot) -> Leg:
    """Return a leg whose first change of dead load exceeds the residual of the equilibrium.

    Separated surfaces that attract each other are at a limit point under a dead load. A growing
    load makes them jump together; round-off must not make them jump apart instead.
    """
    if not (leg.dead_load and leg.rate > 0) or before.edge > 0:
        return leg
    least = min(_NOTICED * abs(before.force) / leg.rate, leg.duration)
    return replace(leg, least_step=max(leg.least_step, least))


def _stepped(run: Run, at: MarchState) -> MarchState:
    """Advance by one step, shortened until it is accepted or cannot be shortened further."""
    while True:
        at = clipped(run, at)
        goal = ahead(run, at)
        if goal is not None:
            at = replace(at, dt=goal.dt)
            attempt = travelled(run, at, goal)
        else:
            s = step(run.body.modes, at.dt)
            if is_shortest(run, at, s):
                return shortest_step(run, at, s)
            attempt = weighed(run, at, s, tried(run, at, s))
        shorter = shortened(run, at, attempt)
        if shorter is None:
            assert attempt is not None
            after = arrived(at, attempt)
            run.keep(after)
            return after
        at = shorter


def _judged(run: Run, at: MarchState, until: str) -> MarchState:
    """Check whether the leg or the run has ended, and remesh if the edge has left the nodes."""
    history, last = run.history, at.number == len(run.legs) - 1
    if last and at.leg.opens and separated(at.state.gap, run.body.contact.span):
        history.outcome = "detached"
    elif last and until == "pull-off" and over(run, at):
        history.outcome = "pull-off"
    elif len(history.snapshots) > run.settings.most_steps:
        history.outcome = "steps"
    elif at.ahead <= _MET or at.left <= 0:
        if not last:
            return _begun(run, at, at.number + 1)
        history.outcome = "end"
    elif at.mesh.left_by(at.seen.edge, at.seen.inner) or narrowed(run, at):
        return followed(run, at)
    return at


def narrowed(run: Run, at: MarchState) -> bool:
    """Return whether the cohesive zone has become too short for the present nodes."""
    if not (at.mesh.narrows and at.seen.edge > 2 * at.mesh.grading.spacing):
        return False
    return at.mesh.too_coarse(opening(at.state, run.body.contact))


def _share(run: Run, at: MarchState) -> float:
    """Return the completed fraction of the run, 0 to 1; all legs have the same weight."""
    edge, leg, whole = at.seen.edge, at.leg, at.leg.missing(at.began)
    if isfinite(leg.duration):
        part = 1 - at.left / leg.duration
    elif isfinite(whole):
        part = 1 - at.ahead / whole if whole > 0 else 1.0
    else:
        part = 1 - (edge / at.began.edge if edge > 0 else 0.0) if at.began.edge > 0 else 0.0
    return (at.number + min(max(part, 0.0), 1.0)) / len(run.legs)


class SteppedSimulation:
    """A contact at its relaxed start, moved by a drive in pieces of constant speed.

    All is dimensionless, as in a result. The equations and steps are those of a history
    (:func:`march`), but the next piece of it may depend on what the last one did.

    Parameters
    ----------
    part : Part
        The contact, with modes for the shortest step and for the time of all pieces.
    stiffness : float
        Of the spring between drive and indenter; infinite for a rigid machine.
    least_step : float
        Length of the first step.
    settings : Settings
        Mesh and steps.
    """

    def __init__(
        self, part: Part, stiffness: float, *, least_step: float, settings: Settings
    ) -> None:
        self._leg = Leg(stiffness, 0.0, least_step=least_step)
        self._largest = _INSIDE * part.grading.outer_radius
        spring = None if isinf(stiffness) else stiffness
        self._run, self._at = begun_run(part, (self._leg,), settings, spring)
        self._run.keep(self._at)

    @property
    def now(self) -> Snapshot:
        """Time, depth, force and edge at present."""
        return self._at.seen

    @property
    def apart(self) -> bool:
        """Whether the surfaces have separated."""
        return self._run.history.outcome == "detached"

    @property
    def tension(self) -> float:
        """Largest tension of all steps so far, positive."""
        return max(-min(step.force for step in self._run.history.snapshots), 0.0)

    def move(self, speed: float, duration: float) -> Snapshot:
        """Move the drive at a speed for a time, and return the observed state.

        Parameters
        ----------
        speed : float
            Of the drive, positive into the solid [h0 per time unit].
        duration : float
            Positive [time unit].

        Raises
        ------
        ValueError
            If no equilibrium is found, the limit on steps is reached, or the edge reaches the end
            of the mesh, which is made for the start.
        """
        leg = replace(self._leg, rate=speed, duration=duration)
        run, before = replace(self._run, legs=(leg,)), len(self._run.history.snapshots)
        self._at = advanced(run, self._at, leg)
        if (outcome := run.history.outcome) not in ("", "end", "detached"):
            raise InputError(f"the contact cannot be moved on: {outcome}")
        # beyond the mesh the edge is nan, as apart
        if any(step.edge > self._largest for step in run.history.snapshots[before:]):
            raise InputError("the contact grows to the end of its mesh; start from a deeper one")
        if outcome == "end":
            run.history.outcome = ""
        return self.now
