r"""The march: constant-rate retraction of a relaxed contact, step by step, until it lets go.

Each step is implicit and exact for a load that is linear in time (:mod:`.memory`), so it is
second order in its length. The length is bounded by the error of that linearity, by the change of
the force, by the travel of the drive and of the edge, and by the energy: drive work must reappear
as elastic and interface energy and heat. Where it does not, however short the step and although
the solid already answers as stiffly as it can, the equilibrium branch has ended: the contact jumps
to the next stable state downhill in energy, and what it loses is booked.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack.bem.equilibrium import descend
from viscotack.bem.halfspace import Surface, half_space
from viscotack.bem.memory import Memory, Step, step
from viscotack.bem.mesh import Grading
from viscotack.bem.settings import Settings
from viscotack.bem.start import Relaxed
from viscotack.materials import Modes
from viscotack.result import Event
from viscotack.traction import Traction

# The surfaces have separated when the smallest gap is this large [h0]; the work that is left is
# the energy of the interface there.
SEPARATED = 10.0
# The imbalance of the energies is measured by their largest term, but by no less than this: at the
# start all of them are zero [1.5 pi R dg0 h0].
SMALLEST_ENERGY = 0.1
# Pull-off is behind when the force has risen again by this part of its minimum.
_RISEN = 0.1
# The solid answers as stiffly as it can when a step's compliance exceeds the instantaneous one by
# less than this part.
_INSTANT = 1e-2
# Past the pull-off, steps may be this much longer: what is left is a small part of the work.
_LOOSER = 2.0
# A step that needs more iterations than this is too long.
_MOST_ITERATIONS = 25
# A step is at most this much longer than the last.
_GROWTH = 1.5


@dataclass(frozen=True, eq=False)
class Rates:
    """Rates of change over the last step; they only serve to predict the next."""

    relaxed: npt.NDArray
    edge: float
    gap: npt.NDArray  # in the frame of the moving edge


@dataclass(frozen=True)
class Snapshot:
    """What a run keeps of each step; energies in 1.5 pi R dg0 h0."""

    time: float
    depth: float  # [h0]
    edge: float  # [beta], nan without one
    force: float  # [1.5 pi R dg0]
    elastic: float
    interface: float


@dataclass(frozen=True, eq=False)
class State:
    """Everything at one instant: what is kept of it, and what the next step needs."""

    seen: Snapshot
    surface: Surface
    gap: npt.NDArray
    relaxed: npt.NDArray  # e: the displacement this pressure would cause in the relaxed solid
    nodal: npt.NDArray  # F: nodal forces
    memory: Memory
    rates: Rates


@dataclass(frozen=True, eq=False)
class Books:
    """Where the drive's work went so far [1.5 pi R dg0 h0]; heat by mode."""

    drive: float
    heat: npt.NDArray
    jumps: float = 0.0
    transfer: float = 0.0

    def imbalance(self, start: Snapshot, now: Snapshot) -> float:
        """Return the drive work that is nowhere to be found."""
        stored = now.elastic + now.interface - start.elastic - start.interface
        return self.drive - stored - float(self.heat.sum()) - self.jumps - self.transfer

    def largest(self, start: Snapshot, now: Snapshot) -> float:
        """Return the largest term, the measure of the imbalance."""
        elastic, interface = now.elastic - start.elastic, now.interface - start.interface
        terms = (self.drive, elastic, interface, float(self.heat.sum()), self.jumps, self.transfer)
        return max(abs(term) for term in terms)


@dataclass(frozen=True, eq=False)
class Profile:
    """Pressure [dg0/h0] and gap [h0] over the radius [beta] at one instant."""

    radius: npt.NDArray
    pressure: npt.NDArray
    gap: npt.NDArray


@dataclass(eq=False)
class History:
    """What the march passed through: a snapshot and the books after each step."""

    snapshots: list[Snapshot] = field(default_factory=list)
    books: list[Books] = field(default_factory=list)
    profiles: list[Profile] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    outcome: str = ""
    iterations: int = 0
    rejected: int = 0
    meshes: int = 1
    nodes: int = 0

    def add(self, state: State, books: Books, profile: bool) -> None:
        """Keep what is to be kept of a state."""
        self.snapshots.append(state.seen)
        self.books.append(books)
        self.nodes = max(self.nodes, len(state.gap))
        if profile:
            pressure = state.nodal / state.surface.area
            self.profiles.append(Profile(state.surface.radius, pressure, state.gap))


