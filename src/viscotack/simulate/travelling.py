"""Step control in the frame of the moving crack (:mod:`.frame`), with work and heat.

This frame is used if the edge moves by more than a small fraction of its cohesive zone in a step.
The nodes are moved before the step to the expected position of the edge. The travel of the edge is
iterated until it agrees with the equilibrium at the end of the step; mostly one solution suffices.
The work of the drive and the heat are integrals of the polynomials through the last instants.

If the edge is at rest, no equilibrium is found or a branch ends, the solver uses :mod:`.steps`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import prod

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack.simulate.body import Body, Memory, Passed, Rates, State, step
from viscotack.simulate.frame import (
    Balancing,
    Found,
    Passage,
    Way,
    along,
    elastic,
    farthest,
    widths,
)
from viscotack.simulate.machine import Leg
from viscotack.simulate.mesh import Mesh
from viscotack.simulate.steps import (
    Attempt,
    MarchState,
    Run,
    around_edge,
    changed,
    entered,
    lost,
    opening,
)
from viscotack.simulate.surface import Surface, least_gap, room

# Smallest expected travel, as a fraction of the zone, for a step in this frame.
_LEAST_TRAVEL = 0.03
# Smallest width of the profile that moves with the edge, in half widths of the fine nodes.
_LEAST_WIDTH = 8.0
# The travel has converged when it changes by less than this fraction of the zone.
_FOUND = 0.1
_MOST_BALANCES = 6
# For an elastic solid only the nodes move. This pays if the travel of the contact is at least this
# multiple of the range of the law. The edge must be at the expected position within this fraction
# of its travel.
_MANY_ZONES, _NEAR = 9.0, 0.3
# Largest change of the speed in a step, relative, at the default accuracy.
_SPEED_CHANGE = 0.2
# Factor on the allowed error of linearity in this frame, relative to the fixed frame.
_LOOSER = 40.0
# An edge that moves less than this fraction of the half width stays within the fine nodes.
_WITHIN = 0.8
# Remeshing changes the energies, and a shorter step does not make this smaller. An imbalance below
# this multiple of the tolerated one is not attributed to a step onto new nodes.
_MOVED = 2.0
# Factor by which a step is shortened if the edge would move too far.
_SHORTER = 0.8
# Extrapolate the edge by a cubic if it agrees with the parabola within this fraction.
_AGREED = 0.2
# Relative time difference below which two instants are treated as equal.
_TICK = 1e-12
# Smallest distance of instants used for integration, as a fraction of the step.
_APART = 0.25


@dataclass(frozen=True)
class Ahead:
    """Expected position of the edge after a step, with data of its motion.

    Attributes
    ----------
    dt, travel : float
        Length of the step, shortened if the edge would move too far; expected travel of the edge.
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


def ahead(run: Run, at: MarchState) -> Ahead | None:
    """Predict the edge after the next step; None if this frame does not apply."""
    trail, edge = at.state.trail, at.seen.edge
    if run.body.growing is not None:  # speeds and ages of bonds are defined at fixed points
        return None
    if len(trail) < 3 or not edge > 0:
        return None
    time = np.array([passed.seen.time for passed in trail])
    if not min(np.diff(time).min(), at.dt) > _TICK * time[-1]:  # equal instants
        return None
    if at.mesh.inner:  # several edges would need several frames
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


def _expected(trail: tuple[Passed, ...], dt: float) -> float:
    """Return the travel of the edge in the next step, extrapolated from earlier positions."""
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


def travelled(run: Run, at: MarchState, goal: Ahead) -> Attempt | None:
    """Try a step in the frame of the crack; None if no equilibrium is found at its end."""
    at = _on_better_nodes(run, at, goal)
    nodes = _Nodes.of(run.body, at, goal)
    way, found, passage = _balanced(run, at, goal, nodes) or (None, None, None)
    if way is None or found is None or passage is None:
        return None
    after, bend = _after(run, at, nodes, way, found, passage)
    work = _work(at.leg, after, at.dt)
    heat = _integral(after.trail, np.array([p.heat for p in after.trail]), at.dt)
    strain = _strain(run, at, goal, nodes.mesh, way, after, bend)
    moved = nodes.mesh is not at.mesh
    allowed = (_MOVED if run.body.weights.size else np.inf) if moved else None
    attempt = entered(run, at, after, work, heat, strain, allowed=allowed)
    if moved and not attempt.too_long:
        run.history.meshes += 1
    return replace(attempt, mesh=nodes.mesh)


def _on_better_nodes(run: Run, at: MarchState, goal: Ahead) -> MarchState:
    """Remesh the present state if it can be brought into equilibrium on the new nodes.

    The energy lost by remeshing is then known and recorded. This is possible if the edge stays
    within the fine nodes, or if a longer cohesive zone allows coarser ones.
    """
    mesh, there = at.mesh, at.seen.edge + goal.travel
    near = abs(goal.travel) < _WITHIN * mesh.grading.half_width
    grown = mesh.around(there, opening(at.state, run.body.contact)).grading != mesh.grading
    if not grown and not (near and mesh.left_by(there)):
        return at
    moved = around_edge(run.body, at, there if near else at.seen.edge)
    # close to detachment there may be an edge on one mesh and none on the other
    if not isinstance(moved, MarchState) or not np.isfinite(moved.seen.edge):
        return at
    work, gone = lost(at, moved)
    books = moved.books
    books = replace(books, work=books.work + work, transfer=books.transfer + gone)
    return replace(moved, books=books)


@dataclass(frozen=True, eq=False)
class _Nodes:
    """Nodes of a step, with the fields of the present state."""

    mesh: Mesh
    surface: Surface
    modes: npt.NDArray
    relaxed: CubicSpline
    opening: CubicSpline  # gap and its rate

    @classmethod
    def of(cls, body: Body, at: MarchState, goal: Ahead) -> _Nodes:
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
            CubicSpline(old, np.array([state.gap, state.rates.gap]), axis=-1),
        )


def _balanced(
    run: Run, at: MarchState, goal: Ahead, nodes: _Nodes
) -> tuple[Way, Found, Passage] | None:
    """Iterate the travel of the edge until it agrees with the equilibrium; return both."""
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
            old, rate = nodes.opening(back)
            moved = np.maximum(old + at.dt * rate, old - 0.5 * room(old, span))
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
        if not body.weights.size:  # the path has no influence
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
    """Return the next trial travel, by the secant method."""
    travel, off = tried[-1]
    if len(tried) > 1:
        before, was = tried[-2]
        slope = (off - was) / (travel - before) if travel != before else -1.0
        if slope < -0.2:
            return travel - off / slope
    return travel + off


def _after(
    run: Run, at: MarchState, nodes: _Nodes, way: Way, found: Found, passage: Passage
) -> tuple[State, float]:
    """Return the state at the end of a step and the change of its rate in this frame."""
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
        gap=(found.gap - nodes.opening(back)[0]) / dt,
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
    run: Run, at: MarchState, goal: Ahead, mesh: Mesh, way: Way, after: State, bend: float
) -> float:
    """Return the squared ratio of step length to allowed length, energy criterion excluded."""
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
    # the drive is linear in time; subtract the change of spring energy from its work
    k = leg.stiffness
    return (travel + more / k) / dt * force - more * (now.force + last.force) / (2 * k)


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
