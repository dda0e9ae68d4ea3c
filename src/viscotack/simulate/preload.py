r"""Shallower start for a retraction from a deep contact, with the same pull-off.

The pull-off of an elastic contact does not depend on the initial depth. In a viscoelastic solid the
dependence vanishes as the creep ends. With

.. math:: M(t) = 1 - E_0\, C(t),

the fraction of the creep that remains after a time t, force and work at pull-off differ from those
of a much deeper start by less than 2 M(t), where t is the time from start to pull-off. This was
found for power laws of both kinds and standard solids, k from 1e-3 to 0.1, Tabor numbers from 0.3
to 10. Two coarse runs from depths that differ by a factor of four give a better estimate. The ratio
of the remaining effect to the difference of the two runs equals the ratio of M at the deeper one to
its decrease between them. These runs also detect a crack that has not reached its final speed
although the creep has ended, for example with a soft spring. The depth is therefore multiplied by
four until the effect is small compared with the accuracy. The remaining effect is added to the
error estimate. The start must also be pressed with at least the pull-off force, so that the run
contains the whole work of separation.

The remaining indentation of the omitted path is a uniform displacement without effect on work and
force. It shifts the depth of the pull-off by at most :math:`v \int M\, dt` over the omitted time,
which is limited as well.

If pull-off occurs before the solid starts to creep, or if the spectrum is unbounded, the effect
does not vanish. The run then starts from the requested depth, or is rejected if it would be too
long.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import log

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.model.geometry import Cone, HalfSpace, PowerLawProfile, Sphere
from viscotack.model.materials import Material
from viscotack.model.problem import Groups
from viscotack.model.protocol import Apart, AtDepth
from viscotack.model.traction import has_rest
from viscotack.result import Result, ShallowStart
from viscotack.result.observables import pull_off, work_to_pull_off
from viscotack.simulate.contacts.contact import Contact
from viscotack.simulate.settings import Settings

# Starts up to this depth [h0] are simulated directly, which takes seconds.
_DEEP = 1000.0
# Trial depths: the first in travels of the contact, the ratio of successive depths, and the largest
# as a fraction of the requested depth, above which little time would be saved.
_FIRST, _DEEPER, _WORTH = 5.0, 4.0, 0.5
# Upper bound of the effect of the depth, as a multiple of the remaining fraction of the creep; the
# largest observed multiple is 2.
_SENSITIVE = 5.0
# The remaining effect is the estimate from the creep times this factor, and at least this fraction
# of the effect so far, because creep is not the only slow process.
_SAFE, _LEAST = 1.5, 0.1
# Allowed effects of the depth, relative to the accuracy; work has five times the error of force.
_SHARES = {"force": 0.3, "work": 1.5}
# Allowed shift of the depth at pull-off, as fractions of the contact travel and of that depth.
_SHIFT, _SHIFT_FAR = 0.05, 0.005
# Number of times for the integral of the creep over the omitted path.
_TIMES = 200
# Approximate ratio of the steps of the main run to those of a coarse run.
_LIGHT = 2.0


@dataclass(frozen=True, eq=False)
class Beginning:
    """Shallower start of a run, and the coarse run from there."""

    start: ShallowStart
    light: Result


@dataclass(frozen=True, eq=False)
class _End:
    """Pull-off of a coarse run from a depth: values, depth, time, and remaining creep."""

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
    light: Callable[[Groups], Result],
) -> Beginning | None:
    """Return a shallower start that gives the same pull-off, None to use the given start.

    Parameters
    ----------
    groups : Groups
        The test.
    contact : Contact
        Its contact.
    settings : Settings
        Settings of the main run.
    light : callable
        Simulates a test to the pull-off with coarser settings.

    Raises
    ------
    ValueError
        If the start cannot be replaced and is too deep for a direct simulation.
    """
    asked = _asked(groups, contact)
    if not asked > _DEEP:
        return None
    ends: list[_End] = []
    depth = _FIRST * contact.travel
    while depth <= _WORTH * asked and _LIGHT * _steps(ends, depth) <= settings.most_steps:
        end = _ended(light, replace(groups, start=AtDepth(depth)), depth)
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
    """Return the approximate initial depth [h0] of a test, 0 if its start must not be replaced.

    The start is not replaced for tests with moves before the retraction or without a retraction,
    for punches, for bodies other than the half-space, for shapes that may have several contacts at
    one depth, and for interfaces that grow or age.
    """
    if isinstance(groups.start, Apart):
        return 0.0
    known = isinstance(groups.geometry, Sphere | Cone | PowerLawProfile)
    known &= isinstance(groups.body, HalfSpace)
    if groups.moves or groups.rate is None or not known or has_rest(groups.traction):
        return 0.0
    return contact.deepest(groups.start)


def _ended(light: Callable[[Groups], Result], groups: Groups, depth: float) -> _End | None:
    """Run a coarse simulation from a depth; None if it has no start or no pull-off."""
    try:
        result = light(groups)
        found, work = pull_off(result), work_to_pull_off(result)
    except InputError:
        return None
    values = {"force": found.force, "work": work}
    left = float(_left(groups.material, found.time))
    return _End(depth, values, found.depth, found.time, left, result)


def _left(material: Material, time: float | npt.NDArray) -> npt.NDArray:
    """Return the fraction of the creep that remains after a time."""
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
