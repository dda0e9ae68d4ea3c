"""Sampling of a trajectory: 24 points from the start of a retraction to the pull-off.

From a deep start, the travel to zero force is long and the travel in tension short, so each part
has its own points: the last 16 lie between zero force and pull-off. A start in tension has only the
second part.
"""

import numpy as np
import numpy.typing as npt

POINTS, TENSILE = 24, 16
PRESSED = POINTS - TENSILE


def gathered(count: int) -> npt.NDArray[np.float64]:
    """Return fractions of a travel from 0 to 1, denser at its end.

    Examples
    --------
    >>> gathered(3).tolist()
    [0.0, 0.75, 1.0]
    """
    return 1 - (1 - np.linspace(0.0, 1.0, count)) ** 2


def shares(zero: float) -> npt.NDArray[np.float64]:
    """Return the fractions of the travel to the pull-off at which a trajectory is sampled, (24,).

    Parameters
    ----------
    zero : float
        Fraction at which the force is zero for the last time; 0 for a start in tension.

    Returns
    -------
    ndarray
        Eight points from the start to zero force and sixteen from there to the pull-off, or all 24
        in tension; denser at the end of each part, :math:`1 - (1 - i/n)^2` of it.

    Examples
    --------
    >>> shares(0.9)[[0, 7, 8, 9, 23]].round(4).tolist()
    [0.0, 0.8859, 0.9, 0.9129, 1.0]
    """
    if zero <= 0:
        return gathered(POINTS)
    pressing = gathered(PRESSED + 1)[:-1]
    return np.append(zero * pressing, zero + (1 - zero) * gathered(TENSILE))
