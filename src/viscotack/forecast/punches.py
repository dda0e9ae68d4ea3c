"""Surrogate of flat punches on a sliding layer, as a tier."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.geometry import FlatPunch, Frictionless, numbers
from viscotack.materials import Prony, StandardSolid
from viscotack.problem import Case, Groups, PunchScales
from viscotack.protocol import AtDepth, AtForce
from viscotack.traction import LennardJones

from .allow_list import Verified
from .beyond import Beyond, slower
from .learned import INSIDE, further_prediction, within
from .prediction import Prediction
from .question import Question
from .training_range import out_of_range

if TYPE_CHECKING:
    from viscotack.surrogate.model import Surrogate


LEARNED_PUNCH = "surrogate of punches"
PUNCHES = Verified(
    shapes=(FlatPunch,),
    bodies=(Frictionless,),
    laws=(LennardJones,),
    solids=(StandardSolid, Prony),
    starts=(AtDepth, AtForce),
)
# Units of the inputs with units.
_UNITS = {"size": "a0", "thickness": "a0", "preload": "h0", "rate": "h0/tau0"}


def punch_limits(asked: Question) -> str:
    """Name the input of a punch outside the training range, or return ""."""
    groups, learned = asked.groups, _learned()
    material = groups.material
    if isinstance(material, Prony) and len(material.branches) > 1:
        return f"the solid has {len(material.branches)} branches; verified only for one"
    try:
        row = asked.once(_row)
    except InputError as error:  # no start in the range has this stress
        return str(error)
    if asked.model is None and asked.once(_slower) is not None:
        return ""
    return "; ".join(_out(row, asked.problem, groups, learned))


def by_punches(asked: Question) -> Prediction:
    """Evaluate the surrogate of punches on a sliding layer, including its slow limit."""
    learned, row = asked.model or _learned(), asked.once(_row)
    if asked.model is None and (further := asked.once(_slower)):
        out = "; ".join(_out(row, asked.problem, asked.groups, learned))
        return further_prediction(asked, further, LEARNED_PUNCH, out)
    return within(asked, learned, learned.tests(row[None]), LEARNED_PUNCH, INSIDE)


def _slower(asked: Question) -> Beyond | None:
    """Return the extrapolation below the smallest rate of the surrogate, or None."""
    return slower(_learned(), asked.once(_row)[None], asked.confidence)


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


def _learned() -> Surrogate:
    from viscotack.surrogate import store

    return store.shipped("punch")


def _row(asked: Question) -> Array:
    """Return the inputs of a test; the depth of a start by stress is nan if sizes are out of range.

    Raises
    ------
    InputError
        If no start in the range has this stress.
    """
    from viscotack.surrogate.punch_physics import INPUTS, PRELOAD

    given, learned = inputs_of(asked.groups), _learned()
    row = np.array([given.get(name, np.nan) for name in INPUTS])
    if "preload_force" in given and learned.inside(row[None])[0, :2].all():
        row[PRELOAD] = learned.start_depth(row[0], row[1], force=given["preload_force"])
    return row


def _time(groups: Groups) -> float:
    """Return the retardation time of a standard solid, in the groups' unit of time."""
    material = groups.material
    if isinstance(material, Prony):
        ((_, relaxation),) = material.branches
        return relaxation / material.modulus_ratio
    assert isinstance(material, StandardSolid), "others were rejected"
    return material.tau0


def _out(row: Array, problem: Case, groups: Groups, learned: Surrogate) -> list[str]:
    """Describe the inputs out of range, with their values and the range."""
    inside, limits = learned.inside(row[None])[0], learned.limits_of(row)
    sized, units = inside[0] and inside[1], _si(problem, groups)
    found = []
    for (name, ends), value, fits in zip(limits.items(), row.tolist(), inside, strict=True):
        # the largest depth of a start depends on size and thickness
        if fits or (name == "preload" and not sized):
            continue
        words = out_of_range(name, value, ends, _UNITS.get(name, ""), units.get(name))
        found.append(f"{words} for this size and thickness" if name == "preload" else words)
    return found


def _si(problem: Case, groups: Groups) -> dict[str, tuple[float, str]]:
    """Return the SI value and unit of each input's unit; empty for a dimensionless problem."""
    scales = problem.scales()
    if not isinstance(scales, PunchScales):
        return {}
    speed = scales.length / (scales.time * _time(groups))
    return {
        "size": (scales.width, "m"),
        "thickness": (scales.width, "m"),
        "preload": (scales.length, "m"),
        "rate": (speed, "m/s"),
    }
