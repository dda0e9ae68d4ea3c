"""Random cases: a contact without dimensions, a material or a law, drawn from a seed."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

import viscotack
from benchmarks.random_problems import Luck, RoundedCone, Scene, deeper, driven, solid, table
from viscotack import (
    AtDepth,
    AtForce,
    AtRadius,
    Bonded,
    Cone,
    Dugdale,
    Exponential,
    Eyring,
    FlatPunch,
    FractionalZener,
    Frictionless,
    GentSchultz,
    Groups,
    Layer,
    LennardJones,
    PowerLawProfile,
    SaturatingAgeing,
    Sphere,
)
from viscotack.traction import effective_range, has_rest

sys.path.append(str(Path(__file__).parents[1] / "examples" / "own"))
from cole_cole import ColeCole  # noqa: E402
from morse import Morse  # noqa: E402

Case = Groups
OWN = (RoundedCone, ColeCole, Morse)
# Names that the text of a case may use.
NAMES: dict[str, Any] = {name: getattr(viscotack, name) for name in viscotack.__all__} | {
    kind.__name__: kind for kind in OWN
}

__all__ = ["NAMES", "OWN", "Case", "Luck", "contact", "law", "material", "of_text", "relaxed"]


def of_text(text: str) -> Any:
    """Return the case that its text describes, as ``repr`` writes it."""
    return eval(text, {"__builtins__": {}, "inf": np.inf}, NAMES)


def material(luck: Luck) -> Any:
    """Return a reduced material with a modulus ratio from 1e-4 to 1."""
    if luck.happens(0.8):
        return solid(luck)
    kind = luck.one({FractionalZener: 0.7, ColeCole: 0.3})
    order = round(luck.within(0.2, 0.95), 3)
    common = {"rubbery_modulus": 1.0, "tau0": 1.0, "poisson_ratio": 0.0}
    return kind(glassy_modulus=luck.decades(1.0, 1e4), order=order, **common)


def law(luck: Luck) -> Any:
    """Return a reduced traction law; some are tables, grow with the speed or are a user's own."""
    match luck.one(
        {
            "lj": 0.45,
            "exp": 0.2,
            "dugdale": 0.1,
            "table": 0.1,
            "grows": 0.06,
            "ages": 0.04,
            "own": 0.05,
        }
    ):
        case "exp":
            return Exponential(1.0, 1.0, decay=luck.decades(0.25, 3))
        case "dugdale":
            return Dugdale(1.0, 1.0, rise=luck.decades(0.03, 0.3), fall=luck.decades(0.3, 1))
        case "table":
            return gentle_table(luck)
        case "grows":
            speed = luck.decades(0.1, 1e3)
            if luck.happens(0.5):
                return GentSchultz.of(
                    LennardJones(1.0, 1.0), reference_speed=speed, exponent=luck.within(0.1, 0.6)
                )
            return Eyring.of(
                LennardJones(1.0, 1.0), reference_speed=speed, sensitivity=luck.within(0.05, 0.5)
            )
        case "ages":
            return SaturatingAgeing.of(
                LennardJones(1.0, 1.0),
                reference_time=luck.decades(0.01, 1e2),
                largest_growth=luck.decades(0.1, 3),
            )
        case "own":
            return Morse(1.0, 1.0, steepness=luck.within(1.5, 6.0))
        case _:
            return LennardJones(1.0, 1.0)


def gentle_table(luck: Luck) -> Any:
    """Return a table whose strength is that of ordinary laws."""
    while True:
        found = table(luck)
        if 0.3 < found.strength < 3:
            return found


