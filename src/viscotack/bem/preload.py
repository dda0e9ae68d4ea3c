r"""Shallower start for a retraction from a deep contact, with the same pull-off.

The pull-off of an elastic contact does not depend on the initial depth. In a viscoelastic solid the
dependence vanishes as the creep ends. With

.. math:: M(t) = 1 - E_0\, C(t),

the part of the creep that is left after a time t, force and work at pull-off differ from those of a
much deeper start by less than 2 M(t), t being the time from start to pull-off (power laws of
both kinds and standard solids, k from 1e-3 to 0.1, Tabor numbers from 0.3 to 10). Two light marches
from depths that differ by a factor of four say it better: what is still to come is to what has
come between them as M is at the deeper one to what it has lost. They also see a crack that has not
come up to its speed, as behind a soft spring, where the solid has long crept. So the depth grows by
fours until the effect is small beside the accuracy; what it is, is added to the error estimate. And
the start is pressed as hard as the contact then pulls, so that the whole of the work lies
behind it.

The indentation that is left of the deeper way is a mere displacement for work and force. It shifts
the depth of the pull-off by no more than :math:`v \int M\, dt` over the time that is left out,
which is bounded as well.

A retraction that is over before the solid has begun to creep never forgets, and a spectrum without
an end hardly: then the depth is the one asked for, or refused where the march would be too long.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import log

import numpy as np
import numpy.typing as npt

from viscotack.bem.contacts.contact import Contact
from viscotack.bem.settings import Settings
from viscotack.errors import InputError
from viscotack.geometry import Cone, HalfSpace, PowerLawProfile, Sphere
from viscotack.materials import Material
from viscotack.problem import Groups
from viscotack.protocol import Apart
from viscotack.result import Result, ShallowStart
from viscotack.result.observables import pull_off, work_to_pull_off
from viscotack.traction import grows

# Starts up to this depth [h0] are marched as they are: that takes seconds.
_DEEP = 1000.0
# The depths that are tried: the first in travels of the contact, each this many times the last,
# and none above this part of the depth asked for, where little would be saved.
_FIRST, _DEEPER, _WORTH = 5.0, 4.0, 0.5
# No effect of the depth is larger than this many times the part of the creep that is left; the
# largest seen is 2.
_SENSITIVE = 5.0
# The remaining effect is the estimate from the creep times this factor, and at least this fraction
# of the effect so far, because creep is not the only slow process.
_SAFE, _LEAST = 1.5, 0.1
# What the depth may do, as parts of the accuracy; the work has five times the error of the force.
_SHARES = {"force": 0.3, "work": 1.5}
# It may shift the depth at pull-off by these parts of the travel of the contact, or of that depth.
_SHIFT, _SHIFT_FAR = 0.05, 0.005
# Times at which the creep of the way that is left out is looked up.
_TIMES = 200
# The march itself has about this many times the steps of a light one.
_LIGHT = 2.0


@dataclass(frozen=True, eq=False)
class Beginning:
    """Where a march begins instead, and the light march from there."""

    start: ShallowStart
    light: Result


@dataclass(frozen=True, eq=False)
class _End:
    """What a light march from a depth came to, where, when; and the part of the creep left then."""

    depth: float
    values: Mapping[str, float]
    place: float
    time: float
    left: float
    result: Result

    @property
    def steps(self) -> float:
        return self.result.statistics["steps"]


def shallower(
    groups: Groups,
    contact: Contact,
    settings: Settings,
    light: Callable[[float], Result],
) -> Beginning | None:
    """Return where the march of a test may begin instead of at its start; None for the start.

    Parameters
    ----------
    groups : Groups
        The test.
    contact : Contact
        Its contact.
    settings : Settings
        Of the march.
    light : callable
        Marches from a depth [h0] to the pull-off with coarser settings.

    Raises
    ------
    ValueError
        If the start cannot be replaced, and is too deep to be marched.
    """
    asked = _asked(groups, contact)
    if not asked > _DEEP:
        return None
    ends: list[_End] = []
    depth = _FIRST * contact.travel
    while depth <= _WORTH * asked and _LIGHT * _steps(ends, depth) <= settings.most_steps:
        end = _ended(light, depth, groups.material)
        if end is not None:
            effects = _effects(ends, end, groups.material)
            start = ShallowStart(asked, depth, **effects, shift=_shift(groups, end, asked))
            if _will_do(start, end, contact, settings):
                return Beginning(start, end.result)
            ends.append(end)
        depth *= _DEEPER
    _check_length(ends, asked, settings)
    return None


def _asked(groups: Groups, contact: Contact) -> float:
    """Return the depth [h0] at which a test begins, about; 0 where it must be marched as it is.

    That are tests with moves before the retraction, or without one, of punches, of other bodies
    than the half-space, of shapes that may have several contacts at one depth, and of interfaces
    that grow with the opening speed.
    """
    if isinstance(groups.start, Apart):
        return 0.0
    known = isinstance(groups.geometry, Sphere | Cone | PowerLawProfile)
    known &= isinstance(groups.body, HalfSpace)
    if groups.moves or groups.rate is None or not known or grows(groups.traction):
        return 0.0
    return contact.deepest(groups.start)


def _ended(light: Callable[[float], Result], depth: float, material: Material) -> _End | None:
    """Run a coarse simulation from a depth; None if it has no start or no pull-off."""
    try:
        result = light(depth)
        found, work = pull_off(result), work_to_pull_off(result)
    except InputError:
        return None
    values = {"force": found.force, "work": work}
    left = float(_left(material, found.time))
    return _End(depth, values, found.depth, found.time, left, result)


def _left(material: Material, time: float | npt.NDArray) -> npt.NDArray:
    """Return the part of the creep that is left after a time."""
    return np.maximum(1 - np.asarray(material.creep(time)), 0.0)


def _will_do(start: ShallowStart, end: _End, contact: Contact, settings: Settings) -> bool:
    """Return whether a march may begin there."""
    pressed = end.result.force[0] >= end.values["force"]
    shares = (start.force / _SHARES["force"], start.work / _SHARES["work"])
    far = max(_SHIFT * contact.travel, _SHIFT_FAR * abs(end.place))
    return pressed and max(shares) <= settings.accuracy and start.shift <= far


def _shift(groups: Groups, end: _End, asked: float) -> float:
    """Return by how much the indentation that is left of the way before shifts the pull-off [h0].

    A spring only makes the contact slower.
    """
    assert groups.rate is not None
    before = (asked - end.depth) / groups.rate
    time = np.geomspace(end.time, end.time + before, _TIMES)
    left = _left(groups.material, time)
    return groups.rate * float(np.sum(np.diff(time) * (left[1:] + left[:-1]) / 2))


def _effects(before: list[_End], end: _End, material: Material) -> dict[str, float]:
    """Return by how much force and work may change from a depth on, relative."""
    if material.modulus_ratio == 1:
        return dict.fromkeys(_SHARES, 0.0)
    if not before:
        return dict.fromkeys(_SHARES, 1.0)  # nothing is known
    last, effects = before[-1], {}
    lost = last.left - end.left
    for name, value in end.values.items():
        change = abs(value - last.values[name]) / abs(value)
        fading = _SENSITIVE * end.left
        if lost > 0:
            fading = min(fading, _SAFE * change * end.left / lost)
        effects[name] = max(fading, _LEAST * change)
    return effects


def _steps(ends: list[_End], depth: float) -> float:
    """Return the steps of a light march from a depth, as they grow between the last two; 0."""
    if len(ends) < 2:
        return 0.0
    last, end = ends[-2:]
    power = log(end.steps / last.steps) / log(end.depth / last.depth)
    return end.steps * (depth / end.depth) ** power


def _check_length(ends: list[_End], asked: float, settings: Settings) -> None:
    """Refuse a depth from which a march would take more steps than it may."""
    needed = _LIGHT * _steps(ends, asked)
    if needed <= settings.most_steps:
        return
    last, end = ends[-2:]
    changes = {n: 100 * abs(v - last.values[n]) / abs(v) for n, v in end.values.items()}
    raise InputError(
        f"a march from a depth of {asked:.3g} h0 would take about {needed:.1g} steps, more than "
        f"{settings.most_steps}, and a shallower start would not do: from {last.depth:.3g} to "
        f"{end.depth:.3g} h0 the force still changes by {changes['force']:.2g} % and the work by "
        f"{changes['work']:.2g} %, and {100 * end.left:.2g} % of the creep is left at the "
        f"pull-off; start at {end.depth:.2g} h0, say, or retract more slowly"
    )
