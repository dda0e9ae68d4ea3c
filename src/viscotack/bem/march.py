r"""The march: a soft body through the legs of a history, step by step.

Each step is implicit and exact for a load that is linear in time (:mod:`.memory`), so it is
second order in its length. The length is bounded by the error of that linearity, by the change of
force and depth, by the travel of the drive and of the edge, and by the energy: drive work must
reappear as elastic and interface energy and heat. Where it does not, however short the step and
although the solid already answers as stiffly as it can, the equilibrium branch has ended: the
contact jumps to the next stable state downhill in energy, and what it loses is booked.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from viscotack.bem.body import Body, State, Trial
from viscotack.bem.books import SMALLEST_ENERGY, Books, History, Profile, Snapshot
from viscotack.bem.contact import Contact, Relaxed
from viscotack.bem.equilibrium import Balance
from viscotack.bem.machine import Hold, Leg
from viscotack.bem.memory import Step, step
from viscotack.bem.mesh import Grading
from viscotack.bem.settings import Settings
from viscotack.materials import Modes
from viscotack.result import Event

# The surfaces have separated when the smallest gap is this large [h0]; the work that is left is
# the energy of the interface there.
SEPARATED = 10.0
# Pull-off is behind when the force has risen again by this part of its minimum and of the unit of
# force: a force that has just become tensile is as large as what nodes add to it.
_RISEN = 0.03
# The solid answers as stiffly as it can when a step's compliance exceeds the instantaneous one by
# less than this part.
_INSTANT = 1e-2
# Past the pull-off, steps may be this much longer: what is left is a small part of the work.
_LOOSER = 2.0
# A step that needs more iterations than this is too long; the way down from the end of a branch may
# take so many.
_MOST_ITERATIONS = 25
_PATIENCE = 500
# No equilibrium is there when none was found in so many steps, each twice as long as the last.
_LOOKS = 8
# A step is at most this much longer than the last.
_GROWTH = 1.5
# The end of a leg has been met within this part of the step that passes it.
_AT_END = 1e-3
# What is lost on new nodes after a step that has lost nothing is a jump from so many times the
# tolerated imbalance on.
_CLEARLY = 5.0
# After a jump the edge may be far from the fine nodes: so many meshes go after it.
_MOST_MESHES = 200


@dataclass(eq=False)
class _March:
    """A march at work: where it is, what it has passed, and the mesh it is on."""

    body: Body
    settings: Settings
    legs: tuple[Leg, ...]
    profiles: bool
    state: State
    books: Books
    grading: Grading
    finest: Grading
    lattice: float
    meshed_at: float
    opening: float
    leg: Leg
    dt: float = 0.0
    number: int = 0
    began: Snapshot = field(init=False)
    known: bool = False  # whether the rates of the state tell anything of the next step
    lowest: float = np.inf
    since_lowest: int = 0
    history: History = field(default_factory=History)

    @property
    def past(self) -> bool:
        """Whether the force minimum of this leg is behind."""
        risen = min(self.state.seen.force, 0.0) - self.lowest
        return self.since_lowest > 2 and risen > _RISEN * (abs(self.lowest) + 1)

    @property
    def looser(self) -> float:
        """How much longer steps may be."""
        return _LOOSER if self.past else 1.0

    @property
    def room(self) -> float:
        """Largest change of the force in a step."""
        return self.looser * self.settings.force_change * (abs(self.state.seen.force) + 1)

    @property
    def travel(self) -> float:
        """Largest travel [h0] in a step.

        Once apart, tractions change over the gap. Pressed deep, forces change over the depth, which
        grows like F^(2/3) by Hertz; adhesion is a small matter there.
        """
        apart = max(float(np.min(self.state.gap)) - 1, 0.0)
        pressed = max(self.state.seen.force, 0.0) ** (2 / 3)
        reach = self.body.contact.travel * (1 + pressed) + apart
        return self.looser * self.settings.travel * reach

    def run(self, until: str, progress: Callable[[float], None] | None) -> History:
        """Go through all legs."""
        self._keep()
        self._begin(0)
        while not self.history.outcome:
            if not self._step():
                continue
            self._judge(until)
            if progress is not None:
                progress(self._share())
        return self.history

    def _begin(self, number: int) -> None:
        """Begin a leg: the machine takes hold of the contact as it is."""
        before, was_outwards = self.state.seen, self.leg.outwards
        self.number, self.known = number, False
        self.leg = self.legs[number].beginning(before.drive, before.force)
        turns = number > 0 and self.leg.outwards and not was_outwards
        self.dt, self.lowest, self.since_lowest = self.leg.least_step, np.inf, 0
        self.state = self.body.stopped(self.state, self._hold(before, 0.0))
        # The drive does the work that tightens the spring where another machine held the contact.
        tightened = self.state.seen.spring - before.spring
        self.books = replace(self.books, drive=self.books.drive + tightened)
        self.began = self.state.seen
        if turns and self.began.edge > 0:
            self.lattice = self.began.edge
            self._remesh()

    def _hold(self, began: Snapshot, elapsed: float) -> Hold:
        """Return what the machine imposes at a time after the beginning of the leg."""
        leg, unit = self.leg, self.state.surface.unit
        if leg.dead_load:
            return Hold(0.0, load=(began.force + leg.rate * elapsed) / unit)
        if np.isinf(leg.stiffness):
            return Hold(np.inf, depth=began.depth + leg.rate * elapsed)
        k = leg.stiffness / unit
        return Hold(k, load=k * (began.drive + leg.rate * elapsed))

    def _step(self) -> bool:
        """Try a step and go where it leads, or make the next one shorter."""
        leg, now, first = self.leg, self.state.seen, self.history.snapshots[0]
        ahead = leg.missing(now.depth, now.force, now.edge)
        self._clip(ahead)
        s = step(self.body.modes, self.dt)
        instant = s.compliance < (1 + _INSTANT) * self.body.modes.instantaneous
        stiffest = instant and self.dt <= leg.least_step * (1 + 1e-9)
        trial = self._try(s, _PATIENCE if stiffest else _MOST_ITERATIONS)
        if stiffest and trial.lost:
            s, trial = self._look_again(s, trial)
        after = trial.after.seen
        if trial.released and stiffest:
            self._release(after)
            return True
        entry = self._entry(s, trial.after)
        missing = entry.imbalance(first, after) - self.books.imbalance(first, now)
        tolerated = self.settings.imbalance * max(entry.largest(first, after), SMALLEST_ENERGY)
        strain = max(self._strain(trial), abs(missing) / tolerated)
        if not strain <= 1.5 and not stiffest:
            self.history.rejected += 1
            self.dt *= max(0.2, min(0.8 / np.sqrt(strain), 0.7))
            return False
        if trial.lost:  # however short the step, no equilibrium was found
            self.history.outcome = "lost"
            return True
        over = -leg.missing(after.depth, after.force, after.edge)
        if 0 < ahead and over > _AT_END * (ahead + over) and strain <= 1.5 and not stiffest:
            self.dt *= ahead / (ahead + over)
            return False
        jumped = strain > 1.5
        if jumped:  # the branch has ended: what is missing was lost in a jump
            entry = replace(entry, jumps=entry.jumps + missing)
            self.dt = leg.least_step
        else:
            self.dt *= min(_GROWTH, 0.8 / np.sqrt(strain + 1e-12))
        self.state, self.books, self.known = trial.after, entry, True
        if jumped:
            self._chase(now, missing, tolerated)
        self._keep()
        if after.force < self.lowest:
            self.lowest, self.since_lowest = after.force, 0
        else:
            self.since_lowest += 1
        return True

    def _try(self, s: Step, most_iterations: int) -> Trial:
        elapsed = self.state.seen.time - self.began.time + s.length
        trial = self.body.after(self.state, s, self._hold(self.began, elapsed), most_iterations)
        self.history.iterations += trial.iterations
        return trial

    def _look_again(self, s: Step, trial: Trial) -> tuple[Step, Trial]:
        """Look for the state after a jump from a little later on.

        Where a branch has only just ended, the way down begins so flat that round-off decides how
        many iterations it takes. Later it is steep; what the solid does meanwhile is next to
        nothing, its compliance being the instantaneous one.
        """
        state, known = self.state, self.known
        self.state, self.known = self.body.at_rest(state), False
        for _ in range(_LOOKS):
            longer = step(self.body.modes, 2 * s.length)
            instant = longer.compliance < (1 + _INSTANT) * self.body.modes.instantaneous
            if not instant or longer.length > self._left():
                break
            s, trial = longer, self._try(longer, _PATIENCE)
            if not trial.lost:
                break
        self.state = state
        if trial.lost:
            self.known = known
        return s, trial

    def _strain(self, trial: Trial) -> float:
        """Return by how much a step is too long but for its energy: a ratio of lengths, squared."""
        now, after = self.state.seen, trial.after.seen
        allowed = self.settings.step_error * self.looser**2
        known = self.known or np.isinf(trial.error)
        # a rigid machine's travel is bounded before the step is tried
        sprung = not np.isinf(self.leg.stiffness)
        return max(
            trial.error / allowed if known else 0.0,
            (abs(after.force - now.force) / (2 * self.room)) ** 2,
            (abs(after.depth - now.depth) / self.travel) ** 2 if sprung else 0.0,
            _edge_strain(now.edge, after.edge, self.grading),
        )

    def _clip(self, ahead: float) -> None:
        """Shorten the next step to the travel it may have, and to the end of its leg."""
        leg = self.leg
        if leg.rate and np.isinf(leg.stiffness):  # a soft spring's drive may run ahead
            self.dt = min(self.dt, self.travel / abs(leg.rate))
        if np.isinf(leg.stiffness) and leg.depth == leg.depth and leg.rate and ahead > 0:
            self.dt = min(self.dt, ahead / abs(leg.rate))
        left = self._left()
        if self.dt > 0.999 * left > 0:
            self.dt = left

    def _left(self) -> float:
        """Return the time left of the leg, none where the clock can no longer tell it from none."""
        now = self.state.seen.time
        left = self.leg.duration - (now - self.began.time)
        return left if left > 8 * np.spacing(now) else 0.0

    def _entry(self, s: Step, after: State) -> Books:
        """Return the books after a step, before anything is said of jumps."""
        before, now = self.state, self.state.seen
        work = 0.5 * (now.force + after.seen.force) * (after.seen.drive - now.drive)
        heat = before.surface.unit * before.memory.heat(
            s, before.relaxed, after.relaxed, before.nodal, after.nodal
        )
        return replace(self.books, drive=self.books.drive + work, heat=self.books.heat + heat)

    def _judge(self, until: str) -> None:
        """See whether the leg, or the march, has come to its end, and whether nodes must follow."""
        history, seen, leg = self.history, self.state.seen, self.leg
        if history.outcome:
            return
        last = self.number == len(self.legs) - 1
        if last and leg.opens and float(np.min(self.state.gap)) > SEPARATED:
            history.outcome = "detached"
        elif last and until == "pull-off" and self.past:
            history.outcome = "pull-off"
        elif len(history.snapshots) > self.settings.most_steps:
            history.outcome = "steps"
        elif leg.missing(seen.depth, seen.force, seen.edge) <= 1e-9 or self._left() <= 0:
            if last:
                history.outcome = "end"
            else:
                self._begin(self.number + 1)
        elif self._edge_left():
            self._remesh()

    def _release(self, after: Snapshot) -> None:
        """End with a contact that a dead load pulls apart: nothing stops it, and nothing is kept.

        The elastic energy is lost; what the load gains by falling further has no bound.
        """
        now = self.state.seen
        gone = replace(now, time=after.time, edge=float("nan"))
        self.history.events.append(_jump(now, gone, now.elastic))
        self.history.outcome = "detached"

    def _edge_left(self) -> bool:
        edge = self.state.seen.edge
        away = abs(edge - self.meshed_at) > 0.5 * self.grading.half_width
        return away and edge > 2 * self.grading.spacing

    def _remesh(self) -> None:
        """Go on with the fine nodes around the edge, and book what that costs."""
        now = self.state.seen
        moved = self._on_new_nodes()
        if moved is None:
            return
        lost = now.stored - moved.stored
        if abs(moved.force - now.force) > self.room:  # new nodes tipped it over the brink
            self.books = replace(self.books, jumps=self.books.jumps + lost)
            self.history.events.append(_jump(now, moved, lost))
        else:
            self.books = replace(self.books, transfer=self.books.transfer + lost)

    def _on_new_nodes(self) -> Snapshot | None:
        """Move the state to nodes around its edge; None where it finds no balance there.

        That happens on the brink of a jump: the march then goes on with the nodes it has.
        """
        edge = self.state.seen.edge
        opened = _opening(self.state, self.body.contact)
        grading = _fitting(self.finest, opened / self.opening, edge)
        nodes = grading.nodes(edge, self.lattice)
        hold = self._hold(self.began, self.state.seen.time - self.began.time)
        state = self.body.remeshed(self.state, nodes, hold)
        self.meshed_at = edge
        if isinstance(state, Balance):
            if state.released:  # a dead load had nothing left that holds it
                self._release(self.state.seen)
            return None
        self.history.meshes += 1
        self.state, self.grading = state, grading
        return state.seen

    def _chase(self, before: Snapshot, missing: float, tolerated: float) -> None:
        """After a jump: go on at rest, with fine nodes where the edge has come to be."""
        # A jump loses energy. Where the step itself has lost none, and only went far, what new
        # nodes cost must not look like one.
        least = tolerated if missing > tolerated else _CLEARLY * tolerated
        self.state, self.known = self.body.at_rest(self.state), False
        for _ in range(_MOST_MESHES):
            now = self.state.seen
            if not self._edge_left():
                break
            moved = self._on_new_nodes()
            if moved is None:
                break
            missing += now.stored - moved.stored
            self.books = replace(self.books, jumps=self.books.jumps + now.stored - moved.stored)
        now = self.state.seen
        if missing > least or (before.edge > 0) != (now.edge > 0):
            self.history.events.append(_jump(before, now, missing))

    def _keep(self) -> None:
        """Keep what is to be kept of the present state."""
        state, history = self.state, self.history
        history.snapshots.append(state.seen)
        history.books.append(self.books)
        history.legs.append(self.number)
        history.nodes = max(history.nodes, len(state.gap))
        if self.profiles:
            pressure = state.nodal / state.surface.area
            history.profiles.append(Profile(state.surface.position, pressure, state.gap))

    def _share(self) -> float:
        """Return the done share of the way, from 0 to 1."""
        edge, first = self.state.seen.edge, self.began.edge
        part = 1 - (edge / first if edge > 0 else 0.0) if self.leg.outwards and first > 0 else 0.0
        return (self.number + part) / len(self.legs)


def _jump(before: Snapshot, after: Snapshot, lost: float) -> Event:
    kind = "jump"
    if before.edge > 0 and not after.edge > 0:
        kind = "jump out of contact"
    elif after.edge > 0 and not before.edge > 0:
        kind = "jump into contact"
    return Event(kind, after.time, after.depth, before.force, lost)


def _opening(state: State, contact: Contact) -> float:
    """Return the distance from the edge over which the gap opens by h0; the zone's without one."""
    gap, x = state.gap - contact.law.edge_gap - 1, state.surface.position
    beyond = int(np.argmax((gap > 0) & (x > state.seen.edge)))
    if beyond == 0:
        return contact.zone
    g, r = gap[beyond - 1 : beyond + 1], x[beyond - 1 : beyond + 1]
    return float(r[1] - g[1] * (r[1] - r[0]) / (g[1] - g[0])) - state.seen.edge


