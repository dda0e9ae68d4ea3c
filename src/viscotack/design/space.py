"""Targets of a design, and the variables that are free between bounds."""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import exp, inf, log

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError

HOLD, RELEASE, RATIO = "hold", "release", "ratio"
RADIUS, PRELOAD, PADS = "radius", "preload", "pads"
HOLD_SPEED, RELEASE_SPEED = "hold_speed", "release_speed"
UNITS = {RADIUS: "m", PRELOAD: "N", PADS: "1", HOLD_SPEED: "m/s", RELEASE_SPEED: "m/s"}
MOST_PADS = 10_000


@dataclass(frozen=True)
class Targets:
    """Forces that a design must hold and release.

    Parameters
    ----------
    hold : float or None
        Least pull-off force of all pads at the hold speed [N].
    release : float or None
        Largest pull-off force of all pads at the release speed [N].
    ratio : float or None
        Least ratio of both forces.

    Examples
    --------
    >>> Targets(hold=5e-3, release=1e-3).least_ratio
    5.0
    """

    hold: float | None = None
    release: float | None = None
    ratio: float | None = None

    def __post_init__(self) -> None:
        if not self.stated:
            raise InputError("a design needs a target: hold, release or ratio")
        for name, value in self.stated.items():
            if not 0 < value < inf:
                raise InputError(f"the target {name} must be positive, got {value!r}")

    @property
    def stated(self) -> dict[str, float]:
        """The targets that are stated, by their names."""
        values = ((field.name, getattr(self, field.name)) for field in fields(self))
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
        return self.hold is not None or self.ratio is not None

    @property
    def needs_release(self) -> bool:
        """Whether a target depends on the release speed."""
        return self.release is not None or self.ratio is not None


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
    """

    material: str
    radius: float
    preload: float
    pads: int
    hold_speed: float | None
    release_speed: float | None


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

    radius: Bounds
    preload: Bounds
    hold_speed: Bounds | None = None
    release_speed: Bounds | None = None
    pads: Bounds = Bounds(1)
    area: float | None = None

    def __post_init__(self) -> None:
        if any(end != int(end) or end > MOST_PADS for end in (self.pads.low, self.pads.top)):
            raise InputError(f"the number of pads must be a whole number up to {MOST_PADS:,}")
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
        values = ((name, getattr(self, name)) for name in UNITS)
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
        found: dict[str, float | None] = {name: None for name in UNITS}
        found |= {name: each.low for name, each in self.variables.items()}
        for name, place in zip(self.free, places.tolist(), strict=True):
            value, each = place if name == PADS else exp(place), self.variables[name]
            found[name] = min(max(value, each.low), each.top)
        return Choice(material, **{**found, PADS: round(found[PADS] or 1)})  # type: ignore[arg-type]

    def places(self, choice: Choice) -> Array:
        """Return the places of a design, the inverse of :meth:`choice`."""
        values = [(name, float(getattr(choice, name))) for name in self.free]
        return np.array([x if name == PADS else log(x) for name, x in values])

    def ends(self) -> list[tuple[float, float]]:
        """Return the ranges of the free variables: logarithms, and the number of pads itself."""
        return [
            (each.low, each.top) if name == PADS else (log(each.low), log(each.top))
            for name, each in self.variables.items()
            if name in self.free
        ]
