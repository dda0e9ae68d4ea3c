r"""Length scales of the traction law in gap direction: range and derived limits.

All of them are multiples of the law's range s (:func:`viscotack.model.traction.effective_range`),
which is 1 for Lennard-Jones, and count from the gap of equilibrium at 1 h0: a law whose range is
half as long has steps and meshes that are half as long, wherever its equilibrium is.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

# The surfaces have separated when the smallest gap exceeds this multiple of the range; the
# remaining work is the energy of the interface there.
_SEPARATED = 9.0
# Opening of the smallest gap, in ranges, above which a contact cannot hold a dead load.
_RELEASED = 29.0
# Smallest gap after interpolation to new nodes: closed by this fraction of the range, where every
# law repels strongly, but at least a tenth of h0. A steep gap may undershoot in the interpolation.
_CLOSED, _LEAST = 0.2, 0.1
# Smallest value of `room`, as a fraction of the range, for gaps below equilibrium.
_LEAST_ROOM = 0.1


def separated(gap: npt.NDArray, span: float) -> bool:
    """Return whether the surfaces have separated."""
    return float(gap.min()) > 1 + _SEPARATED * span


def released(gap: npt.NDArray, span: float) -> bool:
    """Return whether the surfaces are too far apart to hold a dead load."""
    return float(gap.min()) > 1 + _RELEASED * span


def least_gap(span: float) -> float:
    """Return the smallest gap [h0] of an initial guess."""
    return max(1 - _CLOSED * span, _LEAST)


def room(gap: npt.NDArray, span: float) -> npt.NDArray:
    """Return the change of gap [h0] over which the traction changes considerably.

    It is the gap itself for Lennard-Jones, whose traction is made of powers; for any law it is
    about the range near equilibrium, grows with the opening, and never more than the gap.
    """
    return np.minimum(gap, np.maximum(gap + (span - 1), _LEAST_ROOM * span))
