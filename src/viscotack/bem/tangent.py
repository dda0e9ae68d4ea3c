r"""Derivatives of a simulation by its inputs, from the linearised steps of its time integration.

The march is differentiated step by step, with its time steps and the path of its edge frozen. At
the end of a step the nodal forces S e of the solid balance the tensions T(g) of the interface, with
:math:`g = b + c\,e + \sum_j w_j d_j - \delta` (:mod:`.memory`). A dot being the derivative by an
input at fixed time,

.. math::

    S \dot e + \dot S e + T' \dot g + \dot T = 0, \qquad
    \dot g = \dot b + \dot c\, e + c\,\dot e + \sum_j (\dot w_j d_j + w_j \dot d_j) - \dot\delta

is linear in :math:`\dot e`, with the matrix of Newton's method: one factorisation per accepted step
and one back-substitution per input. The modes follow the recursion of the step, in the frame of the
solid or of the crack (:mod:`.frame`). What the input changes directly (:math:`\dot S, \dot T,
\dot b`, the legs of the machine, the modes) is a central difference of the dimensionless problem,
without a simulation. Where a leg of the machine ends at another time, the state is moved by its
rate times the change of that time.

Nodes are frozen up to their unit of length, which follows the edge of the relaxed start: the edge
then starts at the same place between the nodes, as it does in a simulation of the other input. With
nodes that stay in place, the memory of the start would have an error of first order in the small
error of the nodes over their distance. For the same reason one more direction is carried along, in
which nothing changes but the length of the time steps (:func:`null_direction`); the outputs are
computed with as much of it as keeps the edge at its place between the nodes later
(:mod:`viscotack.result.sensitivities`).

Frozen steps leave out how an input changes the discretisation error. A jump moves with the input,
which is not part of these equations: derivatives after it are not meaningful.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack.bem.body import Body, State
from viscotack.bem.books import Snapshot
from viscotack.bem.contacts.contact import Contact
from viscotack.bem.equilibrium import elastic_energy, factored, solved
from viscotack.bem.frame import Balancing, Tangent, path_recursion
from viscotack.bem.interface import Band
from viscotack.bem.machine import Hold, Leg
from viscotack.bem.memory import Step
from viscotack.bem.origin import ByNodes, ByStep, ByTravel
from viscotack.bem.place import Place
from viscotack.bem.surface import Surface
from viscotack.geometry import HalfSpace
from viscotack.materials import Material, Modes
from viscotack.protocol import Apart, AtDepth, AtForce, Start

# Times at which the creep of the modes is compared with that of the solid, per decade.
_PER_DECADE = 20
# Relative size below which combinations of modes are left out, and the largest part of the change
# of the creep that the modes may miss.
_RANK, _MISSED = 1e-9, 0.02
# Relative change of the times of modes in central differences.
_TINY = 1e-5
# Tolerance within which a leg has ended by its duration, relative.
_TIMED = 1e-6


class Unstable(ArithmeticError):
    """The linearised equilibrium is singular: the state is at the end of its branch."""


@dataclass(frozen=True, eq=False)
class Direction:
    """What an input changes in a march: two versions of it, beside the march itself.

    Attributes
    ----------
    step : float
        Difference of the logarithms of the input in the two versions.
    contacts, legs, starts : pair
        Contact, legs and start for the smaller and the larger input.
    instantaneous, weights, times : float, ndarray (M,), ndarray (M,)
        Derivatives of the modes, that of the times by their logarithm.
    null : bool
        Whether nothing changes but the time steps (:func:`null_direction`).
    """

    step: float
    contacts: tuple[Contact, Contact]
    legs: tuple[tuple[Leg, ...], tuple[Leg, ...]]
    starts: tuple[Start | Apart, Start | Apart]
    instantaneous: float
    weights: npt.NDArray
    times: npt.NDArray
    null: bool = False

    def slope(self, low: Any, high: Any) -> Any:
        """Return the derivative by the logarithm of the input, from the values of both versions."""
        return (high - low) / self.step


def null_direction(
    contact: Contact, legs: tuple[Leg, ...], start: Start | Apart, modes: Modes
) -> Direction:
    """Return the direction along the curve: longer time steps in the last leg, no change of input.

    The curve is the same, and each of its points moves along it; any difference is an error of the
    nodes, between which the edge moves, and of the time steps.
    """
    none = np.zeros(len(modes.times))
    pairs = (contact, contact), (legs, legs), (start, start)
    return Direction(1.0, *pairs, 0.0, none, none, null=True)


def mode_slopes(
    modes: Modes, solids: tuple[Material, Material], step: float, window: tuple[float, float]
) -> tuple[float, npt.NDArray, npt.NDArray]:
    """Return the derivatives of c, w and ln(tau) that change the creep as the solid does.

    They are a least-squares fit to the difference of the creep of two solids over a window of time.
    The relaxed compliance, 1, does not change.

    Raises
    ------
    ArithmeticError
        If the modes of the march cannot follow the change of the creep.
    """
    w, tau = np.asarray(modes.weights), np.asarray(modes.times)
    none = np.zeros_like(w)
    if solids[0] == solids[1]:
        return 0.0, none, none
    decades = np.log10(window[1] / window[0])
    t = np.geomspace(*window, 2 + int(_PER_DECADE * decades))
    change = (np.asarray(solids[1].creep(t)) - np.asarray(solids[0].creep(t))) / step
    x = t[:, None] / tau
    decay = np.exp(-x)
    columns = np.hstack([-decay, -w * x * decay])
    found = np.linalg.lstsq(columns, change, rcond=_RANK)[0]
    missed = np.max(np.abs(columns @ found - change), initial=0.0)
    if missed > _MISSED * np.max(np.abs(change), initial=0.0) + 1e-9:
        raise ArithmeticError(
            "the retardation modes of the simulation cannot follow the change of the creep"
        )
    return -float(found[: len(w)].sum()), found[: len(w)], found[len(w) :]


@dataclass(frozen=True, eq=False)
class _Shape:
    """Derivatives of a surface by the inputs."""

    surfaces: dict[int, tuple[Surface, Surface]]
    rigid_gap: npt.NDArray  # (P, N)
    unit: npt.NDArray  # (P,)
    flank: npt.NDArray  # (P,)
    harder: npt.NDArray  # (P,), of ln S where S changes by a factor
    stiffer: dict[int, npt.NDArray]  # of S where it does not
    stretched: tuple[npt.NDArray, float, float, npt.NDArray | None]  # see `_stretch_of`


@dataclass(eq=False)
class Now:
    """Derivatives at one instant: of e, of every mode, and of the recorded quantities."""

    relaxed: npt.NDArray  # (P, N)
    modes: npt.NDArray  # (P, M, N)
    depth: npt.NDArray  # (P,)
    force: npt.NDArray
    edge: npt.NDArray
    time: npt.NDArray


@dataclass(eq=False)
class Tangents:
    """The derivatives of a march, carried along with it.

    Attributes
    ----------
    rows : list of ndarray, shape (4, P)
        Derivatives of time, depth, force and edge at every recorded step.
    reason : str
        Why there are no derivatives from some step on; empty where there are.
    moved_nodes : ndarray, shape (P,)
        Derivatives of the logarithm of the unit of length of the nodes.
    """

    body: Body
    directions: list[Direction]
    rows: list[npt.NDArray] = field(default_factory=list)
    reason: str = ""

    def __post_init__(self) -> None:
        each = self.directions
        self._c = np.array([d.instantaneous for d in each])
        self._w = np.array([d.weights for d in each]).reshape(len(each), -1)
        self._tau = np.array([d.times for d in each]).reshape(len(each), -1)
        self._tau_or_step = self._tau
        self._null = np.array([d.null for d in each])
        self._shape: tuple[Surface, _Shape] | None = None
        laws = ((i, tuple(c.law for c in d.contacts)) for i, d in enumerate(each))
        self._laws = {i: (low, high) for i, (low, high) in laws if low != high}
        self._changed_law: tuple[State | None, dict[int, npt.NDArray]] = None, {}
        gaps = [d.slope(*(c.law.edge_gap for c in d.contacts)) for d in each]
        self._edge_gap = np.array(gaps)
        self.moved_nodes = np.zeros(len(each))

    def kept(self, at: Place) -> None:
        """Carry the derivatives on to a recorded state, through all that led to it."""
        if self.reason:
            return
        try:
            if not self.rows:
                self._begin(at)
            else:
                self._follow(at)
        except (Unstable, np.linalg.LinAlgError):
            self.reason = "the contact is at the end of a stable branch"
            return
        self._record()

    def begun(self, at: Place) -> None:
        """Attach the next leg of the machine in the present state.

        The leg before it may end at another time; the state then changes by its rate.
        """
        if self.reason:
            return
        try:
            self._follow(at)
            if at.number:
                self._end_leg(at)
        except (Unstable, np.linalg.LinAlgError):
            self.reason = "the contact is at the end of a stable branch"
            return
        now = self.now
        self._leg, self._began = at.leg, at.seen
        self._from = now.depth.copy(), now.force.copy()
        self._slopes = self._leg_slopes(at.number)
        self.stretch = self._stretched(at.number)
        self._tau_or_step = self._tau - self.stretch[:, None]

    # -- what led to a state

    def _follow(self, at: Place) -> None:
        state, chain = at.state, []
        while state.origin is not None and state.origin.before is not None:
            chain.append(state)
            state = state.origin.before
        for state in reversed(chain):
            origin = state.origin
            match origin:
                case ByNodes():
                    self._onto_nodes(origin.before, state)
                case ByStep():
                    self._step(origin.before, state, origin.step)
                case ByTravel():
                    self._travel(origin.before, state, origin)
            origin.before = None  # the past is not needed again

    def _begin(self, at: Place) -> None:
        state, n = at.state, len(self.directions)
        self.start = state
        many, nodes = len(self.body.weights), len(state.gap)
        zero = np.zeros(n)
        self.now = Now(np.zeros((n, nodes)), np.zeros((n, many, nodes)), zero, zero, zero, zero)
        shape = self._of(state.surface)
        starts = [
            d.slope(*(_value_of(x, c) for x, c in zip(d.starts, d.contacts, strict=True)))
            for d in self.directions
        ]
        start, value = self.directions[0].starts[0], np.array(starts)
        if isinstance(start, AtForce):
            machine = _Machine(0.0, value)
        elif isinstance(start, AtDepth | Apart):
            machine = _Machine(np.inf, value)
        else:
            machine = self._at_edge(state, shape.rigid_gap, value)
        gap, depth = self._balanced(state, 1.0, shape.rigid_gap, machine)
        if np.isfinite(state.seen.edge) and state.seen.edge > 0:
            self.moved_nodes, self._shape = self.now.edge / state.seen.edge, None
            shape = self._of(state.surface)
            if not isinstance(start, AtForce | AtDepth | Apart):
                machine = self._at_edge(state, shape.rigid_gap, value)
            gap, depth = self._balanced(state, 1.0, shape.rigid_gap, machine)
        self.now.relaxed = gap - shape.rigid_gap + depth[:, None]
        self.now.modes = np.repeat(self.now.relaxed[:, None], many, axis=1)
        self._leg, self._began = at.leg, at.seen

    def _at_edge(self, state: State, known: npt.NDArray, edge: npt.NDArray) -> _Machine:
        """Return the machine that holds the depth at which the edge is where it must be."""
        n = len(edge)
        still, _ = self._balanced(state, 1.0, known, _Machine(np.inf, np.zeros(n)))
        self.now.depth = np.ones(n)
        deeper, _ = self._balanced(state, 1.0, known, _Machine(np.inf, np.ones(n)))
        zero, one = (self._edge(state, gap) for gap in (still, deeper))
        return _Machine(np.inf, (edge - zero) / (one - zero))

    def _step(self, before: State, state: State, s: Step) -> None:
        """Carry the derivatives through a step in the frame of the solid."""
        now, known = self.now, self.now.modes
        known *= s.decay[:, None]
        known += s.drive[:, 0, None] * now.relaxed[:, None]
        now.time = now.time + self.stretch * s.length
        if (timed := self._timed).size:
            way = -s.length / s.times * self._tau_or_step[timed]
            e0, e1, d = before.relaxed, state.relaxed, before.memory.displacement
            decay = -s.decay * way
            mean = (s.decay - 1 + s.drive[:, 1]) / (s.length / s.times) * way
            more = decay[:, :, None] * d
            more += np.stack([mean - decay, -mean], axis=2) @ np.array([e0, e1])
            known[timed] += more
        gap, depth = self._changed_gap(state, s.compliance, known)
        now.relaxed = (gap + depth[:, None] - self._given) / s.compliance
        known += s.drive[:, 1, None] * now.relaxed[:, None]

    def _travel(self, before: State, state: State, origin: ByTravel) -> None:
        """Carry the derivatives through a step in the frame of the crack."""
        passage, way, now, modes = origin.passage, origin.way, self.now, self.body.modes
        nodes, old = state.surface.position, before.surface
        theta = passage.theta
        shifts = np.outer(way.from_begin(theta), origin.moves)
        path = CubicSpline(old.position, now.relaxed, axis=1)(nodes + shifts)
        path *= (1 - theta)[:, None]
        d = self._carried(old, state.surface, now.modes)
        known = passage.decay[:, None] * d + passage.weights @ path
        now.time = now.time + self.stretch * origin.length
        if (timed := self._timed).size:
            whole = passage.old + theta[:, None] * passage.interpolated(state.relaxed)
            x = origin.length / self.body.times
            for i in timed:
                some = _TINY * self._tau_or_step[i]
                up, down = (
                    path_recursion(self.body.times * np.exp(sign * some), origin.length, theta)[1]
                    for sign in (1, -1)
                )
                known[i] += (passage.decay * x * self._tau_or_step[i])[:, None] * origin.modes
                known[i] += (up - down) / (2 * _TINY) @ whole
        given = self._given_gap(state, known)
        C = passage.compliance(modes)
        surface, law = state.surface, self.body.contact.law
        face = surface.interface.at(law, state.gap)
        free = Hold(np.inf)
        tangent = Tangent.of(face, Balancing(surface, law, C, surface.rigid_gap, free))
        if tangent is None or tangent.negative:
            raise Unstable
        band, load = face.tangent(), self._load(state)
        right = np.vstack([-load - _times(band, given), _times(band, np.ones((1, len(nodes))))])
        e = tangent.solved(right.T).T
        still, deeper = e[:-1] @ C.T + given, (C @ e[-1] - 1)[None]
        depth = self._placed(state, band, still, deeper, None)
        now.relaxed = e[:-1] + depth[:, None] * e[-1]
        gap = still + depth[:, None] * deeper
        new = np.stack([passage.interpolated(each) for each in now.relaxed])
        now.modes = known + passage.weights @ (theta[:, None] * new)
        self._note(state, band, gap, depth)

    def _onto_nodes(self, before: State, state: State) -> None:
        """Carry the derivatives onto other nodes, on which the state was balanced again."""
        now = self.now
        now.modes = self._carried(before.surface, state.surface, now.modes)
        now.relaxed = np.zeros((len(now.relaxed), len(state.gap)))
        c = self.body.modes.instantaneous
        gap, depth = self._changed_gap(state, c, now.modes)
        now.relaxed = (gap + depth[:, None] - self._given) / c

    def _carried(self, old: Surface, new: Surface, modes: npt.NDArray) -> npt.NDArray:
        if old is new or not modes.size:
            return modes if old is new else np.zeros((*modes.shape[:2], len(new.position)))
        n, many, _ = modes.shape
        d = CubicSpline(old.position, modes.reshape(n * many, -1), axis=1)(new.position)
        return new.free_beyond(old.position[-1], d).reshape(n, many, -1)

    def _end_leg(self, at: Place) -> None:
        """Move the derivatives from the recorded end of a leg to where the leg ends now."""
        state, now, leg = at.state, self.now, self._leg
        e, d, c = state.relaxed, state.memory.displacement, self.body.modes.instantaneous
        rates = (e - d) / self.body.times[:, None]
        band, given = self._band(state), (self.body.weights @ rates)[None]
        still, deeper = _responses(state, c, given, np.zeros_like(given), band, deeper=True)
        machine = _Machine(*_drift(leg))
        force, per_depth = (_force_of(state, band, self.body, x) for x in (still, deeper))
        depth = machine.depth(force, float(per_depth[0]))
        gap = still + depth[:, None] * deeper
        flow = {
            "relaxed": (gap[0] - given[0] + depth) / c,
            "depth": depth[0],
            "force": _force_of(state, band, self.body, gap)[0],
            "edge": _moved_edge(state, gap)[0][0],
        }
        late = self._later(at, flow)
        now.relaxed = now.relaxed + np.outer(late, flow["relaxed"])
        now.modes = now.modes + late[:, None, None] * rates
        now.depth, now.force = now.depth + late * flow["depth"], now.force + late * flow["force"]
        now.edge, now.time = now.edge + late * flow["edge"], now.time + late
        self.rows[-1] = np.array([now.time, now.depth, now.force, now.edge])

    def _later(self, at: Place, flow: dict[str, Any]) -> npt.NDArray:
        """Return the derivatives of the duration of the leg that has ended."""
        leg, seen, slopes = self._leg, at.seen, self._slopes
        elapsed = seen.time - self._began.time
        if np.isfinite(leg.duration) and elapsed >= leg.duration * (1 - _TIMED):
            return slopes["duration"] - self.stretch * elapsed
        ends = [name for name in ("depth", "force", "edge") if not np.isnan(getattr(leg, name))]
        name = min(ends, key=lambda x: abs(getattr(leg, x) - getattr(seen, x)))
        return (slopes[name] - getattr(self.now, name)) / flow[name]

    # -- equilibrium

    def _changed_gap(
        self, state: State, compliance: float, modes: npt.NDArray
    ) -> tuple[npt.NDArray, npt.NDArray]:
        """Return the derivatives of gap and depth, for those of the modes without the new e."""
        self._given = self._given_gap(state, modes)
        return self._balanced(state, compliance, self._given, None)

    def _given_gap(self, state: State, modes: npt.NDArray) -> npt.NDArray:
        """Return the derivatives of the gap at fixed depth and fixed e."""
        shape = self._of(state.surface)
        given = shape.rigid_gap + np.outer(self._c, state.relaxed)
        if self.body.weights.size:
            given += self._w @ state.memory.displacement + self.body.weights @ modes
        return given

    def _balanced(
        self, state: State, compliance: float, given: npt.NDArray, machine: _Machine | None
    ) -> tuple[npt.NDArray, npt.NDArray]:
        """Return the derivatives of gap and depth for those of the free gap."""
        band, machine = self._band(state), machine or self._machine(state.seen)
        load = self._load(state)
        if np.isinf(machine.stiffness):
            depth = machine.value
            gap, _ = _responses(state, compliance, given - depth[:, None], load, band)
        else:
            still, deeper = _responses(state, compliance, given, load, band, deeper=True)
            depth = self._placed(state, band, still, deeper, machine)
            gap = still + depth[:, None] * deeper
        self._note(state, band, gap, depth)
        return gap, depth

    def _band(self, state: State) -> Band:
        faces = getattr(state.origin, "faces", None)
        if faces is None:
            faces = state.surface.interface.at(self.body.contact.law, state.gap)
        return faces.tangent()

    def _placed(
        self,
        state: State,
        band: Band,
        still: npt.NDArray,
        deeper: npt.NDArray,
        machine: _Machine | None,
    ) -> npt.NDArray:
        """Return the derivatives of the depth, from gaps at fixed depth and per unit of depth."""
        machine = self._machine(state.seen) if machine is None else machine
        if np.isinf(machine.stiffness):
            return machine.value
        force = _force_of(state, band, self.body, still) + self._explicit_force(state)
        return machine.depth(force, float(_force_of(state, band, self.body, deeper)[0]))

    def _note(self, state: State, band: Band, gap: npt.NDArray, depth: npt.NDArray) -> None:
        """Store the derivatives of the recorded quantities."""
        now = self.now
        force = _force_of(state, band, self.body, gap)
        now.depth, now.force = depth, force + self._explicit_force(state)
        now.edge = self._edge(state, gap)

    def _edge(self, state: State, gap: npt.NDArray) -> npt.NDArray:
        own, slope = _moved_edge(state, gap)
        return own + self._edge_gap / slope + self.moved_nodes * state.seen.edge

    def _load(self, state: State) -> npt.NDArray:
        """Return the derivatives of the unbalanced forces at fixed gap and fixed e."""
        shape, e = self._of(state.surface), state.relaxed
        nodal, S = state.nodal, shape.stretched[3]
        area = (nodal if S is None else S @ e) - 2 * nodal
        found = np.outer(shape.harder, nodal) + np.outer(self.moved_nodes, area)
        for i, stiffness in shape.stiffer.items():
            found[i] += stiffness @ e
        for i, tension in self._tensions(state).items():
            found[i] += tension
        return found

    def _tensions(self, state: State) -> dict[int, npt.NDArray]:
        """Return the derivatives of the nodal forces by the inputs of the law, at fixed gaps."""
        if self._changed_law[0] is not state:
            shape, found = self._of(state.surface), {}
            for i, pair in self._laws.items():
                low, high = (
                    s.interface.at(law, state.gap).tension
                    for s, law in zip(shape.surfaces[i], pair, strict=True)
                )
                found[i] = self.directions[i].slope(low, high)
            self._changed_law = state, found
        return self._changed_law[1]

    def _explicit_force(self, state: State) -> npt.NDArray:
        """Return the derivatives of the force at fixed gap."""
        shape, surface, gap = self._of(state.surface), state.surface, state.gap
        whole = float(state.nodal.sum())
        found = shape.unit * whole + self.moved_nodes * (2 * surface.unit * whole)
        if shape.flank.any():
            found += shape.flank * float(self.body.contact.law.energy(gap[-1]))
        for i, tension in self._tensions(state).items():
            found[i] -= surface.unit * float(tension.sum())
            if surface.flank:
                forces = (surface.flank_force(law, gap) for law in self._laws[i])
                found[i] += self.directions[i].slope(*forces)
        return found

    def _of(self, surface: Surface) -> _Shape:
        """Return the derivatives of a surface, computed once for each set of nodes."""
        if self._shape is None or self._shape[0] is not surface:
            self._shape = surface, self._shape_of(surface)
        return self._shape[1]

    def _shape_of(self, surface: Surface) -> _Shape:
        x, contact, n = surface.position, self.body.contact, len(self.directions)
        relaxed = surface.stiffness / contact.hardness
        stretched = self._stretch_of(surface, relaxed)
        gap, unit, flank, _ = stretched
        moved = self.moved_nodes
        found = _Shape(
            {},
            np.outer(moved, gap),
            moved * unit,
            moved * flank,
            np.zeros(n),
            {},
            stretched,
        )
        for i, d in enumerate(self.directions):
            low, high = d.contacts
            if low == high:
                continue
            known = relaxed if low.body == high.body == contact.body else None
            a, b = (each.surface(x, known) for each in (low, high))
            found.surfaces[i] = a, b
            found.rigid_gap[i] += d.slope(a.rigid_gap, b.rigid_gap)
            found.unit[i] += d.slope(a.unit, b.unit)
            found.flank[i] += d.slope(a.flank, b.flank)
            if known is None:
                found.stiffer[i] = d.slope(a.stiffness, b.stiffness)
            else:
                found.harder[i] = d.slope(np.log(low.hardness), np.log(high.hardness))
        return found

    def _stretch_of(self, surface: Surface, relaxed: npt.NDArray):
        """Return the derivatives of a surface by the logarithm of the unit of its nodes.

        These are rigid gap, unit and flank, and the stiffness; None where that is proportional.
        """
        contact, x = self.body.contact, surface.position
        if not np.any(self.moved_nodes):
            return np.zeros_like(x), 0.0, 0.0, None
        free = isinstance(contact.body, HalfSpace)
        low, high = (
            contact.surface(x * by, relaxed * by if free else None) for by in (1 - _TINY, 1 + _TINY)
        )
        parts = ("rigid_gap", "unit", "flank", "stiffness")
        gap, unit, flank, S = (
            (getattr(high, name) - getattr(low, name)) / (2 * _TINY) for name in parts
        )
        return gap, unit, flank, None if free else S

    # -- machine

    def _leg_slopes(self, number: int) -> dict[str, npt.NDArray]:
        """Return the derivatives of the numbers of a leg."""
        names = ("stiffness", "rate", "duration", "drive", "depth", "force", "edge")
        found = {name: np.zeros(len(self.directions)) for name in names}
        now, began, leg = self.now, self._began, self._leg
        for i, d in enumerate(self.directions):
            low, high = (legs[number] for legs in d.legs)
            for name in names:
                a, b = getattr(low, name), getattr(high, name)
                found[name][i] = d.slope(a, b) if np.isfinite(a) and np.isfinite(b) else 0.0
        if np.isnan(self.directions[0].legs[0][number].rate):
            at = now.force if leg.dead_load else now.depth
            if not (leg.dead_load or leg.rigid):
                k = leg.stiffness
                at = at + now.force / k - began.force / k**2 * found["stiffness"]
            found["rate"] = (found["drive"] - at - leg.rate * found["duration"]) / leg.duration
        return found

    @property
    def _timed(self) -> npt.NDArray:
        """Inputs that change the steps over the times of the modes."""
        return np.flatnonzero(np.any(self._tau_or_step != 0, axis=1))

    def _stretched(self, number: int) -> npt.NDArray:
        """Return the derivatives of the logarithm of the time steps of the present leg.

        The steps are frozen as parts of the duration of a leg, or of the travel of the machine:
        the state of an elastic solid then does not move along its curve with the rate.
        """
        leg, slopes = self._leg, self._slopes
        if np.isfinite(leg.duration):
            found = slopes["duration"] / leg.duration
        elif leg.rate:
            found = -slopes["rate"] / leg.rate
        else:
            found = np.zeros(len(self.directions))
        last = number == len(self.directions[0].legs[0]) - 1
        return np.where(self._null, float(last), found)

    def _machine(self, seen: Snapshot) -> _Machine:
        """Return the machine at a time of the present leg."""
        leg, began, slopes = self._leg, self._began, self._slopes
        elapsed, (depth, force) = seen.time - began.time, self._from
        moved = (slopes["rate"] + leg.rate * self.stretch) * elapsed
        if leg.dead_load:
            return _Machine(0.0, force + moved)
        if leg.rigid:
            return _Machine(np.inf, depth + moved)
        k = leg.stiffness
        drive = began.depth + leg.rate * elapsed - seen.depth
        return _Machine(k, force + slopes["stiffness"] * drive + k * (depth + moved))

    def _record(self) -> None:
        now = self.now
        self.rows.append(np.array([now.time, now.depth, now.force, now.edge]))


@dataclass(frozen=True, eq=False)
class _Machine:
    """Derivatives of the boundary condition: of the depth (rigid), or force = value - k depth."""

    stiffness: float
    value: npt.NDArray

    def depth(self, force: npt.NDArray, per_depth: float) -> npt.NDArray:
        """Return the derivatives of the depth, from those of the force at a fixed depth."""
        if np.isinf(self.stiffness):
            return self.value
        return (self.value - force) / (per_depth + self.stiffness)


def _drift(leg: Leg) -> tuple[float, npt.NDArray]:
    """Return stiffness and rate of the boundary condition of a leg."""
    rate = np.array([leg.rate])
    return (leg.stiffness, rate if leg.rigid or leg.dead_load else leg.stiffness * rate)


def _value_of(start: Start | Apart, contact: Contact) -> float:
    """Return the depth, force or edge of a start."""
    if isinstance(start, Apart):
        return 1 - start.gap
    if isinstance(start, AtDepth):
        return start.depth
    if isinstance(start, AtForce):
        return start.force
    return start.contact_radius * contact.edge_unit


def _responses(
    state: State,
    compliance: float,
    given: npt.NDArray,
    load: npt.NDArray,
    band: Band,
    *,
    deeper: bool = False,
) -> tuple[npt.NDArray, npt.NDArray]:
    """Return the gaps for free gaps and loads, shape (P, N), and per unit of depth, (1, N)."""
    solid = elastic_energy(state.surface, compliance, state.surface.rigid_gap, Hold(np.inf))
    factor = factored(solid, band)
    if factor is None:
        raise Unstable
    right = given @ solid.matrix - load
    if deeper:
        right = np.vstack([right, -solid.matrix.sum(axis=0)])
    gaps = solved(factor, right.T).T
    return (gaps[:-1], gaps[-1:]) if deeper else (gaps, gaps[:0])


def _force_of(state: State, band: Band, body: Body, gap: npt.NDArray) -> npt.NDArray:
    """Return the changes of the force for changes of the gap, shape (P, N)."""
    surface = state.surface
    weights = band.diagonal
    if band.beside is not None:
        weights = weights.copy()
        weights[1:] += band.beside
        weights[:-1] += band.beside
    found = -surface.unit * (gap @ weights)
    if surface.flank:
        found += surface.flank * float(body.contact.law.traction(state.gap[-1])) * gap[:, -1]
    return found


def _times(band: Band, rows: npt.NDArray) -> npt.NDArray:
    """Return the product of the band with each row."""
    product = rows * band.diagonal
    if band.beside is not None:
        product[:, 1:] += rows[:, :-1] * band.beside
        product[:, :-1] += rows[:, 1:] * band.beside
    return product


def _moved_edge(state: State, gap: npt.NDArray) -> tuple[npt.NDArray, float]:
    """Return how far the edge moves for changes of the gap, and the slope of the gap there.

    Both are those of the cubic through four nodes; an edge at the end of the nodes does not move.
    """
    x, edge = state.surface.position, state.seen.edge
    i = int(np.searchsorted(x, edge)) - 1 if np.isfinite(edge) else -1
    if not 0 < i < len(x) - 2:
        return np.full(len(gap), 0.0 if np.isfinite(edge) else np.nan), np.inf
    r = slice(i - 1, i + 3)
    a, b, c, d = (float(edge - y) for y in x[r])
    p, q, s, t = (float(y) for y in x[r])
    # weights of the four nodes in Lagrange's form: value and slope at the edge
    below = np.array(
        [
            (p - q) * (p - s) * (p - t),
            (q - p) * (q - s) * (q - t),
            (s - p) * (s - q) * (s - t),
            (t - p) * (t - q) * (t - s),
        ]
    )
    value = np.array([b * c * d, a * c * d, a * b * d, a * b * c]) / below
    pairs = [c * d + b * d + b * c, c * d + a * d + a * c, b * d + a * d + a * b]
    steep = np.array([*pairs, b * c + a * c + a * b]) / below
    slope = float(steep @ state.gap[r])
    return -(gap[:, r] @ value) / slope, slope
