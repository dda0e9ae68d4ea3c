r"""Greenwood: the effective surface energy of a viscoelastic crack with a cohesive zone.

A constant tension, the strength, bridges the crack over a moving zone; the creep
of the solid under it determines the opening of the faces. For one retardation time (Eq. 3.32)

.. math:: \frac1\Gamma = k + (1 - k) \, g(\alpha), \quad
          g(\alpha) = \frac\alpha2 \int_0^1 H(\xi) e^{-\alpha (1 - \xi)} d\xi, \quad
          \alpha = \frac{l \, \Gamma}{v \tau_0},

with the retardation modes of any solid :math:`1/\Gamma = c_\infty + \sum_j w_j
g(l \Gamma / v \tau_j)`, because creep adds up. Speeds are dimensionless,
:math:`\hat v = v \tau_0 / l` with the material's ``time_unit`` (a retardation time) for tau_0
and :func:`cohesive_zone_length` for l: multiply by l/tau_0 for m/s. Range: steady opening crack
in a half-space much larger than l Gamma, linear viscoelastic solid.

Source: Greenwood (2004), J. Phys. D 37, 2557 (no DOI known to this package), in the form of
Maghami, PhD thesis (2025), chapter 3, published as doi:10.1016/j.engfracmech.2024.109898.

**Greenwood's law over a table of the loss compliance: kernel, integral and inversion.** With
:math:`E_0 C(t) = 1 - \frac{2 E_0}{\pi} \int C''(\omega) \cos \omega t \, d\ln\omega` the energy of
the zone is

.. math:: \frac1\Gamma = 1 - \frac{2 E_0}{\pi} \int_0^\infty C''(\omega) \, Q(\omega A) \,
          d\ln\omega, \quad A = \frac{l \Gamma}{v}, \quad
          Q(y) = \mathrm{Re} \, {}_2F_2(1, 1; \tfrac32, 2; -i y)

with 0 < Q <= 1. On a grid uniform in ln omega and in ln A the integral is a convolution, and
everything is explicit at a given A.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.theory._checks import Number, Values, at_least, plain, positive
from viscotack.theory.crack import _crack


def amplification(speed: Values, *, material: _crack.Material) -> Number:
    r"""Return effective over rubbery surface energy at a dimensionless speed.

    The speed is :math:`v \tau_0 / l`, with the time unit tau_0 of the material. Eq. 3.32,
    after Greenwood (2004), for a steady opening crack; see the module.

    Relative error 1e-12 or better; 1e5 speeds take a fraction of a second.

    Parameters
    ----------
    speed : array_like
        Dimensionless speed, not negative.
    material : Material
        Viscoelastic solid of :mod:`viscotack.model.materials`.

    Raises
    ------
    InputError
        If a speed is negative or not finite.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> f"{amplification(1.0, material=solid):.3f}"
    '2.056'
    """
    return _theory.amplification(speed, material=material)


def speed(amplification: Values, *, material: _crack.Material) -> Number:
    r"""Return the dimensionless speed at which an amplification is reached.

    Parameters
    ----------
    amplification : array_like
        Effective over rubbery surface energy, at least 1 and below glassy over rubbery modulus.
    material : Material
        Viscoelastic solid of :mod:`viscotack.model.materials`.

    Raises
    ------
    InputError
        If an amplification is outside its range.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> f"{speed(2.0, material=solid):.3f}"
    '0.918'
    """
    return _theory.speed(amplification, material=material)


def cohesive_zone_length(
    *, contact_modulus: Values, work_of_adhesion: Values, strength: Values
) -> Number:
    r"""Return the length l [m] of the cohesive zone of a slow crack against a rigid body.

    .. math:: l = \frac{\pi E_0^* \Delta\gamma_0}{4 \sigma_0^2}

    Parameters
    ----------
    contact_modulus : float
        Rubbery E0* [Pa], positive.
    work_of_adhesion : float
        :math:`\Delta\gamma_0` [J/m^2], positive.
    strength : float
        Traction in the zone :math:`\sigma_0` [Pa], positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Notes
    -----
    Half of the fracture length a0 of Eq. 3.3; not the length of
    :func:`viscotack.theory.crack.persson_brener.crack_tip_length`.

    Examples
    --------
    >>> l = cohesive_zone_length(contact_modulus=1.9e6, work_of_adhesion=0.2, strength=5e6)
    >>> f"{l * 1e9:.1f} nm"
    '11.9 nm'
    """
    E, w, s = positive(
        contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion, strength=strength
    )
    return plain(np.pi * E * w / (4 * s**2))


def zone_response(ratio: Values) -> Number:
    r"""Return the ratio g of effective to full creep of a mode in the zone, dimensionless.

    .. math:: g(\alpha) = \frac\alpha2 \int_0^1 H(\xi) e^{-\alpha (1 - \xi)} d\xi
              = 1 - \frac2\alpha \int_0^{\sqrt\alpha} D(x) dx,

    :math:`H = 2 \sqrt\xi - (1 - \xi) \ln \frac{1 + \sqrt\xi}{1 - \sqrt\xi}` (Eq. 3.33), D
    Dawson's integral. It rises from alpha/3 to 1 - [ln(4 alpha) + 0.5772]/(2 alpha).

    Parameters
    ----------
    ratio : array_like
        :math:`\alpha = l \Gamma / (v \tau)`, not negative.

    Raises
    ------
    InputError
        If a ratio is negative or not finite.

    Examples
    --------
    >>> f"{zone_response(3.0):.4f}"
    '0.5284'
    """
    alpha = np.asarray(at_least(0, "it is a ratio of lengths", ratio=ratio))
    done, _ = _response(alpha)
    return plain(done)


_EULER = 0.5772156649015329
# Between these values of alpha the integral of Dawson's function is a Chebyshev polynomial.
_SMALL, _LARGE = 1.0, 50.0
# g = -sum (-alpha)^m / [(3/2)_m (m + 1)]
_SERIES = np.array(
    [0.0, *(-((-1.0) ** m) / ((m + 1) * np.prod(np.arange(1.5, m + 1))) for m in range(1, 21))]
)
# (2k - 1)!! / (k 2^(k+2)), of the asymptotic series in 1/alpha
_TAIL = np.array(
    [0.0, *(np.prod(np.arange(1.0, 2 * k, 2)) / (k * 2.0 ** (k + 2)) for k in range(1, 22))]
)


def _dawson_integral(z: Any) -> Any:
    """Return the integral of Dawson's function from 0 to z by quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(48)
    return z / 2 * (scipy.special.dawsn(z[..., None] / 2 * (nodes + 1)) @ weights)


