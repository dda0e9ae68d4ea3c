"""The operation ``theory rectangle``: bounds for a rectangular stamp."""

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from viscotack.errors import InputError
from viscotack.units import readable

from .declare.answer import Answer, Caller
from .declare.cards import Number
from .declare.options import Operation
from .parts.layer import BONDED, THICKNESS, body_of
from .parts.record_words import record_words

# Largest cohesive zone over half the width: a disc of this zone is 3 % below Kendall.
_LARGEST_ZONE = 0.05


@dataclass(frozen=True, kw_only=True)
class OfRectangle(Operation):
    """Detachment of a rectangular flat stamp: bounds on a half-space, an estimate on a thin film.

    The bounds follow from inscribed discs and the ellipse around the rectangle, for a guided stamp
    that does not tilt, forces of short range and a slow pull. With a modulus ratio the largest
    force of a fast pull is added. The estimate on a film is that of a strip and a disc of the same
    width. Shear, peeling and tilt are not computed.

    Example: viscotack theory rectangle --length "300 um" --width "100 um" --contact-modulus "1 MPa"
    --work-of-adhesion "50 mJ/m^2" --strength "5 MPa" --modulus-ratio 0.1
    """

    word: ClassVar = "theory rectangle"

    length: Annotated[
        float, Number('Length of the stamp, "300 um".', unit="m", above=0, metavar="LENGTH")
    ]
    width: Annotated[
        float, Number('Width of the stamp, "100 um".', unit="m", above=0, metavar="LENGTH")
    ]
    contact_modulus: Annotated[
        float,
        Number('E* = E/(1 - nu^2), "1.94 MPa".', unit="Pa", above=0, metavar="PRESSURE"),
    ]
    work_of_adhesion: Annotated[
        float, Number('dg0, "0.1523 J/m^2".', unit="J/m^2", above=0, metavar="ENERGY")
    ]
    strength: Annotated[
        float | None,
        Number(
            'Of the interface, "5 MPa"; its force limits the largest one.',
            unit="Pa",
            above=0,
            metavar="PRESSURE",
        ),
    ] = None
    modulus_ratio: Annotated[
        float | None,
        Number("Rubbery over glassy modulus, for a fast pull.", above=0, most=1, metavar="K"),
    ] = None
    thickness: Annotated[float | None, THICKNESS] = None
    bonded: Annotated[float | None, BONDED] = None

    def __post_init__(self) -> None:
        body_of(self.thickness, self.bonded)

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory."""
        from viscotack.geometry import Layer
        from viscotack.theory.punch import rectangle

        self._check_zone()
        solid: Any = {
            "half_width": self.width / 2,
            "contact_modulus": self.contact_modulus,
            "work_of_adhesion": self.work_of_adhesion,
        }
        body = body_of(self.thickness, self.bonded)
        if isinstance(body, Layer):
            layer = {"thickness": body.thickness, "base": body.base}
            low, high = rectangle.on_layer(self.length / 2, **solid, **layer)
        else:
            low, high = rectangle.bounds(self.length / 2, **solid)
        limit = np.inf if self.strength is None else self.length * self.width * self.strength
        record: dict[str, Any] = {
            "least_pull_off_force_N": float(low),
            "most_pull_off_force_N": min(float(high), limit),
            "kind": "bounds" if self.thickness is None else "estimate",
        }
        if self.modulus_ratio is not None:
            fast = min(float(high) / self.modulus_ratio**0.5, limit)
            record["fastest_most_pull_off_force_N"] = fast
        return Answer(
            rectangle.Interval(low, high),
            record=lambda: record,
            words=lambda: record_words(record),
        )

    def _check_zone(self) -> None:
        """Raise an InputError where the zone of attraction at an edge is not small."""
        if self.strength is None:
            return
        zone = np.pi * self.contact_modulus * self.work_of_adhesion / (4 * self.strength**2)
        if zone > _LARGEST_ZONE * min(self.length, self.width) / 2:
            raise InputError(
                f"the zone of attraction at an edge is {readable(float(zone), 'm')} long, and the "
                f"bounds need at most {_LARGEST_ZONE:g} of half the width; a disc of any range is "
                "simulated by `viscotack simulate`"
            )