def _fitting(finest: Grading, grown: float, edge: float) -> Grading:
    """Return the grading for a crack that has grown so much, within a third of the edge."""
    factor = min(grown, edge / (3 * finest.half_width))
    return finest.widened(2.0 ** np.floor(np.log2(factor))) if factor >= 2 else finest


def _edge_strain(before: float, after: float, grading: Grading) -> float:
    """Return 1 where the edge goes so far in a step that it might leave the fine nodes."""
    if not (before > 2 * grading.spacing and after > 0):
        return 0.0
    return ((after - before) / (0.4 * grading.half_width)) ** 2


def march(
    contact: Contact,
    start: Relaxed,
    modes: Modes,
    legs: tuple[Leg, ...],
    grading: Grading,
    settings: Settings,
    *,
    until: str,
    profiles: bool = False,
    progress: Callable[[float], None] | None = None,
) -> History:
    """Take a body at rest through the legs and return its history.

    `until` is "pull-off" (a little past the force minimum of the last leg) or "detached" (surfaces
    apart). The outcome is "pull-off", "detached", "end" (of the last leg), "steps" when the bound
    on steps was met, or "lost" when no equilibrium was found.
    """
    body = Body(contact, modes, np.asarray(modes.weights))
    first = body.first(start)
    return _March(
        body=body,
        settings=settings,
        legs=legs,
        profiles=profiles,
        state=first,
        books=Books(0.0, np.zeros(len(modes.weights))),
        grading=grading,
        finest=grading,
        lattice=start.lattice,
        meshed_at=0.0 if np.isnan(start.edge) else start.edge,
        opening=_opening(first, contact),
        leg=legs[0],
    ).run(until, progress)
