"""Interface between solver and geometry: surface on given nodes, node placement, relaxed state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy.typing as npt

from viscotack.model.protocol import Apart, Start
from viscotack.model.traction import Traction
from viscotack.simulate.mesh import Grading
from viscotack.simulate.settings import Settings
from viscotack.simulate.surface import Surface


@dataclass(frozen=True, eq=False)
class Relaxed:
    """Relaxed state: gap, depth [h0], force [output unit] and contact edge, nan without contact.

    `lattice` is the centre of the fine nodes; it is within one zone of the contact edge.
    """

    surface: Surface
    gap: npt.NDArray
    depth: float
    force: float
    edge: float
    lattice: float


class Contact(Protocol):
    """An indenter on a solid; each contact has its own unit of length along the surface.

    Attributes
    ----------
    law : Traction
        Reduced traction law.
    span : float
        Range of the traction law [h0].
    travel : float
        Depth [h0] over which the whole contact changes; scale of the time steps.
    edge_unit : float
        Unit of the outputs for the contact edge, in the unit of the mesh.
    zone : float
        Length over which the gap opens at a relaxed contact edge.
    """

    @property
    def law(self) -> Traction: ...  # noqa: D102
    @property
    def span(self) -> float: ...  # noqa: D102
    @property
    def travel(self) -> float: ...  # noqa: D102
    @property
    def edge_unit(self) -> float: ...  # noqa: D102
    @property
    def zone(self) -> float: ...  # noqa: D102
    @property
    def body(self) -> Any: ...  # noqa: D102
    def surface(self, nodes: npt.NDArray) -> Surface: ...  # noqa: D102
    def grading(self, settings: Settings, depth: float) -> Grading: ...  # noqa: D102
    def relaxed(self, start: Start | Apart, settings: Settings) -> Relaxed: ...  # noqa: D102
    def deepest(self, start: Start) -> float: ...  # noqa: D102
    def relaxed_pull_off(self, edge: float) -> float: ...  # noqa: D102
