"""Gauss-Legendre quadrature over panels."""

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
