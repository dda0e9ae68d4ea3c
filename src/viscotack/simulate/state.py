"""Solver state between steps, and the constant data of a run."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ulp

import numpy as np

from viscotack.simulate.body import Body, State
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
