"""What a prediction says, and how it is written down: a record that needs no simulation.

Force positive in compression, depth positive into the solid; numbers are dimensionless as in
:class:`viscotack.Result`, :func:`prediction_summary` has them in SI as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack import __version__
from viscotack.problem import Groups, Problem
from viscotack.problem.outputs import REVOLUTION
from viscotack.problem.record import run_id, to_dict

if TYPE_CHECKING:
    from viscotack.surrogate.model import Curves

MEASURED, NOT_MEASURED = "measured", "not measured"
# An observable in the same unit as what is none.
_MEASURED_LIKE = {"zero_force_depth": "pull_off_depth"}


@dataclass(frozen=True, eq=False)
class Prediction:
    """How hard one must pull, as far as it is known without simulating.

    Attributes
    ----------
    value : float
        Pull-off force [1.5 pi R dg0], positive.
    interval : tuple of float
        Between which the simulated force lies with that confidence, same unit. Where a fitted
        theory answers and its band was not measured: between the slowest and the fastest pull-off
        of such a contact from any relaxed start.
    work_to_pull_off : float or None
        [1.5 pi R dg0 h0]; None where a theory answers, which has none.
    work_interval : tuple of float, or None
        The same for the work.
    confidence : float or None
        Part of the cases that the intervals held where they were measured; None where they were
        not.
    band : str
        "measured" where it was measured how many cases the intervals hold, else "not measured".
    method : str
        "surrogate", "surrogate of solids", or the theory's name as in :class:`viscotack.Estimate`.
    inside : bool
        Whether the problem lies in the range that the surrogate learned from.
    why : str
        A sentence; when not inside, which input is out, its value and the range, and whether the
        theory's interval was measured elsewhere.
    curve : Curves or None
        `depth` [h0], `force` [1.5 pi R dg0] and `contact_radius` [(pi R^2 dg0/E0*)^(1/3)] along the
        retraction, shape (24,) each; the last point is the pull-off. None where a theory answers.
    curve_band : float or None
        How far the force in tension is off at worst, at the same travel from zero force (or from a
        start in tension), with that confidence [1.5 pi R dg0]; None without a curve.
    zero_force_depth : float or None
        Depth at which the force of a pressed start is zero [h0]; None for starts in tension, and
        without a curve.
    zero_force_interval : tuple of float, or None
        Between which it lies with that confidence [h0].
    problem : Problem or Groups
        What was asked.
    """

    value: float
    interval: tuple[float, float]
    work_to_pull_off: float | None
    work_interval: tuple[float, float] | None
    confidence: float | None
    band: str
    method: str
    inside: bool
    why: str
    curve: Curves | None
    curve_band: float | None
    problem: Problem | Groups
    zero_force_depth: float | None = None
    zero_force_interval: tuple[float, float] | None = None


def prediction_summary(prediction: Prediction) -> dict[str, Any]:
    """Return a prediction ready for JSON, with the names of :func:`viscotack.summary`.

    Dimensionless; for a problem in SI the same names with a unit in addition. What the method
    does not know is None. `interval` is that of the pull-off force, `work_interval` that of the
    work to pull-off.
    """
    problem, curve = prediction.problem, prediction.curve
    values: dict[str, Any] = {
        "pull_off_force": prediction.value,
        "work_to_pull_off": prediction.work_to_pull_off,
        "pull_off_depth": None if curve is None else float(curve.depth[-1]),
        "zero_force_depth": prediction.zero_force_depth,
        "contact_radius_at_pull_off": None if curve is None else _known(curve.contact_radius[-1]),
    }
    intervals = {
        "interval": (prediction.interval, "pull_off_force"),
        "work_interval": (prediction.work_interval, "work_to_pull_off"),
        "zero_force_interval": (prediction.zero_force_interval, "pull_off_depth"),
    }
    answer = {name: None if pair is None else list(pair) for name, (pair, _) in intervals.items()}
    answer = values | answer
    if (scales := problem.scales()) is not None:
        for name, value in values.items():
            unit = REVOLUTION.observables[_MEASURED_LIKE.get(name, name)].unit
            scale = getattr(scales, unit.scale)
            answer[f"{name}_{unit.tail}"] = None if value is None else value * scale
        for name, (pair, of) in intervals.items():
            unit = REVOLUTION.observables[of].unit
            scale = getattr(scales, unit.scale)
            answer[f"{name}_{unit.tail}"] = None if pair is None else [x * scale for x in pair]
    groups = problem.groups()
    return answer | {
        "method": prediction.method,
        "inside": prediction.inside,
        "confidence": prediction.confidence,
        "band": prediction.band,
        "curve_band": prediction.curve_band,
        "why": prediction.why,
        **groups.inputs,
        "problem": to_dict(problem),
        "run_id": run_id(problem),
        "versions": {"viscotack": __version__},
    }


def _known(number: Any) -> float | None:
    return float(number) if np.isfinite(number) else None
