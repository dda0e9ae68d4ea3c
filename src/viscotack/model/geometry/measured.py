"""Indenter profile from a table of heights, measured or sampled from a formula."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.cards import Pairs, conform
from viscotack.errors import InputError

# Limits of the number of rows: fewer define no shape, more cannot be resolved by a mesh.
_FEWEST, _MOST = 3, 10_000
# Finest detail considered, as a fraction of the radius to which the profile is known.
_FINEST = 1 / 60


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
        ),
    ]

    def __post_init__(self) -> None:
        conform(self)
        if not _FEWEST <= len(self.points) <= _MOST:
            raise InputError(
                f"points must have {_FEWEST} to {_MOST:,} rows, got {len(self.points):,}"
            )
        try:
            points = tuple((float(r), float(z)) for r, z in self.points)
        except (TypeError, ValueError):
            raise InputError("points must be pairs of numbers, a radius and a height [m]") from None
        _check(points)
        lowest = min(z for _, z in points)
        object.__setattr__(self, "points", tuple((r, z - lowest) for r, z in points))
        r, z = np.array(self.points).T
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


def _check(points: tuple[tuple[float, float], ...]) -> None:
    """Refuse rows that are no profile."""
    r, z = np.array(points).T
    if not (np.isfinite(r).all() and np.isfinite(z).all()):
        raise InputError("radii and heights must be finite numbers")
    if r[0] != 0 or np.any(np.diff(r) <= 0):
        raise InputError(f"radii must ascend from 0, the axis, got {r[0]:g} m to {r[-1]:g} m")
    if not z[-1] > min(z):
        raise InputError("the height must rise at the last row; add rows farther out")
