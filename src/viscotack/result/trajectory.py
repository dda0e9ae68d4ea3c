"""Where a trajectory is kept: 24 points from the start of a retraction to the pull-off.

From a deep start to zero force it is long and its tension only a sliver of the travel, so the two
parts have points of their own: the last 16 lie between zero force and pull-off. A start in tension
has the second part only.
"""

import numpy as np
import numpy.typing as npt

POINTS, TENSILE = 24, 16
PRESSED = POINTS - TENSILE


def gathered(count: int) -> npt.NDArray[np.float64]:
    """Return shares of a travel from 0 to 1, closer to each other at its end.

    Examples
    --------
    >>> gathered(3).tolist()
    [0.0, 0.75, 1.0]
    """
    return 1 - (1 - np.linspace(0.0, 1.0, count)) ** 2


def shares(zero: float) -> npt.NDArray[np.float64]:
    """Return the shares of the travel to the pull-off at which a trajectory is kept, shape (24,).

    Parameters
    ----------
    zero : float
        The share at which the force is zero for the last time; 0 where it starts in tension.

    Returns
    -------
    ndarray
        Eight points from the start to zero force and sixteen from there to the pull-off, or all 24
        in tension; closer to each other at the end of each part, :math:`1 - (1 - i/n)^2` of it.

    Examples
    --------
    >>> shares(0.9)[[0, 7, 8, 9, 23]].round(4).tolist()
    [0.0, 0.8859, 0.9, 0.9129, 1.0]
    """
    if zero <= 0:
        return gathered(POINTS)
    pressing = gathered(PRESSED + 1)[:-1]
    return np.append(zero * pressing, zero + (1 - zero) * gathered(TENSILE))
