r"""Flat punch on a viscoelastic layer: energy of the edge cracks, limited by the finite size.

The energy of a fast crack is :math:`\Gamma = \Delta\gamma_{eff}/\Delta\gamma_0` works of adhesion,
on a half-space up to glassy over rubbery modulus, 1/k. On a layer the mean stress cannot exceed
the strength of the interface, so :math:`\Gamma` is below :math:`(\pi/4) \, b/a_0`. The
theories of Greenwood and of Persson and Brener are corrected by their glassy limit: the
larger of k and the inverse of that limit, :math:`k_b`, replaces k, as in
:meth:`viscotack.theory.crack.law.CrackLaw.limited` for any spectrum; for one retardation
time this is Eq. 3.35 and, for Persson and Brener, Eq. 4 of appendix II. Below the thickness b0 the
limit is below 1 and holds at every speed.

Speeds are those of the crack [m/s], opening. The crack is that of the edges of a
:class:`viscotack.theory.punch.pad.Pad`, by its method ``crack_law``.

Source: Maghami, PhD thesis (2025), Eq. 3.31 to 3.35 and appendix II.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, at_least, plain, positive
from viscotack.theory.crack import CrackLaw

from .pad import Pad
from .regimes import regime_thicknesses


def largest_amplification(thickness: Values, pad: Pad) -> Number:
    r"""Return the effective over rubbery surface energy allowed by the size of the pad.

    .. math:: \Gamma_{max} = \frac{\min(b, b_1)}{b_0}
              = \frac\pi4 \frac{b}{\zeta a_0} \;(b < b_1), \quad \frac{a}{a_0} \;(b > b_1)

    where the mean stress equals the strength (Eq. 3.31, which is for b < b1). The material gives
    another limit, 1/k. Below 1 the pad detaches at its strength at any speed.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    pad : Pad
        Punch, layer and interface; the Poisson ratio of a bonded layer is below 0.5.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> f"{largest_amplification(1e-4, pad):.2f}"
    '2.50'
    """
    b = positive(thickness=thickness)
    b0, _, b1 = regime_thicknesses(pad, modulus_ratio=1.0)
    return plain(np.minimum(b, b1) / b0)


def amplification(crack_speed: Values, law: CrackLaw, *, largest: Values) -> Number:
    r"""Return effective over rubbery surface energy at a crack speed, corrected for finite size.

    Parameters
    ----------
    crack_speed : array_like
        Speed [m/s] at which each edge recedes, not negative.
    law : CrackLaw
        Crack law of the edges on a half-space.
    largest : array_like
        Limit by the size: :func:`largest_amplification`, or infinity for a half-space.

    Raises
    ------
    InputError
        If a speed is negative or not finite, or a limit is not positive.

    Notes
    -----
    1e5 speeds take 0.1 s; every distinct ``largest`` below 1/k takes 1 to 5 ms.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.theory.punch import Frictionless, Pad
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> law = pad.crack_law("greenwood", material=solid)
    >>> found = amplification(0.1, law, largest=[0.5, 2.5, np.inf])
    >>> [f"{x:.3f}" for x in found]
    ['0.500', '2.163', '3.891']
    """
    v, limit = np.broadcast_arrays(
        at_least(0, "a crack that closes is another problem", crack_speed=crack_speed),
        _positive_limit(largest),
    )
    # below b0 the strength limits the stress at every speed
    found = np.array(np.minimum(limit, 1.0))
    for limited, here in _limited(law, limit):
        found[here] = limited.amplification(v[here])
    return plain(found)


def crack_speed(amplification: Values, law: CrackLaw, *, largest: Values) -> Number:
    """Return the crack speed [m/s] at which an amplification is reached.

    Parameters
    ----------
    amplification : array_like
        Effective over rubbery surface energy, at least 1 and below both `largest` and glassy
        over rubbery modulus.
    law : CrackLaw
        Crack law of the edges on a half-space.
    largest : array_like
        As for :func:`amplification`.

    Raises
    ------
    InputError
        If an amplification is not in its range, or a limit is not positive.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.theory.punch import Frictionless, Pad
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> law = pad.crack_law("greenwood", material=solid)
    >>> f"{crack_speed(2.0, law, largest=2.5) * 1e3:.1f} mm/s"
    '54.2 mm/s'
    """
    gamma, limit = np.broadcast_arrays(
        at_least(
            1,
            "the energy of the slowest crack is the work of adhesion",
            amplification=amplification,
        ),
        _positive_limit(largest),
    )
    most = np.minimum(limit, law.largest)
    if np.any((gamma >= most) & (gamma > 1)):
        raise InputError(
            "amplification must be below the limits of size and material, which are reached at "
            f"infinite speed: got {np.max(gamma):.6g}, limit {np.min(most):.6g}"
        )
    found = np.zeros(gamma.shape)
    for limited, here in _limited(law, limit):
        found[here] = limited.speed(gamma[here])
    return plain(found)


def _positive_limit(largest: Values) -> Any:
    limit = np.asarray(largest, dtype=float)
    if not np.all(limit > 0):
        raise InputError(f"largest must be a positive amplification, got {np.min(limit)}")
    return limit


def _limited(law: CrackLaw, limit: Any) -> Iterator[tuple[CrackLaw, Any]]:
    """Yield each limited law and its elements; nothing if the limit is 1 or below."""
    ratios = np.maximum(1 / limit, law.material.modulus_ratio)
    for ratio in np.unique(ratios[ratios < 1]):
        yield law.limited(modulus_ratio=float(ratio)), ratios == ratio
