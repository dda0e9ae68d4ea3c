"""What the tiers of surrogates share: predictions inside the range and slightly beyond it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import OutOfRange
from viscotack.model.protocol import AtDepth, AtForce, AtRadius
from viscotack.prediction.surrogate.contact import Contact
from viscotack.prediction.surrogate.model import Surrogate

from .beyond import Beyond
from .prediction import MEASURED, Prediction, with_curve
from .tier import Question, Uncertain

INSIDE = "every input is in the training range"


def out_of_range(
    learned: Surrogate,
    row: Array,
    units: Mapping[str, str],
    si: Mapping[str, tuple[float, str]],
) -> dict[str, str]:
    """Describe each known input of a test that is out of the range of a surrogate, by its name.

    Parameters
    ----------
    learned : Surrogate
    row : ndarray, shape (inputs,)
        Inputs of the test, nan where unknown.
    units : mapping of str to str
        Units of the inputs that have one.
    si : mapping of str to tuple
        SI value of one such unit, and its SI unit; empty for a problem without dimensions.
    """
    found = {}
    inside = learned.inside(row[None])[0]
    for (name, ends), value, fits in zip(
        learned.limits_of(row).items(), row.tolist(), inside, strict=True
    ):
        if fits or np.isnan(value):
            continue
        unit = f" {units[name]}" if name in units else ""
        own = f" ({value * si[name][0]:.3g} {si[name][1]})" if name in si else ""
        least, most = ends
        found[name] = (
            f"{name} is {value:.4g}{unit}{own}, outside the training range of {least:.4g} to "
            f"{most:.4g}{unit}"
        )
    return found


def not_certain(method: str, force: float, end: float, second: float) -> str:
    """Return why a surrogate abstains, from its force, the end of its interval, and the second."""
    return (
        f"the networks of the {method} are not certain here: they predict a pull-off force of "
        f"{force:.4g} within {end / force - 1:.2g} of it, the independent second ones {second:.4g}"
    )


def within(
    asked: Question, learned: Surrogate, tests: Contact, method: str, why: str
) -> Prediction:
    """Return a prediction inside the range, with its curve and the uncertainty of its start.

    Without work and curve if only these are uncertain, as where two maxima of the force are equal.

    Raises
    ------
    Uncertain
        If the force is uncertain: the second networks contradict it, or its interval is wide.
    """
    start, answers = asked.groups.start, learned.evaluate(tests)
    force_doubtful, work_doubtful = learned.doubtful(tests, answers)[0].tolist()
    if force_doubtful:
        end = learned.intervals(tests, answers).pull_off_force[0, 1]
        second = 10 ** tests.second[0][0]
        raise Uncertain(not_certain(method, answers.pull_off_force[0], end, second))
    held = learned.intervals(tests, answers, confidence=asked.confidence, joint=asked.joint)
    by = {AtDepth: "depth", AtForce: "force", AtRadius: "contact_radius"}[type(start)]
    held = learned.with_start_doubt(tests, answers, held, by=by, confidence=asked.confidence)
    (low, high), (least, most) = held.pull_off_force[0], held.work_to_pull_off[0]
    force, work = (low, answers.pull_off_force[0], high), (least, answers.work_to_pull_off[0], most)
    found = replace(_prediction(asked, force, work, method, why), joint=asked.joint)
    if work_doubtful:
        why += (
            f"; no work and no curve: the networks predict a work of "
            f"{answers.work_to_pull_off[0]:.4g}, the independent second ones "
            f"{10 ** tests.second[1][0]:.4g}; the force may have two maxima of about the same "
            "height"
        )
        return replace(found, work_to_pull_off=None, work_interval=None, joint=False, why=why)
    return with_curve(found, learned.curves(tests, answers), held.curve[0], held.travel[0])


def further_prediction(
    asked: Question, further: Beyond | None, method: str, out: str
) -> Prediction:
    """Return an extrapolation as a prediction, with the inputs that are out of range in words.

    Raises
    ------
    OutOfRange
        If there is none, or the surrogate is not certain at the limit of its range.
    """
    if further is None:
        raise OutOfRange(out)
    if not further.certain:
        raise Uncertain(f"{out}; the networks of the {method} are not certain at that limit")
    why = f"{out}; {further.why}"
    force, work = further.numbers.T.tolist()
    found = _prediction(asked, force, work, method, why)
    work = {} if further.with_work else {"work_to_pull_off": None, "work_interval": None}
    return replace(found, inside=False, **work)


def _prediction(
    asked: Question, force: Sequence[float], work: Sequence[float], method: str, why: str
) -> Prediction:
    """Return a prediction from force and work, each with the ends of its interval around it."""
    low, value, high = map(float, force)
    least, middle, most = map(float, work)
    return Prediction(
        pull_off_force=value,
        interval=(low, high),
        work_to_pull_off=middle,
        work_interval=(least, most),
        confidence=asked.confidence,
        band=MEASURED,
        method=method,
        inside=True,
        why=why,
        problem=asked.problem,
    )
