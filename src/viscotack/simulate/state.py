"""Solver state between steps, and the constant data of a run."""

from __future__ import annotations

from dataclasses import dataclass
from math import ulp

from viscotack.simulate.body import Body, State
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
