r"""Length scales of the traction law in gap direction: range and derived limits.

All of them are multiples of the law's range s (:func:`viscotack.traction.effective_range`), which
is 1 for Lennard-Jones, and count from the gap of equilibrium at 1 h0: a law whose range is half as
long has steps and meshes that are half as long, wherever its equilibrium is.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

# The surfaces have separated when the smallest gap exceeds this multiple of the range; the
# remaining work is the energy of the interface there.
_SEPARATED = 9.0
# Opening of the smallest gap, in ranges, above which a contact cannot hold a dead load.
_RELEASED = 29.0
# Carried to other nodes, a gap may undershoot where it is steep; every law repels by much where it
# is closed by this part of its range. But no gap is made smaller than a tenth of h0.
_CLOSED, _LEAST = 0.2, 0.1
# Below equilibrium, by how much of the range a gap may close at once, however far it is closed.
_LEAST_ROOM = 0.1


def separated(gap: npt.NDArray, span: float) -> bool:
    """Return whether surfaces have separated for all that matters."""
    return float(gap.min()) > 1 + _SEPARATED * span


def released(gap: npt.NDArray, span: float) -> bool:
    """Return whether surfaces are so far apart that nothing holds a dead load any more."""
    return float(gap.min()) > 1 + _RELEASED * span


def least_gap(span: float) -> float:
    """Return the smallest gap [h0] that a guess may have."""
    return max(1 - _CLOSED * span, _LEAST)


def room(gap: npt.NDArray, span: float) -> npt.NDArray:
    """Return over which change of a gap [h0] its traction changes by much.

    It is the gap itself for Lennard-Jones, whose traction is made of powers; for any law it is
    about the range near equilibrium, grows with the opening, and never more than the gap.
    """
    return np.minimum(gap, np.maximum(gap + (span - 1), _LEAST_ROOM * span))
