"""A soft body at one instant, and what a step, a jump or a new mesh makes of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack.bem.books import Snapshot
from viscotack.bem.contacts.contact import Contact, Relaxed
from viscotack.bem.equilibrium import Balance, descend
from viscotack.bem.growth import Frozen, Opening, Stepped, bend, driven
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
class Extra:
    """What an interface that grows with the opening speed adds at an instant.

    Attributes
    ----------
    opening : Opening
        How fast the gap opens.
    nodal : ndarray, shape (N,)
        Nodal forces beyond those at rest, tension positive.
    flank : float
        Force beyond that at rest on the flank [output unit], tension positive.
    """

    opening: Opening
    nodal: npt.NDArray
    flank: float


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
    extra: Extra | None = None  # None where the law is one of the gap alone


@dataclass(frozen=True, eq=False)
class Trial:
    """A step that was tried: the state after it, and how good it is.

    The error is that of a pressure linear in time, as a displacement [h0]; zero where the rates
    before the step are not known, infinite where no stable equilibrium was found. The bend says
    by which part opening speeds that change in the step change the attraction.
    """

    after: State
    error: float
    iterations: int
    released: bool
    bend: float = 0.0

    @property
    def lost(self) -> bool:
        """Whether iterations ran out, nothing else being known."""
        return not (np.isfinite(self.error) or self.released)


@dataclass(frozen=True, eq=False)
class Body:
    """What stays the same during a run: the contact and the modes of its solid.

    The law of the contact is the one at rest; `growing` is it where it grows with the opening
    speed, else None.
    """

    contact: Contact
    modes: Modes
    weights: npt.NDArray
    growing: Any = None

    def first(self, start: Relaxed) -> State:
        """Return the relaxed state: every mode has come to rest."""
        gap, surface = start.gap, start.surface
        e = gap - (surface.rigid_gap - start.depth)
        nodal = surface.nodal(self.contact.law, gap)
        many = (len(self.weights), 1)
        memory = Memory(np.tile(e, many), np.tile(nodal, many))
        opening = None if self.growing is None else Opening.none(gap)
        rates = _at_rest(gap)
        return self.state(0.0, gap, start.depth, surface, e, memory, rates, opening)

    def after(self, state: State, s: Step, hold: Hold, most_iterations: int) -> Trial:
        """Return what a step leads to."""
        surface, stepped = state.surface, None
        law: Any = self.contact.law
        if state.extra is not None:
            before = state.extra.opening
            law = stepped = Stepped.of(law, self.growing, state.gap, before, s.length)
        free = surface.rigid_gap + state.memory.inherited(s, state.relaxed)
        guess = _shifted(state, state.rates.edge * s.length) + s.length * state.rates.gap
        guess = np.maximum(guess, state.gap - 0.5 * room(state.gap, self.contact.span))
        machine, balance, speed = self.net(hold, state), None, None
        if stepped is not None:
            balance, speed = driven(surface, stepped, free, s.compliance, guess, machine)
        if balance is None:
            balance = descend(
                surface,
                law,
                free,
                s.compliance,
                guess,
                machine,
                least_gain=_LEAST_GAIN,
                most_iterations=most_iterations,
            )
        gap = balance.gap
        e = (gap - free + balance.depth) / s.compliance
        nodal = surface.nodal(law, gap)
        moved = surface.edge(gap, self.contact.law.edge_gap) - state.seen.edge
        moved = 0.0 if np.isnan(moved) else moved
        change = e - state.relaxed
        most = float(np.max(np.abs(change - s.length * state.rates.relaxed)))
        rates = Rates(
            relaxed=change / s.length,
            edge=moved / s.length,
            gap=(gap - _shifted(state, moved)) / s.length,
        )
        memory = state.memory.advanced(s, state.relaxed, e, state.nodal, nodal)
        time = state.seen.time + s.length
        opening, bent = None, 0.0
        if stepped is not None:
            speed = stepped.speed(gap) if speed is None else speed
            opening = stepped.opening(state.gap, speed, s.length)
            bent = bend(stepped, gap, opening, surface.area)
        after = self.trailing(
            state, self.state(time, gap, balance.depth, surface, e, memory, rates, opening)
        )
        error = (s.curvature * most if state.rates.known else 0.0) if balance.stable else np.inf
        return Trial(after, error, balance.iterations, balance.released, bent)

    def remeshed(self, state: State, nodes: npt.NDArray, hold: Hold) -> State | Balance:
        """Return the state on other nodes, or the balance that is none where it finds no other.

        Displacements are carried over, and the gaps are brought into balance again.
        """
        surface, old = self.contact.surface(nodes), state.surface.position

        def carried(fields: npt.NDArray) -> npt.NDArray:
            return CubicSpline(old, fields, axis=-1)(nodes)

        d = surface.free_beyond(old[-1], carried(state.memory.displacement))
        memory = Memory(d, d @ surface.stiffness)
        c = self.modes.instantaneous
        free = surface.rigid_gap + self.weights @ d
        guess = np.maximum(carried(state.gap), least_gap(self.contact.span))
        opening = None if state.extra is None else state.extra.opening.carried(carried)
        machine, balance, speed = self.net(hold, state), None, None
        law: Any = self.law(opening)
        if opening is not None and opening.length:
            # speeds must change with the gaps: frozen ones attract what closes as if it opened
            law = Stepped.again(self.contact.law, self.growing, guess, opening)
            balance, speed = driven(surface, law, free, c, guess, machine)
        if balance is None:
            balance = descend(surface, law, free, c, guess, machine)
        if not balance.stable:
            return balance
        if opening is not None and opening.length:
            speed = law.speed(balance.gap) if speed is None else speed
            opening = replace(opening, speed=speed)
        e = (balance.gap - free + balance.depth) / c
        rates = state.rates
        rates = replace(
            rates,
            relaxed=carried(rates.relaxed),
            gap=carried(rates.gap),
            followed=None if rates.followed is None else carried(rates.followed),
        )
        gap, depth = balance.gap, balance.depth
        return self.state(state.seen.time, gap, depth, surface, e, memory, rates, opening)

    def law(self, opening: Opening | None) -> Any:
        """Return the law at opening speeds, frozen; None for the law at rest."""
        if opening is None:
            return self.contact.law
        return Frozen(self.contact.law, 1 + self.growing.growth(opening.speed))

    @staticmethod
    def at_rest(state: State) -> State:
        """Return the state without rates, where the last ones tell nothing of the next."""
        extra = state.extra
        if extra is not None:
            extra = replace(extra, opening=extra.opening.forgotten())
        return replace(state, rates=_at_rest(state.gap), extra=extra)

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
        law = self.law(None if state.extra is None else state.extra.opening)
        flank = state.surface.flank_force(law, state.gap) / state.surface.unit
        return replace(hold, load=hold.load - flank)

    def state(
        self,
        time: float,
        gap: npt.NDArray,
        depth: float,
        surface: Surface,
        relaxed: npt.NDArray,
        memory: Memory,
        rates: Rates,
        opening: Opening | None,
    ) -> State:
        """Return the state at an instant, with what is to be seen of it."""
        law, at_rest = self.law(opening), self.contact.law
        nodal = surface.nodal(law, gap)
        instant = 0.5 * self.modes.instantaneous * float(relaxed @ nodal)
        seen = Snapshot(
            time=time,
            depth=depth,
            edge=surface.edge(gap, at_rest.edge_gap),
            force=surface.force(law, gap),
            elastic=surface.unit * (instant + memory.stored(self.weights)),
            interface=surface.interface_energy(at_rest, gap),
            inner=surface.inner_edges(gap, at_rest.edge_gap),
        )
        extra = None
        if opening is not None:
            flank = surface.flank_force(at_rest, gap) - surface.flank_force(law, gap)
            extra = Extra(opening, surface.nodal(at_rest, gap) - nodal, flank)
        return State(seen, surface, gap, relaxed, nodal, memory, rates, extra)


def _at_rest(gap: npt.NDArray) -> Rates:
    zero = np.zeros_like(gap)
    return Rates(zero, 0.0, zero, known=False)


def _shifted(state: State, distance: float) -> npt.NDArray:
    """Return the gap as it would be if its profile moved outwards by a distance."""
    x = state.surface.position
    return np.interp(x - distance, x, state.gap)
