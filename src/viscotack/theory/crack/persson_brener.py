r"""Persson and Brener: the effective surface energy of a viscoelastic crack, any spectrum.

The energy is dissipated in the bulk around a crack of tip length a, cut off at the frequency
2 pi v / a. With the retardation modes of the creep, :math:`E_0 C(t) = c_\infty + \sum_j w_j
(1 - e^{-t/\tau_j})`, the amplification :math:`\Gamma = \Delta\gamma_{eff}/\Delta\gamma_0` solves

.. math:: \frac1\Gamma = 1 - \sum_j w_j \left[ \sqrt{1 + b_j^{-2}} - b_j^{-1} \right], \quad
          b_j = \frac{2 \pi v \tau_j}{l_0 \Gamma}

(Eq. 4.17 and 4.18; for the modified power law 4.20). Speeds are dimensionless,
:math:`\hat v = v \tau_0 / l_0` with the material's ``time_unit`` for tau_0 and
:func:`crack_tip_length` for l_0: multiply by l_0/tau_0 for m/s. Range: steady opening crack in a
half-space much larger than l_0 Gamma, linear viscoelastic solid. Gamma rises from 1 at zero speed
to glassy over rubbery modulus.

Source: Persson & Brener (2005), doi:10.1103/PhysRevE.71.036123, in the form of Maghami, PhD
thesis (2025), chapter 4, published as doi:10.1016/j.jmps.2024.105844.

**Persson-Brener integral over a table of the loss compliance, and its inversion.** The loss
compliance is a power law between two rows, so I, its integral over ln omega, is explicit; the
integral of I(omega_c sin theta) sin theta is smooth between the angles of the rows.

**Power-law regimes of the Persson-Brener theory: slow, intermediate, and their validity.** A slow
crack dissipates in proportion to its speed (:func:`slow_amplification`); a faster one as a power of
it that depends on the breadth of the spectrum (:func:`local_exponent`, :func:`steepest`); the
fastest not at all.

Source: the same, Fig. 4.6 and appendix IV of the thesis, whose fit q1 = -0.0125 + 3.136 n
approximates the exact coefficient below at k = 0.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, at_least, plain, positive, ratio
from viscotack.theory._roots import regula_falsi
from viscotack.theory.crack import _crack


def amplification(speed: Values, *, material: _crack.Material) -> Number:
    r"""Return effective over rubbery surface energy at a dimensionless speed.

    The speed is :math:`v \tau_0 / l_0`, with the time unit tau_0 of the material. Eq. 4.17 and
    4.18, after Persson and Brener (2005), for a steady opening crack; see the module.

    Relative error 1e-12 or better if the modes represent the creep to 1e-14 k, as for power laws;
    for a fractional solid 1e-11 for k down to 1e-6 and orders up to 0.95. 1e5 speeds take a
    fraction of a second.

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
    >>> from viscotack.model.materials import RetardationPowerLaw
    >>> rubber = RetardationPowerLaw(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, exponent=0.6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> f"{amplification(1.0, material=rubber):.3f}"
    '1.677'
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
    '0.512'
    """
    return _theory.speed(amplification, material=material)


def crack_tip_length(
    *, contact_modulus: Values, work_of_adhesion: Values, strength: Values, strength_ratio: Values
) -> Number:
    r"""Return the length l0 [m] at which the stress of the slow crack equals the critical one.

    .. math:: l_0 = \frac{E_0^* \Delta\gamma_0}{\pi (\alpha \sigma_0)^2} \quad \text{(Eq. 4.23)}

    Parameters
    ----------
    contact_modulus : float
        Rubbery E0* [Pa], against a rigid body; positive.
    work_of_adhesion : float
        :math:`\Delta\gamma_0` [J/m^2], positive.
    strength : float
        Peak traction :math:`\sigma_0` [Pa], positive.
    strength_ratio : float
        :math:`\alpha = \sigma_c / \sigma_0`, positive: pi/9 was fitted to simulations of a
        sphere with the Lennard-Jones traction (chapter 4), sqrt(2)/pi makes l0 the fracture length
        a0 of Eq. 3.3 (appendix II).

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Notes
    -----
    Not the length of :func:`viscotack.theory.crack.greenwood.cohesive_zone_length`, which is
    :math:`\pi^2 \alpha^2 / 4` times this one.

    Examples
    --------
    >>> l0 = crack_tip_length(
    ...     contact_modulus=1.9e6, work_of_adhesion=0.2, strength=5e6, strength_ratio=np.pi / 9
    ... )
    >>> f"{l0 * 1e9:.1f} nm"
    '39.7 nm'
    """
    E, w, s, alpha = positive(
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
        strength=strength,
        strength_ratio=strength_ratio,
    )
    return plain(E * w / (np.pi * (alpha * s) ** 2))


def _response(q: Any) -> tuple[Any, Any]:
    """Return 1 - sqrt(1 + q^2) + q and its complement, q = 1/b, without cancellation."""
    root = np.sqrt(1 + q**2)
    return 2 * q / (1 + q + root), 1 / (root + q)


_theory = _crack.Theory(_response, factor=2 * np.pi)
# Cracks with given passage times of the tip, for CrackLaw.
passage, amplification_of_passage = _theory.passage, _theory.amplification_of_passage


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_CLOSE = 1e-13
_BLOCK = 2**18


class Table(NamedTuple):
    """Frequencies, E0 C'' there, I at the first row, and whether I falls to zero with omega."""

    frequencies: Array
    loss: Array
    start: float
    linear_below: bool


def rest(cutoff: Array, table: Table) -> Array:
    """Return 1/Gamma at cut-offs within the table."""
    w, loss, start, linear_below = table
    width = np.diff(np.log(w))
    slope = np.diff(np.log(loss)) / width
    total = start + np.append(0.0, np.cumsum(loss[:-1] * width * _mean(slope * width)))
    edges = np.arcsin(np.minimum(w / cutoff[:, None], 1.0))
    # rows above the cut-off contribute nothing
    half = np.diff(edges)[..., None] / 2
    angle = edges[:, :-1, None] + half * (1 + _NODES)
    x = np.log(cutoff[:, None, None] * np.sin(angle) / w[:-1, None])
    inside = total[:-1, None] + loss[:-1, None] * x * _mean(slope[:, None] * x)
    found = np.sum(inside * np.sin(angle) * half * _WEIGHTS, axis=(1, 2))
    first = edges[:, 0]
    if linear_below:
        found += start * (first / 2 - np.sin(2 * first) / 4) / np.sin(first)
    else:
        found += start * (1 - np.cos(first))
    return 1 - 2 / np.pi * found


def solved(speed: Array, table: Table) -> Array:
    """Return Gamma at speeds v/l0 whose cut-offs lie in the table, in blocks."""
    flat = np.ravel(speed)
    size = max(1, _BLOCK // (_NODES.size * table.loss.size))
    blocks = [_solved(flat[i : i + size], table) for i in range(0, flat.size, size)]
    return np.concatenate([*blocks, []]).reshape(np.shape(speed))


def _mean(y: Array) -> Array:
    """Return (e^y - 1)/y, the mean of a power law over a panel."""
    return np.where(np.abs(y) < 1e-8, 1 + y / 2, np.expm1(y) / np.where(y == 0, 1.0, y))


def _solved(speed: Array, table: Table) -> Array:
    """Return Gamma at speeds; the speed rises with the cut-off, so two rows bracket it."""
    rows = table.frequencies
    aim = np.log(2 * np.pi * speed)
    at_rows = np.log(rows / rest(rows, table))
    i = np.clip(np.searchsorted(at_rows, aim) - 1, 0, rows.size - 2)

    def miss(log_cutoff: Array) -> Array:
        return log_cutoff - np.log(rest(np.exp(log_cutoff), table)) - aim

    found = regula_falsi(miss, np.log(rows[i]), np.log(rows[i + 1]), noise=_CLOSE)
    return 1 / rest(np.exp(found), table)


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
    gamma = np.log(np.asarray(amplification(at, material=material)))
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
    low, high = (float(speed(1 + span * part, material=material)) for part in (1e-3, 0.999))
    for _ in range(3):
        decades = np.log10(high / low)
        grid = np.geomspace(low, high, max(int(_PER_DECADE * decades), _PER_DECADE))
        slopes = np.asarray(local_exponent(grid, material=material))
        best = int(np.clip(np.argmax(slopes), 1, grid.size - 2))
        low, high = grid[best - 1], grid[best + 1]
    steep, m = float(grid[best]), float(slopes[best])
    gamma = float(amplification(steep, material=material))
    return PowerLaw(gamma / steep**m, m, steep)
