"""How long a step may be, trying one, and saying whether it was too long.

A step is implicit and exact for a load that is linear in time (:mod:`.memory`), so it is of second
order in its length. Its strain says by how much it is too long, as the square of a ratio of
lengths: by the error of that linearity, by the change of force and depth, by the travel of the
edge, and by the energy that is missing after it. The travel of a drive and the end of a leg are
known before a step is tried; it is clipped to them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from viscotack.bem.body import State, Trial
from viscotack.bem.books import Books, Snapshot
from viscotack.bem.later import over
from viscotack.bem.memory import Step
from viscotack.bem.mesh import Mesh
from viscotack.bem.place import Place, Run

# The solid answers as stiffly as it can when a step's compliance exceeds the instantaneous one by
# less than this part.
_INSTANT = 1e-2
# Past the pull-off, steps may be this much longer: what is left is a small part of the work.
_LOOSER = 2.0
# In the frame of the crack steps may be so much longer.
_FOLLOWING = 4.0
# A step without a balance at its end is made so much shorter.
_UNBALANCED_CUT = 0.4
# A step that needs more iterations than this is too long.
_MOST_ITERATIONS = 25
# A step is made again when its strain exceeds this. The next one aims at a ratio of lengths of
# _AIM, so that few are; it is cut to between _MOST_CUT and _LEAST_CUT of its length, because a
# strain that large tells only about how long it may be.
_TOO_LONG = 1.5
_AIM, _LEAST_CUT, _MOST_CUT = 0.8, 0.7, 0.2
# A step is at most this much longer than the last.
_GROWTH = 1.5
# What is missing in all may be so many times what may go missing in a step; as it comes near, a
# step is left less, but no less than this part.
_MOST_MISSING, _LEAST_LEFT = 25.0, 0.2
# Round-off in the energies, of themselves.
_ROUND_OFF = 1e-11
# Opening speeds that change in a step may change the attraction by so many times what the force may
# change.
_BEND = 0.25
# A contact whose tension grows with the opening speed runs where another jumps: steps may be this
# part of the first one of a leg.
_RUNNING = 1e-8
# The end of a leg has been met within this part of the step that passes it.
_AT_END = 1e-3


@dataclass(frozen=True, eq=False)
class Attempt:
    """A step that was tried, and what the books would say of it.

    Attributes
    ----------
    after, entry, mesh : State, Books, Mesh
        The state after it, the books if nothing was lost in a jump, and the nodes.
    missing, tolerated : float
        Work that is nowhere to be found after it, and how much of that there may be.
    strain : float
        By how much it is too long: a ratio of lengths, squared.
    """

    after: State
    entry: Books
    mesh: Mesh
    missing: float
    tolerated: float
    strain: float

    @property
    def too_long(self) -> bool:
        """Whether it cannot be taken as a step."""
        return not self.strain <= _TOO_LONG


def clipped(run: Run, at: Place) -> Place:
    """Return the march with its next step within the travel it may have, and the end of its leg."""
    leg, dt = at.leg, at.dt
    if leg.rigid and leg.rate:  # a soft spring's drive may run ahead
        dt = min(dt, _farthest(run, at) / abs(leg.rate))
        if not np.isnan(leg.depth) and at.ahead > 0:
            dt = min(dt, at.ahead / abs(leg.rate))
    if dt > 0.999 * at.left > 0:
        dt = at.left
    return at if dt == at.dt else replace(at, dt=dt)


def instant(run: Run, s: Step) -> bool:
    """Return whether the solid answers a step as stiffly as it can."""
    return s.compliance < (1 + _INSTANT) * run.body.modes.instantaneous


def is_shortest(run: Run, at: Place, s: Step) -> bool:
    """Return whether nothing would change if the step were shorter still."""
    least = at.leg.least_step * (1.0 if run.body.growing is None else _RUNNING)
    return instant(run, s) and at.dt <= least * (1 + 1e-9)


def tried(run: Run, at: Place, s: Step, most_iterations: int = _MOST_ITERATIONS) -> Trial:
    """Return what a step leads to."""
    trial = run.body.after(at.state, s, at.hold(s.length), most_iterations)
    run.history.iterations += trial.iterations
    return trial


def weighed(run: Run, at: Place, s: Step, trial: Trial) -> Attempt:
    """Return a step that was tried with its entry in the books, and by how much it is too long."""
    before, after = at.state, trial.after
    heat = before.surface.unit * before.memory.heat(
        s, before.relaxed, after.relaxed, before.nodal, after.nodal
    )
    work, friction = work_of(before.seen, after.seen), _interface_heat(before, after)
    return entered(run, at, after, work, heat, _strain(run, at, trial), interface=friction)


def entered(
    run: Run,
    at: Place,
    after: State,
    work: float,
    heat: npt.NDArray,
    strain: float,
    *,
    interface: float = 0.0,
    least: float = 1.0,
) -> Attempt:
    """Return a step with its entry in the books; energy that is missing makes it too long.

    The least that counts is so many times what is tolerated.
    """
    before = at.state
    first, entry = run.history.snapshots[0], at.books.entered(work, heat, interface)
    so_far = at.books.imbalance(first, before.seen)
    missing = entry.imbalance(first, after.seen) - so_far
    largest = run.history.measure(entry, after.seen)
    tolerated = max(run.settings.imbalance * largest, _ROUND_OFF * after.seen.held)
    # what is missing adds up: the more there is, the less is left for this step
    left = max(1 - abs(so_far) / (_MOST_MISSING * tolerated), _LEAST_LEFT)
    strain = max(strain, abs(missing) / (least * left * tolerated))
    return Attempt(after, entry, at.mesh, missing, tolerated, strain)


def work_of(before: Snapshot, after: Snapshot) -> float:
    """Return the work at the indenter in a step in which force and depth changed linearly."""
    return 0.5 * (before.force + after.force) * (after.depth - before.depth)


def _interface_heat(before: State, after: State) -> float:
    """Return the heat in an interface that grows with the opening speed, over a step."""
    if before.extra is None or after.extra is None:
        return 0.0
    nodal = 0.5 * (before.extra.nodal + after.extra.nodal)
    flank = 0.5 * (before.extra.flank + after.extra.flank)
    lifted = before.seen.depth - after.seen.depth
    return before.surface.unit * float(nodal @ (after.gap - before.gap)) + flank * lifted


def shortened(run: Run, at: Place, attempt: Attempt | None) -> Place | None:
    """Return the march with a shorter next step, None where the one that was tried will do."""
    if attempt is None:
        run.history.rejected += 1
        return replace(at, dt=at.dt * _UNBALANCED_CUT)
    if attempt.too_long:
        run.history.rejected += 1
        cut = min(_AIM / np.sqrt(attempt.strain), _LEAST_CUT)
        return replace(at, dt=at.dt * max(_MOST_CUT, cut))
    ahead, over = at.ahead, -at.leg.missing(attempt.after.seen)
    if 0 < ahead and over > _AT_END * (ahead + over):
        return replace(at, dt=at.dt * (ahead / (ahead + over)))
    return None


def arrived(at: Place, attempt: Attempt) -> Place:
    """Return the march after a step, the next one as long as its strain suggests."""
    return replace(
        at,
        state=attempt.after,
        books=attempt.entry,
        mesh=attempt.mesh,
        dt=at.dt * min(_GROWTH, _AIM / np.sqrt(attempt.strain + 1e-12)),
        lowest=at.lowest.after(attempt.after.seen.force),
    )


def force_change(run: Run, at: Place) -> float:
    """Return the largest change of the force in a step."""
    return _looser(run, at) * run.settings.force_change * (abs(at.seen.force) + 1)


def travel(run: Run, at: Place) -> float:
    """Return the largest travel [h0] in a step.

    Once apart, tractions change over the gap. Pressed deep, forces change over the depth, which
    grows like F^(2/3) by Hertz; adhesion is a small matter there.
    """
    apart = max(float(at.state.gap.min()) - 1, 0.0)
    pressed = max(at.seen.force, 0.0) ** (2 / 3)
    reach = run.body.contact.travel * (1 + pressed) + apart
    return _looser(run, at) * run.settings.travel * reach


def _farthest(run: Run, at: Place) -> float:
    """Return the largest travel [h0] in a step, longer after one in the frame of the crack."""
    follows = at.state.rates.followed is not None
    return travel(run, at) * (_FOLLOWING if follows else 1.0)


def _looser(run: Run, at: Place) -> float:
    """Return how much longer steps may be."""
    return _LOOSER if over(run, at) else 1.0


def changed(run: Run, at: Place, after: Snapshot) -> float:
    """Return by how much force and depth change too much in a step: a ratio, squared."""
    now = at.seen
    went = 0.0  # a rigid machine's travel is bounded before the step is tried
    if not at.leg.rigid:
        went = (abs(after.depth - now.depth) / _farthest(run, at)) ** 2
    return max((abs(after.force - now.force) / (2 * force_change(run, at))) ** 2, went)


def _strain(run: Run, at: Place, trial: Trial) -> float:
    """Return by how much a step is too long but for its energy: a ratio of lengths, squared."""
    after = trial.after.seen
    return max(
        trial.error / (run.settings.step_error * run.body.contact.span * _looser(run, at) ** 2),
        changed(run, at, after),
        at.mesh.strain(at.seen, after),
        (trial.bend / (_BEND * run.settings.force_change)) ** 2,
    )
