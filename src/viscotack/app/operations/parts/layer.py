"""Options for a layer on a rigid base: its thickness, and whether it is bonded."""

from typing import TYPE_CHECKING

from viscotack.errors import InputError

from ..options import number
from ..request import Request

if TYPE_CHECKING:
    from viscotack.model.geometry import HalfSpace, Layer


class OnLayer(Request):
    """A contact on a half-space, or on a layer of a thickness."""

    thickness: float | None = number(
        'Thickness of a layer on a rigid base, "60 um"; a half-space when left out.', "m", above=0
    )
    bonded: float | None = number(
        "Poisson ratio, 0 to 0.5, of a layer bonded to its base; without this option the layer "
        "slides on its base.",
        least=0,
        most=0.5,
    )

    def check(self) -> None:
        """Refuse a base without a layer."""
        super().check()
        if self.bonded is not None and self.thickness is None:
            raise InputError("bonded needs a layer; give its thickness as well", field="bonded")

    @property
    def body(self) -> "HalfSpace | Layer":
        """The half-space or the layer."""
        from viscotack.model.geometry import Bonded, Frictionless, HalfSpace, Layer

        if self.thickness is None:
            return HalfSpace()
        nu = self.bonded
        return Layer(self.thickness, Frictionless() if nu is None else Bonded(poisson_ratio=nu))
