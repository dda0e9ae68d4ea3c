"""What a run on a grid records: contact area, patches and frames."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from viscotack.simulate.grid.body import GridState
from viscotack.simulate.grid.plane import on_host
from viscotack.simulate.history import Snapshot
from viscotack.simulate.steps import MarchState, Run

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
