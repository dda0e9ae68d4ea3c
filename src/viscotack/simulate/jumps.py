"""Jumps at the end of an equilibrium branch: detection, new state and energy loss.

The work of the drive must equal the change of elastic and interface energy plus heat. If it does
not even for a step so short that the solid responds instantaneously, the branch has ended. The
contact then jumps to the next stable state of lower energy, and the lost energy is recorded. Under
a dead load such a state may not exist; the contact then detaches.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from viscotack.result import Event
from viscotack.simulate.body import Step, Trial, step
from viscotack.simulate.history import Snapshot
from viscotack.simulate.mesh import Mesh
from viscotack.simulate.steps import (
    Attempt,
    MarchState,
    Run,
    around_edge,
    arrived,
    force_change,
    instant,
    lost,
    travel,
    tried,
    weighed,
)

# Maximum number of iterations from the end of a branch to the next stable state.
_PATIENCE = 500
# Number of steps, each twice as long as the last, after which the search for equilibrium fails.
_LOOKS = 8
# If a step loses no energy itself, a loss on new nodes counts as a jump above this multiple of the
# tolerated imbalance.
_CLEARLY = 5.0
# A step that creates more energy than this multiple of the tolerated imbalance is too long, not a
# jump; factor by which it is shortened, and maximum number of cuts.
_CREATED, _CUT, _MOST_CUTS = 25.0, 0.4, 8
# Maximum number of remeshings after a jump, when the edge may be far from the fine nodes.
_MOST_MESHES = 200


def shortest_step(run: Run, at: MarchState, s: Step, cuts: int = _MOST_CUTS) -> MarchState:
    """Advance by the shortest possible step; if that step is too long, treat it as a jump.

    A jump loses energy. A step that creates energy is shortened further, at most `cuts` times.
    """
    s, trial = _way_down(run, at, s)
    if trial.released:
        _let_go(run, at.seen, trial.after.seen.time)
        return at
    if trial.lost:  # however short the step, no equilibrium was found
        run.history.pressed = run.body.pressed(trial.after)
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


def followed(run: Run, at: MarchState) -> MarchState:
    """Remesh around the edge and record the energy lost by remeshing.

    Coarse nodes may pin an edge that has left the fine ones, where no other force holds it, for
    example with a soft spring. On new nodes the contact then becomes unstable, and the change is
    recorded as a jump. If this would create energy, the present nodes are kept.
    """
    moved, gone = _chased(run, at)
    now, then = at.seen, moved.seen
    books = moved.books
    tipped = abs(then.force - now.force) > force_change(run, moved)
    # a contact that no rigid machine holds may move as by a jump
    went_far = abs(then.depth - now.depth) > travel(run, moved)
    if not (tipped or went_far or (now.edge > 0) != (then.edge > 0)):
        return replace(moved, books=replace(books, transfer=books.transfer + gone))
    if gone < -_CREATED * run.settings.imbalance * run.history.measure(books, now):
        return _staying(at)
    # the jump lies between the recorded step and the next
    behind = replace(then, time=float(np.nextafter(now.time, np.inf)))
    run.history.events.append(_event(now, behind, gone))
    return replace(
        moved,
        state=run.body.at_rest(moved.state),
        books=replace(books, jumps=books.jumps + gone),
        dt=at.leg.least_step,
    )


def _way_down(run: Run, at: MarchState, s: Step) -> tuple[Step, Trial]:
    """Try the shortest step; if no equilibrium is found, try slightly longer ones.

    Just past the end of a branch the energy is so flat that round-off determines the number of
    iterations. A little later it is steep. The solid hardly relaxes meanwhile, because its
    compliance is still the instantaneous one.
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


def _jumped(run: Run, at: MarchState, attempt: Attempt) -> MarchState:
    """Return the solver state after a jump: at rest, with fine nodes around the new edge."""
    missing, tolerated = attempt.missing, attempt.tolerated
    # A jump loses energy. If the step itself lost none and only moved far, the energy lost by
    # remeshing must not be reported as a jump.
    least = tolerated if missing > tolerated else _CLEARLY * tolerated
    if run.history.stiffness is not None:  # ignore snaps from node to node
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


def _chased(run: Run, at: MarchState) -> tuple[MarchState, float]:
    """Remesh until the edge stays inside the fine nodes; also return the energy lost.

    The work at the indenter, which a spring or a dead load moves, is recorded here; the lost energy
    is recorded by the caller.
    """
    left: list[Mesh] = []
    missing = 0.0
    for _ in range(_MOST_MESHES):
        edges = at.seen.edge, at.seen.inner
        # where the gap is flat the edge depends on the mesh and may oscillate between two meshes
        if not at.mesh.left_by(*edges) or any(mesh.had(*edges) for mesh in left):
            break
        left.append(at.mesh)
        before, at = at, _on_new_nodes(run, at)
        if at.seen is before.seen:
            break
        work, gone = lost(before, at)
        heat = run.body.transferred(before.state, at.state)
        books = replace(at.books, work=at.books.work + work, interface=at.books.interface + heat)
        at = replace(at, books=books)
        missing += gone - heat
    return at, missing


def _on_new_nodes(run: Run, at: MarchState) -> MarchState:
    """Remesh around the edge; keep the present nodes if no equilibrium is found on new ones.

    This happens close to a limit point, or if edges are so close to each other that uneven panels
    give a compliance that is not positive definite.
    """
    try:
        moved = around_edge(run.body, at)
    except ArithmeticError:
        return _staying(at)
    if isinstance(moved, MarchState):
        run.history.meshes += 1
        return moved
    if moved.released:  # no equilibrium is left under the dead load
        _let_go(run, at.seen, at.seen.time)
    return _staying(at)


def _staying(at: MarchState) -> MarchState:
    """Keep the present nodes and mark them as centred on the edge."""
    return replace(at, mesh=replace(at.mesh, edge=at.seen.edge, inner=at.seen.inner))


def _let_go(run: Run, now: Snapshot, time: float) -> None:
    """End the run because a dead load has detached the contact.

    The elastic energy is lost; the further work of the load is unbounded and not recorded. If there
    was no contact before, the outcome is "unheld".
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
