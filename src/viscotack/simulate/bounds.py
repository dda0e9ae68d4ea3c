"""Input limits of a simulation, checked before any computation starts.

Values far outside the physical range are allowed and give the results of the limiting cases. Values
are rejected if they exceed floating-point range, time resolution, mesh size or a reasonable run
time.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from viscotack.cards import cards
from viscotack.errors import InputError
from viscotack.model.problem import Groups
from viscotack.model.protocol import Apart, Approach, AtRadius, Move, Retract, end_of
from viscotack.model.traction import ages, effective_range
from viscotack.simulate.contacts.contact import Contact, Relaxed
from viscotack.simulate.contacts.punch import PunchContact
from viscotack.simulate.equilibrium import descend
from viscotack.simulate.machine import Hold, Leg, lasting

# Range of the magnitudes of a test; their squares and cubes must not overflow.
_SMALLEST, _LARGEST = 1e-100, 1e100
# A softer machine equals a dead load in double precision; it must be stated as a dead load.
_SOFTEST = 1e-9
# Limits of half width and thickness of a punch, and of their ratio.
_NARROWEST, _WIDEST = 1e-9, 1e9
# Range of a law relative to that of Lennard-Jones.
_SHORTEST, _LONGEST = 1e-6, 1e6
# Radii [that of the outputs] whose depths bound those of a contact of revolution: the last, and
# smaller ones, whose JKR solution on a layer takes less time; depth [h0] of a punch.
_RADII = (3.0, 30.0, 1000.0)
_DEEPEST_PUNCH = 1e7
# Largest depth change of a stable start, as a fraction of its travel.
_MOVED = 1e-2
# Largest time before a leg in units of its first step: time has 16 digits.
_TICKS = 1e14


def check_bounds(groups: Groups, contact: Contact) -> None:
    """Reject a problem with a value outside the limits of a simulation.

    Raises
    ------
    ValueError
        The message contains the value and the allowed range.
    """
    _check_numbers(groups)
    reach = effective_range(groups.traction)
    if not _SHORTEST <= reach <= _LONGEST:
        raise InputError(
            f"the range of the traction law must lie between {_SHORTEST:g} and {_LONGEST:g} of "
            f"that of Lennard-Jones for a simulation, got {reach:g} for {groups.traction}"
        )
    if isinstance(contact, PunchContact):
        sizes = {
            "size": contact.size,
            "thickness": contact.thickness,
            "thickness over size": contact.thickness / contact.size,
        }
        for name, value in sizes.items():
            if not _NARROWEST <= value <= _WIDEST:
                raise InputError(
                    f"{name} must lie between {_NARROWEST:g} and {_WIDEST:g} for a simulation of "
                    f"a punch, got {value:g}"
                )
    _check_depths(groups, contact)
    law: Any = groups.traction
    if ages(law) and not isinstance(groups.start, Apart) and not np.isfinite(law.settled):
        raise InputError(
            f"a relaxed contact has been closed for ever, and {law.word} has no end; start apart, "
            "approach and dwell for as long as the contact rests"
        )


def check_held(start: Relaxed, contact: Contact, leg: Leg) -> None:
    """Reject a start that is not stable with the spring of the machine."""
    if leg.rigid or leg.dead_load or not start.edge > 0:
        return
    surface, law, stiffness = start.surface, contact.law, leg.stiffness / start.surface.unit
    force = float(np.sum(surface.nodal(law, start.gap)))
    hold = Hold(stiffness, load=stiffness * start.depth + force)
    balance = descend(surface, law, surface.rigid_gap, 1.0, start.gap, hold)
    moved = abs(balance.depth - start.depth)
    if balance.stable and moved <= _MOVED * contact.travel:
        return
    raise InputError(
        f"no spring of stiffness {leg.stiffness:g} holds the relaxed contact at a depth of "
        f"{start.depth:.4g} h0, where the force is {start.force:.4g}: it detaches immediately; "
        "start deeper, or with a stiffer machine"
    )


def check_clock(
    legs: tuple[Leg, ...], moves: tuple[Move, ...], depths: list[float], contact: Contact
) -> None:
    """Reject a test in which a long part leaves no time resolution for a later one."""
    elapsed = 0.0
    for number, leg in enumerate(legs):
        if elapsed > _TICKS * leg.least_step:
            what = f"move {number + 1}" if number < len(moves) else "the retraction"
            raise InputError(
                f"{what} begins with steps of {leg.least_step:.3g} time units when about "
                f"{elapsed:.3g} have passed, and no clock has the digits for both; let the moves "
                "before it take less, or make it slower"
            )
        if number < len(moves):
            elapsed += lasting(depths[number], depths[number + 1], moves[number], contact)


def _check_numbers(groups: Groups) -> None:
    """Reject values of the test outside the floating-point range."""
    nouns: dict[str, Any] = {"the start": groups.start}
    for number, move in enumerate(groups.moves, 1):
        nouns[f"move {number}"] = move
        if isinstance(move, Approach | Retract):
            nouns[f"the end of move {number}"] = move.to
    numbers = [
        (f"{name.replace('_', ' ')} of {whose}", getattr(noun, name), field.card.measure)
        for whose, noun in nouns.items()
        for name, field in cards(type(noun)).items()
    ]
    if groups.rate is not None:
        numbers.append(("rate of the retraction", groups.rate, "speed"))
    if groups.stiffness is not None:
        numbers.append(("stiffness of the machine", groups.stiffness, "stiffness"))
    for name, value, measure in numbers:
        least = _SOFTEST if measure == "stiffness" else _SMALLEST
        if measure in ("depth", "force"):  # of either sign
            least = -_LARGEST
        if not least <= value <= _LARGEST:
            raise InputError(
                f"the {name} must lie between {least:g} and {_LARGEST:g} {groups.units[measure]} "
                f"for a simulation, got {value:g}"
            )


def _check_depths(groups: Groups, contact: Contact) -> None:
    """Reject a contact that is pressed too deep."""
    named: dict[str, Any] = {"the start": groups.start}
    named |= {f"move {number}": end_of(move) for number, move in enumerate(groups.moves, 1)}
    for whose, state in named.items():
        if state is None or isinstance(state, Apart):
            continue
        depth, deepest = contact.deepest(state), _DEEPEST_PUNCH
        for radius in () if groups.in_plane_strain else _RADII:
            deepest = contact.deepest(AtRadius(radius))
            if depth <= deepest:
                break
        if depth > deepest:
            raise InputError(
                f"{whose}, {state}, presses to a depth of about {depth:.3g} h0, and a simulation "
                f"takes up to {deepest:.3g} here; press less"
            )
