r"""Share of parts that meet the targets, by slopes of ln of the forces.

The tolerances of a part are factors :math:`e^{s z}` with normal z, cut at three. The margin of a
target is linear in z with the slopes of the design; the share is counted over points of Sobol.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from statistics import NormalDist

import numpy as np

from viscotack.arrays import Array

from .space import HOLD, PRELOAD, RATIO, RELEASE

# Points, and where normal deviates are cut.
_POINTS, _CUT = 2**12, 3.0
Slopes = Mapping[str, Mapping[str, float | None]]


def gain(target: str, name: str, slopes: Slopes) -> float | None:
    """Return the slope of the margin of a target by ln of a variable; None where unknown."""
    if target == PRELOAD:
        return -1.0 if name == PRELOAD else 0.0
    of = {RELEASE: ((RELEASE, -1),), RATIO: ((HOLD, 1), (RELEASE, -1))}
    total = 0.0
    for force, sign in of.get(target, ((target, 1),)):
        slope = slopes.get(force, {}).get(name, 0.0)
        if slope is None:
            return None
        total += sign * slope
    return total


def share_of(
    margins: Mapping[str, float], slopes: Slopes, deviations: Mapping[str, float]
) -> float | None:
    """Return the share of parts whose margins are all positive; None where a slope is unknown."""
    z = _deviates(len(deviations))
    met = np.ones(len(z), dtype=bool)
    for target, margin in margins.items():
        gains = [gain(target, name, slopes) for name in deviations]
        if any(x is None for x in gains):
            return None
        met &= margin + z @ (np.array(gains) * np.array(list(deviations.values()))) >= 0
    return float(met.mean())


def allowances(
    targets: tuple[str, ...], slopes: Slopes, deviations: Mapping[str, float], share: float
) -> dict[str, float]:
    """Return the margins by which each target must be met, so that together this share meets all.

    Each target has an equal part of the rejects, an upper bound of them.
    """
    z = NormalDist().inv_cdf(1 - (1 - share) / len(targets)) if deviations else 0.0
    found = {}
    for target in targets:
        gains = [(gain(target, name, slopes) or 0.0) * s for name, s in deviations.items()]
        found[target] = z * float(np.linalg.norm(gains))
    return found


@lru_cache(maxsize=8)
def _deviates(count: int) -> Array:
    from scipy.stats import qmc, truncnorm

    drawn = qmc.Sobol(count, rng=np.random.default_rng(count)).random(_POINTS)
    return truncnorm.ppf(drawn, -_CUT, _CUT)
