"""Detection of surfaces pressed together harder than the traction law can repel.

The repulsion of a law may be finite at zero gap (exponential, Dugdale, tabulated). A larger contact
pressure closes the gap to 0, where the law ends. No equilibrium exists then, and the error message
must not attribute this to missing adhesion.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.model.traction import Traction
from viscotack.simulate.equilibrium import GONE
from viscotack.simulate.surface import Surface


class ClosedGap(InputError):
    """Deeper than the traction law can hold the surfaces apart."""


def pressed_shut(surface: Surface, gap: npt.NDArray, relaxed: npt.NDArray) -> float:
    """Return the pressure [dg/h0] where the gap is closed completely, 0 if it is open.

    Parameters
    ----------
    surface : Surface
        The surface.
    gap : ndarray, shape (N,)
        Gap at the end of a search without equilibrium [h0].
    relaxed : ndarray, shape (N,)
        Displacement of the relaxed solid under this pressure [h0].
    """
    gone = gap < GONE
    if not gone.any():
        return 0.0
    return float(np.max((surface.stiffness @ relaxed / surface.area)[gone]))


def why(law: Traction, pressure: float) -> str:
    """Return the explanation for the error message."""
    most = -float(law.traction(GONE * law.equilibrium_gap))
    return (
        f"the contact presses with up to {pressure:.4g} dg0/h0, and the traction law repels with "
        f"{most:.4g} dg0/h0 at most, at a gap of 0, where it ends; press less, or take a law that "
        "repels more strongly, such as lennard-jones or one of shorter range"
    )


def check_open(surface: Surface, law: Traction, gap: npt.NDArray, depth: float, of: str) -> None:
    """Raise `ClosedGap` if the search for a relaxed contact has closed the gap."""
    if pressure := pressed_shut(surface, gap, gap - surface.rigid_gap + depth):
        raise ClosedGap(
            f"no relaxed contact exists at a depth of {depth:g} h0 ({of}): {why(law, pressure)}"
        )
