r"""Find a design: the largest margin of the worst target by the fast tier, then simulations.

The margin of a target is :math:`\ln(P/P_\mathrm{hold})` or :math:`\ln(P_\mathrm{release}/P)`, with
the less favourable end of the interval of P. Differential evolution maximises the smallest one;
with tolerances the smallest one less the allowance that the yield needs. If no simulated design
meets the targets, the ratios of simulated to predicted forces correct all predictions, and the best
designs by these are simulated too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from math import ceil, exp, inf, log
from typing import Any

import numpy as np

from viscotack.clock import limited
from viscotack.errors import InputError, OutOfRange
from viscotack.materials import Material
from viscotack.problem.accuracy import DEFAULT_ACCURACY
from viscotack.units import readable

from .confirming import Simulated, simulate
from .fast import SURROGATES, THEORIES, FastTier, Forces
from .front import front_of
from .interpolating import interpolation
from .limits import SPEEDS, Limit, solid_limits, wanted
from .margins import Candidate, Judge
from .searching import NONE, Effort, search
from .space import (
    HOLD,
    HOLD_SPEED,
    INTERFACE,
    LOAD,
    MODULUS,
    PADS,
    PRELOAD,
    RATIO,
    RELEASE,
    RELEASE_SPEED,
    WORK,
    Choice,
    Conditions,
    DesignSpace,
    Targets,
)
from .yields import Slopes, allowances, gain, share_of

# Sizes of searches: of all targets together, of one alone, and of all ends of a front.
_EFFORT, _REACH, _END = Effort(3.3, 5.5), Effort(3.3, 2), Effort(2, 2.4)
# Bonus on the margin of all other targets, ln 2, in a search towards the end of a front.
_BONUS = log(2.0)
# Further simulations of designs by corrected predictions.
_CORRECTED = 3
# Designs that theories predict before they are interpolated, times free variables + 1, and rounds
# of interpolation.
_SAMPLED, _ROUNDS = 3.3, 4
# Designs that are tried first, and the share of them that surrogates must predict.
_TRIED, _COVERED = 16, 0.25
# Distance of candidates in some variable, over its range.
_APART = 0.15
# Step of logarithms for slopes, part of a range within which a variable is at its end, largest
# difference of margins that bind together, and least slope of a bound that binds.
_STEP, _AT_END, _TOGETHER, _SLOPE = 0.02, 5e-3, 0.02, 1e-3


@dataclass(frozen=True)
class Design:
    """The best designs, what binds them, and what matters.

    Attributes
    ----------
    candidates : tuple of Candidate
        Best designs by the fast tier, best first; those that were simulated are ordered by their
        simulated margin.
    simulated : tuple of (Simulated or None)
        Simulation of each.
    meets : bool or None
        Whether the first design meets every target: by simulation; None without one, unless the
        fast tier excludes it.
    binding : tuple of str
        Targets with the smallest margin of the first design, and bounds of variables beyond which
        it would grow, such as "hold_speed at most".
    elasticities : mapping of str to (mapping of str to (float or None))
        d ln P/d ln x of the first design for each force of its targets; None where no tier
        predicts.
    front : tuple of Candidate
        Designs of which none is better in every target, by the less favourable ends of their
        intervals; empty for a single target.
    yields : tuple of (float or None)
        Share of the parts of each candidate that meets the targets, by its simulated forces or
        else by the fast tier; None without tolerances.
    limits : tuple of Limit
        What the solid permits, and if the targets are out of reach, what the best designs reach of
        each target alone.
    fast : FastTier
        Predictions of one pad.
    """

    candidates: tuple[Candidate, ...]
    simulated: tuple[Simulated | None, ...]
    meets: bool | None
    binding: tuple[str, ...]
    elasticities: Mapping[str, Mapping[str, float | None]]
    limits: tuple[Limit, ...]
    fast: FastTier
    front: tuple[Candidate, ...] = ()
    yields: tuple[float | None, ...] = ()
    judge: Judge = field(default_factory=lambda: Judge(Targets(ratio=1.0)))

    @property
    def predictions(self) -> int:
        """Number of predictions of one pad."""
        return len(self.fast.known)

    @property
    def tier(self) -> str:
        """Fast tier of the search: "surrogates" or "theories"."""
        return "surrogates" if self.fast.budget == SURROGATES else "theories"

    @property
    def best(self) -> Candidate:
        """The first design."""
        return self.candidates[0]

    @property
    def excluded(self) -> tuple[Limit, ...]:
        """Limits that exclude a target."""
        return tuple(each for each in self.limits if each.excludes)


def find_design(
    materials: Mapping[str, Material],
    traction: Any,
    space: DesignSpace,
    targets: Targets,
    conditions: Conditions | None = None,
    *,
    confirm: int = 3,
    seed: int = 0,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> Design:
    """Find radius, preload, number of pads and speeds that hold and release wanted forces.

    Parameters
    ----------
    materials : mapping of str to material
        Materials to choose from, by names.
    traction : traction law
        The interface.
    space : DesignSpace
        Bounds of the variables.
    targets : Targets
        Wanted forces of all pads.
    conditions : Conditions, optional
        Speeds, temperatures and tolerances at which the targets count.
    confirm : int
        Number of candidates that are simulated, 0 to 3; if none of them meets the targets, up to
        three more follow.
    seed : int
        Of the search.
    accuracy : float
        Of each simulation, as for :func:`viscotack.solve`.
    time_limit : float, optional
        Longest wall time of all simulations [s]; those that it stops leave the answer open.
    progress : callable
        Called with the completed share.

    Raises
    ------
    OutOfRange
        If no fast tier predicts any design between the bounds.
    ValueError
        If a target needs a speed without bounds.
    """
    judge = Judge(targets, conditions or Conditions(), space.bonded)
    check_stated(materials, space, targets)
    fast, tried = _covering(materials, traction, space, judge, seed)
    needed = _needed(tried, fast, judge)
    several = len(targets.stated) > 1
    share = 0.6 / len(materials)
    seen: dict[Choice, Candidate] = {}
    for i, name in enumerate(materials):

        def tell(done: float, i: int = i) -> None:
            progress((i + done) * share)

        if fast.budget != SURROGATES:
            seen |= _suggested(fast, space, judge, needed, name, seed, tell)
            continue
        seen |= _searched(fast, space, judge, _over(needed), name, seed, tell)
        if several:
            seen |= _ends(fast, space, judge, name, seed)
    if not seen:
        raise OutOfRange(f"no fast tier predicts a design between the bounds: {_reason(fast)}")
    candidates = _apart(seen, space, needed)
    limits = solid_limits(fast, space, targets)
    if not candidates[0].is_possible and not any(each.excludes for each in limits):
        limits += _reached(fast, space, judge, seed)
    progress(0.6)

    def again(rate: Callable[[Candidate], float], material: str) -> None:
        if fast.budget == SURROGATES:
            found = _searched(fast, space, judge, rate, material, seed, effort=_REACH)
            seen.update(found)

    with limited(time_limit):
        tested = _simulated(
            candidates, seen, again, fast, judge, needed, confirm, accuracy, progress
        )
    yields = [_yield(one, run, fast, judge) for one, run in tested]
    order = sorted(range(len(tested)), key=lambda i: _rank(*tested[i], yields[i]))
    best, run = tested[order[0]]
    slopes = slopes_of(best.choice, fast, judge)
    return Design(
        candidates=tuple(tested[i][0] for i in order),
        simulated=tuple(tested[i][1] for i in order),
        meets=_meets(best, run, yields[order[0]], judge),
        binding=_binding(best, space, slopes),
        elasticities=slopes,
        limits=limits,
        fast=fast,
        front=front_of(seen.values()) if several else (),
        yields=tuple(yields[i] for i in order),
        judge=judge,
    )


def check_stated(materials: Mapping[str, Material], space: DesignSpace, targets: Targets) -> None:
    """Raise an InputError without a material, or without the speed of a target."""
    if not materials:
        raise InputError("a design needs at least one material")
    for name, needed in ((HOLD_SPEED, targets.needs_hold), (RELEASE_SPEED, targets.needs_release)):
        if needed and getattr(space, name) is None:
            raise InputError(f"the targets need bounds of the {name}")


def _covering(
    materials: Mapping[str, Material],
    traction: Any,
    space: DesignSpace,
    judge: Judge,
    seed: int,
) -> tuple[FastTier, list[Candidate]]:
    """Return the surrogates if they predict enough of the space, otherwise the theories.

    Also return the designs that were tried.
    """
    fast = FastTier(materials, traction, SURROGATES)
    tried = [
        judge.judged(choice, fast)
        for name in materials
        for choice in _drawn(space, name, _TRIED, seed)
    ]
    known = [each for each in tried if not isinstance(each, str)]
    if len(known) >= _COVERED * len(tried):
        return fast, known
    return FastTier(materials, traction, THEORIES), known


def _needed(tried: list[Candidate], fast: FastTier, judge: Judge) -> dict[str, float]:
    """Return the margins that the yield needs, by the slopes of the best design that was tried."""
    conditions, names = judge.conditions, tuple(judge.targets.stated)
    best = max(tried, key=lambda each: each.margin, default=None)
    if best is None or not conditions.deviations:
        return dict.fromkeys(names, 0.0)
    slopes = slopes_of(best.choice, fast, judge)
    return allowances(names, slopes, conditions.deviations, conditions.share)


def rated(margins: Mapping[str, float], needed: Mapping[str, float]) -> float:
    """Return the smallest margin over what is needed."""
    return min(margin - needed[name] for name, margin in margins.items())


def _over(needed: Mapping[str, float]) -> Callable[[Candidate], float]:
    """Return the rating of a candidate by its smallest margin over what is needed."""
    return lambda one: rated(one.margins, needed)


def _searched(
    forces: Forces,
    space: DesignSpace,
    judge: Judge,
    rate: Callable[[Candidate], float],
    material: str,
    seed: int,
    tell: Callable[[float], None] = lambda share: None,
    effort: Effort = _EFFORT,
) -> dict[Choice, Candidate]:
    """Return the designs of a search for the largest rate, with their forces."""
    seen: dict[Choice, Candidate] = {}

    def rating(choice: Choice) -> float:
        found = judge.judged(choice, forces)
        if isinstance(found, str):
            return NONE
        seen[choice] = found
        return max(rate(found), NONE)

    search(rating, space, material, effort=effort, seed=seed, tell=tell)
    return seen


def _ends(
    fast: FastTier, space: DesignSpace, judge: Judge, material: str, seed: int
) -> dict[Choice, Candidate]:
    """Return designs of shorter searches towards each end of the front."""
    effort = replace(_END, generations=_END.generations / len(judge.targets.stated))
    seen: dict[Choice, Candidate] = {}
    for number, target in enumerate(judge.targets.stated):
        needed = {name: -_BONUS * (name != target) for name in judge.targets.stated}
        rate, own = _over(needed), seed + number + 1
        seen |= _searched(fast, space, judge, rate, material, own, effort=effort)
    return seen


def _suggested(
    fast: FastTier,
    space: DesignSpace,
    judge: Judge,
    needed: Mapping[str, float],
    material: str,
    seed: int,
    tell: Callable[[float], None],
) -> dict[Choice, Candidate]:
    """Return designs that theories predict: some are drawn, and others interpolation suggests."""
    choices = _drawn(space, material, ceil(_SAMPLED * (len(space.free) + 1)), seed)
    seen: dict[Choice, Candidate] = {}
    for number in range(_ROUNDS + 1):
        tried = {choice: judge.judged(choice, fast) for choice in choices}
        seen |= {choice: found for choice, found in tried.items() if not isinstance(found, str)}
        tell((number + 1) / (_ROUNDS + 1))
        between = interpolation(fast, material)
        if between is None or number == _ROUNDS:
            break
        likely = _searched(between, space, judge, _over(needed), material, seed + number)
        choices = [each.choice for each in _apart(likely, space, needed)]
    return seen


def _drawn(space: DesignSpace, material: str, count: int, seed: int) -> list[Choice]:
    """Return designs at random places between the bounds."""
    low, high = np.array(space.ends()).reshape(-1, 2).T
    points = np.random.default_rng(seed).random((count, low.size))
    return [space.choice(material, low + point * (high - low)) for point in points]


def _reason(fast: FastTier) -> str:
    """Return the most frequent reason why no tier predicts a pad."""
    reasons = [each for each in fast.known.values() if isinstance(each, str)]
    return max(reasons, key=reasons.count, default="the area has no room for a pad")


def _apart(
    seen: Mapping[Choice, Candidate], space: DesignSpace, needed: Mapping[str, float]
) -> tuple[Candidate, ...]:
    """Return up to three of the best candidates that differ in a variable or in the material."""
    ends = np.array(space.ends()).reshape(-1, 2)
    found: list[Candidate] = []
    # a wide interval may hide a design that meets the targets behind one that surely does not
    order = sorted(
        seen.values(), key=lambda one: (not one.is_possible, -rated(one.margins, needed))
    )
    for each in order:
        near = any(
            each.choice.material == other.choice.material
            and np.all(
                np.abs(space.places(each.choice) - space.places(other.choice))
                <= _APART * (ends[:, 1] - ends[:, 0])
            )
            for other in found
        )
        # a worse design is of use only if it may meet the targets too
        if len(found) == 3 or (found and not each.is_possible):
            break
        if not near:
            found.append(each)
    return tuple(found)


# Simulation -------------------------------------------------------------------------------------


def _simulated(
    candidates: tuple[Candidate, ...],
    seen: Mapping[Choice, Candidate],
    again: Callable[[Callable[[Candidate], float], str], None],
    fast: FastTier,
    judge: Judge,
    needed: Mapping[str, float],
    confirm: int,
    accuracy: float,
    progress: Callable[[float], None],
) -> list[tuple[Candidate, Simulated | None]]:
    """Return candidates with their simulations, until one meets the targets.

    The next one is the best by corrected predictions, which a further search adds to those that
    were seen, or else the next candidate.
    """
    tested: list[tuple[Candidate, Simulated]] = []
    waiting = [each for each in candidates[:confirm] if each.is_possible]
    most = len(waiting) + _CORRECTED if waiting else 0
    while len(tested) < most and not any(
        _meets(one, run, _yield(one, run, fast, judge), judge) for one, run in tested[-1:]
    ):
        known = [(one, run) for one, run in tested if run.margins]
        done = {one.choice for one, _ in tested}
        waiting = [each for each in waiting if each.choice not in done]
        likely = []
        if known:

            def rate(one: Candidate, known: list[tuple[Candidate, Simulated]] = known) -> float:
                return rated(_corrected(one, known, judge), needed)

            again(rate, known[-1][0].choice.material)
            likely = [max(seen.values(), key=rate)]
        fresh = [each for each in (*likely, *waiting) if each.choice not in done]
        if not fresh:
            break
        tested.append((fresh[0], simulate(fresh[0], fast, judge, accuracy=accuracy)))
        progress(0.6 + 0.4 * len(tested) / most)
    simulated = {one.choice for one, _ in tested}
    return [*tested, *((x, None) for x in candidates if x.choice not in simulated)]


def _corrected(
    one: Candidate, known: list[tuple[Candidate, Simulated]], judge: Judge
) -> dict[str, float]:
    """Return the margins by predictions times the ratio of the nearest simulation to its own."""

    def distance(other: Candidate) -> float:
        return sum(
            log(force.value / other.forces[name].value) ** 2 for name, force in one.forces.items()
        )

    near, run = min(known, key=lambda pair: distance(pair[0]))
    forces = {
        name: x.value * run.forces[name] / near.forces[name].value for name, x in one.forces.items()
    }
    return judge.margins(one.choice, forces)


def _rank(one: Candidate, run: Simulated | None, part: float | None) -> tuple[float, float]:
    """Return the order of a candidate: by its simulated yield and margin, then the others."""
    margin = None if run is None else run.margin
    if margin is None:
        return inf, -one.margin
    return -round(part or 0.0, 3), -margin


def _yield(one: Candidate, run: Simulated | None, fast: FastTier, judge: Judge) -> float | None:
    """Return the share of parts that meet the targets; None without tolerances."""
    deviations = judge.conditions.deviations
    if not deviations:
        return None
    margins = one.margins if run is None or not run.margins else run.margins
    return share_of(margins, slopes_of(one.choice, fast, judge), deviations)


def _meets(best: Candidate, run: Simulated | None, part: float | None, judge: Judge) -> bool | None:
    if run is None:
        return None if best.is_possible else False
    if run.meets is None or not judge.conditions.deviations:
        return run.meets
    return None if part is None else part >= judge.conditions.share


def _reached(fast: FastTier, space: DesignSpace, judge: Judge, seed: int) -> tuple[Limit, ...]:
    """Return the largest or smallest force or ratio between the bounds, each target alone."""
    found = []
    for target, value in wanted(judge.targets).items():
        rating = partial(_alone, judge=_judge_of(target, judge))
        tried = []
        for name in fast.materials:
            forces = fast if fast.budget == SURROGATES else interpolation(fast, name) or fast
            alone = partial(rating, fast=forces)
            choice = search(alone, space, name, effort=_REACH, seed=seed)
            # of a theory, if it predicts what the interpolation suggests
            known = rating(choice, fast=fast)
            tried.append((alone(choice) if known <= NONE else known, choice))
        most, best = max(tried, key=lambda pair: pair[0])
        reach = exp(most)
        reach = 1 / reach if target == RELEASE else reach
        found.append(Limit(target, value, reach, SPEEDS, _of_speeds(best, target)))
    return tuple(found)


def _judge_of(target: str, judge: Judge) -> Judge:
    """Return the judge of one target alone, with the force 1."""
    time = judge.targets.holding_time if target == LOAD else None
    return replace(judge, targets=Targets(**{target: 1.0}, holding_time=time))


def _alone(choice: Choice, *, fast: Forces, judge: Judge) -> float:
    """Return ln of the force or ratio of a design by the favourable ends; NONE without one."""
    found = judge.judged(choice, fast)
    if isinstance(found, str):
        return NONE
    return max(min(found.best_margins.values()), NONE)


def _of_speeds(best: Choice, target: str) -> str:
    """Return the design that reaches most, in words."""
    needed = {
        HOLD: (HOLD_SPEED,),
        WORK: (HOLD_SPEED,),
        RELEASE: (RELEASE_SPEED,),
        RATIO: (HOLD_SPEED, RELEASE_SPEED),
        LOAD: (),
    }
    said = {HOLD_SPEED: "hold", RELEASE_SPEED: "release"}
    speeds = " and ".join(
        f"a {said[name]} speed of {readable(getattr(best, name), 'm/s', digits=3)}"
        for name in needed[target]
    )
    return (
        f"{speeds + ', ' if speeds else ''}pads: {best.pads}, R = "
        f"{readable(best.radius, 'm', digits=3)}, preload {readable(best.preload, 'N', digits=3)}"
    )


# What matters ---------------------------------------------------------------------------------

# Speed on which a force depends.
_OWN = {HOLD: HOLD_SPEED, WORK: HOLD_SPEED, RELEASE: RELEASE_SPEED}


def slopes_of(choice: Choice, fast: FastTier, judge: Judge) -> Slopes:
    """Return d ln P/d ln x of the forces of a design by central differences of the fast tier."""
    modulus = getattr(fast.materials[choice.material], "rubbery_modulus", None)
    scatters = judge.conditions.deviations
    if MODULUS in scatters and choice.modulus is None:
        choice = replace(choice, modulus=modulus)
    names = [x for x in _variables(choice) if x != PADS]
    ends: dict[str, list[Any]] = {}
    for name in (*names, *(x for x in INTERFACE if hasattr(fast.traction, x))):
        for step in (-_STEP, _STEP):
            if name in INTERFACE:
                law = replace(fast.traction, **{name: getattr(fast.traction, name) * exp(step)})
                tier = FastTier(fast.materials, law, fast.budget)
                found = judge.forces(choice, tier)
            else:
                moved = replace(choice, **{name: getattr(choice, name) * exp(step)})
                found = judge.forces(moved, fast)
            ends.setdefault(name, []).append(found)
    forces = judge.forces(choice, fast)
    slopes: dict[str, dict[str, float | None]] = {}
    for force in () if isinstance(forces, str) else forces:
        own: dict[str, float | None] = {}
        for name, (low, high) in ends.items():
            if name in (HOLD_SPEED, RELEASE_SPEED) and name != _OWN.get(force):
                continue
            own[name] = _difference(low, high, force)
            if name == PRELOAD:
                # N pads under the preload F are N times one under F/N
                by_preload = own[name]
                own[PADS] = None if by_preload is None else 1 - by_preload
        slopes[force] = own
    return slopes


def _difference(low: Any, high: Any, force: str) -> float | None:
    """Return d ln P/d ln x of a force between two steps; None where no tier predicts."""
    if isinstance(low, str) or isinstance(high, str):
        return None
    return log(high[force].value / low[force].value) / (2 * _STEP)


def _variables(choice: Choice) -> list[str]:
    """Return the names of the variables that a design has."""
    names = DesignSpace.__dataclass_fields__.keys() & choice.__dataclass_fields__.keys()
    return [x for x in choice.__dataclass_fields__ if x in names and getattr(choice, x) is not None]


def _binding(best: Candidate, space: DesignSpace, slopes: Slopes) -> tuple[str, ...]:
    """Return the targets with the smallest margin, and the bounds beyond which it would grow."""
    worst = [x for x, margin in best.margins.items() if margin <= best.margin + _TOGETHER]
    bounds = []
    for name, (low, high), place in zip(
        space.free, space.ends(), space.places(best.choice).tolist(), strict=True
    ):
        # where several targets bind they share the gain
        more = sum(gain(target, name, slopes) or 0.0 for target in worst)
        near = _AT_END * (high - low)
        if more > _SLOPE and place >= high - near:
            bounds.append(f"{name} at most")
        elif more < -_SLOPE and place <= low + near:
            bounds.append(f"{name} at least")
    if space.area is not None and best.choice.pads == space.most_pads(best.choice.radius):
        more = sum(gain(x, PADS, slopes) or 0.0 for x in worst)
        bounds += ["area at most"] if more > _SLOPE else []
    return (*worst, *bounds)
