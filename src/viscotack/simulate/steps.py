"""Solver state between steps, constant data of a run, and step-size control.

**Step-size control: trial steps, their error measures and their acceptance.** A step is implicit
and exact for a load linear in time (:mod:`.body`), so its error is of second order in its length.
The attribute `strain` of an attempt is the squared ratio of its length to the allowed length. It is
the largest of several criteria: deviation from linearity, change of force and depth, travel of the
edge, and energy imbalance. The travel of the drive and the end of the leg are known in advance, and
the step is limited to them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, ulp

import numpy as np
import numpy.typing as npt

from viscotack.simulate.body import Body, State, Step, Trial
from viscotack.simulate.contacts.contact import Contact
from viscotack.simulate.equilibrium import Balance
from viscotack.simulate.history import EnergyTerms, History, Lowest, Profile, Snapshot
from viscotack.simulate.machine import Hold, Leg
from viscotack.simulate.mesh import Mesh
from viscotack.simulate.settings import Settings

# Times of at most this many units in the last place are treated as zero.
_TICKS = 8


@dataclass(frozen=True, eq=False)
class MarchState:
    """Solver state between two steps.

    Attributes
    ----------
    state, books, mesh : State, EnergyTerms, Mesh
        State of the body, cumulative energy terms, and nodes.
    leg, number, began : Leg, int, Snapshot
        Present leg, its number, and the snapshot at its start.
    dt : float
        Length of the next step [time unit of the modes].
    lowest : Lowest
        Smallest force of the leg.
    """

    state: State
    books: EnergyTerms
    mesh: Mesh
    leg: Leg
    number: int
    began: Snapshot
    dt: float
    lowest: Lowest

    @property
    def seen(self) -> Snapshot:
        """Recorded quantities of this instant."""
        return self.state.seen

    @property
    def past(self) -> bool:
        """Whether the lowest force minimum of this leg so far has been passed."""
        return self.lowest.behind(self.seen.force)

    @property
    def ahead(self) -> float:
        """Distance to the nearest end of the leg, as a depth, a force or an edge."""
        return self.leg.missing(self.seen)

    @property
    def left(self) -> float:
        """Remaining time of the leg; 0 if it is below the resolution of the time."""
        now = self.seen.time
        left = self.leg.duration - (now - self.began.time)
        return left if left > _TICKS * ulp(now) else 0.0

    def hold(self, later: float = 0.0) -> Hold:
        """Return the boundary condition of the machine, now or after the time `later`."""
        elapsed = self.seen.time - self.began.time + later
        return self.leg.hold(self.began, elapsed, self.state.surface.unit)


@dataclass(frozen=True, eq=False)
class Run:
    """Constant data of a run: body, settings and legs; and the history under construction."""

    body: Body
    settings: Settings
    legs: tuple[Leg, ...]
    profiles: bool
    history: History

    def keep(self, at: MarchState) -> None:
        """Append the present state to the history."""
        state, history = at.state, self.history
        history.snapshots.append(at.seen)
        history.books.append(at.books)
        history.legs.append(at.number)
        history.nodes = max(history.nodes, len(state.gap))
        if self.profiles:
            pressure = state.nodal / state.surface.area
            history.profiles.append(Profile(state.surface.position, pressure, state.gap))


def around_edge(body: Body, at: MarchState, edge: float | None = None) -> MarchState | Balance:
    """Return the solver state remeshed around its edge, or the unstable balance on failure.

    If the cohesive zone has grown, the nodes are coarser and the fine zone is longer by the same
    factor. `edge` overrides the present edge as the centre of the fine nodes.
    """
    edge = at.seen.edge if edge is None else edge
    mesh = at.mesh.around(edge, opening(at.state, body.contact), at.seen.inner)
    state = body.remeshed(at.state, mesh.nodes(), at.hold())
    return state if isinstance(state, Balance) else replace(at, state=state, mesh=mesh)


def lost(before: MarchState, after: MarchState) -> tuple[float, float]:
    """Return work at the indenter between two states of one instant, and the energy lost.

    A spring or a dead load moves the indenter; a rigid machine does not.
    """
    now, then = before.seen, after.seen
    work = 0.5 * (now.force + then.force) * (then.depth - now.depth)
    return work, work + now.stored - then.stored


def opening(state: State, contact: Contact) -> float:
    """Return the distance over which the gap opens by the range of the law, or the zone."""
    gap, x = state.gap - contact.law.edge_gap - contact.span, state.surface.position
    beyond = int(np.argmax((gap > 0) & (x > state.seen.edge)))
    if beyond == 0:
        return contact.zone
    g, r = gap[beyond - 1 : beyond + 1], x[beyond - 1 : beyond + 1]
    return float(r[1] - g[1] * (r[1] - r[0]) / (g[1] - g[0])) - state.seen.edge


# The response counts as instantaneous if the compliance of a step exceeds the instantaneous one by
# less than this fraction.
_INSTANT = 1e-2
# Factor on the step length after pull-off, where little of the work remains.
_LOOSER = 2.0
# Factor on the step length in the frame of the crack.
_FOLLOWING = 4.0
# Factor by which a step without equilibrium at its end is shortened.
UNBALANCED_CUT = 0.4
# A step that needs more iterations than this is too long.
_MOST_ITERATIONS = 25
# A step is repeated if its strain exceeds _TOO_LONG. The next one aims at the length ratio _AIM, so
# that few steps are repeated. A repeated step has between _MOST_CUT and _LEAST_CUT of its length,
# because a large strain is only a rough estimate of the allowed length.
_TOO_LONG = 1.5
_AIM, _LEAST_CUT, _MOST_CUT = 0.8, 0.7, 0.2
# Largest ratio of a step to the previous one.
_GROWTH = 1.5
# The total energy imbalance may be this multiple of that allowed per step. Close to this limit the
# allowance of a step is reduced, but not below this fraction.
_MOST_MISSING, _LEAST_LEFT = 25.0, 0.2
# The iterations of a step end only when one reduces the energy by less than this fraction of the
# tolerated imbalance. At the beginning of a run, when little work has been done, this is less than
# a fraction of the energy of the contact can resolve, and a wide contact would seem to create
# energy.
_GAINED = 1e-3
# Relative round-off of the energies.
_ROUND_OFF = 1e-11
# Allowed change of attraction due to a change of opening speed in a step, relative to the allowed
# change of force.
_BEND = 0.25
# With a rate-dependent interface the crack runs fast instead of jumping. Steps may then be as short
# as this fraction of the first step of a leg.
_RUNNING = 1e-8
# Tolerance on the end of a leg, as a fraction of the step that passes it.
_AT_END = 1e-3


@dataclass(frozen=True, eq=False)
class Attempt:
    """A trial step with its energy imbalance.

    Attributes
    ----------
    after, entry, mesh : State, EnergyTerms, Mesh
        State after the step, energy terms without any jump loss, and nodes.
    missing, tolerated : float
        Energy imbalance of the step, and its allowed value.
    strain : float
        Squared ratio of the step length to the allowed length.
    """

    after: State
    entry: EnergyTerms
    mesh: Mesh
    missing: float
    tolerated: float
    strain: float

    @property
    def too_long(self) -> bool:
        """Whether the step must be rejected."""
        return not self.strain <= _TOO_LONG


def clipped(run: Run, at: MarchState) -> MarchState:
    """Limit the next step to the allowed travel and to the end of the leg."""
    leg, dt = at.leg, at.dt
    if leg.rigid and leg.rate:  # a soft spring's drive may run ahead
        dt = min(dt, _farthest(run, at) / abs(leg.rate))
        if not np.isnan(leg.depth) and at.ahead > 0:
            dt = min(dt, at.ahead / abs(leg.rate))
    if dt > 0.999 * at.left > 0:
        dt = at.left
    return at if dt == at.dt else replace(at, dt=dt)


def instant(run: Run, s: Step) -> bool:
    """Return whether the response of the solid to a step is instantaneous."""
    return s.compliance < (1 + _INSTANT) * run.body.modes.instantaneous


def is_shortest(run: Run, at: MarchState, s: Step) -> bool:
    """Return whether a shorter step would not change the result."""
    least = at.leg.least_step * (_RUNNING if run.body.runs else 1.0)
    return instant(run, s) and at.dt <= least * (1 + 1e-9)


def tried(run: Run, at: MarchState, s: Step, most_iterations: int = _MOST_ITERATIONS) -> Trial:
    """Compute a trial step from the present state."""
    tolerated = run.settings.imbalance * run.history.measure(at.books, at.seen)
    gain = _GAINED * tolerated / at.state.surface.unit
    trial = run.body.after(at.state, s, at.hold(s.length), most_iterations, gain)
    run.history.iterations += trial.iterations
    return trial


def weighed(run: Run, at: MarchState, s: Step, trial: Trial) -> Attempt:
    """Return the attempt of a trial step, with its energy terms and its strain."""
    before, after = at.state, trial.after
    heat = before.surface.unit * before.memory.heat(
        s, before.relaxed, after.relaxed, before.nodal, after.nodal
    )
    now, then = before.seen, after.seen  # force and depth are linear in between
    work = 0.5 * (now.force + then.force) * (then.depth - now.depth)
    friction = run.body.friction(before, after)
    return entered(run, at, after, work, heat, _strain(run, at, trial), interface=friction)


def entered(
    run: Run,
    at: MarchState,
    after: State,
    work: float,
    heat: npt.NDArray,
    strain: float,
    *,
    interface: float = 0.0,
    allowed: float | None = None,
) -> Attempt:
    """Return an attempt with its energy terms; an energy imbalance increases its strain.

    The imbalance may be `allowed` times the tolerated one. By default that is at most 1 and
    decreases with the sum of the imbalances so far.
    """
    before = at.state
    first, entry = run.history.snapshots[0], at.books.entered(work, heat, interface)
    so_far = at.books.imbalance(first, before.seen)
    missing = entry.imbalance(first, after.seen) - so_far
    largest = run.history.measure(entry, after.seen)
    tolerated = max(run.settings.imbalance * largest, _ROUND_OFF * after.seen.held)
    if allowed is None:
        # imbalances accumulate: the larger the sum so far, the less is allowed in this step
        allowed = max(1 - abs(so_far) / (_MOST_MISSING * tolerated), _LEAST_LEFT)
    strain = max(strain, abs(missing) / (allowed * tolerated))
    return Attempt(after, entry, at.mesh, missing, tolerated, strain)


def cut(strain: float) -> float:
    """Return the factor by which a step that is too long is shortened."""
    return max(_MOST_CUT, min(_AIM / np.sqrt(strain), _LEAST_CUT))


def shortened(run: Run, at: MarchState, attempt: Attempt | None) -> MarchState | None:
    """Return the solver state with a shorter next step, None if the attempt is accepted."""
    if attempt is None:
        run.history.rejected += 1
        return replace(at, dt=at.dt * UNBALANCED_CUT)
    if attempt.too_long:
        run.history.rejected += 1
        return replace(at, dt=at.dt * cut(attempt.strain))
    ahead, over = at.ahead, -at.leg.missing(attempt.after.seen)
    if 0 < ahead and over > _AT_END * (ahead + over):
        return replace(at, dt=at.dt * (ahead / (ahead + over)))
    return None


def arrived(at: MarchState, attempt: Attempt) -> MarchState:
    """Return the solver state after a step, with the next step length set by the strain."""
    return replace(
        at,
        state=attempt.after,
        books=attempt.entry,
        mesh=attempt.mesh,
        dt=at.dt * min(_GROWTH, _AIM / np.sqrt(attempt.strain + 1e-12)),
        lowest=at.lowest.after(attempt.after.seen.force),
    )


def force_change(run: Run, at: MarchState) -> float:
    """Return the largest change of the force in a step."""
    return _looser(run, at) * run.settings.force_change * (abs(at.seen.force) + 1)


def travel(run: Run, at: MarchState) -> float:
    """Return the largest travel [h0] in a step.

    For separated surfaces the tractions change over the gap. In deep contact the force changes over
    the depth, which grows like F^(2/3) by Hertz; adhesion is small there.
    """
    apart = max(float(at.state.gap.min()) - 1, 0.0)
    pressed = max(at.seen.force, 0.0) ** (2 / 3)
    reach = run.body.contact.travel * (1 + pressed) + apart
    return _looser(run, at) * run.settings.travel * reach


def _farthest(run: Run, at: MarchState) -> float:
    """Return the largest travel [h0] in a step, longer after one in the frame of the crack."""
    follows = at.state.rates.followed is not None
    return travel(run, at) * (_FOLLOWING if follows else 1.0)


def _looser(run: Run, at: MarchState) -> float:
    """Return the factor on the step length, larger after pull-off."""
    return _LOOSER if over(run, at) else 1.0


def changed(run: Run, at: MarchState, after: Snapshot) -> float:
    """Return the squared ratio of the changes of force and depth to their allowed values."""
    now = at.seen
    went = 0.0  # the travel of a rigid machine is limited before the step
    if not at.leg.rigid:
        went = (abs(after.depth - now.depth) / _farthest(run, at)) ** 2
    return max((abs(after.force - now.force) / (2 * force_change(run, at))) ** 2, went)


def _strain(run: Run, at: MarchState, trial: Trial) -> float:
    """Return the squared ratio of step length to allowed length, energy criterion excluded."""
    after = trial.after.seen
    return max(
        trial.error / (run.settings.step_error * run.body.contact.span * _looser(run, at) ** 2),
        changed(run, at, after),
        at.mesh.strain(at.seen, after),
        (trial.bend / (_BEND * run.settings.force_change)) ** 2,
    )


# Fraction of the largest tension so far that the relaxed contact must be able to carry.
_SAFE = 0.5


def over(run: Run, at: MarchState) -> bool:
    """Return whether the largest tension of the leg has been passed, and no later one exceeds it.

    The force of a fast pull from a deep start may have two peaks: one while the bulk is still
    glassy and the contact almost whole, and one after the bulk has relaxed, when the crack runs. In
    a relaxed solid a JKR contact whose energy does not change with the radius pulls off when the
    Hertz force at its radius equals the pull-off force. The energy of a crack that accelerates
    rises as the contact shrinks, and the tension then exceeds the Hertz force, by half in computed
    cases. In a retraction the edge only recedes, so no later peak is expected to exceed F once the
    Hertz force at the edge is below half of F. The factor of a half is a heuristic.
    """
    if not at.past:
        return False
    left = run.body.contact.relaxed_pull_off(at.seen.edge)
    if left < inf and not run.body.weights.size:
        return True  # an elastic contact has one peak, except for shapes without a bound
    return left < _SAFE * -at.lowest.force
