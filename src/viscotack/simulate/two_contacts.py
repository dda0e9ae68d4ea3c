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

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, log

from viscotack.clock import TimeUp
from viscotack.simulate.history import History, Snapshot
from viscotack.simulate.interface import separated
from viscotack.simulate.jumps import followed
from viscotack.simulate.machine import Leg
from viscotack.simulate.march import Part, Units, begun_run, narrowed
from viscotack.simulate.memory import step
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
    *,
    speed: float,
    stiffness: float | None,
    settings: Settings,
    watch: Callable[[float, float], None] | None = None,
) -> SeriesHistory:
    """Pull two contacts in series apart at a speed [m/s] through a spring [N/m], None if rigid.

    `watch` is called after each step with the time [s] and the force [N].
    """
    first, second = (begun_side(part, settings, speed) for part in parts)
    K = inf if stiffness is None else stiffness
    drive = first.depth + second.depth + first.force / K
    pair = _Pair(first, second, speed, K, drive)
    history = SeriesHistory((first.run.history, second.run.history))
    try:
        while not history.outcome:
            pair, history.outcome = _stepped(pair)
            if not history.outcome:
                pair, history.outcome = _judged(pair)
            if watch is not None:
                watch(first.units.time * pair.first.at.seen.time, pair.force)
    except TimeUp as limit:
        history.outcome, history.reason = "time", str(limit)
    if history.outcome not in ("steps", "time"):
        history.opened = pair.opening
    return history


@dataclass(frozen=True, eq=False)
class Side:
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

    def is_instant(self, dt: float) -> bool:
        """Whether the solid responds instantaneously to a step of this length [s]."""
        return instant(self.run, step(self.run.body.modes, dt / self.units.time))

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
        if goal is not None:
            attempt = travelled(run, at, goal) if goal.dt == own else None
            return None if attempt is None else _Moved(at, attempt, self.units)
        s = step(run.body.modes, own)
        trial = tried(run, at, s)
        if trial.lost or trial.released:
            return None
        return _Moved(at, weighed(run, at, s, trial), self.units)

    def arrived(self, moved: _Moved, dt: float, stiffness: float) -> Side:
        """Return the side after an accepted step."""
        speed = (moved.depth - self.depth) / dt
        after = arrived(moved.at, moved.attempt)
        self.run.keep(after)
        return replace(self, at=after, speed=speed, stiffness=stiffness)

    def remeshed(self) -> Side:
        """Return the side with fine nodes around its edge, if the edge has left them."""
        at = self.at
        if at.mesh.left_by(at.seen.edge, at.seen.inner) or narrowed(self.run, at):
            return replace(self, at=followed(self.run, at))
        return self


@dataclass(frozen=True, eq=False)
class _Moved:
    """A trial step of one side."""

    at: MarchState
    attempt: Attempt
    units: Units

    @property
    def seen(self) -> Snapshot:
        return self.attempt.after.seen

    @property
    def force(self) -> float:
        return self.seen.force * self.units.force

    @property
    def depth(self) -> float:
        return self.seen.depth * self.units.depth


@dataclass(frozen=True, eq=False)
class _Split:
    """Trial steps of both sides, their stiffnesses [N/m], and the difference of forces [N]."""

    moved: tuple[_Moved, _Moved]
    stiffness: tuple[float, float]
    difference: float

    @property
    def strain(self) -> float:
        """Squared ratio of the step to the allowed one, the larger of both."""
        return max(each.attempt.strain for each in self.moved)

    @property
    def too_long(self) -> bool:
        """Whether the step must be rejected."""
        return any(each.attempt.too_long for each in self.moved)

    @property
    def jumps(self) -> bool:
        """Whether a contact loses energy in a step that should be reversible."""
        attempts = [each.attempt for each in self.moved]
        return any(abs(a.missing) > _CLEARLY * a.tolerated for a in attempts)


