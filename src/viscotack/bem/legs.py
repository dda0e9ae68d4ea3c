"""From the moves of a test to the legs of a march."""

from __future__ import annotations

import numpy as np

from viscotack.bem.contacts.contact import Contact, Relaxed
from viscotack.bem.machine import Leg
from viscotack.bem.settings import Settings
from viscotack.protocol import (
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

# Waiting begins with this part of the time it lasts.
_FIRST_WAIT = 1e-6
# A move of given duration begins with this part of it, at most.
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
    """Return the depths [h0] through which a test goes, about, in their order."""
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


def longest_time(
    depths: list[float], moves: tuple[Move, ...], rate: float | None, contact: Contact
) -> float:
    """Return how long a test takes, about, and rather more: what its solid must remember."""
    total = 0.0
    for before, after, move in zip(depths[:-1], depths[1:], moves, strict=True):
        total += lasting(before, after, move, contact)
    if rate is not None:
        total += (max(depths[-1], 0.0) + 5 * contact.travel) / rate
    return total


def lasting(before: float, after: float, move: Move, contact: Contact) -> float:
    """Return how long a move takes from one depth to another, about, and rather more."""
    if isinstance(move, Approach | Retract):
        return (abs(after - before) + 5 * contact.travel) / move.speed
    return move.duration
