"""Contacts of engineers in SI: grippers, stamps, AFM tips and tack tests.

Each family is even in the logarithms of its ranges. Spheres are pressed by a force over
1.5 pi R dg0 and lie on a power law (three in five) or a standard solid; stamps are flat punches on
a layer of a standard solid, pressed by a mean stress over dg0 and the range.
"""

from typing import Any

import numpy as np

from viscotack import (
    AtDepth,
    AtForce,
    FlatPunch,
    InputError,
    LennardJones,
    Problem,
    RetardationPowerLaw,
    Retraction,
    Sphere,
    StandardSolid,
)
from viscotack.model.geometry import Frictionless, Layer

# Radius or half width [m], rubbery modulus [Pa], work of adhesion [J/m2], range [m], speed [m/s],
# retardation time [s], glassy over rubbery modulus, and preload; exponents are those of the
# surrogate.
_NAMES: tuple[str, ...] = (
    "radius", "modulus", "work", "range", "speed", "time", "stiffening", "preload",
    "exponent", "thickness",
)  # fmt: skip
FAMILIES = {
    "grippers": (
        (5e-5, 5e-3), (1e5, 5e6), (0.02, 0.3), (1e-9, 3e-7), (1e-6, 0.1), (1e-4, 1.0), (2.0, 1e3),
        (0.3, 30.0),
    ),
    "stamps": (
        (5e-6, 2.5e-4), (5e5, 3e6), (0.05, 0.3), (1e-8, 3e-7), (1e-5, 0.1), (1e-3, 1.0),
        (1.5, 30.0), (0.003, 0.3),
    ),
    "AFM tips": (
        (5e-9, 1e-5), (1e5, 1e8), (0.01, 0.1), (3e-10, 1e-8), (1e-8, 1e-4), (1e-5, 1.0),
        (2.0, 1e3), (0.3, 30.0),
    ),
    "tack tests": (
        (1e-3, 1.5e-2), (5e3, 1e6), (0.03, 0.3), (1e-8, 1e-6), (1e-6, 1e-2), (1e-3, 10.0),
        (3.0, 1e3), (1.0, 100.0),
    ),
}  # fmt: skip
_EXPONENT, _THICKNESS, _STANDARD = (0.2, 1.5), (1.0, 20.0), 0.4


def contact(family: str, random: np.random.Generator) -> dict[str, float]:
    """Draw a contact of a family that is of small strain."""
    while True:
        ends = [*FAMILIES[family], _EXPONENT, _THICKNESS]
        drawn = [float(f"{a * (b / a) ** random.random():.8g}") for a, b in ends]
        inputs: dict[str, float] = dict(zip(_NAMES, drawn, strict=True))
        stamp = family == "stamps"
        standard = stamp or random.random() < _STANDARD
        inputs |= {"standard": float(standard), "stamp": float(stamp)}
        try:
            problem(inputs)
        except InputError:
            continue
        return inputs


def problem(of: dict[str, float]) -> Problem:
    """Return the problem of a contact in SI."""
    solid = {
        "rubbery_modulus": of["modulus"],
        "glassy_modulus": of["modulus"] * of["stiffening"],
        "tau0": of["time"],
        "poisson_ratio": 0.5,
    }
    law = LennardJones(work_of_adhesion=of["work"], equilibrium_gap=of["range"])
    parts: dict[str, Any] = {"traction": law}
    if of["stamp"]:
        layer = Layer(of["thickness"] * of["radius"], Frictionless())
        parts |= {"geometry": FlatPunch(of["radius"]), "body": layer}
        # about the depth of a layer under that mean stress
        stress = of["preload"] * of["work"] / of["range"]
        start = AtDepth(of["range"] + stress / (of["modulus"] * 4 / 3) * layer.thickness)
    else:
        parts |= {"geometry": Sphere(of["radius"])}
        start = AtForce(1.5 * np.pi * of["radius"] * of["work"] * of["preload"])
    material = (
        StandardSolid(**solid)
        if of["standard"]
        else RetardationPowerLaw(**solid, exponent=of["exponent"])
    )
    return Problem(material=material, protocol=Retraction(start=start, speed=of["speed"]), **parts)
