"""Effect of a compliant machine on pull-offs, near a given interface.

While the tension grows a compliant machine stretches, so the sphere moves more slowly than the
drive. The ratio of the force to that of a rigid machine is computed at one interface. Where it is
far from 1, its derivatives with respect to the interface are computed as well.

The logarithm of the ratio is nearly proportional to the compliance. Its product with the relative
uncertainty of the compliance is therefore an error common to all forces.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from viscotack.arrays import Array

from .forward import Changed, Forward, Growth

# |ln ratio| above which derivatives are computed, and steps in ln of work and range.
_FAR, _WORK, _GAP = 0.1, 0.1, -0.3


@dataclass(frozen=True, eq=False)
class Yielding:
    """Ratio of forces with a compliant machine to those with a rigid one.

    Parameters
    ----------
    log_ratio : ndarray, shape (S,)
        ln of the ratio at the reference interface; of tests without an answer by theory that of the
        nearest speeds with one.
    slopes : ndarray, shape (2, S)
        Derivatives with respect to ln of the work of adhesion and of the range.
    work, gap : float
        Reference interface [J/m2] and [m].
    """

    log_ratio: Array
    slopes: Array
    work: float = 1.0
    gap: float = 1.0

    @property
    def much(self) -> bool:
        """Whether the ratio depends on the interface."""
        return bool(np.any(self.slopes != 0))

    @classmethod
    def of_a_rigid_machine(cls, speeds: int) -> "Yielding":
        """Return the ratios of a rigid machine, which are 1."""
        return cls(np.zeros(speeds), np.zeros((2, speeds)))

    def __call__(self, values: Mapping[str, Any]) -> Array:
        """Return the ratios of one interface, shape (S,), or of many, shape (N, S)."""
        away = np.stack(
            [
                np.log(np.asarray(values["work_of_adhesion"]) / self.work),
                np.log(np.asarray(values["equilibrium_gap"]) / self.gap),
            ],
            axis=-1,
        )
        return np.exp(self.log_ratio + away @ self.slopes)


def yielding_near(
    forward: Forward,
    work: float,
    gap: float,
    speed: Array,
    preload: Array,
    stiffness: float | None,
    growth: Growth | None,
) -> tuple[Yielding, Changed]:
    """Compute the ratios near an interface, and those at the interface."""

    def log_ratio(w: float, h0: float) -> tuple[Array, Changed]:
        found = forward.changed(w, h0, speed, preload, stiffness=stiffness, growth=growth)
        return np.log(found.ratio), found

    middle, changed = log_ratio(work, gap)
    slopes = np.zeros((2, speed.size))
    if np.max(np.abs(middle)) > _FAR:
        beside = (
            (log_ratio(work * np.exp(_WORK), gap), _WORK),
            (log_ratio(work, gap * np.exp(_GAP)), _GAP),
        )
        for row, ((other, there), step) in zip(slopes, beside, strict=True):
            known = [i for i in range(speed.size) if i not in there.refused]
            row[known] = (other - middle)[known] / step
    told = [i for i in np.argsort(speed) if i not in changed.refused]
    if told:
        middle = np.interp(np.log(speed), np.log(speed[told]), middle[told])
    return Yielding(middle, slopes, work, gap), changed
