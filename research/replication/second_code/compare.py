"""Agreement of the second code with the package: plane cracks, zones, and pull-offs of spheres."""

from typing import Any

import numpy as np

import viscotack as vt
from research.cases import reduced
from viscotack import LennardJones
from viscotack.theory import SteadyCrack, lennard_jones

from .half_plane import Solid, cracks
from .sphere import pull_off, retraction

OPENING = (0.01, 0.1, 1.0, 10.0, 100.0, 1000.0)
CLOSING = (-0.1, -1.0, -10.0, -100.0)
# Modulus ratio and exponent of a power law (None: standard solid), and speeds.
PLANE = (
    (0.1, None, OPENING),
    (0.01, None, (*OPENING, 1e4)),
    (0.1, 0.6, OPENING),
    (0.1, None, CLOSING),
)
# Gaps between which zones are compared [h0].
ZONE = (1.1, 20.0)
ELASTIC_TABOR = (5.0, 10.0, 20.0, 50.0, 100.0, 200.0)
# Tabor numbers and speeds of spheres whose edge moves, modulus ratio 0.1.
MOVING = ((10.0, 1.0), (10.0, 10.0), (30.0, 10.0), (30.0, 100.0), (100.0, 100.0), (200.0, 10.0))
_REFINED = (1.0, 2.0)
# Retractions in time at a Tabor number of 10: depth [beta^2/R], rate [beta^2/R per tau], coarsest
# spacing [beta]. Accuracy of the simulations of the package.
MARCHED = ((8.0, 5.0, 0.03), (8.0, 1.0, 0.02))
_MARCHED_TABOR, _ACCURACY = 10.0, 3e-4


def solids(modulus_ratio, exponent):
    """Return the same solid for this code and for the package."""
    own = Solid.power_law(modulus_ratio, exponent) if exponent else Solid.standard(modulus_ratio)
    return own, reduced(modulus_ratio, exponent)


def plane(modulus_ratio, exponent, speeds, **mesh):
    """Return rows of energies by both codes, and how far gaps and tractions of the zones differ."""
    own, theirs = solids(modulus_ratio, exponent)
    crack = SteadyCrack(theirs, LennardJones(1.0, 1.0))
    rows = []
    for speed, found in zip(speeds, cracks(own, speeds, **mesh), strict=True):
        profile = crack.at(speed)
        inside = (profile.gap > ZONE[0]) & (profile.gap < ZONE[1])
        gap = np.interp(profile.position[inside], found.position, found.gap)
        middle = np.interp(profile.middle, profile.position, profile.gap)
        there = (middle > ZONE[0]) & (middle < ZONE[1])
        traction = np.interp(profile.middle[there], found.position, found.traction)
        rows.append(
            {
                "modulus_ratio": modulus_ratio,
                "exponent": exponent,
                "speed": speed,
                "energy": found.energy,
                "package": profile.amplification,
                "energy_off": found.energy / profile.amplification - 1,
                "gap_off": float(np.max(np.abs(gap / profile.gap[inside] - 1))),
                "traction_off": float(np.max(np.abs(traction - profile.traction[there]))),
            }
        )
    return rows


def extrapolated(tabor, **options):
    """Return the pull-off force without the error of the mesh, which is of second order."""
    coarse, fine = (pull_off(tabor, refined=r, **options) for r in _REFINED)
    ratio = (_REFINED[1] / _REFINED[0]) ** 2
    return (ratio * fine - coarse) / (ratio - 1)


def elastic(tabor):
    """Return a row of an elastic pull-off beside the table of the package."""
    force, package = extrapolated(tabor), float(lennard_jones.pull_off_ratio(tabor))
    return {"tabor": tabor, "force": force, "package": package, "off": force / package - 1}


def moving(tabor, speed, modulus_ratio=0.1):
    """Return a row of a pull-off at a steady speed of the edge beside the rule of the package."""
    own, theirs = solids(modulus_ratio, None)
    energy = float(np.asarray(SteadyCrack(theirs, LennardJones(1.0, 1.0)).amplification(speed)))
    effective = tabor * energy ** (-1 / 3)
    force = extrapolated(tabor, solid=own, speed=speed, energy=energy) / energy
    rule = float(lennard_jones.pull_off_ratio(effective))
    return {
        "tabor": tabor,
        "speed": speed,
        "energy": energy,
        "effective": effective,
        "factor": force,
        "rule": rule,
        "off": force / rule - 1,
    }


def marched(depth, rate, spacing, tabor=_MARCHED_TABOR, modulus_ratio=0.1):
    """Return a row of a retraction in time by both codes, and by the contact with a steady crack.

    The second code is extrapolated from three spacings.
    """
    own, theirs = solids(modulus_ratio, None)
    groups = vt.Groups(
        tabor=tabor, material=theirs, start=vt.AtDepth(depth * tabor), rate=rate * tabor
    )
    contact: Any = vt.crack_contact(groups)
    options: dict[str, Any] = {"until": "pull-off", "accuracy": _ACCURACY, "estimate_error": False}
    simulated = vt.pull_off(vt.solve(groups, **options)).force
    least = 0.75 * contact.contact_radius_at_pull_off * np.pi ** (1 / 3)
    forces = [
        retraction(tabor, own, depth=depth, rate=rate, least=least, spacing=spacing / part)
        for part in (1, 2, 4)
    ]
    first, second = np.diff(forces)
    force = forces[-1] + second**2 / (first - second)
    return {
        "tabor": tabor,
        "depth": depth,
        "rate": rate,
        "finest": forces[-1],
        "order": float(np.log2(first / second)),
        "force": force,
        "simulated": simulated,
        "contact": contact.pull_off_force,
        "energy": contact.amplification_at_pull_off,
        "off": force / simulated - 1,
        "contact_off": contact.pull_off_force / simulated - 1,
    }


def agreement():
    """Return all rows."""
    return {
        "plane": [row for case in PLANE for row in plane(*case)],
        "elastic": [elastic(tabor) for tabor in ELASTIC_TABOR],
        "moving": [moving(*case) for case in MOVING],
        "marched": [marched(*case) for case in MARCHED],
    }
