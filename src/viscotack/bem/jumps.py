"""Where a branch of equilibrium ends: telling a jump from a step, and going after it.

Drive work must reappear as elastic and interface energy and heat. Where it does not, however short
the step and although the solid already answers as stiffly as it can, the branch has ended: the
contact jumps to the next stable state downhill in energy, and what it loses is booked. Under a dead
load there may be no such state: the contact is pulled apart.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from viscotack.bem.body import Trial
from viscotack.bem.books import Snapshot
from viscotack.bem.memory import Step, step
from viscotack.bem.mesh import Mesh
from viscotack.bem.place import Place, Run
from viscotack.bem.remesh import around_edge, lost
from viscotack.bem.shut import pressed_shut
from viscotack.bem.steps import Attempt, arrived, force_change, instant, travel, tried, weighed
from viscotack.result import Event

# The way down from the end of a branch may take so many iterations.
_PATIENCE = 500
# No equilibrium is there when none was found in so many steps, each twice as long as the last.
_LOOKS = 8
# What is lost on new nodes after a step that has lost nothing is a jump from so many times the
# tolerated imbalance on.
_CLEARLY = 5.0
# A step that creates more energy than so many times what may go missing is no jump, but too long:
# it is made so much shorter, so many times.
_CREATED, _CUT, _MOST_CUTS = 25.0, 0.4, 8
# After a jump the edge may be far from the fine nodes: so many meshes go after it.
_MOST_MESHES = 200


def shortest_step(run: Run, at: Place, s: Step, cuts: int = _MOST_CUTS) -> Place:
    """Return where a step leads that can be no shorter: where that is too far, it is a jump.

    A jump loses energy. A step that creates some is cut after all, up to so many times.
    """
    s, trial = _way_down(run, at, s)
    if trial.released:
        _let_go(run, at.seen, trial.after.seen.time)
        return at
    if trial.lost:  # however short the step, no equilibrium was found
        after = trial.after
        run.history.pressed = pressed_shut(after.surface, after.gap, after.relaxed)
        run.history.outcome = "shut" if run.history.pressed else "lost"
        return at
    attempt = weighed(run, at, s, trial)
    if attempt.missing < -_CREATED * attempt.tolerated:
        run.history.rejected += 1
        if cuts == 0:
            run.history.outcome = "lost"
            return at
        shorter = replace(at, dt=_CUT * at.dt)
        return shortest_step(run, shorter, step(run.body.modes, shorter.dt), cuts - 1)
    after = _jumped(run, at, attempt) if attempt.too_long else arrived(at, attempt)
    run.keep(after)
    return after


def followed(run: Run, at: Place) -> Place:
    """Return the march with the fine nodes around its edge, what that costs being booked.

    Coarse nodes may hold an edge that has run out of the fine ones where nothing else does, behind
    a soft spring for example. New nodes then tip it over the brink, and it is a jump. Where that
    would create energy, the march goes on with the nodes it has.
    """
    moved, gone = _chased(run, at)
    now, then = at.seen, moved.seen
    books = moved.books
    tipped = abs(then.force - now.force) > force_change(run, moved)
    if not (tipped or _went_far(run, moved, now)):
        return replace(moved, books=replace(books, transfer=books.transfer + gone))
    if gone < -_CREATED * run.settings.imbalance * run.history.measure(books, now):
        return _staying(at)
    # it lies behind the step that is kept, and before the next
    behind = replace(then, time=float(np.nextafter(now.time, np.inf)))
    run.history.events.append(_event(now, behind, gone))
    return replace(
        moved,
        state=run.body.at_rest(moved.state),
        books=replace(books, jumps=books.jumps + gone),
        dt=at.leg.least_step,
    )


def _went_far(run: Run, moved: Place, now: Snapshot) -> bool:
    """Return whether new nodes have moved a contact that no rigid machine holds like a jump."""
    then = moved.seen
    return (now.edge > 0) != (then.edge > 0) or abs(then.depth - now.depth) > travel(run, moved)


def _way_down(run: Run, at: Place, s: Step) -> tuple[Step, Trial]:
    """Return the shortest step, or where it finds nothing one that looks from a little later on.

    Where a branch has only just ended, the way down begins so flat that round-off decides how
    many iterations it takes. Later it is steep; what the solid does meanwhile is next to
    nothing, its compliance being the instantaneous one.
    """
    trial = tried(run, at, s, _PATIENCE)
    at = replace(at, state=run.body.at_rest(at.state))
    for _ in range(_LOOKS):
        if not trial.lost:
            break
        longer = step(run.body.modes, 2 * s.length)
        if not instant(run, longer) or longer.length > at.left:
            break
        s, trial = longer, tried(run, at, longer, _PATIENCE)
    return s, trial


def _jumped(run: Run, at: Place, attempt: Attempt) -> Place:
    """Return the march after a jump: at rest, with fine nodes where the edge has come to be."""
    missing, tolerated = attempt.missing, attempt.tolerated
    # A jump loses energy. Where the step itself has lost none, and only went far, what new
    # nodes cost must not look like one.
    least = tolerated if missing > tolerated else _CLEARLY * tolerated
    if run.history.stiffness is not None:  # a snap from node to node is none to speak of
        least = max(least, run.settings.imbalance * at.seen.held)
    after = replace(
        arrived(at, attempt),
        state=run.body.at_rest(attempt.after),
        books=replace(attempt.entry, jumps=attempt.entry.jumps + missing),
        dt=at.leg.least_step,
    )
    after, gone = _chased(run, after)
    missing += gone
    after = replace(after, books=replace(after.books, jumps=after.books.jumps + gone))
    if missing > least or (at.seen.edge > 0) != (after.seen.edge > 0):
        run.history.events.append(_event(at.seen, after.seen, missing))
    return after


def _chased(run: Run, at: Place) -> tuple[Place, float]:
    """Return the march with fine nodes where its edge comes to rest, and what is lost on the way.

    The work at the indenter, which a spring or a dead load moves, is booked; what is lost is not.
    """
    left: list[Mesh] = []
    missing = 0.0
    for _ in range(_MOST_MESHES):
        edges = at.seen.edge, at.seen.inner
        # where the gap is flat each mesh has the edge elsewhere: to and fro, for the same force
        if not at.mesh.left_by(*edges) or any(mesh.had(*edges) for mesh in left):
            break
        left.append(at.mesh)
        before, at = at, _on_new_nodes(run, at)
        if at.seen is before.seen:
            break
        work, gone = lost(before, at)
        at = replace(at, books=replace(at.books, work=at.books.work + work))
        missing += gone
    return at, missing


def _on_new_nodes(run: Run, at: Place) -> Place:
    """Return the march on nodes around its edge, where it was if it finds no balance on them.

    That happens on the brink of a jump, or where edges come so close that panels are too uneven for
    a compliance that is positive definite: the march then goes on with the nodes it has.
    """
    try:
        moved = around_edge(run.body, at)
    except ArithmeticError:
        return _staying(at)
    if isinstance(moved, Place):
        run.history.meshes += 1
        return moved
    if moved.released:  # a dead load had nothing left that holds it
        _let_go(run, at.seen, at.seen.time)
    return _staying(at)


def _staying(at: Place) -> Place:
    """Return the march on the nodes it has, which count as those around its edge."""
    return replace(at, mesh=replace(at.mesh, edge=at.seen.edge, inner=at.seen.inner))


def _let_go(run: Run, now: Snapshot, time: float) -> None:
    """End with a contact that a dead load pulls apart: nothing stops it, and nothing is kept.

    The elastic energy is lost; what the load gains by falling further has no bound. Where there was
    no contact, there was nothing that bore the load.
    """
    if not now.edge > 0:
        run.history.outcome = "unheld"
        return
    gone = replace(now, time=time, edge=float("nan"))
    run.history.events.append(_event(now, gone, now.elastic))
    run.history.outcome = "detached"
    run.history.left = len(run.legs) - 1 - run.history.legs[-1]


def _event(before: Snapshot, after: Snapshot, lost: float) -> Event:
    kind = "jump"
    if before.edge > 0 and not after.edge > 0:
        kind = "jump out of contact"
    elif after.edge > 0 and not before.edge > 0:
        kind = "jump into contact"
    return Event(kind, after.time, after.depth, before.force, lost)