@lru_cache(maxsize=1)
def _middle() -> Any:
    """Return the polynomial of the integral; made at its first use, for it loads scipy.special."""
    ends = [np.sqrt(_SMALL), np.sqrt(_LARGE)]
    return np.polynomial.Chebyshev.interpolate(_dawson_integral, 60, domain=ends)


def _response(alpha: Any) -> tuple[Any, Any]:
    """Return g and 1 - g; the branch determines which of the two is the difference."""
    small, large = alpha < _SMALL, alpha > _LARGE
    middle = ~(small | large)
    done, rest = np.empty_like(alpha), np.empty_like(alpha)
    done[small] = np.polynomial.polynomial.polyval(alpha[small], _SERIES)
    rest[small] = 1 - done[small]
    a = alpha[middle]
    rest[middle] = 2 / a * _middle()(np.sqrt(a))
    a = alpha[large]
    tail = np.polynomial.polynomial.polyval(1 / a, _TAIL)
    rest[large] = 2 / a * ((np.log(4 * a) + _EULER) / 4 - tail)
    done[~small] = 1 - rest[~small]
    return done, rest


_theory = _crack.Theory(_response, factor=1.0)
# Cracks with given passage times of the tip, for CrackLaw.
passage, amplification_of_passage = _theory.passage, _theory.amplification_of_passage


