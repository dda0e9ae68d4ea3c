r"""Empirical laws of adhesion: Gent-Schultz, WLF shift.

They describe a material in a measured range of speed and temperature and must not be extrapolated.
Speeds are those of the crack [m/s].

Source: Maghami, PhD thesis (2025), Eq. 2.19, 4.25 and 4.28, published as
doi:10.1016/j.jmps.2024.105844; Gent & Schultz (1972), J. Adhesion 3, 281 (no DOI known to this
package); Williams, Landel & Ferry (1955), doi:10.1021/ja01619a008.
"""

from __future__ import annotations

import numpy as np

from viscotack.errors import InputError
from viscotack.model.materials.shift import UNIVERSAL, wlf_decades
from viscotack.theory._checks import Number, Values, at_least, plain, positive

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


def wlf_shift(temperature: Values, *, glass_transition: Values) -> Number:
    r"""Return the factor of times a_T at a temperature [K] over that at the glass transition [K].

    .. math:: \log_{10} a_T = \frac{-17.44 (T - T_g)}{51.6 + T - T_g} \quad \text{(Eq. 4.25)}

    The law has a pole 51.6 K below the glass transition. The constants are averages from the
    transition to about 100 K above it; below it a glass need not follow them. The shift between two
    temperatures is a quotient.

    Parameters
    ----------
    temperature : array_like
        T [K], at most 48.6 K below `glass_transition`.
    glass_transition : array_like
        Tg [K], positive.

    Raises
    ------
    InputError
        If a temperature is not positive and finite, or more than 48.6 K below the transition.

    Examples
    --------
    >>> f"{wlf_shift(293.15, glass_transition=158.15):.2e}"
    '2.41e-13'
    """
    T, Tg = positive(temperature=temperature, glass_transition=glass_transition)
    x = T - Tg
    if np.any(x < -48.6):  # a_T overflows 2.8 K above the pole
        raise InputError(
            "the WLF shift has its pole 51.6 K below the glass transition and no value there or "
            f"below, got {np.min(x):.4g} K from it"
        )
    return plain(10 ** wlf_decades(x, *UNIVERSAL))
