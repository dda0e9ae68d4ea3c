r"""JKR for a rigid indenter of revolution on any elastic body, from the body's influence matrix.

A rigid disc of radius a that is pressed in by 1, for :math:`E^* = 1`, has a pressure
:math:`p_1(r; a)`; let

.. math:: K(a) = \int p_1\, dA, \qquad M(a) = \int p_1 f\, dA,

f being the profile. By Betti's theorem the profile pressed in by :math:`\delta` has the force
:math:`E^* (\delta K - M)`. A contact without adhesion grows at its edge without changing the force,
:math:`\delta K' = M'`, and with adhesion it is drawn out by :math:`\Delta` from there like a disc,
whose energy release is the work of adhesion:

.. math:: D(a) = \frac{M'}{K'}, \qquad \delta = D - \Delta, \qquad
          \tfrac12 E^* K' \Delta^2 = 2 \pi a\, \Delta\gamma_0 .

The half-space has K = 2a. K and M are computed at a few radii in each decade and interpolated: they
are powers of the radius but where it passes a length of the body, and their discretization error is
below 1e-4 (`tests/ladder/test_bodies.py`).
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.model.geometry import Sphere, detail
from viscotack.model.geometry.panels import hat_areas

# Nodes of a disc, crowded at its edge; radii per decade, and of how many K and M are interpolated.
_NODES, _PER_DECADE, _AROUND = 97, 6, 6
# Difference of radii from which derivatives are computed, relative.
_STEP = 1e-3
_CROWDED = 1 - (1 - np.linspace(0.0, 1.0, _NODES)) ** 3


def bare_depth(a: npt.NDArray, shape: Any, body: Any) -> npt.NDArray:
    """Return the depth [m] at which a contact has this radius [m] without adhesion."""
    (_, K1), (_, M1) = _disc(a, shape, body)
    return M1 / K1


def drawn(a: npt.NDArray, shape: Any, body: Any, length: float) -> npt.NDArray:
    r"""Return by how much adhesion draws a contact of this radius out, :math:`\Delta` [m].

    The `length` is the work of adhesion over the contact modulus [m].
    """
    (_, K1), _ = _disc(a, shape, body)
    return np.sqrt(4 * np.pi * a * length / K1)


def force(a: npt.NDArray, shape: Any, body: Any, length: float) -> npt.NDArray:
    """Return the force over the contact modulus [m^2] of a contact of this radius [m]."""
    (K, K1), (M, M1) = _disc(a, shape, body)
    return (M1 / K1 - np.sqrt(4 * np.pi * a * length / K1)) * K - M


def stiffness(a: npt.NDArray, body: Any) -> npt.NDArray:
    """Return the force per depth over the contact modulus [m] of a flat disc of this radius [m]."""
    return _disc(a, Sphere(1.0), body)[0][0]


def gap(position: npt.NDArray, a: float, depth: float, shape: Any, body: Any) -> npt.NDArray:
    """Return the gap [m] at some distances from the axis [m] around a contact at a depth [m]."""
    inner = a * _CROWDED
    # the pressure ends within so little of the edge as nodes are apart there
    end = 2 * inner[-1] - inner[-2]
    beyond = position > end
    nodes, back = np.unique(np.append([*inner, end], position[beyond]), return_inverse=True)
    G = body.influence(nodes, "revolution")
    pressure = np.linalg.solve(G[:_NODES, :_NODES], depth - shape.gap(inner))
    moved = G[:, :_NODES] @ pressure
    found = np.zeros(len(position))
    found[beyond] = shape.gap(position[beyond]) - depth + moved[back[_NODES + 1 :]]
    return found


def _disc(a: npt.NDArray, shape: Any, body: Any) -> Any:
    """Return K and M with their derivatives by the radius."""
    each = [_interpolated(float(radius), shape, body) for radius in np.ravel(a)]
    K, K1, M, M1 = (np.reshape(values, np.shape(a)) for values in zip(*each, strict=True))
    return (K, K1), (M, M1)


def _interpolated(radius: float, shape: Any, body: Any) -> tuple[float, float, float, float]:
    """Return K, K', M and M' at a radius, by the polynomials of their logarithms."""
    if np.isfinite(detail(shape)):
        return _by_differences(radius, shape, body)
    place = np.log10(radius) * _PER_DECADE
    first = int(np.floor(place)) - _AROUND // 2 + 1
    steps = np.arange(_AROUND)
    table = np.log([_sums(first + int(k), shape, body) for k in steps])
    x = place - first
    # Lagrange's polynomials and their derivatives, in steps of the table
    powers = np.linalg.inv(np.vander(steps.astype(float), increasing=True))
    value = (x ** np.arange(_AROUND)) @ powers
    slope = (np.arange(1, _AROUND) * x ** np.arange(_AROUND - 1)) @ powers[1:]
    K, M = np.exp(value @ table)
    K1, M1 = (slope @ table) * np.array([K, M]) * _PER_DECADE / (radius * np.log(10))
    return K, K1, M, M1


def _by_differences(radius: float, shape: Any, body: Any) -> tuple[float, float, float, float]:
    """Compute K, K', M and M' of a shape with details, whose M is near no power of the radius."""
    before, here, after = (_sums_at(radius * (1 + x), shape, body) for x in (-_STEP, 0, _STEP))
    K1, M1 = ((b - a) / (2 * _STEP * radius) for a, b in zip(before, after, strict=True))
    return here[0], K1, here[1], M1


@lru_cache(maxsize=4096)
def _sums(step: int, shape: Any, body: Any) -> tuple[float, float]:
    """Return K and M at a radius of the table."""
    return _sums_at(10 ** (step / _PER_DECADE), shape, body)


def _sums_at(radius: float, shape: Any, body: Any) -> tuple[float, float]:
    """Compute K and M at a radius."""
    nodes = radius * _CROWDED
    pressure = np.linalg.solve(body.influence(nodes, "revolution"), np.ones(_NODES))
    on_hats: Array = pressure * hat_areas(nodes, "revolution")
    return float(np.sum(on_hats)), float(on_hats @ shape.gap(nodes))
