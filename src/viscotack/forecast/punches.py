"""The answer at once to a flat punch on a sliding layer, where it was learned."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError, OutOfRange
from viscotack.geometry import Frictionless
from viscotack.materials import Prony, StandardSolid
from viscotack.problem import Case, PunchGroups, PunchScales
from viscotack.protocol import AtDepth, AtForce
from viscotack.traction import LennardJones

from .prediction import MEASURED, Prediction, with_curve
from .refusals import other_test, out_of_range
from .theory import SIMULATE

if TYPE_CHECKING:
    from viscotack.surrogate.punch import PunchSurrogate

Array = npt.NDArray[np.float64]

# How an answer is named that was learned of punches.
LEARNED_PUNCH = "surrogate of punches"
# Units of the inputs that have one.
_UNITS = {"size": "a0", "thickness": "a0", "preload": "h0", "rate": "h0/tau0"}


def by_learned_punch(problem: Case, groups: PunchGroups, confidence: float) -> Prediction:
    """Return what was learned of a punch on a layer.

    Parameters
    ----------
    problem : Problem or PunchGroups
        As it was asked.
    groups : PunchGroups
        Of the problem.
    confidence : float
        One of those for which intervals were measured.

    Raises
    ------
    OutOfRange
        If it was not learned: another test, solid, body or traction, or which input is out.
    """
    learned = _learned()
    if unlearned := _unlearned(groups):
        raise OutOfRange(f"{unlearned}; {SIMULATE}")
    try:
        row = _row(groups, learned)
    except InputError as error:  # no start in the range has that stress
        raise OutOfRange(f"{error}; {SIMULATE}") from None
    if out := _out(row, problem, groups, learned):
        raise OutOfRange(f"{'; '.join(out)}; {SIMULATE}")
    rows = row[None]
    answers = learned.evaluate(rows)
    held = learned.intervals(rows, answers, confidence=confidence)
    (low, high), (least, most) = (
        pair[0].tolist() for pair in (held.pull_off_force, held.work_to_pull_off)
    )
    found = Prediction(
        value=float(answers.pull_off_force[0]),
        interval=(low, high),
        work_to_pull_off=float(answers.work_to_pull_off[0]),
        work_interval=(least, most),
        confidence=confidence,
        band=MEASURED,
        method=LEARNED_PUNCH,
        inside=True,
        why="every input lies in the range that was learned from",
        curve=None,
        curve_band=None,
        problem=problem,
    )
    return with_curve(found, learned.curves(rows, answers), held)


def inputs_of(groups: PunchGroups) -> dict[str, float]:
    """Return the inputs of a campaign's case for a learned test, its rate in h0/tau0."""
    assert groups.rate is not None, "a test without moves ends with a retraction"
    start: dict[str, float] = {}
    match groups.start:
        case AtDepth(depth=depth):
            start["preload"] = depth
        case AtForce(force=force):
            start["preload_force"] = force
    return start | {
        "size": groups.size,
        "thickness": groups.thickness,
        "cohesion": groups.cohesion,
        "modulus_ratio": groups.modulus_ratio,
        "rate": groups.rate * _time(groups),
    }


def _learned() -> PunchSurrogate:
    from viscotack.surrogate import punch

    return punch.shipped()


def _unlearned(groups: PunchGroups) -> str:
    """Return in words why a test was not learned, or nothing."""
    material = groups.material
    if not isinstance(groups.traction, LennardJones):
        name = type(groups.traction).__name__
        return f"the traction is {name}, and of punches LennardJones alone was learned from"
    if not isinstance(groups.base, Frictionless):
        return "the layer is glued to its base, and layers that slide on it alone were learned from"
    if isinstance(material, Prony) and len(material.branches) > 1:
        return (
            f"the solid has {len(material.branches)} branches, and of punches standard solids "
            "alone, with one, were learned from"
        )
    if not isinstance(material, Prony | StandardSolid):
        name = type(material).__name__
        return f"the solid is {name}, and of punches standard solids alone were learned from"
    return other_test(groups, AtDepth | AtForce, "sigma0/h0")


def _row(groups: PunchGroups, learned: PunchSurrogate) -> Array:
    """Return the inputs of a test; the depth of a start by stress is nan where sizes are out.

    Raises
    ------
    InputError
        If no start in the range has that stress.
    """
    from viscotack.surrogate.punch_physics import INPUTS, PRELOAD

    given = inputs_of(groups)
    row = np.array([given.get(name, np.nan) for name in INPUTS])
    if "preload_force" in given and learned.inside(row[None])[0, :2].all():
        row[PRELOAD] = learned.start_depth(row[0], row[1], given["preload_force"])
    return row


def _time(groups: PunchGroups) -> float:
    """Return the retardation time of a solid that has one, in the groups' unit of time."""
    material = groups.material
    if isinstance(material, Prony):
        ((_, relaxation),) = material.branches
        return relaxation / material.modulus_ratio
    assert isinstance(material, StandardSolid), "others were refused"
    return material.tau0


def _out(row: Array, problem: Case, groups: PunchGroups, learned: PunchSurrogate) -> list[str]:
    """Return in words which inputs are out of the range, with their values and the range."""
    inside, limits = learned.inside(row[None])[0], learned.limits(row[0], row[1])
    sized, units = inside[0] and inside[1], _si(problem, groups)
    found = []
    for (name, ends), value, fits in zip(limits.items(), row.tolist(), inside, strict=True):
        # how deep a start may be depends on size and thickness
        if fits or (name == "preload" and not sized):
            continue
        words = out_of_range(name, value, ends, _UNITS.get(name, ""), units.get(name))
        found.append(f"{words} for this size and thickness" if name == "preload" else words)
    return found


def _si(problem: Case, groups: PunchGroups) -> dict[str, tuple[float, str]]:
    """Return what one unit of each input is in SI, nothing for a problem without dimensions."""
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