@dataclass(frozen=True, eq=False)
class _Solid:
    """What stays the same during a run: modes, traction law, rate, and the unit of work."""

    modes: Modes
    weights: npt.NDArray
    law: Traction
    rate: float
    to_work: float  # dg beta^2 in 1.5 pi R dg0 h0

    def state(
        self,
        time: float,
        depth: float,
        surface: Surface,
        gap: npt.NDArray,
        relaxed: npt.NDArray,
        memory: Memory,
        rates: Rates,
    ) -> State:
        nodal = -surface.area * self.law.traction(gap)
        instant = 0.5 * self.modes.instantaneous * float(relaxed @ nodal)
        seen = Snapshot(
            time=time,
            depth=depth,
            edge=surface.edge(gap, self.law.edge_gap),
            force=surface.force(self.law, gap),
            elastic=self.to_work * (instant + memory.stored(self.weights)),
            interface=surface.interface_energy(self.law, gap),
        )
        return State(seen, surface, gap, relaxed, nodal, memory, rates)

    def first(self, start: Relaxed) -> State:
        """Return the relaxed state: every mode has come to rest."""
        gap, surface = start.gap, start.surface
        e = gap - (surface.rigid_gap - start.depth)
        nodal = -surface.area * self.law.traction(gap)
        many = (len(self.weights), 1)
        memory = Memory(np.tile(e, many), np.tile(nodal, many))
        return self.state(0.0, start.depth, surface, gap, e, memory, _at_rest(gap))

    def after(self, state: State, s: Step, most_iterations: int) -> tuple[State, float, int]:
        """Return the state after a step, the error of its linearity [h0], and the iterations."""
        surface, depth = state.surface, state.seen.depth - self.rate * s.length
        free = surface.rigid_gap - depth + state.memory.inherited(s, state.relaxed)
        guess = _shifted(state, state.rates.edge * s.length) + s.length * state.rates.gap
        balance = descend(
            surface,
            self.law,
            free,
            s.compliance,
            np.maximum(guess, 0.5 * state.gap),
            most_iterations=most_iterations,
        )
        gap = balance.gap
        e = (gap - free) / s.compliance
        nodal = -surface.area * self.law.traction(gap)
        moved = surface.edge(gap, self.law.edge_gap) - state.seen.edge
        moved = 0.0 if np.isnan(moved) else moved
        change = e - state.relaxed
        error = s.curvature * float(np.max(np.abs(change - s.length * state.rates.relaxed)))
        rates = Rates(
            relaxed=change / s.length,
            edge=moved / s.length,
            gap=(gap - _shifted(state, moved)) / s.length,
        )
        memory = state.memory.advanced(s, state.relaxed, e, state.nodal, nodal)
        after = self.state(state.seen.time + s.length, depth, surface, gap, e, memory, rates)
        return after, error if balance.stable else np.inf, balance.iterations

    def settled(
        self,
        time: float,
        depth: float,
        surface: Surface,
        memory: Memory,
        guess: npt.NDArray,
    ) -> State:
        """Return the state to which the contact goes at once, downhill from a guess."""
        c = self.modes.instantaneous
        free = surface.rigid_gap - depth + self.weights @ memory.displacement
        gap = descend(surface, self.law, free, c, guess).gap
        return self.state(time, depth, surface, gap, (gap - free) / c, memory, _at_rest(gap))

    def remeshed(self, state: State, nodes: npt.NDArray) -> State:
        """Return the state on other nodes: displacements carried over, gaps in balance again."""
        surface = half_space(nodes, state.surface.tabor)
        old = state.surface.radius

        def carried(fields: npt.NDArray) -> npt.NDArray:
            return CubicSpline(old, fields, axis=-1)(nodes)

        d = carried(state.memory.displacement)
        guess = np.maximum(carried(state.gap), 0.8)
        memory = Memory(d, d @ surface.stiffness)
        moved = self.settled(state.seen.time, state.seen.depth, surface, memory, guess)
        rates = state.rates
        return replace(moved, rates=Rates(carried(rates.relaxed), rates.edge, carried(rates.gap)))


def _at_rest(gap: npt.NDArray) -> Rates:
    zero = np.zeros_like(gap)
    return Rates(zero, 0.0, zero)


def _shifted(state: State, distance: float) -> npt.NDArray:
    """Return the gap as it would be if its profile moved outwards by a distance [beta]."""
    r = state.surface.radius
    return np.interp(r - distance, r, state.gap)


def _jump(before: Snapshot, after: Snapshot, lost: float) -> Event:
    kind = "jump" if after.edge > 0 else "jump out of contact"
    return Event(kind, after.time, after.depth, before.force, lost)


