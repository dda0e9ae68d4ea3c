r"""Vertical shifts of moduli between temperatures, in addition to the shift in frequency.

The theory of rubber elasticity gives, from density and temperature,

.. math:: b_T = \frac{\rho_0 T_0}{\rho T}, \qquad \rho \propto e^{-\alpha T}

which is a few per cent per ten kelvin. A clamp or a gap that changes with temperature has an effect
of the same size. By default moduli do not move: in sweeps that need no vertical shift a fitted one
takes up noise and moves the horizontal shift. "auto" determines the vertical shift by both moduli
together: the vertical shifts of all steps have a common size, fitted with them, which is the prior
where curves are too straight to determine a shift. It also contributes to the uncertainty of
horizontal shifts computed without vertical ones.
"""

from collections.abc import Sequence

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError

from .overlap import Curve, Hold, free_vertical

WORDS = ("none", "auto", "free")
_USUAL = 0.02  # decades, 5 %: usual effect of gap, clamp and rubber elasticity between sweeps
_SPREADS = np.geomspace(1e-4, 0.3, 80)  # decades


def checked(vertical: str | float) -> str | float:
    """Return an item of WORDS or an expansion coefficient [1/K]; raise an error otherwise."""
    if isinstance(vertical, str) and vertical in WORDS:
        return vertical
    if isinstance(vertical, bool | str) or not 0 <= float(vertical) < 0.01:
        raise InputError(
            f"vertical must be one of {', '.join(WORDS)}, or the coefficient of volume expansion "
            f"in 1/K, from 0 to 0.01 (about 6e-4 for a melt), got {vertical!r}"
        )
    return float(vertical)


def by_density(temperature: Array, expansion: float) -> Array:
    """Return log10(rho T) up to a constant; differences are minus the vertical shift.

    Parameters
    ----------
    temperature : ndarray
        [K].
    expansion : float
        Coefficient of volume expansion [1/K], constant.
    """
    return np.log10(temperature) - expansion * temperature / np.log(10)


def holds(
    vertical: str | float, temperature: Array, pairs: Sequence[tuple[Curve, Curve]]
) -> list[Hold]:
    """Return the prior of the vertical shift of each step.

    Parameters
    ----------
    vertical : str or float
        Output of :func:`checked`.
    temperature : ndarray, shape (n + 1,)
        Of the curves [K], ascending.
    pairs : sequence of (Curve, Curve), n
        Neighbouring curves, with all measured moduli.
    """
    if vertical == "free":
        return [Hold(0.0, np.inf) for _ in pairs]
    law = np.zeros(len(pairs))
    if not isinstance(vertical, str):
        law = -np.diff(by_density(temperature, vertical))
    spread = _spread(law, pairs)
    moves = vertical == "auto"
    return [Hold(float(expected), spread, moves) for expected in law]


def _spread(law: Array, pairs: Sequence[tuple[Curve, Curve]]) -> float:
    """Return the standard deviation of vertical shifts about their expected values.

    Root mean square under the likelihood of the steps' free fits and a half-normal
    prior of the usual size.
    """
    cost = (_SPREADS / _USUAL) ** 2
    for expected, (colder, hotter) in zip(law, pairs, strict=True):
        try:
            found, variance = free_vertical(colder, hotter)
        except ValueError:
            continue  # too straight to determine the vertical shift
        total = variance + _SPREADS**2
        cost += np.log(total) + (found - expected) ** 2 / total
    # uniform in the spread, not in its logarithm
    weight = np.exp(-(cost - np.min(cost)) / 2) * _SPREADS
    return float(np.sqrt(np.sum(weight * _SPREADS**2) / np.sum(weight)))
