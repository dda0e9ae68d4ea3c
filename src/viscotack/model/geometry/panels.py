"""Panels of a mesh: quadrature over them, and areas of hat functions.

Hat functions: unit pressure at one node, falling linearly to 0 at its neighbours.

A mesh of a surface of revolution goes from the axis, r = 0, outwards, and its pressures are linear
in r^2; one in plane strain goes from the middle, x = 0, to the end of the punch, and each node
represents the two hats at x and -x. The last hat is half a hat: pressure ends at the last node.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array


def gauss(edges: npt.NDArray, points: int) -> tuple[Array, Array]:
    """Return nodes and weights of the Gauss-Legendre rule with `points` nodes in each panel.

    Parameters
    ----------
    edges : ndarray
        Ends of the panels, ascending.
    points : int
        Nodes in each panel.

    Examples
    --------
    >>> x, weight = gauss(np.linspace(0.0, np.pi, 3), 8)
    >>> f"{np.sin(x) @ weight:.12f}"
    '2.000000000000'
    """
    nodes, weights = _rule(points)
    half = np.diff(edges)[:, None] / 2
    return (edges[:-1, None] + half * (1 + nodes)).ravel(), (half * weights).ravel()


@lru_cache(maxsize=16)
def _rule(points: int) -> tuple[Array, Array]:
    """Return nodes and weights on (-1, 1)."""
    return np.polynomial.legendre.leggauss(points)


def panel_areas(nodes: npt.NDArray, symmetry: str) -> npt.NDArray:
    """Return the areas between neighbouring nodes, in plane strain on both sides of the middle.

    Parameters
    ----------
    nodes : ndarray, shape (N,)
        Ascending from 0, in any unit of length.
    symmetry : {"revolution", "plane"}
        Of the shape that presses.

    Returns
    -------
    ndarray, shape (N - 1,)
        In that unit squared; in plane strain, per length, in that unit.
    """
    if symmetry == "plane":
        return 2 * np.diff(nodes)
    return np.pi * np.diff(nodes * nodes)


def hat_areas(nodes: npt.NDArray, symmetry: str) -> npt.NDArray:
    """Return the integral of each hat over the surface; they add up to the whole of it.

    Parameters are those of :func:`panel_areas`.

    Examples
    --------
    >>> import numpy as np
    >>> hat_areas(np.array([0.0, 2.0, 3.0]), "plane")
    array([2., 3., 1.])
    """
    end = np.zeros(1)
    half = np.diff(nodes) if symmetry == "plane" else np.diff(np.pi * nodes * nodes) / 2
    return np.concatenate([half, end]) + np.concatenate([end, half])
