r"""Mesh of a steady crack: nodes, kernel and far field.

The traction caused by an opening e in the relaxed solid, :math:`\sigma = -\frac{1}{2\pi} \, PV
\int e'(s)/(x - s) \, ds`, is averaged over each element, for piecewise linear e. This
makes the matrix of :math:`\int \sigma e' dx` antisymmetric for any
spacing: the residual field does no work on itself, and the energy balance of the crack
holds on coarse elements as well. Far away :math:`e \to A \sqrt x`; that field is subtracted in
closed form, :math:`A \, \mathrm{Re} \sqrt z` with :math:`z = x + i b`, whose traction is
:math:`-\frac A4 \mathrm{Im} \, z^{-1/2}`.

**Interpolation between computed cracks that depends on a fixed number of neighbours only.** Cracks
are computed on demand, from the slowest on. A cubic spline through all computed ones would change
everywhere with each further crack, so an answer would depend on earlier calls. Here each piece is a
cubic with given values and slopes at its ends, and each slope is that of the polynomial of fourth
degree through five neighbours. A piece is final when :data:`AHEAD` more cracks are known.

**Memory of the solid along a steady crack: its modes as matrices.** In the frame of the crack, the
time of a material point corresponds to its position.

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
from functools import lru_cache, wraps
from threading import RLock
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.model.materials import Modes

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


# Cracks that must be known above a speed for the value there, and for its stated error.
AHEAD, AHEAD_FOR_ERROR = 3, 5
# Slopes at each of five equidistant knots from the values at all of them.
_SLOPES = (
    np.array(
        [
            [-25, 48, -36, 16, -3],
            [-3, -10, 18, -6, 1],
            [1, -8, 0, 8, -1],
            [-1, 6, -18, 10, 3],
            [3, -16, 36, -48, 25],
        ]
    )
    / 12
)
# Stated multiple of the leading term of the interpolation error, and the knots on either side
# from which the largest is taken.
_STATED, _NEAR = 4, 3
# Points of an inverse between two knots.
FINE = 16
# One thread at a time computes further cracks. Not in the objects, which can be pickled.
_LOCK = RLock()


def alone(method: Callable[..., Any]) -> Callable[..., Any]:
    """Let one thread at a time call the decorated methods, which extend shared cracks."""

    @wraps(method)
    def locked(*arguments: Any, **options: Any) -> Any:
        with _LOCK:
            return method(*arguments, **options)

    return locked


def between(x: Array) -> Array:
    """Return 16 points from each knot to the next, and the last knot."""
    place = np.arange(FINE * (x.size - 1) + 1) / FINE
    return np.interp(place, np.arange(x.size), x)


def curve(x: Array, y: Array) -> Any:
    """Return the interpolation of values at equidistant knots.

    Examples
    --------
    A further knot does not change a piece that three knots follow.

    >>> x = np.arange(8.0)
    >>> float(curve(x, x**5)(3.5) - curve(x[:7], x[:7] ** 5)(3.5))
    0.0
    """
    n = x.size
    if n < 5:
        return scipy.interpolate.CubicSpline(x, y)
    first = np.clip(np.arange(n) - 2, 0, n - 5)
    row = np.arange(n) - first
    slope = sum(_SLOPES[row, j] * y[first + j] for j in range(5)) / (x[1] - x[0])
    return scipy.interpolate.CubicHermiteSpline(x, y, slope)


def stated(y: Array, place: Array) -> Array:
    """Return the stated interpolation error at places in the list of knots, such as 3.5.

    The error of a piece is its fourth difference over 384; the largest nearby is multiplied by 4.

    Examples
    --------
    >>> y = np.arange(9.0) ** 4
    >>> float(stated(y, np.array(4.5))), abs(float(curve(np.arange(9.0), y)(4.5)) - 4.5**4)
    (0.25, 0.0625)
    """
    fourth = np.abs(np.diff(y, 4)) / 384
    at = np.arange(fourth.size) + 2.0
    near = [float(np.max(fourth[np.abs(at - u) < _NEAR], initial=0.0)) for u in place.flat]
    return _STATED * np.reshape(near, place.shape)


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
