"""State of a soft body under a map of heights, its change by a step, and the record of a run.

A run records contact area, patches and frames.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from viscotack.model.materials import Modes
from viscotack.simulate.body import Rates, Step, Trial
from viscotack.simulate.equilibrium import GONE
from viscotack.simulate.grid.descent import Found, equilibrium
from viscotack.simulate.grid.map_contact import MapContact
from viscotack.simulate.grid.plane import on_host
from viscotack.simulate.history import Snapshot
from viscotack.simulate.machine import Hold
from viscotack.simulate.steps import MarchState, Run

# Largest sum of unbalanced tractions over that of all.
_UNBALANCED = 3e-5


@dataclass(frozen=True, eq=False)
class GridMemory:
    """Forces of every mode on the device of the grid, and their products with displacements.

    The displacements d are those of the relaxed body under the forces z of the mode, so that energy
    and heat follow from products, whose recursion is that of the forces.
    """

    force: npt.NDArray  # z, shape (M, N)
    present: npt.NDArray  # z e of each mode, with the present displacement e of the surface
    own: npt.NDArray  # z d

    def advanced(
        self, s: Step, e: npt.NDArray, e1: npt.NDArray, F: npt.NDArray, F1: npt.NDArray
    ) -> GridMemory:
        """Return the memory after a step."""
        found, part = np.empty_like(self.force), np.empty_like(F)
        # fields of all modes at once would take most of the memory of a run
        for j, (decay, (begin, end)) in enumerate(
            zip(s.decay.tolist(), s.drive.tolist(), strict=True)
        ):
            mode = np.multiply(self.force[j], decay, out=found[j])
            mode += np.multiply(F, begin, out=part)
            mode += np.multiply(F1, end, out=part)

        def recur(field: npt.NDArray, first: Any, last: Any) -> npt.NDArray:
            return s.decay * field + s.drive[:, 0] * first + s.drive[:, 1] * last

        later = on_host(self.force @ e1)
        before, between, after = float(e @ F), float(e1 @ F), float(e1 @ F1)
        present = recur(later, between, after)
        # products of the new d with z, F and the new F
        own = recur(self.own, self.present, later), recur(self.present, before, between), present
        return GridMemory(found, present, recur(*own))

    def heat(
        self, s: Step, e: npt.NDArray, e1: npt.NDArray, F: npt.NDArray, F1: npt.NDArray
    ) -> npt.NDArray:
        """Return the heat of each mode in a step."""
        de, dF = e1 - e, F1 - F
        mixed = float(e @ dF) - on_host(self.force @ de)
        return s.heat(float(e @ F) - 2 * self.present + self.own, mixed, float(de @ dF))


@dataclass(frozen=True, eq=False)
class GridState:
    """Complete solver state at one instant: recorded quantities and data for the next step.

    The names are those of :class:`viscotack.simulate.body.State`; fields of the surface are flat
    arrays of its pixels, `moved` and `moving` are e and its rate on the domain of the transforms.
    """

    seen: Snapshot
    surface: MapContact
    gap: npt.NDArray
    relaxed: npt.NDArray  # e: displacement of the relaxed solid under this traction
    nodal: npt.NDArray  # F: forces on the pixels
    memory: GridMemory
    rates: Rates
    moved: npt.NDArray
    moving: npt.NDArray | None = None
    extra: None = None
    trail: tuple[()] = ()  # no step is taken in the frame of an edge


@dataclass(frozen=True, eq=False)
class GridBody:
    """Constant data of a run: the contact and the retardation modes of the solid."""

    contact: MapContact
    modes: Modes
    weights: npt.NDArray
    growing: None = None
    runs: bool = False

    def first(self, found: Found) -> GridState:
        """Return the relaxed state, in which every mode is in equilibrium."""
        e, many = self.contact.plane.within(found.moved), (len(self.weights), 1)
        force = self.contact.area * found.held
        product = np.full(many[0], float(e @ force))
        memory = GridMemory(np.tile(force, many), product, product)
        seen = self._seen(0.0, found, e, force, memory)
        return GridState(seen, self.contact, found.gap, e, force, memory, _at_rest(e), found.moved)

    def after(
        self, state: GridState, s: Step, hold: Hold, most_iterations: int, largest_gain: float
    ) -> Trial:
        """Advance the state by one trial time step."""
        contact, plane = self.contact, self.contact.plane
        area = contact.area
        free = contact.free
        if self.weights.size:
            inherited = plane.field(s.weights * s.decay) @ state.memory.force
            inherited = inherited + float(s.weights @ s.drive[:, 0]) * state.nodal
            free = free + plane.within(plane.moved(inherited / area))
        guess = state.moved if state.moving is None else state.moved + s.length * state.moving
        depth = state.seen.depth
        if not hold.rigid:
            tail = contact.tail_force(depth) / contact.unit
            hold = replace(hold, stiffness=hold.stiffness / area, load=(hold.load - tail) / area)
        found = equilibrium(
            plane,
            contact.law,
            free,
            s.compliance,
            s.compliance * guess,
            hold,
            depth=depth,
            tolerance=_UNBALANCED,
            most_iterations=most_iterations,
        )
        moved = found.moved / s.compliance
        e, force = plane.within(moved), area * found.held
        change = e - state.relaxed
        memory = state.memory.advanced(s, state.relaxed, e, state.nodal, force)
        after = GridState(
            self._seen(state.seen.time + s.length, found, e, force, memory),
            contact,
            found.gap,
            e,
            force,
            memory,
            Rates(change / s.length, 0.0, np.zeros(1)),
            moved,
            (moved - state.moved) / s.length,
        )
        away = change - s.length * state.rates.relaxed
        most = float(np.sqrt(np.mean(away**2)))
        error = (s.curvature * most if state.rates.known else 0.0) if found.stable else np.inf
        return Trial(after, error, found.iterations, found.released)  # type: ignore[arg-type]

    def pressed(self, state: GridState) -> float:
        """Return the pressure [dg/h0] where a search has closed the gap completely, 0 if open."""
        gone = state.gap < GONE
        return float(state.nodal[gone].max()) / self.contact.area if gone.any() else 0.0

    def at_rest(self, state: GridState) -> GridState:
        """Return the state with rates reset, where the previous rates do not apply."""
        return replace(state, rates=_at_rest(state.relaxed), moving=None)

    def friction(self, before: GridState, after: GridState) -> float:
        """Return 0: the law depends on the gap alone."""
        return 0.0

    def _seen(
        self, time: float, found: Found, e: npt.NDArray, force: npt.NDArray, memory: GridMemory
    ) -> Snapshot:
        """Return the recorded quantities of an instant."""
        contact, depth, unit = self.contact, found.depth, self.contact.unit
        touching = int(np.count_nonzero(found.gap < contact.law.edge_gap))
        instant = 0.5 * self.modes.instantaneous * float(e @ force)
        return Snapshot(
            time=time,
            depth=depth,
            edge=float(np.sqrt(touching * contact.area / np.pi)) if touching else np.nan,
            force=contact.force_under(found.tension, depth),
            elastic=unit * (instant + 0.5 * float(self.weights @ memory.own)),
            interface=unit * contact.area * found.energy + contact.tail_energy(depth),
        )


def _at_rest(e: npt.NDArray) -> Rates:
    return Rates(np.zeros_like(e), 0.0, np.zeros(1), known=False)


# Without types, which SciPy states for several libraries of arrays.
_label: Any = ndimage.label

# Largest gap of a frame [h0], in single precision; a dead load opens gaps without end.
_LARGEST_GAP = 1e30


@dataclass(frozen=True)
class Fixed:
    """The nodes of a grid, which stay: no step is limited by them."""

    lattice: float = 0.0
    edge: float = 0.0
    inner: tuple[float, ...] = ()
    narrows: bool = False

    def strain(self, before: Snapshot, after: Snapshot) -> float:
        """Return 0."""
        return 0.0

    def left_by(self, edge: float, inner: tuple[float, ...] = ()) -> bool:
        """Return False."""
        return False


@dataclass(frozen=True, eq=False)
class Frame:
    """Gap [h0] and pressure [dg/h0] of the pixels at one instant."""

    time: float
    depth: float
    force: float
    gap: npt.NDArray
    pressure: npt.NDArray


@dataclass(frozen=True, eq=False)
class Frames:
    """Frames of a run: that of the largest tension, and evenly drawn ones, at most `most`."""

    most: int
    kept: list[Frame] = field(default_factory=list)
    every: list[int] = field(default_factory=lambda: [1, 0])  # stride, and number of frames seen
    strongest: list[Frame] = field(default_factory=list)

    def take(self, frame: Frame) -> None:
        """Keep a frame; where there are too many, every second goes."""
        if not self.strongest or frame.force < self.strongest[0].force:
            self.strongest[:] = [frame]
        stride, count = self.every
        if self.most and count % stride == 0:
            self.kept.append(frame)
            if len(self.kept) > self.most:
                del self.kept[1::2]
                self.every[0] = 2 * stride
        self.every[1] += 1


@dataclass(frozen=True)
class GridRun(Run):
    """Data of a run on a grid, which records areas, patches and frames too."""

    touching: list[tuple[int, int]] = field(default_factory=list)
    frames: Frames = field(default_factory=lambda: Frames(0))
    told: Callable[[MarchState], None] = lambda at: None  # called with each place that is kept

    def keep(self, at: MarchState) -> None:
        """Append the present state to the history."""
        super().keep(at)
        state: GridState = at.state  # type: ignore[assignment]
        contact = state.surface
        shape, seen = contact.plane.shape, at.seen
        close = on_host(state.gap < contact.law.edge_gap).reshape(shape)
        self.touching.append((int(close.sum()), patches(close, contact.plane.periodic)))
        pressure = on_host((state.nodal / contact.area).astype(np.float32)).reshape(shape)
        gap = on_host(np.minimum(state.gap, _LARGEST_GAP).astype(np.float32)).reshape(shape)
        self.frames.take(Frame(seen.time, seen.depth, seen.force, gap, pressure))
        self.told(at)


def patches(close: npt.NDArray, periodic: bool) -> int:
    """Return the number of connected parts of a contact, also across the sides of a periodic one.

    Examples
    --------
    >>> close = np.zeros((8, 8), dtype=bool)
    >>> close[2, 0] = close[2, 7] = True
    >>> patches(close, periodic=False), patches(close, periodic=True)
    (2, 1)
    """
    names, count = _label(close)
    if not periodic or count < 2:
        return int(count)
    ends = [(names[0], names[-1]), (names[:, 0], names[:, -1])]
    joined = np.concatenate([np.array([a, b])[:, (a > 0) & (b > 0)] for a, b in ends], axis=1) - 1
    links = coo_array((np.ones(joined.shape[1]), tuple(joined)), shape=(count, count))
    return int(connected_components(links, directed=False)[0])
