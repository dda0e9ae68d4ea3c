r"""Edges of many interfaces that grow with the opening speed, on one solid: for grids and fits.

A table of cracks for one reference speed (over h0 per unit of time) and exponent takes
0.4 to 2 s. At one speed :math:`\ln(\Gamma - 1)` and the energy of the interface are smooth
functions of the growth at an opening speed and of the exponent: cubic splines in ln G and n on a
lattice. Below its smallest growth, energies are interpolated in proportion to the growth towards
the law at rest. Receding contacts (:func:`.recede`) use one edge per case.

A similar solid (:class:`NeighbourEdges`) needs no further cracks. In scaled units
(:mod:`viscotack.theory.crack.steady._grown`) a crack with growth equals one of the law at rest
at the speed Q V: the neighbour's bulk has the energy of its own crack at rest at that speed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials import Modes
from viscotack.model.traction import GentSchultz, LennardJones, Traction
from viscotack.model.traction.growing import power_growth
from viscotack.model.traction.growing import reference_speed as speed_of_growth
from viscotack.theory._checks import Values
from viscotack.theory.crack.contact.history import Edge
from viscotack.theory.crack.steady import NeighbourCrack, SteadyCrack

# Rows of a table over ln V; above the last crack the energy is extrapolated with at least this
# slope, determined over this range of ln V.
_ROWS, _LEAST_SLOPE, _NEAR = 500, 0.2, 0.5
# Smallest and largest energy in the tables; beyond, they are extrapolated.
_GAINED, LARGEST_ENERGY = 1.0001, 250.0
_ORDER = 3
# Distance between growths of the lattice (ln), and Gamma - 1 of cracks close to elastic.
_APART, _NOTHING = np.log(5.0), 1e-300
# Effect of a stronger bulk on the energy of the interface, see :class:`NeighbourEdges`.
_LONGER = 1.6
_ROUND_OFF = 1e-9

Kept = Callable[[Callable[[], Mapping[str, Array]]], Mapping[str, Array]]


class GrowingCracks:
    """Opening cracks of a solid with Gent-Schultz growth, over amounts and exponents of growth.

    Parameters
    ----------
    material : viscoelastic material
        Reduced, or in SI: speeds are then those of a law with h0 = 1 m.
    growths : (float, float)
        Smallest and largest growth G.
    speeds : (float, float)
        Range of the opening speeds at which the growth is defined [h0 per unit of time].
    exponents : sequence of float
        Exponents of the lattice, at least four, ascending.
    base : Traction
        Reduced law at rest.
    kept : callable
        Returns the arrays of a function, computed now or earlier.
    """

    def __init__(
        self,
        material: Any,
        growths: tuple[float, float],
        speeds: tuple[float, float],
        exponents: Sequence[float],
        *,
        base: Traction | None = None,
        kept: Kept = lambda compute: compute(),
    ) -> None:
        self.given = growths, speeds, tuple(exponents)
        n = np.asarray(exponents, dtype=float)
        rising = 0 < growths[0] < growths[1] and 0 < speeds[0] <= speeds[1]
        if n.size <= _ORDER or np.any(np.diff(n) <= 0) or not rising:
            raise InputError(
                "a lattice needs at least four ascending exponents, and growths and speeds from "
                f"the smaller to the larger; got {n.tolist()}, {growths!r} and {speeds!r}"
            )
        self._middle = float(np.sqrt(speeds[0] * speeds[1]))
        self._log_growths = np.log(np.array(growths))
        self._half = float(np.log(speeds[1] / speeds[0])) / 2
        self._exponents = n
        low, high = self._ends(n)
        reduced = material.reduced()
        base = LennardJones(1.0, 1.0) if base is None else base
        # a smaller exponent needs fewer growths
        counts = np.maximum(_ORDER + 1, 1 + np.ceil((high - low) / _APART).astype(int))
        part = np.linspace(0.0, 1.0, int(counts.max()))

        def tabulated() -> dict[str, Array]:
            laws = [
                (float(v), float(x))
                for x, a, b, size in zip(n, low, high, counts, strict=True)
                for v in speed_of_growth(np.exp(np.linspace(a, b, size)), self._middle, x)
            ]
            # in the order of the speeds, because near ones share the openings of the solid
            cracks = {
                law: SteadyCrack(reduced, GentSchultz(1.0, 1.0, *law, base=base))
                for law in sorted(laws)
            }
            ends = np.array([_tabulated(crack) for crack in cracks.values()])
            log_speed = np.linspace(ends[:, 0].min(), ends[:, 1].max(), _ROWS)
            tables = np.array([_table(cracks[law], log_speed) for law in laws])
            columns = [
                lattice_spline([np.linspace(0.0, 1.0, len(own))], own)(part[:, None])
                for own in np.split(tables, np.cumsum(counts)[:-1])
            ]
            return {"log_speed": log_speed, "tables": np.stack(columns, axis=1)}

        found = kept(tabulated)
        self._log_speed = found["log_speed"]
        self._spline = lattice_spline((part, n), found["tables"])
        self.at_rest = SteadyCrack(reduced, base)
        gained = np.asarray(self.at_rest.amplification(np.exp(self._log_speed))) - 1
        self._at_rest = np.maximum(gained, _NOTHING), np.ones(_ROWS)
        self.modes: Modes = self.at_rest.modes

    def edges(self, reference_speed: Values, exponent: Values) -> GrowingEdges:
        """Return the edges of cases, each with its reference speed and exponent.

        An infinite reference speed means no growth.

        Raises
        ------
        ValueError
            If a case grows by more than the lattice, or its exponent is outside the lattice.
        """
        v0, n = (np.ravel(x) for x in np.broadcast_arrays(reference_speed, exponent))
        first, last = self._exponents[0], self._exponents[-1]
        if np.any((n < first * (1 - _ROUND_OFF)) | (n > last * (1 + _ROUND_OFF))):
            raise InputError(
                f"exponent must lie within the lattice, {first:g} to {last:g}, got {n.min():g} to "
                f"{n.max():g}"
            )
        pairs, which = np.unique(np.column_stack([v0, n]), axis=0, return_inverse=True)
        v0, n = pairs[:, 0], np.clip(pairs[:, 1], first, last)
        with np.errstate(divide="ignore"):
            log_growth = np.log(power_growth(self._middle / v0, n))
        low, high = self._ends(n)
        if np.any(log_growth > high + 1e-6):
            raise InputError(
                "the growth of the interface exceeds the lattice by a factor of "
                f"{np.exp(np.max(log_growth - high)):.3g} (widen the lattice)"
            )
        part = (log_growth - low) / (high - low)
        found = self._spline(np.column_stack([np.clip(part, 0.0, 1.0), n]))
        # below the smallest growth of the lattice: proportional to the growth, from the law at rest
        share = np.exp(np.minimum(log_growth - low, 0.0))[:, None]
        gained, work = (
            (1 - share) * rest + share * np.exp(found[:, k]) for k, rest in enumerate(self._at_rest)
        )
        tables = np.log(gained), np.log(work)
        return GrowingEdges(self.modes, self._log_speed, tables, n, which.ravel())

    def _ends(self, exponent: Array) -> tuple[Array, Array]:
        """Return ln of the smallest and largest growth at the middle speed, for exponents."""
        low, high = self._log_growths
        return low - exponent * self._half, high + exponent * self._half


class GrowingEdges:
    """Edges of many cases, accepted by :func:`.recede` in place of a crack."""

    def __init__(
        self,
        modes: Modes,
        log_speed: Array,
        tables: tuple[Array, Array],
        exponent: Array,
        which: npt.NDArray[np.intp],
    ) -> None:
        self.modes, self.limit, self.exponent = modes, LARGEST_ENERGY, exponent[which]
        self._first, self._per = log_speed[0], (_ROWS - 1) / (log_speed[-1] - log_speed[0])
        (self._gained, self._log_work), self._which = tables, which

    def amplification(self, speed: Any) -> Any:
        """Return the energies of the cases at their speeds, with the cases along the last axis."""
        return 1 + np.exp(self._at(self._gained, speed))

    def interface_work(self, speed: Any) -> Any:
        """Return the energies dissipated by the interfaces [works of adhesion]."""
        return np.exp(np.maximum(self._at(self._log_work, speed), 0.0))

    def _at(self, table: Array, speed: Any) -> Any:
        with np.errstate(divide="ignore"):
            place = np.clip((np.log(speed) - self._first) * self._per, 0.0, _ROWS - 1.0)
        i = np.minimum(place.astype(np.intp), _ROWS - 2)
        low, high = table[self._which, i], table[self._which, i + 1]
        return low + (place - i) * (high - low)


class NeighbourEdges:
    r"""Edges of the same interfaces on a solid similar to one with known cracks.

    .. math:: \ln \Gamma_2(V) = \ln \Gamma_1(V) + t \ln \frac{\Gamma_2^0(Q V)}{\Gamma_1^0(Q V)},
              \quad t = \max \left( 0, 1 - 1.6 \, n \, \frac{Q - 1}{Q} \right)

    with the energies :math:`\Gamma^0` of the law at rest, each in the units of its own solid. More
    energy in the bulk makes the zone longer, so the gap opens more slowly and the interface
    dissipates less: with strong growth, a change of the bulk has little effect. The number 1.6
    holds for a zone that grows like :math:`\Gamma^{0.6}`. For solids changed by a third, the
    energies agree with those of their own cracks within 1.5 %, compared with up to 14 % for the law
    at rest.

    Parameters
    ----------
    edges : GrowingEdges
        Edges on the known solid, with reference speeds in h0 per unit of time of the other.
    known : SteadyCrack
        Crack of the known solid with the law at rest.
    neighbour : NeighbourCrack
        Crack of the other solid with the law at rest.
    """

    def __init__(self, edges: GrowingEdges, known: SteadyCrack, neighbour: NeighbourCrack) -> None:
        self.modes, self.limit = neighbour.modes, edges.limit
        self._edges, self._known, self._neighbour = edges, Edge(known, 1), neighbour

    def amplification(self, speed: Any) -> Any:
        """Return the energies of the cases at their speeds, the cases along the last axis."""
        work = self._edges.interface_work(speed)
        at_rest = np.maximum(work * speed, _NOTHING)
        change = self._neighbour.amplification(at_rest) / self._known.amplification(at_rest)
        left = np.maximum(1 - _LONGER * self._edges.exponent * (1 - 1 / work), 0.0)
        return self._edges.amplification(speed) * change**left

    def interface_work(self, speed: Any) -> Any:
        """Return the energies dissipated by the interfaces [works of adhesion]."""
        return self._edges.interface_work(speed)


def lattice_spline(axes: Sequence[Array], values: Array) -> scipy.interpolate.NdBSpline:
    """Return the cubic spline through values on a lattice, whose axes come first."""
    knots, coefficients = [], values
    for i, axis in enumerate(axes):
        one = scipy.interpolate.make_interp_spline(axis, coefficients, k=_ORDER, axis=i)
        # the spline axis comes first
        coefficients = np.moveaxis(one.c, 0, i)
        knots.append(one.t)
    return scipy.interpolate.NdBSpline(tuple(knots), coefficients, _ORDER)


def _tabulated(crack: SteadyCrack) -> tuple[float, float]:
    """Return ln of the speeds between which a crack is tabulated."""
    last = 1 + (1 - 1e-6) * (min(crack.largest, LARGEST_ENERGY) - 1)
    first, end = np.log(np.asarray(crack.speed(np.array([_GAINED, last]))))
    return float(first), float(end)


def _table(crack: SteadyCrack, log_speed: Array) -> Array:
    """Return ln(Gamma - 1) and ln of the interface energy at speeds.

    Beyond the known cracks both are power laws of the speed.
    """
    ends = _tabulated(crack)
    inside = np.clip(log_speed, *ends)
    near = np.array([ends[0], ends[0] + _NEAR, ends[1] - _NEAR, ends[1]])
    gained = np.log(np.asarray(crack.amplification(np.exp(np.append(inside, near)))) - 1)
    gained, (a, b, c, d) = gained[:-4], gained[-4:]
    work = np.log(np.asarray(crack.interface_work(np.exp(inside))))
    below = (b - a) / _NEAR * np.minimum(log_speed - ends[0], 0.0)
    beyond = max((d - c) / _NEAR, _LEAST_SLOPE) * np.maximum(log_speed - ends[1], 0.0)
    return np.array([gained + below + beyond, work * np.exp(below) + beyond])
