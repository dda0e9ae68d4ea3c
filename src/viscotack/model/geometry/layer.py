r"""Compliance of an elastic layer in plane strain under symmetric pressure, on any mesh.

A line load of 1 on a layer of thickness b moves its surface, at a distance s, by G(s/b)/E*. With
F'' = G, F even and F(0) = 0,

.. math:: F(y) = \frac{2}{\pi} \int_0^\infty \kappa(t) \frac{1 - \cos ty}{t^3}\, dt,

kappa being the transfer function of the layer on its base, a pressure that is linear between the
nodes of *any* mesh is a matter of differences: a hat of height 1 moves the surface by b^2/E* times
the jump, at its top, of the slopes of the chords of F(s/b) over its two flanks. One function per
base serves all meshes and thicknesses. It is tabulated once, in 10 ms, in two ways:

- near, y < 1, as :math:`F = y^2 [r(y) - \ln(y)/\pi]`: the half-plane, and a smooth r;
- far, as :math:`F = c\,y/2 + A + E(y)`, where c is the compliance of a thin layer as a foundation
  and E dies out exponentially: nothing is left of it at y = 48, whatever Poisson's ratio.

For layers thinner than the punch is wide, differences are taken of E alone, and the foundation
c p b/E*, which corresponds to the linear terms c y/2, is added to the diagonal. Thin layers
(b/a = 0.005) therefore lose no digits. Rounding errors come from differences over short flanks h:
about 1e-16 (a/h)^2 in the compliance, 1e-8 at h = 1e-4 a, and less on thin layers.

The half-plane is not included: with growing b the layer sinks deeper as a whole, by :math:`(2/\pi)
\ln b` per force and length. Only differences of displacement have a limit, to which they tend as
(a/b)^2.

Pressure is symmetric in x. Nodes go from the middle, x = 0, to the end of the punch, x = a, where
the pressure ends with half a hat; node j represents the two hats at x_j and -x_j.

As for the half-space, the compliance B = G/length of a unit *force* on node j is to be replaced by
its symmetric part. That was positive definite in all that was tried: b/a from 0.005 to 100, every
base, shortest flank 1e-4 a. Averages of the displacement over the hats (Galerkin's matrix) would be
symmetric by themselves. Against it, with the same nodes, this collocation has 1.5 times smaller
errors of the adhesive pull-off stress for b >= 0.2 a and four to five times larger ones, below
1e-4, for b = 0.03 a; both are of second order once the cohesive zone is resolved. Without adhesion
a rigid punch, its pressure infinite at the ends, comes out 4.6 times less exact, both being of
first order.

A bonded layer of Poisson's ratio 1/2 needs nodes that tell thicknesses apart also where the
pressure is smooth: with b = 0.05 a and flanks in the middle of 4, 1 and 1/2 b the punch is 14, 0.4
and 0.04 % off.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from scipy.interpolate import PPoly
from scipy.special import xlogy, zeta

from viscotack.errors import InputError
from viscotack.model.geometry.bodies import Base
from viscotack.model.geometry.panels import gauss

# Where F changes its form, and where E has died out: for Poisson's ratio 1/2 as exp(-0.74 y).
_NEAR, _FAR = 1.0, 48.0
_DEGREE = 9


def layer_influence(x: npt.NDArray, thickness: float, base: Base) -> npt.NDArray:
    r"""Return G[i, j], the displacement at node i under the hats at x_j and -x_j, for E* = 1.

    .. math:: u(x_i) = \frac{1}{E^*} \sum_j G_{ij} p_j

    Parameters
    ----------
    x : ndarray, shape (N,)
        Nodes in any unit of length, ascending from 0 to the end of the punch, at any distances.
    thickness : float
        Thickness b of the layer, in the same unit.
    base : Frictionless or Bonded
        How the layer rests on the rigid body below.

    Returns
    -------
    ndarray, shape (N, N)
        In the same unit of length; displacement into the layer is positive under pressure. Small
        negative values far away are real: the surface bulges there.

    Raises
    ------
    ValueError
        If the nodes do not ascend from 0, or the thickness is not positive.

    References
    ----------
    Maghami, PhD thesis (2025), Eq. 3.19 to 3.22, has the same hats on equal nodes, after Bentall
    and Johnson; its displacement is positive for tension, so that its signs are the other ones.

    Examples
    --------
    A flat punch on a thin layer meets a stiffness of 2a/b and two edges of 0.177 each:

    >>> import numpy as np
    >>> from viscotack.model.geometry import Frictionless
    >>> from viscotack.model.geometry.panels import hat_areas
    >>> x = 1 - np.linspace(1, 0, 101) ** 2  # crowded at the end
    >>> G = layer_influence(x, 0.1, Frictionless())
    >>> pressure = np.linalg.solve(G, np.ones(101))
    >>> f"{hat_areas(x, 'plane') @ pressure:.3f}"
    '20.355'
    """
    if not (len(x) > 1 and x[0] == 0 and np.all(np.diff(x) > 0)):
        raise InputError(f"the nodes x must ascend from 0, got {np.array2string(x, threshold=6)}")
    if not thickness > 0:
        raise InputError(f"thickness must be positive, got {thickness:g}")
    y = x / thickness
    end = y[-1]
    thin = bool(2 * end > _NEAR)
    potential = _potential(base)
    lower, upper = np.triu_indices(len(y))
    distances = np.stack([y[upper] - y[lower], y[upper] + y[lower]])
    F = np.empty((len(y), len(y)))
    F[lower, upper] = F[upper, lower] = potential.value(distances, thin).sum(axis=0)
    chords = np.diff(F, axis=1) / np.diff(y)
    last = potential.slope(np.stack([end - y, end + y]), thin).sum(axis=0)
    G = np.column_stack([chords[:, 0], np.diff(chords, axis=1), last - chords[:, -1]])
    if thin:
        inner = np.arange(len(y) - 1)
        G[inner, inner] += base.foundation
        G[-1, -1] += base.foundation / 2  # pressed on one side only
    return thickness * G


def own_displacement(y: npt.NDArray, base: Base) -> npt.NDArray:
    """Return the displacement at the top of each hat under it alone, lengths in b, for E* = 1."""
    flank = np.diff(y)
    chord = _potential(base).value(flank, False) / flank
    return np.concatenate([chord[:1], chord]) + np.concatenate([chord, [0.0]])


@dataclass(frozen=True, eq=False)
class _Potential:
    """F for one base: r(y) below y = 1 and E(y) above as one table, c/2 and A."""

    table: PPoly
    tilt: PPoly  # derivative of the table
    linear: float
    constant: float

    def value(self, y: npt.NDArray, reduced: bool) -> npt.NDArray:
        """Return F(y), or if reduced E(y) = F - c y/2 - A, for y >= 0."""
        near, middle = y < _NEAR, (y >= _NEAR) & (y < _FAR)
        s, out = y[near], np.zeros_like(y)
        out[near] = s * s * self.table(s) - xlogy(s * s, s) / np.pi
        out[middle] = self.table(y[middle])
        if reduced:
            out[near] -= self.linear * s + self.constant
        else:
            out[~near] += self.linear * y[~near] + self.constant
        return out

    def slope(self, y: npt.NDArray, reduced: bool) -> npt.NDArray:
        """Return the derivative of the same, at y = 0 as the mean of both sides, zero."""
        near, middle = y < _NEAR, (y >= _NEAR) & (y < _FAR)
        s, out = y[near], np.zeros_like(y)
        out[near] = s * (2 * self.table(s) + s * self.tilt(s)) - (2 * xlogy(s, s) + s) / np.pi
        out[middle] = self.tilt(y[middle])
        if reduced:
            out[near & (y > 0)] -= self.linear
        else:
            out[~near] += self.linear
        return out


@lru_cache(maxsize=64)
def _potential(base: Base) -> _Potential:
    """Tabulate F for a base, to about 1e-15 near and 5e-14 far away."""
    near = np.linspace(0.0, _NEAR, 9)
    growing = _NEAR * 1.125 ** np.arange(13)  # E has a logarithm at y = 0
    breaks = np.concatenate([near[:-1], growing, np.linspace(4.5, _FAR, 88)])
    width = np.diff(breaks)
    points = (1 + np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))) / 2
    y = (breaks[:-1, None] + width[:, None] * points).ravel()
    far, constant = _far(base, y[y >= _NEAR])
    values = np.concatenate([_near(base, y[y < _NEAR]), far]).reshape(len(width), -1)
    powers = np.linalg.solve(np.vander(points), values.T)
    table = PPoly(powers / width ** np.arange(_DEGREE, -1, -1)[:, None], breaks)
    return _Potential(table, table.derivative(), base.foundation / 2, constant)


def _near(base: Base, y: npt.NDArray) -> npt.NDArray:
    """Return r(y) = F/y^2 + ln(y)/pi, for y up to 1, from Gauss panels.

    Taken off is the half-plane: -ln y is the integral of (cos ty - exp -t)/t.
    """
    edges = np.concatenate([np.linspace(0.0, 4.0, 9), np.linspace(6.0, 40.0, 18)])
    t, w = gauss(edges, 16)
    rest = 1 - base.transfer(t)
    sinc = np.sinc(np.multiply.outer(y, t) / (2 * np.pi))
    return 1.5 / np.pi + (np.exp(-t) - rest * sinc * sinc) @ (w / t) / np.pi


def _far(base: Base, y: npt.NDArray) -> tuple[npt.NDArray, float]:
    """Return E(y), for y from 1 to 48, and A.

    The kernel tanh t has a closed form, exponentials. What it leaves of kappa, over t, is even and
    dies out, and so the trapezoidal rule has no error but images of E at y = 100 and more.
    """
    odd = np.arange(1, 61, 2)
    E = 16 / np.pi**3 * np.exp(-np.pi / 2 * np.multiply.outer(y, odd)) @ (1.0 / odd**3)
    constant = -14 / np.pi**3 * float(zeta(3))
    step = np.pi / (_FAR + 6)
    t = step * np.arange(1, int(20 / step))
    weight = 4 * step / np.pi * (base.transfer(t) - np.tanh(t)) / t**3
    linear = base.foundation / 2 - 1

    def bent(y: npt.NDArray) -> npt.NDArray:
        at_zero = step / (2 * np.pi) * linear * y * y  # the node t = 0
        return at_zero + np.sin(np.multiply.outer(y, t) / 2) ** 2 @ weight - linear * y

    shift = float(bent(np.array([_FAR]))[0])
    return E + bent(y) - shift, constant + shift
