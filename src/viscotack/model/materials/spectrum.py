r"""Spectrum of the modified power law, as nodes and weights.

Both forms of the material share one density per ln u, the gamma distribution

.. math:: \frac{u^n e^{-u}}{\Gamma(n)} ,

with u = tau/tau0 for the retardation form (Eq. 4.6) and u = tau0/tau for the relaxation form
(Eq. 4.1) of Maghami, PhD thesis (2025). The trapezoidal rule in ln u approximates every integral
over it with an error of exp(-pi^2/step), because the integrands are analytic for \|Im ln u\| <
pi/2: a step of 0.2 is exact to round-off for every exponent, integers included.
"""

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.model.materials.modes import blockwise, maxwell

FINE = 0.2  # exp(-pi^2/0.2) = 4e-22
_FIRST, _LAST = -37.0, math.log(60)  # ln u where exp(-u) is 1 to round-off, and where it is 0


def nodes(exponent: float, *, smallest: float, step: float) -> tuple[Array, Array]:
    """Return normalised weights and ascending nodes u of the spectrum.

    The first node replaces the whole spectrum below `smallest`, with its exact weight and
    mean, so that small exponents need no long tail of nodes.
    """
    n = exponent
    first = min(math.log(max(smallest, 1e-300)), _FIRST)
    y = step * np.arange(math.floor(first / step), math.ceil(_LAST / step))
    u = np.exp(y)
    weights = np.exp(n * y - u)
    # below y[0], exp(-u) is 1, so the sums over y[0] - step, y[0] - 2 step, ... are geometric
    weight = np.exp(n * y[0]) / math.expm1(n * step)
    mean = u[0] * math.expm1(n * step) / math.expm1((n + 1) * step)
    weights = np.concatenate(([weight], weights))
    return weights / np.sum(weights), np.concatenate(([mean], u))


def transform(exponent: float, x: Array) -> npt.NDArray[np.complex128]:
    r"""Average i x/(u + i x) over the spectrum, for x in [0, inf].

    .. math:: \Phi_n(s) = s e^s \mathbf{E}_n(s), \quad s = i x

    (Eq. 4.2 and 4.7), without the exponential integral of complex argument: each part is a sum
    of positive terms, with a relative error of 1e-14 for x from 1e-25 to 1e25.
    """
    mean = np.where(np.isinf(x), 1.0 + 0j, 0j)
    inside = (x > 0) & np.isfinite(x)
    if np.any(inside):
        # the mean of 1/(1 + (u/x)^2) and of (u/x)/(1 + (u/x)^2) for u below x/1e8 is that of 1 and
        # u/x
        weights, u = nodes(exponent, smallest=float(np.min(x[inside])) * 1e-8, step=FINE)
        mean[inside] = summed(maxwell, weights, x[inside], u)
    return mean


def crept(exponent: float, t: Array) -> Array:
    r"""Average 1 - exp(-t/u) over the spectrum, for t in [0, inf].

    .. math:: 1 - \frac{2}{\Gamma(n)} t^{n/2} \mathbf{K}_n(2 \sqrt{t})

    (Eq. 4.10 with k = 0). For small t, where this formula cancels, the integral itself is
    evaluated.
    """
    n = exponent
    late = np.clip(t, 0.1, 1e6)  # exp(-2000) is zero
    root = 2 * np.sqrt(late)
    mean = np.array(
        1
        - 2 * scipy.special.rgamma(n) * late ** (n / 2) * scipy.special.kve(n, root) * np.exp(-root)
    )
    early = (t > 0) & (t < 0.1)
    if np.any(early):
        weights, u = nodes(n, smallest=float(np.min(t[early])) / 40, step=FINE)
        mean[early] = summed(lambda ratio: -np.expm1(-ratio), weights, t[early], u)
    return np.where(t == 0, 0.0, mean)


def summed(
    kernel: Callable[[Array], npt.NDArray], weights: Array, x: Array, u: Array
) -> npt.NDArray:
    """Sum weights times kernel(x/u) over the nodes u; the result has the shape of x."""
    return blockwise(lambda column: kernel(column / u), weights, x)


def coarse_step(exponent: float, *, longest: float, tolerance: float) -> tuple[float, float]:
    r"""Return the widest step of the nodes for a tolerated error of the creep, and that error.

    The error of the trapezoidal rule is given by its first harmonic, with s = 2 pi/step and
    nu = n + i s (weights normalised to the sum 1):

    .. math::

        \frac{2}{\Gamma(n)} \left| \int_0^\infty u^{\nu-1} e^{-u} (1 - e^{-t/u}) du
        - \Gamma(\nu) F(t) \right| ,

    where F is the exact creep. For t <= longest it is bounded by the smaller of
    \|Gamma(nu)\| (1 + 2.2/(1 + 2n)), an envelope of the largest values for n in (0, 3] and
    s <= 23, and of \|Gamma(nu)\| F + exp(t/s) (t^n \|Gamma(-nu)\| + t \|Gamma(nu - 1)\|), from the
    series in t.
    """
    n, t = exponent, longest
    s = np.arange(3.0, 30.0, 0.1)
    nu = n + 1j * s
    G = np.exp(scipy.special.loggamma(nu).real) * scipy.special.rgamma(n)  # |Gamma(nu)|/Gamma(n)
    bound = G * (1 + 2.2 / (1 + 2 * n))
    if t < 1:
        reflected = np.pi / np.abs(nu * np.sin(np.pi * nu)) / G * scipy.special.rgamma(n) ** 2
        early = np.exp(t / s) * (t**n * reflected + t * G / np.abs(nu - 1))
        bound = np.minimum(bound, early + G * crept(n, np.array([t])))
    error = 2.1 * bound  # 5 % for the higher harmonics
    first = int(np.argmax(error <= tolerance)) if error[-1] <= tolerance else s.size - 1
    return 2 * np.pi / float(s[first]), float(error[first])
