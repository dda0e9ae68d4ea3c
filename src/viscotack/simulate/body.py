r"""State of a soft body at one instant, and its change by a step, a jump or a new mesh.

**Internal variables of the solid: one displacement field per retardation mode.** The creep
compliance is a short sum of exponentials (:class:`viscotack.model.materials.Modes`), so that the
hereditary integral of Eq. 4.15 needs no stored history. Let e(t) be the displacement that the
present pressure would cause in the relaxed solid. Mode j follows :math:`\tau_j \dot d_j = e - d_j`,
and the surface displacement is :math:`u = c\, e + \sum_j w_j d_j` (c: instantaneous compliance). If
e is linear over a step dt, with :math:`x = dt/\tau` and :math:`\varphi = (1-e^{-x})/x`, then
exactly

.. math:: d^+ = e^{-x} d + (\varphi - e^{-x})\, e + (1-\varphi)\, e^+ .

The state variables are displacements, not stresses. Ahead of the crack, inside the contact, they
are smooth, so remeshing around the moving edge adds almost no error, even for k = 1e-4. The forces
z conjugate to d obey the same recursion and are stored for the energy balance. The heat of mode j
in a step is :math:`w_j \int (e-d_j)\cdot(F-z_j)\,dt/\tau_j`, integrated exactly.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import isnan
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack.model.materials import Modes
from viscotack.model.traction import grows
from viscotack.simulate.contacts.contact import Contact, Relaxed
from viscotack.simulate.equilibrium import Balance, descend, pressed_shut
from viscotack.simulate.growth import Contacted, Frozen, Opening, Stepped, bend, driven
from viscotack.simulate.history import Snapshot
from viscotack.simulate.machine import Hold
from viscotack.simulate.surface import Faces, Surface, least_gap, room


@dataclass(frozen=True, eq=False)
class Step:
    """The recursion of all modes for one step length.

    Attributes
    ----------
    compliance : float
        Displacement at the end of the step per unit of e there: c + sum w (1 - phi).
    decay : ndarray, shape (M,)
        exp(-x) of each mode.
    drive : ndarray, shape (M, 2)
        phi - exp(-x) and 1 - phi of each mode.
    curvature : float
        Displacement per unit deviation of e from linear; used by the step-size control.
    """

    weights: npt.NDArray
    times: npt.NDArray
    length: float
    compliance: float
    decay: npt.NDArray
    drive: npt.NDArray
    curvature: float

    def heat(self, start: npt.NDArray, mixed: npt.NDArray, ramp: float) -> npt.NDArray:
        """Return the heat of each mode from the products of fields over the nodes.

        With y = e - d and f = F - z at the start of the step, and the changes de and dF in it, they
        are y f and y dF, shape (M,), and de dF.
        """
        x = self.length / self.times
        # y(s) = y exp(-s) + v (1 - exp(-s)) with v = de/x; integrals of the three products
        one, two = -np.expm1(-x), -np.expm1(-2 * x) / 2
        # the last integral loses digits by cancellation for short steps; use its series there
        series = x**3 / 3 - x**4 / 4 + 7 * x**5 / 60
        square = np.where(x < 1e-3, series, x - one - one**2 / 2)
        return self.weights * (start * two + mixed / x * one**2 + ramp / x**2 * square)


def step(modes: Modes, length: float) -> Step:
    """Return the recursion for a step of this length [time units of the modes]."""
    w, tau = np.asarray(modes.weights), np.asarray(modes.times)
    x = length / tau
    decay = np.exp(-x)
    phi = -np.expm1(-x) / x
    return Step(
        weights=w,
        times=tau,
        length=length,
        compliance=modes.instantaneous + float(w @ (1 - phi)),
        decay=decay,
        drive=np.array([phi - decay, 1 - phi]).T,
        # A parabola of unit height over the step adds x/6 to a slow mode and 1/x to a fast one.
        curvature=float(w @ (x / (6 + x * x))),
    )


@dataclass(frozen=True, eq=False)
class Memory:
    """Displacement d and force z of every mode, shape (M, N)."""

    displacement: npt.NDArray
    force: npt.NDArray

    def inherited(self, s: Step, e: npt.NDArray) -> npt.NDArray:
        """Return the displacement at the end of a step due to the loading history alone."""
        return (s.weights * s.decay) @ self.displacement + float(s.weights @ s.drive[:, 0]) * e

    def advanced(self, s: Step, e: npt.NDArray, e1: npt.NDArray, F: npt.NDArray, F1: npt.NDArray):
        """Return the memory after a step in which e and F changed linearly to e1 and F1."""

        def recur(field: npt.NDArray, first: npt.NDArray, last: npt.NDArray) -> npt.NDArray:
            return s.decay[:, None] * field + s.drive @ np.array([first, last])

        return Memory(recur(self.displacement, e, e1), recur(self.force, F, F1))

    def heat(self, s: Step, e: npt.NDArray, e1: npt.NDArray, F: npt.NDArray, F1: npt.NDArray):
        """Return the heat dissipated by each mode in that step, shape (M,) [dg beta^2]."""
        y, f = e - self.displacement, F - self.force
        start, mixed = np.einsum("ij,ij->i", y, f), y @ (F1 - F)
        return s.heat(start, mixed, float((e1 - e) @ (F1 - F)))

    def stored(self, weights: npt.NDArray) -> float:
        """Return the elastic energy in the springs of the modes [dg beta^2]."""
        return 0.5 * float(weights @ np.einsum("ij,ij->i", self.displacement, self.force))


# The iterations of a step end when one reduces the energy by less than this fraction. The force is
# then accurate to 1e-7, and steps at large Tabor numbers take three times fewer iterations.
_LEAST_GAIN = 1e-10


# Number of previous instants stored for prediction.
_TRAIL = 4


@dataclass(frozen=True, eq=False)
class Passed:
    """Data of a past instant, used to predict the next one and to integrate over the steps.

    Attributes
    ----------
    seen : Snapshot
        Recorded quantities of the instant.
    heat : ndarray, shape (M,)
        Rate of heat of each mode [output force times h0 per time].
    """

    seen: Snapshot
    heat: npt.NDArray


@dataclass(frozen=True, eq=False)
class Rates:
    """Rates of change over the last step, used only to predict the next step.

    At rest the rates are zero and marked as unknown, so they are not used in the error estimate.
    """

    relaxed: npt.NDArray
    edge: float
    gap: npt.NDArray  # in the frame of the moving edge
    known: bool = True
    followed: npt.NDArray | None = None  # of e, in the frame of the moving edge


@dataclass(frozen=True, eq=False)
class Extra:
    """Additional traction of an interface that exceeds its law at rest, at one instant.

    Attributes
    ----------
    bonds : Opening or Contacted
        Opening speed of the gap, or time in contact.
    nodal : ndarray, shape (N,)
        Nodal forces in excess of the quasi-static ones, tension positive.
    flank : float
        Force on the flank in excess of the quasi-static one [output unit], tension positive.
    """

    bonds: Opening | Contacted
    nodal: npt.NDArray
    flank: float


@dataclass(frozen=True, eq=False)
class State:
    """Complete solver state at one instant: recorded quantities and data for the next step.

    `trail` holds the last few instants including this one; after a rest only this one.
    """

    seen: Snapshot
    surface: Surface
    gap: npt.NDArray
    relaxed: npt.NDArray  # e: displacement of the relaxed solid under this pressure
    nodal: npt.NDArray  # F: nodal forces
    memory: Memory
    rates: Rates
    trail: tuple[Passed, ...]
    extra: Extra | None = None  # None if the law depends on the gap alone


@dataclass(frozen=True, eq=False)
class Trial:
    """Result of a trial step: the state after it and its error estimate.

    `error` is the error of assuming a pressure linear in time, as a displacement [h0]. It is zero
    if the rates before the step are unknown, infinite if no stable equilibrium was found. `bend` is
    the relative change of the attraction due to the change of opening speeds in the step.
    """

    after: State
    error: float
    iterations: int
    released: bool
    bend: float = 0.0

    @property
    def lost(self) -> bool:
        """Whether no equilibrium was found and the contact was not released."""
        return not (np.isfinite(self.error) or self.released)


@dataclass(frozen=True, eq=False)
class Body:
    """Constant data of a run: the contact and the retardation modes of the solid.

    The traction law of the contact is that at rest. `growing` is the law itself if its tension
    grows with the opening speed or with the time in contact, otherwise None.
    """

    contact: Contact
    modes: Modes
    weights: npt.NDArray
    growing: Any = None

    @property
    def runs(self) -> bool:
        """Whether a crack that is unstable runs at a finite speed instead of jumping."""
        return grows(self.growing)

    @cached_property
    def times(self) -> npt.NDArray:
        """Retardation times of the modes."""
        return np.asarray(self.modes.times)

    def first(self, start: Relaxed) -> State:
        """Return the relaxed state, in which every mode is in equilibrium."""
        gap, surface = start.gap, start.surface
        bonds: Opening | Contacted | None = None
        if self.runs:
            bonds = Opening.none(gap)
        elif self.growing is not None:
            bonds = Contacted.relaxed(self.contact.law, self.growing, gap)
        if isinstance(bonds, Contacted):
            # the edge is where loading has left it; inside, old bonds hold the gap tighter
            free, hold = surface.rigid_gap, Hold(np.inf, depth=start.depth)
            gap = descend(surface, self.law(bonds), free, 1.0, gap, hold).gap
        e = gap - (surface.rigid_gap - start.depth)
        faces = surface.interface.at(self.law(bonds), gap)
        many = (len(self.weights), 1)
        memory = Memory(np.tile(e, many), np.tile(-faces.tension, many))
        edge, rates = surface.edge(gap, self.contact.law.edge_gap), _at_rest(gap)
        return self.state(0.0, start.depth, edge, surface, faces, e, memory, rates, bonds)

    def after(
        self, state: State, s: Step, hold: Hold, most_iterations: int, largest_gain: float
    ) -> Trial:
        """Advance the state by one trial time step; for `largest_gain` see `descend`."""
        surface, base = state.surface, self.contact.law
        bonds = None if state.extra is None else state.extra.bonds
        law: Any = base
        if bonds is not None:
            law = bonds.stepped(base, self.growing, state.gap, s.length)
        free = surface.rigid_gap + state.memory.inherited(s, state.relaxed)
        guess = _shifted(state, state.rates.edge * s.length) + s.length * state.rates.gap
        guess = np.maximum(guess, state.gap - 0.5 * room(state.gap, self.contact.span))
        machine, balance, speed = self.net(hold, state), None, None
        if isinstance(law, Stepped):
            balance, speed = driven(surface, law, free, s.compliance, guess, machine)
        if balance is None:
            balance = descend(
                surface,
                law,  # type: ignore[arg-type]
                free,
                s.compliance,
                guess,
                machine,
                least_gain=_LEAST_GAIN,
                largest_gain=largest_gain,
                most_iterations=most_iterations,
            )
        gap, faces, bent = balance.gap, balance.faces, 0.0
        if isinstance(law, Stepped):
            speed = law.speed(gap) if speed is None else speed
            bonds = law.opening(state.gap, speed, s.length)
            bent = bend(law, gap, bonds, surface.area)
            faces = surface.interface.at(self.law(bonds), gap)
        elif isinstance(bonds, Contacted):  # bonds that break now pull less from the next step on
            bonds = bonds.after(base, state.gap, gap, s.length)
        e = (gap - free + balance.depth) / s.compliance
        edge = surface.edge(gap, self.contact.law.edge_gap)
        moved = 0.0 if isnan(edge - state.seen.edge) else edge - state.seen.edge
        change = e - state.relaxed
        most = float(np.abs(change - s.length * state.rates.relaxed).max())
        rates = Rates(
            relaxed=change / s.length,
            edge=moved / s.length,
            gap=(gap - _shifted(state, moved)) / s.length,
        )
        memory = state.memory.advanced(s, state.relaxed, e, state.nodal, -faces.tension)
        time, depth = state.seen.time + s.length, balance.depth
        after = self.state(time, depth, edge, surface, faces, e, memory, rates, bonds, state.trail)
        error = (s.curvature * most if state.rates.known else 0.0) if balance.stable else np.inf
        return Trial(after, error, balance.iterations, balance.released, bent)

    def remeshed(self, state: State, nodes: npt.NDArray, hold: Hold) -> State | Balance:
        """Return the state on new nodes, or the unstable balance if no equilibrium was found.

        Displacements are interpolated to the new nodes; the gaps are then solved for again.
        """
        surface, old = self.contact.surface(nodes), state.surface.position

        def carried(fields: npt.NDArray) -> npt.NDArray:
            return CubicSpline(old, fields, axis=-1)(nodes)

        last, many = state.rates, len(self.weights)
        followed = () if last.followed is None else (last.followed,)
        fields = carried(
            np.vstack([state.memory.displacement, state.gap, last.relaxed, last.gap, *followed])
        )
        d = surface.free_beyond(old[-1], fields[:many])
        rates = replace(
            last,
            relaxed=fields[many + 1],
            gap=fields[many + 2],
            followed=fields[many + 3] if followed else None,
        )
        memory = Memory(d, d @ surface.stiffness)
        c = self.modes.instantaneous
        free = surface.rigid_gap + self.weights @ d
        guess = np.maximum(fields[many], least_gap(self.contact.span))
        bonds = None if state.extra is None else state.extra.bonds.carried(old, nodes)
        machine, balance, speed = self.net(hold, state), None, None
        law: Any = self.law(bonds)
        if isinstance(bonds, Opening) and bonds.length:
            # update speeds with the gaps: frozen speeds would give closing gaps the traction of
            # opening
            law = Stepped.again(self.contact.law, self.growing, guess, bonds)
            balance, speed = driven(surface, law, free, c, guess, machine)
        if balance is None:
            balance = descend(surface, law, free, c, guess, machine)
        if not balance.stable:
            return balance
        if isinstance(bonds, Opening) and bonds.length:
            speed = law.speed(balance.gap) if speed is None else speed
            bonds = replace(bonds, speed=speed)
        gap, depth = balance.gap, balance.depth
        e = (gap - free + depth) / c
        edge = surface.edge(gap, self.contact.law.edge_gap)
        faces = balance.faces if bonds is None else surface.interface.at(self.law(bonds), gap)
        time = state.seen.time
        moved = self.state(time, depth, edge, surface, faces, e, memory, rates, bonds)
        return replace(moved, trail=state.trail) if len(state.trail) > 1 else moved

    def law(self, bonds: Opening | Contacted | None) -> Any:
        """Return the law with opening speeds or contact times frozen; None for the law at rest."""
        if bonds is None:
            return self.contact.law
        return Frozen(self.contact.law, bonds.factor(self.growing))

    def transferred(self, before: State, after: State) -> float:
        """Return the heat in an interface that ages when its gaps are balanced on other nodes."""
        if after.extra is None or not isinstance(after.extra.bonds, Contacted):
            return 0.0
        gap = CubicSpline(before.surface.position, before.gap)(after.surface.position)
        heat = after.extra.bonds.heat(self.contact.law, self.growing, gap, after.gap, 0.0)
        return after.surface.unit * float(after.surface.area @ heat)

    def friction(self, before: State, after: State) -> float:
        """Return the heat in the interface over a step, 0 if the law depends on the gap alone."""
        if before.extra is None or after.extra is None:
            return 0.0
        bonds, surface, gap = before.extra.bonds, before.surface, before.gap
        if isinstance(bonds, Contacted):
            length = after.seen.time - before.seen.time
            heat = bonds.heat(self.contact.law, self.growing, gap, after.gap, length)
            return surface.unit * float(surface.area @ heat)
        nodal = 0.5 * (before.extra.nodal + after.extra.nodal)
        flank = 0.5 * (before.extra.flank + after.extra.flank)
        lifted = before.seen.depth - after.seen.depth
        return surface.unit * float(nodal @ (after.gap - gap)) + flank * lifted

    def pressed(self, state: State) -> float:
        """Return the pressure [dg/h0] where a search has closed the gap completely, 0 if open."""
        return pressed_shut(state.surface, state.gap, state.relaxed)

    def at_rest(self, state: State) -> State:
        """Return the state with rates reset, where the previous rates do not apply."""
        extra = state.extra
        if extra is not None:
            extra = replace(extra, bonds=extra.bonds.forgotten())
        passed = self._passed(state.seen, state.surface, state.relaxed, state.nodal, state.memory)
        return replace(state, rates=_at_rest(state.gap), trail=(passed,), extra=extra)

    def _passed(
        self, seen: Snapshot, surface: Surface, e: npt.NDArray, F: npt.NDArray, memory: Memory
    ) -> Passed:
        each = np.einsum("ij,ij->i", e - memory.displacement, F - memory.force)
        return Passed(seen, surface.unit * (self.weights / self.times * each))

    def net(self, hold: Hold, state: State) -> Hold:
        """Return the hold minus the flank force, which is not on any node and changes slowly."""
        if hold.rigid:
            return hold
        law = self.law(None if state.extra is None else state.extra.bonds)
        flank = state.surface.flank_force(law, state.gap) / state.surface.unit
        return replace(hold, load=hold.load - flank)

    def state(
        self,
        time: float,
        depth: float,
        edge: float,
        surface: Surface,
        faces: Faces,
        relaxed: npt.NDArray,
        memory: Memory,
        rates: Rates,
        bonds: Opening | Contacted | None,
        before: tuple[Passed, ...] = (),
    ) -> State:
        """Assemble the state at an instant with its recorded quantities and the earlier trail."""
        law, gap, nodal = self.law(bonds), faces.gap, -faces.tension
        resting, extra, at_rest = faces, None, self.contact.law
        if bonds is not None:
            resting = surface.interface.at(at_rest, gap)
            flank = surface.flank_force(at_rest, gap) - surface.flank_force(law, gap)
            extra = Extra(bonds, faces.tension - resting.tension, flank)
        instant = 0.5 * self.modes.instantaneous * float(relaxed @ nodal)
        seen = Snapshot(
            time=time,
            depth=depth,
            edge=edge,
            force=surface.unit * float(nodal.sum()) + surface.flank_force(law, gap),
            elastic=surface.unit * (instant + memory.stored(self.weights)),
            interface=surface.unit * resting.energy + surface.flank_energy(at_rest, gap),
            inner=surface.inner_edges(gap, at_rest.edge_gap),
        )
        trail = (*before[1 - _TRAIL :], self._passed(seen, surface, relaxed, nodal, memory))
        return State(seen, surface, gap, relaxed, nodal, memory, rates, trail, extra)


def _at_rest(gap: npt.NDArray) -> Rates:
    zero = np.zeros_like(gap)
    return Rates(zero, 0.0, zero, known=False)


def _shifted(state: State, distance: float) -> npt.NDArray:
    """Return the gap with its profile shifted outwards by a distance."""
    x = state.surface.position
    return np.interp(x - distance, x, state.gap)
