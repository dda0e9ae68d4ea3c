"""Targets of a design, its conditions, and the variables that are free between bounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import partial
from math import exp, inf, log
from typing import Annotated, Any, Literal

import numpy as np

from viscotack.arrays import Array
from viscotack.cards import Quantity, conform
from viscotack.errors import InputError
from viscotack.model.geometry import Bonded
from viscotack.model.tables import Read, Reading

# Names of the variables of a design.
VARIABLES = (
    "radius",
    "preload",
    "pads",
    "hold_speed",
    "release_speed",
    "modulus",
    "thickness",
    "exponent",
    "backing",
)
# Variables that a design has without bounds: a sphere of the stated material on a half-space.
OF_PADS = ("modulus", "thickness", "exponent", "backing")
INTERFACE = ("work_of_adhesion", "equilibrium_gap")
MOST_PADS = 10_000
# Largest relative standard deviation of a tolerance.
_LARGEST = 0.5
_Above = partial(Quantity, above=0)


@dataclass(frozen=True)
class Targets:
    """What a design must hold and release.

    Parameters
    ----------
    hold : float or None
        Least pull-off force of all pads at the hold speed [N].
    release : float or None
        Largest pull-off force of all pads at the release speed [N].
    ratio : float or None
        Least ratio of both forces.
    work : float or None
        Least work to pull-off of all pads at the hold speed [J].
    dead_load : float or None
        Weight that hangs on all pads for the holding time [N].
    preload : float or None
        Largest preload of all pads [N].
    holding_time : float or None
        Time for which the dead load is held [s].

    Examples
    --------
    >>> Targets(hold=5e-3, release=1e-3).least_ratio
    5.0
    """

    hold: Annotated[float, _Above("N", "F", "least pull-off force", example="5 mN")] | None = None
    release: Annotated[float, _Above("N", "F", "largest pull-off force", example="1 mN")] | None = (
        None
    )
    ratio: Annotated[float, _Above("1", "q", "least ratio of both forces", example="4")] | None = (
        None
    )
    work: Annotated[float, _Above("J", "W", "least work to pull-off", example="20 nJ")] | None = (
        None
    )
    dead_load: Annotated[float, _Above("N", "G", "weight that hangs", example="2 mN")] | None = None
    preload: Annotated[float, _Above("N", "P", "largest preload", example="10 mN")] | None = None
    holding_time: (
        Annotated[float, _Above("s", "t", "time of the dead load", example="60 s")] | None
    ) = None

    def __post_init__(self) -> None:
        conform(self)
        if not self.stated.keys() - {"preload"}:
            raise InputError("a design needs a target: hold, release, ratio, work or dead_load")
        if (self.dead_load is None) != (self.holding_time is None):
            raise InputError("a dead_load needs its holding_time, and the other way round")

    @property
    def stated(self) -> dict[str, float]:
        """The targets that are stated, by their names."""
        values = ((x.name, getattr(self, x.name)) for x in fields(self) if x.name != "holding_time")
        return {name: value for name, value in values if value is not None}

    @property
    def least_ratio(self) -> float | None:
        """Least ratio of the forces: as stated, or that of hold and release."""
        implied = [] if self.hold is None or self.release is None else [self.hold / self.release]
        known = implied if self.ratio is None else [*implied, self.ratio]
        return max(known, default=None)

    @property
    def needs_hold(self) -> bool:
        """Whether a target depends on the hold speed."""
        return not self.hold is self.ratio is self.work is None

    @property
    def needs_release(self) -> bool:
        """Whether a target depends on the release speed."""
        return self.release is not None or self.ratio is not None


@dataclass(frozen=True)
class Conditions:
    """Conditions that a design must bear: at the worst of them each target counts.

    Parameters
    ----------
    hold_window : float
        Holds at all speeds from the hold speed to this times it.
    release_window : float
        Releases at all speeds from the release speed to one over this times it.
    shifts : mapping of str to (float, float)
        Least and largest factor on the times of each material, a_T, over the temperatures. By
        superposition a test at the speed v is one at v a_T of the stated material.
    deviations : mapping of str to float
        Relative standard deviations of variables, "work_of_adhesion" and "equilibrium_gap" from
        part to part.
    share : float
        Least share of the parts that meet all targets, the yield; 0 without deviations.

    Examples
    --------
    >>> Conditions(hold_window=10.0).speeds("hold", "rubber", 1e-3)
    (0.001, 0.01)
    """

    hold_window: float = 1.0
    release_window: float = 1.0
    shifts: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    deviations: Mapping[str, float] = field(default_factory=dict)
    share: float = 0.0

    def __post_init__(self) -> None:
        for name in ("hold_window", "release_window"):
            if not 1 <= getattr(self, name) < inf:
                raise InputError(f"the {name} must be at least 1, got {getattr(self, name)!r}")
        known = [name for name in (*VARIABLES, *INTERFACE) if name != "pads"]
        for name, value in self.deviations.items():
            if name not in known:
                raise InputError(f"no scatter of {name!r:.60}; known are {', '.join(known)}")
            if not 0 < value <= _LARGEST:
                raise InputError(
                    f"the relative standard deviation of {name} must be above 0 and at most "
                    f"{_LARGEST:g}, got {value:g}"
                )
        if bool(self.deviations) != (self.share > 0) or not 0 <= self.share < 1:
            raise InputError(
                "a scatter needs the yield, a share between 0 and 1, and the other way round; got "
                f"{self.share:g}"
            )

    def speeds(self, name: str, material: str, speed: float) -> tuple[float, ...]:
        """Return the ends of the speeds at which the stated material is like all conditions."""
        least, most = self.shifts.get(material, (1.0, 1.0))
        if name == "hold":
            ends = speed * least, speed * self.hold_window * most
        else:
            ends = speed / self.release_window * least, speed * most
        return tuple(dict.fromkeys(ends))

    def holding_time(self, material: str, time: float) -> float:
        """Return the longest holding time for the stated material over the temperatures [s]."""
        return time / self.shifts.get(material, (1.0, 1.0))[0]


@dataclass(frozen=True)
class Bounds:
    """Least and largest value of a variable in SI; equal ones fix it.

    Examples
    --------
    >>> Bounds(1e-3).high
    0.001
    """

    low: float
    high: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "high", self.low if self.high is None else self.high)
        if not 0 < self.low <= self.top < inf:
            raise InputError(
                f"bounds must be positive and ascending, got {self.low!r} to {self.high!r}"
            )

    @property
    def top(self) -> float:
        """The largest value."""
        assert self.high is not None
        return self.high


def ends(value: Any, reading: Reading, unit: str, example: str = "") -> list[float]:
    """Return a quantity, or both ends of a range "1 mm..10 mm"."""
    parts = value.split("..", 1) if isinstance(value, str) else [value]
    return [reading.parsed(x.strip() if isinstance(x, str) else x, unit, example) for x in parts]


@dataclass(frozen=True)
class Between:
    """Marks a field of a table that has bounds: a quantity, or a range "1 mm..10 mm"."""

    unit: str
    example: str

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        """Read the bounds."""
        return Read(
            lambda value, reading: Bounds(*ends(value, reading, self.unit, self.example))
        ).__get_pydantic_core_schema__(source, handler)


@dataclass(frozen=True)
class Choice:
    """One design: a value of each variable, in SI.

    Attributes
    ----------
    material : str
        Name of the material.
    radius : float
        Radius of the sphere [m].
    preload : float
        Force of the relaxed start [N] on all pads.
    pads : int
        Number of equal pads on a rigid backing.
    hold_speed, release_speed : float or None
        Speeds of the two pulls [m/s]; None if no target depends on one.
    modulus : float or None
        Rubbery modulus [Pa] of a family with the spectrum of the material: all moduli scale. None
        for the material as it is.
    thickness : float or None
        Of a layer of the material on a rigid base [m]; None for a half-space.
    exponent : float or None
        q of the profile r^q/(q R^(q-1)), from a cone (1) over the sphere (2) to flatter tips; None
        for a sphere.
    backing : float or None
        Stiffness of the backing of each pad [N/m]; None for a rigid one.
    """

    material: str
    radius: float
    preload: float
    pads: int
    hold_speed: float | None
    release_speed: float | None
    modulus: float | None = None
    thickness: float | None = None
    exponent: float | None = None
    backing: float | None = None


@dataclass(frozen=True)
class DesignSpace:
    """Bounds of the variables of a design.

    Parameters
    ----------
    radius : Bounds
        Of the sphere [m].
    preload : Bounds
        Force of the relaxed start on all pads [N]; the largest is the limit of the preload.
    hold_speed, release_speed : Bounds or None
        Speeds at which the design must hold and release [m/s].
    pads : Bounds
        Number of equal pads on a rigid backing, whole numbers.
    area : float or None
        Largest area of the pads [m^2], spheres side by side in squares of 2 R: N (2 R)^2.
    modulus, thickness, exponent, backing : Bounds or None
        As in :class:`Choice`; None leaves a sphere of the stated material on a half-space and a
        rigid backing.
    base : str
        Whether a layer is "bonded" to its base or slides, "frictionless".

    Examples
    --------
    >>> space = DesignSpace(
    ...     Bounds(1e-3, 4e-3), Bounds(1e-3), hold_speed=Bounds(1e-5, 1e-3), area=1e-4
    ... )
    >>> space.free
    ('radius', 'hold_speed')
    >>> space.most_pads(4e-3)
    1
    """

    radius: Annotated[Bounds, Between("m", "1 mm..10 mm")]
    preload: Annotated[Bounds, Between("N", "1 mN..20 mN")]
    hold_speed: Annotated[Bounds | None, Between("m/s", "100 um/s..10 mm/s")] = None
    release_speed: Annotated[Bounds | None, Between("m/s", "0.1 um/s..10 um/s")] = None
    pads: Annotated[Bounds, Between("1", "1..12")] = Bounds(1)
    area: Annotated[float, _Above("m^2", "A", "largest area", example="4 cm^2")] | None = None
    modulus: Annotated[Bounds | None, Between("Pa", "0.5 MPa..5 MPa")] = None
    thickness: Annotated[Bounds | None, Between("m", "100 um..2 mm")] = None
    exponent: Annotated[Bounds | None, Between("1", "2..4")] = None
    backing: Annotated[Bounds | None, Between("N/m", "100 N/m..10 kN/m")] = None
    base: Literal["frictionless", "bonded"] = "frictionless"

    @property
    def bonded(self) -> bool:
        """Whether a layer is bonded to its base."""
        return self.base == Bonded.word

    def __post_init__(self) -> None:
        if any(end != int(end) or end > MOST_PADS for end in (self.pads.low, self.pads.top)):
            raise InputError(f"the number of pads must be a whole number up to {MOST_PADS:,}")
        if self.bonded and self.thickness is None:
            raise InputError("a bonded layer needs bounds of its thickness")
        if (
            self.area is not None
            and not self.used_area(self.radius.low, self.pads.low) <= self.area
        ):
            raise InputError(
                f"the area of {self.area:.4g} m^2 is smaller than that of the least pads, "
                f"{self.used_area(self.radius.low, self.pads.low):.4g} m^2"
            )

    @property
    def variables(self) -> dict[str, Bounds]:
        """The variables with bounds, by their names."""
        values = ((name, getattr(self, name)) for name in VARIABLES)
        return {name: each for name, each in values if each is not None}

    @property
    def free(self) -> tuple[str, ...]:
        """Names of the variables that are not fixed."""
        return tuple(name for name, each in self.variables.items() if each.low < each.top)

    def used_area(self, radius: float, pads: float) -> float:
        """Return the area of pads side by side [m^2]."""
        return pads * (2 * radius) ** 2

    def most_pads(self, radius: float) -> int:
        """Return the largest number of pads of a radius [m]; 0 if the area has room for none."""
        if self.area is None:
            return int(self.pads.top)
        room = int(self.area / self.used_area(radius, 1) * (1 + 1e-12))
        return min(int(self.pads.top), room) if room >= self.pads.low else 0

    def choice(self, material: str, places: Array) -> Choice:
        """Return the design at places in the ranges of the free variables (:meth:`ends`)."""
        found: dict[str, float | None] = {name: None for name in VARIABLES}
        found |= {name: each.low for name, each in self.variables.items()}
        for name, place in zip(self.free, places.tolist(), strict=True):
            value, each = place if name == "pads" else exp(place), self.variables[name]
            found[name] = min(max(value, each.low), each.top)
        return Choice(material, **{**found, "pads": round(found["pads"] or 1)})  # type: ignore[arg-type]

    def places(self, choice: Choice) -> Array:
        """Return the places of a design, the inverse of :meth:`choice`."""
        values = [(name, float(getattr(choice, name))) for name in self.free]
        return np.array([x if name == "pads" else log(x) for name, x in values])

    def ends(self) -> list[tuple[float, float]]:
        """Return the ranges of the free variables: logarithms, and the number of pads itself."""
        return [
            (each.low, each.top) if name == "pads" else (log(each.low), log(each.top))
            for name, each in self.variables.items()
            if name in self.free
        ]
