"""An elastic foundation: springs side by side, as a user would add a body, without an edit of ours.

viscotack simulate case examples/own/foundation.toml --with examples/own/foundation.py: the table
[foundation] states what the sphere presses.
"""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack import Quantity
from viscotack.cards import conform

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Foundation:
    """Springs side by side: a pressure p moves the surface by p b/E*, and only where it presses.

    A compressible layer that is thin beside the contact and slides on its base does so, b being its
    thickness.

    Parameters
    ----------
    thickness : float
        b [m]; positive.
    """

    word: ClassVar[str] = "foundation"
    symmetries: ClassVar[tuple[str, ...]] = ("revolution", "plane")

    thickness: Annotated[
        float, Quantity("m", "b", "thickness of the foundation", above=0, example="20 um")
    ]

    def __post_init__(self) -> None:
        conform(self)

    @property
    def decay_length(self) -> float:
        """A pressure is not felt beside it: 0."""
        return 0.0

    def influence(self, nodes: Array, symmetry: str) -> Array:
        """Return the displacement at node i under a hat of pressure at node j, for E* = 1."""
        return self.thickness * np.eye(len(nodes))

    def reduced(self, along: float) -> "Foundation":
        """Return the foundation with lengths in `along` [m]."""
        return Foundation(self.thickness / along)

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers of the body for summaries of dimensionless problems."""
        return {"thickness": self.thickness}
