r"""The plain twin of the punch: the published algorithm, slow and obvious, for the tests.

Chapter 3 of Maghami, PhD thesis (2025): M + 1 equally spaced nodes under the punch, overlapping
triangles by quadrature, full ones at the ends too, a fixed time step, the full hereditary sum and a
dense Newton, without use of the symmetry. Nothing is shared with the fast solver but the statement
of the problem.

The full end triangles reach beyond the punch, so that M + 1 triangles bear where M would: the
cohesive limit comes out as (M + 1)/M, and every stress too high by about as much.

Lengths are in a0, gap and depth in h0, the pressure p in dg/h0 and positive in compression:

.. math::

    h_i = 1 - \delta + u_i, \qquad u_i^{(q)} = \frac{\pi}{2 \hat\sigma_0^2} \sum_j G_{ij}
      \Big\{p_j^{(0)} + \sum_{m=0}^{q-1} \bar C_{q-1-m} \big(p_j^{(m+1)} - p_j^{(m)}\big)\Big\}

with the mean creep compliance of each step and :math:`\hat\sigma_0 = 16/(9\sqrt3)`.
"""

from __future__ import annotations

from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.linalg import toeplitz
from scipy.special import sici, xlogy

from viscotack.model.geometry import Base
from viscotack.model.problem import Case
from viscotack.result import Result
from viscotack.simulate.twins.plain_sphere import crossing, relaxed_depth, retract

# kappa differs from 1 by exp(-beta) times a square: nothing is left at the end.
_END = 60.0
_GAUSS, _WEIGHT = np.polynomial.legendre.leggauss(20)


def triangle_matrix(triangles: int, size: float, thickness: float, base: Base) -> npt.NDArray:
    r"""Return G[i, j], displacement at node i under triangle j of unit pressure, E* = 1.

    .. math:: G_{ij} = -\frac{4 b}{\pi} \left[ I_{A0} + I_A(i-j) + 4 z I_{AR}(i-j) \right],
              \quad z = \frac{a}{2 b M}

    Eq. 3.19 to 3.22, of the other sign: compression is positive. The ratio of hyperbolic functions
    there is minus the base's transfer function at beta/2.
    """
    M, z = triangles, size / (2 * thickness * triangles)
    beta, weight = _panels(0.0, 1.0, 1)
    head = base.transfer(beta / 2) * np.sin(beta * z) ** 2 / beta**3 @ weight
    # beyond 1 the transfer function is taken off and put back: an integral in closed form
    w = 2 * z
    tail = ((1 - np.cos(w)) / 2 + w / 2 * (np.sin(w) - w * sici(w)[1])) / 2
    beta, weight = _panels(1.0, _END, 60)
    tail -= (1 - base.transfer(beta / 2)) * np.sin(beta * z) ** 2 / beta**3 @ weight
    first = -2 / z * (head + tail)
    j = np.arange(M + 1)
    # the panels follow the oscillation
    beta, weight = _panels(0.0, _END, 60 + int(_END * z * M / 5))
    decaying = weight * (1 - base.transfer(beta / 2)) * np.sin(beta * z) ** 2 / beta**3
    second = -4 / z * np.array([decaying @ np.sin(beta * z * n) ** 2 for n in j])
    half_plane = (
        xlogy((j + 1) ** 2, j + 1) + xlogy((j - 1) ** 2, np.abs(j - 1)) - 2 * xlogy(j * j, j)
    ) / 4
    return toeplitz(-4 * thickness / np.pi * (first + second + 4 * z * half_plane))


def _panels(low: float, high: float, count: int) -> tuple[npt.NDArray, npt.NDArray]:
    """Return Gauss points and weights on `count` equal panels."""
    edges = np.linspace(low, high, count + 1)
    half = np.diff(edges)[:, None] / 2
    return (edges[:-1, None] + half * (1 + _GAUSS)).ravel(), (half * _WEIGHT).ravel()


def plain_solve(problem: Case, *, triangles: int, steps: int, last_depth: float) -> Result:
    """Simulate a retraction from a relaxed depth with the published algorithm.

    Parameters
    ----------
    problem : Problem or Groups
        The start must be by depth and the traction law Lennard-Jones.
    triangles : int
        M, spacings under the punch; the thesis takes 200.
    steps : int
        Equal time steps from the start to `last_depth`.
    last_depth : float
        Depth of the drive at the end [h0], below the start.

    Returns
    -------
    Result
        Ends early just past the first minimum of the force, where a jump may follow: a larger
        second peak of a fast deep pull is not seen. A status "stopped" means that Newton's method
        failed.
    """
    began, groups = perf_counter(), problem.groups()
    depth, strength = relaxed_depth(groups), groups.traction.strength
    punch: Any = groups.geometry
    layer: Any = groups.body
    size = punch.half_width
    x = np.linspace(-size, size, triangles + 1)
    G = triangle_matrix(triangles, size, layer.thickness, layer.base)
    return retract(
        problem,
        began=began,
        depth=depth,
        matrix=G * (np.pi / (2 * strength**2)),
        base=np.ones(len(x)),
        tabor=1.0,
        guess=np.ones(len(x)),
        force=lambda p, _: float(p.sum()) / (triangles * strength),
        edge=lambda gap: crossing(x, gap),
        edge_unit=1.0,
        steps=steps,
        last_depth=last_depth,
    )
