r"""Edges of many interfaces that grow with the opening speed, of one solid: for grids and fits.

A crack costs a table of its own for every reference speed (over h0 per unit of time) and exponent,
0.5 to 2 s. At one speed :math:`\ln(\Gamma - 1)` and the work of the interface are smooth in both:
cubic splines in ln v0 and n, from a lattice. With tables a decade and an exponent of 0.15 apart
(28 of them for seven decades), energies between them are those of their own cracks within 1.3 %,
below 20 works of adhesion within 1.0 %, for a standard solid and a power law of 0.3 with k from
1e-3. Receding contacts (:func:`.recede`) take from it an edge of their own for each case.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import RectBivariateSpline

from viscotack.errors import InputError
from viscotack.materials import Modes
from viscotack.theory.crack.steady import SteadyCrack
from viscotack.traction import GentSchultz, LennardJones, Traction

Array = npt.NDArray[np.float64]

# Rows of a table over ln V; an energy beyond the last crack goes on with this slope at least.
_ROWS, _LEAST_SLOPE = 500, 0.2
# What counts as the largest energy: beyond, tables are extrapolated.
_LIMIT = 250.0
_ORDER = 3


class GrowingCracks:
    """The opening cracks of a solid with Gent-Schultz growth, over reference speeds and exponents.

    Parameters
    ----------
    material : viscoelastic material
        Reduced, or in SI: reference speeds are then those of a law with h0 = 1 m.
    reference_speeds, exponents : sequence of float
        The lattice, at least four of each, ascending; speeds in h0 per unit of time.
    base : Traction
        The reduced law at rest.
    """

    def __init__(
        self,
        material: Any,
        reference_speeds: Sequence[float],
        exponents: Sequence[float],
        *,
        base: Traction | None = None,
    ) -> None:
        v0, n = np.asarray(reference_speeds, dtype=float), np.asarray(exponents, dtype=float)
        few = min(v0.size, n.size) <= _ORDER
        if few or np.any(np.diff(v0) <= 0) or np.any(np.diff(n) <= 0) or v0[0] <= 0:
            raise InputError(
                "a lattice has four reference speeds and four exponents at least, ascending, got "
                f"{v0.tolist()} and {n.tolist()}"
            )
        base = LennardJones(1.0, 1.0) if base is None else base
        reduced = material.reduced()
        cracks = [
            [SteadyCrack(reduced, GentSchultz(1.0, 1.0, x, y, base=base)) for y in n] for x in v0
        ]
        flat = [crack for row in cracks for crack in row]
        ends = np.array([_ends(crack) for crack in flat])
        self._log_speed = np.linspace(ends[:, 0].min(), ends[:, 1].max(), _ROWS)
        tables = np.array([[_table(crack, self._log_speed) for crack in row] for row in cracks])
        self._gained, self._work = (
            [
                RectBivariateSpline(np.log(v0), n, tables[:, :, k, i], kx=3, ky=3)
                for i in range(_ROWS)
            ]
            for k in (0, 1)
        )
        self._ranges = (v0[0], v0[-1]), (n[0], n[-1])
        self.modes: Modes = flat[0].modes

    def edges(self, reference_speed: npt.ArrayLike, exponent: npt.ArrayLike) -> GrowingEdges:
        """Return the edges of cases, each with its reference speed and exponent.

        Raises
        ------
        ValueError
            If one lies outside the lattice.
        """
        v0, n = (np.ravel(x) for x in np.broadcast_arrays(reference_speed, exponent))
        for name, values, (low, high) in zip(
            ("reference_speed", "exponent"), (v0, n), self._ranges, strict=True
        ):
            if np.any((values < low * (1 - 1e-9)) | (values > high * (1 + 1e-9))):
                raise InputError(
                    f"{name} must lie within the lattice, {low:g} to {high:g}, got "
                    f"{values.min():g} to {values.max():g}"
                )
        pairs, which = np.unique(np.column_stack([np.log(v0), n]), axis=0, return_inverse=True)
        gained = np.array([one.ev(pairs[:, 0], pairs[:, 1]) for one in self._gained]).T
        work = np.array([one.ev(pairs[:, 0], pairs[:, 1]) for one in self._work]).T
        return GrowingEdges(self.modes, self._log_speed, gained, work, which.ravel())


class GrowingEdges:
    """An edge for each case, as :func:`.recede` takes it in the place of a crack."""

    def __init__(
        self,
        modes: Modes,
        log_speed: Array,
        gained: Array,
        work: Array,
        which: npt.NDArray[np.intp],
    ) -> None:
        self.modes, self.limit = modes, _LIMIT
        self._first, self._per = log_speed[0], (_ROWS - 1) / (log_speed[-1] - log_speed[0])
        self._gained, self._log_work, self._which = gained, work, which

    def amplification(self, speed: Any) -> Any:
        """Return the energies of the cases at their speeds, the cases along the last axis."""
        return 1 + np.exp(self._at(self._gained, speed))

    def interface_work(self, speed: Any) -> Any:
        """Return what the interfaces take [works of adhesion]."""
        return np.exp(np.maximum(self._at(self._log_work, speed), 0.0))

    def _at(self, table: Array, speed: Any) -> Any:
        with np.errstate(divide="ignore"):
            place = np.clip((np.log(speed) - self._first) * self._per, 0.0, _ROWS - 1.0)
        i = np.minimum(place.astype(np.intp), _ROWS - 2)
        low, high = table[self._which, i], table[self._which, i + 1]
        return low + (place - i) * (high - low)


def _ends(crack: SteadyCrack) -> tuple[float, float]:
    """Return ln of the speeds between which a crack is tabulated."""
    last = 1 + (1 - 1e-6) * (min(crack.largest, _LIMIT) - 1)
    first, end = np.log(np.asarray(crack.speed(np.array([1.0001, last]))))
    return float(first), float(end)


def _table(crack: SteadyCrack, log_speed: Array) -> Array:
    """Return ln of what is gained and of the work of the interface at speeds."""
    _, end = _ends(crack)
    inside = np.minimum(log_speed, end)
    gained = np.log(np.asarray(crack.amplification(np.exp(inside))) - 1)
    work = np.log(np.asarray(crack.interface_work(np.exp(inside))))
    before = np.log(np.asarray(crack.amplification(np.exp([end - 0.5, end]))) - 1)
    slope = max(float(before[1] - before[0]) / 0.5, _LEAST_SLOPE)
    beyond = slope * np.maximum(log_speed - end, 0.0)
    return np.array([gained + beyond, work + beyond])
