r"""Deviation of simpler theories from the steady crack, for one solid and one law.

The theories of Persson and Brener and of Greenwood need a length, which follows from the strength
of the law: :math:`l_0 = \lambda/(\pi \alpha^2 \bar\sigma_0^2)` (Eq. 4.23) with any alpha, :math:`l
= \pi \lambda/(4 \bar\sigma_0^2)`, :math:`\bar\sigma_0 = \sigma_0 h_0/\Delta\gamma_0`. The slow
asymptote is :math:`1 + s V`, the fast one 1/k. All are for opening cracks.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from viscotack.arrays import Array
from viscotack.model.traction.resting import check_of_gap_alone
from viscotack.theory._checks import Values, positive
from viscotack.theory.crack import greenwood, persson_brener

from .cracks import SteadyCrack

# Value of the thesis, fitted to simulations of a sphere at a Tabor number of 3.24.
THESIS_RATIO = np.pi / 9


class Comparison(NamedTuple):
    """Amplifications of an opening crack by theory, returned by :func:`compared`.

    All are dimensionless arrays of the shape of the speeds.

    Attributes
    ----------
    speed : ndarray
        Speed [E0* h0^2/(dg tau)].
    steady, error : ndarray
        Steady crack with the full law, and its relative error.
    persson_brener, greenwood, slow, fast : ndarray
        Other theories and asymptotes.
    """

    speed: Array
    steady: Array
    error: Array
    persson_brener: Array
    greenwood: Array
    slow: Array
    fast: Array

    def off(self, theory: str) -> Array:
        """Return the signed relative deviation of a theory from the steady crack."""
        return getattr(self, theory) / self.steady - 1


def compared(
    crack: SteadyCrack, speed: Values, *, strength_ratio: float = THESIS_RATIO
) -> Comparison:
    """Compare theories of an opening crack at speeds [E0* h0^2/(dg tau)].

    Parameters
    ----------
    crack : SteadyCrack
        Solid and law.
    speed : array_like
        Dimensionless speeds, positive.
    strength_ratio : float
        Alpha of the Persson-Brener length.

    Raises
    ------
    InputError
        If a speed or the ratio is not positive and finite.
    OutOfRange
        If the law depends on more than the gap.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.model.traction import LennardJones
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> found = compared(SteadyCrack(solid, LennardJones(1, 1)), 10.0)
    >>> f"Persson-Brener {found.off('persson_brener'):+.1%}"
    'Persson-Brener +6.4%'
    """
    check_of_gap_alone(crack.traction, "a comparison of theories")
    v, alpha = positive(speed=speed, strength_ratio=strength_ratio)
    law = crack.traction.reduced()
    case = {"contact_modulus": 1.0, "work_of_adhesion": 1.0, "strength": law.strength}
    tip = persson_brener.crack_tip_length(**case, strength_ratio=alpha)
    zone = greenwood.cohesive_zone_length(**case)
    solid = crack.material
    return Comparison(
        speed=v,
        steady=np.asarray(crack.amplification(v)),
        error=np.asarray(crack.error(v)),
        persson_brener=np.asarray(persson_brener.amplification(v / tip, material=solid)),
        greenwood=np.asarray(greenwood.amplification(v / zone, material=solid)),
        slow=1 + crack.slow_coefficient * v,
        fast=np.full(v.shape, crack.largest),
    )
