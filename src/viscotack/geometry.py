"""Shapes: the gap between the rigid indenter and the flat solid when they just touch."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .units import positive


@dataclass(frozen=True)
class Sphere:
    """Rigid sphere, near its lowest point: the gap is that of a paraboloid.

    Parameters
    ----------
    radius : float
        Radius of curvature R [m]; positive.

    Notes
    -----
    The paraboloid stands for the sphere while the contact radius is small beside R: at 0.5 R the
    true gap is 7 % larger. A problem in SI refuses larger contacts.

    Examples
    --------
    >>> f"{Sphere(radius=5.19e-3).gap(100e-6) * 1e6:.4f} um"
    '0.9634 um'
    """

    radius: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", positive("radius", self.radius, "m"))

    def gap(self, position: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the undeformed gap [m] at a distance from the axis [m], r^2/(2 R)."""
        r = np.asarray(position, dtype=float)
        return r * r / (2 * self.radius)


@dataclass(frozen=True)
class FlatPunch:
    """Rigid flat punch, long in the third direction: plane strain.

    Parameters
    ----------
    half_width : float
        Half of its width, a [m]; positive.
    """

    half_width: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "half_width", positive("half_width", self.half_width, "m"))
