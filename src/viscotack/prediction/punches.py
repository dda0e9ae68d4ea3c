"""Surrogate of flat punches on a sliding layer, as a tier."""

from __future__ import annotations

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import OutOfRange
from viscotack.model.geometry import FlatPunch, Frictionless, numbers
from viscotack.model.materials import Prony, StandardSolid
from viscotack.model.problem import Groups, PunchScales
from viscotack.model.protocol import AtDepth, AtForce
from viscotack.model.traction import LennardJones
from viscotack.prediction.surrogate import store
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.prediction.surrogate.punch_physics import INPUTS, PRELOAD

from .beyond import slower
from .learned import INSIDE, further_prediction, out_of_range, within
from .prediction import Prediction
from .tier import LEARNED_PUNCH, Question, Verified

VERIFIED = Verified(
    shapes=(FlatPunch,),
    bodies=(Frictionless,),
    laws=(LennardJones,),
    solids=(StandardSolid, Prony),
    starts=(AtDepth, AtForce),
)
# Units of the inputs with units.
_UNITS = {"size": "a0", "thickness": "a0", "preload": "h0", "rate": "h0/tau0"}


def by_punches(asked: Question) -> Prediction:
    """Evaluate the surrogate of punches on a sliding layer, including its slow limit."""
    groups, learned = asked.groups, asked.model or store.shipped("punch")
    material = groups.material
    if isinstance(material, Prony) and len(material.branches) > 1:
        raise OutOfRange(f"the solid has {len(material.branches)} branches; verified only for one")
    given = inputs_of(groups)
    row = np.array([given.get(name, np.nan) for name in INPUTS])
    sized = bool(learned.inside(row[None])[0, :2].all())
    if "preload_force" in given and sized:
        row[PRELOAD] = learned.start_depth(row[0], row[1], force=given["preload_force"])
    if learned.inside(row[None]).all():
        return within(asked, learned, learned.tests(row[None]), LEARNED_PUNCH, INSIDE)
    further = None if asked.model else slower(learned, row[None], asked.confidence)
    return further_prediction(asked, further, LEARNED_PUNCH, _out(asked, learned, row, sized))


def inputs_of(groups: Groups) -> dict[str, float]:
    """Return the inputs of a test in the form of a campaign's case, with the rate in h0/tau0."""
    assert groups.rate is not None, "a test without moves ends with a retraction"
    assert groups.cohesion is not None, "a punch has one"
    start: dict[str, float] = {}
    match groups.start:
        case AtDepth(depth=depth):
            start["preload"] = depth
        case AtForce(force=force):
            start["preload_force"] = force
    return start | {
        **numbers(groups.geometry),
        **numbers(groups.body),
        "cohesion": groups.cohesion,
        "modulus_ratio": groups.modulus_ratio,
        "rate": groups.rate * _time(groups),
    }


def _time(groups: Groups) -> float:
    """Return the retardation time of a standard solid, in the groups' unit of time."""
    material = groups.material
    if isinstance(material, Prony):
        ((_, relaxation),) = material.branches
        return relaxation / material.modulus_ratio
    assert isinstance(material, StandardSolid), "others were rejected"
    return material.tau0


def _out(asked: Question, learned: Surrogate, row: Array, sized: bool) -> str:
    """Describe the inputs out of range, with their values and the range."""
    scales, si = asked.problem.scales(), {}
    if isinstance(scales, PunchScales):
        speed = scales.length / (scales.time * _time(asked.groups))
        si = dict.fromkeys(("size", "thickness"), (scales.width, "m"))
        si |= {"preload": (scales.length, "m"), "rate": (speed, "m/s")}
    found = out_of_range(learned, row, _UNITS, si)
    # the largest depth of a start depends on size and thickness
    if "preload" in found:
        found["preload"] += " for this size and thickness"
    return "; ".join(words for name, words in found.items() if sized or name != "preload")


TIERS = {LEARNED_PUNCH: ((VERIFIED,), by_punches)}
