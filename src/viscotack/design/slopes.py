r"""What matters: slopes of ln of the forces, what binds, and the share of parts that meet targets.

The tolerances of a part are factors :math:`e^{s z}` with normal z, cut at three. The margin of a
target is linear in z with the slopes of the design; the share is counted over points of Sobol.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from math import exp, log
from statistics import NormalDist
from typing import Any

import numpy as np

from viscotack.arrays import Array

from .fast import FastTier
from .margins import Candidate, Judge
from .space import INTERFACE, VARIABLES, Choice, DesignSpace

# Points, and where normal deviates are cut.
_POINTS, _CUT = 2**12, 3.0
# Step of logarithms for slopes, part of a range within which a variable is at its end, largest
# difference of margins that bind together, and least slope of a bound that binds.
_STEP, _AT_END, _TOGETHER, _SLOPE = 0.02, 5e-3, 0.02, 1e-3
Slopes = Mapping[str, Mapping[str, float | None]]


# Speed on which a force depends.
_OWN = {"hold": "hold_speed", "work": "hold_speed", "release": "release_speed"}


def slopes_of(choice: Choice, fast: FastTier, judge: Judge) -> Slopes:
    """Return d ln P/d ln x of the forces of a design by central differences of the fast tier."""
    if "modulus" in judge.conditions.deviations and choice.modulus is None:
        modulus = getattr(fast.materials[choice.material], "rubbery_modulus", None)
        choice = replace(choice, modulus=modulus)
    ends: dict[str, list[Any]] = {}
    for name in VARIABLES:
        if name != "pads" and (value := getattr(choice, name)) is not None:
            both = (replace(choice, **{name: value * exp(step)}) for step in (-_STEP, _STEP))
            ends[name] = [judge.forces(each, fast) for each in both]
    for name in INTERFACE:
        if (value := getattr(fast.traction, name, None)) is not None:
            laws = (replace(fast.traction, **{name: value * exp(x)}) for x in (-_STEP, _STEP))
            tiers = (FastTier(fast.materials, law, fast.budget) for law in laws)
            ends[name] = [judge.forces(choice, each) for each in tiers]
    forces = judge.forces(choice, fast)
    slopes: dict[str, dict[str, float | None]] = {}
    for force in () if isinstance(forces, str) else forces:
        own: dict[str, float | None] = {}
        for name, (low, high) in ends.items():
            if name in ("hold_speed", "release_speed") and name != _OWN.get(force):
                continue
            # none where no tier predicts
            slope = None
            if not isinstance(low, str) and not isinstance(high, str):
                slope = log(high[force].value / low[force].value) / (2 * _STEP)
            own[name] = slope
            if name == "preload":
                # N pads under the preload F are N times one under F/N
                own["pads"] = None if slope is None else 1 - slope
        slopes[force] = own
    return slopes


def binding(best: Candidate, space: DesignSpace, slopes: Slopes) -> tuple[str, ...]:
    """Return the targets with the smallest margin, and the bounds beyond which it would grow."""
    worst = [x for x, margin in best.margins.items() if margin <= best.margin + _TOGETHER]
    bounds = []
    for name, (low, high), place in zip(
        space.free, space.ends(), space.places(best.choice).tolist(), strict=True
    ):
        # where several targets bind they share the gain
        more = sum(gain(target, name, slopes) or 0.0 for target in worst)
        near = _AT_END * (high - low)
        if more > _SLOPE and place >= high - near:
            bounds.append(f"{name} at most")
        elif more < -_SLOPE and place <= low + near:
            bounds.append(f"{name} at least")
    if space.area is not None and best.choice.pads == space.most_pads(best.choice.radius):
        more = sum(gain(x, "pads", slopes) or 0.0 for x in worst)
        bounds += ["area at most"] if more > _SLOPE else []
    return (*worst, *bounds)


def gain(target: str, name: str, slopes: Slopes) -> float | None:
    """Return the slope of the margin of a target by ln of a variable; None where unknown."""
    if target == "preload":
        return -1.0 if name == "preload" else 0.0
    of = {"release": (("release", -1),), "ratio": (("hold", 1), ("release", -1))}
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
