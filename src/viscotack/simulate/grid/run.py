"""A run on a grid: relaxed start, legs and history."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.model.materials import Modes
from viscotack.model.protocol import Apart, AtDepth, AtForce, AtRadius, Start
from viscotack.simulate.grid.body import Fixed, Frames, GridBody, GridRun
from viscotack.simulate.grid.checkpoint import Checkpoint, continued, run_arrays
from viscotack.simulate.grid.descent import Found, equilibrium
from viscotack.simulate.grid.map_contact import MapContact
from viscotack.simulate.history import SMALLEST_ENERGY, EnergyTerms, History, Lowest
from viscotack.simulate.machine import Hold, Leg
from viscotack.simulate.march import through
from viscotack.simulate.settings import Settings
from viscotack.simulate.steps import MarchState

# Part of a checkpoint.
_MAIN = "main"
# Steps in which a relaxed contact is loaded, and gap [range of the law] from which.
_LOADINGS, _APART = 16, 4.0
_MOST_LOADINGS = 400
# Largest number of iterations of a relaxed state, which may jump into contact.
_PATIENCE = 500
# Fewest pixels along a side on which a relaxed state is found before it is refined.
_COARSEST = 64
# Largest relative change of the force beyond a map under a dead load, and trials of it.
_TAIL, _TAILS = 1e-9, 50
# Largest sum of unbalanced tractions of a relaxed state over that of all.
_UNBALANCED = 1e-7


def relaxed(contact: MapContact, start: Start | Apart) -> Found:
    """Return the relaxed state that a slow approach from far away reaches.

    Under a tensile force it is the contact that is left when a compressed one is unloaded.

    A front of contact spreads by about a pixel per iteration. On many pixels it spreads on pixels
    twice as large, and this state is corrected; the gap of a larger pixel is the largest of its
    four, so that it comes into contact last.
    """
    found = None
    if min(contact.plane.shape) >= 2 * _COARSEST and not isinstance(start, Apart):
        with suppress(ArithmeticError):
            found = _refined(contact, start)
    if found is None:
        found = _approached(contact, start)
    if isinstance(start, AtForce) and start.force < 0 and found.stable:
        found = _under(contact, found, start.force)
    if not found.stable:
        raise ArithmeticError("no equilibrium of the surface was found")
    return found


def _refined(contact: MapContact, start: Start) -> Found:
    """Return the state in compression from that on pixels twice as large."""
    if isinstance(start, AtForce):
        start = AtForce(max(start.force, 0.0))
    plane = contact.plane
    coarse = contact.coarser()
    found = relaxed(coarse, start)
    rows, columns = (plane.field(np.minimum(np.arange(n) // 2, n // 2 - 1)) for n in plane.shape)
    held = found.held.reshape(coarse.plane.shape)[rows[:, None], columns]
    found = replace(found, moved=plane.moved(held))
    if isinstance(start, AtForce):
        return _under(contact, found, start.force)
    return _at_depth(contact, found, found.depth)


def _approached(contact: MapContact, start: Start | Apart) -> Found:
    """Return the state in compression by steps of the depth."""
    plane, law, span = contact.plane, contact.law, contact.span
    apart = _APART * span
    if isinstance(start, Apart):
        return _at_depth(contact, None, 1 - start.gap)
    if isinstance(start, AtRadius):
        raise InputError("a map has no contact radius to start at; give a depth or a force")
    found = None
    if isinstance(start, AtDepth):
        for depth in np.linspace(-apart, start.depth, _LOADINGS):
            found = _at_depth(contact, found, float(depth))
        assert found is not None
        return found
    deepest = np.inf if not plane.mean_is_zero else float(contact.rigid_gap.mean()) - 1
    depth, step = min(-apart, deepest), 0.25 * contact.travel
    for _ in range(_MOST_LOADINGS):
        found = _at_depth(contact, found, depth)
        force = contact.force_under(found.tension, depth)
        touches = bool((found.gap < law.edge_gap).any())
        if depth >= deepest or (touches and force >= max(start.force, 0.0)):
            break
        depth, step = min(depth + step, deepest), 1.2 * step
    assert found is not None
    return _under(contact, found, max(start.force, 0.0))


def _at_depth(contact: MapContact, guess: Found | None, depth: float) -> Found:
    moved = contact.plane.zeros() if guess is None else guess.moved
    return _balanced(contact, moved, Hold(np.inf, depth=depth), depth)


def _under(contact: MapContact, guess: Found, force: float) -> Found:
    """Return the equilibrium under a dead load; what lies beyond the map pulls as well."""
    found = guess
    for _ in range(_TAILS):
        tail = contact.tail_force(found.depth)
        load = (force - tail) / (contact.unit * contact.area)
        found = _balanced(contact, found.moved, Hold(0.0, load=load), found.depth)
        if not found.stable or abs(contact.tail_force(found.depth) - tail) <= _TAIL * abs(tail):
            break
    return found


def _balanced(contact: MapContact, moved: npt.NDArray, hold: Hold, depth: float) -> Found:
    return equilibrium(
        contact.plane,
        contact.law,
        contact.free,
        1.0,
        moved,
        hold,
        depth=depth,
        tolerance=_UNBALANCED,
        most_iterations=_PATIENCE,
    )


def march_on_grid(
    contact: MapContact,
    start: Found,
    modes: Modes,
    legs: tuple[Leg, ...],
    settings: Settings,
    *,
    stiffness: float | None = None,
    frames: int = 0,
    checkpoint: Checkpoint | None = None,
    progress: Callable[[float], None] | None = None,
) -> GridRun:
    """Integrate a relaxed body through all legs; see :func:`viscotack.simulate.march.march`.

    Up to `frames` frames are kept. The history is an attribute of the run. A run that is a part of
    the checkpoint continues from there.
    """
    history = History(SMALLEST_ENERGY * contact.span, stiffness)
    body, last = GridBody(contact, modes, np.asarray(modes.weights)), []

    def write(at: MarchState, counted: tuple[int, int, int]) -> None:
        if checkpoint is not None:
            checkpoint.keep(_MAIN, run_arrays(run, at, counted))

    def counts() -> tuple[int, int, int]:
        return history.iterations, history.rejected, len(history.events)

    def take(at: MarchState) -> None:
        last[:] = [at, counts()]
        # the first place is before the machine is attached
        if checkpoint is not None and checkpoint.due and len(history.snapshots) > 1:
            write(*last)

    run = GridRun(body, settings, legs, False, history, frames=Frames(frames), told=take)  # type: ignore[arg-type]
    at = None
    if checkpoint is not None:
        at = checkpoint.part(_MAIN, lambda arrays: continued(run, arrays))
    if at is None:
        state, leg = body.first(start), legs[0]
        books = EnergyTerms(0.0, np.zeros(len(body.weights)))
        at = MarchState(state, books, Fixed(), leg, 0, state.seen, leg.least_step, Lowest())  # type: ignore[arg-type]
    if not history.outcome:
        through(run, at, "detached", progress)
        if last and len(history.snapshots) > 1:
            # where the time limit was met, counts are those of the last place
            write(last[0], last[1] if history.outcome == "time" else counts())
    return run
