r"""Two contacts in series by steady cracks: which of them opens, with bands.

Each contact is that of :func:`viscotack.crack_contact`, and both carry the same force
(:mod:`viscotack.theory.crack.contact.series`). Each has a band of its strength from
:mod:`.crack_contact.by_crack`, at its energy and travel when the common tension is largest. The
answer is decided if the same contact opens in both corners of the bands: with the first contact
weaker and the second stronger, and the reverse.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isnan
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.model.geometry import Sphere
from viscotack.model.problem import Groups, Problem
from viscotack.model.traction import LennardJones, has_rest
from viscotack.simulate.crack_contact import not_covered
from viscotack.simulate.crack_contact.by_crack import (
    LEAST_TABOR,
    band_parts,
    effective_tabor,
    not_measured,
    tension_left,
    too_large_zone,
)
from viscotack.simulate.crack_contact.crack_problem import start_of
from viscotack.theory import SteadyCrack, lennard_jones
from viscotack.theory.crack.contact import Elastic, Pulled, Receding, Scales, profile_of, pull_apart
from viscotack.theory.elastic.relaxed import contact_in_groups

# Error of the table of elastic pull-off forces, relative to simulations.
_TABLE_ERROR = 0.005
# Contribution of the coupling to the band of each contact.
_COUPLING_BAND = 0.01
# Smallest travel of the edge of the opening contact to the largest tension [zone lengths], if its
# energy exceeds `_SLOW`.
_LEAST_ZONES, _SLOW = 1.5, 1.1


CRACKS, SIMULATION = "steady cracks", "simulation"
OVERLAP = "the intervals of both strengths overlap"


@dataclass(frozen=True)
class SeriesOpening:
    """Answer to which of two contacts in series opens.

    Attributes
    ----------
    opened : int or None
        The contact that opens, 0 or 1; None if it is undecided.
    tension : float or None
        Largest common tension [N], the pull-off force of the pair; None if unknown.
    held : float or None
        Radius of the contact that holds after the largest tension, over that at the start; None if
        unknown.
    bands : tuple of float, or None
        Relative half widths of the 90 % intervals of the strengths of both contacts; None for a
        simulation and where steady cracks do not apply.
    nominal : int or None
        The contact that opens without regard to bands.
    corners : tuple of (int or None)
        The contact that opens if the first is weaker and the second stronger by their bands, and
        the reverse.
    method : str
        "steady cracks" or "simulation".
    why : str
        Reason for an undecided answer, and for a simulation.
    """

    opened: int | None = None
    tension: float | None = None
    held: float | None = None
    bands: tuple[float, float] | None = None
    nominal: int | None = None
    corners: tuple[int | None, int | None] = (None, None)
    method: str = CRACKS
    why: str = ""


@dataclass(frozen=True, eq=False)
class _Side:
    """A contact as theory takes it, with its problem; the crack is None if it is elastic."""

    groups: Groups
    crack: SteadyCrack | None
    contact: Receding | Elastic


def opening_by_cracks(first: Problem, second: Problem) -> SeriesOpening:
    """Return which of two contacts in series opens, by steady cracks.

    Parameters
    ----------
    first, second : Problem
        Both contacts with the same protocol: a relaxed start at a force, a speed, and perhaps the
        stiffness of the machine.

    Raises
    ------
    OutOfRange
        If the theory does not hold for one of the contacts; the message names it.
    ValueError
        If a contact has no relaxed start under the common force.
    """
    sides = _side(first), _side(second)
    test: Any = first.protocol

    def pulled(strengths: tuple[float, float]) -> Pulled:
        one, other = (x.contact.stronger(s) for x, s in zip(sides, strengths, strict=True))
        return pull_apart(
            (one, other), preload=test.start.force, speed=test.speed, stiffness=test.stiffness
        )

    found = pulled((1.0, 1.0))
    bands = [_band(side, found, i) for i, side in enumerate(sides)]
    weaker, stronger = (pulled((1 - s * bands[0], 1 + s * bands[1])) for s in (1, -1))
    opened = found.opened, weaker.opened, stronger.opened
    nominal, *corners = (None if each < 0 else each for each in opened)
    decided = nominal if corners == [nominal] * 2 else None
    return SeriesOpening(
        decided,
        found.tension,
        None if isnan(found.held) else float(found.held),
        (bands[0], bands[1]),
        nominal,
        (corners[0], corners[1]),
        why="" if decided is not None else OVERLAP,
    )


def _side(problem: Problem) -> _Side:
    """Return a contact of theory; OutOfRange if it does not hold."""
    groups: Any
    groups, si = problem.groups(), problem.scales()
    if reason := not_covered(groups):
        raise OutOfRange(
            f"steady cracks in series cover {reason}; simulate both contacts (`simulate`)"
        )
    groups = replace(groups, moves=(), stiffness=None)
    assert groups.tabor is not None
    profile = profile_of(groups.geometry)
    scales = Scales(si.length * groups.tabor, si.force / (1.5 * np.pi), si.time)
    if has_rest(groups.traction):
        raise OutOfRange(
            "steady cracks in series were not compared with simulations of interfaces that grow "
            "with the opening speed, or age in contact; simulate"
        )
    elastic = groups.modulus_ratio == 1
    is_table = isinstance(groups.geometry, Sphere) and isinstance(groups.traction, LennardJones)
    if not (elastic and is_table):
        if groups.effective_tabor < LEAST_TABOR:
            raise OutOfRange(too_large_zone(groups, groups.effective_tabor))
        if reason := not_measured(groups):
            raise OutOfRange(f"the band of steady cracks was not measured here: {reason}")
    if contact_in_groups(groups.start, tabor=groups.tabor, shape=groups.geometry) is None:
        raise InputError(
            f"no relaxed contact of {problem.geometry} exists under the common force of "
            f"{groups.start.force * si.force:.4g} N; press harder"
        )
    radius, _ = start_of(groups, profile)
    crack = SteadyCrack(groups.material, groups.traction)
    if elastic:
        left = float(lennard_jones.pull_off_ratio(groups.effective_tabor))
        return _Side(groups, None, Elastic(profile, radius=radius, scales=scales, left=left))

    def left_of(energy: Array, speed: Array) -> Array:
        return tension_left(groups, crack, energy, speed)

    contact = Receding(
        crack, profile, tabor=groups.tabor, radius=radius, scales=scales, left=left_of
    )
    return _Side(groups, crack, contact)


def _band(side: _Side, found: Pulled, number: int) -> float:
    """Return the band of the strength of a contact; OutOfRange if its crack is not steady."""
    groups, crack = side.groups, side.crack
    if crack is None:
        if isinstance(groups.geometry, Sphere) and isinstance(groups.traction, LennardJones):
            return _TABLE_ERROR
        return float(sum(band_parts(1.0, groups.effective_tabor, 1.0)))
    energy = max(found.energy[number], 1.0)
    effective = float(effective_tabor(groups, energy, 1.0))
    if effective < LEAST_TABOR:
        raise OutOfRange(too_large_zone(groups, effective, energy))
    assert isinstance(side.contact, Receding)
    assert groups.tabor is not None
    start = side.contact.radius(side.contact.start())
    zone = crack.zone_length * energy / groups.tabor**2
    zones = start * (1 - found.radius[number]) / zone
    if found.opened in (number, -1) and zones < _LEAST_ZONES and energy > _SLOW:
        raise OutOfRange(
            f"the edge of the contact that opens travels {zones:.2g} zone lengths to the largest "
            f"tension, and a crack is steady after {_LEAST_ZONES:g}; press harder, pull more "
            "slowly, or simulate"
        )
    return float(sum(band_parts(energy, effective, zones))) + _COUPLING_BAND
