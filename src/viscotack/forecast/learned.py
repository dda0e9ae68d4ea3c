"""Surrogates of spheres as tiers: power laws, other solids, and large Tabor numbers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import TYPE_CHECKING

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import OutOfRange
from viscotack.geometry import HalfSpace, Sphere
from viscotack.materials import RetardationPowerLaw
from viscotack.methods.crack_band import curve_bands, not_measured
from viscotack.problem import Case, Groups
from viscotack.protocol import AtDepth, AtForce, AtRadius
from viscotack.surrogate.answers import Intervals
from viscotack.theory.elastic.lennard_jones import pull_off_ratio
from viscotack.theory.elastic.relaxed import contact_in_groups
from viscotack.traction import LennardJones

from .allow_list import ANY, Verified
from .beyond import Beyond, beyond
from .equivalent_power_law import alike_words, like_of, unlike_words
from .prediction import MEASURED, Prediction, of_theory, with_curve
from .question import Question
from .training_range import out_of_range

if TYPE_CHECKING:
    from viscotack.surrogate.alike import Alike
    from viscotack.surrogate.answers import Answers
    from viscotack.surrogate.contact import Contact
    from viscotack.surrogate.model import Surrogate
    from viscotack.surrogate.short_range import ShortRangeContact


SURROGATE, SOLIDS, LEARNED_CRACK = "surrogate", "surrogate of solids", "learned crack contact"
POWER_LAWS = Verified(
    shapes=(Sphere,),
    bodies=(HalfSpace,),
    laws=(LennardJones,),
    solids=(RetardationPowerLaw,),
    starts=(AtDepth, AtForce, AtRadius),
)
# Any linear solid: its creep is compared with that of the training data.
OTHER_SOLIDS = replace(POWER_LAWS, solids=ANY)
INSIDE = "every input is in the training range"
# Tabor number from which the theory of the crack is used as it is.
_FADED = 20.0
# Times of the modes that lag, in h0 over the speed, and their tolerance; the longest lag over the
# smallest rate up to which the excess of the force is nearly proportional to it, and the part of
# the excess that depends on the spectrum.
_SHORTEST, _LONGEST, _TOLERANCE = 1e-9, 1e3, 1e-6
_MOST_LAG, _OF_SPECTRUM, _ROUNDED = 5.0, 0.1, 1e-6
# Units of the inputs with units.
_UNITS = {"preload": "h0", "rate": "h0/tau0"}


@dataclass(frozen=True, eq=False)
class Inputs:
    """Inputs of the surrogates of spheres, and those out of range.

    Attributes
    ----------
    rows : ndarray, shape (1, 5)
        The groups; for another solid those of its equivalent power law.
    out : tuple of str
        Inputs out of range, in words.
    like : Alike or None
        Equivalent power law of a solid that is not a power law by retardation.
    """

    rows: Array
    out: tuple[str, ...]
    like: Alike | None = None


def inputs_of_sphere(asked: Question) -> Inputs:
    """Return the inputs of the surrogates for a sphere on the allow-list."""
    groups, learned = asked.groups, _learned()
    material = groups.material
    row, known = np.full(len(learned.limits), np.nan), list(learned.limits)
    row[:2] = groups.tabor, groups.modulus_ratio
    assert groups.rate is not None, "checked by the allow-list"
    if isinstance(material, RetardationPowerLaw):
        row[[2, 4]] = material.exponent, groups.rate * material.tau0
    else:
        # the other inputs are those of the equivalent power law
        known = ["tabor", "modulus_ratio", "preload"]
    no_start = ""
    # the depth of a start by force or radius is defined if the Tabor number is in range
    if isinstance(groups.start, AtDepth) or learned.inside([row])[0, 0]:
        try:
            row[3] = _start_depth(groups, learned)
        except ValueError as error:
            no_start = str(error)
    out = []
    for (name, limits), value, inside in zip(
        learned.limits.items(), row.tolist(), learned.inside([row])[0], strict=True
    ):
        if name not in known:
            continue
        if np.isnan(value):
            out.append(no_start)
        elif not inside:
            out.append(_out_words(name, value, limits, asked.problem))
    out = tuple(words for words in out if words)
    if isinstance(material, RetardationPowerLaw) or not np.isfinite(row[[0, 1, 3]]).all() or out:
        return Inputs(row[None], out)
    like = like_of(groups, float(row[3]))
    return Inputs(like.groups, tuple(unlike_words(like)), like)


# Power laws ----------------------------------------------------------------------------------


def power_law_limits(asked: Question) -> str:
    """List the inputs of a power law out of the range of the surrogate, or return ""."""
    out = asked.once(inputs_of_sphere).out
    further = asked.model is None and out and asked.once(_further) is not None
    return "" if further else "; ".join(out)


def by_power_laws(asked: Question) -> Prediction:
    """Evaluate the surrogate of power laws, including its extrapolation."""
    learned, inputs = asked.model or _learned(), asked.once(inputs_of_sphere)
    if not inputs.out:
        return within(asked, learned, learned.tests(inputs.rows), SURROGATE, INSIDE)
    further = asked.once(_further)
    assert further is not None, "checked by the limits"
    return further_prediction(asked, further, SURROGATE, "; ".join(inputs.out))


def further_prediction(asked: Question, further: Beyond, method: str, out: str) -> Prediction:
    """Return an extrapolation as a prediction, with the inputs that are out of range in words.

    Raises
    ------
    OutOfRange
        If the surrogate is not certain at the limit of its range.
    """
    if not further.certain:
        raise OutOfRange(f"{out}; the networks of the {method} are not certain at that limit")
    why = f"{out}; {further.why}"
    found = _prediction(asked, further.answers, further.intervals, method, why)
    work = {} if further.with_work else {"work_to_pull_off": None, "work_interval": None}
    return replace(found, inside=False, **work)


def _further(asked: Question) -> Beyond | None:
    """Return the extrapolation slightly beyond the range of the surrogate, or None."""
    rows = asked.once(inputs_of_sphere).rows
    return beyond(_learned(), rows, asked.confidence) if np.isfinite(rows).all() else None


# Other solids --------------------------------------------------------------------------------


def solid_limits(asked: Question) -> str:
    """List the inputs of a solid other than a power law out of range, or return ""."""
    if isinstance(asked.groups.material, RetardationPowerLaw):
        return f"power laws by retardation are covered by the tier {SURROGATE!r}"
    return "; ".join(asked.once(inputs_of_sphere).out)


def by_solids(asked: Question) -> Prediction:
    """Evaluate the surrogate of solids other than power laws by retardation.

    Raises
    ------
    OutOfRange
        If it is not certain.
    """
    from viscotack.surrogate import physics

    inputs, solids = asked.once(inputs_of_sphere), _learned("solids")
    assert inputs.like is not None, "checked by the limits"
    over = inputs.like.groups[0, physics.RATE] / physics.LIMITS["rate"][0]
    lag, variance = _lag(asked.groups) if over <= _MOST_LAG else (np.inf, 0.0)
    if lag <= _MOST_LAG * physics.LIMITS["rate"][0]:
        return _by_lag(asked, inputs.like.groups.copy(), lag, variance)
    if over <= 1 + _ROUNDED:
        raise OutOfRange(
            "the solid is slower than its equivalent power law: its mean retardation time is "
            f"{lag:.3g} h0 over the speed"
        )
    why = f"{INSIDE}; {alike_words(inputs.like)}"
    return within(asked, solids, solids.tests(inputs.like), SOLIDS, why)


def _lag(groups: Groups) -> tuple[float, float]:
    """Return the mean retardation time, in h0 over the speed, and its relative variance."""
    assert groups.rate is not None, "checked by the allow-list"
    modes = groups.material.retardation_modes(
        shortest=_SHORTEST / groups.rate, longest=_LONGEST / groups.rate, tolerance=_TOLERANCE
    )
    weights, times = np.array(modes.weights), groups.rate * np.array(modes.times)
    mean, square = (float(weights @ x) / (1 - groups.modulus_ratio) for x in (times, times**2))
    return mean, square / mean**2 - 1 if mean > 0 else 0.0


def _by_lag(asked: Question, rows: Array, lag: float, variance: float) -> Prediction:
    """Evaluate the surrogate of power laws for a solid that hardly lags behind the test.

    The force exceeds its slow limit in proportion to the mean retardation time, whatever the
    spectrum. The power law with the same mean and, as far as in the range, the same variance has
    nearly the same force.

    Raises
    ------
    OutOfRange
        If the surrogate is not certain.
    """
    from viscotack.surrogate import physics

    learned = _learned()
    # the retardation times of a power law have the mean n tau0, and a relative variance of 1/n
    n = float(np.clip(1 / max(variance, _ROUNDED), *physics.LIMITS["exponent"]))
    columns = [physics.MODULUS_RATIO, physics.EXPONENT, physics.RATE]
    rows[0, columns] = asked.groups.modulus_ratio, n, lag / n
    why = f"the solid is nearly relaxed: it lags behind by {lag:.3g} h0 over the speed"
    if lag / n >= physics.LIMITS["rate"][0]:
        found = within(asked, learned, learned.tests(rows), SOLIDS, f"{INSIDE}; {why}")
    else:
        further = beyond(learned, rows, asked.confidence)
        assert further is not None, "the other inputs are in the range"
        found = further_prediction(asked, further, SOLIDS, why)
    slow, (low, high) = float(pull_off_ratio(asked.groups.tabor)), found.interval
    wider = _OF_SPECTRUM * max(found.pull_off_force - slow, 0.0)
    return replace(found, interval=(max(low - wider, min(low, slow)), high + wider))


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
    OutOfRange
        If the force is uncertain: the second networks contradict it, or its interval is wide.
    """
    start, answers = asked.groups.start, learned.evaluate(tests)
    force_doubtful, work_doubtful = learned.doubtful(tests, answers)[0].tolist()
    if force_doubtful:
        force, end = (
            answers.pull_off_force[0],
            learned.intervals(tests, answers).pull_off_force[0, 1],
        )
        raise OutOfRange(not_certain(method, force, end, 10 ** tests.second[0][0]))
    held = learned.intervals(tests, answers, confidence=asked.confidence, joint=asked.joint)
    if not isinstance(start, AtDepth):
        by = "force" if isinstance(start, AtForce) else "contact_radius"
        half = NormalDist().inv_cdf((1 + asked.confidence) / 2)
        held = learned.with_start_doubt(tests, answers, held, by=by, quantile=half)
    found = replace(_prediction(asked, answers, held, method, why), joint=asked.joint)
    if work_doubtful:
        why += (
            f"; no work and no curve: the networks predict a work of "
            f"{answers.work_to_pull_off[0]:.4g}, the independent second ones "
            f"{10 ** tests.second[1][0]:.4g}; the force may have two maxima of about the same "
            "height"
        )
        return replace(found, work_to_pull_off=None, work_interval=None, joint=False, why=why)
    return with_curve(found, learned.curves(tests, answers), held)


