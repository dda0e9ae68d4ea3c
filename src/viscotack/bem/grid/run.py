"""A run on a grid: relaxed start, legs and history."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from viscotack.bem.books import SMALLEST_ENERGY, Books, History, Lowest, Snapshot
from viscotack.bem.grid.body import GridBody, GridState
from viscotack.bem.grid.descent import Found, equilibrium
from viscotack.bem.grid.map_contact import MapContact
from viscotack.bem.machine import Hold, Leg
from viscotack.bem.march import through
from viscotack.bem.place import Place, Run
from viscotack.bem.settings import Settings
from viscotack.errors import InputError
from viscotack.materials import Modes
from viscotack.protocol import Apart, AtDepth, AtRadius, Start

# Steps in which a relaxed contact is loaded, and gap [range of the law] from which.
_LOADINGS, _APART = 16, 4.0
_MOST_LOADINGS = 400
# Largest sum of unbalanced tractions of a relaxed state over that of all.
_UNBALANCED = 1e-7

# Without types, which SciPy states for several libraries of arrays.
_label: Any = ndimage.label


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


def relaxed(contact: MapContact, start: Start | Apart) -> Found:
    """Return the relaxed state that a slow approach from far away reaches.

    Under a tensile force it is the contact that is left when a compressed one is unloaded.
    """
    plane, law, span = contact.plane, contact.law, contact.span
    apart = _APART * span

    def at(depth: float, guess: Found | None) -> Found:
        moved = np.zeros(plane.domain) if guess is None else guess.moved
        return _balanced(contact, moved, Hold(np.inf, depth=depth), depth)

    if isinstance(start, Apart):
        return _checked(at(1 - start.gap, None))
    if isinstance(start, AtRadius):
        raise InputError("a map has no contact radius to start at; give a depth or a force")
    if isinstance(start, AtDepth):
        found = None
        for depth in np.linspace(-apart, start.depth, _LOADINGS):
            found = at(float(depth), found)
        assert found is not None
        return _checked(found)
    deepest = np.inf if not plane.mean_is_zero else float(contact.rigid_gap.mean()) - 1
    found, depth, step = None, min(-apart, deepest), 0.25 * contact.travel
    for _ in range(_MOST_LOADINGS):
        found = at(depth, found)
        force = contact.force_under(found.tension, depth)
        touches = np.any(found.gap < law.edge_gap)
        if depth >= deepest or (touches and force >= max(start.force, 0.0)):
            break
        depth, step = min(depth + step, deepest), 1.2 * step
    assert found is not None
    load = (start.force - contact.tail_force(depth)) / (contact.unit * contact.area)
    return _checked(_balanced(contact, found.moved, Hold(0.0, load=load), depth))


def _balanced(contact: MapContact, moved: npt.NDArray, hold: Hold, depth: float) -> Found:
    return equilibrium(
        contact.plane,
        contact.law,
        contact.rigid_gap,
        1.0,
        moved,
        hold,
        depth=depth,
        tolerance=_UNBALANCED,
    )


def _checked(found: Found) -> Found:
    if found.stable:
        return found
    raise ArithmeticError("no equilibrium of the surface was found")


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

    def keep(self, at: Place) -> None:
        """Append the present state to the history."""
        super().keep(at)
        state: GridState = at.state  # type: ignore[assignment]
        contact = state.surface
        shape, seen = contact.plane.shape, at.seen
        close = (state.gap < contact.law.edge_gap).reshape(shape)
        self.touching.append((int(close.sum()), patches(close, contact.plane.periodic)))
        pressure = (state.nodal / contact.area).astype(np.float32).reshape(shape)
        gap = state.gap.astype(np.float32).reshape(shape)
        self.frames.take(Frame(seen.time, seen.depth, seen.force, gap, pressure))


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


def march_on_grid(
    contact: MapContact,
    start: Found,
    modes: Modes,
    legs: tuple[Leg, ...],
    settings: Settings,
    *,
    stiffness: float | None = None,
    frames: int = 0,
    progress: Callable[[float], None] | None = None,
) -> GridRun:
    """Integrate a relaxed body through all legs; see :func:`viscotack.bem.march.march`.

    Up to `frames` frames are kept. The history is an attribute of the run.
    """
    history = History(SMALLEST_ENERGY * contact.span, stiffness)
    body = GridBody(contact, modes, np.asarray(modes.weights))
    run = GridRun(body, settings, legs, False, history, frames=Frames(frames))  # type: ignore[arg-type]
    state, leg = body.first(start), legs[0]
    books = Books(0.0, np.zeros(len(body.weights)))
    at = Place(state, books, Fixed(), leg, 0, state.seen, leg.least_step, Lowest())  # type: ignore[arg-type]
    through(run, at, "detached", progress)
    return run
