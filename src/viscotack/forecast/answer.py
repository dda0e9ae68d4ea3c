"""The answer at once: what was learned from simulations where it holds, a theory elsewhere."""

from __future__ import annotations

from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError, OutOfRange
from viscotack.geometry import Sphere
from viscotack.materials import RetardationPowerLaw
from viscotack.materials.conversion import slowed
from viscotack.problem import Case, Groups, Problem, PunchGroups
from viscotack.protocol import AtDepth, AtForce, AtRadius, Start
from viscotack.theory import jkr
from viscotack.traction import LennardJones
from viscotack.traction.growing import check_of_gap_alone

from .beyond import beyond
from .prediction import MEASURED, Prediction, with_curve
from .punches import by_learned_punch
from .refusals import other_test, out_of_range
from .solids import LEARNED_SOLID, alike_words, like_of, unlike_words
from .theory import by_crack, by_learned_theory, by_theory

if TYPE_CHECKING:
    from viscotack.surrogate.alike import Alike
    from viscotack.surrogate.model import Surrogate
    from viscotack.surrogate.solids import Solids

Array = npt.NDArray[np.float64]

# Units of the inputs that have one.
_UNITS = {"preload": "h0", "rate": "h0/tau0"}


def predict(
    problem: Case,
    *,
    confidence: float = 0.9,
    shift_deviation: float = 0.0,
) -> Prediction:
    """Return the pull-off force, its work and its curve, without simulating.

    Parameters
    ----------
    problem : Problem, Groups or PunchGroups
        In SI or dimensionless.
    confidence : float
        Part of the cases that the intervals are to hold: 0.5, 0.6, 0.7, 0.8, 0.9, 0.95 or 0.98, for
        which they were measured.
    shift_deviation : float
        Standard deviation of log10 a_T by which the times of the material are uncertain, as
        :meth:`viscotack.materials.passport.Passport.shift_deviation` has it. It widens the
        intervals: the problem is answered for slower and faster material as well.

    Returns
    -------
    Prediction
        By the surrogate, in less than a millisecond (of solids that are no power laws in some),
        where the problem lies in the range that it learned from. Else by the theory with the
        smallest error of those that apply, in about 0.01
        s and with its own band, whatever the confidence asked for. The band held nine of ten cases
        where it was measured: power laws and standard solids, Tabor numbers 0.3 to 8, modulus
        ratios 1e-3 to 0.3, exponents 0.3 to 1.6, rates 0.1 to 1e8 h0/tau0. Elsewhere it is not
        known to hold, and `why` says so. From an effective Tabor number of 5 on, and for other
        tests and shapes from 2 on, a contact is asked whose edge is a steady crack
        (:func:`viscotack.crack_contact`): 0.1 to 1 s, and some seconds for a new solid.

    Raises
    ------
    OutOfRange
        If no theory applies either, or none knows this test or indenter.
    ValueError
        If there is no relaxed contact to pull off, or the confidence is not one of those.
    TypeError
        If it is no problem, but the name of a file, say.

    Notes
    -----
    The surrogate knows the retraction of a sphere at a constant speed from a relaxed solid, with
    the Lennard-Jones traction and a rigid machine. It has learned from
    :class:`viscotack.RetardationPowerLaw`; for any other linear solid that one answers which creeps
    like it around the times of the test (:mod:`viscotack.surrogate.alike`), with intervals that
    were measured on other solids. Of a flat punch it knows the same test on a standard solid that
    slides on its base (:mod:`viscotack.surrogate.punch`); no theory answers where that ends.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, RetardationPowerLaw
    >>> material = RetardationPowerLaw(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> groups = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=316.23)
    >>> answer = predict(groups)
    >>> f"{answer.value:.1f} by {answer.method}"
    '7.3 by surrogate'
    """
    if shift_deviation > 0:
        return _uncertain(problem, confidence, shift_deviation)
    groups = _groups(problem)
    check_confidence(confidence)
    if isinstance(groups, PunchGroups):
        return by_learned_punch(problem, groups, confidence)
    if unlearned := _unlearned(groups):
        return by_crack(problem, unlearned)
    inputs = _inputs(groups, _learned(), problem)
    found = _by_learned(problem, groups, inputs, confidence)
    return found or by_theory(problem, groups, "; ".join(inputs.out), confidence)


def learned_prediction(problem: Case, *, confidence: float = 0.9) -> Prediction:
    """Return what was learned, in some milliseconds whatever the problem.

    Parameters and returns are those of :func:`predict`, which asks the theories where this has no
    answer; they may take seconds.

    Raises
    ------
    OutOfRange
        If the problem lies outside of what was learned: which input is out, and the range.
    ValueError
        If the confidence is not one of those that were measured.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, Groups, OutOfRange
    >>> material = Elastic(rubbery_modulus=1.5e6, poisson_ratio=0.5)
    >>> groups = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=316.23)
    >>> try:
    ...     learned_prediction(groups)
    ... except OutOfRange as error:
    ...     print(error)
    modulus_ratio is 1, and 0.0001 to 0.7 was learned from
    """
    groups = _groups(problem)
    check_confidence(confidence)
    if isinstance(groups, PunchGroups):
        return by_learned_punch(problem, groups, confidence)
    if unlearned := _unlearned(groups):
        raise OutOfRange(unlearned)
    inputs = _inputs(groups, _learned(), problem)
    found = _by_learned(problem, groups, inputs, confidence)
    if found is None:
        raise OutOfRange("; ".join(inputs.out))
    return found