def _prediction(
    asked: Question, answers: Answers, held: Intervals, method: str, why: str
) -> Prediction:
    force, work = (
        (float(pair[0, 0]), float(pair[0, 1]))
        for pair in (held.pull_off_force, held.work_to_pull_off)
    )
    return Prediction(
        pull_off_force=float(answers.pull_off_force[0]),
        interval=force,
        work_to_pull_off=float(answers.work_to_pull_off[0]),
        work_interval=work,
        confidence=asked.confidence,
        band=MEASURED,
        method=method,
        inside=True,
        why=why,
        curve=None,
        curve_band=None,
        problem=asked.problem,
    )


# Large Tabor numbers -------------------------------------------------------------------------


def learned_crack_limits(asked: Question) -> str:
    """Return why the surrogate of the crack theory does not apply, or ""."""
    said = asked.once(said_of_crack)
    return said if isinstance(said, str) else ""


def by_learned_crack(asked: Question) -> Prediction:
    """Evaluate the surrogate of the crack theory."""
    found = asked.once(said_of_crack)
    assert not isinstance(found, str), "checked by the limits"
    tests, said = found
    error = _learned("short range").constants["error"][:, 0]
    zones, energy, effective = (
        float(said.more[name][0]) for name in ("zones", "amplification", "effective")
    )
    bands = error + curve_bands(energy, effective, zones)
    why = (
        f"surrogate of the theory 'crack contact', within {error[0]:.2%} of it: effective Tabor "
        f"number {effective:.3g}, travel of {zones:.3g} zones to the pull-off; not simulated "
        f"detachments, because {'; '.join(asked.once(inputs_of_sphere).out)}"
    )
    factors = _at_seam(asked)
    if factors[0] != 1:
        why += (
            f"; times {factors[0]:.4g}, with which it meets the simulations at a Tabor number of 10"
        )
    force, work = said.pull_off_force * factors[0], said.work_to_pull_off * factors[1]
    said = replace(said, pull_off_force=force, work_to_pull_off=work)
    ends = np.outer([force[0], work[0], 1.0], [1.0, 1.0])
    ends *= 1 + bands[[0, 1, 3], None] * [-1, 1]
    least = min(force[0], float(pull_off_ratio(asked.groups.tabor)))
    ends[0, 0] = max(ends[0, 0], least)
    plain = of_theory(asked, float(force[0]), float(bands[0]), LEARNED_CRACK, why, inside=True)
    plain = replace(plain, interval=(float(ends[0, 0]), float(ends[0, 1])))
    if np.isnan(work[0]) or not tests.agree(said)[0]:
        return replace(plain, why=f"{why}; no work and no curve: its networks are not certain")
    whole = replace(
        plain,
        work_to_pull_off=float(work[0]),
        work_interval=(float(ends[1, 0]), float(ends[1, 1])),
    )
    held = Intervals(ends[:1], ends[1:2], bands[2:3], ends[2:])
    return with_curve(whole, tests.curves(said), held)


