r"""Boundary condition of the machine, and the legs of a run, made from the moves of a test.

The drive at D pushes the indenter, at depth :math:`\delta`, through a spring k with the force
:math:`P = k (D - \delta)`. A rigid machine has an infinite k, and a dead load none: there P itself
is imposed. A history is a sequence of legs, in each of which one of the three is linear in time.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, isinf, isnan, nan

import numpy as np

from viscotack.model.protocol import (
    Approach,
    AtDepth,
    AtForce,
    AtRadius,
    Dwell,
    LoadTo,
    Move,
    MoveTo,
    Retract,
    end_of,
)
from viscotack.simulate.contacts.contact import Contact, Relaxed
from viscotack.simulate.history import Snapshot
from viscotack.simulate.settings import Settings


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


# First step of a dwell, as a fraction of its duration.
_FIRST_WAIT = 1e-6
# Largest pull-off force of a sphere times k. A punch has less, other tips a few times as much.
_PULL_OFF = 4 / 3
# Largest first step of a move of given duration, as a fraction of it.
_FIRST_MOVE = 1e-3


# Attributes of a leg that ends at a state.
_ENDS = {AtDepth: "depth", AtForce: "force", AtRadius: "edge"}


def legs_of(
    moves: tuple[Move, ...],
    rate: float | None,
    stiffness: float | None,
    contact: Contact,
    settings: Settings,
) -> tuple[Leg, ...]:
    """Return the legs of a test: its moves, and the retraction unless the rate is None."""
    k = np.inf if stiffness is None else stiffness
    first_travel = settings.first_travel * contact.travel
    legs = []
    for move in moves:
        match move:
            case Approach() | Retract():
                way, to = (1.0 if isinstance(move, Approach) else -1.0), move.to
                unit = contact.edge_unit if isinstance(to, AtRadius) else 1.0
                end = {_ENDS[type(to)]: to.value * unit}
                step = first_travel / move.speed
                legs.append(Leg(k, way * move.speed, **end, least_step=step))
            case MoveTo():
                step = _FIRST_MOVE * move.duration
                legs.append(Leg(k, np.nan, move.duration, drive=move.depth, least_step=step))
            case LoadTo():
                step = _FIRST_MOVE * move.duration
                legs.append(Leg(0.0, np.nan, move.duration, drive=move.force, least_step=step))
            case Dwell():
                held = {"drive": k, "depth": np.inf, "force": 0.0}[move.hold]
                step = _FIRST_WAIT * move.duration
                legs.append(Leg(held, 0.0, move.duration, least_step=step))
    if rate is not None:
        legs.append(Leg(k, -rate, least_step=first_travel / rate))
    return tuple(legs)


def reached(start: Relaxed, moves: tuple[Move, ...], contact: Contact) -> list[float]:
    """Return the approximate depths [h0] at the start and after each move of a test."""
    depths = [start.depth]
    for move in moves:
        end = end_of(move)
        depths.append(depths[-1] if end is None else contact.deepest(end))
    return depths


def spring_travel(
    start: Relaxed,
    depths: list[float],
    moves: tuple[Move, ...],
    stiffness: float | None,
    modulus_ratio: float,
    contact: Contact,
) -> float:
    """Return the approximate spring elongation [h0] at the largest force of a test.

    This force is a prescribed force, the pull-off force, or the force that presses the solid with
    its instantaneous stiffness.
    """
    if stiffness is None:
        return 0.0
    pressed = (max(*depths, 0.0) / contact.travel) ** 1.5
    forces = [abs(start.force), max(pressed, _PULL_OFF) / modulus_ratio]
    for move in moves:
        if isinstance(end := end_of(move), AtForce):
            forces.append(abs(end.force))
    return max(forces) / stiffness


def longest_time(
    depths: list[float],
    moves: tuple[Move, ...],
    rate: float | None,
    contact: Contact,
    spring: float = 0.0,
) -> float:
    """Return an upper estimate of the duration of a test, the longest relevant retardation time.

    With a spring the drive moves farther than the contact, by the travel `spring`.
    """
    total = 0.0
    for before, after, move in zip(depths[:-1], depths[1:], moves, strict=True):
        total += lasting(before, after, move, contact)
        if isinstance(move, Approach | Retract):
            total += 2 * spring / move.speed
    if rate is not None:
        total += (max(depths[-1], 0.0) + 5 * contact.travel + 2 * spring) / rate
    return total


def lasting(before: float, after: float, move: Move, contact: Contact) -> float:
    """Return an upper estimate of the duration of a move from one depth to another."""
    if isinstance(move, Approach | Retract):
        return (abs(after - before) + 5 * contact.travel) / move.speed
    return move.duration
