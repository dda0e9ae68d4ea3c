"""What a march keeps of each step: where it was, and where the work at the indenter went.

The spring of the machine is not booked here: what it stores is :math:`F^2/(2K)` at every instant,
the work of the drive is that at the indenter and the change of that energy, and both add the same
to either side of the balance.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from viscotack.result import Event

# The imbalance of the energies is measured by their largest term, but by no less than this: at the
# start all of them are zero [output force times the range of the law].
SMALLEST_ENERGY = 0.1
# Pull-off is behind when the force has risen again by this part of its minimum and of the unit of
# force: a force that has just become tensile is as large as what nodes add to it.
_RISEN = 0.03


@dataclass(frozen=True)
class Snapshot:
    """One instant; energies in the output unit of force times h0."""

    time: float
    depth: float  # [h0]
    edge: float  # [unit of the mesh], nan without one
    force: float  # [output unit]
    elastic: float
    interface: float
    inner: tuple[float, ...] = ()  # edges within the outermost [unit of the mesh], ascending

    @property
    def rings(self) -> int:
        """How many parts the contact has: rings, or a disc at the axis; 0 without an edge."""
        return len(self.inner) // 2 + 1 if self.edge > 0 else 0

    @property
    def hole(self) -> float:
        """The inner edge of the outermost part [unit of the mesh], 0 of a disc; nan without one."""
        return max(self.inner, default=0.0) if self.edge > 0 else np.nan

    @property
    def stored(self) -> float:
        """All energy of the contact that is not lost."""
        return self.elastic + self.interface

    @property
    def held(self) -> float:
        """Return what there is of energy in the contact, whatever its sign."""
        return abs(self.elastic) + abs(self.interface)


@dataclass(frozen=True, eq=False)
class Books:
    """Where the work at the indenter went so far; heat by mode, and that in the interface."""

    work: float
    heat: npt.NDArray
    jumps: float = 0.0
    transfer: float = 0.0
    interface: float = 0.0

    def entered(self, work: float, heat: npt.NDArray, interface: float = 0.0) -> Books:
        """Return the books after a step in which the indenter did work, and heat was left."""
        return replace(
            self,
            work=self.work + work,
            heat=self.heat + heat,
            interface=self.interface + interface,
        )

    def imbalance(self, start: Snapshot, now: Snapshot) -> float:
        """Return the work that is nowhere to be found."""
        stored = now.stored - start.stored
        heat = float(self.heat.sum()) + self.interface
        return self.work - stored - heat - self.jumps - self.transfer

    def largest(self, start: Snapshot, now: Snapshot) -> float:
        """Return the largest term, the measure of the imbalance."""
        stored = now.elastic - start.elastic, now.interface - start.interface
        heat = float(self.heat.sum())
        terms = (self.work, *stored, heat, self.interface, self.jumps, self.transfer)
        return max(abs(term) for term in terms)


@dataclass(frozen=True)
class Lowest:
    """The least force of a leg so far, and how many steps have been made since."""

    force: float = np.inf
    since: int = 0

    def after(self, force: float) -> Lowest:
        """Return the least force after one more step."""
        return Lowest(force) if force < self.force else replace(self, since=self.since + 1)

    def behind(self, force: float) -> bool:
        """Return whether this was the pull-off, for the force at present."""
        risen = min(force, 0.0) - self.force
        return self.since > 2 and risen > _RISEN * (abs(self.force) + 1)


@dataclass(frozen=True, eq=False)
class Profile:
    """Pressure [dg/h0] and gap [h0] over the surface [unit of the mesh] at one instant."""

    position: npt.NDArray
    pressure: npt.NDArray
    gap: npt.NDArray


@dataclass(eq=False)
class History:
    """What the march passed through: a snapshot and the books after each step.

    `least_energy` is what the imbalance of the energies is measured by at least [output force times
    h0], `stiffness` that of the spring of the machine [output force/h0], None without one. `legs`
    has the number of the leg that led to each snapshot, `pressed` the pressure [dg/h0] that no law
    withstood, where the outcome is "shut", `reason` what the time limit says, `left` how many legs
    a dead load that has let go left.
    """

    least_energy: float
    stiffness: float | None = None
    snapshots: list[Snapshot] = field(default_factory=list)
    books: list[Books] = field(default_factory=list)
    legs: list[int] = field(default_factory=list)
    profiles: list[Profile] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    outcome: str = ""
    pressed: float = 0.0
    reason: str = ""
    left: int = 0
    iterations: int = 0
    rejected: int = 0
    meshes: int = 1
    nodes: int = 0

    def measure(self, books: Books, now: Snapshot) -> float:
        """Return what an imbalance at an instant is measured by: the largest energy.

        Behind a soft spring the edge snaps from node to node, and loses a little each time: there
        it is no less than what the contact holds, as far as the spring has given or taken that.
        """
        first = self.snapshots[0]
        largest = max(books.largest(first, now), self.least_energy)
        if self.stiffness is None:
            return largest
        spring = abs(now.force**2 - first.force**2) / (2 * self.stiffness)
        return max(largest, min(now.held, spring))

    def imbalances(self) -> npt.NDArray:
        """Return the missing energy at each snapshot over what it is measured by until then."""
        first = self.snapshots[0]
        pairs = list(zip(self.books, self.snapshots, strict=True))
        missing = np.array([b.imbalance(first, s) for b, s in pairs])
        largest = np.array([self.measure(b, s) for b, s in pairs])
        return missing / np.maximum.accumulate(largest)
