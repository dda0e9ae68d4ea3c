r"""What the solid remembers along a steady crack: its modes as matrices.

In the frame of the crack a material point's time is its place. A crack that opens advances to
-x, so that each mode lags behind the opening e of the relaxed solid,
:math:`l_j d_j' = e - d_j` with :math:`l_j = v \tau_j`, and the opening is :math:`w = c e + \sum w_j
d_j`. A crack that closes advances to +x. There w is what is universal, as e is in front of a crack
that opens: the contact forces it to zero. By the correspondence principle the same solid says

.. math:: -\frac{1}{2\pi} PV \int \frac{w'(s)}{x - s} ds = c \, \sigma + \sum_j w_j T_j, \quad
          l_j T_j' = T_j - \sigma,

so that the memory acts on the tractions, which are zero where the material comes from.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array

from ._mesh import Mesh

# A mode shorter than this part of the finest element has no memory, one longer than so many
# reaches of the mesh has not begun to creep where there are tractions.
_SHORT, _LONG = 1e-3, 1e4
# Decay lengths after which nothing is left: e^-50, and no numbers too small for the processor.
_FORGOTTEN = 50.0
# Places at which the tractions beyond the mesh are summed, in lengths of a mode.
_BEYOND = np.geomspace(1e-4, 50.0, 60)


class Lengths(NamedTuple):
    """The modes of a solid at a speed: what yields at once, and the lengths over which others do.

    Attributes
    ----------
    instantaneous : float
        Compliance over that of the relaxed solid.
    weights, lengths : ndarray
        Of the modes that lag.
    """

    instantaneous: float
    weights: Array
    lengths: Array


def lengths_of(mesh: Mesh, instantaneous: float, weights: Array, lengths: Array) -> Lengths:
    """Return the modes that matter on a mesh."""
    fast = lengths < _SHORT * np.min(mesh.dx)
    lagging = ~fast & (lengths < _LONG * mesh.x[-1])
    return Lengths(instantaneous + float(np.sum(weights[fast])), weights[lagging], lengths[lagging])


def lagged(mesh: Mesh, length: float) -> Array:
    """Return the matrix that takes openings e at the nodes to the lagging d, straight between.

    The first opening is the one of all that came before.
    """
    behind, decay, late, early = _steps(mesh, length)
    matrix = np.zeros_like(decay)
    matrix[:, 1:] += decay[:, 1:] * early
    matrix[:, :-1] += decay[:, 1:] * (late - behind)
    matrix[:, 0] += decay[:, 0]
    return matrix


def lagged_far(mesh: Mesh, length: float) -> Array:
    """Return the lagging d of the far field of amplitude 1 at the nodes."""
    z = mesh.x + 1j * mesh.width
    root = np.sqrt(np.pi * length) / 2
    return np.real(np.sqrt(z) + 1j * root * scipy.special.wofz(np.sqrt(z / length)))


def opening_matrix(mesh: Mesh, modes: Lengths) -> Array:
    """Return the openings w at the nodes, of (e - A far field, A); see `lagged`."""
    size = mesh.x.size
    later, earlier = _pairs(size)
    distance = mesh.x[later] - mesh.x[earlier]
    # what an opening leaves at its own node and later, and what it has left before the next one
    own, before = np.zeros(distance.size), np.zeros(distance.size)
    far = modes.instantaneous * mesh.far
    for weight, length in zip(modes.weights, modes.lengths, strict=True):
        step = mesh.dx / length
        mean = _mean_decay(step)
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
    """Return the tractions c sigma + sum w_j T_j, means of the elements, of the mean sigma."""
    size = mesh.dx.size
    # of two elements the one where the material comes from, and where it goes
    source, place = _pairs(size)
    distance = np.maximum(mesh.x[source] - mesh.x[place + 1], 0.0)
    reached, kept_here = np.zeros(distance.size), np.zeros(size)
    for weight, length in zip(modes.weights, modes.lengths, strict=True):
        step = mesh.dx / length
        kept = _mean_decay(step)
        decay = np.exp(-np.minimum(distance / length, _FORGOTTEN))
        reached += (weight * kept)[place] * decay * (-np.expm1(-step))[source]
        kept_here += weight * (1 - kept)
    matrix = np.zeros((size, size))
    matrix[place, source] = reached
    np.fill_diagonal(matrix, modes.instantaneous + kept_here)
    return matrix


@lru_cache(maxsize=16)
def _pairs(size: int) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Return all pairs of numbers, the first not below the second."""
    first, second = np.tril_indices(size)
    return first, second


def closing_inflow(
    mesh: Mesh, modes: Lengths, traction: Callable[[Array], Array]
) -> Callable[[float], Array]:
    """Return what tractions beyond the open end of the mesh leave, as a function of A."""
    if not modes.lengths.size:
        return lambda amplitude: np.zeros(mesh.dx.size)
    l = modes.lengths[:, None]
    shares = _mean_decay(mesh.dx / l) * np.exp(-(mesh.x[-1] - mesh.x[1:]) / l)
    gap = np.sqrt(mesh.x[-1] + _BEYOND * l)
    measure = np.exp(-_BEYOND) * _BEYOND * np.log(_BEYOND[1] / _BEYOND[0])

    def inflow(amplitude: float) -> Array:
        return (modes.weights * (traction(1 + abs(amplitude) * gap) @ measure)) @ shares

    return inflow


def _mean_decay(step: Array) -> Array:
    """Return (1 - e^-y)/y."""
    return np.where(step < 1e-8, 1 - step / 2, -np.expm1(-step) / np.maximum(step, 1e-300))


def _steps(mesh: Mesh, length: float) -> tuple[Array, Array, Array, Array]:
    """Return decays over the elements and between all nodes, and the weights of both ends."""
    step = mesh.dx / length
    mean = _mean_decay(step)
    distance = np.maximum(mesh.x[:, None] - mesh.x, 0.0)
    return np.exp(-step), np.tril(np.exp(-distance / length)), mean, 1 - mean
