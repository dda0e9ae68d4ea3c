"""Conversion of the moves of a test to the legs of a run."""

from __future__ import annotations

import numpy as np

from viscotack.model.protocol import (
    Approach,
    AtDepth,
    AtForce,
    Dwell,
    LoadTo,
    Move,
    MoveTo,
    Retract,
    Start,
)
from viscotack.simulate.contacts.contact import Contact, Relaxed
from viscotack.simulate.machine import Leg
from viscotack.simulate.settings import Settings

# First step of a dwell, as a fraction of its duration.
_FIRST_WAIT = 1e-6
# Largest pull-off force of a sphere times k. A punch has less, other tips a few times as much.
_PULL_OFF = 4 / 3
# Largest first step of a move of given duration, as a fraction of it.
_FIRST_MOVE = 1e-3


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
                way = 1.0 if isinstance(move, Approach) else -1.0
                legs.append(
                    Leg(
                        k,
                        way * move.speed,
                        **_end(move.to, contact),
                        least_step=first_travel / move.speed,
                    )
                )
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


def _end(to: Start, contact: Contact) -> dict[str, float]:
    if isinstance(to, AtDepth):
        return {"depth": to.depth}
    if isinstance(to, AtForce):
        return {"force": to.force}
    return {"edge": to.contact_radius * contact.edge_unit}


def reached(start: Relaxed, moves: tuple[Move, ...], contact: Contact) -> list[float]:
    """Return the approximate depths [h0] at the start and after each move of a test."""
    depths = [start.depth]
    for move in moves:
        match move:
            case Approach() | Retract():
                depths.append(contact.deepest(move.to))
            case MoveTo():
                depths.append(move.depth)
            case LoadTo():
                depths.append(contact.deepest(AtForce(move.force)))
            case Dwell():
                depths.append(depths[-1])
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
        if isinstance(move, LoadTo):
            forces.append(abs(move.force))
        elif isinstance(move, Approach | Retract) and isinstance(move.to, AtForce):
            forces.append(abs(move.to.force))
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