@dataclass(frozen=True, eq=False)
class _Inputs:
    """What the surrogate takes, and what of it is out of range.

    Attributes
    ----------
    rows : ndarray, shape (1, 5)
        The groups; of another solid those of the power law that it is like.
    out : list of str
        In words.
    like : Alike or None
        Of a solid that is no power law by retardation.
    """

    rows: Array
    out: list[str]
    like: Alike | None = None


def _by_learned(
    problem: Case, groups: Groups, inputs: _Inputs, confidence: float
) -> Prediction | None:
    """Return what the surrogate says, or the learned theory of large Tabor numbers; else None."""
    learned, rows, out, like = _learned(), inputs.rows, inputs.out, inputs.like
    method = "surrogate" if like is None else LEARNED_SOLID
    if not out:
        if like is None:
            answers = learned.evaluate(rows)
            held = learned.intervals(rows, answers, confidence=confidence)
        else:
            answers = _solids().evaluate(like)
            held = _solids().intervals(like, answers, confidence=confidence)
        if not isinstance(groups.start, AtDepth):
            by = "force" if isinstance(groups.start, AtForce) else "contact_radius"
            half = NormalDist().inv_cdf((1 + confidence) / 2)
            held = learned.with_start_doubt(rows, answers, held, by=by, quantile=half)
        why, at, with_work = "every input lies in the range that was learned from", rows, True
        if like is not None:
            why += f"; {alike_words(like)}"
    elif not isinstance(groups.material, RetardationPowerLaw):
        return None
    elif np.isfinite(rows).all() and (further := beyond(learned, rows, confidence)) is not None:
        answers, held, at = further.answers, further.intervals, further.groups
        with_work = further.with_work
        why = f"{'; '.join(out)}; {further.why}"
    else:
        return _large(problem, groups, rows, "; ".join(out), confidence)
    found = Prediction(
        value=float(answers.pull_off_force[0]),
        interval=_pair(held.pull_off_force[0]),
        work_to_pull_off=float(answers.work_to_pull_off[0]) if with_work else None,
        work_interval=_pair(held.work_to_pull_off[0]) if with_work else None,
        confidence=confidence,
        band=MEASURED,
        method=method,
        inside=at is rows,
        why=why,
        curve=None,
        curve_band=None,
        problem=problem,
    )
    return with_curve(found, learned.curves(at, answers), held) if found.inside else found


def _large(
    problem: Case, groups: Groups, rows: Array, out: str, confidence: float
) -> Prediction | None:
    """Return the learned theory of large Tabor numbers, None where it was not learned."""
    from viscotack.surrogate import physics, short_range

    learned, rows = short_range.shipped(), rows.copy()
    if np.isnan(rows[0, physics.PRELOAD]) and rows[0, physics.TABOR] >= short_range.LOW[0]:
        rows[0, physics.PRELOAD] = _short_range_depth(groups)
    if not np.isfinite(rows).all() or not learned.in_range(rows)[0]:
        return None
    said, error = learned.evaluate(rows), float(learned.error[0])
    if not learned.holds(said)[0]:
        return None
    return by_learned_theory(problem, groups, said, error, out, confidence)


def _short_range_depth(groups: Groups) -> float:
    """Return the depth of a relaxed start [h0] by JKR; nan where there is none."""
    unit = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}
    match groups.start:
        case AtForce(force=force):
            try:
                radius = jkr.contact_radius_at_force(1.5 * np.pi * force, **unit)
            except ValueError:  # said by the theories
                return np.nan
        case AtRadius(contact_radius=contact_radius):
            radius = contact_radius * np.pi ** (1 / 3)
        case _:
            return np.nan
    return float(jkr.depth(radius, **unit)) * groups.tabor


def _uncertain(problem: Case, confidence: float, deviation: float) -> Prediction:
    """Return a prediction whose intervals hold the uncertainty of the material's times as well."""
    found = predict(problem, confidence=confidence)
    decades = NormalDist().inv_cdf((1 + confidence) / 2) * deviation
    others = []
    for factor in (10.0**-decades, 10.0**decades):
        material = slowed(problem.material, factor)
        others.append(predict(replace(problem, material=material), confidence=confidence))
    work = None
    if found.work_to_pull_off is not None and found.work_interval is not None:
        known = [each.work_to_pull_off for each in others if each.work_to_pull_off is not None]
        work = _widened(found.work_to_pull_off, found.work_interval, known)
    forces = [each.value for each in others]
    return replace(
        found,
        interval=_widened(found.value, found.interval, forces),
        work_interval=work,
        **_curve_widened(found, others),
        why=f"{found.why}; intervals hold times of the material known to {deviation:.2g} decades, "
        "from its shift",
    )


