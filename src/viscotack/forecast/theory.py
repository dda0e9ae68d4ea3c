"""What a theory says of a problem that was not learned, and where its band was measured."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from viscotack.bem.by_crack import METHOD, crack_contact
from viscotack.bem.crack_band import ELSEWHERE, band_parts, not_measured, outside
from viscotack.errors import InputError, OutOfRange
from viscotack.materials import RetardationPowerLaw, StandardSolid
from viscotack.problem import Case, Groups, PunchGroups
from viscotack.protocol import AtDepth, AtForce, AtRadius
from viscotack.theory import hertz, lennard_jones
from viscotack.traction import LennardJones, effective_range, softening

from .advice import Estimate, advise, lennard_jones_alike
from .prediction import MEASURED, NOT_MEASURED, Prediction

if TYPE_CHECKING:
    from viscotack.surrogate.short_range import Said

# The learned theory of a crack at the edge, by name.
LEARNED = "learned crack contact"
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


# What the slowest and the fastest pull-off are known to, with Lennard-Jones and with other laws.
_BOUND_ERROR, _OTHER_BOUND_ERROR = 0.005, 0.05
# Other laws: effective range, and the steepest fall of the tension [strength^2/work].
_MEASURED_LAWS = {"effective range": (0.69, 8.4), "steepest fall": (0.76, 6.7)}


def by_theory(problem: Case, groups: Groups, out: str, confidence: float) -> Prediction:
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
    interval = (force * (1 - error), force * (1 + error))
    crack = best.tier == METHOD
    if elsewhere := (not_measured(groups) if crack else _not_measured(groups)):
        why += f"; its band of {error:.2g} of the force {ELSEWHERE}{elsewhere}"
        if not crack:
            interval = _bounds(groups, force)
            why += (
                "; the interval is that from the slowest to the fastest pull-off of such a contact"
            )
    return _without_curve(problem, force, interval, best.tier, why, confidence, not elsewhere)


def by_learned_theory(
    problem: Case, groups: Groups, said: Said, error: float, out: str, confidence: float
) -> Prediction:
    """Return what the learned theory of a crack at the edge says of a case in its range.

    Parameters
    ----------
    problem : Problem or Groups
        As it was asked.
    groups : Groups
        Of the problem.
    said : Said
        Of this case alone.
    error : float
        Part of the force by which what was learned differs from the theory in 9 of 10 cases.
    out : str
        Why the surrogate of simulations was not asked, in words.
    confidence : float
        That was asked for.
    """
    force, zones = float(said.pull_off_force[0]), float(said.zones[0])
    energy, effective = float(said.amplification[0]), float(said.effective[0])
    band = error + sum(map(float, band_parts(energy, effective, zones)))
    why = (
        f"{out}; learned from the theory {METHOD!r}, from which it differs by {error:.2%}: "
        f"effective Tabor number {effective:.3g}, way of {zones:.3g} zones to the pull-off"
    )
    if elsewhere := not_measured(groups):
        why += f"; its band of {band:.2g} of the force {ELSEWHERE}{elsewhere}"
    interval = (force * (1 - band), force * (1 + band))
    return _without_curve(
        problem, force, interval, LEARNED, why, confidence, not elsewhere, inside=True
    )


def _without_curve(
    problem: Case,
    force: float,
    interval: tuple[float, float],
    method: str,
    why: str,
    confidence: float,
    measured: bool,
    *,
    inside: bool = False,
    work: float | None = None,
) -> Prediction:
    """Return the answer of a theory."""
    if measured and confidence != THEORY_CONFIDENCE:
        why += f"; its band is one for {THEORY_CONFIDENCE:.0%} of the cases, not {confidence:.0%}"
    return Prediction(
        value=force,
        interval=interval,
        work_to_pull_off=work,
        work_interval=None,
        confidence=THEORY_CONFIDENCE if measured else None,
        band=MEASURED if measured else NOT_MEASURED,
        method=method,
        inside=inside,
        why=why,
        curve=None,
        curve_band=None,
        problem=problem,
    )


def _bounds(groups: Groups, force: float) -> tuple[float, float]:
    """Return the slowest and the fastest pull-off of a contact from any relaxed start."""
    alike = lennard_jones_alike(groups)
    mu, k = alike.tabor, alike.modulus_ratio
    low, high = (
        float(np.asarray(lennard_jones.pull_off_ratio(mu * ratio ** (1 / 3)))) / ratio
        for ratio in (1.0, k)
    )
    wider = _BOUND_ERROR if isinstance(groups.traction, LennardJones) else _OTHER_BOUND_ERROR
    return min(low * (1 - wider), force), max(high * (1 + wider), force)


def by_crack(problem: Case, out: str) -> Prediction:
    """Return what a contact says whose edge is a steady crack, for other tests and shapes.

    Raises
    ------
    OutOfRange
        If the theory does not hold there.
    """
    assert not isinstance(problem, PunchGroups), "punches are answered elsewhere"
    try:
        found = crack_contact(problem)
    except InputError as error:
        words = f"{out}, and the theory of a crack at the edge has no answer: {error}"
        raise OutOfRange(words) from None
    if found.pull_off_force is None or found.interval is None:
        raise OutOfRange(f"{out}, and by the theory of a crack at the edge it comes to no pull-off")
    why = f"{out}; by the theory {METHOD!r}: {found.why}"
    return _without_curve(
        problem,
        found.pull_off_force,
        found.interval,
        METHOD,
        why,
        THEORY_CONFIDENCE,
        found.inside,
        work=found.work_to_pull_off,
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
    return outside(values, _MEASURED | _MEASURED_LAWS)


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