def _at_seam(asked: Question) -> Array:
    """Return the factors that make force and work continuous at a Tabor number of 10, shape (2,).

    They are the ratios of the surrogate of simulations to that of the theory there, for the same
    depth and rate, and tend to 1 at ``_FADED``; 1 without both. The factor of a work that is
    doubtful there is nan.
    """
    from viscotack.surrogate import physics

    seam, rows = physics.LIMITS["tabor"][1], asked.once(inputs_of_sphere).rows.copy()
    mu, rows[0, physics.TABOR] = asked.groups.tabor, seam
    simulated, theory = _learned(), _learned("short range")
    if mu >= _FADED or not (simulated.inside(rows).all() and theory.inside(rows).all()):
        return np.ones(2)
    answers, said = simulated.evaluate(rows), theory.evaluate(rows)
    force_doubtful, work_doubtful = simulated.doubtful(rows, answers)[0].tolist()
    if force_doubtful or not theory.tests(rows).holds(said)[0]:
        return np.ones(2)
    ratio = np.append(
        answers.pull_off_force / said.pull_off_force,
        np.nan if work_doubtful else answers.work_to_pull_off / said.work_to_pull_off,
    )
    return ratio ** float(1 - np.log(mu / seam) / np.log(_FADED / seam))


def said_of_crack(asked: Question) -> tuple[ShortRangeContact, Answers] | str:
    """Return the tests and output of the surrogate of the crack theory, or why it has none."""
    from viscotack.surrogate import physics, short_range

    learned, groups = _learned("short range"), asked.groups
    rows = asked.once(inputs_of_sphere).rows.copy()
    if np.isnan(rows[0, physics.PRELOAD]) and rows[0, physics.TABOR] >= short_range.LOW[0]:
        contact = contact_in_groups(groups.start, tabor=groups.tabor)
        rows[0, physics.PRELOAD] = np.nan if contact is None else contact.depth * groups.tabor
    tests = learned.tests(rows)
    assert isinstance(tests, short_range.ShortRangeContact)
    if not learned.inside(tests).all():
        return "out of the training range of the surrogate of the crack theory"
    said = learned.evaluate(tests)
    if not tests.holds(said)[0]:
        return "the crack theory behind the surrogate does not hold there"
    if elsewhere := not_measured(groups):
        return f"the band of the crack theory was not measured here: {elsewhere}"
    return tests, said


# Inputs --------------------------------------------------------------------------------------


def _start_depth(groups: Groups, learned: Surrogate) -> float:
    """Return the depth of the start [h0]; raise ValueError if it is undefined."""
    start = groups.start
    match start:
        case AtForce():
            return learned.start_depth(groups.tabor, force=start.force)
        case AtRadius():
            return learned.start_depth(groups.tabor, contact_radius=start.contact_radius)
    assert isinstance(start, AtDepth), "checked by the allow-list"
    return start.depth


def _out_words(name: str, value: float, limits: tuple[float, float], problem: Case) -> str:
    """Describe an input out of the range of the surrogate, with its value and the range."""
    unit, si = _UNITS.get(name, ""), None
    if unit and (scales := problem.scales()) is not None:
        speed = scales.length / scales.time
        si = (scales.length, "m") if name == "preload" else (speed, "m/s")
    return out_of_range(name, value, limits, unit, si)


def _learned(contact: str = "sphere") -> Surrogate:
    from viscotack.surrogate import store

    return store.shipped(contact)
