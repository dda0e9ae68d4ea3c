r"""Find a design: the largest margin of the worst target by the fast tier, then simulations.

The margin of a target is :math:`\ln(P/P_\mathrm{hold})` or :math:`\ln(P_\mathrm{release}/P)`, with
the less favourable end of the interval of P. Differential evolution maximises the smallest one;
with tolerances the smallest one less the allowance that the yield needs. If no simulated design
meets the targets, the ratios of simulated to predicted forces correct all predictions, and the best
designs by these are simulated too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from math import ceil, exp, log
from typing import Any

import numpy as np

from viscotack.clock import limited
from viscotack.design.fast import SURROGATES, THEORIES, FastTier, interpolated
from viscotack.design.margins import (
    Candidate,
    Judge,
    Limit,
    Simulated,
    allowances,
    binding,
    pad_of,
    share_of,
    slopes_of,
    solid_limits,
    wanted,
)
from viscotack.design.searching import NONE, Effort, front_of, search
from viscotack.design.space import Choice, Conditions, DesignSpace, Targets
from viscotack.errors import InputError, OutOfRange
from viscotack.model.materials import Material
from viscotack.model.problem import Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.model.protocol import Dwell, LoadTo, Retraction
from viscotack.result import Outcome, Result
from viscotack.result.cycles import time_to_detachment
from viscotack.result.observables import pull_off, work_to_pull_off
from viscotack.simulate import solve
from viscotack.units import readable

# A dead load is applied within this part of the holding time; the simulation lasts this
# number of holding times.
_APPLIED, _LONGEST = 0.01, 10.0


def simulate(candidate: Candidate, fast: FastTier, judge: Judge, *, accuracy: float) -> Simulated:
    """Simulate one pad of a design at the conditions of its targets.

    Parameters
    ----------
    candidate : Candidate
        The design.
    fast : FastTier
        Has materials and interface.
    judge : Judge
        Targets and conditions.
    accuracy : float
        Of each simulation, as for :func:`viscotack.solve`.
    """
    choice = candidate.choice
    forces: dict[str, float] = {}
    reasons = []
    for name, pads in judge.pads(choice).items():
        # of several speeds that with the worst prediction
        known = [(x, pad) for pad in pads if not isinstance(x := fast.force(pad), str)]
        select, end = (min, "low") if name == "hold" else (max, "high")
        _, pad = select(known, key=lambda pair, end=end: getattr(pair[0], end))
        try:
            problem = fast.problem(pad)
            found = _solved(problem, accuracy, until="pull-off")
            unit, work = problem.scales(), problem.outputs.observables["work_to_pull_off"].unit
            forces[name] = choice.pads * (pull_off(found).force * unit.force)
            if judge.targets.work is not None and name == "hold":
                joules = work_to_pull_off(found) * getattr(unit, work.scale)
                forces["work"] = choice.pads * joules
        except InputError as reason:
            reasons.append(f"{name}: {reason}")
    time = None
    if judge.targets.holding_time is not None:
        try:
            forces["dead_load"], time = _held(candidate, fast, judge, accuracy)
        except InputError as reason:
            reasons.append(f"dead_load: {reason}")
    margins = {} if reasons else judge.margins(choice, forces)
    return Simulated(forces, margins, "; ".join(reasons), time)


def _solved(problem: Problem, accuracy: float, **until: Any) -> Result:
    """Return a simulation; InputError with the reason if it stops."""
    found = solve(problem, accuracy=accuracy, throw=False, **until)
    if found.outcome is Outcome.STOPPED:
        raise InputError(found.status)
    return found


def _held(
    candidate: Candidate, fast: FastTier, judge: Judge, accuracy: float
) -> tuple[float, float | None]:
    """Return the load held for the time [N], and the time under the predicted load [s].

    The simulated time becomes a load by the theory: that load times the ratio of the loads that the
    theory has for both times.
    """
    choice, targets = candidate.choice, judge.targets
    assert targets.holding_time is not None, "the caller checks"
    wanted = judge.conditions.holding_time(choice.material, targets.holding_time)
    pad = pad_of(choice, 1.0, bonded=judge.bonded)
    problem = fast.problem(pad)
    load, longest = candidate.forces["dead_load"].value / choice.pads, _LONGEST * wanted
    moves = (LoadTo(-load, duration=_APPLIED * wanted), Dwell(longest, hold="force"))
    held = Retraction(problem.protocol.start, None, moves)  # type: ignore[arg-type]
    found, time = _solved(replace(problem, protocol=held), accuracy), None
    if found.outcome in (Outcome.JUMPED, Outcome.DETACHED):
        time = 0.0  # it is over before the load is
        with suppress(InputError):
            time = time_to_detachment(found)
    shown = longest if time is None else max(time, _APPLIED * wanted)
    first, second = (fast.held(pad, x) for x in (wanted, shown))
    if isinstance(first, str) or isinstance(second, str):
        raise InputError(str(first))
    return choice.pads * load * first.value / second.value, time


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


@dataclass(frozen=True)
class Design:
    """The best designs, what binds them, and what matters.

    Attributes
    ----------
    candidates : tuple of Candidate
        Best designs by the fast tier, best first; those that were simulated are ordered by their
        simulated margin.
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
    limits : tuple of Limit
        What the solid permits, and if the targets are out of reach, what the best designs reach of
        each target alone.
    fast : FastTier
        Predictions of one pad.
    """

    candidates: tuple[Candidate, ...]
    meets: bool | None
    binding: tuple[str, ...]
    elasticities: Mapping[str, Mapping[str, float | None]]
    limits: tuple[Limit, ...]
    fast: FastTier
    front: tuple[Candidate, ...] = ()

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
    if not materials:
        raise InputError("a design needs at least one material")
    if targets.needs_hold and space.hold_speed is None:
        raise InputError("the targets need bounds of the hold_speed")
    if targets.needs_release and space.release_speed is None:
        raise InputError("the targets need bounds of the release_speed")
    work = _Search.begun(materials, traction, space, judge, seed)
    fast, by_surrogates = work.fast, work.fast.budget == SURROGATES
    several = len(targets.stated) > 1
    share = 0.6 / len(materials)
    seen: dict[Choice, Candidate] = {}
    for i, name in enumerate(materials):

        def tell(done: float, i: int = i) -> None:
            progress((i + done) * share)

        if not by_surrogates:
            seen |= work.suggested(name, tell)
            continue
        seen |= work.searched(fast, work.over_needed, name, seed, tell)
        if several:
            seen |= work.ends(name)
    if not seen:
        reasons = [each for each in fast.known.values() if isinstance(each, str)]
        why = max(reasons, key=reasons.count, default="the area has no room for a pad")
        raise OutOfRange(f"no fast tier predicts a design between the bounds: {why}")
    candidates = work.apart(seen)
    limits = solid_limits(fast, space, targets)
    if not candidates[0].is_possible and not any(each.excludes for each in limits):
        limits += work.reached()
    progress(0.6)
    with limited(time_limit):
        tested = work.simulated(candidates, seen, confirm, accuracy, progress)
    tested.sort(key=lambda each: each.rank)
    best = tested[0]
    slopes = slopes_of(best.choice, fast, judge)
    return Design(
        candidates=tuple(tested),
        meets=best.meets(judge.conditions.share),
        binding=binding(best, space, slopes),
        elasticities=slopes,
        limits=limits,
        fast=fast,
        front=front_of(seen.values()) if several else (),
    )


@dataclass(frozen=True, eq=False)
class _Search:
    """Tier, bounds and targets of a search, and the margins that the yield needs."""

    fast: FastTier
    space: DesignSpace
    judge: Judge
    seed: int
    needed: Mapping[str, float]

    @classmethod
    def begun(
        cls,
        materials: Mapping[str, Material],
        traction: Any,
        space: DesignSpace,
        judge: Judge,
        seed: int,
    ) -> _Search:
        """Return a search by surrogates if they predict enough of the space, else by theories."""
        fast = FastTier(materials, traction, SURROGATES)
        tried = [
            judge.judged(choice, fast)
            for name in materials
            for choice in _drawn(space, name, _TRIED, seed)
        ]
        known = [each for each in tried if not isinstance(each, str)]
        if len(known) < _COVERED * len(tried):
            fast = FastTier(materials, traction, THEORIES)
        names, conditions = tuple(judge.targets.stated), judge.conditions
        needed = dict.fromkeys(names, 0.0)
        if known and conditions.deviations:
            best = max(known, key=lambda each: each.margin)
            slopes = slopes_of(best.choice, fast, judge)
            needed = allowances(names, slopes, conditions.deviations, conditions.share)
        return cls(fast, space, judge, seed, needed)

    def rated(self, margins: Mapping[str, float]) -> float:
        """Return the smallest margin over what is needed."""
        return min(margin - self.needed[name] for name, margin in margins.items())

    def over_needed(self, one: Candidate) -> float:
        """Return the rating of a candidate."""
        return self.rated(one.margins)

    def searched(
        self,
        forces: FastTier,
        rate: Callable[[Candidate], float],
        material: str,
        seed: int,
        tell: Callable[[float], None] = lambda share: None,
        effort: Effort = _EFFORT,
    ) -> dict[Choice, Candidate]:
        """Return the designs of a search for the largest rate, with their forces."""
        seen: dict[Choice, Candidate] = {}

        def rating(choice: Choice) -> float:
            found = self.judge.judged(choice, forces)
            if isinstance(found, str):
                return NONE
            seen[choice] = found
            return max(rate(found), NONE)

        search(rating, self.space, material, effort=effort, seed=seed, tell=tell)
        return seen

    def ends(self, material: str) -> dict[Choice, Candidate]:
        """Return designs of shorter searches towards each end of the front."""
        names = tuple(self.judge.targets.stated)
        effort = replace(_END, generations=_END.generations / len(names))
        seen: dict[Choice, Candidate] = {}
        for number, target in enumerate(names):
            needed = {name: -_BONUS * (name != target) for name in names}
            towards = replace(self, needed=needed)
            own = self.seed + number + 1
            seen |= towards.searched(self.fast, towards.over_needed, material, own, effort=effort)
        return seen

    def suggested(self, material: str, tell: Callable[[float], None]) -> dict[Choice, Candidate]:
        """Return designs that theories predict: some drawn, others that interpolation suggests."""
        many = ceil(_SAMPLED * (len(self.space.free) + 1))
        choices = _drawn(self.space, material, many, self.seed)
        seen: dict[Choice, Candidate] = {}
        for number in range(_ROUNDS + 1):
            tried = {choice: self.judge.judged(choice, self.fast) for choice in choices}
            seen |= {choice: found for choice, found in tried.items() if not isinstance(found, str)}
            tell((number + 1) / (_ROUNDS + 1))
            between = interpolated(self.fast, material)
            if between is None or number == _ROUNDS:
                break
            likely = self.searched(between, self.over_needed, material, self.seed + number)
            choices = [each.choice for each in self.apart(likely)]
        return seen

    def apart(self, seen: Mapping[Choice, Candidate]) -> tuple[Candidate, ...]:
        """Return up to three of the best candidates that differ in a variable or the material."""
        low, high = np.array(self.space.ends()).reshape(-1, 2).T
        found: list[Candidate] = []

        def near(one: Choice, other: Choice) -> bool:
            away = np.abs(self.space.places(one) - self.space.places(other))
            return one.material == other.material and bool(np.all(away <= _APART * (high - low)))

        # a wide interval may hide a design that meets the targets behind one that surely does not
        order = sorted(seen.values(), key=lambda x: (not x.is_possible, -self.over_needed(x)))
        for each in order:
            # a worse design is of use only if it may meet the targets too
            if len(found) == 3 or (found and not each.is_possible):
                break
            if not any(near(each.choice, other.choice) for other in found):
                found.append(each)
        return tuple(found)

    def simulated(
        self,
        candidates: tuple[Candidate, ...],
        seen: dict[Choice, Candidate],
        confirm: int,
        accuracy: float,
        progress: Callable[[float], None],
    ) -> list[Candidate]:
        """Return candidates with their simulations, until one meets the targets.

        The next one is the best by corrected predictions, which a further search adds to those that
        were seen, or else the next candidate.
        """
        tested: list[Candidate] = []
        share = self.judge.conditions.share
        waiting = [each for each in candidates[:confirm] if each.is_possible]
        most = len(waiting) + _CORRECTED if waiting else 0
        while len(tested) < most and not (tested and tested[-1].meets(share)):
            known = [each for each in tested if each.run is not None and each.run.margins]
            likely = []
            if known:

                def rate(one: Candidate, known: list[Candidate] = known) -> float:
                    return self.rated(self.corrected(one, known))

                if self.fast.budget == SURROGATES:
                    material = known[-1].choice.material
                    seen |= self.searched(self.fast, rate, material, self.seed, effort=_REACH)
                likely = [max(seen.values(), key=rate)]
            done = {each.choice for each in tested}
            fresh = [each for each in (*likely, *waiting) if each.choice not in done]
            if not fresh:
                break
            run = simulate(fresh[0], self.fast, self.judge, accuracy=accuracy)
            tested.append(self.shared(replace(fresh[0], run=run)))
            progress(0.6 + 0.4 * len(tested) / most)
        done = {each.choice for each in tested}
        return [*tested, *(self.shared(x) for x in candidates if x.choice not in done)]

    def shared(self, one: Candidate) -> Candidate:
        """Return a candidate with the share of parts that meet the targets, by its simulation."""
        deviations = self.judge.conditions.deviations
        if not deviations:
            return one
        margins = one.margins if one.run is None or not one.run.margins else one.run.margins
        slopes = slopes_of(one.choice, self.fast, self.judge)
        return replace(one, share=share_of(margins, slopes, deviations))

    def corrected(self, one: Candidate, known: list[Candidate]) -> dict[str, float]:
        """Return the margins by predictions times the ratio of the nearest simulation to its."""

        def distance(other: Candidate) -> float:
            ratios = (x.value / other.forces[name].value for name, x in one.forces.items())
            return sum(log(ratio) ** 2 for ratio in ratios)

        near = min(known, key=distance)
        assert near.run is not None, "the known ones were simulated"
        forces = {
            name: x.value * near.run.forces[name] / near.forces[name].value
            for name, x in one.forces.items()
        }
        return self.judge.margins(one.choice, forces)

    def reached(self) -> tuple[Limit, ...]:
        """Return the largest or smallest force or ratio between the bounds, each target alone."""
        found = []
        for target, value in wanted(self.judge.targets).items():
            time = self.judge.targets.holding_time if target == "dead_load" else None
            judge = replace(self.judge, targets=Targets(**{target: 1.0}, holding_time=time))

            def alone(choice: Choice, forces: FastTier, judge: Judge = judge) -> float:
                """Return ln of the force or ratio by the favourable ends; NONE without one."""
                one = judge.judged(choice, forces)
                return NONE if isinstance(one, str) else max(min(one.best_margins.values()), NONE)

            tried = []
            for name in self.fast.materials:
                forces: FastTier = self.fast
                if self.fast.budget != SURROGATES:
                    forces = interpolated(self.fast, name) or self.fast
                rating = partial(alone, forces=forces)
                choice = search(rating, self.space, name, effort=_REACH, seed=self.seed)
                # of a theory, if it predicts what the interpolation suggests
                most = alone(choice, self.fast)
                tried.append((rating(choice) if most <= NONE else most, choice))
            most, best = max(tried, key=lambda pair: pair[0])
            reach = exp(-most) if target == "release" else exp(most)
            found.append(Limit(target, value, reach, "speeds", _of_speeds(best, target)))
        return tuple(found)


def _drawn(space: DesignSpace, material: str, count: int, seed: int) -> list[Choice]:
    """Return designs at random places between the bounds."""
    low, high = np.array(space.ends()).reshape(-1, 2).T
    points = np.random.default_rng(seed).random((count, low.size))
    return [space.choice(material, low + point * (high - low)) for point in points]


def _of_speeds(best: Choice, target: str) -> str:
    """Return the design that reaches most, in words."""
    words = []
    if target in ("hold", "work", "ratio"):
        words.append(f"a hold speed of {readable(best.hold_speed or 0.0, 'm/s', digits=3)}")
    if target in ("release", "ratio"):
        words.append(f"a release speed of {readable(best.release_speed or 0.0, 'm/s', digits=3)}")
    pads = (
        f"pads: {best.pads}, R = {readable(best.radius, 'm', digits=3)}, preload "
        f"{readable(best.preload, 'N', digits=3)}"
    )
    return ", ".join([" and ".join(words), pads] if words else [pads])
