"""Indenter shapes: the gap between the rigid indenter and the flat body at first contact.

A shape of revolution implements :meth:`gap`, its derivative :meth:`flank`, and :meth:`reduced`,
which returns the shape in other units of length. `word` is its name in files. A shape whose slope
decreases somewhere has a length over which it changes (:func:`detail`). A shape known only to some
radius states this radius (:func:`end`). Any class with these attributes is a shape; docs/own.md
explains an example. The attribute `symmetry` determines scales, limits and outputs: "revolution",
or "plane" for the flat punch in plane strain.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import log
from typing import Annotated, Any, ClassVar, Protocol

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.cards import Checked, Quantity
from viscotack.errors import InputError

# Decades of radius [m] over which a shape of revolution is examined.
_DECADES = (-30.0, 30.0)


class Shape(Protocol):
    """Interface of a shape of revolution, for the type checker."""

    word: ClassVar[str]
    symmetry: ClassVar[str]

    def gap(self, position: npt.ArrayLike) -> Array:
        """Return the undeformed gap [m] at a distance from the axis [m]; 0 at the tip."""
        ...

    def flank(self, position: npt.ArrayLike) -> Array:
        """Return the slope of the gap at a distance from the axis [m]; see :func:`detail`."""
        ...

    def reduced(self, along: float, height: float) -> "Shape":
        """Return the shape with distances in `along` [m] and gaps in `height` [m]."""
        ...


@dataclass(frozen=True)
class Sphere(Checked):
    """Rigid sphere, near its lowest point: the gap is that of a paraboloid.

    Parameters
    ----------
    radius : float
        Radius of curvature R [m]; positive.

    Notes
    -----
    The paraboloid approximates the sphere while the contact radius is small beside R: at 0.5 R the
    true gap is 7 % larger. A problem in SI refuses larger contacts.

    Examples
    --------
    >>> f"{Sphere(radius=5.19e-3).gap(100e-6) * 1e6:.4f} um"
    '0.9634 um'
    """

    word: ClassVar[str] = "sphere"
    symmetry: ClassVar[str] = "revolution"

    radius: Annotated[float, Quantity("m", "R", "sphere radius", above=0, example="5.19 mm")]

    def gap(self, position: npt.ArrayLike) -> Array:
        """Return the undeformed gap [m] at a distance from the axis [m], r^2/(2 R)."""
        r = np.asarray(position, dtype=float)
        return r * r / (2 * self.radius)

    def flank(self, position: npt.ArrayLike) -> Array:
        """Return the slope of the flank at a distance from the axis [m], r/R."""
        return np.asarray(position, dtype=float) / self.radius

    def equivalent_radius(self, length: float) -> float:
        """Return its radius [m], whatever the material's length."""
        return self.radius

    def reduced(self, along: float, height: float) -> "Sphere":
        """Return the sphere with distances in `along` [m] and gaps in `height` [m]."""
        return Sphere(_snapped(self.radius * height / along**2, 1.0))


def effective_sphere(first: Sphere, second: Sphere) -> Sphere:
    r"""Return the sphere on a flat body equivalent to a sphere on a sphere.

    .. math:: \frac{1}{R} = \frac{1}{R_1} + \frac{1}{R_2}

    Parameters
    ----------
    first, second : Sphere
        Convex spheres with radii [m] much larger than their contact.

    Returns
    -------
    Sphere
        The gap between the two is its gap to a plane. For two soft spheres the material is
        :func:`viscotack.model.materials.two_bodies.effective_solid`.

    Examples
    --------
    >>> effective_sphere(Sphere(2e-3), Sphere(2e-3))
    Sphere(radius=0.001)
    """
    return Sphere(1 / (1 / first.radius + 1 / second.radius))


