"""Steps in the frame of the crack (:mod:`.frame`): when, how long, and what they cost.

An edge that goes farther in a step than a part of its zone is followed there. Nodes move before the
step, to where the edge is expected. The travel of the edge is what the balance at the end says: a
few balances find it, mostly one. The work of the drive and the heat over a step are integrals of
the polynomials through the last instants.

Where an edge rests, where no balance is found or where a branch ends, steps are those of
:mod:`.steps`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import prod

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack.bem.body import Body, Passed, Rates, State
from viscotack.bem.frame import (
    Balancing,
    Found,
    Passage,
    Way,
    along,
    elastic,
    farthest,
    widths,
)
from viscotack.bem.machine import Leg
from viscotack.bem.memory import Memory, step
from viscotack.bem.mesh import Mesh
from viscotack.bem.place import Place, Run
from viscotack.bem.remesh import around_edge, lost, opening
from viscotack.bem.span import least_gap, room
from viscotack.bem.steps import Attempt, changed, entered
from viscotack.bem.surface import Surface

# An edge that is expected to go less than this part of its zone in a step is not followed.
_LEAST_TRAVEL = 0.03
# The profile that moves along with the edge is at least so many half widths of the fine nodes.
_LEAST_WIDTH = 8.0
# The travel has been found when it changes by less than this part of the zone.
_FOUND = 0.1
_MOST_BALANCES = 6
# A solid that remembers nothing has no passage, only nodes that move: worth the while where a
# contact changes over so many ranges of the law. Its edge is then to be where it was expected,
# within this part of the travel.
_MANY_ZONES, _NEAR = 9.0, 0.3
# Largest change of the speed in a step, relative, at the default accuracy.
_SPEED_CHANGE = 0.2
# The error of a linear change in the frame may be so many times that at a place.
_LOOSER = 40.0
# An edge that goes less than this part of the half width stays within the fine nodes.
_WITHIN = 0.8
# On new nodes the energies differ by what the nodes do: less than so many times the tolerated
# imbalance tells nothing of the step.
_MOVED = 2.0
# A step in which the edge would go too far is made so much shorter.
_SHORTER = 0.8
# The cubic through four places of the edge is trusted within this part of the parabola.
_AGREED = 0.2
# Instants that differ by less than this part of the time are one.
_TICK = 1e-12
# Instants nearer to each other than this part of a step tell the same of it.
_APART = 0.25


@dataclass(frozen=True)
class Ahead:
    """Where the edge is expected after a step, and what is known of its way.

    Attributes
    ----------
    dt, travel : float
        Length of the step, shorter than was wanted where the edge would go too far; expected
        change of the edge.
    speed, before : float
        Mean speed of the last step, and its length.
    zone : float
        Length over which the gap opens.
    """

    dt: float
    travel: float
    speed: float
    before: float
    zone: float


def ahead(run: Run, at: Place) -> Ahead | None:
    """Return where the edge is expected after the next step; None where not to be followed."""
    trail, edge = at.state.trail, at.seen.edge
    if run.body.growing is not None:  # its speeds are those of the gap at a place
        return None
    if len(trail) < 3 or not edge > 0 or not _told_apart(trail, at.dt):
        return None
    if at.mesh.inner:  # there are others, and each has a frame of its own
        return None
    contact = run.body.contact
    if not run.body.weights.size and contact.travel < _MANY_ZONES * contact.span:
        return None
    x, grading = at.state.surface.position, at.mesh.grading
    if min(widths(x, edge)) < _LEAST_WIDTH * grading.half_width:
        return None
    zone = contact.zone * grading.half_width / at.mesh.finest.half_width
    dt, travel = at.dt, _expected(trail, at.dt)
    if not _LEAST_TRAVEL * zone < abs(travel):
        return None
    while abs(travel) > farthest(x, edge):
        dt *= _SHORTER
        travel = _expected(trail, dt)
    last, now = trail[-2].seen, trail[-1].seen
    before = now.time - last.time
    return Ahead(dt, travel, (now.edge - last.edge) / before, before, zone)


def _told_apart(trail: tuple[Passed, ...], dt: float) -> bool:
    """Return whether the clock tells the last instants, and the next one, apart."""
    time = [passed.seen.time for passed in trail]
    shortest = min(later - earlier for earlier, later in pairwise(time))
    return min(shortest, dt) > _TICK * time[-1]


def _expected(trail: tuple[Passed, ...], dt: float) -> float:
    """Return the travel of the edge in the next step, by the places it has been at."""
    time = [passed.seen.time for passed in trail]
    edge = [passed.seen.edge for passed in trail]
    if not all(place > 0 for place in edge):
        return 0.0
    parabola = _extrapolated(time[-3:], edge[-3:], dt)
    if len(trail) > 3:
        cubic = _extrapolated(time, edge, dt)
        if abs(cubic - parabola) < _AGREED * abs(parabola):
            return cubic
    return parabola


def _extrapolated(time: list[float], edge: list[float], dt: float) -> float:
    t, x = [(at - time[-1]) / dt for at in time], [at - edge[-1] for at in edge]
    parts = (prod((1 - s) / (t[k] - s) for s in t[:k] + t[k + 1 :]) for k in range(len(t)))
    return sum(part * place for part, place in zip(parts, x, strict=True))


def travelled(run: Run, at: Place, goal: Ahead) -> Attempt | None:
    """Return a step in the frame of the crack; None where there is no balance at its end."""
    at = _on_better_nodes(run, at, goal)
    nodes = _Nodes.of(run.body, at, goal)
    way, found, passage = _balanced(run, at, goal, nodes) or (None, None, None)
    if way is None or found is None or passage is None:
        return None
    after, bend = _after(run, at, nodes, way, found, passage)
    work, heat = _work(at.leg, after, at.dt), _heat(after, at.dt)
    strain = _strain(run, at, goal, nodes.mesh, way, after, bend)
    moved = nodes.mesh is not at.mesh
    least = (_MOVED if run.body.weights.size else np.inf) if moved else 1.0
    attempt = entered(run, at, after, work, heat, strain, least=least)
    if moved and not attempt.too_long:
        run.history.meshes += 1
    return replace(attempt, mesh=nodes.mesh)


def _on_better_nodes(run: Run, at: Place, goal: Ahead) -> Place:
    """Return the march on other nodes where the present state can be brought to them and balanced.

    So what the move costs is known, and booked. It can be if the edge stays within the fine nodes,
    or comes into coarser ones for a crack that has grown.
    """
    mesh, there = at.mesh, at.seen.edge + goal.travel
    near = abs(goal.travel) < _WITHIN * mesh.grading.half_width
    grown = mesh.around(there, opening(at.state, run.body.contact)).grading != mesh.grading
    if not grown and not (near and mesh.left_by(there)):
        return at
    moved = around_edge(run.body, at, there if near else at.seen.edge)
    # where a contact is about to be lost there may be an edge on the one, and none on the other
    if not isinstance(moved, Place) or not np.isfinite(moved.seen.edge):
        return at
    work, gone = lost(at, moved)
    books = moved.books
    books = replace(books, work=books.work + work, transfer=books.transfer + gone)
    return replace(moved, books=books)


@dataclass(frozen=True, eq=False)
class _Nodes:
    """The nodes of a step, and what the march has brought to them."""

    mesh: Mesh
    surface: Surface
    modes: npt.NDArray
    relaxed: CubicSpline
    gap: CubicSpline
    rate: CubicSpline

    @classmethod
    def of(cls, body: Body, at: Place, goal: Ahead) -> _Nodes:
        state, mesh = at.state, at.mesh
        surface, d, old = state.surface, state.memory.displacement, state.surface.position
        there = at.seen.edge + goal.travel
        if mesh.left_by(there):
            mesh = mesh.around(there, opening(state, body.contact))
            surface = body.contact.surface(mesh.nodes())
            d = surface.free_beyond(old[-1], CubicSpline(old, d, axis=-1)(surface.position))
        return cls(
            mesh,
            surface,
            d,
            CubicSpline(old, state.relaxed),
            CubicSpline(old, state.gap),
            CubicSpline(old, state.rates.gap),
        )


def _balanced(run: Run, at: Place, goal: Ahead, nodes: _Nodes) -> tuple[Way, Found, Passage] | None:
    """Return the way of the edge that the balance at its end confirms, and that balance."""
    body, surface, edge = run.body, nodes.surface, at.seen.edge
    law, h = body.contact.law, nodes.mesh.grading.spacing
    span = body.contact.span
    hold = body.net(at.hold(at.dt), at.state)
    travel, guess = goal.travel, None
    tried: list[tuple[float, float]] = []
    for _ in range(_MOST_BALANCES):
        way = Way.of(edge, travel, at.dt, goal.speed, goal.before)
        if guess is None:
            back = surface.position - travel * along(surface.position, edge + travel)
            old = nodes.gap(back)
            moved = np.maximum(old + at.dt * nodes.rate(back), old - 0.5 * room(old, span))
            guess = np.maximum(moved, least_gap(span))
        passage = Passage.of(body.modes, at.dt, way, nodes.relaxed, surface.position, h)
        free = surface.rigid_gap + passage.inherited(body.modes, nodes.modes)
        if body.weights.size:
            balancing = Balancing(surface, law, passage.compliance(body.modes), free, hold)
            found = balancing.found(guess)
        else:
            found = elastic(surface, law, free, body.modes.instantaneous, guess, hold)
        if found is None:
            return None
        run.history.iterations += found.iterations
        ended = surface.edge(found.gap, law.edge_gap) - edge
        if not np.isfinite(ended):
            return None
        if not body.weights.size:  # nothing hangs on the way
            near = abs(ended - travel) < max(goal.zone, _NEAR * abs(travel))
            return (way, found, passage) if near else None
        if abs(ended - travel) < _FOUND * goal.zone:
            return way, found, passage
        tried.append((travel, ended - travel))
        travel, guess = _next(tried), found.gap
        if not abs(travel) < farthest(surface.position, edge):
            return None
    return None


def _next(tried: list[tuple[float, float]]) -> float:
    """Return the travel to be tried next: where the secant has no difference left."""
    travel, off = tried[-1]
    if len(tried) > 1:
        before, was = tried[-2]
        slope = (off - was) / (travel - before) if travel != before else -1.0
        if slope < -0.2:
            return travel - off / slope
    return travel + off


def _after(
    run: Run, at: Place, nodes: _Nodes, way: Way, found: Found, passage: Passage
) -> tuple[State, float]:
    """Return the state at the end of a step, and by how much its rate in the frame has changed."""
    surface, x, dt = nodes.surface, nodes.surface.position, at.dt
    edge = surface.edge(found.gap, run.body.contact.law.edge_gap)
    back = x - (edge - way.begin) * along(x, edge)
    e = found.relaxed
    rate = (e - nodes.relaxed(back)) / dt
    bend = 0.0
    if (last := at.state.rates.followed) is not None:
        last = CubicSpline(at.state.surface.position, last)(back)
        bend = dt * float(np.max(np.abs(rate - last)))
    d = passage.advanced(nodes.modes, e)
    rates = Rates(
        relaxed=np.zeros_like(e),
        edge=(edge - way.begin) / dt,
        gap=(found.gap - nodes.gap(back)) / dt,
        known=False,
        followed=rate,
    )
    memory = Memory(d, d @ surface.stiffness)
    time = at.seen.time + dt
    after = run.body.state(
        time, found.depth, edge, surface, found.faces, e, memory, rates, None, at.state.trail
    )
    return after, bend


def _strain(
    run: Run, at: Place, goal: Ahead, mesh: Mesh, way: Way, after: State, bend: float
) -> float:
    """Return by how much a step is too long but for its energy: a ratio of lengths, squared."""
    settings, speed = run.settings, (after.seen.edge - way.begin) / at.dt
    fastest = max(abs(speed), abs(goal.speed)) + goal.zone / at.dt
    faster = (speed - goal.speed) / fastest if run.body.weights.size else 0.0
    error = step(run.body.modes, at.dt).curvature * bend
    return max(
        (faster / (_SPEED_CHANGE * settings.coarseness)) ** 2,
        error / (_LOOSER * settings.step_error * run.body.contact.span),
        changed(run, at, after.seen),
        ((after.seen.edge - mesh.edge) / (0.75 * mesh.grading.half_width)) ** 2,
    )


def _work(leg: Leg, after: State, dt: float) -> float:
    """Return the work at the indenter over the last step."""
    passed = after.trail
    last, now = passed[-2].seen, passed[-1].seen
    if leg.dead_load:  # linear in time, while the depth is not
        fallen = now.force * now.depth - last.force * last.depth
        depth = _integral(passed, np.array([p.seen.depth for p in passed]), dt)
        return fallen - (now.force - last.force) / dt * float(depth)
    force = float(_integral(passed, np.array([p.seen.force for p in passed]), dt))
    travel, more = now.depth - last.depth, now.force - last.force
    if leg.rigid:
        return travel / dt * force
    # the drive is linear in time, and what it does beyond the work at the indenter is in the spring
    k = leg.stiffness
    return (travel + more / k) / dt * force - more * (now.force + last.force) / (2 * k)


def _heat(after: State, dt: float) -> npt.NDArray:
    """Return the heat of each mode over the last step."""
    passed = after.trail
    return _integral(passed, np.array([p.heat for p in passed]), dt)


def _integral(passed: tuple[Passed, ...], values: npt.NDArray, dt: float) -> npt.NDArray:
    """Return the integral over the last step of the polynomial through the last instants."""
    now = passed[-1].seen.time
    since = np.array([(p.seen.time - now) / dt for p in passed])
    kept = [len(since) - 1, len(since) - 2]
    for k in range(len(since) - 3, -1, -1):
        if since[kept[-1]] - since[k] > _APART:
            kept.append(k)
    orders = np.arange(len(kept))
    # integrals of the powers from -1 to 0
    moments = -((-1.0) ** (orders + 1)) / (orders + 1)
    weights = np.linalg.solve(since[kept] ** orders[:, None], moments)
    return dt * (weights @ values[kept])
