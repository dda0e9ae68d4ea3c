"""Recorded history of a simulation: snapshots and the energy balance after each step.

The spring of the machine is not included in the energy balance. It stores :math:`F^2/(2K)` at every
instant. The work of the drive equals the work at the indenter plus the change of this energy, so
the spring adds the same amount to both sides of the balance.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from viscotack.result import Event

# The energy imbalance is divided by the largest energy term, but by no less than this value,
# because all terms are zero at the start [output force times the range of the law].
SMALLEST_ENERGY = 0.1
# Pull-off has passed when the force has risen again by this fraction of its minimum plus one unit
# of force. The unit is added because a small tensile force is comparable to the discretisation
# error.
_RISEN = 0.03


@dataclass(frozen=True)
class Snapshot:
    """Recorded quantities at one instant; energies in output force times h0."""

    time: float
    depth: float  # [h0]
    edge: float  # [unit of the mesh], nan without one
    force: float  # [output unit]
    elastic: float
    interface: float
    inner: tuple[float, ...] = ()  # edges within the outermost [unit of the mesh], ascending

    @property
    def rings(self) -> int:
        """Number of parts of the contact: rings, or a disc at the axis; 0 without an edge."""
        return len(self.inner) // 2 + 1 if self.edge > 0 else 0

    @property
    def hole(self) -> float:
        """Inner edge of the outermost part [unit of the mesh], 0 for a disc; nan without edge."""
        return max(self.inner, default=0.0) if self.edge > 0 else np.nan

    @property
    def stored(self) -> float:
        """Recoverable energy of the contact: elastic plus interface energy."""
        return self.elastic + self.interface

    @property
    def held(self) -> float:
        """Sum of the magnitudes of elastic and interface energy."""
        return abs(self.elastic) + abs(self.interface)


@dataclass(frozen=True, eq=False)
class EnergyTerms:
    """Cumulative energy terms: work at the indenter, heat by mode, jumps, transfer, interface."""

    work: float
    heat: npt.NDArray
    jumps: float = 0.0
    transfer: float = 0.0
    interface: float = 0.0

    def entered(self, work: float, heat: npt.NDArray, interface: float = 0.0) -> EnergyTerms:
        """Return the terms after a step with this work of the indenter and this heat."""
        return replace(
            self,
            work=self.work + work,
            heat=self.heat + heat,
            interface=self.interface + interface,
        )

    def imbalance(self, start: Snapshot, now: Snapshot) -> float:
        """Return the energy imbalance: work minus stored, dissipated and lost energy."""
        stored = now.stored - start.stored
        heat = float(self.heat.sum()) + self.interface
        return self.work - stored - heat - self.jumps - self.transfer

    def largest(self, start: Snapshot, now: Snapshot) -> float:
        """Return the largest energy term, the scale of the imbalance."""
        stored = now.elastic - start.elastic, now.interface - start.interface
        heat = float(self.heat.sum())
        terms = (self.work, *stored, heat, self.interface, self.jumps, self.transfer)
        return max(abs(term) for term in terms)


@dataclass(frozen=True)
class Lowest:
    """Smallest force of a leg so far, and the number of steps since."""

    force: float = np.inf
    since: int = 0

    def after(self, force: float) -> Lowest:
        """Return the smallest force after a further step."""
        return Lowest(force) if force < self.force else replace(self, since=self.since + 1)

    def behind(self, force: float) -> bool:
        """Return whether the smallest force was the pull-off, given the present force."""
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
    """History of a simulation: a snapshot and the energy terms after each step.

    Main attributes: `least_energy`, the smallest scale of the energy imbalance [output force times
    h0]; `stiffness`, the spring stiffness of the machine [output force/h0], None without a spring;
    `legs`, the number of the leg of each snapshot; `pressed`, the pressure [dg/h0] that exceeded
    the repulsion of the law if the outcome is "shut"; `reason`, the message of the time limit;
    `left`, the number of remaining legs when a dead load detached the contact.
    """

    least_energy: float
    stiffness: float | None = None
    snapshots: list[Snapshot] = field(default_factory=list)
    books: list[EnergyTerms] = field(default_factory=list)
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

    @property
    def statistics(self) -> dict[str, float]:
        """Numbers of steps and of iterations."""
        return {
            "steps": len(self.snapshots) - 1,
            "newton_iterations": self.iterations,
            "rejected_steps": self.rejected,
        }

    def seen(self, name: str) -> npt.NDArray:
        """Return a recorded quantity at every snapshot."""
        return np.array([getattr(snapshot, name) for snapshot in self.snapshots])

    def energies(self) -> dict[str, npt.NDArray]:
        """Return the energies of :class:`viscotack.result.Energies` at every snapshot.

        If force or depth is prescribed, the drive follows and the energy F^2/2K of the spring is
        still given by F.
        """
        force = self.seen("force")
        spring = np.zeros_like(force) if self.stiffness is None else force**2 / (2 * self.stiffness)
        names = ("work", "jumps", "transfer", "interface")
        spent = {name: np.array([getattr(b, name) for b in self.books]) for name in names}
        return {
            "drive": spent["work"] + (spring - spring[0]),
            "elastic": self.seen("elastic"),
            "interface": self.seen("interface"),
            "spring": spring,
            "heat": np.array([b.heat for b in self.books]).sum(axis=1),
            "jumps": spent["jumps"],
            "transfer": spent["transfer"],
            "interface_heat": spent["interface"],
        }

    def measure(self, books: EnergyTerms, now: Snapshot) -> float:
        """Return the energy scale of the imbalance at an instant: the largest energy term.

        With a soft spring the edge snaps from node to node and loses a little energy each time. The
        scale is then at least the energy of the contact, limited to the change of spring energy.
        """
        first = self.snapshots[0]
        largest = max(books.largest(first, now), self.least_energy)
        if self.stiffness is None:
            return largest
        spring = abs(now.force**2 - first.force**2) / (2 * self.stiffness)
        return max(largest, min(now.held, spring))

    def imbalances(self) -> npt.NDArray:
        """Return the relative energy imbalance at each snapshot, over the largest scale so far."""
        first = self.snapshots[0]
        pairs = list(zip(self.books, self.snapshots, strict=True))
        missing = np.array([b.imbalance(first, s) for b, s in pairs])
        largest = np.array([self.measure(b, s) for b, s in pairs])
        return missing / np.maximum.accumulate(largest)
