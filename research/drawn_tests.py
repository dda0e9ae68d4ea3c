"""Random tests as laboratories make them: spheres and punches that a second or two answers.

Each is made of a seed and its number. `random_problems.py` draws from a wider and harder field.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from research.random_problems import Luck, solid
from viscotack import (
    Approach,
    AtDepth,
    Dugdale,
    Dwell,
    Exponential,
    FlatPunch,
    Groups,
    Layer,
    LennardJones,
    Retract,
)
from viscotack.traction import effective_range

_PUNCHES, _WITH_SPRING, _WITH_HISTORY = 0.3, 0.25, 0.3


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
