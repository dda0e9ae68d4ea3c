r"""Integral equation of a rigid punch on a layer, solved once for all sizes.

Lengths in half widths a, lambda = a/b. A pressure p = phi(t) / sqrt(1 - t^2) displaces the surface
of the layer by

    (2/pi) int p(s) int_0^inf kappa(u)/u cos(u lambda (t - s)) du ds,

with the transfer function kappa of the base; under the punch this equals 1. The logarithm in the
kernel is diagonal in Chebyshev polynomials, the rest is analytic for |Im(lambda t)| < 2, so
Gauss-Chebyshev points converge geometrically. The results are functions of lambda alone,
represented by Chebyshev polynomials in ln(1 + lambda) up to where the two edges no longer interact.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.geometry import Base, Bonded
from viscotack.model.geometry.gauss import gauss
from viscotack.theory._roots import halved

# kappa differs from 1 - exp(-2u) by u^2 exp(-2u), negligible above this u.
_CUT = 22.0
# Spacing and degree of the spline of the smooth part of the kernel, for round-off accuracy.
_SPACING, _SPLINE = 0.03, 7
# Gauss-Chebyshev points of a half: the pressure has an edge layer of one thickness.
_POINTS, _PER_THICKNESS = 22, 3
# The table ends where the interaction of the edges is exp(-this).
_FORGOTTEN = 30.0
# For a layer closer to incompressible the table would be too long.
LARGEST_POISSON_RATIO = 0.49


class Curve(NamedTuple):
    """The state of a punch as a function of a/b."""

    longest: float
    foundation: float
    offset: float
    inverse: Any
    stress: Any

    def __call__(self, ratio: Any) -> tuple[Any, Any]:
        """Return S, force per depth and length in E*, and the pull-off stress in sqrt(E* w/a)."""
        x = np.minimum(ratio, self.longest)
        q = np.log1p(x)
        S = 1 / (self.inverse(q) / (1 + x) + _half_plane(x))
        stress = self.stress(q) * np.sqrt(1 + x)
        thin = ratio > self.longest
        # S = 2 zeta a/b + c, and a S' its first term alone
        line = 2 * ratio / self.foundation
        return (
            np.where(thin, line + self.offset, S),
            np.where(thin, (line + self.offset) / np.sqrt(line), stress),
        )


@lru_cache(maxsize=32)
def curve(base: Base) -> Curve:
    """Return the state of a punch on a layer with this base, computed on first use."""
    if isinstance(base, Bonded) and base.poisson_ratio > LARGEST_POISSON_RATIO:
        raise InputError(
            f"poisson_ratio of a bonded layer must be at most {LARGEST_POISSON_RATIO}, got "
            f"{base.poisson_ratio}, because the interaction of the edges decays too slowly near 0.5"
        )
    longest = _FORGOTTEN / _decay(base) + 1
    degree = 40 + 2 * int(longest)
    end = np.log1p(longest)
    nodes = (1 + np.polynomial.chebyshev.chebpts1(degree + 1)) * end / 2
    ratios = np.append(np.expm1(nodes), longest)
    S, edge = states(ratios, base)
    # a S' = 2 pi phi(1)^2, from the stress intensity at the edges
    stress = S / (np.sqrt(2 * np.pi) * edge)
    shapes = (1 / S - _half_plane(ratios)) * (1 + ratios), stress / np.sqrt(1 + ratios)
    inverse, stress = (
        np.polynomial.Chebyshev.fit(nodes, y[:-1], degree, domain=[0, end]) for y in shapes
    )
    offset = float(S[-1] - 2 * longest / base.foundation)
    return Curve(longest, base.foundation, offset, inverse, stress)


def states(ratios: Array, base: Base) -> tuple[Array, Array]:
    """Return S, the force of a punch at unit depth, and phi(1), its edge intensity, per a/b."""
    smooth = _smooth_kernel(2 * float(np.max(ratios)), base)
    force, edge = np.array([_state(float(ratio), smooth) for ratio in ratios]).T
    return force, edge


def _half_plane(ratio: Any) -> Any:
    """Return the logarithmic part of 1/S for a thick layer; zero for a thin one."""
    return np.log1p(ratio**-2.0) / np.pi


def _decay(base: Base) -> float:
    """Return y of the edge interaction exp(-y a/b): the first zero of kappa(iy/2)."""
    if not isinstance(base, Bonded):
        return 2 * np.pi
    # q sin y = y
    q = 3 - 4 * base.poisson_ratio
    return float(halved(lambda y: q * np.sin(y) - y, 1e-3, np.pi))


def _smooth_kernel(longest: float, base: Base) -> Any:
    """Return the kernel without its logarithm as a spline of the distance in thicknesses."""
    panels = int(np.ceil(_CUT * (longest + 4) / 60)) + 2
    u, weights = gauss(np.linspace(0.0, _CUT, panels + 1), 40)
    rest = weights * (base.transfer(u) - 1 + np.exp(-2 * u)) / u
    x = np.arange(-8, int(np.ceil(longest / _SPACING)) + 9) * _SPACING
    values = np.log(x**2 + 4) / 2 + np.cos(np.multiply.outer(x, u)) @ rest
    return scipy.interpolate.make_interp_spline(x, values, k=_SPLINE)


def _state(ratio: float, smooth: Any) -> tuple[float, float]:
    n = _POINTS + int(np.ceil(_PER_THICKNESS * ratio))
    angle = (2 * np.arange(n) + 1) * np.pi / (4 * n)
    t, orders = np.cos(angle), 2 * np.arange(n)
    # the solution is even: fold the other half onto this one
    kernel = smooth(ratio * np.abs(t[:, None] - t)) + smooth(ratio * (t[:, None] + t))
    polynomials = np.cos(np.outer(angle, orders))
    logarithm = np.pi * np.append(np.log(2 / ratio), 1 / orders[1:])
    system = 2 / np.pi * (polynomials * logarithm + np.pi / (2 * n) * kernel @ polynomials)
    coefficients = np.linalg.solve(system, np.ones(n))
    return np.pi * float(coefficients[0]), float(np.sum(coefficients))
