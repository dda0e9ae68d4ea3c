"""Pull-off forces interpolated over the unknowns of an interface, for fast search and intervals."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.theory.crack.contact.growing import lattice_spline

from .forward import Forward
from .growth import EXPONENT, STRENGTHENING, Opening
from .travel import PARTS

_AT_ONCE = 20_000  # points interpolated per batch


class Table:
    """Forces over the unknowns of an interface: splines in logarithms.

    Parameters
    ----------
    axes : mapping
        Unknown -> ascending values, at least four.
    logs : ndarray, shape (values of each unknown, columns)
        ln of the forces, and of what else is interpolated.
    count : int
        Number of forces.
    """

    def __init__(self, axes: Mapping[str, Array], logs: Array, count: int) -> None:
        self.axes, self._count = dict(axes), count
        self._spline = lattice_spline([_inner(name, x) for name, x in self.axes.items()], logs)

    @classmethod
    def of_cracks(
        cls,
        forward: Forward,
        speed: Array,
        preload: Array,
        axes: Mapping[str, Array],
        *,
        opening: Opening | None = None,
        travels: bool = False,
        radii: int = 160,
    ) -> "Table":
        """Return the pull-off forces of a steady crack at the edge.

        Parameters
        ----------
        forward : Forward
            Forward model of the material.
        speed, preload : ndarray, shape (S,)
            Speeds [m/s] and preloads [N] of the series.
        axes : mapping
            Values of "work_of_adhesion" and "equilibrium_gap", with growth also of "strengthening"
            and "exponent".
        opening : Opening, optional
            Opening speed at which the strengthening is defined.
        travels : bool
            Whether to interpolate the travels between forces as well.
        radii : int
            Number of points of a curve.
        """
        values = lattice(axes)
        growth = None
        if opening is not None:
            gap = values["equilibrium_gap"]
            growth = opening.growth(gap, values[STRENGTHENING], values[EXPONENT])
        work, gap = values["work_of_adhesion"], values["equilibrium_gap"]
        found = forward.pulled(work, gap, speed, preload, radii, growth)
        least = found.effective_tabor.min(axis=-1)
        columns = [np.log(found.force), np.log(least)[..., None]]
        if travels:
            # travels exist only for starts in compression
            columns.append(np.log(found.travels).reshape(*least.shape, -1))
        return cls(axes, np.concatenate(columns, axis=-1), speed.size)

    def __call__(self, values: Mapping[str, float]) -> Array:
        """Return forces [N], shape (S,)."""
        return np.exp(self._at(values)[: self._count])

    def effective(self, values: Mapping[str, float]) -> float:
        """Return the smallest effective Tabor number of the series."""
        return float(np.exp(self._at(values)[self._count]))

    def travels(self, values: Mapping[str, float]) -> Array:
        """Return travels between forces [m], shape (S, travels)."""
        return np.exp(self._at(values)[self._count + 1 :]).reshape(-1, 1 + len(PARTS))

    def forces(self, points: Array) -> Array:
        """Return forces of many interfaces, shape (N, S), at points of :meth:`dense`."""
        parts = [
            self._spline(points[i : i + _AT_ONCE])[:, : self._count]
            for i in range(0, len(points), _AT_ONCE)
        ]
        return np.exp(np.concatenate(parts))

    def dense(self, times: int) -> Array:
        """Return points of a finer lattice, in search coordinates."""
        axes = []
        for name, x in self.axes.items():
            place = np.linspace(0, x.size - 1, times * (x.size - 1) + 1)
            axes.append(np.interp(place, np.arange(x.size), _inner(name, x)))
        return np.stack([x.ravel() for x in np.meshgrid(*axes, indexing="ij")], axis=1)

    def _at(self, values: Mapping[str, float]) -> Array:
        point = [_inner(name, values[name]) for name in self.axes]
        return self._spline(np.array(point))


def lattice(axes: Mapping[str, Array]) -> dict[str, Array]:
    """Return the values of each unknown at all points of a lattice, with a last axis of one."""
    points = np.meshgrid(*axes.values(), indexing="ij")
    return {name: x[..., None] for name, x in zip(axes, points, strict=True)}


def _inner(name: str, value: Any) -> Any:
    """Return the search coordinate of an unknown: its logarithm if positive."""
    return np.asarray(value, dtype=float) if name == EXPONENT else np.log(value)