def _opening(state: State, law: Traction) -> float:
    """Return the distance [beta] from the edge over which the gap opens by h0."""
    gap = state.gap - law.edge_gap - 1
    beyond = int(np.argmax((gap > 0) & (state.surface.radius > state.seen.edge)))
    g, r = gap[beyond - 1 : beyond + 1], state.surface.radius[beyond - 1 : beyond + 1]
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
    start: Relaxed,
    modes: Modes,
    law: Traction,
    rate: float,
    grading: Grading,
    settings: Settings,
    *,
    until: str,
    profiles: bool = False,
    progress: Callable[[float], None] | None = None,
) -> History:
    """Retract a relaxed contact at a constant rate [h0 per time unit] and return its history.

    `until` is "pull-off" (a little past the force minimum) or "detached" (surfaces apart).
    The outcome is "pull-off", "detached", "steps" when the bound on steps was met, or "lost" when
    no equilibrium was found.
    """
    tabor = start.surface.tabor
    solid = _Solid(modes, np.asarray(modes.weights), law, rate, 2 * tabor / (3 * np.pi))
    state = solid.first(start)
    first = state.seen
    books = Books(0.0, np.zeros(len(modes.weights)))
    history = History()
    history.add(state, books, profiles)
    meshed_at, first_opening, finest = first.edge, _opening(state, law), grading
    travel = settings.travel * (tabor + 1)
    least = settings.first_travel * (tabor + 1)
    dt = least / rate
    lowest, since_lowest, looser = first.force, 0, 1.0
    while not history.outcome:
        s, now = step(modes, dt), state.seen
        stiffest = s.compliance < (1 + _INSTANT) * modes.instantaneous and dt * rate <= least
        after, error, iterations = solid.after(state, s, 500 if stiffest else _MOST_ITERATIONS)
        history.iterations += iterations
        work = 0.5 * (now.force + after.seen.force) * (after.seen.depth - now.depth)
        heat = solid.to_work * state.memory.heat(
            s, state.relaxed, after.relaxed, state.nodal, after.nodal
        )
        entry = replace(books, drive=books.drive + work, heat=books.heat + heat)
        balance = books.imbalance(first, now)
        tolerated = settings.imbalance * max(entry.largest(first, after.seen), SMALLEST_ENERGY)
        room = looser * settings.force_change * (abs(now.force) + 1)
        strain = max(
            error / (settings.step_error * looser**2) if now.time > 0 or error == np.inf else 0.0,
            (abs(after.seen.force - now.force) / (2 * room)) ** 2,
            abs(entry.imbalance(first, after.seen) - balance) / tolerated,
            _edge_strain(now.edge, after.seen.edge, grading),
        )
        if not strain <= 1.5 and not stiffest:
            history.rejected += 1
            dt *= max(0.2, min(0.8 / np.sqrt(strain), 0.7))
            continue
        if not np.isfinite(error):  # however short the step, no equilibrium was found
            history.outcome = "lost"
            break
        if strain > 1.5:  # the branch has ended: what is missing was lost in a jump
            lost = entry.imbalance(first, after.seen) - balance
            entry = replace(entry, jumps=entry.jumps + lost)
            if abs(lost) > tolerated or (now.edge > 0 and not after.seen.edge > 0):
                history.events.append(_jump(now, after.seen, lost))
            dt = least / rate
        else:
            dt *= min(_GROWTH, 0.8 / np.sqrt(strain + 1e-12))
        state, books, now = after, entry, after.seen
        history.add(state, books, profiles)
        lowest, since_lowest = (now.force, 0) if now.force < lowest else (lowest, since_lowest + 1)
        smallest = float(np.min(state.gap))
        past = since_lowest > 2 and (1 - _RISEN) * lowest < min(now.force, 0.0)
        looser = _LOOSER if past else 1.0
        if smallest > SEPARATED:
            history.outcome = "detached"
        elif until == "pull-off" and past:
            history.outcome = "pull-off"
        elif len(history.snapshots) > settings.most_steps:
            history.outcome = "steps"
        elif abs(now.edge - meshed_at) > 0.5 * grading.half_width and (
            now.edge > 2 * grading.spacing
        ):
            grown = _opening(state, law) / first_opening
            grading = _fitting(finest, grown, now.edge)
            state = solid.remeshed(state, grading.nodes(now.edge, start.lattice))
            moved = state.seen
            lost = now.elastic + now.interface - moved.elastic - moved.interface
            if abs(moved.force - now.force) > room:  # new nodes tipped it over the brink
                books = replace(books, jumps=books.jumps + lost)
                history.events.append(_jump(now, moved, lost))
            else:
                books = replace(books, transfer=books.transfer + lost)
            meshed_at = now.edge
            history.meshes += 1
        # Once apart, the traction changes over the gap, not over the travel within contact.
        dt = min(dt, looser * (travel + settings.travel * max(smallest - 1, 0.0)) / rate)
        if progress is not None:
            progress(1 - (now.edge / first.edge if now.edge > 0 else 0.0))
    return history