@dataclass(frozen=True)
class FlatPunch(Checked):
    """Rigid flat punch, long in the third direction: plane strain.

    Parameters
    ----------
    half_width : float
        Half width a [m]; positive.

    Examples
    --------
    >>> FlatPunch(half_width=1e-3).half_width
    0.001
    """

    word: ClassVar[str] = "punch"
    symmetry: ClassVar[str] = "plane"

    half_width: Annotated[
        float, Quantity("m", "a", "half width of the punch", above=0, example="1 mm")
    ]

    def reduced(self, along: float, height: float) -> "FlatPunch":
        """Return the punch with distances in `along` [m]; it has no height."""
        return FlatPunch(self.half_width / along)

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers of the shape for summaries of dimensionless problems."""
        return {"size": self.half_width}


class _PowerLaw(Checked):
    """Profile z = A r^q of a coefficient A and an exponent q."""

    coefficient: Any
    exponent: Any

    def gap(self, position: npt.ArrayLike) -> Array:
        """Return the undeformed gap [m] at a distance from the axis [m], A r^q."""
        return self.coefficient * np.asarray(position, dtype=float) ** self.exponent

    def flank(self, position: npt.ArrayLike) -> Array:
        """Return the slope of the flank at a distance from the axis [m], q A r^(q-1)."""
        A, q = self.coefficient, self.exponent
        return q * A * np.asarray(position, dtype=float) ** (q - 1)

    def equivalent_radius(self, length: float) -> float:
        """Return the radius [m] of the sphere with the same scales, for dg0/E0* [m]."""
        q, slope = self.exponent, self.exponent * self.coefficient
        return (length / slope**2) ** ((2 - q) / (2 * q - 1)) / slope

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers of the shape for summaries of dimensionless problems."""
        return {"profile_exponent": self.exponent}


@dataclass(frozen=True)
class PowerLawProfile(_PowerLaw):
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

    word: ClassVar[str] = "profile"
    symmetry: ClassVar[str] = "revolution"

    coefficient: Annotated[
        float, Quantity("m^(1 - exponent)", "A", "coefficient of the profile A r^q", above=0)
    ]
    exponent: Annotated[
        float,
        Quantity(
            "1",
            "q",
            "exponent of the profile A r^q",
            least=1,
            most=10,
            example="2",
            advice="1 is a cone, 10 a blunt tip; for a flat punch see theory.profiles",
        ),
    ]

    def reduced(self, along: float, height: float) -> "PowerLawProfile":
        """Return the profile with distances in `along` [m] and gaps in `height` [m]."""
        A, q = self.coefficient, self.exponent
        return PowerLawProfile(_snapped(A * along**q / height, 1 / q), q)


@dataclass(frozen=True)
class Cone(_PowerLaw):
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

    word: ClassVar[str] = "cone"
    symmetry: ClassVar[str] = "revolution"

    slope: Annotated[
        float, Quantity("1", "A", "rise of the cone over its radius", above=0, example="0.1")
    ]

    @property
    def coefficient(self) -> float:
        """The slope, as the coefficient of a power law."""
        return self.slope

    @property
    def exponent(self) -> float:
        """That of a cone as a power law, 1."""
        return 1.0

    def reduced(self, along: float, height: float) -> "Cone":
        """Return the cone with distances in `along` [m] and gaps in `height` [m]."""
        return Cone(_snapped(self.slope * along / height, 1.0))


def equivalent_radius(shape: Shape, length: float) -> float:
    r"""Return the radius R [m] of the sphere with the same Tabor number and scales.

    .. math:: \beta f'(\beta)^2 = \Delta\gamma_0/E_0^*, \qquad R = \beta/f'(\beta)

    for the profile f; for a sphere it is its own radius, and else it depends on the `length`
    dg0/E0* [m].

    Raises
    ------
    ValueError
        If the slope is too small or too large everywhere.
    """
    own = getattr(shape, "equivalent_radius", None)
    if own is not None:
        return own(length)

    def excess(decades: float) -> float:
        beta = 10**decades
        return log(beta * float(shape.flank(beta)) ** 2 / length)

    try:
        beta = 10 ** float(scipy.optimize.brentq(excess, *_DECADES, xtol=1e-15))  # type: ignore[arg-type]
    except (ValueError, OverflowError, ZeroDivisionError):
        raise InputError(
            f"the flank of {shape} must rise from the tip outwards: no radius balances "
            f"adhesion over modulus, {length:g} m"
        ) from None
    return beta / float(shape.flank(beta))


def detail(shape: Any) -> float:
    """Return the length over which the slope of a shape changes [m]; inf of one that never falls.

    A shape with a detail may have waves, rings and hollows, and contacts with several edges.
    """
    return getattr(shape, "detail", float("inf"))


def end(shape: Any) -> float:
    """Return the radius to which a shape is known [m]; inf of a formula."""
    return getattr(shape, "end", float("inf"))


def numbers(noun: Any) -> Mapping[str, float]:
    """Dimensionless numbers of a shape or a body, by name."""
    return getattr(noun, "numbers", {})


def _snapped(value: float, to: float) -> float:
    """Return a number, without the round-off of scales where it is the expected one."""
    return to if abs(value / to - 1) < 1e-9 else value
