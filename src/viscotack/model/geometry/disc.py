"""Disc: flat end of a cylinder with a sharp or a rounded edge."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.cards import Quantity, conform
from viscotack.errors import InputError


@dataclass(frozen=True)
class Disc:
    r"""Rigid cylinder with a flat end: the stamp of transfer printing, the probe of tack tests.

    A rounded edge rises like a parabola over its width w to its height h,

    .. math:: f(r) = h \left(\frac{r - (a - w)}{w}\right)^2, \quad a - w < r \le a,

    for a quarter of a circle of radius rho about w = rho, h = rho/2. Beyond a there is nothing.

    It has the scales of a sphere of radius :math:`R = a \sqrt{a E_0^*/\Delta\gamma_0}`, so that
    :math:`\beta = a` and :math:`\mu = \sqrt{a \Delta\gamma_0/E_0^*}/h_0`: Kendall's pull-off force
    is 1.064 of :math:`1.5 \pi R \Delta\gamma_0`, at a depth of :math:`-\sqrt{2\pi}\mu h_0`.

    Parameters
    ----------
    radius : float
        Radius of the cylinder a [m]; positive.
    edge_width : float
        Width over which the edge is rounded w [m], up to a; 0 for a sharp edge.
    edge_height : float
        Rise of the edge h [m]; 0 for a sharp edge.

    Examples
    --------
    >>> stamp = Disc(radius=1e-3, edge_width=20e-6, edge_height=10e-6)
    >>> [f"{height * 1e6:.1f} um" for height in stamp.gap([0.5e-3, 0.99e-3, 1e-3])]
    ['0.0 um', '2.5 um', '10.0 um']
    """

    word: ClassVar[str] = "disc"
    symmetry: ClassVar[str] = "revolution"

    radius: Annotated[float, Quantity("m", "a", "radius of the cylinder", above=0, example="1 mm")]
    edge_width: Annotated[
        float,
        Quantity("m", "w", "width over which the edge is rounded", least=0, example="20 um"),
    ] = 0.0
    edge_height: Annotated[
        float, Quantity("m", "h", "rise of the rounded edge", least=0, example="10 um")
    ] = 0.0

    def __post_init__(self) -> None:
        conform(self)
        if (self.edge_width > 0) != (self.edge_height > 0) or self.edge_width > self.radius:
            raise InputError(
                "a rounded edge has a width, up to the radius, and a height; leave out both for a "
                f"sharp one, got {self.edge_width:g} m and {self.edge_height:g} m"
            )

    @property
    def is_sharp(self) -> bool:
        """Whether its edge is not rounded."""
        return self.edge_width == 0

    def gap(self, position: npt.ArrayLike) -> Array:
        """Return the undeformed gap [m] at a distance from the axis [m], continued beyond a."""
        over = np.maximum(np.asarray(position, dtype=float) - self._flat, 0.0)
        return np.zeros_like(over) if self.is_sharp else self._bend / 2 * over * over

    def flank(self, position: npt.ArrayLike) -> Array:
        """Return the slope at a distance from the axis [m]."""
        over = np.maximum(np.asarray(position, dtype=float) - self._flat, 0.0)
        return np.zeros_like(over) if self.is_sharp else self._bend * over

    @property
    def end(self) -> float:
        """The radius at which it ends [m]."""
        return self.radius

    @property
    def detail(self) -> float:
        """The length over which its slope changes [m]."""
        return self.edge_width or self.radius

    def equivalent_radius(self, length: float) -> float:
        """Return the radius [m] of the sphere with the same scales, for dg0/E0* [m]."""
        return self.radius * sqrt(self.radius / length)

    def reduced(self, along: float, height: float) -> Disc:
        """Return the disc with distances in `along` [m] and gaps in `height` [m]."""
        radius = self.radius / along
        # without the round-off of scales, where it is 1
        radius = 1.0 if abs(radius - 1) < 1e-9 else radius
        return Disc(radius, self.edge_width / along, self.edge_height / height)

    @property
    def numbers(self) -> dict[str, float]:
        """Dimensionless numbers of the shape, by name."""
        if self.is_sharp:
            return {}
        return {"edge_width": self.edge_width, "edge_height": self.edge_height}

    @property
    def _flat(self) -> float:
        return self.radius - self.edge_width

    @property
    def _bend(self) -> float:
        return 2 * self.edge_height / self.edge_width**2
