r"""Compliance of the elastic half-space under axisymmetric pressure, on any mesh.

Pressure is given at the nodes :math:`r_0 = 0 < r_1 < \dots < r_N` and varies linearly between them
*in* :math:`r^2`, that is in enclosed area: the "overlapping triangles" of Appendix V with flanks
that make the displacement known in closed form. Every such hat is a combination of three caps
:math:`p = c^2 - s^2` (for :math:`s<c`), whose displacement for :math:`E^*=1` is

.. math::

    U(r, c) = \frac{8}{3\pi} \int_0^{\min(r,c)} \frac{(c^2-t^2)^{3/2}}{\sqrt{r^2-t^2}}\, dt

(Copson's form of Eq. 4.13 with the kernel of Eq. 4.14 and the factor s that the print lost).
Inside (r < c, m = r^2/c^2) the integral is :math:`c^3 [2(2-m)E(m) - (1-m)K(m)]/3`, outside
(m = c^2/r^2) it is :math:`c^4 [(4m-2)E(m) + (1-m)(2-3m)K(m)]/(3 m^2 r)`.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.special import ellipe, ellipkm1

# Below this ratio (c/r)^2 the closed form outside the cap loses digits to cancellation.
_SERIES_BELOW = 0.05
_SERIES_TERMS = 14


def cap_displacement(radius: npt.NDArray) -> npt.NDArray:
    """Return U[i, j], the displacement at node i under the cap that ends at node j, with E* = 1.

    Inside and outside share their elliptic integrals: one of each pair of nodes serves both.

    Parameters
    ----------
    radius : ndarray, shape (N,)
        Nodes in any unit of length, ascending; the result has this unit cubed.
    """
    small, large = np.triu_indices(len(radius))
    r, c = radius[small], radius[large]
    q = r / np.where(c > 0, c, 1.0)
    m, m1 = q * q, (1 - q) * (1 + q)
    E = ellipe(m)
    m1K = m1 * ellipkm1(np.maximum(m1, np.finfo(float).tiny))
    U = np.empty((len(radius), len(radius)))
    # at the larger radius, outside the smaller cap
    mm = np.maximum(m, _SERIES_BELOW)  # the closed form is not used below it
    bracket = ((4 * mm - 2) * E + (2 - 3 * mm) * m1K) / (3 * mm * mm)
    far = m < _SERIES_BELOW
    bracket[far] = _outside_series(m[far])
    U[large, small] = r * r * r * q * bracket
    # at the smaller radius, inside the larger cap
    U[small, large] = c * c * c * (2 * (2 - m) * E - m1K) / 3
    return 8 / (3 * np.pi) * U


def _outside_series(m: npt.NDArray) -> npt.NDArray:
    """Return (3 pi/16) 2F1(1/2, 1/2; 3; m), the bracket of the outside form for small m."""
    total, term = np.zeros_like(m), np.ones_like(m)
    for k in range(_SERIES_TERMS):
        total = total + term
        term = term * m * (0.5 + k) ** 2 / ((3 + k) * (1 + k))
    return 3 * np.pi / 16 * total


def influence(radius: npt.NDArray) -> npt.NDArray:
    """Return G[i, j], the displacement at node i under hat j of unit pressure, for E* = 1.

    The last hat is half a hat: pressure ends at the last node.
    """
    area = radius * radius
    ramps = np.diff(cap_displacement(radius), axis=1) / np.diff(area)
    disc = 4 / np.pi * radius[-1] * ellipe((radius / radius[-1]) ** 2)
    return np.column_stack([ramps[:, 0], np.diff(ramps, axis=1), disc - ramps[:, -1]])
