"""A cone with a rounded tip, and an observable: as a user would add them, without an edit of ours.

viscotack simulate case examples/own/rounded.toml, with --with for the three files here: the table
[rounded-cone] stands in place of [sphere].
"""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack import Observable, Quantity, Result
from viscotack.cards import conform

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class RoundedCone:
    r"""A hyperboloid of revolution: a cone far from its tip, a sphere of radius b/s near it.

    .. math:: z(r) = s \left(\sqrt{r^2 + b^2} - b\right)

    Parameters
    ----------
    slope : float
        s of the cone; positive.
    rounding : float
        b [m]; positive.
    """

    word: ClassVar[str] = "rounded-cone"
    symmetry: ClassVar[str] = "revolution"

    slope: Annotated[float, Quantity("1", "s", "slope of the cone", above=0, example="0.1")]
    rounding: Annotated[
        float, Quantity("m", "b", "radius over which the tip is round", above=0, example="20 um")
    ]

    def __post_init__(self) -> None:
        conform(self)

    def gap(self, position: npt.ArrayLike) -> Array:
        """Return the undeformed gap [m] at a distance from the axis [m]."""
        r, b = np.asarray(position, dtype=float), self.rounding
        # without the cancellation of sqrt(r^2 + b^2) - b near the tip
        return self.slope * r * r / (np.sqrt(r * r + b * b) + b)

    def flank(self, position: npt.ArrayLike) -> Array:
        """Return the slope of the flank at a distance from the axis [m]."""
        r, b = np.asarray(position, dtype=float), self.rounding
        return self.slope * r / np.sqrt(r * r + b * b)

    def reduced(self, along: float, height: float) -> "RoundedCone":
        """Return the shape with distances in `along` [m] and gaps in `height` [m]."""
        return RoundedCone(self.slope * along / height, self.rounding / along)

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers of the shape for summaries of dimensionless problems."""
        return {"rounding": self.rounding}


def _largest_radius(result: Result) -> float:
    return float(np.nanmax(result.contact_radius))


largest_contact_radius = Observable(
    "largest_contact_radius", "largest contact radius", "radius", _largest_radius
)
