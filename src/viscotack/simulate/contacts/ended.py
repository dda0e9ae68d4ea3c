"""Grading of nodes up to the end of an indenter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.simulate.mesh import Grading, check_count


@dataclass(frozen=True)
class EndedGrading(Grading):
    """A grading with its last node exactly at the end of the indenter.

    No panel is longer than `coarsest`.
    """

    coarsest: float = np.inf

    def nodes(self, edge: float, first_edge: float) -> npt.NDArray:
        """Return the nodes, from 0 to the end, for an edge and the first edge of the run."""
        nodes = super().nodes(edge, first_edge)
        inside = nodes < self.outer_radius - self.scar_spacing / 4
        nodes = nodes[inside]
        if self.outer_radius - nodes[-1] < 0.5 * (nodes[-1] - nodes[-2]):
            nodes = nodes[:-1]  # a short panel after long ones would not be resolved
        nodes = np.append(nodes, self.outer_radius)
        parts = np.ceil(np.diff(nodes) / self.coarsest - 1e-9).clip(min=1)
        check_count(float(parts.sum()))
        return np.interp(np.arange(parts.sum() + 1), np.append(0, np.cumsum(parts)), nodes)
