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


Random = np.random.Generator


def decades(random: Random, low: float, high: float) -> float:
    """Return a number whose logarithm is anywhere between two."""
    return float(10 ** random.uniform(np.log10(low), np.log10(high)))


def one(random: Random, weights: dict[Any, float]) -> Any:
    """Return one of some things, each as often as its weight says."""
    share = np.array(list(weights.values()))
    return list(weights)[random.choice(len(share), p=share / share.sum())]


def solid(random: Random) -> Any:
    """Return a reduced material with a modulus ratio from 1e-3 to 1."""
    kind = one(
        random,
        {Elastic: 0.2, StandardSolid: 0.25, RetardationPowerLaw: 0.3, Prony: 0.15}
        | {RelaxationPowerLaw: 0.1},
    )
    if kind is Elastic:
        return Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    glassy = decades(random, 1.0, 1e3)
    if kind is Prony:
        arms = int(random.integers(2, 7))
        share = random.uniform(0.05, 1.0, arms)
        times = 10.0 ** -np.cumsum([0.0, *random.uniform(0.3, 1.2, arms - 1)])
        arm = (glassy - 1) * share / share.sum()
        branches = [(float(E), float(t)) for E, t in zip(arm, times, strict=True)]
        return Prony(rubbery_modulus=1.0, branches=branches, poisson_ratio=0.0)
    more = {} if kind is StandardSolid else {"exponent": random.uniform(0.2, 1.5)}
    return kind(rubbery_modulus=1.0, glassy_modulus=glassy, tau0=1.0, poisson_ratio=0.0, **more)


def drawn(seed: int, number: int) -> Groups:
    """Return a test: a sphere of Tabor number 0.1 to 8, or a punch, with a law, a solid, a spring.

    A history, where there is one, presses deeper, waits, or pulls half way before the retraction.
    """
    random = np.random.default_rng((seed, number))
    material, traction = solid(random), law(random)
    reach = effective_range(traction)
    if random.random() < _PUNCHES:
        thickness = decades(random, 1, 30)
        pushed = thickness / (0.64 * traction.strength)
        sizes = {
            "tabor": None,
            "geometry": FlatPunch(decades(random, 5, 80)),
            "body": Layer(thickness),
            "cohesion": 0.05,
        }
        travel = reach * (1 + np.sqrt(3 * thickness))
        depth = pushed * decades(random, 0.03, 1.5)
    else:
        sizes = {"tabor": reach * decades(random, 0.1, 8)}
        travel = sizes["tabor"] + reach
        depth = travel * decades(random, 0.03, 20)
    stiffness = None
    if random.random() < _WITH_SPRING:
        stiffness = 1 / travel * decades(random, 0.1, 100)
    speed = travel * decades(random, 1e-2, 1e4)
    return Groups(
        **sizes,
        material=material,
        traction=traction,
        start=AtDepth(depth),
        stiffness=stiffness,
        moves=history(random, depth, travel) if random.random() < _WITH_HISTORY else (),
        rate=speed,
    )


def law(random: Random) -> Any:
    """Return a reduced law that is quick to follow."""
    match one(random, {"lennard-jones": 0.5, "exponential": 0.3, "dugdale": 0.2}):
        case "lennard-jones":
            return LennardJones(1.0, 1.0)
        case "exponential":
            return Exponential(1.0, 1.0, decay=decades(random, 0.1, 1.0))
        case _:
            return Dugdale(1.0, 1.0, rise=0.1, fall=decades(random, 0.3, 1.0))


def history(random: Random, depth: float, travel: float) -> tuple[Any, ...]:
    """Return moves before the retraction."""
    deeper = AtDepth(depth + 0.5 * travel * random.uniform(0.1, 1.0))
    speed = travel * decades(random, 1e-1, 1e2)
    match one(random, {"press": 1, "wait": 1, "cycle": 1}):
        case "press":
            return (Approach(speed, deeper), Dwell(decades(random, 1e-2, 1e2)))
        case "wait":
            return (Approach(speed, deeper), Dwell(decades(random, 1e-2, 1e2), "force"))
        case _:
            return (Approach(speed, deeper), Retract(speed, AtDepth(depth)), Dwell(1.0))
