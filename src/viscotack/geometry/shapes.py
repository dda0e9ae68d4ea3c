"""Shapes: the gap between the rigid indenter and the flat solid when they just touch."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.units import positive


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


@dataclass(frozen=True)
class PowerLawProfile:
    """Rigid indenter of revolution with the profile z = A r^q.

    Parameters
    ----------
    coefficient : float
        A [m^(1-q)]; positive.
    exponent : float
        q, from 1 (a cone) to 10; 2 is the paraboloid of a sphere with A = 1/(2 R), larger ones are
        ever flatter tips. Below 1 the tip would be infinitely sharp.

    Examples
    --------
    The sphere of 5.19 mm as a paraboloid:

    >>> f"{PowerLawProfile(1 / (2 * 5.19e-3), exponent=2).gap(100e-6) * 1e6:.4f} um"
    '0.9634 um'
    """

    coefficient: float
    exponent: float

    def __post_init__(self) -> None:
        unit = "m^(1 - exponent)"
        object.__setattr__(self, "coefficient", positive("coefficient", self.coefficient, unit))
        object.__setattr__(self, "exponent", profile_exponent("exponent", self.exponent))

    def gap(self, position: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the undeformed gap [m] at a distance from the axis [m], A r^q."""
        return self.coefficient * np.asarray(position, dtype=float) ** self.exponent


@dataclass(frozen=True)
class Cone:
    """Rigid cone: the power law with exponent 1.

    Parameters
    ----------
    slope : float
        Rise over radius, the cotangent of the half angle at the tip; positive. A problem in SI
        refuses steep cones.

    Examples
    --------
    >>> f"{Cone(slope=0.05).gap(100e-6) * 1e6:.1f} um"
    '5.0 um'
    """

    slope: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "slope", positive("slope", self.slope, "1"))

    @property
    def coefficient(self) -> float:
        """The slope, as the coefficient of a power law."""
        return self.slope

    @property
    def exponent(self) -> float:
        """That of a cone as a power law, 1."""
        return 1.0

    def gap(self, position: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the undeformed gap [m] at a distance from the axis [m]."""
        return self.slope * np.asarray(position, dtype=float)


def profile_exponent(name: str, value: float) -> float:
    """Return the exponent of a profile as a float, or refuse one outside 1 to 10."""
    q = positive(name, value, "1")
    if not 1 <= q <= 10:
        raise ValueError(
            f"{name} must be between 1 (a cone) and 10 (a blunt tip), got {q:g}; for a flat punch "
            "see theory.profiles"
        )
    return q