@dataclass(frozen=True, eq=False)
class _Pair:
    """Both contacts between steps; depth of the drive [m] and largest tension so far [N]."""

    first: Side
    second: Side
    speed: float
    spring: float
    drive: float
    largest_tension: float = 0.0

    @property
    def sides(self) -> tuple[Side, Side]:
        return self.first, self.second

    @property
    def force(self) -> float:
        """Common force [N], positive in compression."""
        return self.first.force

    @property
    def scale(self) -> float:
        """Scale of the forces [N]."""
        units = max(side.units.force for side in self.sides)
        return max(abs(self.force), self.largest_tension, _LEAST_FORCE * units)

    @property
    def opening(self) -> int:
        """The contact whose edge recedes faster, relative to its radius; -1 if both do."""
        first, second = self.first.receded(), self.second.receded()
        together = first == second or abs(first - second) < _TOGETHER * max(first, second)
        return -1 if together else int(second > first)

    def is_shortest(self, dt: float) -> bool:
        """Whether a shorter step [s] would not change the result."""
        fastest = max(1.0, *(abs(side.speed) / self.speed for side in self.sides))
        least = _SHORTER * min(side.least_step for side in self.sides) / min(fastest, _RUNNING)
        return dt <= least * (1 + 1e-9) and all(side.is_instant(dt) for side in self.sides)

    def split(self, dt: float) -> _Split | None:
        """Find the depths after a step at which both forces are equal; None if there are none."""
        drive, slopes, before = self.drive - self.speed * dt, [], None
        slopes = [side.stiffness for side in self.sides]
        depth, best = self.first.depth + dt * self.first.speed, None
        for _ in range(_MOST_TRIALS):
            first = self.first.moved(dt, depth)
            if first is None:
                return None
            second = self.second.moved(dt, drive - first.force / self.spring - depth)
            if second is None:
                return None
            off, now = first.force - second.force, (first, second)
            if before is not None:
                slopes = [self._slope(*x) for x in zip(before, now, slopes, strict=True)]
            if best is None or abs(off) < abs(best.difference):
                best = _Split(now, (slopes[0], slopes[1]), off)
            if abs(off) < _EQUAL * self.scale:
                return best
            slope = slopes[0] + slopes[1] * (1 + slopes[0] / self.spring)
            if not slope > 0:
                return None
            before, depth = now, depth - off / slope
        close = best is not None and abs(best.difference) < _NEARLY * self.scale
        return best if close else None

    def _slope(self, before: _Moved, now: _Moved, known: float) -> float:
        """Return the stiffness between two trials [N/m]; the known one if round-off prevails."""
        travel, change = now.depth - before.depth, now.force - before.force
        return change / travel if abs(change) > _EQUAL * self.scale else known

    def after(self, split: _Split, dt: float) -> _Pair:
        """Return the pair after an accepted step."""
        first, second = (
            side.arrived(moved, dt, stiffness)
            for side, moved, stiffness in zip(self.sides, split.moved, split.stiffness, strict=True)
        )
        drive, most = self.drive - self.speed * dt, max(self.largest_tension, -first.force)
        return replace(self, first=first, second=second, drive=drive, largest_tension=most)


def begun_side(part: Part, settings: Settings, speed: float) -> Side:
    """Return a contact at its relaxed start; each takes half the speed of the drive at first."""
    contact, units = part.contact, part.units
    rate = speed / 2 / units.depth * units.time
    leg = Leg(inf, -rate, least_step=settings.first_travel * contact.travel / rate)
    run, at = begun_run(part, leg, settings)
    at = replace(at, state=run.body.at_rest(at.state))
    stiffness = units.force / (contact.travel * units.depth)
    side = Side(run, at, units, -speed / 2, stiffness, leg.least_step * units.time)
    # the stiffness of a fast solid is larger by up to the ratio of its moduli
    moved = side.moved(side.least_step, side.depth - speed / 2 * side.least_step)
    if moved is None:
        return side
    known = (moved.force - side.force) / (moved.depth - side.depth)
    return replace(side, stiffness=known) if known > 0 else side


def _stepped(pair: _Pair) -> tuple[_Pair, str]:
    """Advance by one step, shortened until it is accepted; return the outcome of the run or ""."""
    dt = min(side.longest() for side in pair.sides)
    while True:
        split, shortest = pair.split(dt), pair.is_shortest(dt)
        if split is None:
            if shortest:
                return pair, "jump"
            dt *= UNBALANCED_CUT
        elif shortest and split.jumps:
            return pair, "jump"
        elif split.too_long and not shortest:
            dt *= cut(split.strain)
        else:
            return pair.after(split, dt), ""
        for side in pair.sides:
            side.run.history.rejected += 1


def _judged(pair: _Pair) -> tuple[_Pair, str]:
    """Check whether the run has ended, and remesh where an edge has left the fine nodes."""
    sides, tension = pair.sides, -pair.force
    if any(separated(side.at.state.gap, side.run.body.contact.span) for side in sides):
        return pair, "detached"
    if pair.largest_tension > 0 and tension < _LEFT * pair.largest_tension:
        falling = sides[0].at.lowest.since > _LAST
        if falling:
            return pair, "fallen"
    if len(sides[0].run.history.snapshots) > _MOST_STEPS:
        return pair, "steps"
    first, second = (side.remeshed() for side in sides)
    return replace(pair, first=first, second=second), ""
