"""Where a march is: all that its next step begins from; and what its steps have in common."""

from __future__ import annotations

from dataclasses import dataclass
from math import ulp

from viscotack.bem.body import Body, State
from viscotack.bem.books import Books, History, Lowest, Profile, Snapshot
from viscotack.bem.machine import Hold, Leg
from viscotack.bem.mesh import Mesh
from viscotack.bem.settings import Settings

# A time of no more than so many units in the last place of the clock is none.
_TICKS = 8


@dataclass(frozen=True, eq=False)
class Place:
    """Where a march is.

    Attributes
    ----------
    state, books, mesh : State, Books, Mesh
        The body, where the work of the drive went, and the nodes.
    leg, number, began : Leg, int, Snapshot
        The leg under way, its number, and the instant at which it began.
    dt : float
        Length of the next step [time unit of the modes].
    lowest : Lowest
        The least force of the leg.
    """

    state: State
    books: Books
    mesh: Mesh
    leg: Leg
    number: int
    began: Snapshot
    dt: float
    lowest: Lowest

    @property
    def seen(self) -> Snapshot:
        """What is kept of this instant."""
        return self.state.seen

    @property
    def past(self) -> bool:
        """Whether a force minimum of this leg, the lowest so far, is behind."""
        return self.lowest.behind(self.seen.force)

    @property
    def ahead(self) -> float:
        """How far the nearest end of the leg is, as a depth, a force or an edge."""
        return self.leg.missing(self.seen)

    @property
    def left(self) -> float:
        """The time left of the leg, none where the clock can no longer tell it from none."""
        now = self.seen.time
        left = self.leg.duration - (now - self.began.time)
        return left if left > _TICKS * ulp(now) else 0.0

    def hold(self, later: float = 0.0) -> Hold:
        """Return what the machine imposes, now or so much later."""
        elapsed = self.seen.time - self.began.time + later
        return self.leg.hold(self.began, elapsed, self.state.surface.unit)


@dataclass(frozen=True, eq=False)
class Run:
    """What all steps of a march have in common: the body, the legs, and the history they write."""

    body: Body
    settings: Settings
    legs: tuple[Leg, ...]
    profiles: bool
    history: History

    def keep(self, at: Place) -> None:
        """Keep what is to be kept of a place."""
        state, history = at.state, self.history
        history.snapshots.append(at.seen)
        history.books.append(at.books)
        history.legs.append(at.number)
        history.nodes = max(history.nodes, len(state.gap))
        if self.profiles:
            pressure = state.nodal / state.surface.area
            history.profiles.append(Profile(state.surface.position, pressure, state.gap))