def contact(luck: Luck) -> Case:
    """Return a contact of any kind: start, moves, spring, retraction."""
    if luck.happens(0.12):
        return punch(luck)
    traction, tabor = law(luck), tabor_of(luck)
    shape = geometry(luck)
    if not isinstance(shape, Sphere):
        tabor = min(tabor, 3.0)
    if tabor > 200:  # the tier of steady cracks answers: a crack of each law takes seconds
        traction = LennardJones(1.0, 1.0)
    scene = scene_of(luck, traction, tabor)
    solid, moved = material(luck), luck.happens(0.5 if tabor < 200 else 0.2)
    stiffness, machine = driven(luck, solid, scene, with_history=moved)
    if machine["rate"] is not None:
        machine["rate"] = min(machine["rate"], 1e5)
    return Groups(
        tabor=tabor,
        material=solid,
        traction=traction,
        geometry=shape,
        stiffness=stiffness,
        **machine,
    )


def relaxed(luck: Luck) -> Groups:
    """Return a sphere that is pulled from a relaxed contact by a rigid machine."""
    traction = LennardJones(1.0, 1.0) if luck.happens(0.6) else law(luck)
    while has_rest(traction):
        traction = law(luck)
    tabor = tabor_of(luck)
    scene = scene_of(luck, traction, tabor)
    return Groups(
        tabor=tabor,
        material=material(luck),
        traction=traction,
        start=deeper(scene),
        rate=scene.travel * luck.decades(1e-2, 1e4),
    )


def tabor_of(luck: Luck) -> float:
    """Return a Tabor number: most of them small, where a simulation takes a tenth of a second."""
    low, high = luck.one({(0.05, 1): 0.45, (1, 7): 0.47, (7, 30): 0.04, (210, 300): 0.02})
    return luck.decades(low, high)


def scene_of(luck: Luck, traction: Any, tabor: float) -> Scene:
    """Return how far and how hard a machine moves that suits the contact of a tip."""
    reach = effective_range(traction.base if has_rest(traction) else traction)
    travel = tabor + reach

    def press() -> Any:
        match luck.one({"depth": 0.45, "force": 0.3, "pulled": 0.1, "radius": 0.15}):
            case "depth":
                return AtDepth(travel * luck.decades(0.03, 10))
            case "force":
                return AtForce(luck.decades(0.01, 30))
            case "pulled":
                return AtForce(luck.within(-0.9, 0.0))
            case _:
                return AtRadius(luck.within(1.3, 4.0))

    return Scene(travel, 1 + 4 * reach + 6 * travel, 1.0, press)


def geometry(luck: Luck) -> Any:
    """Return a reduced shape of revolution, of slope 1 at distance 1."""
    match luck.one({"sphere": 0.72, "cone": 0.08, "power": 0.12, "own": 0.08}):
        case "cone":
            return Cone(1.0)
        case "power":
            q = round(luck.within(1.3, 5.0), 3)
            return PowerLawProfile(1 / q, q)
        case "own":
            rounding = luck.decades(0.1, 10)
            return RoundedCone(float(np.hypot(1, rounding)), rounding)
        case _:
            return Sphere(1.0)


def punch(luck: Luck) -> Groups:
    """Return a flat punch on a layer, free to slide or bonded."""
    traction = law(luck)
    size, thickness = luck.decades(3, 100), luck.decades(1, 30)
    strength = traction.strength
    pushed = thickness / (0.64 * strength)

    def press() -> Any:
        if luck.happens(0.5):
            return AtDepth(pushed * luck.decades(0.03, 3))
        return AtForce(luck.decades(0.01, 1))

    reach = effective_range(traction.base if has_rest(traction) else traction)
    scene = Scene(pushed + reach, 10 * reach + pushed, 0.1, press)
    solid = material(luck)
    stiffness, machine = driven(luck, solid, scene, with_history=luck.happens(0.4))
    bonded = luck.happens(0.3)
    cohesion = luck.decades(0.01, 0.1)
    base = Bonded(poisson_ratio=luck.within(0.3, 0.49)) if bonded else Frictionless()
    return Groups(
        tabor=None,
        cohesion=cohesion,
        geometry=FlatPunch(size),
        body=Layer(thickness, base),
        material=solid,
        traction=traction,
        stiffness=stiffness,
        **machine,
    )
