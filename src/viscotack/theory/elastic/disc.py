r"""A rigid disc, the flat end of a cylinder, on a half-space or a layer: Kendall, and his limit.

A disc detaches abruptly, as a crack runs in from its edge (Kendall) or, where it is small
beside the crack's own length, at the strength of the interface everywhere:

.. math:: P_K = \sqrt{8 \pi E^* a^3 \Delta\gamma_0}, \quad P_\sigma = \pi a^2 \sigma_0, \quad
          a_\times = \frac{8 E^* \Delta\gamma_0}{\pi \sigma_0^2}

being equal at the crossover radius, here of a half-space. On a layer Kendall's force follows from
the stiffness of the disc. Around it a law of traction lies below both; with Dugdale's
the march is 2.8, 0.8 and 0.2 % below Kendall at :math:`\sqrt{a \Delta\gamma_0/E^*}/h_0` of 4, 8
and 16.

Source: Kendall (1971), doi:10.1088/0022-3727/4/8/320. Depth and stiffness of the disc are in
:mod:`viscotack.theory.elastic.profiles`.
"""

from __future__ import annotations

import numpy as np

from viscotack.model.geometry import Body, HalfSpace, Sphere
from viscotack.theory._checks import Number, Values, plain, positive

from . import indenter, on_layer

_HALF_SPACE = HalfSpace()


def strength_limit(*, contact_radius: Values, strength: Values) -> Number:
    r"""Return the force [N] at which a small disc detaches everywhere, a positive number.

    Parameters
    ----------
    contact_radius, strength : array_like
        Radius of the disc a [m] and :math:`\sigma_0` [Pa]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

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

    Parameters
    ----------
    contact_modulus, work_of_adhesion, strength : array_like
        E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and :math:`\sigma_0` [Pa]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

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


def energy_release_rate(
    depth: Values, *, contact_radius: Values, contact_modulus: Values, body: Body = _HALF_SPACE
) -> Number:
    r"""Return the energy [J/m^2] that the edge of a disc releases, from its compliance.

    A disc that is pulled by :math:`\delta` has the force :math:`P = S(a)\, \delta`
    (:func:`.indenter.stiffness`), and while its contact shrinks

    .. math:: G = \frac{\delta^2 S'(a)}{4 \pi a} = -\frac{P^2}{4 \pi a} \frac{d(1/S)}{da}.

    Parameters
    ----------
    depth : array_like
        Depth [m] of either sign, from the depth without load.
    contact_radius, contact_modulus : array_like
        Radius of the disc a [m] and :math:`E^*` [Pa], positive.
    body : Body
        Elastic body, by default the half-space.

    Returns
    -------
    float or ndarray
        Energy per area of opened contact [J/m^2], not negative.

    Raises
    ------
    InputError
        If radius or modulus is not positive and finite, or the radius exceeds 100 thicknesses
        of the layer.

    Examples
    --------
    >>> from viscotack.model.geometry import Bonded, Layer
    >>> film = Layer(0.2e-3, Bonded(poisson_ratio=0.5))
    >>> disc = dict(contact_radius=1e-3, contact_modulus=1e6)
    >>> each = [energy_release_rate(-1e-6, body=body, **disc) for body in (HalfSpace(), film)]
    >>> [f"{value * 1e3:.2f} mJ/m^2" for value in each]
    ['0.16 mJ/m^2', '25.12 mJ/m^2']
    """
    on_layer.check_disc(contact_radius, body)
    E = positive(contact_modulus=contact_modulus)
    one = indenter.drawn(
        contact_radius, shape=Sphere(1.0), contact_modulus=1.0, work_of_adhesion=1.0, body=body
    )
    return plain(E * (np.asarray(depth, dtype=float) / one) ** 2)


def pull_off_force(
    *,
    contact_radius: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
    strength: Values | None = None,
    body: Body = _HALF_SPACE,
) -> Number:
    r"""Return the most that a disc can bear [N], a positive number: the smaller of both limits.

    Kendall's force is that at which the edge releases the work of adhesion
    (:func:`energy_release_rate`), :math:`P_K = S \sqrt{4 \pi a \Delta\gamma_0/S'}`. On a thin layer
    of thickness b it is :math:`\pi a^2 \sqrt{2 E^* \Delta\gamma_0/(c b)}`, and on a bonded
    incompressible one :math:`\pi a^3 \sqrt{3 E^* \Delta\gamma_0/(32\, b^3)}`.

    Parameters
    ----------
    contact_radius, contact_modulus, work_of_adhesion : array_like
        Radius of the disc a [m], :math:`E^*` [Pa], :math:`\Delta\gamma_0` [J/m^2]; positive.
    strength : array_like
        Largest tension of the interface [Pa]; left out, it is Kendall's force.
    body : Body
        Elastic body, by default the half-space.

    Raises
    ------
    InputError
        If a value is not positive and finite, or the disc is wider than 100 thicknesses of the
        layer.

    Examples
    --------
    >>> from viscotack.model.geometry import Bonded, Layer
    >>> disc = dict(contact_radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> film = Layer(0.2e-3, Bonded(poisson_ratio=0.5))
    >>> each = [pull_off_force(body=body, **disc) for body in (HalfSpace(), film)]
    >>> ", ".join(f"{force * 1e3:.0f} mN" for force in each)
    '35 mN, 141 mN'
    >>> f"{pull_off_force(**disc, body=film, strength=40e3) * 1e3:.0f} mN"
    '126 mN'
    """
    on_layer.check_disc(contact_radius, body)
    a, E, w = positive(
        contact_radius=contact_radius,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
    )
    stiffness = np.asarray(indenter.stiffness(a, contact_modulus=E, body=body))
    one = energy_release_rate(1.0, contact_radius=a, contact_modulus=E, body=body)
    kendall = stiffness * np.sqrt(w / np.asarray(one))
    if strength is None:
        return plain(kendall)
    return plain(np.minimum(kendall, strength_limit(contact_radius=a, strength=strength)))
