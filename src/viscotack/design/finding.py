r"""Find a design: the largest margin of the worst target by the fast tier, then simulations.

The margin of a target is :math:`\ln(P/P_\mathrm{hold})` or :math:`\ln(P_\mathrm{release}/P)`, with
the less favourable end of the interval of P. Differential evolution maximises the smallest one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import ceil, exp, log
from typing import Any

import numpy as np

from viscotack.clock import limited
from viscotack.errors import InputError, OutOfRange
from viscotack.materials import Material
from viscotack.problem.accuracy import DEFAULT_ACCURACY
from viscotack.units import readable

from .confirming import Simulated, simulate
from .fast import SURROGATES, THEORIES, FastTier, Forces, Pad
from .interpolating import interpolation
from .limits import SPEEDS, Limit, solid_limits, wanted
from .margins import Candidate, judged, pads_of
from .searching import NONE, Effort, search
from .space import (
    HOLD,
    HOLD_SPEED,
    PADS,
    PRELOAD,
    RADIUS,
    RATIO,
    RELEASE,
    RELEASE_SPEED,
    Choice,
    DesignSpace,
    Targets,
)

# Sizes of searches: of all targets together, and of one alone.
_EFFORT, _REACH = Effort(3.3, 5.5), Effort(3.3, 2)
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
        For "hold" and "release" d ln P/d ln x of the first design; None where no tier predicts.
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
    confirm : int
        Number of candidates that are simulated, 0 to 3.
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
    check_stated(materials, space, targets)
    fast = _covering(materials, traction, space, targets, seed)
    share = 0.6 / len(materials)
    seen: dict[Choice, Candidate] = {}
    for i, name in enumerate(materials):
        by = _searched if fast.budget == SURROGATES else _suggested
        seen |= by(fast, space, targets, name, seed, lambda done, i=i: progress((i + done) * share))
    if not seen:
        raise OutOfRange(f"no fast tier predicts a design between the bounds: {_reason(fast)}")
    candidates = _apart(seen, space)
    limits = solid_limits(fast, space, targets)
    if not candidates[0].is_possible and not any(each.excludes for each in limits):
        limits += _reached(fast, space, targets, seed)
    some = [each for each in candidates[:confirm] if each.is_possible]
    runs: list[Simulated] = []
    with limited(time_limit):
        for each in some:
            runs.append(simulate(each, fast, targets, accuracy=accuracy))
            progress(0.6 + 0.4 * len(runs) / len(some))
    candidates, simulated = _ranked(candidates, runs)
    best = candidates[0]
    slopes = _elasticities(best, fast, targets)
    return Design(
        candidates=candidates,
        simulated=simulated,
        meets=_meets(best, simulated[0]),
        binding=_binding(best, space, slopes),
        elasticities=slopes,
        limits=limits,
        fast=fast,
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
    targets: Targets,
    seed: int,
) -> FastTier:
    """Return the surrogates if they predict enough of the space, otherwise the theories."""
    fast = FastTier(materials, traction, SURROGATES)
    tried = [
        judged(choice, fast, targets)
        for name in materials
        for choice in _drawn(space, name, _TRIED, seed)
    ]
    covered = sum(not isinstance(each, str) for each in tried) / len(tried)
    return fast if covered >= _COVERED else FastTier(materials, traction, THEORIES)


def _searched(
    forces: Forces,
    space: DesignSpace,
    targets: Targets,
    material: str,
    seed: int,
    tell: Callable[[float], None] = lambda share: None,
) -> dict[Choice, Candidate]:
    """Return the designs of a search with their forces."""
    seen: dict[Choice, Candidate] = {}

    def rating(choice: Choice) -> float:
        found = judged(choice, forces, targets)
        if isinstance(found, str):
            return NONE
        seen[choice] = found
        return max(found.margin, NONE)

    search(rating, space, material, effort=_EFFORT, seed=seed, tell=tell)
    return seen


def _suggested(
    fast: FastTier,
    space: DesignSpace,
    targets: Targets,
    material: str,
    seed: int,
    tell: Callable[[float], None],
) -> dict[Choice, Candidate]:
    """Return designs that theories predict: some are drawn, and others interpolation suggests."""
    choices = _drawn(space, material, ceil(_SAMPLED * (len(space.free) + 1)), seed)
    seen: dict[Choice, Candidate] = {}
    for number in range(_ROUNDS + 1):
        tried = {choice: judged(choice, fast, targets) for choice in choices}
        seen |= {choice: found for choice, found in tried.items() if not isinstance(found, str)}
        tell((number + 1) / (_ROUNDS + 1))
        between = interpolation(fast, material)
        if between is None or number == _ROUNDS:
            break
        likely = _searched(between, space, targets, material, seed + number)
        choices = [each.choice for each in _apart(likely, space)]
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


def _apart(seen: Mapping[Choice, Candidate], space: DesignSpace) -> tuple[Candidate, ...]:
    """Return up to three of the best candidates that differ in a variable or in the material."""
    ends = np.array(space.ends()).reshape(-1, 2)
    found: list[Candidate] = []
    for each in sorted(seen.values(), key=lambda one: -one.margin):
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


def _ranked(
    candidates: tuple[Candidate, ...], runs: list[Simulated]
) -> tuple[tuple[Candidate, ...], tuple[Simulated | None, ...]]:
    """Return candidates by their simulated margins, followed by those without a simulation."""

    def rank(pair: tuple[Candidate, Simulated | None]) -> float:
        margin = None if pair[1] is None else pair[1].margin
        return np.inf if margin is None else -margin

    rest: list[Simulated | None] = [None] * (len(candidates) - len(runs))
    pairs = sorted(zip(candidates, [*runs, *rest], strict=True), key=rank)
    first, second = zip(*pairs, strict=True)
    return first, second


def _meets(best: Candidate, run: Simulated | None) -> bool | None:
    if run is not None:
        return run.meets
    return None if best.is_possible else False


def _reached(fast: FastTier, space: DesignSpace, targets: Targets, seed: int) -> tuple[Limit, ...]:
    """Return the largest or smallest force or ratio between the bounds, each target alone."""
    found = []
    for target, value in wanted(targets).items():
        rating = partial(_alone, targets=targets, target=target)
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


def _alone(choice: Choice, *, fast: Forces, targets: Targets, target: str) -> float:
    """Return ln of the force or ratio of a design by the favourable ends; NONE without one."""
    needed = (HOLD, RELEASE) if target == RATIO else (target,)
    pads = pads_of(choice, targets)
    forces = {name: fast.force(pads[name]) for name in needed}
    total = 0.0
    for name, force in forces.items():
        if isinstance(force, str) or force.low <= 0:
            return NONE
        total += log(choice.pads * force.high) if name == HOLD else -log(choice.pads * force.low)
    return total


def _of_speeds(best: Choice, target: str) -> str:
    """Return the design that reaches most, in words."""
    needed = {HOLD: (HOLD_SPEED,), RELEASE: (RELEASE_SPEED,), RATIO: (HOLD_SPEED, RELEASE_SPEED)}
    said = {HOLD_SPEED: "hold", RELEASE_SPEED: "release"}
    speeds = " and ".join(
        f"a {said[name]} speed of {readable(getattr(best, name), 'm/s', digits=3)}"
        for name in needed[target]
    )
    return (
        f"{speeds}, pads: {best.pads}, R = {readable(best.radius, 'm', digits=3)}, preload "
        f"{readable(best.preload, 'N', digits=3)}"
    )


# What matters ---------------------------------------------------------------------------------


def _elasticities(
    best: Candidate, fast: FastTier, targets: Targets
) -> dict[str, dict[str, float | None]]:
    """Return d ln P/d ln x of the forces by central differences of the fast tier."""
    found = {}
    for name, pad in pads_of(best.choice, targets).items():
        of_pad = {x: _slope(fast, pad, x) for x in (RADIUS, PRELOAD, "speed")}
        own = HOLD_SPEED if name == HOLD else RELEASE_SPEED
        by_preload = of_pad[PRELOAD]
        found[name] = {
            RADIUS: of_pad[RADIUS],
            PRELOAD: by_preload,
            own: of_pad["speed"],
            # N pads under the preload F are N times one under F/N
            PADS: None if by_preload is None else 1 - by_preload,
            **{x: _interface_slope(fast, pad, x) for x in _INTERFACE if hasattr(fast.traction, x)},
        }
    return found


_INTERFACE = ("work_of_adhesion", "equilibrium_gap")


def _slope(fast: FastTier, pad: Pad, name: str) -> float | None:
    """Return d ln P/d ln x for a variable of a pad."""
    value = getattr(pad, name)
    ends = [fast.force(replace(pad, **{name: value * exp(step)})) for step in (-_STEP, _STEP)]
    return _difference(*ends)


def _interface_slope(fast: FastTier, pad: Pad, name: str) -> float | None:
    """Return d ln P/d ln x for a number of the interface."""
    value = getattr(fast.traction, name)
    ends = []
    for step in (-_STEP, _STEP):
        law = replace(fast.traction, **{name: value * exp(step)})
        ends.append(FastTier(fast.materials, law, fast.budget).force(pad))
    return _difference(*ends)


def _difference(low: Any, high: Any) -> float | None:
    if isinstance(low, str) or isinstance(high, str):
        return None
    return log(high.value / low.value) / (2 * _STEP)


def _binding(
    best: Candidate, space: DesignSpace, slopes: Mapping[str, Mapping[str, float | None]]
) -> tuple[str, ...]:
    """Return the targets with the smallest margin, and the bounds beyond which it would grow."""
    worst = [x for x, margin in best.margins.items() if margin <= best.margin + _TOGETHER]
    bounds = []
    for name, (low, high), place in zip(
        space.free, space.ends(), space.places(best.choice).tolist(), strict=True
    ):
        # where several targets bind they share the gain
        gain = sum(_gain(target, name, slopes) for target in worst)
        near = _AT_END * (high - low)
        if gain > _SLOPE and place >= high - near:
            bounds.append(f"{name} at most")
        elif gain < -_SLOPE and place <= low + near:
            bounds.append(f"{name} at least")
    if space.area is not None and best.choice.pads == space.most_pads(best.choice.radius):
        bounds += ["area at most"] if sum(_gain(x, PADS, slopes) for x in worst) > _SLOPE else []
    return (*worst, *bounds)


def _gain(target: str, name: str, slopes: Mapping[str, Mapping[str, float | None]]) -> float:
    """Return the slope of the margin of a target by ln of a variable; 0 where unknown."""
    hold, release = (slopes.get(x, {}).get(name) or 0.0 for x in (HOLD, RELEASE))
    return {HOLD: hold, RELEASE: -release, RATIO: hold - release}[target]
