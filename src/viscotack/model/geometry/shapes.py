"""Indenter shapes: the gap between the rigid indenter and the flat body at first contact.

A shape of revolution implements :meth:`gap`, its derivative :meth:`flank`, and :meth:`reduced`,
which returns the shape in other units of length. `word` is its name in files. A shape whose slope
decreases somewhere has a length over which it changes (:func:`detail`). A shape known only to some
radius states this radius (:func:`end`). Any class with these attributes is a shape; docs/own.md
explains an example. The attribute `symmetry` determines scales, limits and outputs: "revolution",
or "plane" for the flat punch in plane strain.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import log, pi, sqrt
from typing import Annotated, Any, ClassVar, Protocol

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.cards import Checked, Pairs, Quantity, conform
from viscotack.errors import InputError

# Decades of radius [m] over which a shape of revolution is examined.
_DECADES = (-30.0, 30.0)
# Finest detail considered, as a fraction of the radius to which the profile is known.
_FINEST = 1 / 60


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

    def reduced(self, along: float, height: float) -> Shape:
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

    def reduced(self, along: float, height: float) -> Sphere:
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
        :func:`viscotack.model.materials.conversion.effective_solid`.

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

    def reduced(self, along: float, height: float) -> FlatPunch:
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

    def reduced(self, along: float, height: float) -> PowerLawProfile:
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

    def reduced(self, along: float, height: float) -> Cone:
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


@dataclass(frozen=True)
class MeasuredProfile:
    r"""Rigid indenter of revolution through measured heights, such as those of a profilometer.

    Between rows the height is the monotone cubic of Fritsch and Carlson in :math:`r^2`: it adds no
    extrema to the table, its slope is continuous, and it is exact for a paraboloid. The tip is
    round within the first row. Beyond the last row the profile is continued as a power law of the
    radius. This part serves only for the attraction on the flank; a contact that spreads so far is
    rejected.

    Parameters
    ----------
    points : tuple of (float, float)
        Distances from the axis [m], ascending from 0, and heights of the indenter [m], upwards,
        from any level: 0 becomes the lowest one. The heights rise at the last row. Noise counts as
        shape: smooth the rows first.

    Raises
    ------
    ValueError
        If the rows state no such profile.

    References
    ----------
    Fritsch & Carlson (1980), doi:10.1137/0717021.

    Examples
    --------
    A sphere of 5 mm, worn flat over a radius of 0.1 mm:

    >>> worn = MeasuredProfile.sampled(
    ...     lambda r: max(r**2 - 1e-4**2, 0) / (2 * 5e-3), np.linspace(0, 5e-4, 51)
    ... )
    >>> f"{worn.gap(3e-4) * 1e6:.2f} um, equivalent radius {worn.equivalent_radius(0) * 1e3:.2f} mm"
    '8.00 um, equivalent radius 5.02 mm'
    """

    word: ClassVar[str] = "measured-profile"
    symmetry: ClassVar[str] = "revolution"

    points: Annotated[
        tuple[tuple[float, float], ...],
        Pairs(
            ("m", "m"),
            "r, z",
            "distance from the axis and height of the profile there",
            example='[["0 um", "0 um"], ["50 um", "1 um"], ["100 um", "4 um"]]',
            fewest=3,
        ),
    ]

    def __post_init__(self) -> None:
        conform(self)
        points = self.points
        r, z = np.array(points).T
        if r[0] != 0 or np.any(np.diff(r) <= 0):
            raise InputError(f"radii must ascend from 0, the axis, got {r[0]:g} m to {r[-1]:g} m")
        if not z[-1] > min(z):
            raise InputError("the height must rise at the last row; add rows farther out")
        lowest = min(z for _, z in points)
        object.__setattr__(self, "points", tuple((r, z - lowest) for r, z in points))
        if not self._fit > 0:
            raise InputError(
                "the profile must rise outwards as a whole, and the sphere closest to it is "
                "hollow: add rows farther out"
            )
        if not float(self._inner(r[-1] ** 2, 1)) > 0:
            raise InputError(f"the height must rise at the last row, {r[-1]:g} m; add rows or cut")

    @classmethod
    def sampled(cls, height: Callable[[float], float], radii: npt.ArrayLike) -> MeasuredProfile:
        """Return the profile of a formula, height [m] of a distance from the axis [m], at radii."""
        r = np.asarray(radii, dtype=float)
        return cls(tuple((float(x), float(height(float(x)))) for x in r))

    def gap(self, position: npt.ArrayLike) -> Array:
        """Return the undeformed gap [m] at a distance from the axis [m]; 0 at the lowest place."""
        r = np.asarray(position, dtype=float)
        inside = self._inner(np.minimum(r, self.end) ** 2)
        height, power = self._rim
        return np.where(
            r <= self.end, inside, height * (np.maximum(r, self.end) / self.end) ** power
        )

    def flank(self, position: npt.ArrayLike) -> Array:
        """Return the slope of the profile at a distance from the axis [m]; it may fall."""
        r = np.asarray(position, dtype=float)
        within = np.minimum(r, self.end)
        height, power = self._rim
        beyond = height * power / self.end * (np.maximum(r, self.end) / self.end) ** (power - 1)
        return np.where(r <= self.end, 2 * within * self._inner(within**2, 1), beyond)

    @property
    def end(self) -> float:
        """The radius to which it is known [m]."""
        return self.points[-1][0]

    @property
    def detail(self) -> float:
        """The length over which the slope may change [m]: two rows, but no less than end/60."""
        rows = min(b - a for (a, _), (b, _) in pairwise(self.points))
        return max(2 * rows, _FINEST * self.end)

    def equivalent_radius(self, length: float) -> float:
        """Return the radius of the sphere closest to the table [m], by area; any length will do."""
        return 1 / (2 * self._fit)

    def reduced(self, along: float, height: float) -> MeasuredProfile:
        """Return the profile with distances in `along` [m] and gaps in `height` [m]."""
        return MeasuredProfile(tuple((r / along, z / height) for r, z in self.points))

    @cached_property
    def _fit(self) -> float:
        """The slope of the height over r^2 by least squares over the area [1/m]."""
        r, z = np.array(self.points).T
        s, weight = r * r, np.gradient(r * r)
        s = s - np.average(s, weights=weight)
        return float(np.sum(weight * s * z) / np.sum(weight * s * s))

    @cached_property
    def _inner(self) -> scipy.interpolate.PchipInterpolator:
        r, z = np.array(self.points).T
        return scipy.interpolate.PchipInterpolator(r * r, z)

    @cached_property
    def _rim(self) -> tuple[float, float]:
        """Height at the last row, and exponent of the power law beyond it."""
        height = self.points[-1][1]
        return height, float(2 * self.end**2 * self._inner(self.end**2, 1)) / height
