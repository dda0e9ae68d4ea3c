r"""Adhesion of vanishing range for any profile: flat punch, cone, power law, and general rule.

Integrals of the slope of a profile, by Gauss-Legendre nodes in the angle (Sneddon).

For every shape, adhesion adds the displacement of a flat punch with the stress intensity of the
work of adhesion:

.. math:: \delta = \delta_1(a) - \sqrt{\frac{2 \pi a \Delta\gamma_0}{E^*}}, \quad
          P = P_1(a) - \sqrt{8 \pi E^* a^3 \Delta\gamma_0}

with the adhesionless depth and force at the same contact radius a (Eq. 2.10 and 2.11). Range: large
Tabor number, rigid indenter, elastic half-space, small slopes. A profile is :math:`z = A r^q`:
q = 1 is a cone of slope A, q = 2 with A = 1/2R the sphere of
:mod:`viscotack.theory.elastic.jkr`.

Source: Sneddon (1965), doi:10.1016/0020-7225(65)90019-4, without adhesion; Maghami, PhD thesis
(2025), Eq. 2.10 and 2.11; the flat punch of Kendall (1971), doi:10.1088/0022-3727/4/8/320.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.geometry import Shape, detail
from viscotack.model.geometry.panels import gauss
from viscotack.theory._checks import Number, Values, at_least, plain, positive
from viscotack.theory.elastic.jkr import Point

_LENGTH = "a contact radius is a length"


def punch_pull_off(
    *, contact_radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Point:
    r"""Return the pull-off of a flat punch, over its whole area, for load and depth control.

    .. math:: P = -\sqrt{8 \pi E^* a^3 \Delta\gamma_0}, \quad
              \delta = -\sqrt{2 \pi a \Delta\gamma_0 / E^*}

    Range: :math:`E^* \Delta\gamma_0/\sigma_0^2` is small compared with a; a smaller punch
    detaches uniformly, at the strength.

    Parameters
    ----------
    contact_radius, contact_modulus, work_of_adhesion : array_like
        Radius of the punch a [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> end = punch_pull_off(contact_radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{end.force * 1e3:.1f} mN at {end.depth * 1e6:.1f} um"
    '-35.4 mN at -17.7 um'
    """
    a, E, w = positive(
        contact_radius=contact_radius,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
    )
    lift = np.sqrt(2 * np.pi * a * w / E)
    return Point(plain(a + 0 * lift), plain(-lift), plain(-2 * E * a * lift))


def depth(
    contact_radius: Values,
    *,
    exponent: Values,
    coefficient: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
) -> Number:
    r"""Return the depth [m] of a profile at a contact radius [m].

    .. math:: \delta = A \kappa a^q - \sqrt{2 \pi a \Delta\gamma_0/E^*}, \quad
              \kappa = \sqrt\pi \, \Gamma(1 + q/2) / \Gamma(1/2 + q/2)

    Parameters
    ----------
    contact_radius : array_like
        a [m], not negative.
    exponent, coefficient : array_like
        q and A [m^(1-q)] of the profile; positive.
    contact_modulus, work_of_adhesion : array_like
        E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> cone = dict(exponent=1.0, coefficient=0.1, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{depth(1e-4, **cone) * 1e6:.2f} um"
    '10.10 um'
    """
    q, C, E, w = _checked(exponent, coefficient, contact_modulus, work_of_adhesion)
    a = at_least(0, _LENGTH, contact_radius=contact_radius)
    return plain(C * a**q - np.sqrt(2 * np.pi * a * w / E))


def force(
    contact_radius: Values,
    *,
    exponent: Values,
    coefficient: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
) -> Number:
    r"""Return the force [N] of a profile at a contact radius [m], positive in compression.

    .. math:: P = \frac{2 q}{q + 1} E^* A \kappa a^{q + 1} - \sqrt{8 \pi E^* a^3 \Delta\gamma_0}

    with :math:`\kappa` of :func:`depth`.

    Parameters
    ----------
    contact_radius : array_like
        a [m], not negative.
    exponent, coefficient : array_like
        q and A [m^(1-q)] of the profile; positive.
    contact_modulus, work_of_adhesion : array_like
        E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> cone = dict(exponent=1.0, coefficient=0.1, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{force(1e-4, **cone) * 1e3:.3f} mN"
    '0.450 mN'
    """
    q, C, E, w = _checked(exponent, coefficient, contact_modulus, work_of_adhesion)
    a = at_least(0, _LENGTH, contact_radius=contact_radius)
    return plain(2 * q / (q + 1) * E * C * a ** (q + 1) - np.sqrt(8 * np.pi * E * a**3 * w))


def pull_off(
    *, exponent: Values, coefficient: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Point:
    r"""Return the force minimum of a profile, where a dead load detaches.

    .. math:: a^{q - 1/2} = \frac{3}{2 q A \kappa} \sqrt{2 \pi \Delta\gamma_0/E^*}, \quad
              P = -\frac{q - 1/2}{q + 1} \sqrt{8 \pi E^* a^3 \Delta\gamma_0}

    The force is independent of the modulus only for q = 2. A tip with q up to 1/2 has
    no force minimum.

    Parameters
    ----------
    exponent, coefficient : array_like
        q, above 1/2, and A [m^(1-q)], positive, of the profile.
    contact_modulus, work_of_adhesion : array_like
        E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Returns
    -------
    Point
        Contact radius [m], depth [m] and force [N].

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> cone = dict(exponent=1.0, coefficient=0.1, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> end = pull_off(**cone)
    >>> f"{end.force * 1e6:.1f} uN at {end.contact_radius * 1e6:.1f} um"
    '-43.0 uN at 28.6 um'
    """
    return _end(exponent, coefficient, contact_modulus, work_of_adhesion, 1.5)


def instability(
    *, exponent: Values, coefficient: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Point:
    r"""Return the depth minimum of a profile, where a rigid drive detaches.

    :math:`a^{q - 1/2}` is a third of that of :func:`pull_off`.

    Parameters
    ----------
    exponent, coefficient : array_like
        q, above 1/2, and A [m^(1-q)], positive, of the profile.
    contact_modulus, work_of_adhesion : array_like
        E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Returns
    -------
    Point
        Contact radius [m], depth [m] and force [N].

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> cone = dict(exponent=1.0, coefficient=0.1, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{instability(**cone).depth * 1e6:.2f} um"
    '-0.50 um'
    """
    return _end(exponent, coefficient, contact_modulus, work_of_adhesion, 0.5)


def _checked(exponent: Any, coefficient: Any, contact_modulus: Any, work: Any) -> Any:
    """Return q, A kappa, E* and w."""
    q, A, E, w = positive(
        exponent=exponent,
        coefficient=coefficient,
        contact_modulus=contact_modulus,
        work_of_adhesion=work,
    )
    return (
        q,
        A
        * np.sqrt(np.pi)
        * np.exp(scipy.special.gammaln(1 + q / 2) - scipy.special.gammaln(0.5 + q / 2)),
        E,
        w,
    )


def _end(exponent: Any, coefficient: Any, contact_modulus: Any, work: Any, factor: float) -> Point:
    q, C, E, w = _checked(exponent, coefficient, contact_modulus, work)
    if np.any(q <= 0.5):
        raise InputError(
            f"exponent must be above 1/2, got {np.min(q)}; the force of a flatter tip has no "
            "minimum, see punch_pull_off"
        )
    lift = np.sqrt(2 * np.pi * w / E)
    a = (factor * lift / (q * C)) ** (1 / (q - 0.5))
    # from the stationarity, without the difference of two large terms
    d = np.sqrt(a) * lift * (factor / q - 1)
    P = 2 * E * a**1.5 * lift * (factor / (q + 1) - 1)
    return Point(plain(a), plain(d), plain(P))


# Exact to round-off for smooth profiles.
_NODES = 64
# Details of a profile per Gauss panel, and largest number of panels.
_DETAILS, _MOST_PANELS = 1.0, 64
# Slopes that are looked up at a time.
_AT_ONCE = 1_000_000


def mean_slope(shape: Shape, a: npt.NDArray, power: int) -> npt.NDArray:
    """Return the integral of the slope over the angle, with a power of its sine."""
    angle, weight = angles(shape, float(np.max(a, initial=0.0)))
    sine = np.sin(angle)
    weight = weight * sine**power
    radii = np.ravel(a)
    parts = np.array_split(radii, -(-radii.size * sine.size // _AT_ONCE) or 1)
    means = [np.asarray(shape.flank(np.multiply.outer(part, sine))) @ weight for part in parts]
    return np.reshape(np.concatenate(means), np.shape(a))


def half_space_depth(a: npt.NDArray, shape: Shape) -> npt.NDArray:
    """Return the depth [m] of a contact of this radius [m] on a half-space without adhesion."""
    return a * mean_slope(shape, a, 0)


def angles(shape: Shape, radius: float) -> tuple[Array, Array]:
    """Return angles and weights for a contact of this radius at most."""
    panels = np.ceil(radius / (_DETAILS * detail(shape)))
    return _rule(int(np.clip(panels, 1, _MOST_PANELS)))


@lru_cache(maxsize=_MOST_PANELS)
def _rule(panels: int) -> tuple[Array, Array]:
    """Return the nodes and the weights of `panels` equal panels from 0 to pi/2."""
    return gauss(np.linspace(0.0, np.pi / 2, panels + 1), _NODES)
