r"""DMT in the form of Maugis (DMT-M): Hertz plus the rigid sphere's constant attraction.

Range: small Tabor number, attraction of long range compared with the elastic deformation it causes.
For intermediate and short range use :mod:`viscotack.theory.elastic.maugis`; for rigid bodies
:mod:`viscotack.theory.elastic.bradley`.

Source: Derjaguin, Muller & Toporov (1975), doi:10.1016/0021-9797(75)90018-1; in this form
Maugis (1992), doi:10.1016/0021-9797(92)90285-T; Eq. 2.12 and 2.13.
"""

from __future__ import annotations

import numpy as np

from viscotack.theory._checks import Number, Values, at_least, plain, positive

from . import hertz


def force(
    contact_radius: Values, *, radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the force [N], positive in compression, at a contact radius [m] (Eq. 2.12).

    .. math:: P = \frac{4 E^* a^3}{3 R} - 2 \pi R \Delta\gamma_0

    Parameters
    ----------
    contact_radius : array_like
        a [m], not negative.
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> P = force(1e-6, radius=1e-5, contact_modulus=1e9, work_of_adhesion=0.05)
    >>> f"{P * 1e6:.1f} uN"
    '130.2 uN'
    """
    attraction = pull_off_force(radius=radius, work_of_adhesion=work_of_adhesion)
    return hertz.force(contact_radius, radius=radius, contact_modulus=contact_modulus) - attraction


def depth(contact_radius: Values, *, radius: Values) -> Number:
    r"""Return the depth [m] at a contact radius [m], :math:`a^2/R` as for Hertz (Eq. 2.13).

    Parameters
    ----------
    contact_radius : array_like
        a [m], not negative.
    radius : array_like
        R of the sphere [m], positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> f"{depth(1e-6, radius=1e-5) * 1e9:.0f} nm"
    '100 nm'
    """
    return hertz.depth(contact_radius, radius=radius)


def contact_radius_at_depth(depth: Values, *, radius: Values) -> Number:
    r"""Return the contact radius [m] at a depth [m], :math:`\sqrt{R\delta}`.

    Parameters
    ----------
    depth : array_like
        Depth [m], not negative.
    radius : array_like
        R of the sphere [m], positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> f"{contact_radius_at_depth(1e-7, radius=1e-5) * 1e6:.1f} um"
    '1.0 um'
    """
    return hertz.contact_radius_at_depth(depth, radius=radius)


def contact_radius_at_force(
    force: Values, *, radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the contact radius [m] under a force [N].

    .. math:: a = \left[ \frac{3 R}{4 E^*} (P + 2 \pi R \Delta\gamma_0) \right]^{1/3}

    Parameters
    ----------
    force : array_like
        Force [N], compression positive, not below minus :func:`pull_off_force`.
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> a = contact_radius_at_force(0.0, radius=1e-5, contact_modulus=1e9, work_of_adhesion=0.05)
    >>> f"{a * 1e9:.0f} nm"
    '287 nm'
    """
    attraction = pull_off_force(radius=radius, work_of_adhesion=work_of_adhesion)
    P = at_least(-np.asarray(attraction), "the contact opens at -2 pi R w", force=force)
    load = P + attraction
    return hertz.contact_radius_at_force(load, radius=radius, contact_modulus=contact_modulus)


def pull_off_force(*, radius: Values, work_of_adhesion: Values) -> Number:
    r"""Return the pull-off force [N], the positive number :math:`2 \pi R \Delta\gamma_0`.

    It is reached at zero contact radius and zero depth.

    Parameters
    ----------
    radius, work_of_adhesion : array_like
        R of the sphere [m] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> f"{pull_off_force(radius=1e-5, work_of_adhesion=0.05) * 1e6:.2f} uN"
    '3.14 uN'
    """
    R, w = positive(radius=radius, work_of_adhesion=work_of_adhesion)
    return plain(2 * np.pi * R * w)


def work_to_pull_off(
    *, radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the work [J] from zero force to pull-off.

    .. math:: W = \tfrac65 \left(\tfrac32\right)^{2/3} \pi R \Delta\gamma_0
              \left( \frac{\pi^2 \Delta\gamma_0^2 R}{E^{*2}} \right)^{1/3}

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> W = work_to_pull_off(radius=1e-5, contact_modulus=1e9, work_of_adhesion=0.05)
    >>> f"{W * 1e15:.1f} fJ"
    '15.5 fJ'
    """
    R, E, w = positive(
        radius=radius, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    return plain(1.2 * 1.5 ** (2 / 3) * np.pi * R * w * np.cbrt((np.pi * w / E) ** 2 * R))
