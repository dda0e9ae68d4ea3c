r"""Boundary condition of the machine: depth, dead load or drive with spring; and loading legs.

The drive at D pushes the indenter, at depth :math:`\delta`, through a spring k with the force
:math:`P = k (D - \delta)`. A rigid machine has an infinite k, and a dead load none: there P itself
is imposed. A history is a sequence of legs, in each of which one of the three is linear in time.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, isinf, isnan, nan

from viscotack.simulate.history import Snapshot


@dataclass(frozen=True)
class Hold:
    """Boundary condition at one instant; forces here are sums of nodal forces.

    Attributes
    ----------
    stiffness : float
        Of the spring [nodal force/h0]; infinite for a rigid machine, 0 for a dead load.
    depth : float
        Depth of a rigid machine's indenter [h0].
    load : float
        Force of the spring on an indenter at depth 0, or the dead load [nodal force].
    """

    stiffness: float
    depth: float = 0.0
    load: float = 0.0

    @property
    def rigid(self) -> bool:
        """Whether the depth is imposed."""
        return isinf(self.stiffness)


@dataclass(frozen=True)
class Leg:
    """A part of the history of the machine, in the units of the contact's outputs.

    Attributes
    ----------
    stiffness : float
        Spring between drive and indenter [force/h0]; infinite or 0 as above.
    rate : float
        Change of the drive's depth [h0 per time], or of the dead load [force per time]; positive
        into the solid. nan: what brings the drive, or the load, to `drive` in the duration.
    duration : float
        The leg ends after this time, or earlier when depth, force or edge is reached.
    drive : float
        Depth of the drive [h0], or dead load, at the end; nan where it does not matter.
    depth, force, edge : float
        Depth of the indenter [h0], force, contact edge [unit of the mesh] at which it ends, met in
        the direction of the rate; nan where they do not matter.
    least_step : float
        Length of its first step.
    """

    stiffness: float
    rate: float
    duration: float = inf
    drive: float = nan
    depth: float = nan
    force: float = nan
    edge: float = nan
    least_step: float = 1.0

    def beginning(self, began: Snapshot) -> Leg:
        """Return the leg with its rate, given the snapshot at its start."""
        if not isnan(self.rate):
            return self
        # the depth of the drive follows from the spring of this leg, not of the previous one
        now = began.force if self.dead_load else began.depth + began.force / self.stiffness
        return replace(self, rate=(self.drive - now) / self.duration)

    def hold(self, began: Snapshot, elapsed: float, unit: float) -> Hold:
        """Return the boundary condition a time after the start; `unit`: force per nodal force."""
        if self.dead_load:
            return Hold(0.0, load=(began.force + self.rate * elapsed) / unit)
        if self.rigid:
            return Hold(inf, depth=began.depth + self.rate * elapsed)
        k = self.stiffness / unit
        return Hold(k, load=began.force / unit + k * (began.depth + self.rate * elapsed))

    @property
    def rigid(self) -> bool:
        """Whether the depth is imposed."""
        return isinf(self.stiffness)

    @property
    def dead_load(self) -> bool:
        """Whether the force is imposed."""
        return self.stiffness == 0

    @property
    def outwards(self) -> bool:
        """Whether the contact is being opened."""
        return self.rate < 0

    @property
    def opens(self) -> bool:
        """Whether the contact may detach in the leg: it is being opened or carries a dead load."""
        return self.outwards or self.dead_load

    def missing(self, now: Snapshot) -> float:
        """Return the distance to the nearest end of the leg; not positive if one is reached."""
        way = -1.0 if self.outwards else 1.0
        edge = 0.0 if isnan(now.edge) else now.edge
        ends = (self.depth - now.depth, self.force - now.force, self.edge - edge)
        return min((way * x for x in ends if not isnan(x)), default=inf)
