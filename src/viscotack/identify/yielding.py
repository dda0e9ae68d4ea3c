"""What a machine that yields does to pull-offs, for interfaces near one that is likely.

While the tension grows a soft machine stretches, and the sphere goes more slowly than the drive.
The ratio of the force to that of a rigid machine is computed through the spring at one interface;
where it is far from 1 it hangs on the interface too, and its slopes are taken beside.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from viscotack.arrays import Array

from .forward import Forward, Growth

# ln of ratios beyond which slopes are taken, and how far beside, ln of work and range.
_FAR, _WORK, _GAP = 0.1, 0.1, -0.3


@dataclass(frozen=True, eq=False)
class Yielding:
    """Forces through a spring over those of a rigid machine.

    Parameters
    ----------
    log_ratio : ndarray, shape (S,)
        At the interface where it was computed.
    slopes : ndarray, shape (2, S)
        By ln of the work of adhesion and of the range.
    work, gap : float
        That interface [J/m2] and [m].
    """

    log_ratio: Array
    slopes: Array
    work: float = 1.0
    gap: float = 1.0

    @property
    def much(self) -> bool:
        """Whether it hangs on the interface."""
        return bool(np.any(self.slopes != 0))

    @classmethod
    def of_a_rigid_machine(cls, speeds: int) -> "Yielding":
        """Return that of a machine that does not yield."""
        return cls(np.zeros(speeds), np.zeros((2, speeds)))

    def __call__(self, values: Mapping[str, Any]) -> Array:
        """Return ratios of an interface, shape (S,), or of many, shape (N, S)."""
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
) -> tuple[Yielding, dict[int, str]]:
    """Return what a machine does near an interface, and which speeds are refused there and why."""

    def log_ratio(w: float, h0: float) -> tuple[Array, dict[int, str]]:
        found = forward.changed(w, h0, speed, preload, stiffness=stiffness, growth=growth)
        return np.log(found.ratio), found.refused

    middle, refused = log_ratio(work, gap)
    slopes = np.zeros((2, speed.size))
    if not refused and np.max(np.abs(middle)) > _FAR:
        beside = (
            (log_ratio(work * np.exp(_WORK), gap), _WORK),
            (log_ratio(work, gap * np.exp(_GAP)), _GAP),
        )
        for row, ((other, without), step) in zip(slopes, beside, strict=True):
            known = [i for i in range(speed.size) if i not in without]
            row[known] = (other - middle)[known] / step
    return Yielding(middle, slopes, work, gap), refused