# Step in ln omega: six nodes per period of Q where Q is last resolved.
_STEP, _FULL = 0.005, 200.0
# Below this Q is 1 - y^2/11.25 to round-off.
_TINY = 1e-4
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


class Bounds(NamedTuple):
    """Passage times A, ascending, with a lower and an upper bound of 1/Gamma."""

    passage: Array
    least: Array
    most: Array


def bounds(frequencies: Array, loss: Array, *, below: tuple[float, float], above: float) -> Bounds:
    """Return bounds of 1/Gamma for passage times between the inverse ends of the table.

    ``below`` are bounds of the integral of E0 C'' over ln omega below the table, ``above`` the
    upper bound above it.
    """
    rows = np.log(frequencies)
    width = rows[-1] - rows[0]
    count = int(np.ceil(width / _STEP))
    x = np.linspace(rows[0], rows[-1], count + 1)
    # a power law between two rows
    inner = np.exp(np.interp(x, rows, np.log(loss))) * (x[1] - x[0])
    inner[[0, -1]] /= 2
    y = np.exp(np.linspace(-width, width, 2 * count + 1))
    Q = kernel(y)
    # entry i belongs to ln A = ln A_0 + i step, and needs Q from i to i + count
    size = Q.size + count
    spectrum = np.fft.rfft(Q, size) * np.fft.rfft(inner[::-1], size)
    table = np.fft.irfft(spectrum, size)[count : 2 * count + 1]
    # the extremes of Q beyond each entry
    nearer = np.minimum.accumulate(Q)[: count + 1]
    beyond = np.maximum.accumulate(Q[::-1])[::-1][count:]
    part = 2 / np.pi
    most = 1 - part * (table + below[0] * nearer)
    least = 1 - part * (table + below[1] + above * beyond)
    # the creep under the zone grows with the passage time, and so does 1/Gamma
    most = np.minimum.accumulate(most[::-1])[::-1]
    least = np.maximum.accumulate(least)
    passage = np.exp(x - rows[0] - rows[-1])
    known = least > 0
    return Bounds(passage[known], least[known], most[known])


def ends(curves: Bounds) -> tuple[float, float]:
    """Return the slowest and the fastest v/l covered by both bounds."""
    speeds = [1 / (inverse * curves.passage) for inverse in (curves.least, curves.most)]
    return float(max(v[-1] for v in speeds)), float(min(v[0] for v in speeds))


def kernel(y: Array) -> Array:
    """Return Q at ascending arguments that are uniform in the logarithm."""
    Q = 1 - y**2 / 11.25
    middle = (y > _TINY) & (y <= _FULL)
    large = y > _FULL
    if np.any(middle):
        # (2/alpha) int_0^sqrt(alpha) D(x) dx on the ray alpha = i y, panel by panel
        s = np.sqrt(np.append(0.0, y[middle]))
        half = np.diff(s) / 2
        at = s[:-1, None] + half[:, None] * (1 + _NODES)
        turn = np.exp(0.25j * np.pi)
        integral = np.cumsum(scipy.special.dawsn(turn * at) @ _WEIGHTS * half) * turn
        Q[middle] = np.real(2 * integral / (1j * y[middle]))
    # neglect the oscillations: they decay as y^(-3/2), and their integral is below y^(-5/2)
    Q[large] = np.pi / (4 * y[large]) + 1 / (4 * y[large] ** 2)
    return Q


def solved(speed: Array, passage: Array, inverse: Array) -> Array:
    """Return Gamma at speeds v/l, for 1/Gamma at passage times: v/l = Gamma/A."""
    gamma = 1 / inverse
    aim = np.log(gamma / passage)
    return np.exp(np.interp(np.log(speed), aim[::-1], np.log(gamma)[::-1]))
