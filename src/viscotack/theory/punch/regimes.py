r"""Flat punch on an elastic layer in plane strain: closed forms of the three regimes.

A rigid punch of half width a is pulled off a layer of thickness b on a rigid base. A very thin
layer detaches simultaneously over the whole area at the strength of the interface (cohesive), a
thin one when the energy stored over its thickness equals the work of adhesion, a thick one like a
half-plane, by cracks from the edges:

.. math:: \bar\sigma_{po} = \sigma_0 \;(b < b_0), \quad
          \sqrt{\frac{2 \zeta E^* \Delta\gamma_0}{b}} \;(b_0 \le b \le b_1), \quad
          \sqrt{\frac{\pi E^* \Delta\gamma_0}{2 a}} \;(b > b_1).

A :class:`viscotack.theory.punch.pad.Pad` has the half width a, the contact modulus E*, the work of
adhesion :math:`\Delta\gamma_0`, the strength :math:`\sigma_0` and the base: ``Frictionless()``,
with zeta = 1, or ``Bonded(poisson_ratio=...)``, with :math:`\zeta = (1 - \nu)^2/(1 - 2\nu)`. Stress
is the mean over the punch, tension positive. For a viscoelastic layer the rubbery modulus applies
in the slowest retraction and the glassy one in the fastest (:func:`limits`).

Range: the formulas are branches of a smooth curve. Where they meet, at b1, the exact stress is
23.5 % higher (frictionless); :mod:`viscotack.theory.punch.crossover` computes it for every b/a.
The thin-layer law of a bonded layer holds for nu up to 0.45 (appendix I), and there only for very
thin ones: it is too high by a fraction 0.55 b/a at 0.45, by 2.7 b/a at 0.49. It warns above 0.45.

Source: Maghami, PhD thesis (2025), Eq. 3.1 to 3.16 and appendix I; Maghami, Tricarico, Ciavarella &
Papangelo (2024), Engineering Fracture Mechanics 298, 109898.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from viscotack.theory._checks import Number, Values, plain, positive, ratio

from .laws import half_plane_pull_off_stress, stiffening, thin_layer_pull_off_stress
from .pad import Pad

REGIMES = ("cohesive", "thin layer", "half-plane")


class Thicknesses(NamedTuple):
    """Thicknesses [m] at which the regimes meet.

    b0 slow (``cohesive``), b0 fast (``cohesive_fast``) and b1 (``half_plane``), returned by
    :func:`regime_thicknesses`.
    """

    cohesive: Number
    cohesive_fast: Number
    half_plane: Number


class Limits(NamedTuple):
    """Mean pull-off stress [Pa] of the slowest (``slow``) and the fastest (``fast``) retraction.

    Returned by :func:`limits`.
    """

    slow: Number
    fast: Number


def regime_thicknesses(pad: Pad, *, modulus_ratio: Values) -> Thicknesses:
    r"""Return the thicknesses [m] at which the regimes meet.

    .. math:: b_0 = \frac{2 \zeta E_0^* \Delta\gamma_0}{\sigma_0^2} = \frac4\pi \zeta a_0, \quad
              b_{0\infty} = \frac{b_0}{k}, \quad b_1 = \frac4\pi \zeta a

    (Eq. 3.10, 3.16, 3.11, appendix I), with the rubbery contact modulus. If b0 exceeds b1, that is
    for a < a0 (b0 fast: for a < a0/k), the punch detaches at its strength at every thickness, and
    the half-plane regime does not exist.

    Parameters
    ----------
    pad : Pad
        Punch, layer and interface; the Poisson ratio of a bonded layer is below 0.5.
    modulus_ratio : array_like
        Rubbery over glassy modulus k, above 0 and at most 1.

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
    >>> b0, fast, b1 = regime_thicknesses(pad, modulus_ratio=0.1)
    >>> f"{b0 * 1e6:.0f} um, {fast * 1e6:.0f} um, {b1 * 1e6:.0f} um"
    '40 um, 400 um, 1273 um'
    """
    a, a0, k = pad.half_width, pad.fracture_length, ratio(modulus_ratio)
    unit = 4 / np.pi * stiffening(pad.base)
    return Thicknesses(plain(unit * a0), plain(unit * a0 / k), plain(unit * a))


def pull_off_stress(thickness: Values, pad: Pad) -> Number:
    """Return the mean pull-off stress [Pa] by the regime of the layer (Eq. 3.12).

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
    >>> stress = pull_off_stress([1e-5, 1e-4, 1e-2], pad)
    >>> [f"{s / 1e3:.1f} kPa" for s in stress]
    ['50.0 kPa', '31.6 kPa', '8.9 kPa']
    """
    return _envelope(thickness, pad.contact_modulus, pad)


def limits(thickness: Values, pad: Pad, *, modulus_ratio: Values) -> Limits:
    """Return the pull-off stress [Pa] of the slowest and the fastest retraction (Eq. 3.6, 3.15).

    They follow from the rubbery contact modulus of the pad, and from that over k. The strength
    limits both.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    pad : Pad
        Punch, layer and interface; the Poisson ratio of a bonded layer is below 0.5.
    modulus_ratio : array_like
        Rubbery over glassy modulus k, above 0 and at most 1.

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
    >>> slow, fast = limits(1e-3, pad, modulus_ratio=0.1)
    >>> f"{slow / 1e3:.1f} to {fast / 1e3:.1f} kPa"
    '10.0 to 31.6 kPa'
    """
    E, k = pad.contact_modulus, ratio(modulus_ratio)
    return Limits(_envelope(thickness, E, pad), _envelope(thickness, E / k, pad))


def regime(thickness: Values, pad: Pad) -> Any:
    """Return the regime of an elastic layer, one of ``REGIMES``: a word, or an array of words.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    pad : Pad
        Punch, layer and interface; the Poisson ratio of a bonded layer is below 0.5.

    Returns
    -------
    str or ndarray of str
        "cohesive", "thin layer" or "half-plane".

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
    >>> str(regime(1e-4, pad))
    'thin layer'
    """
    b = positive(thickness=thickness)
    b0, _, b1 = regime_thicknesses(pad, modulus_ratio=1.0)
    cohesive = (b < b0) | np.greater(b0, b1)
    return np.array(REGIMES)[np.where(cohesive, 0, np.where(b <= b1, 1, 2))]


def _envelope(thickness: Values, contact_modulus: Values, pad: Pad) -> Number:
    """Return the pull-off stress of a pad with another contact modulus."""
    case: dict[str, Any] = dict(
        contact_modulus=contact_modulus, work_of_adhesion=pad.work_of_adhesion
    )
    thick = half_plane_pull_off_stress(pad.half_width, **case)
    thin = thin_layer_pull_off_stress(thickness, **case, base=pad.base)
    return plain(np.minimum(pad.strength, np.maximum(thin, thick)))
