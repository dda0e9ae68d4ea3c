r"""Asperities: summits of a map with their positions, heights and radii of curvature.

A summit is a pixel higher than its eight neighbours. The paraboloid of least squares through the
nine heights has its top between the pixels and the principal curvatures
:math:`\kappa_1, \kappa_2`; the radius is :math:`1/\sqrt{\kappa_1 \kappa_2}`. A
sphere of it has the same area of gaps below any gap, and so the same adhesion if rigid.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.units import positive

from .heights import HeightMap

# A top farther than this from the highest pixel, in pixels, stays at it.
_FARTHEST = 1.0


@dataclass(frozen=True, eq=False)
class Asperities:
    """Summits of a surface.

    Attributes
    ----------
    positions : ndarray, shape (N, 2)
        Places in the plane [m].
    heights : ndarray, shape (N,)
        Heights [m], positive towards the solid.
    radii : ndarray, shape (N,)
        Radii of curvature [m].
    area : float
        Area of the surface [m^2].
    """

    positions: npt.NDArray
    heights: npt.NDArray
    radii: npt.NDArray
    area: float


def summits(surface: HeightMap) -> Asperities:
    """Return the summits of a map.

    Those at the edge of a map that does not repeat are left out. A map that continues as a
    paraboloid and has no other summit is one asperity with its radius.

    Raises
    ------
    ValueError
        If there is none, as on a flat map.

    Examples
    --------
    >>> from viscotack.model.surfaces import bumps
    >>> made = bumps(64, 1e-6, radius=20e-6, spacing=16e-6, height=1e-6)
    >>> found = summits(made)
    >>> len(found.radii), f"{found.radii[0]:.3g} m, {found.heights[0]:.3g} m"
    (16, '2e-05 m, 1e-06 m')
    """
    # a plateau has one summit: of equal heights the first one counts
    h, dx = surface.heights, surface.pixel
    wide = np.pad(h, 1, mode="wrap" if surface.periodic else "edge")
    rows, columns = h.shape
    around = np.array(
        [
            wide[1 + i : 1 + i + rows, 1 + j : 1 + j + columns]
            for i in (-1, 0, 1)
            for j in (-1, 0, 1)
        ]
    )
    earlier, later = np.delete(around, range(4, 9), 0), np.delete(around, range(5), 0)
    top = np.all(h > earlier, axis=0) & np.all(h >= later, axis=0)
    if not surface.periodic:
        top[[0, -1]] = top[:, [0, -1]] = False
    at = np.argwhere(top)
    z = around[:, top].reshape(3, 3, -1)
    # least squares over 3 x 3 pixels, in pixels
    x = np.array([-1.0, 0.0, 1.0])
    along, across = np.einsum("i,ijn->n", x, z) / 6, np.einsum("j,ijn->n", x, z) / 6
    bend = x**2 - 2 / 3
    xx, yy = np.einsum("i,ijn->n", bend, z) / 2, np.einsum("j,ijn->n", bend, z) / 2
    xy = np.einsum("i,j,ijn->n", x, x, z) / 4
    level = z.mean(axis=(0, 1)) - (xx + yy) * 2 / 3
    # z = level + along x + across y + xx x^2 + yy y^2 + xy x y
    gauss = 4 * xx * yy - xy**2
    round_ = (gauss > 0) & (xx < 0)
    at, along, across, xx, yy, xy, level, gauss = (
        each[round_] for each in (at, along, across, xx, yy, xy, level, gauss)
    )
    if not at.size:
        raise InputError("the map has no summit, a pixel higher than its eight neighbours")
    x0, y0 = (xy * across - 2 * yy * along) / gauss, (xy * along - 2 * xx * across) / gauss
    near = np.maximum(np.abs(x0), np.abs(y0)) <= _FARTHEST
    x0, y0 = np.where(near, x0, 0.0), np.where(near, y0, 0.0)
    height = level + along * x0 + across * y0 + xx * x0**2 + yy * y0**2 + xy * x0 * y0
    positions = (at + 0.5 + np.stack([x0, y0], axis=1)) * dx
    return Asperities(positions, height, dx**2 / np.sqrt(gauss), surface.area)


def drawn_asperities(
    count: int, area: float, *, radius: float, rms_height: float, seed: int
) -> Asperities:
    """Return asperities of one radius with Gaussian heights at random places.

    This is the surface of Greenwood and Williamson (1966, doi:10.1098/rspa.1966.0242).

    Parameters
    ----------
    count : int
        Number of asperities.
    area : float
        Area of the surface, a square [m^2].
    radius, rms_height : float
        Radius of all [m], and standard deviation of their heights [m].
    seed : int
        Seed of places and heights.

    Examples
    --------
    >>> found = drawn_asperities(100, 1e-6, radius=1e-5, rms_height=1e-7, seed=1)
    >>> found.positions.shape
    (100, 2)
    """
    rng = np.random.default_rng(seed)
    side = np.sqrt(positive("area", area, "m^2"))
    return Asperities(
        rng.uniform(0, side, size=(count, 2)),
        positive("rms_height", rms_height, "m") * rng.normal(size=count),
        np.full(count, positive("radius", radius, "m")),
        area,
    )
