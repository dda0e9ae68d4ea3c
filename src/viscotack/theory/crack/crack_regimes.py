r"""Power-law regimes of the Persson-Brener theory: slow, intermediate, and their validity.

A slow crack dissipates in proportion to its speed (:func:`slow_amplification`); a faster one
as a power of it that depends on the breadth of the spectrum (:func:`local_exponent`,
:func:`steepest`); the fastest not at all. Speeds are dimensionless as in
:mod:`viscotack.theory.crack.persson_brener`, :math:`\hat v = v \tau_0 / l_0`.

Source: Persson & Brener (2005), doi:10.1103/PhysRevE.71.036123; Maghami, PhD thesis (2025),
Fig. 4.6 and appendix IV, published as doi:10.1016/j.jmps.2024.105844, whose fit
q1 = -0.0125 + 3.136 n approximates the exact coefficient below at k = 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, at_least, plain, positive, ratio

from . import _crack, persson_brener

_PER_DECADE = 40


class PowerLaw(NamedTuple):
    """Tangent Gamma = coefficient * speed**exponent in logarithms, and its point of contact.

    Returned by :func:`steepest`; all numbers are dimensionless.
    """

    coefficient: float
    exponent: float
    speed: float


def slow_amplification(speed: Values, *, modulus_ratio: Values, exponent: Values) -> Number:
    r"""Return the dimensionless amplification of a slow crack in a retardation power law.

    .. math:: \Gamma \to 1 + \pi n (1 - k) \hat v

    Range: exact for :math:`\hat v \to 0`; the next term is of the order :math:`\hat v^3`.

    Parameters
    ----------
    speed : array_like
        Dimensionless speed :math:`\hat v`, not negative.
    modulus_ratio : array_like
        k, above 0 and at most 1.
    exponent : array_like
        Exponent n of the retardation power law, positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> f"{slow_amplification(0.01, modulus_ratio=0.1, exponent=0.6):.4f}"
    '1.0170'
    """
    k, n = ratio(modulus_ratio), positive(exponent=exponent)
    v = at_least(0, "a crack that closes is another problem", speed=speed)
    return plain(1 + np.pi * n * (1 - k) * v)


def intermediate_exponent(exponent: Values) -> Number:
    r"""Return the intermediate exponent of speed in the limit of a small modulus ratio.

    .. math:: m_2 = \frac{n}{1 + n} \; (n < 1), \quad m_2 = \tfrac12 \; (n \ge 1)

    A finite modulus ratio keeps the slope below it, see :func:`steepest`; the limit is approached
    slowly, at n = 1 logarithmically.

    Parameters
    ----------
    exponent : array_like
        Exponent n of the retardation power law, positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> f"{intermediate_exponent(0.6):.3f}"
    '0.375'
    """
    n = positive(exponent=exponent)
    return plain(np.minimum(n / (1 + n), 0.5))


def local_exponent(speed: Values, *, material: _crack.Material) -> Number:
    r"""Return :math:`d \ln \Gamma / d \ln \hat v` at dimensionless speeds.

    Parameters
    ----------
    speed : array_like
        Dimensionless speed :math:`\hat v`, positive.
    material : Material
        Viscoelastic solid of :mod:`viscotack.model.materials`.

    Raises
    ------
    InputError
        If a speed is not positive and finite.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e8, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> f"{local_exponent(1.0, material=solid):.3f}"
    '0.423'
    """
    v = positive(speed=speed)
    step = 1e-3
    # a central difference of fourth order in ln v; Gamma is known to 1e-14
    at = v[..., None] * np.exp(step * np.array([-2.0, -1.0, 1.0, 2.0]))
    gamma = np.log(np.asarray(persson_brener.amplification(at, material=material)))
    return plain(gamma @ np.array([1.0, -8.0, 8.0, -1.0]) / (12 * step))


def steepest(*, material: _crack.Material) -> PowerLaw:
    r"""Return the power law :math:`\Gamma = \beta \hat v^m` of the intermediate range (Fig. 4.6).

    The tangent in logarithms at the speed where the local exponent is largest.

    Parameters
    ----------
    material : Material
        Viscoelastic solid of :mod:`viscotack.model.materials`, not elastic.

    Returns
    -------
    PowerLaw
        Coefficient, exponent and speed of the tangent, dimensionless.

    Raises
    ------
    InputError
        If the solid is elastic.

    Examples
    --------
    >>> from viscotack.model.materials import RetardationPowerLaw
    >>> rubber = RetardationPowerLaw(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, exponent=0.6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> law = steepest(material=rubber)
    >>> f"{law.coefficient:.2f} v^{law.exponent:.3f}"
    '1.64 v^0.248'
    """
    k = material.modulus_ratio
    if k >= 1:
        raise InputError(
            "an elastic solid has no intermediate range, because its amplification is 1"
        )
    span = 1 / k - 1
    low, high = (
        float(persson_brener.speed(1 + span * part, material=material)) for part in (1e-3, 0.999)
    )
    for _ in range(3):
        decades = np.log10(high / low)
        grid = np.geomspace(low, high, max(int(_PER_DECADE * decades), _PER_DECADE))
        slopes = np.asarray(local_exponent(grid, material=material))
        best = int(np.clip(np.argmax(slopes), 1, grid.size - 2))
        low, high = grid[best - 1], grid[best + 1]
    speed, m = float(grid[best]), float(slopes[best])
    gamma = float(persson_brener.amplification(speed, material=material))
    return PowerLaw(gamma / speed**m, m, speed)
