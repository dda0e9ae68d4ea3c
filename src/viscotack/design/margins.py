r"""Forces of a design and their margins over the targets, by the fast tier.

**What bounds the forces of a design: the solid at the ends of its spectrum, and the speeds.** The
pull-off force of a sphere lies between those of the relaxed and of the instantaneous solid
(:mod:`viscotack.theory.sphere.bounds`). For N pads

.. math:: \frac32 \pi R \Delta\gamma N f(\mu) \le P \le
          \frac32 \pi R \Delta\gamma N \frac{f(\mu k^{1/3})}{k},

with the elastic f from 1 (JKR) to 4/3 (rigid), and so their ratio is at most 1/k times that of both
f. The bounds are those of simulations at all rates, not a proof.

**What matters: slopes of ln of the forces, what binds, and the share of parts that meet targets.**
The tolerances of a part are factors :math:`e^{s z}` with normal z, cut at three. The margin of a
target is linear in z with the slopes of the design; the share is counted over points of Sobol.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import product
from math import exp, inf, log
from statistics import NormalDist
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.design.fast import FastTier, Force, Pad
from viscotack.design.space import (
    INTERFACE,
    OF_PADS,
    VARIABLES,
    Choice,
    Conditions,
    DesignSpace,
    Targets,
)
from viscotack.errors import InputError
from viscotack.prediction.closed_forms import lennard_jones_alike
from viscotack.theory.elastic.lennard_jones import pull_off_ratio
from viscotack.units import readable


@dataclass(frozen=True)
class Simulated:
    """Simulated forces of a design.

    Attributes
    ----------
    forces : mapping of str to float
        Of all pads, with the names of :class:`Candidate`: "hold", "release" [N] and "work"
        [J], and as "dead_load" the load held for the time [N], by the simulated time under the
        predicted load and the slope of the theory. Those of failed runs are missing.
    margins : mapping of str to float
        Margins of the targets by the simulated forces; empty if a run failed.
    why : str
        Reason of a failed run.
    time : float or None
        Simulated time to detachment under the predicted dead load [s]; None if there is none, or
        if it is longer than ten holding times.
    """

    forces: Mapping[str, float]
    margins: Mapping[str, float]
    why: str = ""
    time: float | None = None

    @property
    def margin(self) -> float | None:
        """Margin of the worst target; None if a run failed."""
        return min(self.margins.values(), default=None)

    @property
    def meets(self) -> bool | None:
        """Whether every target is met; None if a run failed."""
        return None if self.margin is None else self.margin >= 0


@dataclass(frozen=True)
class Candidate:
    """A design with its forces by the fast tier, and its simulation.

    Attributes
    ----------
    choice : Choice
        The design.
    forces : mapping of str to Force
        Of all pads, with 90 % intervals, at the worst of the conditions: pull-off force to "hold"
        and "release" [N], "work" to pull-off [J], and the "dead_load" held for the time [N]; those
        on which a target depends.
    margins : mapping of str to float
        For each target ln of the force over the target, or of the target over the force, by the
        less favourable ends of the intervals; positive if the target is met.
    best_margins : mapping of str to float
        The same by the more favourable ends.
    run : Simulated or None
        Its simulation.
    share : float or None
        Share of the parts that meet the targets, by simulated forces or else by the fast tier;
        None without tolerances.
    """

    choice: Choice
    forces: Mapping[str, Force]
    margins: Mapping[str, float]
    best_margins: Mapping[str, float]
    run: Simulated | None = None
    share: float | None = None

    @property
    def margin(self) -> float:
        """Margin of the worst target, which the search maximises."""
        return min(self.margins.values())

    @property
    def is_possible(self) -> bool:
        """Whether intervals of twice the width leave it open that every target is met.

        One in ten numbers is outside its own interval.
        """
        both = ((self.margins[name], high) for name, high in self.best_margins.items())
        return all(high + (high - low) / 2 >= 0 for low, high in both)

    def meets(self, share: float) -> bool | None:
        """Whether every target is met, in a share of the parts, by simulation; None if open."""
        if self.run is None:
            return None if self.is_possible else False
        if self.run.meets is None or not share:
            return self.run.meets
        return None if self.share is None else self.share >= share

    @property
    def rank(self) -> tuple[float, float]:
        """Order of a candidate: by its simulated yield and margin, then the others."""
        margin = None if self.run is None else self.run.margin
        if margin is None:
            return inf, -self.margin
        return -round(self.share or 0.0, 3), -margin


def pad_of(choice: Choice, speed: float, *, bonded: bool = False) -> Pad:
    """Return one pad of a design at a speed."""
    more = {name: getattr(choice, name) for name in OF_PADS}
    each = choice.preload / choice.pads
    return Pad(choice.material, choice.radius, each, speed, **more, bonded=bonded)


@dataclass(frozen=True)
class Judge:
    """Targets, the conditions at which they count, and how a layer rests on its base."""

    targets: Targets
    conditions: Conditions = Conditions()
    bonded: bool = False

    def pads(self, choice: Choice) -> dict[str, tuple[Pad, ...]]:
        """Return one pad at each hold and release speed, as far as targets need them."""
        speeds = {"hold": choice.hold_speed, "release": choice.release_speed}
        needed = {"hold": self.targets.needs_hold, "release": self.targets.needs_release}
        return {
            name: tuple(
                pad_of(choice, v, bonded=self.bonded)
                for v in self.conditions.speeds(name, choice.material, speed)
            )
            for name, speed in speeds.items()
            if needed[name] and speed is not None
        }

    def forces(self, choice: Choice, fast: FastTier) -> dict[str, Force] | str:
        """Return the forces of a design at the worst conditions, or why none is predicted."""
        found: dict[str, Force] = {}
        for name, pads in self.pads(choice).items():
            some = [fast.force(pad) for pad in pads]
            known = [x for x in some if not isinstance(x, str)]
            if len(known) < len(some):
                return next(x for x in some if isinstance(x, str))
            found[name] = _least(known) if name == "hold" else max(known, key=lambda x: x.high)
            if name == "hold" and self.targets.work is not None:
                works = [x.work for x in known if x.work is not None]
                if len(works) < len(known):
                    return f"the tier {known[0].method!r} has no interval of the work to pull-off"
                found["work"] = _least(works)
        if self.targets.holding_time is not None:
            time = self.conditions.holding_time(choice.material, self.targets.holding_time)
            held = fast.held(pad_of(choice, 1.0, bonded=self.bonded), time)
            if isinstance(held, str):
                return held
            found["dead_load"] = held
        return {name: force.times(choice.pads) for name, force in found.items()}

    def judged(self, choice: Choice, fast: FastTier) -> Candidate | str:
        """Return a design with its forces and margins, or why no tier predicts a force."""
        forces = self.forces(choice, fast)
        if isinstance(forces, str):
            return forces
        low = {name: x.high if name == "release" else x.low for name, x in forces.items()}
        high = {name: x.low if name == "release" else x.high for name, x in forces.items()}
        margins, best = (self.margins(choice, x) for x in (low, high))
        return Candidate(choice, forces, margins, best)

    def margins(self, choice: Choice, forces: Mapping[str, float]) -> dict[str, float]:
        """Return the margin of each target for forces of all pads [N or J]."""
        over: Mapping[str, Callable[[float], float]] = {
            "hold": lambda wanted: _ln(forces["hold"], wanted),
            "release": lambda wanted: -_ln(forces["release"], wanted),
            "ratio": lambda wanted: _ln(forces["hold"], wanted) - _ln(forces["release"], 1.0),
            "work": lambda wanted: _ln(forces["work"], wanted),
            "dead_load": lambda wanted: _ln(forces["dead_load"], wanted),
            "preload": lambda wanted: _ln(wanted, choice.preload),
        }
        return {name: over[name](wanted) for name, wanted in self.targets.stated.items()}


def _least(forces: list[Force]) -> Force:
    return min(forces, key=lambda x: x.low)


def _ln(force: float, over: float) -> float:
    """Return ln of a force over another number; the interval of a poor theory may reach 0."""
    return log(force / over) if force > 0 else -inf


# Number of radii at which bounds are computed.
_RADII = 33
# Preload of a pad of which only the groups are needed [N].
_LIGHT = 1e-12


@dataclass(frozen=True)
class Limit:
    """The most or least that designs reach of one target.

    Attributes
    ----------
    target : str
        "hold", "release", "ratio", "work" or "dead_load".
    wanted, reach : float
        The target, and the largest force, ratio or work, or the smallest force to release [N, 1
        or J].
    cause : str
        "solid" for the relaxed and instantaneous solid, "speeds" for the best design between the
        bounds, by the fast tier.
    why : str
        The bound with its numbers.
    """

    target: str
    wanted: float
    reach: float
    cause: str
    why: str

    @property
    def excludes(self) -> bool:
        """Whether the target is out of reach."""
        return self.wanted < self.reach if self.target == "release" else self.wanted > self.reach

    @property
    def words(self) -> str:
        """The bound as a sentence, where it excludes the target."""
        unit = {"ratio": "1", "work": "J"}.get(self.target, "N")
        least, most = (
            ("at most", "at least") if self.target == "release" else ("at least", "at most")
        )
        cause = {"solid": "the solid permits", "speeds": "designs between the bounds reach"}
        return (
            f"out of reach: {self.target.replace('_', ' ')} of {least} "
            f"{readable(self.wanted, unit)}; {cause[self.cause]} {most} "
            f"{readable(self.reach, unit)}: {self.why}"
        )


def wanted(targets: Targets) -> dict[str, float]:
    """Return the targets with the ratio that hold and release imply."""
    return replace(targets, ratio=targets.least_ratio, preload=None).stated


def solid_limits(fast: FastTier, space: DesignSpace, targets: Targets) -> tuple[Limit, ...]:
    """Return the bounds by the relaxed and the instantaneous solid, the widest of all materials.

    They are those of spheres on a half-space; of works, layers and other tips none is known.
    """
    if space.thickness is not None or space.exponent is not None:
        return ()
    moduli = [None] if space.modulus is None else [space.modulus.low, space.modulus.top]
    radii = np.geomspace(space.radius.low, space.radius.top, _RADII).tolist()
    reached = {"hold": [(-inf, "")], "release": [(inf, "")], "ratio": [(-inf, "")]}
    sizes = [(R, modulus) for R in radii for modulus in moduli]
    for name, (R, modulus) in product(fast.materials, sizes):
        many = space.most_pads(R)
        if not many:
            continue
        try:
            problem = fast.problem(Pad(name, R, _LIGHT, 1.0, modulus))
        except InputError:  # the sphere is too small for the range of attraction
            continue
        groups = lennard_jones_alike(problem.groups())
        k, unit, few = groups.modulus_ratio, problem.scales().force, int(space.pads.low)
        slow, quick = (float(pull_off_ratio(groups.tabor * x)) for x in (1.0, k ** (1 / 3)))
        words = f"{readable(unit, 'N', digits=3)} (1.5 pi R dg, R = {readable(R, 'm', digits=3)})"
        hold = f"{many} times {words} times {quick / k:.4g} (f/k) of the instantaneous solid"
        release = f"{few} times {words} times {slow:.3g} (f) of the relaxed solid"
        ratio = (
            f"instantaneous over relaxed modulus (1/k = {1 / k:.4g}), times {quick / slow:.3g} for "
            "the range of attraction"
        )
        reached["hold"].append((many * unit * quick / k, hold))
        reached["release"].append((few * unit * slow, release))
        reached["ratio"].append((quick / slow / k, ratio))
    reached["dead_load"] = reached["hold"]
    found = []
    for target, value in wanted(targets).items():
        if target in reached:
            reach, why = (min if target == "release" else max)(reached[target])
            found.append(Limit(target, value, reach, "solid", why))
    return tuple(found)


# Points, and where normal deviates are cut.
_POINTS, _CUT = 2**12, 3.0
# Step of logarithms for slopes, part of a range within which a variable is at its end, largest
# difference of margins that bind together, and least slope of a bound that binds.
_STEP, _AT_END, _TOGETHER, _SLOPE = 0.02, 5e-3, 0.02, 1e-3
Slopes = Mapping[str, Mapping[str, float | None]]


# Speed on which a force depends.
_OWN = {"hold": "hold_speed", "work": "hold_speed", "release": "release_speed"}


def slopes_of(choice: Choice, fast: FastTier, judge: Judge) -> Slopes:
    """Return d ln P/d ln x of the forces of a design by central differences of the fast tier."""
    if "modulus" in judge.conditions.deviations and choice.modulus is None:
        modulus = getattr(fast.materials[choice.material], "rubbery_modulus", None)
        choice = replace(choice, modulus=modulus)
    ends: dict[str, list[Any]] = {}
    for name in VARIABLES:
        if name != "pads" and (value := getattr(choice, name)) is not None:
            both = (replace(choice, **{name: value * exp(step)}) for step in (-_STEP, _STEP))
            ends[name] = [judge.forces(each, fast) for each in both]
    for name in INTERFACE:
        if (value := getattr(fast.traction, name, None)) is not None:
            laws = (replace(fast.traction, **{name: value * exp(x)}) for x in (-_STEP, _STEP))
            tiers = (FastTier(fast.materials, law, fast.budget) for law in laws)
            ends[name] = [judge.forces(choice, each) for each in tiers]
    forces = judge.forces(choice, fast)
    slopes: dict[str, dict[str, float | None]] = {}
    for force in () if isinstance(forces, str) else forces:
        own: dict[str, float | None] = {}
        for name, (low, high) in ends.items():
            if name in ("hold_speed", "release_speed") and name != _OWN.get(force):
                continue
            # none where no tier predicts
            slope = None
            if not isinstance(low, str) and not isinstance(high, str):
                slope = log(high[force].value / low[force].value) / (2 * _STEP)
            own[name] = slope
            if name == "preload":
                # N pads under the preload F are N times one under F/N
                own["pads"] = None if slope is None else 1 - slope
        slopes[force] = own
    return slopes


def binding(best: Candidate, space: DesignSpace, slopes: Slopes) -> tuple[str, ...]:
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
        more = sum(gain(x, "pads", slopes) or 0.0 for x in worst)
        bounds += ["area at most"] if more > _SLOPE else []
    return (*worst, *bounds)


def gain(target: str, name: str, slopes: Slopes) -> float | None:
    """Return the slope of the margin of a target by ln of a variable; None where unknown."""
    if target == "preload":
        return -1.0 if name == "preload" else 0.0
    of = {"release": (("release", -1),), "ratio": (("hold", 1), ("release", -1))}
    total = 0.0
    for force, sign in of.get(target, ((target, 1),)):
        slope = slopes.get(force, {}).get(name, 0.0)
        if slope is None:
            return None
        total += sign * slope
    return total


def share_of(
    margins: Mapping[str, float], slopes: Slopes, deviations: Mapping[str, float]
) -> float | None:
    """Return the share of parts whose margins are all positive; None where a slope is unknown."""
    z = _deviates(len(deviations))
    met = np.ones(len(z), dtype=bool)
    for target, margin in margins.items():
        gains = [gain(target, name, slopes) for name in deviations]
        if any(x is None for x in gains):
            return None
        met &= margin + z @ (np.array(gains) * np.array(list(deviations.values()))) >= 0
    return float(met.mean())


def allowances(
    targets: tuple[str, ...], slopes: Slopes, deviations: Mapping[str, float], share: float
) -> dict[str, float]:
    """Return the margins by which each target must be met, so that together this share meets all.

    Each target has an equal part of the rejects, an upper bound of them.
    """
    z = NormalDist().inv_cdf(1 - (1 - share) / len(targets)) if deviations else 0.0
    found = {}
    for target in targets:
        gains = [(gain(target, name, slopes) or 0.0) * s for name, s in deviations.items()]
        found[target] = z * float(np.linalg.norm(gains))
    return found


@lru_cache(maxsize=8)
def _deviates(count: int) -> Array:
    from scipy.stats import qmc, truncnorm

    drawn = qmc.Sobol(count, rng=np.random.default_rng(count)).random(_POINTS)
    return truncnorm.ppf(drawn, -_CUT, _CUT)
