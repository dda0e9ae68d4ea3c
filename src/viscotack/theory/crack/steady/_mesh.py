r"""Mesh of a steady crack: nodes, kernel and far field.

The traction caused by an opening e in the relaxed solid, :math:`\sigma = -\frac{1}{2\pi} \, PV
\int e'(s)/(x - s) \, ds`, is averaged over each element, for piecewise linear e. This
makes the matrix of :math:`\int \sigma e' dx` antisymmetric for any
spacing: the residual field does no work on itself, and the energy balance of the crack
holds on coarse elements as well. Far away :math:`e \to A \sqrt x`; that field is subtracted in
closed form, :math:`A \, \mathrm{Re} \sqrt z` with :math:`z = x + i b`, whose traction is
:math:`-\frac A4 \mathrm{Im} \, z^{-1/2}`.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from viscotack.arrays import Array

# Spacing at the crack over its length, growth factor of the spacing per node, distance in crack
# lengths from which the growth factor itself increases, and its increase per decade.
SPACING, GROWTH = 0.05, 0.08
_FAR, _FASTER = 30.0, 0.7


class Mesh(NamedTuple):
    """Nodes x around the crack at 0, and the linear operators on them.

    Attributes
    ----------
    x : ndarray, shape (n,)
        Nodes [E0* h0^2/dg], ascending; ``middle`` is the index of the node at 0.
    dx : ndarray, shape (n - 1,)
        Lengths of the elements.
    kernel : ndarray, shape (n - 1, n)
        Matrix from openings at the nodes to mean tractions of the elements.
    width : float
        Imaginary part b of the far field.
    far, far_traction : ndarray
        The far field of amplitude 1: opening at the nodes, mean traction of the elements.
    """

    x: Array
    dx: Array
    kernel: Array
    middle: int
    width: float
    far: Array
    far_traction: Array


@lru_cache(maxsize=8)
def mesh(length: float, reach: float, *, refined: float = 1.0) -> Mesh:
    """Return a mesh for cracks of a given length, extending to both sides by a distance.

    ``refined`` divides spacing and growth.
    """
    spacing, growth = SPACING * length / refined, GROWTH / refined
    half = [0.0]
    while half[-1] < reach:
        decades = max(0.0, np.log10(max(half[-1], length) / (_FAR * length)))
        half.append(half[-1] + np.hypot(spacing, growth * (1 + _FASTER * decades) * half[-1]))
    x = np.array([*(-u for u in half[:0:-1]), *half])
    z = x + 1j * length
    dx = np.diff(x)
    return Mesh(
        x=x,
        dx=dx,
        kernel=_kernel(x, dx),
        middle=len(half) - 1,
        width=length,
        far=np.real(np.sqrt(z)),
        far_traction=-np.imag(np.diff(np.sqrt(z))) / (2 * dx),
    )


def _kernel(x: Array, dx: Array) -> Array:
    """Return the matrix from openings to mean tractions."""
    u = np.abs(x[:, None] - x)
    # integral of ln |x - s| over x
    integral = np.sign(x[:, None] - x) * (u * np.log(np.where(u > 0, u, 1.0)) - u)
    mean = np.diff(integral, axis=0) / dx[:, None]
    slopes = np.diff(mean, axis=1) / (2 * np.pi * dx)
    kernel = np.zeros((dx.size, x.size))
    kernel[:, 1:] += slopes
    kernel[:, :-1] -= slopes
    return kernel
