r"""How moduli may move from one temperature to the next, beside their shift in frequency.

The theory of rubber elasticity says by density and temperature,

.. math:: b_T = \frac{\rho_0 T_0}{\rho T}, \qquad \rho \propto e^{-\alpha T}

a few per cent over ten kelvin; a clamp or a gap that changes with temperature does as much. Where
nobody says, the moduli move as far as both of them together fix it: the vertical shifts of all
steps have a common size, which is found with them, and where the curves are too straight to fix a
shift this size holds it. Shifts that were found without a vertical shift are no surer than that.
"""

from collections.abc import Sequence

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError

from .overlap import Curve, Hold, free_vertical

WORDS = ("auto", "none", "free")
_USUAL = 0.02  # decades, 5 %: what a gap, a clamp and rubber elasticity do from sweep to sweep
_SPREADS = np.geomspace(1e-4, 0.3, 80)  # decades


def checked(vertical: str | float) -> str | float:
    """Return a word of WORDS, or an expansion coefficient [1/K]; refuse anything else."""
    if isinstance(vertical, str) and vertical in WORDS:
        return vertical
    if isinstance(vertical, bool | str) or not 0 <= float(vertical) < 0.01:
        raise InputError(
            f"vertical must be one of {', '.join(WORDS)}, or the coefficient of volume expansion "
            f"in 1/K, from 0 to 0.01 (about 6e-4 for a melt), got {vertical!r}"
        )
    return float(vertical)


def by_density(temperature: Array, expansion: float) -> Array:
    """Return log10 of rho T over a common factor: minus the vertical shift to any temperature.

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
    """Return what is known before of the vertical shift of each step.

    Parameters
    ----------
    vertical : str or float
        As :func:`checked` returns it.
    temperature : ndarray, shape (n + 1,)
        Of the curves [K], ascending.
    pairs : sequence of (Curve, Curve), n
        Neighbours, with all the moduli that were measured.
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
    """Return the standard deviation that vertical shifts have about what is expected of them.

    The root of the mean square under the likelihood of the steps' own free fits and half a normal
    distribution of the usual size before.
    """
    cost = (_SPREADS / _USUAL) ** 2
    for expected, (colder, hotter) in zip(law, pairs, strict=True):
        try:
            found, variance = free_vertical(colder, hotter)
        except ValueError:
            continue  # too straight to tell
        total = variance + _SPREADS**2
        cost += np.log(total) + (found - expected) ** 2 / total
    weight = np.exp(-(cost - np.min(cost)) / 2) * _SPREADS  # evenly in the spread, not its log
    return float(np.sqrt(np.sum(weight * _SPREADS**2) / np.sum(weight)))
