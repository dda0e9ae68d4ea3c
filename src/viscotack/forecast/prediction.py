"""What a prediction says, and how it is written down: a record that needs no simulation.

Force positive in compression, depth positive into the solid; numbers are dimensionless as in
:class:`viscotack.Result`, :func:`prediction_summary` has them in SI as well.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack.problem import Case
from viscotack.problem.record import run_id, to_dict
from viscotack.renamed import Renamed
from viscotack.result.trajectory import PRESSED
from viscotack.version import __version__

if TYPE_CHECKING:
    from viscotack.surrogate.answers import Intervals
    from viscotack.surrogate.line import Curves

    from .question import Question

MEASURED, NOT_MEASURED = "measured", "not measured"
# Part of the cases that the bands of theories and the stated errors of simulations hold.
THEORY_CONFIDENCE = 0.9


@dataclass(frozen=True, eq=False)
class Prediction:
    """How hard one must pull, as far as it is known without simulating.

    Attributes
    ----------
    pull_off_force : float
        Largest tension of the retraction [1.5 pi R dg0], positive; of a punch the pull-off stress
        [sigma0].
    interval : tuple of float
        Between which the simulated force lies with that confidence, same unit.
    work_to_pull_off : float or None
        [1.5 pi R dg0 h0], of a punch that of unit area [dg0]; None where a theory answers, which
        has none.
    work_interval : tuple of float, or None
        The same for the work.
    confidence : float or None
        Part of the cases that the intervals held where they were measured; None where they were
        not.
    band : str
        "measured" where it was measured how many cases the intervals hold, else "not measured".
    method : str
        Name of the tier: "surrogate", "surrogate of solids", "surrogate of punches", "learned crack
        contact", the name of a theory as in :class:`viscotack.Estimate`, or "simulation".
    inside : bool
        Whether the problem lies in the range that the surrogate learned from; of a simulation true.
    why : str
        A sentence; when not inside, which input is out, its value and the range.
    curve : Curves or None
        `depth` [h0], `force` [1.5 pi R dg0] and `contact_radius` [(pi R^2 dg0/E0*)^(1/3)] along the
        retraction, shape (24,) each; of a punch, as in a :class:`viscotack.Result`, mean stress
        [sigma0], compression positive, and half length of the contact [a0]. The last point is the
        pull-off. None where a theory answers.
    curve_band : float or None
        How far the force in tension is off at worst, at the same travel from zero force (or from a
        start in tension), with that confidence [1.5 pi R dg0]; None without a curve, and of a
        simulation.
    zero_force_depth : float or None
        Depth at which the force of a pressed start is zero [h0]; None for starts in tension, and
        without a curve.
    zero_force_interval : tuple of float, or None
        Between which it lies with that confidence [h0].
    depth_interval : tuple of float, or None
        Between which the depth at pull-off, the last of the curve, lies [h0]; None without a curve.
    problem : Problem or Groups
        What was asked.
    """

    pull_off_force: float
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
    problem: Case
    zero_force_depth: float | None = None
    zero_force_interval: tuple[float, float] | None = None
    depth_interval: tuple[float, float] | None = None

    value = Renamed("pull_off_force")

    @property
    def pull_off_stress(self) -> float:
        """The `pull_off_force` of a punch [sigma0]."""
        self.problem.outputs.check_has("pull_off_stress")
        return self.pull_off_force

    @property
    def depth_at_pull_off(self) -> float | None:
        """Depth at the pull-off [h0], positive into the solid; None where a theory answers."""
        return None if self.curve is None else float(self.curve.depth[-1])

    def because(self, why: str) -> Prediction:
        """Return the prediction with the reason why no better tier answers, before its own."""
        return replace(self, why=f"{why}; {self.why}")


def with_curve(found: Prediction, curves: Curves, held: Intervals) -> Prediction:
    """Return a prediction with its curve, the first of several, and how well it is known."""
    depth = curves.depth[0]
    found = replace(
        found,
        curve=type(curves)(depth, curves.force[0], curves.contact_radius[0]),
        curve_band=float(held.curve[0] * found.pull_off_force),
    )
    if curves.force[0, 0] > 0:
        least, most = depth[0] - held.travel[0, ::-1] * (depth[0] - depth[PRESSED])
        found = replace(
            found,
            zero_force_depth=float(depth[PRESSED]),
            zero_force_interval=(float(least), float(most)),
        )
    return replace(found, depth_interval=depth_between(found))


def depth_between(found: Prediction) -> tuple[float, float] | None:
    r"""Return between which the depth at pull-off lies [h0]; None where there is no curve.

    The force is flat there, so that an error :math:`\Delta W` of the work is one of the place where
    it ends, :math:`\Delta W/P`. To that come, in quadrature, the error of the depth at zero force,
    and that of the curve over the travel from there (`benchmarks/depth_interval.py`).
    """
    curve, work = found.curve, found.work_to_pull_off
    if curve is None or found.curve_band is None or work is None or found.work_interval is None:
        return None
    depth, begin = float(curve.depth[-1]), float(curve.depth[0])
    groups = found.problem.groups()
    force = found.pull_off_force * groups.outputs.energy_factor(groups)
    down, up = ((end - work) / force for end in reversed(found.work_interval))
    least = most = 0.0
    if found.zero_force_interval is not None and found.zero_force_depth is not None:
        begin = found.zero_force_depth
        least, most = (end - begin for end in found.zero_force_interval)
    bent = found.curve_band / found.pull_off_force * (begin - depth)
    low, high = (float(np.linalg.norm(x)) for x in ((down, least, bent), (up, most, bent)))
    return depth - low, depth + high


def of_theory(
    asked: Question,
    force: float,
    band: float,
    method: str,
    why: str,
    *,
    inside: bool = False,
    work: float | None = None,
) -> Prediction:
    """Return the prediction of a theory: a force and its relative band, no curve."""
    if asked.confidence != THEORY_CONFIDENCE:
        why += (
            f"; its band is one for {THEORY_CONFIDENCE:.0%} of the cases, "
            f"not {asked.confidence:.0%}"
        )
    return Prediction(
        pull_off_force=force,
        interval=(force * (1 - band), force * (1 + band)),
        work_to_pull_off=work,
        work_interval=None,
        confidence=THEORY_CONFIDENCE,
        band=MEASURED,
        method=method,
        inside=inside,
        why=why,
        curve=None,
        curve_band=None,
        problem=asked.problem,
    )


def prediction_summary(prediction: Prediction) -> dict[str, Any]:
    """Return a prediction ready for JSON, with the names of :func:`viscotack.summary`.

    Dimensionless; for a problem in SI the same names with a unit in addition. What the method
    does not know is None. `interval` is that of the pull-off force, `work_interval` that of the
    work to pull-off.
    """
    problem, curve = prediction.problem, prediction.curve
    groups = problem.groups()
    kind = groups.outputs
    force, edge = kind.name_of("force"), kind.name_of("contact_radius")
    pull_off, at_pull_off = f"pull_off_{force}", f"{edge}_at_pull_off"
    ended = None if curve is None else curve.contact_radius[-1] * kind.series[edge].factor(groups)
    values: dict[str, Any] = {
        pull_off: prediction.pull_off_force,
        "work_to_pull_off": prediction.work_to_pull_off,
        "depth_at_pull_off": prediction.depth_at_pull_off,
        f"zero_{force}_depth": prediction.zero_force_depth,
        at_pull_off: None if ended is None else _known(ended),
    }
    intervals = {
        "interval": (prediction.interval, pull_off),
        "work_interval": (prediction.work_interval, "work_to_pull_off"),
        f"zero_{force}_interval": (prediction.zero_force_interval, "depth_at_pull_off"),
        "depth_interval": (prediction.depth_interval, "depth_at_pull_off"),
    }
    answer = {name: None if pair is None else list(pair) for name, (pair, _) in intervals.items()}
    answer = values | answer
    if (scales := problem.scales()) is not None:
        for name, value in values.items():
            like = "depth_at_pull_off" if name == f"zero_{force}_depth" else name
            unit = kind.observables[like].unit
            scale = getattr(scales, unit.scale)
            answer[f"{name}_{unit.tail}"] = None if value is None else value * scale
        for name, (pair, of) in intervals.items():
            unit = kind.observables[of].unit
            scale = getattr(scales, unit.scale)
            answer[f"{name}_{unit.tail}"] = None if pair is None else [x * scale for x in pair]
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