def _curve_widened(found: Prediction, others: list[Prediction]) -> dict[str, Any]:
    """Return the bands of a curve with the reach of others, by their forces and beginnings."""
    curve = found.curve
    if curve is None or found.curve_band is None:
        return {}
    far = max(abs(each.value - found.value) for each in others)
    wider: dict[str, Any] = {"curve_band": float(np.hypot(found.curve_band, far))}
    if found.zero_force_depth is None or found.zero_force_interval is None:
        return wider
    start, (low, high) = float(curve.depth[0]), found.zero_force_interval
    known = [start - x for each in others if (x := each.zero_force_depth) is not None]
    least, most = _widened(start - found.zero_force_depth, (start - high, start - low), known)
    return wider | {"zero_force_interval": (start - most, start - least)}


def _widened(
    value: float, interval: tuple[float, float], others: list[float]
) -> tuple[float, float]:
    """Return an interval with the reach of other answers added in quadrature, as logarithms."""
    low, high = interval
    down = max([np.log(value / other) for other in others if other < value], default=0.0)
    up = max([np.log(other / value) for other in others if other > value], default=0.0)
    return (
        float(value * np.exp(-np.hypot(np.log(value / low), down))) if low > 0 else low,
        float(value * np.exp(np.hypot(np.log(high / value), up))),
    )


def check_confidence(confidence: float) -> None:
    """Refuse a confidence for which no interval was measured."""
    from viscotack.surrogate.trust import CONFIDENCES

    if confidence not in CONFIDENCES:
        raise InputError(
            f"confidence must be one of {', '.join(map(str, CONFIDENCES))}, for which intervals "
            f"were measured; got {confidence!r}"
        )


def _out_words(name: str, value: float, limits: tuple[float, float], problem: Case) -> str:
    """Return that an input is out of the range of the surrogate, with its value and the range."""
    unit, si = _UNITS.get(name, ""), None
    if unit and (scales := problem.scales()) is not None:
        speed = scales.length / scales.time
        si = (scales.length, "m") if name == "preload" else (speed, "m/s")
    return out_of_range(name, value, limits, unit, si)


def _learned() -> Surrogate:
    from viscotack.surrogate import store

    return store.shipped()


def _solids() -> Solids:
    from viscotack.surrogate import solids

    return solids.shipped()


def _pair(interval: Array) -> tuple[float, float]:
    return float(interval[0]), float(interval[1])


def _groups(problem: Any) -> Groups | PunchGroups:
    """Return the groups of a problem; refuse what is none."""
    if not isinstance(problem, Problem | Groups | PunchGroups):
        raise TypeError(
            f"predict takes a Problem or Groups, got {problem!r}; for a file give "
            "viscotack.read_case(path)"
        )
    groups = problem.groups()
    check_of_gap_alone(groups.traction, "a prediction")
    return groups


def _unlearned(groups: Groups) -> str:
    """Return in words why neither the surrogate nor the theories of a sphere know a test."""
    if not isinstance(groups.geometry, Sphere):
        return f"what was learned is for spheres, got a {groups.geometry.word}"
    return other_test(groups, Start, "x 1.5 pi R dg0/h0")


def _inputs(groups: Groups, learned: Surrogate, problem: Case) -> _Inputs:
    """Return what the surrogate takes of a problem, and what of it is out of range."""
    material, mu = groups.material, groups.tabor
    if not isinstance(groups.traction, LennardJones):
        name = type(groups.traction).__name__
        words = f"the traction is {name}, and LennardJones alone was learned from"
        return _Inputs(np.full((1, len(learned.limits)), np.nan), [words])
    assert groups.rate is not None, "checked at the door"
    row, known = np.full(len(learned.limits), np.nan), list(learned.limits)
    row[:2] = mu, groups.modulus_ratio
    if isinstance(material, RetardationPowerLaw):
        row[[2, 4]] = material.exponent, groups.rate * material.tau0
    else:
        # the others are those of a power law that the solid is like
        known = ["tabor", "modulus_ratio", "preload"]
    no_start = ""
    # the depth of a start by force or radius is asked where the Tabor number is known
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
            out.append(_out_words(name, value, limits, problem))
    out = [words for words in out if words]
    if isinstance(material, RetardationPowerLaw) or not np.isfinite(row[[0, 1, 3]]).all() or out:
        return _Inputs(row[None], out)
    like = like_of(groups, float(row[3]))
    return _Inputs(like.groups, unlike_words(like), like)


def _start_depth(groups: Groups, learned: Surrogate) -> float:
    """Return the depth of the start [h0]; ValueError where the surrogate knows none."""
    start = groups.start
    match start:
        case AtForce():
            return learned.start_depth(groups.tabor, force=start.force)
        case AtRadius():
            return learned.start_depth(groups.tabor, contact_radius=start.contact_radius)
    assert isinstance(start, AtDepth), "checked at the door"
    return start.depth
