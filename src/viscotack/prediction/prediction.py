"""Predictions and their records.

Force is positive in compression, depth positive into the solid. Numbers are dimensionless as in
:class:`viscotack.Result`; :func:`prediction_summary` adds SI units.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack.arrays import Array
from viscotack.model.problem import Case
from viscotack.model.problem.case_file import run_id, to_dict
from viscotack.result.curve import PRESSED
from viscotack.units import readable, readable_interval
from viscotack.version import __version__

if TYPE_CHECKING:
    from viscotack.prediction.surrogate.line import Curves

    from .tier import Question

MEASURED, NOT_MEASURED = "measured", "not measured"
# Fraction of cases inside the bands of theories and the stated errors of simulations.
THEORY_CONFIDENCE = 0.9


@dataclass(frozen=True, eq=False, repr=False)
class Prediction:
    """Predicted pull-off force, work and unloading curve, with intervals.

    Attributes
    ----------
    pull_off_force : float
        Largest tension of the retraction [1.5 pi R dg0], positive; of a punch the pull-off stress
        [sigma0].
    interval : tuple of float
        Interval of the simulated force with this confidence, same unit.
    work_to_pull_off : float or None
        [1.5 pi R dg0 h0], for a punch per unit area [dg0]; None for most theories, which do not
        predict it.
    work_interval : tuple of float, or None
        Interval of the work with this confidence.
    confidence : float or None
        Fraction of cases inside the intervals, as measured; None if it was not measured.
    band : str
        "measured" if the coverage of the intervals was measured, otherwise "not measured".
    method : str
        Name of the tier: "surrogate", "surrogate of solids", "surrogate of punches", "learned crack
        contact", the name of a theory as in :class:`viscotack.Estimate`, or "simulation".
    inside : bool
        Whether the problem is in the training range of the surrogate; true for a simulation.
    why : str
        Reason; outside the range, the input that is out, its value and the range.
    curve : Curves or None
        `depth` [h0], `force` [1.5 pi R dg0] and `contact_radius` [(pi R^2 dg0/E0*)^(1/3)] along the
        retraction, shape (24,) each; for a punch, as in a :class:`viscotack.Result`, mean stress
        [sigma0], compression positive, and half length of the contact [a0]. The last point is the
        pull-off. None for theories.
    curve_band : float or None
        Largest error of the tensile force at the same travel from zero force (or from a
        start in tension), with this confidence [1.5 pi R dg0]; None without a curve, and for a
        simulation.
    zero_force_depth : float or None
        Depth at which the force of a compressed start is zero [h0]; None for starts in tension, and
        without a curve.
    zero_force_interval : tuple of float, or None
        Interval of this depth with this confidence [h0].
    depth_interval : tuple of float, or None
        Interval of the depth at pull-off, the last one of the curve [h0]; None without a curve.
    problem : Problem or Groups
        The problem of the prediction.
    joint : bool
        Whether force, work and curve are inside together with this confidence, not each alone.
    warn : callable
        Finds the `cautions`.
    """

    pull_off_force: float
    interval: tuple[float, float]
    method: str
    inside: bool
    why: str
    problem: Case
    confidence: float | None
    band: str
    work_to_pull_off: float | None = None
    work_interval: tuple[float, float] | None = None
    curve: Curves | None = None
    curve_band: float | None = None
    zero_force_depth: float | None = None
    zero_force_interval: tuple[float, float] | None = None
    depth_interval: tuple[float, float] | None = None
    joint: bool = False
    # made for each, because a class as the default would be a member of this one
    warn: Callable[[], tuple[str, ...]] = field(
        default_factory=lambda: tuple, repr=False, compare=False
    )

    def __repr__(self) -> str:
        unit = next(iter(self.problem.outputs.observables.values())).unit
        scales = self.problem.scales()
        factor = 1.0 if scales is None else getattr(scales, unit.scale)
        low, high = (factor * x for x in self.interval)
        si, more = ("1", f" x {unit.text}") if scales is None else (unit.si, "")
        value = readable(factor * self.pull_off_force, si)
        interval = readable_interval(low, high, si)
        return f"<Prediction by the {self.method}: {value} ({interval}){more}>"

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        from viscotack.plot.notebook import html_of_prediction

        return html_of_prediction(self)

    @property
    def pull_off_stress(self) -> float:
        """Pull-off stress of a punch [sigma0], equal to `pull_off_force`."""
        self.problem.outputs.check_has("pull_off_stress")
        return self.pull_off_force

    @property
    def depth_at_pull_off(self) -> float | None:
        """Depth at pull-off [h0], positive into the solid; None for theories."""
        return None if self.curve is None else float(self.curve.depth[-1])

    @cached_property
    def cautions(self) -> tuple[str, ...]:
        """Sentences of :func:`.cautions_on`, if :func:`viscotack.predict` asked.

        They are found on first use: theories take up to a second for a new solid.
        """
        return self.warn()

    def because(self, why: str) -> Prediction:
        """Prepend the reason why no better tier applies."""
        return replace(self, why=f"{why}; {self.why}")


def with_curve(found: Prediction, curves: Curves, band: float, travel: Array) -> Prediction:
    """Add the first of several curves to a prediction, with its intervals.

    Parameters
    ----------
    found : Prediction
    curves : Curves
    band : float
        Largest error of tensile forces over the pull-off force.
    travel : ndarray, shape (2,)
        Interval of the travel from a compressed start to zero force, relative to that of the curve.
    """
    depth = curves.depth[0]
    found = replace(
        found,
        curve=type(curves)(depth, curves.force[0], curves.contact_radius[0]),
        curve_band=float(band * found.pull_off_force),
    )
    if curves.force[0, 0] > 0:
        least, most = depth[0] - travel[::-1] * (depth[0] - depth[PRESSED])
        found = replace(
            found,
            zero_force_depth=float(depth[PRESSED]),
            zero_force_interval=(float(least), float(most)),
        )
    return replace(found, depth_interval=depth_between(found))


def depth_between(found: Prediction) -> tuple[float, float] | None:
    r"""Return the interval of the depth at pull-off [h0]; None without a curve.

    The force is flat there, so an error :math:`\Delta W` of the work corresponds to an error
    :math:`\Delta W/P` of the depth. The error of the depth at zero force and that of the curve over
    the travel from there are added in quadrature.
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
    """Return the prediction of a theory: a force with its relative band, without a curve."""
    if asked.confidence != THEORY_CONFIDENCE:
        why += (
            f"; its band includes {THEORY_CONFIDENCE:.0%} of the cases, not {asked.confidence:.0%}"
        )
    return Prediction(
        pull_off_force=force,
        interval=(force * (1 - band), force * (1 + band)),
        work_to_pull_off=work,
        confidence=THEORY_CONFIDENCE,
        band=MEASURED,
        method=method,
        inside=inside,
        why=why,
        problem=asked.problem,
    )


def prediction_summary(prediction: Prediction) -> dict[str, Any]:
    """Convert a prediction to a JSON record with the names of :func:`viscotack.summary`.

    Numbers are dimensionless; for a problem in SI they are repeated under names that end in the
    unit. Unknown values are None. `interval` belongs to the pull-off force, `work_interval` to the
    work to pull-off.

    Parameters
    ----------
    prediction : Prediction
        Answer of :func:`viscotack.predict`.

    Returns
    -------
    dict
        Numbers, texts, lists and None.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, RetardationPowerLaw, predict
    >>> material = RetardationPowerLaw(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> case = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=316.23)
    >>> record = prediction_summary(predict(case))
    >>> f"{record['pull_off_force']:.1f} by {record['method']}, inside: {record['inside']}"
    '7.3 by surrogate, inside: True'
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
        "cautions": list(prediction.cautions),
        **groups.inputs,
        "problem": to_dict(problem),
        "run_id": run_id(problem),
        "versions": {"viscotack": __version__},
    }


def _known(number: Any) -> float | None:
    return float(number) if np.isfinite(number) else None
