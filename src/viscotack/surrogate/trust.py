r"""How wide an interval is: conformal, from cases that the networks had not learned from.

The scores of such cases, :math:`|\Delta \log_{10}| / (\sigma + \sigma_0)` with the spread
:math:`\sigma` of the networks, were sorted within regions; an interval is as many times as wide as
holds the wanted share of them (:mod:`viscotack.surrogate.training.calibration`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

from . import physics

Array = npt.NDArray[np.float64]

CONFIDENCES = (0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98)
# Between these lie the regions: three ranges of Tabor number, times three of rate.
_TABORS, _RATES = (0.1, 1.0), (10.0, 1e5)
REGIONS = (len(_TABORS) + 1) * (len(_RATES) + 1)


def region(groups: Array) -> npt.NDArray[np.intp]:
    """Return the number of the region of each row, from 0 to REGIONS - 1.

    Examples
    --------
    >>> region(np.array([[0.05, 0.1, 0.6, 1.0, 1.0], [5.0, 0.1, 0.6, 1.0, 1e9]])).tolist()
    [0, 8]
    """
    tabor = np.searchsorted(_TABORS, groups[:, physics.TABOR])
    rate = np.searchsorted(_RATES, groups[:, physics.RATE])
    return tabor * (len(_RATES) + 1) + rate


@dataclass(frozen=True, eq=False)
class Trust:
    """Half widths of intervals.

    Attributes
    ----------
    force, work : ndarray, shape (REGIONS, confidences)
        How many spreads half an interval of log10 is wide.
    floors : ndarray, shape (2,)
        What is added to the spreads of force and work, log10.
    """

    force: Array
    work: Array
    floors: Array

    def factors(
        self, groups: Array, spreads: tuple[Array, Array], confidence: float
    ) -> tuple[Array, Array]:
        """Return by what force and work are multiplied and divided, arrays of shape (n,)."""
        if confidence not in CONFIDENCES:
            raise InputError(
                f"the confidence must be one of {', '.join(map(str, CONFIDENCES))}, for which "
                f"intervals were measured; got {confidence!r}"
            )
        where, level = region(groups), CONFIDENCES.index(confidence)
        half_force = self.force[where, level] * (spreads[0] + self.floors[0])
        half_work = self.work[where, level] * (spreads[1] + self.floors[1])
        return 10**half_force, 10**half_work
