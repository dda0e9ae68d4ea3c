"""Options for a layer on a rigid base: its thickness, and whether it is bonded."""

from typing import TYPE_CHECKING

from viscotack.errors import InputError

from ..request import Number

if TYPE_CHECKING:
    from viscotack.model.geometry import HalfSpace, Layer

THICKNESS = Number(
    'Thickness of a layer on a rigid base, "60 um"; a half-space when left out.', unit="m", above=0
)
BONDED = Number(
    "Poisson ratio, 0 to 0.5, of a layer bonded to its base; without this option the layer slides "
    "on its base.",
    least=0,
    most=0.5,
)


def body_of(thickness: float | None, bonded: float | None) -> "HalfSpace | Layer":
    """Return the half-space, or the layer of a thickness."""
    from viscotack.model.geometry import Bonded, Frictionless, HalfSpace, Layer

    if thickness is None:
        if bonded is not None:
            raise InputError("bonded needs a layer; give its thickness as well")
        return HalfSpace()
    return Layer(thickness, Frictionless() if bonded is None else Bonded(poisson_ratio=bonded))
