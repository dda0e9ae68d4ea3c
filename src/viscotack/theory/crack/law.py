r"""Crack laws in SI: energy per area of a crack by its speed, of a theory and solid or empirical.

:mod:`viscotack.theory.crack.greenwood` and :mod:`viscotack.theory.crack.persson_brener` use
dimensionless speeds, :math:`\hat v = v \tau_0/l`. A :class:`CrackLaw` combines one of them with a
solid and a length l, as input for the theories of spheres and punches.
Range and source are those of the theory.

**Empirical law of adhesion, of Gent and Schultz.** It describes an interface in a measured range of
speed and must not be extrapolated. Speeds are those of the crack [m/s].

Source: Maghami, PhD thesis (2025), Eq. 2.19 and 4.28, published as
doi:10.1016/j.jmps.2024.105844; Gent & Schultz (1972), J. Adhesion 3, 281 (no DOI known to this
package).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.model.materials import Modes
from viscotack.theory._checks import Number, Values, at_least, plain, positive, ratio
from viscotack.theory.crack import greenwood, persson_brener
from viscotack.theory.crack._crack import Material, Passage

THEORIES = {"greenwood": greenwood, "persson-brener": persson_brener}


@dataclass(frozen=True, kw_only=True)
class CrackLaw:
    """Effective surface energy of a moving crack: a theory, a solid and a length.

    Parameters
    ----------
    theory : str
        "greenwood" or "persson-brener".
    material : viscoelastic material of :mod:`viscotack.model.materials`
        Only its normalised creep is used, not its rubbery modulus.
    tip_length : float
        Length l of the tip of the slow crack [m], as defined by the theory:
        :func:`viscotack.theory.crack.greenwood.cohesive_zone_length` or
        :func:`viscotack.theory.crack.persson_brener.crack_tip_length`, which differ. For the edges
        of a pad use :meth:`viscotack.theory.punch.pad.Pad.crack_law`.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> law = CrackLaw(theory="persson-brener", material=solid, tip_length=1e-6)
    >>> f"{law.amplification(1e-3):.3f} at 1 mm/s, at most {law.largest:g}"
    '2.543 at 1 mm/s, at most 10'
    >>> f"{law.speed(2.0) * 1e6:.0f} um/s"
    '512 um/s'
    """

    theory: str
    material: Material
    tip_length: float

    def __post_init__(self) -> None:
        if self.theory not in THEORIES:
            raise InputError(f"theory must be {' or '.join(THEORIES)}, got {self.theory!r}")
        object.__setattr__(self, "tip_length", float(positive(tip_length=self.tip_length)))

    @property
    def largest(self) -> float:
        """Return the amplification at infinite speed, glassy over rubbery modulus."""
        return 1 / self.material.modulus_ratio

    @property
    def speed_unit(self) -> float:
        """Return the speed [m/s] of a dimensionless speed of 1, l over the solid's time unit."""
        return self.tip_length / self.material.time_unit

    def amplification(self, speed: Values) -> Number:
        """Return effective over rubbery surface energy at speeds [m/s], not negative."""
        v = np.asarray(speed, dtype=float) / self.speed_unit
        return THEORIES[self.theory].amplification(v, material=self.material)

    def speed(self, amplification: Values) -> Number:
        """Return the speed [m/s] of an amplification, at least 1 and below ``largest``."""
        v = THEORIES[self.theory].speed(amplification, material=self.material)
        return plain(np.asarray(v) * self.speed_unit)

    def passage(self, log_time: Values) -> Passage:
        r"""Return the cracks with given passage times of the tip, explicitly, from ln of the times.

        A passage time is the time for a tip of length :math:`\Gamma l` to pass, in time units of
        the solid; the returned logarithms of speeds are dimensionless.
        solid; the speeds, logarithms too, are dimensionless.
        """
        return THEORIES[self.theory].passage(log_time, material=self.material)

    def amplification_of_passage(self, low: float, high: float) -> Callable[[Any], Any]:
        """Return the amplification as a function of ln of the passage time, in an interval.

        It avoids the inversion if both speed and amplification are unknown.
        """
        return THEORIES[self.theory].amplification_of_passage(low, high, material=self.material)

    def reduced(self) -> CrackLaw:
        """Return the same law with dimensionless speeds."""
        return replace(self, tip_length=self.material.time_unit)

    def limited(self, *, modulus_ratio: float) -> CrackLaw:
        r"""Return the law with amplifications limited to 1/``modulus_ratio``, :math:`1/k_b`.

        .. math:: \frac1\Gamma = k_b + \frac{1 - k_b}{1 - k}
                  \left( \frac{1}{\Gamma_\infty} - k \right)

        at the same passage time: the delayed part of the creep is reduced in proportion. The law is
        unchanged if its own limit is lower, :math:`k_b \le k`.
        """
        k = float(ratio(modulus_ratio))
        if k <= self.material.modulus_ratio:
            return self
        return replace(self, material=_Limited(self.material, k))


@dataclass(frozen=True)
class _Limited:
    """Effective solid of a crack that can use only part of its creep."""

    material: Material
    modulus_ratio: float

    @property
    def time_unit(self) -> float:
        return self.material.time_unit

    def retardation_modes(self, *, shortest: float, longest: float, tolerance: float) -> Modes:
        modes = self.material.retardation_modes(
            shortest=shortest, longest=longest, tolerance=tolerance
        )
        k = self.material.modulus_ratio
        part = (1 - self.modulus_ratio) / (1 - k)
        return Modes(
            instantaneous=self.modulus_ratio + part * max(modes.instantaneous - k, 0.0),
            weights=tuple(part * w for w in modes.weights),
            times=modes.times,
            error=part * modes.error,
        )


_OPENS = "a crack that closes is another problem"


def gent_schultz(speed: Values, *, reference_speed: Values, exponent: Values) -> Number:
    r"""Return effective over intrinsic surface energy at a crack speed [m/s] (Eq. 2.19, 4.28).

    .. math:: \frac{\Delta\gamma_{eff}}{\Delta\gamma_0} = 1 + \left( \frac{v}{v_0} \right)^\xi

    Parameters
    ----------
    speed : array_like
        Crack speed v [m/s], not negative.
    reference_speed, exponent : array_like
        :math:`v_0` [m/s] and :math:`\xi`; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    The silicone of the thesis, at 100 um/s:

    >>> f"{gent_schultz(1e-4, reference_speed=213.5e-6, exponent=0.4154):.3f}"
    '1.730'
    """
    v0, xi = positive(reference_speed=reference_speed, exponent=exponent)
    v = at_least(0, _OPENS, speed=speed)
    return plain(1 + (v / v0) ** xi)
