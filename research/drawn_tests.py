"""Random tests as laboratories make them: spheres and punches that a second or two answers.

Each is made of a seed and its number alone.
"""

from typing import Any

import numpy as np

from viscotack import (
    Approach,
    AtDepth,
    Dugdale,
    Dwell,
    Elastic,
    Exponential,
    FlatPunch,
    Groups,
    Layer,
    LennardJones,
    Prony,
    RelaxationPowerLaw,
    RetardationPowerLaw,
    Retract,
    StandardSolid,
)
from viscotack.model.traction import effective_range

_PUNCHES, _WITH_SPRING, _WITH_HISTORY = 0.3, 0.25, 0.3


class Luck:
    """Random draws of the kinds that are needed here."""

    def __init__(self, *seed: int) -> None:
        self._random = np.random.default_rng(seed)

    def decades(self, low: float, high: float) -> float:
        """Return a number whose logarithm is anywhere between two."""
        return float(10 ** self._random.uniform(np.log10(low), np.log10(high)))

    def within(self, low: float, high: float, size: int | None = None) -> Any:
        """Return a number between two, or an array of such numbers."""
        found = self._random.uniform(low, high, size)
        return float(found) if size is None else found

    def count(self, low: int, high: int) -> int:
        """Return a whole number between two, which are among them."""
        return int(self._random.integers(low, high + 1))

    def one(self, weights: dict[Any, float]) -> Any:
        """Return one of some things, each as often as its weight says."""
        share = np.array(list(weights.values()))
        return list(weights)[self._random.choice(len(share), p=share / share.sum())]

    def happens(self, share: float) -> bool:
        """Return whether something happens that does so in this share of cases."""
        return bool(self._random.random() < share)


def solid(luck: Luck) -> Any:
    """Return a reduced material with a modulus ratio from 1e-3 to 1."""
    kind = luck.one(
        {Elastic: 0.2, StandardSolid: 0.25, RetardationPowerLaw: 0.3, Prony: 0.15}
        | {RelaxationPowerLaw: 0.1}
    )
    if kind is Elastic:
        return Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    glassy = luck.decades(1.0, 1e3)
    if kind is Prony:
        arms = luck.count(2, 6)
        share = luck.within(0.05, 1.0, arms)
        times = 10.0 ** -np.cumsum([0.0, *luck.within(0.3, 1.2, arms - 1)])
        arm = (glassy - 1) * share / share.sum()
        branches = [(float(E), float(t)) for E, t in zip(arm, times, strict=True)]
        return Prony(rubbery_modulus=1.0, branches=branches, poisson_ratio=0.0)
    more = {} if kind is StandardSolid else {"exponent": luck.within(0.2, 1.5)}
    return kind(rubbery_modulus=1.0, glassy_modulus=glassy, tau0=1.0, poisson_ratio=0.0, **more)


def drawn(seed: int, number: int) -> Groups:
    """Return a test: a sphere of Tabor number 0.1 to 8, or a punch, with a law, a solid, a spring.

    A history, where there is one, presses deeper, waits, or pulls half way before the retraction.
    """
    luck = Luck(seed, number)
    material, traction = solid(luck), law(luck)
    reach = effective_range(traction)
    if luck.happens(_PUNCHES):
        thickness = luck.decades(1, 30)
        pushed = thickness / (0.64 * traction.strength)
        sizes = {
            "tabor": None,
            "geometry": FlatPunch(luck.decades(5, 80)),
            "body": Layer(thickness),
            "cohesion": 0.05,
        }
        travel = reach * (1 + np.sqrt(3 * thickness))
        depth = pushed * luck.decades(0.03, 1.5)
    else:
        sizes = {"tabor": reach * luck.decades(0.1, 8)}
        travel = sizes["tabor"] + reach
        depth = travel * luck.decades(0.03, 20)
    stiffness = None
    if luck.happens(_WITH_SPRING):
        stiffness = 1 / travel * luck.decades(0.1, 100)
    speed = travel * luck.decades(1e-2, 1e4)
    return Groups(
        **sizes,
        material=material,
        traction=traction,
        start=AtDepth(depth),
        stiffness=stiffness,
        moves=history(luck, depth, travel) if luck.happens(_WITH_HISTORY) else (),
        rate=speed,
    )


def law(luck: Luck) -> Any:
    """Return a reduced law that is quick to follow."""
    match luck.one({"lennard-jones": 0.5, "exponential": 0.3, "dugdale": 0.2}):
        case "lennard-jones":
            return LennardJones(1.0, 1.0)
        case "exponential":
            return Exponential(1.0, 1.0, decay=luck.decades(0.1, 1.0))
        case _:
            return Dugdale(1.0, 1.0, rise=0.1, fall=luck.decades(0.3, 1.0))


def history(luck: Luck, depth: float, travel: float) -> tuple[Any, ...]:
    """Return moves before the retraction."""
    deeper = AtDepth(depth + 0.5 * travel * luck.within(0.1, 1.0))
    speed = travel * luck.decades(1e-1, 1e2)
    match luck.one({"press": 1, "wait": 1, "cycle": 1}):
        case "press":
            return (Approach(speed, deeper), Dwell(luck.decades(1e-2, 1e2)))
        case "wait":
            return (Approach(speed, deeper), Dwell(luck.decades(1e-2, 1e2), "force"))
        case _:
            return (Approach(speed, deeper), Retract(speed, AtDepth(depth)), Dwell(1.0))
