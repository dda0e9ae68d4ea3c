r"""The elastic half-space under axisymmetric pressure, and the surface it offers to a contact.

Pressure is given at the nodes :math:`r_0 = 0 < r_1 < \dots < r_N` and varies linearly between them
*in* :math:`r^2`, that is in enclosed area: the "overlapping triangles" of Appendix V with flanks
that make the displacement known in closed form. Every such hat is a combination of three caps
:math:`p = c^2 - s^2` (for :math:`s<c`), whose displacement for :math:`E^*=1` is

.. math::

    U(r, c) = \frac{8}{3\pi} \int_0^{\min(r,c)} \frac{(c^2-t^2)^{3/2}}{\sqrt{r^2-t^2}}\, dt

(Copson's form of Eq. 4.13 with the kernel of Eq. 4.14 and the factor s that the print lost).
Inside (r < c, m = r^2/c^2) the integral is :math:`c^3 [2(2-m)E(m) - (1-m)K(m)]/3`, outside
(m = c^2/r^2) it is :math:`c^4 [(4m-2)E(m) + (1-m)(2-3m)K(m)]/(3 m^2 r)`.

The nodal compliance B (displacement at node i for a unit *force* on hat j) of plain collocation is
symmetric only up to the discretisation error. It is replaced by its symmetric part, so that the
discrete contact has an energy: equilibrium is its minimum, a Cholesky factor exists exactly where
the state is stable, and the energy audit closes. At the axis, where areas grow from node to node,
that alone would cost a fourth of the pressure of the first node on any mesh, and 1 % of the
second's. So the compliances of the first nodes with themselves are those that balance, beside all
others, a smooth pressure (:func:`_levelled`). Under a sphere the pressure at the axis is then
within 2 % on any mesh. Under a cone, where it is unbounded, that of the first node is a third above
the mean there.

Units here: lengths along the surface in beta = (R^2 dg / E0*)^(1/3), gaps and displacements in h0,
pressure in dg/h0, force in dg beta^2 / h0. Then displacement = mu^2 B force.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.special import ellipe, ellipkm1

from viscotack.bem.interface import interface
from viscotack.bem.surface import Surface, stiffness
from viscotack.traction import Traction

# Below this ratio (c/r)^2 the closed form outside the cap loses digits to cancellation.
_SERIES_BELOW = 0.05
_SERIES_TERMS = 14
# The smooth pressure that sets the own compliance of the first nodes goes over so many of them, as
# far as their distances do not grow by this factor, and sets it for a part of them: towards its end
# it is not smooth.
_BUMP, _WIDER, _LEVELLED = 30, 1.5, 1 / 3


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


def nodal_areas(radius: npt.NDArray) -> npt.NDArray:
    """Return the integral of each hat over the surface; they add up to the whole disc."""
    area = np.pi * radius * radius
    half = np.diff(area) / 2
    return np.concatenate([half, [0.0]]) + np.concatenate([[0.0], half])


def _levelled(influence: npt.NDArray, radius: npt.NDArray, area: npt.NDArray) -> npt.NDArray:
    """Return the influence matrix with diagonal entries that suit its symmetric part at the axis.

    A smooth bump of pressure around the axis displaces the nodes as collocation has it, exactly but
    for its straight lines. What the symmetric compliance misses of that at the first nodes is put
    on their diagonal: no other entry changes, and the matrix stays symmetric.
    """
    steps = np.diff(radius)
    wider = steps > _WIDER * steps[0]
    last = min(_BUMP, int(np.argmax(wider)) if wider.any() else len(steps))
    first = round(_LEVELLED * last)
    bump = (1 - (radius[:last] / radius[last]) ** 2) ** 2
    own = influence[:first, :last] @ bump
    mirrored = (influence[:last, :first] / area[:first]).T @ (area[:last] * bump)
    levelled = influence.copy()
    levelled.flat[: first * (len(radius) + 1) : len(radius) + 1] += (own - mirrored) / (
        2 * bump[:first]
    )
    return levelled


def half_space(radius: npt.NDArray, tabor: float, law: Traction) -> Surface:
    """Return the surface with these nodes [beta] under a sphere of this Tabor number."""
    panels, area = np.pi * np.diff(radius * radius), nodal_areas(radius)
    face, levelled = interface(law, area, panels), _levelled(influence(radius), radius, area)
    return Surface(
        position=radius,
        area=area,
        stiffness=stiffness(levelled, panels, face.smoothing) / tabor**2,
        rigid_gap=1 + tabor * radius * radius / 2,
        unit=2 * tabor / (3 * np.pi),  # dg beta^2/h0 in 1.5 pi R dg
        flank=4 / 3,  # 2 pi R times the energy there
        whole=float("nan"),
        interface=face,
    )
