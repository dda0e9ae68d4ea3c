r"""JKR for a rigid indenter of revolution on a layer, by an integral equation.

The pressure of a contact of radius a on a layer of thickness b is that on a half-space for a
function g,

.. math:: \hat p(\xi) = \frac{2}{\pi} \int_0^a g(s) \cos \xi s\, ds, \qquad
          P = 4 \int_0^a g(s)\, ds ,

which solves Lebedev and Ufliand's equation (1958, doi:10.1016/0021-8928(58)90036-X), here for any
transfer function :math:`\kappa` and profile,

.. math:: \frac{E^*}{2} [\delta - D(s)] = g(s) + \frac{2}{\pi} \int_0^a k(s, t)\, g(t)\, dt, \quad
          k(s, t) = \int_0^\infty [\kappa(\xi b) - 1] \cos \xi s \cos \xi t\, d\xi ,

D being the depth of the bare contact on the half-space. At its edge it releases the energy
:math:`G = 2 g(a)^2/(\pi a E^*)`, so with :math:`g_1` for the disc, D = 0 and :math:`\delta = 1`,
and :math:`g_D` for the profile, E* = 2,

.. math:: \delta = \frac{g_D(a) - \sqrt{2 \pi a \Delta\gamma_0/E^*}}{g_1(a)}, \qquad
          P = 2 E^* \int_0^a [\delta\, g_1 - g_D]\, ds .

The kernel is integrated by Gauss panels in :math:`\xi`. Nodes s = a sin(angle) are dense at the
edge; errors are of the order of 1e-8. Beyond 100 thicknesses the solution for a profile that is a
power is continued as a power of the radius.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import floor, log10
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.geometry import Base, Bonded, Cone, Layer, PowerLawProfile, Sphere, detail
from viscotack.model.geometry.panels import gauss
from viscotack.theory.elastic.profiles import half_space_depth

# Gauss panels in the angle: smallest number, thicknesses per extra panel, points per panel.
_PANELS, _WIDER, _POINTS = 3, 4.0, 16
# Gauss panels in t of twice the points, up to where the transfer function is 1: smallest number,
# phase of each more.
_LAST, _FEWEST, _PHASE = 18.0, 4, 36.0
# Details of a shape per extra panel, and largest number of such panels.
_DETAILS, _MOST_PANELS = 4.0, 24
# Solutions at this number of radii or more share panels of two points: width [b], and panels per
# detail.
_MANY, _COARSEST, _PER_DETAIL = 8, 0.25, 8
# Radius [b] up to which the equation is solved.
LARGEST, _ROUND_OFF = 100.0, 1 + 1e-12
# Poisson ratio above which the sums are no powers of the radius beyond it, except at 0.5.
_NEARLY = 0.49
# Solutions per decade of radius for shapes that are powers, and of how many one is interpolated.
_PER_DECADE, _AROUND = 10, 8
_MIDDLE, _POWERS = (_AROUND - 1) / 2, np.arange(_AROUND)[::-1]
POWERS = (Sphere, Cone, PowerLawProfile)
# So many thicknesses from a contact a layer does not move: exp(-0.74 times that) if incompressible.
_BESIDE = 25.0
# Of a logarithm of the radius, for a derivative.
_STEP = 0.01
_LAST_STEP = round(_PER_DECADE * np.log10(LARGEST))


def bare_depth(a: npt.NDArray, shape: Any, body: Layer) -> npt.NDArray:
    """Return the depth [m] at which a contact has this radius [m] without adhesion."""
    disc, profile, _, _ = _sums(a, shape, body)
    return profile / disc


def drawn(a: npt.NDArray, shape: Any, body: Layer, length: float) -> npt.NDArray:
    """Return by how much adhesion draws a contact of this radius out [m].

    The `length` is the work of adhesion over the contact modulus [m].
    """
    return np.sqrt(2 * np.pi * a * length) / _sums(a, shape, body)[0]


def force(a: npt.NDArray, shape: Any, body: Layer, length: float) -> npt.NDArray:
    """Return the force over the contact modulus [m^2] of a contact of this radius [m]."""
    disc, profile, K, M = _sums(a, shape, body)
    return (profile - np.sqrt(2 * np.pi * a * length)) / disc * K - M


def relaxed_pull_off(a: float, shape: Any, body: Layer) -> float:
    """Return the pull-off force over the contact modulus [m^2] of a relaxed contact of this radius.

    Whatever the work of adhesion: depth and force of a contact are those without adhesion less what
    grows like its root, so that where the force is least over the radius is a matter of the radius.
    """
    radius = a * np.exp(_STEP * np.array([-1.0, 0.0, 1.0]))
    disc, profile, K, M = _sums(radius, shape, body)
    bare, out = profile / disc * K - M, np.sqrt(radius) / disc * K
    return float(out[1] * (bare[2] - bare[0]) / (out[2] - out[0]) - bare[1])


def stiffness(a: npt.NDArray, body: Layer) -> npt.NDArray:
    """Return the force per depth over the contact modulus [m] of a flat disc of this radius [m]."""
    return _sums(a, Sphere(1.0), body)[2]


def check_disc(radius: Any, body: Any) -> None:
    """Raise an error for a disc so wide that its stiffness is only a power of the radius."""
    if not isinstance(body, Layer):
        return
    widest = float(np.max(radius)) / body.thickness
    if widest > LARGEST * _ROUND_OFF:
        raise InputError(
            f"a disc with a radius of {widest:.4g} thicknesses of the layer is too wide; it may be "
            f"up to {LARGEST:g}: make the layer thicker"
        )


def is_power(body: Layer) -> bool:
    """Whether contacts wider than `LARGEST` thicknesses follow powers of the radius."""
    base = body.base
    return not (isinstance(base, Bonded) and _NEARLY < base.poisson_ratio < 0.5)


def gap(position: npt.NDArray, a: float, depth: float, shape: Any, body: Layer) -> npt.NDArray:
    r"""Return the gap [m] at some distances from the axis [m] around a contact at a depth [m].

    .. math:: u(r) = \frac{4}{\pi E^*} \left[ \int_0^a \frac{g(s)\, ds}{\sqrt{r^2 - s^2}}
              + \int_0^\infty [\kappa(\xi b) - 1] \int_0^a g(s) \cos \xi s\, ds\, J_0(\xi r)\, d\xi
              \right]
    """
    b = body.thickness
    y, a = np.maximum(position, a) / b, min(a / b, LARGEST)
    solved = _solved(a, body.base, _for_details(a, shape, body))
    s, weight = solved.s, solved.weight
    of, of_edge = solved.profile(shape, b)
    g, edge = depth * solved.disc - of, depth * solved.disc_edge - of_edge
    root = np.sqrt(np.maximum(np.subtract.outer(y * y, s * s), np.finfo(float).tiny))
    # what is left of g without its value at the edge vanishes where the root does
    moved = ((g - edge) / root) @ weight + edge * np.arcsin(np.minimum(solved.a / y, 1.0))
    near = y < solved.a + _BESIDE
    t, kernel = _waves(body.base, float(np.max(y[near], initial=0.0)) + solved.a)
    depths = kernel * (np.cos(np.multiply.outer(t, s)) @ (g * weight))
    moved[near] += scipy.special.j0(np.multiply.outer(y[near], t)) @ depths
    return shape.gap(position) - depth + 2 / np.pi * np.where(near, moved, 0.0)


def _sums(a: npt.NDArray, shape: Any, body: Layer) -> Any:
    """Return g of disc and profile at the edge, and their forces, for E* = 2 and E* = 1."""
    y = np.ravel(a) / body.thickness
    if y.size >= _MANY and np.isfinite(detail(shape)) and y.max() <= LARGEST * _ROUND_OFF:
        values = _at_once(tuple(y.tolist()), shape, body)
    else:
        values = np.transpose([_continued(float(radius), shape, body) for radius in y])
    return [np.reshape(each, np.shape(a)) for each in values]


def _continued(a: float, shape: Any, body: Layer) -> Array:
    """Return the four sums at a radius [b], beyond the largest one as powers."""
    if a <= LARGEST * _ROUND_OFF:
        a = min(a, LARGEST)
        return (_interpolated if type(shape) in POWERS else _direct)(a, shape, body)
    if np.isfinite(detail(shape)):
        raise InputError(
            f"a contact of {a:.4g} thicknesses of the layer is too wide for a shape with details; "
            f"it may be up to {LARGEST:g}: make the layer thicker"
        )
    if not is_power(body):
        raise InputError(
            f"a contact of {a:.4g} thicknesses of a nearly incompressible layer is too wide; it "
            f"may be up to {LARGEST:g}, where such a layer is still becoming a compressible one: "
            "make the layer thicker, or state a Poisson ratio up to 0.49 or of 0.5"
        )
    last, power = _beyond(shape, body)
    return last * (a / LARGEST) ** power


@lru_cache(maxsize=64)
def _beyond(shape: Any, body: Layer) -> tuple[Array, Array]:
    """Return the four sums at the largest radius, and their powers of the radius beyond it."""
    values = _interpolated if type(shape) in POWERS else _direct
    last, before = (values(x, shape, body) for x in (LARGEST, LARGEST / 1.2))
    return last, np.log(last / before) / np.log(1.2)


def _interpolated(a: float, shape: Any, body: Layer) -> Array:
    """Return the four sums of a power at a radius [b], by polynomials of their logarithms."""
    place = log10(a) * _PER_DECADE
    first = min(floor(place) - _AROUND // 2 + 1, _LAST_STEP - _AROUND + 1)
    return np.exp((place - first - _MIDDLE) ** _POWERS @ _polynomials(first, shape, body))


@lru_cache(maxsize=4096)
def _polynomials(first: int, shape: Any, body: Layer) -> Array:
    """Return the coefficients of the polynomials through some radii of the table."""
    table = np.array([_at_step(first + k, shape, body) for k in range(_AROUND)])
    return np.asarray(np.linalg.solve(np.vander(np.arange(_AROUND) - _MIDDLE), table), dtype=float)


@lru_cache(maxsize=4096)
def _at_step(step: int, shape: Any, body: Layer) -> Array:
    """Return the logarithms of the four sums at a radius of the table."""
    return np.log(_direct(10 ** (step / _PER_DECADE), shape, body))


@lru_cache(maxsize=8)
def _at_once(radii: tuple[float, ...], shape: Any, body: Layer) -> Array:
    """Return the four sums at many radii [b], by one factorization.

    With nodes in panels that end at all radii, the equation of a radius is the first part of that
    of the largest one, and so are the Cholesky factor and what is solved with it.
    """
    a, b = np.array(radii), body.thickness
    coarsest = min(_COARSEST, detail(shape) / (_PER_DETAIL * b))
    even = np.linspace(0.0, a.max(), int(np.ceil(a.max() / coarsest)) + 1)
    edges = np.union1d(even, a)
    s, weight = gauss(edges, 2)
    root = np.sqrt(weight)
    t, kernel = _waves(body.base, 2 * a.max())
    waves = np.cos(np.multiply.outer(np.append(s, a), t))
    k = 2 / np.pi * (waves * kernel) @ waves[: s.size].T * root
    factor = np.linalg.cholesky(np.eye(s.size) + root[:, None] * k[: s.size])
    D = half_space_depth(b * np.append(s, a), shape)
    given = np.column_stack([root, root * D[: s.size], k[s.size :].T])
    solved = scipy.linalg.solve_triangular(factor, given, lower=True)
    disc, profile, at_edge = solved[:, 0], solved[:, 1], solved[:, 2:]
    many = 2 * np.searchsorted(edges, a)
    at_edge = np.where(np.arange(s.size)[:, None] < many, at_edge, 0.0)
    forces = 2 * b * np.cumsum([disc * disc, disc * profile], axis=1)[:, many - 1]
    return np.array([1 - disc @ at_edge, D[s.size :] - profile @ at_edge, *forces])


@lru_cache(maxsize=4096)
def _direct(a: float, shape: Any, body: Layer) -> Array:
    """Return the four sums at a radius [b]."""
    b, solved = body.thickness, _solved(a, body.base, _for_details(a, shape, body))
    g, edge = solved.profile(shape, b)
    force_of_disc, force_of_profile = 2 * b * (solved.weight @ np.column_stack([solved.disc, g]))
    return np.array([solved.disc_edge, edge, force_of_disc, force_of_profile])


def _for_details(a: float, shape: Any, body: Layer) -> int:
    """Return the number of panels that a shape needs for its details within a radius [b]."""
    return int(min(a * body.thickness / (_DETAILS * detail(shape)), _MOST_PANELS))


@dataclass(frozen=True, eq=False)
class _Solved:
    """The equation at a radius a, lengths in b: nodes and weights, g of the disc for E* = 2."""

    a: float
    s: npt.NDArray
    weight: npt.NDArray
    inverse: npt.NDArray
    kernel_at_edge: npt.NDArray
    disc: npt.NDArray

    @property
    def disc_edge(self) -> float:
        """The g of the disc at the edge."""
        return 1 - float(self.kernel_at_edge @ self.disc)

    def profile(self, shape: Any, b: float) -> tuple[npt.NDArray, float]:
        """Return g of a profile at the nodes and at the edge [m] for E* = 2."""
        D = half_space_depth(b * np.append(self.s, self.a), shape)
        g = self.inverse @ D[:-1]
        return g, float(D[-1] - self.kernel_at_edge @ g)


@lru_cache(maxsize=64)
def _solved(a: float, base: Base, panels: int) -> _Solved:
    """Return the solved equation at a radius [b], with some panels more for the shape."""
    edges = np.linspace(0.0, np.pi / 2, _PANELS + int(a / _WIDER) + panels + 1)
    angle, weight = gauss(edges, _POINTS)
    s, weight = a * np.sin(angle), a * np.cos(angle) * weight
    t, kernel = _waves(base, 2 * a)
    waves = np.cos(np.multiply.outer(np.append(s, a), t))
    k = 2 / np.pi * (waves * kernel) @ waves[:-1].T * weight
    inverse = np.linalg.inv(np.eye(len(s)) + k[:-1])
    return _Solved(a, s, weight, inverse, k[-1], inverse.sum(axis=1))


def _waves(base: Base, largest: float) -> tuple[npt.NDArray, npt.NDArray]:
    """Return wave numbers [1/b] and kappa - 1 times their weights, for distances up to one [b]."""
    panels = _FEWEST + int(_LAST * largest / _PHASE)
    t, weight = gauss(np.linspace(0.0, _LAST, panels + 1), 2 * _POINTS)
    return t, weight * (base.transfer(t) - 1)
