"""The contact whose edge is a steady crack: a history in a tenth of a second."""

import numpy as np

from viscotack.model.geometry import HalfSpace, detail
from viscotack.model.problem import Groups
from viscotack.model.problem.revolution import ELASTIC_TABOR, SIMULATED_TABOR

# Largest accepted effective Tabor number: beyond it zone and contact lengths differ by more than
# double precision.
LARGEST_TABOR = 1e9


def not_covered(groups: Groups) -> str:
    """Return why the model does not cover a problem; "" for one edge on a half-space."""
    if groups.in_plane_strain:
        return (
            "shapes of revolution, got a flat punch on a layer; use theory.punch.pull_off "
            "(relaxed bulk) or `viscotack simulate`"
        )
    if not isinstance(groups.body, HalfSpace):
        return f"a half-space, got a {groups.body.word}"
    if np.isfinite(detail(groups.geometry)):
        return f"only shapes that rise ever more steeply from the tip, got a {groups.geometry.word}"
    return ""


def too_short(groups: Groups) -> bool:
    """Whether the model replaces the simulation because the range of the forces is too short."""
    if not_covered(groups):
        return False
    least = ELASTIC_TABOR if groups.modulus_ratio >= 1 else SIMULATED_TABOR[1]
    return least < groups.effective_tabor <= LARGEST_TABOR
