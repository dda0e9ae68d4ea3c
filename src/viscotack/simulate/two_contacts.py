r"""March of two contacts in series: a rigid object between two bodies that a drive pulls apart.

Both contacts carry the force F of the machine. Their depths and the spring K add up to the drive,

.. math:: \delta_1 + \delta_2 + F/K = D(t), \qquad F_1 = F_2 = F,

where D falls at the constant speed V from relaxed contacts under a common force. Each contact has
its own mesh, memory and energy terms, in its own units. A step has one length for both: the first
contact is moved to a trial depth, its force gives the extension of the spring, and the rest of the
drive is the depth of the second. The trial depth is the root of :math:`F_1 - F_2` by the secant
method. Each trial is a step of a contact at imposed depth (:mod:`.steps`, :mod:`.travelling`), so
steps, meshes and energies are controlled as in a march of one contact.

The run ends when one contact has separated, when the tension has fallen to a fraction of its
maximum, or at a jump: a step so short that both solids respond instantaneously has no equilibrium
at equal forces. The contact that opens is the one whose edge recedes faster, relative to its
radius, in the last steps.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, log
from typing import NamedTuple

from viscotack.clock import TimeUp
from viscotack.simulate.body import step
from viscotack.simulate.history import History
from viscotack.simulate.jumps import followed
from viscotack.simulate.machine import Leg
from viscotack.simulate.march import Part, begun_run, narrowed
from viscotack.simulate.settings import Settings
from viscotack.simulate.steps import (
    UNBALANCED_CUT,
    Attempt,
    MarchState,
    Run,
    arrived,
    clipped,
    cut,
    instant,
    tried,
    weighed,
)
from viscotack.simulate.surface import separated
from viscotack.simulate.travelling import ahead, travelled

# Forces count as equal within this fraction of their scale; most trials of a step; a step whose
# forces differ by up to `_NEARLY` is accepted if round-off prevents a better one.
_EQUAL, _MOST_TRIALS, _NEARLY = 1e-7, 12, 1e-5
# Smallest scale of the forces, in units of the stronger contact.
_LEAST_FORCE = 0.1
# The run ends when the tension has fallen to this fraction of its maximum.
_LEFT = 0.2
# A step of the shortest length that misses more energy than this multiple of the tolerated one
# contains a jump.
_CLEARLY = 5.0
# Largest speed of a contact over that of the drive; a faster opening counts as a jump.
_RUNNING = 1e4
# Shortest step over the first one.
_SHORTER = 0.05
# Number of steps at the end of a run over which the recession of the edges is compared.
_LAST = 5
# Both contacts open together if their recessions differ by less than this fraction.
_TOGETHER = 1e-3
# Most steps of a run.
_MOST_STEPS = 50_000


@dataclass(frozen=True)
class Units:
    """SI values of the units of a contact: depth [m], force [N], time [s]."""

    depth: float
    force: float
    time: float


@dataclass(eq=False)
class SeriesHistory:
    """History of two contacts in series.

    Attributes
    ----------
    histories : pair of History
        Those of the contacts, in their own units; their snapshots belong to the same instants.
    outcome : str
        "detached" (a contact separated), "fallen" (the tension fell), "jump", "steps" or "time".
    opened : int
        The contact that opens, 0 or 1; -1 if both open together, or the run was stopped before.
    reason : str
        Message of the time limit.
    """

    histories: tuple[History, History]
    outcome: str = ""
    opened: int = -1
    reason: str = ""


def march_in_series(
    parts: tuple[Part, Part],
    units: tuple[Units, Units],
    *,
    speed: float,
    stiffness: float | None,
    settings: Settings,
) -> SeriesHistory:
    """Pull two contacts in series apart at a speed [m/s] through a spring [N/m], None if rigid."""
    first, second = (
        _begun(part, unit, settings, speed) for part, unit in zip(parts, units, strict=True)
    )
    pair = _Pair((first, second), speed, inf if stiffness is None else stiffness)
    history = SeriesHistory((first.run.history, second.run.history))
    try:
        while not history.outcome:
            history.outcome = pair.stepped() or pair.judged()
    except TimeUp as limit:
        history.outcome, history.reason = "time", str(limit)
    if history.outcome not in ("steps", "time"):
        history.opened = pair.opening
    return history


class _Moved(NamedTuple):
    """A trial step of one side, with depth [m] and force [N] at its end."""

    at: MarchState
    attempt: Attempt
    depth: float
    force: float


@dataclass(frozen=True, eq=False)
class _Side:
    """One of the two contacts between steps.

    `speed` is the rate of its depth [m/s] in the last step, `stiffness` its change of force by
    depth [N/m], and `least_step` the length [s] of its first step.
    """

    run: Run
    at: MarchState
    units: Units
    speed: float
    stiffness: float
    least_step: float

    @property
    def depth(self) -> float:
        """Depth [m], positive into the solid."""
        return self.at.seen.depth * self.units.depth

    @property
    def force(self) -> float:
        """Force [N], positive in compression."""
        return self.at.seen.force * self.units.force

    def longest(self) -> float:
        """Longest next step [s] by the criteria of this contact alone."""
        rate = self.speed / self.units.depth * self.units.time
        at = clipped(self.run, replace(self.at, leg=replace(self.at.leg, rate=rate)))
        goal = ahead(self.run, at)
        return (at.dt if goal is None else min(goal.dt, at.dt)) * self.units.time

    def receded(self) -> float:
        """Return ln of the ratio by which the radius fell in the last steps."""
        edges = [x.edge for x in self.run.history.snapshots[-1 - _LAST :]]
        return log(edges[0] / edges[-1]) if edges[-1] > 0 else inf

    def moved(self, dt: float, depth: float) -> _Moved | None:
        """Return a step of length dt [s] to a depth [m]; None without an equilibrium there."""
        run, began, own = self.run, self.at.seen, dt / self.units.time
        rate = (depth / self.units.depth - began.depth) / own
        at = replace(self.at, leg=replace(self.at.leg, rate=rate), began=began, dt=own)
        goal = ahead(run, at)
        if goal is None:
            s = step(run.body.modes, own)
            trial = tried(run, at, s)
            attempt = None if trial.lost or trial.released else weighed(run, at, s, trial)
        else:
            attempt = travelled(run, at, goal) if goal.dt == own else None
        if attempt is None:
            return None
        seen = attempt.after.seen
        return _Moved(at, attempt, seen.depth * self.units.depth, seen.force * self.units.force)


class _Pair:
    """Both contacts between steps; depth of the drive [m] and largest tension so far [N]."""

    def __init__(self, sides: tuple[_Side, _Side], speed: float, spring: float) -> None:
        self.sides, self.speed, self.spring = sides, speed, spring
        self.drive = sides[0].depth + sides[1].depth + sides[0].force / spring
        self.largest_tension = 0.0

    @property
    def opening(self) -> int:
        """The contact whose edge recedes faster, relative to its radius; -1 if both do."""
        first, second = (side.receded() for side in self.sides)
        together = first == second or abs(first - second) < _TOGETHER * max(first, second)
        return -1 if together else int(second > first)

    def stepped(self) -> str:
        """Advance by one step, shortened until it is accepted; return the outcome of the run."""
        dt = min(side.longest() for side in self.sides)
        fastest = max(1.0, *(abs(side.speed) / self.speed for side in self.sides))
        least = _SHORTER * min(side.least_step for side in self.sides) / min(fastest, _RUNNING)
        while True:
            found = self.split(dt)
            # a shorter step would not change the result
            shortest = dt <= least * (1 + 1e-9) and all(
                instant(side.run, step(side.run.body.modes, dt / side.units.time))
                for side in self.sides
            )
            attempts = [] if found is None else [each.attempt for each in found[0]]
            # a contact loses energy in a step that should be reversible
            jumps = any(abs(a.missing) > _CLEARLY * a.tolerated for a in attempts)
            if shortest and (found is None or jumps):
                return "jump"
            if found is None:
                dt *= UNBALANCED_CUT
            elif any(a.too_long for a in attempts) and not shortest:
                dt *= cut(max(a.strain for a in attempts))
            else:
                break
            for side in self.sides:
                side.run.history.rejected += 1
        first, second = (
            replace(
                side,
                at=arrived(moved.at, moved.attempt),
                speed=(moved.depth - side.depth) / dt,
                stiffness=stiffness,
            )
            for side, moved, stiffness in zip(self.sides, *found, strict=True)
        )
        self.sides, self.drive = (first, second), self.drive - self.speed * dt
        for side in self.sides:
            side.run.keep(side.at)
        self.largest_tension = max(self.largest_tension, -first.force)
        return ""

    def split(self, dt: float) -> tuple[tuple[_Moved, _Moved], list[float]] | None:
        """Find the step at whose end both forces are equal, and the stiffnesses [N/m] of the sides.

        None if there is no equilibrium at equal forces.
        """
        (one, other), before, best, least = self.sides, None, None, inf
        drive, slopes = self.drive - self.speed * dt, [one.stiffness, other.stiffness]
        depth = one.depth + dt * one.speed
        scale = max(side.units.force for side in self.sides)
        scale = max(abs(one.force), self.largest_tension, _LEAST_FORCE * scale)
        for _ in range(_MOST_TRIALS):
            if (first := one.moved(dt, depth)) is None:
                return None
            second = other.moved(dt, drive - first.force / self.spring - depth)
            if second is None:
                return None
            off, now = first.force - second.force, (first, second)
            if before is not None:
                for i, (then, moved) in enumerate(zip(before, now, strict=True)):
                    change = moved.force - then.force
                    if abs(change) > _EQUAL * scale:  # else round-off prevails
                        slopes[i] = change / (moved.depth - then.depth)
            if abs(off) < least:
                best, least = (now, slopes.copy()), abs(off)
            if abs(off) < _EQUAL * scale:
                return best
            slope = slopes[0] + slopes[1] * (1 + slopes[0] / self.spring)
            if not slope > 0:
                return None
            before, depth = now, depth - off / slope
        return best if least < _NEARLY * scale else None

    def judged(self) -> str:
        """Return the outcome if the run has ended; remesh where an edge has left the fine nodes."""
        first, tension = self.sides[0], -self.sides[0].force
        if any(separated(side.at.state.gap, side.run.body.contact.span) for side in self.sides):
            return "detached"
        if 0 < self.largest_tension and tension < _LEFT * self.largest_tension:
            if first.at.lowest.since > _LAST:
                return "fallen"
        if len(first.run.history.snapshots) > _MOST_STEPS:
            return "steps"
        self.sides = _remeshed(self.sides[0]), _remeshed(self.sides[1])
        return ""


def _remeshed(side: _Side) -> _Side:
    at = side.at
    if at.mesh.left_by(at.seen.edge, at.seen.inner) or narrowed(side.run, at):
        return replace(side, at=followed(side.run, at))
    return side


def _begun(part: Part, units: Units, settings: Settings, speed: float) -> _Side:
    """Return a contact at its relaxed start; each takes half the speed of the drive at first."""
    travel = part.contact.travel
    rate = speed / 2 / units.depth * units.time
    leg = Leg(inf, -rate, least_step=settings.first_travel * travel / rate)
    run, at = begun_run(part, (leg,), settings)
    run.keep(at)
    at = replace(at, state=run.body.at_rest(at.state))
    stiffness = units.force / (travel * units.depth)
    side = _Side(run, at, units, -speed / 2, stiffness, leg.least_step * units.time)
    # the stiffness of a fast solid is larger by up to the ratio of its moduli
    moved = side.moved(side.least_step, side.depth - speed / 2 * side.least_step)
    if moved is None:
        return side
    known = (moved.force - side.force) / (moved.depth - side.depth)
    return replace(side, stiffness=known) if known > 0 else side
