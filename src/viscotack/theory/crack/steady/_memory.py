r"""Memory of the solid along a steady crack: its modes as matrices.

In the frame of the crack, the time of a material point corresponds to its position.

An opening crack advances to -x. The tractions :math:`\sigma` would cause an opening e of the
relaxed solid. Each mode :math:`d_j` lags behind e, :math:`l_j d_j' = e - d_j` with :math:`l_j = v
\tau_j`, and the opening of the solid is :math:`w = c e + \sum w_j d_j`. The far field of e does not
depend on the memory, because the material ahead of the tip has not crept.

A closing crack advances to +x. Here the far field of w does not depend on the memory, because the
contact forces w to zero behind the tip. By the correspondence principle

.. math:: -\frac{1}{2\pi} PV \int \frac{w'(s)}{x - s} ds = c \, \sigma + \sum_j w_j T_j, \quad
          l_j T_j' = T_j - \sigma,

so the memory acts on the tractions, which are zero in the material that enters from the open side.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.model.materials import Modes

from ._mesh import Mesh

# A mode shorter than this fraction of the finest element has no memory; one longer than this many
# lengths of the mesh has not begun to creep.
_SHORT, _LONG = 1e-3, 1e4
# Number of decay lengths after which the memory is neglected (e^-50, avoids denormal numbers).
_FORGOTTEN = 50.0
# Positions at which the tractions beyond the mesh are summed, in lengths of a mode.
_BEYOND = np.geomspace(1e-4, 50.0, 60)


class Lengths(NamedTuple):
    """Modes of a solid at a speed: instantaneous compliance, and lengths of delayed modes.

    Attributes
    ----------
    instantaneous : float
        Compliance over that of the relaxed solid.
    weights, lengths : ndarray
        Weights and lengths of the delayed modes.
    """

    instantaneous: float
    weights: Array
    lengths: Array


def lengths_of(mesh: Mesh, modes: Modes, speed: float) -> Lengths:
    """Return the relevant modes on a mesh at a speed."""
    weights, lengths = np.array(modes.weights), speed * np.array(modes.times)
    fast = lengths < _SHORT * np.min(mesh.dx)
    lagging = ~fast & (lengths < _LONG * mesh.x[-1])
    return Lengths(
        modes.instantaneous + float(np.sum(weights[fast])), weights[lagging], lengths[lagging]
    )


def lagged_far(mesh: Mesh, length: float) -> Array:
    """Return the delayed d of the far field of amplitude 1 at the nodes."""
    z = mesh.x + 1j * mesh.width
    root = np.sqrt(np.pi * length) / 2
    return np.real(np.sqrt(z) + 1j * root * scipy.special.wofz(np.sqrt(z / length)))


def opening_matrix(mesh: Mesh, modes: Lengths) -> Array:
    """Return the matrix of the openings w at the nodes, from (e - A far field, A).

    The memory is exact for openings e that are linear between the nodes.
    """
    size = mesh.x.size
    later, earlier = _pairs(size)
    distance = mesh.x[later] - mesh.x[earlier]
    # contributions of an opening to its own and later nodes, and before the next node
    own, before = np.zeros(distance.size), np.zeros(distance.size)
    far = modes.instantaneous * mesh.far
    for weight, length in zip(modes.weights, modes.lengths, strict=True):
        step = mesh.dx / length
        mean = mean_decay(step)
        decay = np.exp(-np.minimum(distance / length, _FORGOTTEN))
        own += decay * (weight * np.append(1.0, 1 - mean))[earlier]
        before += decay * (weight * np.append(0.0, mean - np.exp(-step)))[earlier]
        far += weight * lagged_far(mesh, length)
    matrix, shifted = np.zeros((2, size, size + 1))
    matrix[later, earlier] = own
    shifted[later, earlier] = before
    matrix[:, : size - 1] += shifted[:, 1:size]
    matrix[np.arange(size), np.arange(size)] += modes.instantaneous
    matrix[:, -1] = far
    return matrix


def closing_matrix(mesh: Mesh, modes: Lengths) -> Array:
    """Return the matrix of the mean tractions c sigma + sum w_j T_j, from the mean sigma."""
    size = mesh.dx.size
    # of two elements, the upstream and the downstream one
    source, place = _pairs(size)
    distance = np.maximum(mesh.x[source] - mesh.x[place + 1], 0.0)
    reached, kept_here = np.zeros(distance.size), np.zeros(size)
    for weight, length in zip(modes.weights, modes.lengths, strict=True):
        step = mesh.dx / length
        kept = mean_decay(step)
        decay = np.exp(-np.minimum(distance / length, _FORGOTTEN))
        reached += (weight * kept)[place] * decay * (-np.expm1(-step))[source]
        kept_here += weight * (1 - kept)
    matrix = np.zeros((size, size))
    matrix[place, source] = reached
    np.fill_diagonal(matrix, modes.instantaneous + kept_here)
    return matrix


@lru_cache(maxsize=16)
def _pairs(size: int) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Return all pairs of indices, the first not below the second."""
    first, second = np.tril_indices(size)
    return first, second


def closing_inflow(
    mesh: Mesh, modes: Lengths, traction: Callable[[Array], Array]
) -> Callable[[float], Array]:
    """Return the effect of tractions beyond the open end of the mesh, as a function of A."""
    if not modes.lengths.size:
        return lambda amplitude: np.zeros(mesh.dx.size)
    l = modes.lengths[:, None]
    shares = mean_decay(mesh.dx / l) * np.exp(-(mesh.x[-1] - mesh.x[1:]) / l)
    gap = np.sqrt(mesh.x[-1] + _BEYOND * l)
    measure = np.exp(-_BEYOND) * _BEYOND * np.log(_BEYOND[1] / _BEYOND[0])

    def inflow(amplitude: float) -> Array:
        return (modes.weights * (traction(1 + abs(amplitude) * gap) @ measure)) @ shares

    return inflow


def mean_decay(step: Array) -> Array:
    """Return (1 - e^-y)/y."""
    return np.where(step < 1e-8, 1 - step / 2, -np.expm1(-step) / np.maximum(step, 1e-300))
