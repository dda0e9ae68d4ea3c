"""Sphere with axisymmetric waves (Guduru)."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.cards import Checked, Quantity

from .shapes import Sphere


@dataclass(frozen=True)
class WavySphere(Checked):
    r"""Rigid sphere with rings of waves around its axis.

    .. math:: f(r) = \frac{r^2}{2R} + A \left(1 - \cos\frac{2 \pi r}{\lambda}\right)

    Parameters
    ----------
    radius : float
        Radius of the sphere R [m]; positive.
    amplitude : float
        Amplitude of the waves A [m]; positive. The tip is the lowest place.
    wavelength : float
        Distance from ring to ring lambda [m]; positive.

    References
    ----------
    Guduru (2007), doi:10.1016/j.jmps.2006.09.002.

    Examples
    --------
    >>> wavy = WavySphere(radius=0.2, amplitude=1e-6, wavelength=1e-3)
    >>> f"{wavy.gap(0.5e-3) * 1e6:.3f} um"
    '2.625 um'
    """

    word: ClassVar[str] = "wavy-sphere"
    symmetry: ClassVar[str] = "revolution"

    radius: Annotated[float, Quantity("m", "R", "sphere radius", above=0, example="200 mm")]
    amplitude: Annotated[
        float, Quantity("m", "A", "amplitude of the waves", above=0, example="1 um")
    ]
    wavelength: Annotated[
        float, Quantity("m", "lambda", "distance from wave to wave", above=0, example="0.5 mm")
    ]

    def gap(self, position: npt.ArrayLike) -> Array:
        """Return the undeformed gap [m] at a distance from the axis [m]."""
        r = np.asarray(position, dtype=float)
        # the versine without its cancellation near the tip
        waves = 2 * self.amplitude * np.sin(pi * r / self.wavelength) ** 2
        return r * r / (2 * self.radius) + waves

    def flank(self, position: npt.ArrayLike) -> Array:
        """Return the slope at a distance from the axis [m]; it falls behind each crest."""
        r, k = np.asarray(position, dtype=float), 2 * pi / self.wavelength
        return r / self.radius + self.amplitude * k * np.sin(k * r)

    @property
    def detail(self) -> float:
        """The length over which the slope changes [m], half a wave."""
        return self.wavelength / 2

    def equivalent_radius(self, length: float) -> float:
        """Return the radius of the sphere under the waves [m]."""
        return self.radius

    def reduced(self, along: float, height: float) -> WavySphere:
        """Return the shape with distances in `along` [m] and gaps in `height` [m]."""
        radius = Sphere(self.radius).reduced(along, height).radius
        return WavySphere(radius, self.amplitude / height, self.wavelength / along)

    @property
    def numbers(self) -> dict[str, float]:
        """Dimensionless numbers of the shape, by name."""
        return {"amplitude": self.amplitude, "wavelength": self.wavelength}
