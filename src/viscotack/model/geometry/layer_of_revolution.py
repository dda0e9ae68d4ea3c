r"""Compliance of an elastic layer under axisymmetric pressure, on any mesh.

With :math:`\hat p` the Hankel transform of the pressure, the surface moves by

.. math:: u(r) = \frac{2}{E^*} \int_0^\infty \kappa(\xi b)\, \hat p(\xi) J_0(\xi r)\, d\xi .

The part of the half-space, :math:`\kappa = 1`, has a closed form (:mod:`.half_space`). What is left
is a ring on the surface for which distances count in thicknesses b alone,

.. math:: k(y, y') = 2 \int_0^\infty [\kappa(t) - 1] J_0(t y) J_0(t y')\, dt ,

even and smooth in y and y'. It is tabulated once for each base at distances of b/8, and
interpolated by polynomials of degree 9 to about 1e-8; hats are integrated over those exactly. So
the matrix keeps the symmetry of the kernel, and its errors do not grow where nodes are close.

From the node on beyond which all panels are wider than b a layer is a foundation: each of these
nodes moves as the hat on it alone moves a layer in plane strain, and no other. Under an indenter
these are the outer nodes, where next to no pressure acts.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array
from scipy.special import j0

from viscotack.errors import InputError
from viscotack.model.geometry.bodies import Base
from viscotack.model.geometry.half_space import influence as half_space_influence
from viscotack.model.geometry.layer import own_displacement
from viscotack.model.geometry.panels import gauss

# Places of the table per thickness, and of how many a value is interpolated.
_PER_THICKNESS, _AROUND = 8, 10
# Panels of more thicknesses decouple; the widest coupled part of a surface [b].
_WIDE, _LARGEST = 1.0, 300.0
# Where the transfer function has become 1: t^2 exp(-2t) < 1e-11.
_LAST = 16.0
# Gauss panels in t: phase of each panel and number of points.
_PHASE, _POINTS = 12.0, 16
# Tables grow by this factor, so that meshes share them; values of t that are summed at a time.
_GROWTH, _BLOCK = 1.25, 2048
_GAUSS_4 = np.polynomial.legendre.leggauss(4)


def influence(radius: npt.NDArray, thickness: float, base: Base) -> npt.NDArray:
    """Return G[i, j], the displacement at node i under hat j of unit pressure, for E* = 1.

    Parameters
    ----------
    radius : ndarray, shape (N,)
        Nodes in any unit of length, ascending from 0; hats fall linearly in r^2 to the neighbours,
        and the last is half a hat.
    thickness : float
        Thickness b of the layer, in the same unit.
    base : Frictionless or Bonded
        How the layer rests on the rigid body below.

    Returns
    -------
    ndarray, shape (N, N)
        In the unit of length; displacement into the layer is positive under pressure.

    Raises
    ------
    ValueError
        If nodes closer than the thickness reach beyond 300 thicknesses.

    Examples
    --------
    A disc on a glued layer as thick as its radius is 2.5 times as stiff as on a half-space, 2a E*:

    >>> import numpy as np
    >>> from viscotack.model.geometry import Bonded
    >>> from viscotack.model.geometry.panels import hat_areas
    >>> r = 1 - np.linspace(1, 0, 121) ** 3
    >>> G = influence(r, 1.0, Bonded(poisson_ratio=0.3))
    >>> pressure = np.linalg.solve(G, np.ones(121))
    >>> f"{hat_areas(r, 'revolution') @ pressure / 2:.3f}"
    '2.484'
    """
    y = radius / thickness
    narrow = np.flatnonzero(np.diff(y) <= _WIDE)
    coupled = int(narrow[-1]) + 2 if narrow.size else 0
    G = np.zeros((len(y), len(y)))
    if coupled == len(y):
        G = half_space_influence(y) + _correction(y, base)
    elif coupled:
        near = y[: coupled + 1]  # the last of these hats is whole
        G[:coupled, :coupled] = (half_space_influence(near) + _correction(near, base))[:-1, :-1]
    alone = np.arange(coupled, len(y))
    G[alone, alone] = own_displacement(y, base)[coupled:]
    return thickness * G


def _correction(y: npt.NDArray, base: Base) -> npt.NDArray:
    """Return the change of the half-space displacements due to the base, lengths in b."""
    if y[-1] > _LARGEST:
        raise InputError(
            f"the contact needs a mesh out to {y[-1]:.4g} thicknesses of the layer, and a layer is "
            f"simulated out to {_LARGEST:g}: take a shallower contact or a thicker layer"
        )
    least = int(np.ceil(_PER_THICKNESS * y[-1])) + _AROUND
    places = 32
    while places < least:
        places = int(_GROWTH * places)
    kernel = _table(base, places)
    at_nodes = _interpolation(y, places)
    return (_on_hats(y, places) @ (at_nodes @ kernel).T).T


@lru_cache(maxsize=16)
def _table(base: Base, places: int) -> npt.NDArray:
    """Return k(y, y') at multiples of b/8."""
    y = np.arange(places) / _PER_THICKNESS
    panels = max(8, int(np.ceil(2 * y[-1] * _LAST / _PHASE)))
    t, w = gauss(np.linspace(0.0, _LAST, panels + 1), _POINTS)
    weight = 2 * w * (base.transfer(t) - 1)
    found = np.zeros((places, places))
    for first in range(0, t.size, _BLOCK):
        part = slice(first, first + _BLOCK)
        waves = j0(np.multiply.outer(y, t[part]))
        found += (waves * weight[part]) @ waves.T
    return (found + found.T) / 2


def _interpolation(y: npt.NDArray, places: int) -> csr_array:
    """Return the matrix that takes values at the places of the table to those at y."""
    first = np.floor(_PER_THICKNESS * y).astype(int) - _AROUND // 2 + 1
    weights = _lagrange(_PER_THICKNESS * y - first)
    columns = np.abs(first[:, None] + np.arange(_AROUND))  # the kernel is even
    rows = np.repeat(np.arange(len(y)), _AROUND)
    return csr_array((weights.ravel(), (rows, columns.ravel())), shape=(len(y), places))


def _on_hats(y: npt.NDArray, places: int) -> csr_array:
    """Return the integrals over each hat of the polynomials of each place."""
    lines = np.arange(1, int(_PER_THICKNESS * y[-1]) + 1) / _PER_THICKNESS
    breaks = np.unique(np.concatenate([y, lines[lines < y[-1]]]))
    low, width = breaks[:-1], np.diff(breaks)
    panel = np.searchsorted(y, low, side="right") - 1
    nodes, weights = _GAUSS_4
    s = low[:, None] + width[:, None] * (1 + nodes) / 2
    first = np.floor(_PER_THICKNESS * (low + width / 2)).astype(int) - _AROUND // 2 + 1
    polynomials = _lagrange(_PER_THICKNESS * s - first[:, None])
    area = s * width[:, None] * weights / 2
    inner, outer = y[panel, None] ** 2, y[panel + 1, None] ** 2
    share = (s * s - inner) / (outer - inner)
    parts = np.stack([1 - share, share])
    values = np.einsum("hpg,pg,pgk->hpk", parts, area, polynomials)
    rows = np.repeat(np.stack([panel, panel + 1]), _AROUND)
    columns = np.tile(np.abs(first[:, None] + np.arange(_AROUND)).ravel(), 2)
    return csr_array((values.ravel(), (rows, columns)), shape=(len(y), places))


def _polynomials() -> npt.NDArray:
    """Return the coefficients of Lagrange's polynomials about the middle of their places."""
    places = np.arange(_AROUND) - (_AROUND - 1) / 2
    rows = []
    for k, place in enumerate(places):
        others = np.delete(places, k)
        rows.append(np.poly(others) / np.prod(place - others))
    return np.array(rows)


_COEFFICIENTS = _polynomials()


def _lagrange(x: npt.NDArray) -> npt.NDArray:
    """Return the polynomials of the places 0, 1, ... at x, in a last axis."""
    x = np.asarray(x)[..., None] - (_AROUND - 1) / 2
    found = np.zeros(())
    for power in range(_AROUND):
        found = found * x + _COEFFICIENTS[:, power]
    return found
