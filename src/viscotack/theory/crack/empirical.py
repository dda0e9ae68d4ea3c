r"""Empirical law of adhesion, of Gent and Schultz.

It describes an interface in a measured range of speed and must not be extrapolated.
Speeds are those of the crack [m/s].

Source: Maghami, PhD thesis (2025), Eq. 2.19 and 4.28, published as
doi:10.1016/j.jmps.2024.105844; Gent & Schultz (1972), J. Adhesion 3, 281 (no DOI known to this
package).
"""

from __future__ import annotations

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
