"""What a theory says of a problem that was not learned, and where its band was measured."""

from __future__ import annotations

import numpy as np

from viscotack.bem.by_crack import METHOD, crack_contact
from viscotack.errors import InputError, OutOfRange
from viscotack.materials import RetardationPowerLaw, StandardSolid
from viscotack.problem import Groups, Problem
from viscotack.protocol import AtDepth, AtForce, AtRadius
from viscotack.theory import hertz
from viscotack.traction import LennardJones, effective_range, softening

from .advice import Estimate, advise, lennard_jones_alike
from .prediction import Prediction

SIMULATE = "`viscotack simulate` answers it"
# Largest start that the theories are asked about, a radius in (pi R^2 dg0/E0*)^(1/3): their curves
# are traced from there on.
_LARGEST_START = 300.0
# The bands of the theories were measured to hold this part of the cases, of power laws and standard
# solids in these ranges (`viscotack.forecast.advice` and `benchmarks/rate_law.py`); rate in
# h0/tau0.
THEORY_CONFIDENCE = 0.9
_MEASURED = {
    "tabor": (0.3, 8.0),
    "modulus_ratio": (1e-3, 0.3),
    "exponent": (0.3, 1.6),
    "rate": (0.1, 1e8),
}


# Other laws: effective range, and the steepest fall of the tension [strength^2/work].
_MEASURED_LAWS = {"effective range": (0.69, 8.4), "steepest fall": (0.76, 6.7)}


def by_theory(problem: Problem | Groups, groups: Groups, out: str, confidence: float) -> Prediction:
    """Return what the best of the theories says of a problem that was not learned.

    Parameters
    ----------
    problem : Problem or Groups
        As it was asked.
    groups : Groups
        Of the problem.
    out : str
        Why it was not learned, in words.
    confidence : float
        That was asked for; the bands of the theories have one of their own.

    Raises
    ------
    OutOfRange
        If no theory applies.
    ValueError
        If there is no relaxed contact to pull off.
    """
    from viscotack.campaign.columns import has_relaxed_contact

    if (radius := _start_radius(groups)) > _LARGEST_START:
        raise OutOfRange(
            f"{out}; the start is a contact of radius {radius:.4g} (pi R^2 dg0/E0*)^(1/3), and the "
            f"theories are asked up to {_LARGEST_START:g}; {SIMULATE}"
        )
    if not has_relaxed_contact(groups):
        raise InputError(
            f"there is no contact to pull off: no relaxed one exists at {groups.start}"
        )
    try:
        best = _best(advise(groups).estimates)
    except OverflowError:
        raise OutOfRange(f"{out}; no theory reaches that far; {SIMULATE}") from None
    if best is None:
        raise OutOfRange(f"{out}; no theory applies either; {SIMULATE}")
    force, error = best.pull_off_force, best.error
    assert force is not None and error is not None
    why = f"{out}; by the theory {best.tier!r}: {best.why}"
    if confidence != THEORY_CONFIDENCE:
        why += f"; its band is one for {THEORY_CONFIDENCE:.0%} of the cases, not {confidence:.0%}"
    if best.tier != METHOD and (elsewhere := _not_measured(groups)):
        why += f"; its band was measured elsewhere, and is not known to hold here: {elsewhere}"
    return Prediction(
        value=force,
        interval=(force * (1 - error), force * (1 + error)),
        work_to_pull_off=None,
        work_interval=None,
        confidence=THEORY_CONFIDENCE,
        method=best.tier,
        inside=False,
        why=why,
        curve=None,
        problem=problem,
    )


def by_crack(problem: Problem | Groups, out: str) -> Prediction:
    """Return what a contact says whose edge is a steady crack, for other tests and shapes.

    Raises
    ------
    OutOfRange
        If the theory does not hold there.
    """
    try:
        found = crack_contact(problem)
    except InputError as error:
        words = f"{out}, and the theory of a crack at the edge has no answer: {error}"
        raise type(error)(words) from None
    if found.pull_off_force is None or found.interval is None:
        raise OutOfRange(f"{out}, and by the theory of a crack at the edge it comes to no pull-off")
    return Prediction(
        value=found.pull_off_force,
        interval=found.interval,
        work_to_pull_off=found.work_to_pull_off,
        work_interval=None,
        confidence=THEORY_CONFIDENCE,
        method=METHOD,
        inside=False,
        why=f"{out}; by the theory {METHOD!r}: {found.why}",
        curve=None,
        problem=problem,
    )


def _not_measured(groups: Groups) -> str:
    """Return in words where a problem is outside of what the bands were measured on, or ""."""
    material = groups.material
    if not isinstance(material, RetardationPowerLaw | StandardSolid):
        return f"for power laws and standard solids, not {type(material).__name__}"
    alike = lennard_jones_alike(groups)
    assert alike.rate is not None, "checked at the door"
    values = {"tabor": alike.tabor, "modulus_ratio": groups.modulus_ratio}
    if isinstance(material, RetardationPowerLaw):
        values["exponent"] = material.exponent
    values["rate"] = alike.rate * material.time_unit
    if not isinstance(groups.traction, LennardJones):
        values["effective range"] = effective_range(groups.traction)
        values["steepest fall"] = softening(groups.traction)
    found = []
    for name, value in values.items():
        least, most = (_MEASURED | _MEASURED_LAWS)[name]
        # the ends themselves, whichever way they were rounded
        if not least * (1 - 1e-9) <= value <= most * (1 + 1e-9):
            found.append(f"{name} {least:g} to {most:g}, not {value:.4g}")
    return "for " + ", ".join(found) if found else ""


def _start_radius(groups: Groups) -> float:
    """Return the radius of the start without adhesion [(pi R^2 dg0/E0*)^(1/3)]."""
    start = groups.start
    match start:
        case AtRadius():
            return start.contact_radius
        case AtForce():
            load = 1.5 * np.pi * max(start.force, 0.0)
            radius = hertz.contact_radius_at_force(load, radius=1.0, contact_modulus=1.0)
        case AtDepth():
            depth = max(start.depth, 0.0) / groups.tabor  # R = E0* = dg0 = 1, so that h0 = 1/mu
            radius = hertz.contact_radius_at_depth(depth, radius=1.0)
    return float(radius / np.pi ** (1 / 3))


def _best(estimates: tuple[Estimate, ...]) -> Estimate | None:
    """Return the theory that applies with the smallest error, if any does."""
    good = [(e.error, i) for i, e in enumerate(estimates) if _answers(e) and e.error is not None]
    return estimates[min(good)[1]] if good else None


def _answers(estimate: Estimate) -> bool:
    return estimate.applies and estimate.pull_off_force is not None
