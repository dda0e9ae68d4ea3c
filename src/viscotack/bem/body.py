"""A soft body at one instant, and what a step, a jump or a new mesh makes of it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack.bem.books import Snapshot
from viscotack.bem.contacts.contact import Contact, Relaxed
from viscotack.bem.equilibrium import Balance, descend
from viscotack.bem.machine import Hold
from viscotack.bem.memory import Memory, Step
from viscotack.bem.span import least_gap, room
from viscotack.bem.surface import Surface
from viscotack.materials import Modes

# An iteration that gains less than this part of the energy is the last of a step: the force is then
# within 1e-7, and steps at large Tabor numbers take three times fewer iterations.
_LEAST_GAIN = 1e-10


# So many instants are remembered to predict the next one.
_TRAIL = 4


@dataclass(frozen=True, eq=False)
class Passed:
    """What is remembered of an instant, to predict the next and to integrate over the way there.

    Attributes
    ----------
    seen : Snapshot
        What is kept of it.
    heat : ndarray, shape (M,)
        Heat that each mode makes per time [output force times h0].
    """

    seen: Snapshot
    heat: npt.NDArray


@dataclass(frozen=True, eq=False)
class Rates:
    """Rates of change over the last step; they only serve to predict the next.

    At rest they are zero and not known: no step is judged by them.
    """

    relaxed: npt.NDArray
    edge: float
    gap: npt.NDArray  # in the frame of the moving edge
    known: bool = True
    followed: npt.NDArray | None = None  # of e, in the frame of the moving edge
    trail: tuple[Passed, ...] = ()


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
class Trial:
    """A step that was tried: the state after it, and how good it is.

    The error is that of a pressure linear in time, as a displacement [h0]; zero where the rates
    before the step are not known, infinite where no stable equilibrium was found.
    """

    after: State
    error: float
    iterations: int
    released: bool

    @property
    def lost(self) -> bool:
        """Whether iterations ran out, nothing else being known."""
        return not (np.isfinite(self.error) or self.released)


@dataclass(frozen=True, eq=False)
class Body:
    """What stays the same during a run: the contact and the modes of its solid."""

    contact: Contact
    modes: Modes
    weights: npt.NDArray

    def first(self, start: Relaxed) -> State:
        """Return the relaxed state: every mode has come to rest."""
        gap, surface = start.gap, start.surface
        e = gap - (surface.rigid_gap - start.depth)
        nodal = surface.nodal(self.contact.law, gap)
        many = (len(self.weights), 1)
        memory = Memory(np.tile(e, many), np.tile(nodal, many))
        hold = Hold(np.inf, start.depth)
        return self.state(0.0, gap, start.depth, hold, surface, e, memory, _at_rest(gap))

    def after(self, state: State, s: Step, hold: Hold, most_iterations: int) -> Trial:
        """Return what a step leads to."""
        surface, law = state.surface, self.contact.law
        free = surface.rigid_gap + state.memory.inherited(s, state.relaxed)
        guess = _shifted(state, state.rates.edge * s.length) + s.length * state.rates.gap
        balance = descend(
            surface,
            law,
            free,
            s.compliance,
            np.maximum(guess, state.gap - 0.5 * room(state.gap, self.contact.span)),
            self.net(hold, state),
            least_gain=_LEAST_GAIN,
            most_iterations=most_iterations,
        )
        gap = balance.gap
        e = (gap - free + balance.depth) / s.compliance
        nodal = surface.nodal(law, gap)
        moved = surface.edge(gap, law.edge_gap) - state.seen.edge
        moved = 0.0 if np.isnan(moved) else moved
        change = e - state.relaxed
        bend = float(np.max(np.abs(change - s.length * state.rates.relaxed)))
        rates = Rates(
            relaxed=change / s.length,
            edge=moved / s.length,
            gap=(gap - _shifted(state, moved)) / s.length,
        )
        memory = state.memory.advanced(s, state.relaxed, e, state.nodal, nodal)
        time = state.seen.time + s.length
        after = self.trailing(
            state, self.state(time, balance.gap, balance.depth, hold, surface, e, memory, rates)
        )
        error = (s.curvature * bend if state.rates.known else 0.0) if balance.stable else np.inf
        return Trial(after, error, balance.iterations, balance.released)

    def remeshed(self, state: State, nodes: npt.NDArray, hold: Hold) -> State | Balance:
        """Return the state on other nodes, or the balance that is none where it finds no other.

        Displacements are carried over, and the gaps are brought into balance again.
        """
        surface, law = self.contact.surface(nodes), self.contact.law
        old = state.surface.position

        def carried(fields: npt.NDArray) -> npt.NDArray:
            return CubicSpline(old, fields, axis=-1)(nodes)

        d = carried(state.memory.displacement)
        memory = Memory(d, d @ surface.stiffness)
        c = self.modes.instantaneous
        free = surface.rigid_gap + self.weights @ d
        guess = np.maximum(carried(state.gap), least_gap(self.contact.span))
        balance = descend(surface, law, free, c, guess, self.net(hold, state))
        if not balance.stable:
            return balance
        e = (balance.gap - free + balance.depth) / c
        rates = state.rates
        rates = replace(
            rates,
            relaxed=carried(rates.relaxed),
            gap=carried(rates.gap),
            followed=None if rates.followed is None else carried(rates.followed),
        )
        gap, depth = balance.gap, balance.depth
        return self.state(state.seen.time, gap, depth, hold, surface, e, memory, rates)

    def stopped(self, state: State, hold: Hold) -> State:
        """Return the state in the hold of another machine, nothing being in motion."""
        seen = state.seen
        drive, spring = _machine(hold, state.surface.unit, seen.depth, seen.force)
        return self.at_rest(replace(state, seen=replace(seen, drive=drive, spring=spring)))

    @staticmethod
    def at_rest(state: State) -> State:
        """Return the state without rates, where the last ones tell nothing of the next."""
        return replace(state, rates=_at_rest(state.gap))

    def trailing(self, before: State, after: State) -> State:
        """Return a state that remembers those before it."""
        passed = before.rates.trail or (self._passed(before),)
        passed = (*passed[1 - _TRAIL :], self._passed(after))
        return replace(after, rates=replace(after.rates, trail=passed))

    def _passed(self, state: State) -> Passed:
        memory, e, F = state.memory, state.relaxed, state.nodal
        each = np.einsum("ij,ij->i", e - memory.displacement, F - memory.force)
        heat = self.weights / np.asarray(self.modes.times) * each
        return Passed(state.seen, state.surface.unit * heat)

    def net(self, hold: Hold, state: State) -> Hold:
        """Return the hold less the force on the flank, which no node carries; it hardly changes."""
        if hold.rigid:
            return hold
        flank = state.surface.flank_force(self.contact.law, state.gap) / state.surface.unit
        return replace(hold, load=hold.load - flank)

    def state(
        self,
        time: float,
        gap: npt.NDArray,
        depth: float,
        hold: Hold,
        surface: Surface,
        relaxed: npt.NDArray,
        memory: Memory,
        rates: Rates,
    ) -> State:
        """Return the state at an instant, with what is to be seen of it."""
        law = self.contact.law
        nodal = surface.nodal(law, gap)
        instant = 0.5 * self.modes.instantaneous * float(relaxed @ nodal)
        force = surface.force(law, gap)
        drive, spring = _machine(hold, surface.unit, depth, force)
        seen = Snapshot(
            time=time,
            depth=depth,
            drive=drive,
            edge=surface.edge(gap, law.edge_gap),
            force=force,
            elastic=surface.unit * (instant + memory.stored(self.weights)),
            interface=surface.interface_energy(law, gap),
            spring=spring,
        )
        return State(seen, surface, gap, relaxed, nodal, memory, rates)


def _machine(hold: Hold, unit: float, depth: float, force: float) -> tuple[float, float]:
    """Return the depth of the drive [h0] and the energy of the spring [force times h0]."""
    if hold.rigid or hold.stiffness == 0:
        return depth, 0.0
    k = hold.stiffness * unit
    return depth + force / k, force * force / (2 * k)


def _at_rest(gap: npt.NDArray) -> Rates:
    zero = np.zeros_like(gap)
    return Rates(zero, 0.0, zero, known=False)


def _shifted(state: State, distance: float) -> npt.NDArray:
    """Return the gap as it would be if its profile moved outwards by a distance."""
    x = state.surface.position
    return np.interp(x - distance, x, state.gap)
