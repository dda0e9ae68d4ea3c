"""Traction law from a table, measured or computed by another program."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.errors import InputError
from viscotack.model.traction.law import LawOfGap, checked_gap

# Tolerance of the table's work and zero.
_ROUND_OFF = 1e-9
# Largest number of gaps; finer tables gain nothing and slow every evaluation.
_MOST_POINTS = 10_000


@dataclass(frozen=True)
class Tabulated(LawOfGap):
    r"""Traction law through points, monotone between them (no artificial extrema).

    The traction is the piecewise cubic of Fritsch and Carlson, its energy the exact integral. It is
    zero above the last gap and continues linearly below the first one. Because the repulsion at gap
    0 is then finite, a surface pressed harder has no equilibrium: begin the table well inside the
    repulsion.

    Parameters
    ----------
    work_of_adhesion : float
        Delta-gamma_0, work to separate unit area from the equilibrium gap [J/m^2]; positive.
    equilibrium_gap : float
        h_0, the gap of zero traction [m]; positive.
    points : tuple of (float, float)
        Gaps over h_0, ascending, and tractions over Delta-gamma_0/h_0: repulsion (negative) first,
        one zero at 1, zero at the end, and a work of 1. :meth:`of_points` computes them from a
        table in SI.

    Raises
    ------
    ValueError
        If the points do not define such a law.

    References
    ----------
    Fritsch & Carlson (1980), doi:10.1137/0717021.

    Examples
    --------
    >>> gap = [0.8e-6, 1.0e-6, 1.2e-6, 1.5e-6, 2.5e-6, 4e-6]
    >>> law = Tabulated.of_points(gap, [-400e3, 0.0, 100e3, 80e3, 10e3, 0.0])
    >>> f"{law.work_of_adhesion * 1e3:.0f} mJ/m^2, {law.strength / 1e3:.0f} kPa"
    '86 mJ/m^2, 100 kPa'
    """

    word: ClassVar[str] = "table"

    points: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        super().__post_init__()
        _check_number(len(self.points))
        points = tuple((float(gap), float(traction)) for gap, traction in self.points)
        object.__setattr__(self, "points", points)
        _check(*np.array(points, dtype=float).reshape(-1, 2).T)
        at_one = float(self._curves.traction(1.0))
        work = float(self._curves.energy(points[-1][0]) - self._curves.energy(1.0))
        size = max(abs(traction) for _, traction in points)
        if abs(work - 1) > _ROUND_OFF or abs(at_one) > _ROUND_OFF * size:
            raise InputError(
                "points must have zero traction at gap 1 and work 1 beyond it, got "
                f"{at_one:g} and {work:g}; Tabulated.of_points normalises them"
            )

    @classmethod
    def of_points(cls, gap: npt.ArrayLike, traction: npt.ArrayLike) -> "Tabulated":
        """Return the law through a table of gaps [m] and tractions [Pa], tension positive.

        Work of adhesion and equilibrium gap follow from the curve through the points.
        """
        h, t = np.asarray(gap, dtype=float), np.asarray(traction, dtype=float)
        _check_number(len(h))
        _check(h, t)
        curve = scipy.interpolate.PchipInterpolator(h, t)
        after = int(np.argmax(t > 0))
        low, high = float(h[after - 1]), float(h[after])
        h0: float = scipy.optimize.brentq(curve, low, high, xtol=_ROUND_OFF**2 * low)  # type: ignore[assignment]
        work = float(curve.integrate(h0, h[-1]))
        scaled = np.column_stack([h / h0, t * h0 / work])
        return cls(work, h0, tuple((float(x), float(y)) for x, y in scaled))

    def traction(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the traction [Pa], positive in tension, at a gap [m] of any shape."""
        scale = self.work_of_adhesion / self.equilibrium_gap
        return scale * self._curves.traction(self._within(gap))

    def energy(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the energy per area [J/m^2] at a gap [m]: 0 at infinity, minimum at h_0."""
        return self.work_of_adhesion * self._curves.energy(self._within(gap))

    def energy_beyond(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the integral of the energy from a gap [m] to infinity [J/m]; 0 beyond the table.

        Multiplied by 2 pi R it is the energy of a sphere's flank that begins at this gap
        (Derjaguin).
        """
        scale = self.work_of_adhesion * self.equilibrium_gap
        return -scale * self._curves.energy_so_far(self._within(gap))

    def stiffness(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the derivative of the traction by the gap [Pa/m]; negative where it softens."""
        scale = self.work_of_adhesion / self.equilibrium_gap**2
        within = self._within(gap)
        # the curve may reach the end with a slope; beyond it the slope is zero
        return scale * self._curves.stiffness(within) * (within < self.points[-1][0])

    @property
    def strength(self) -> float:
        """Largest tension of the law [Pa], at one of the points of the monotone curve."""
        scale = self.work_of_adhesion / self.equilibrium_gap
        return scale * max(traction for _, traction in self.points)

    @property
    def edge_gap(self) -> float:
        """Gap of the largest tension [m]; defines the contact edge."""
        gap, _ = max(self.points, key=lambda point: point[1])
        return gap * self.equilibrium_gap

    def _within(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return gaps over h_0, limited to the end of the table, where the traction is zero."""
        return np.minimum(checked_gap(gap) / self.equilibrium_gap, self.points[-1][0])

    @cached_property
    def _curves(self) -> "_Curves":
        """Curve through the points, its derivative and its integrals, zero at the end."""
        gap, traction = np.array(self.points).T
        inner = scipy.interpolate.PchipInterpolator(gap, traction)
        # a first piece from gap 0, straight, and a last one without anything, its slope neither
        slope = float(inner(gap[0], 1))
        wall = np.array([0.0, 0.0, slope, traction[0] - slope * gap[0]])
        pieces = np.column_stack([wall, inner.c, np.zeros(4)])
        curve = scipy.interpolate.PPoly(pieces, np.concatenate([[0.0], gap, [gap[-1] + 1]]))
        energy = _zero_at_end(curve.antiderivative())
        return _Curves(curve, energy, _zero_at_end(energy.antiderivative()), curve.derivative())


class _Curves(NamedTuple):
    traction: "scipy.interpolate.PPoly"
    energy: "scipy.interpolate.PPoly"
    energy_so_far: "scipy.interpolate.PPoly"
    stiffness: "scipy.interpolate.PPoly"


def _zero_at_end(curve: "scipy.interpolate.PPoly") -> "scipy.interpolate.PPoly":
    """Shift the curve to zero at its end, summed from there to avoid cancellation."""
    moved, step = curve.c.copy(), np.diff(curve.x)
    moved[-1] = 0.0
    gained = np.sum([c * step**power for power, c in enumerate(moved[::-1])], axis=0)
    moved[-1] = -np.cumsum(gained[::-1])[::-1]
    return scipy.interpolate.PPoly(moved, curve.x)


def _check_number(points: int) -> None:
    if points > _MOST_POINTS:
        raise InputError(f"a table has at most {_MOST_POINTS:,} gaps, got {points:,}; remove rows")


def _check(gap: npt.NDArray, traction: npt.NDArray) -> None:
    """Raise an error for points that do not define a law."""
    if gap.ndim != 1 or gap.shape != traction.shape or len(gap) < 4:
        raise InputError("a table needs at least four gaps, and as many tractions")
    if not (np.isfinite(gap).all() and np.isfinite(traction).all()):
        raise InputError("gaps and tractions must be finite numbers")
    if gap[0] <= 0 or np.any(np.diff(gap) <= 0):
        raise InputError(f"gaps must be positive and ascend, got {gap}")
    if not (traction[0] < 0 and traction[1] > traction[0]):
        raise InputError(
            "the table must begin with repulsion (a negative traction) that falls with the gap, "
            f"got {traction[0]:g} and {traction[1]:g} at its first gaps"
        )
    if traction[-1] != 0:
        raise InputError(
            f"the traction must be zero at the last gap, got {traction[-1]:g}; add a row with the "
            "end of the range"
        )
    if traction.max() <= 0 or sum(a < 0 <= b or a >= 0 > b for a, b in pairwise(traction)) != 1:
        raise InputError(
            "the traction must change its sign once, from repulsion to tension, got "
            f"{traction}; smooth the table first"
        )
