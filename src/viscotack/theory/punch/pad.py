r"""The pad, layer, punch and interface, and closed forms of its detachment if it is elastic.

A rigid punch of half width a is pulled off a layer of thickness b on a rigid base, in plane strain.
A very thin layer detaches simultaneously over the whole area at the strength of the interface
(cohesive), a thin one when the energy stored over its thickness equals the work of adhesion, a
thick one like a half-plane, by cracks from the edges:

.. math:: \bar\sigma_{po} = \sigma_0 \;(b < b_0), \quad
          \sqrt{\frac{2 \zeta E^* \Delta\gamma_0}{b}} \;(b_0 \le b \le b_1), \quad
          \sqrt{\frac{\pi E^* \Delta\gamma_0}{2 a}} \;(b > b_1).

A :class:`Pad` has the half width a, the contact modulus E*, the work of
adhesion :math:`\Delta\gamma_0`, the strength :math:`\sigma_0` and the base: ``Frictionless()``,
with zeta = 1, or ``Bonded(poisson_ratio=...)``, with :math:`\zeta = (1 - \nu)^2/(1 - 2\nu)`. The
thickness b is a separate argument, because the theories vary or solve for it; so is the
viscoelastic solid, which matters only at the edges, as a
:class:`viscotack.theory.crack.law.CrackLaw`. Stress is the mean over the punch, tension positive;
the depth of a punch in tension is negative. For a viscoelastic layer the rubbery modulus applies in
the slowest retraction and the glassy one in the fastest (:func:`limits`).

Range: the formulas are branches of a smooth curve. Where they meet, at b1, the exact stress is
23.5 % higher (frictionless); :mod:`viscotack.theory.punch.crossover` computes it for every b/a.
The thin-layer law of a bonded layer holds for nu up to 0.45 (appendix I), and there only for very
thin ones: it is too high by a fraction 0.55 b/a at 0.45, by 2.7 b/a at 0.49. It warns above 0.45.

Source: Maghami, PhD thesis (2025), Eq. 3.1 to 3.16 and appendix I; Maghami, Tricarico, Ciavarella &
Papangelo (2024), Engineering Fracture Mechanics 298, 109898.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from viscotack.errors import InputError
from viscotack.model.geometry import Base, Bonded
from viscotack.theory._checks import Number, Values, plain, positive, ratio
from viscotack.theory.crack import CrackLaw
from viscotack.theory.crack.law import Material
from viscotack.theory.punch import crossover


@dataclass(frozen=True, kw_only=True)
class Pad:
    r"""A layer under a rigid flat punch, plane strain, of any thickness.

    Parameters
    ----------
    half_width : float
        Half width a of the punch [m].
    contact_modulus : float
        E* = E/(1 - nu^2) of the layer [Pa].
    work_of_adhesion : float
        :math:`\Delta\gamma_0` [J/m^2].
    strength : float
        Strength of the interface :math:`\sigma_0` [Pa].
    base : Frictionless or Bonded
        Boundary condition of the layer on its base.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> f"a0 = {pad.fracture_length * 1e6:.1f} um, {pad.elastic_stress(1e-4) / 1e3:.1f} kPa"
    'a0 = 31.4 um, 32.2 kPa'
    """

    half_width: float
    contact_modulus: float
    work_of_adhesion: float
    strength: float
    base: Base

    def __post_init__(self) -> None:
        for name in ("half_width", "contact_modulus", "work_of_adhesion", "strength"):
            object.__setattr__(self, name, float(positive(**{name: getattr(self, name)})))
        if not isinstance(self.base, Base):
            raise InputError(
                f"base must be Frictionless() or Bonded(poisson_ratio=...), got {self.base!r}"
            )

    @property
    def fracture_length(self) -> float:
        """Return a0 [m], :func:`fracture_length`."""
        return float(
            fracture_length(
                contact_modulus=self.contact_modulus,
                work_of_adhesion=self.work_of_adhesion,
                strength=self.strength,
            )
        )

    def elastic_stress(self, thickness: Values) -> Number:
        """Return the exact mean pull-off stress [Pa] at thicknesses [m], without strength limit."""
        return crossover.pull_off_stress(thickness, **self._elastic())

    def elastic_depth(self, thickness: Values) -> Number:
        """Return the exact depth of pull-off [m] at thicknesses [m], negative."""
        return crossover.depth_at_pull_off(thickness, **self._elastic())

    def elastic_thickness(self, stress: Values) -> Number:
        """Return the thickness [m] of the exact elastic layer with a given pull-off stress [Pa]."""
        return crossover.thickness(stress, **self._elastic())

    def crack_law(self, theory: str, *, material: Material) -> CrackLaw:
        """Return the crack law of the edges of this pad, with its rubbery ``contact_modulus``.

        Its length is the cohesive zone of :mod:`viscotack.theory.crack.greenwood`, a0/2, or a0 for
        "persson-brener" (appendix II of the thesis).
        """
        length = self.fracture_length / (2 if theory == "greenwood" else 1)
        return CrackLaw(theory=theory, material=material, tip_length=length)

    def _elastic(self) -> dict[str, Any]:
        return {
            "half_width": self.half_width,
            "contact_modulus": self.contact_modulus,
            "work_of_adhesion": self.work_of_adhesion,
            "base": self.base,
        }


# Largest Poisson ratio of the thin-layer law of a bonded layer (appendix I).
_THIN_POISSON = 0.45


def fracture_length(
    *, contact_modulus: Values, work_of_adhesion: Values, strength: Values
) -> Number:
    r"""Return the half width a0 [m] below which a punch on a half-plane detaches at the strength.

    .. math:: a_0 = \frac{\pi E^* \Delta\gamma_0}{2 \sigma_0^2} \quad \text{(Eq. 3.3)}

    Twice :func:`viscotack.theory.crack.greenwood.cohesive_zone_length`.

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
    >>> a0 = fracture_length(contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4)
    >>> f"{a0 * 1e6:.1f} um"
    '31.4 um'
    """
    E, w, s = positive(
        contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion, strength=strength
    )
    return plain(np.pi * E * w / (2 * s**2))


def half_plane_pull_off_stress(
    half_width: Values, *, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the mean pull-off stress [Pa] of a punch on a half-plane.

    .. math:: \bar\sigma_{po} = \sqrt{\frac{\pi E^* \Delta\gamma_0}{2 a}} \quad \text{(Eq. 3.2)}

    Range: a well above :func:`fracture_length`. Times 2a it is the force per length, Eq. 3.1.

    Parameters
    ----------
    half_width : array_like
        a [m], positive.
    contact_modulus, work_of_adhesion : array_like
        E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> s = half_plane_pull_off_stress(1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{s / 1e3:.2f} kPa"
    '8.86 kPa'
    """
    a, E, w = positive(
        half_width=half_width, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    return plain(np.sqrt(np.pi * E * w / (2 * a)))


def thin_layer_pull_off_stress(
    thickness: Values, *, contact_modulus: Values, work_of_adhesion: Values, base: Base
) -> Number:
    r"""Return the mean pull-off stress [Pa] of a wide punch on a thin layer.

    .. math:: \bar\sigma_{po} = \sqrt{\frac{2 \zeta E^* \Delta\gamma_0}{b}}
              \quad \text{(Eq. 3.9, appendix I)}

    Range: b0 < b << a; too low by a fraction 0.177 b/a on a frictionless base. A bonded layer with
    a Poisson ratio above 0.45 causes a ``UserWarning``.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    contact_modulus, work_of_adhesion : array_like
        E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is below
        0.5.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> layer = dict(contact_modulus=1e6, work_of_adhesion=0.05)
    >>> free = thin_layer_pull_off_stress(1e-4, **layer, base=Frictionless())
    >>> glued = thin_layer_pull_off_stress(1e-4, **layer, base=Bonded(poisson_ratio=0.4))
    >>> f"{free / 1e3:.1f} kPa, glued {glued / 1e3:.1f} kPa"
    '31.6 kPa, glued 42.4 kPa'
    """
    b, E, w = positive(
        thickness=thickness, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    return plain(np.sqrt(2 * stiffening(base) * E * w / b))


def thin_layer_depth_at_pull_off(
    thickness: Values, *, contact_modulus: Values, work_of_adhesion: Values, base: Base
) -> Number:
    r"""Return the depth at pull-off [m] of a wide punch on a thin layer, negative.

    .. math:: \delta_{po} = -\sqrt{\frac{2 b \Delta\gamma_0}{\zeta E^*}} \quad \text{(Eq. 3.9)}

    Exact up to terms of the order exp(-2 pi a/b) on a frictionless base. Otherwise as
    :func:`thin_layer_pull_off_stress`.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    contact_modulus, work_of_adhesion : array_like
        E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is below
        0.5.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> layer = dict(contact_modulus=1e6, work_of_adhesion=0.05, base=Frictionless())
    >>> f"{thin_layer_depth_at_pull_off(1e-4, **layer) * 1e6:.2f} um"
    '-3.16 um'
    """
    b, E, w = positive(
        thickness=thickness, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    return plain(-np.sqrt(2 * b * w / (stiffening(base) * E)))


def stiffening(base: Base) -> float:
    r"""Return zeta, the ratio of a thin layer's stiffness to that on a frictionless base.

    .. math:: \zeta = \frac{(1 - \nu)^2}{1 - 2 \nu} \quad \text{(bonded, appendix I)}

    Issues a ``UserWarning`` for a Poisson ratio above 0.45, where only extremely thin
    layers obey the thin-layer law.

    Parameters
    ----------
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is below
        0.5.

    Raises
    ------
    InputError
        If a bonded layer has a Poisson ratio of 0.5, for which the thin-layer law does not exist.

    Examples
    --------
    >>> f"{stiffening(Bonded(poisson_ratio=0.3)):.3f}"
    '1.225'
    """
    if base.foundation == 0:
        raise InputError(
            "the thin-layer law does not apply to a bonded layer with a Poisson ratio of 0.5, "
            "which stretches only by sideways flow"
        )
    if isinstance(base, Bonded) and base.poisson_ratio > _THIN_POISSON:
        warnings.warn(
            "the thin-layer law of a bonded layer needs a Poisson ratio of at most "
            f"{_THIN_POISSON}, got {base.poisson_ratio}: use theory.punch.crossover",
            UserWarning,
            stacklevel=3,
        )
    return 1 / base.foundation


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
