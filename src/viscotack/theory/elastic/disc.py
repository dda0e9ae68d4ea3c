r"""A rigid disc, the flat end of a cylinder, on an elastic half-space: Kendall, and his limit.

A disc comes off all at once, as a crack runs in from its edge (Kendall) or, where it is small
beside the crack's own length, at the strength of the interface everywhere:

.. math:: P_K = \sqrt{8 \pi E^* a^3 \Delta\gamma_0}, \quad P_\sigma = \pi a^2 \sigma_0, \quad
          a_\times = \frac{8 E^* \Delta\gamma_0}{\pi \sigma_0^2}

being equal at the crossover radius. Around it a law of traction lies below both; with Dugdale's
the march is 2.8, 0.8 and 0.2 % below Kendall at :math:`\sqrt{a \Delta\gamma_0/E^*}/h_0` of 4, 8
and 16 (`benchmarks/profiles.py`).

Source: Kendall (1971), doi:10.1088/0022-3727/4/8/320. Depth and stiffness of the disc are in
:mod:`viscotack.theory.elastic.profiles`.
"""

from __future__ import annotations

import numpy as np

from viscotack.theory._checks import Number, Values, plain, positive

from . import profiles


def strength_limit(*, contact_radius: Values, strength: Values) -> Number:
    r"""Return the force [N] at which a small disc comes off everywhere, a positive number.

    Examples
    --------
    >>> f"{strength_limit(contact_radius=1e-6, strength=50e3) * 1e9:.1f} nN"
    '157.1 nN'
    """
    a, s = positive(contact_radius=contact_radius, strength=strength)
    return plain(np.pi * a**2 * s)


def crossover_radius(
    *, contact_modulus: Values, work_of_adhesion: Values, strength: Values
) -> Number:
    r"""Return the radius [m] at which Kendall's force is that of the strength.

    Examples
    --------
    >>> solid = dict(contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{crossover_radius(**solid, strength=50e3) * 1e6:.1f} um"
    '50.9 um'
    """
    E, w, s = positive(
        contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion, strength=strength
    )
    return plain(8 * E * w / (np.pi * s**2))


def pull_off_force(
    *,
    contact_radius: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
    strength: Values | None = None,
) -> Number:
    r"""Return the most that a disc can bear [N], a positive number: the smaller of both limits.

    Parameters
    ----------
    contact_radius, contact_modulus, work_of_adhesion : array_like
        Radius of the disc a [m], :math:`E^*` [Pa], :math:`\Delta\gamma_0` [J/m^2]; positive.
    strength : array_like
        Largest tension of the interface [Pa]; left out, it is Kendall's force.

    Examples
    --------
    >>> solid = dict(contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{pull_off_force(contact_radius=1e-3, **solid, strength=50e3) * 1e3:.1f} mN"
    '35.4 mN'
    """
    kendall = profiles.punch_pull_off(
        contact_radius=contact_radius,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
    )
    if strength is None:
        return plain(-np.asarray(kendall.force))
    uniform = strength_limit(contact_radius=contact_radius, strength=strength)
    return plain(np.minimum(-np.asarray(kendall.force), uniform))
