r"""Where a JKR contact ends: the force minimum, the depth minimum and the work up to them.

The functions are reached as ``jkr.pull_off`` and so on; parameters, units, signs, range and
source as in :mod:`viscotack.theory.elastic.jkr`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.theory._checks import Number, plain, positive
from viscotack.theory._scales import contact_scales


class Point(NamedTuple):
    """A point of the equilibrium curve: contact radius [m], depth [m], force [N]."""

    contact_radius: Number
    depth: Number
    force: Number


def pull_off_force(*, radius: npt.ArrayLike, work_of_adhesion: npt.ArrayLike) -> Number:
    r"""Return the pull-off force [N], the positive number :math:`\frac32\pi R\Delta\gamma_0`.

    It does not depend on the modulus and holds for load and depth control alike.

    Examples
    --------
    >>> f"{pull_off_force(radius=1e-3, work_of_adhesion=0.05) * 1e3:.4f} mN"
    '0.2356 mN'
    """
    R, w = positive(radius=radius, work_of_adhesion=work_of_adhesion)
    return plain(1.5 * np.pi * R * w)


def pull_off(
    *, radius: npt.ArrayLike, contact_modulus: npt.ArrayLike, work_of_adhesion: npt.ArrayLike
) -> Point:
    r"""Return the force minimum: :math:`\hat a^3 = 9/8, \hat\delta = -3^{1/3}/4, \hat P = -3/2`.

    Examples
    --------
    >>> end = pull_off(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{end.contact_radius * 1e6:.1f} um, {end.depth * 1e6:.2f} um, {end.force * 1e3:.4f} mN"
    '56.1 um, -1.05 um, -0.2356 mN'
    """
    length, height, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    a, d, P = 1.125 ** (1 / 3), -(3 ** (1 / 3)) / 4, -1.5
    return Point(plain(a * length), plain(d * height), plain(P * load))


def instability(
    *, radius: npt.ArrayLike, contact_modulus: npt.ArrayLike, work_of_adhesion: npt.ArrayLike
) -> Point:
    r"""Return the depth minimum: :math:`\hat a = 1/2, \hat\delta = -3/4, \hat P = -5/6`.

    Examples
    --------
    >>> end = instability(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{end.contact_radius * 1e6:.1f} um, {end.depth * 1e6:.2f} um, {end.force * 1e3:.4f} mN"
    '27.0 um, -2.18 um, -0.1309 mN'
    """
    length, height, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    return Point(plain(length / 2), plain(-0.75 * height), plain(-5 / 6 * load))


def work_to_pull_off(
    *, radius: npt.ArrayLike, contact_modulus: npt.ArrayLike, work_of_adhesion: npt.ArrayLike
) -> Number:
    r"""Return the work [J] of the drive from zero force to the force minimum.

    The integral of P over the depth along retraction,

    .. math:: W = \left(\tfrac98\right)^{2/3} \left(\tfrac35 4^{2/3} - \tfrac25\right)
              \pi R \Delta\gamma_0 (\pi^2 \Delta\gamma_0^2 R / E^{*2})^{1/3}
              \quad \text{(Eq. 46)}

    Examples
    --------
    >>> W = work_to_pull_off(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{W * 1e12:.0f} pJ"
    '550 pJ'
    """
    _, height, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    return plain(1.125 ** (2 / 3) * (0.6 * 4 ** (2 / 3) - 0.4) * load * height)


def work_to_instability(
    *, radius: npt.ArrayLike, contact_modulus: npt.ArrayLike, work_of_adhesion: npt.ArrayLike
) -> Number:
    r"""Return the work [J] of the drive from zero force to the depth minimum.

    The integral of P over the depth along retraction,

    .. math:: W = \left[ \tfrac35 \left(\tfrac92\right)^{2/3} + \tfrac1{10} \right]
              \pi R \Delta\gamma_0 (\pi^2 \Delta\gamma_0^2 R / E^{*2})^{1/3}

    Examples
    --------
    >>> W = work_to_instability(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{W * 1e12:.0f} pJ"
    '794 pJ'
    """
    _, height, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    return plain((0.6 * 4.5 ** (2 / 3) + 0.1) * load * height)
