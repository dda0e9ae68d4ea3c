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

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from math import log
from typing import NamedTuple

import numpy as np

from viscotack.errors import InputError
from viscotack.model.geometry import Cone, HalfSpace, PowerLawProfile, Sphere
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


class _End(NamedTuple):
    """Pull-off of a coarse run from a depth: force and work, the creep left then, and its steps."""

    depth: float
    values: dict[str, float]
    left: float
    steps: float


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
    # not after moves or without a retraction, for punches, other bodies than the half-space, shapes
    # that may have several contacts at one depth, and interfaces that grow or age
    known = isinstance(groups.geometry, Sphere | Cone | PowerLawProfile)
    known &= isinstance(groups.body, HalfSpace) and not has_rest(groups.traction)
    if not known or groups.moves or groups.rate is None or isinstance(groups.start, Apart):
        return None
    asked = contact.deepest(groups.start)
    if not asked > _DEEP:
        return None
    ends: list[_End] = []
    depth = _FIRST * contact.travel
    while depth <= _WORTH * asked and _LIGHT * _steps(ends, depth) <= settings.most_steps:
        with suppress(InputError):  # there is no start or no pull-off
            result = light(replace(groups, start=AtDepth(depth)))
            found, work = pull_off(result), work_to_pull_off(result)
            # The indentation that is left of the way before shifts the pull-off. A spring only
            # makes the contact slower.
            before = (asked - depth) / groups.rate
            time = np.geomspace(found.time, found.time + before, _TIMES)
            left = np.maximum(1 - np.asarray(groups.material.creep(time)), 0.0)
            shift = groups.rate * float(np.sum(np.diff(time) * (left[1:] + left[:-1]) / 2))
            values = {"force": found.force, "work": work}
            end = _End(depth, values, float(left[0]), result.statistics["steps"])
            effects = _effects(ends[-1] if ends else None, end, groups.material.modulus_ratio)
            most = max(effects[name] / share for name, share in _SHARES.items())
            far = max(_SHIFT * contact.travel, _SHIFT_FAR * abs(found.depth))
            is_pressed = result.force[0] >= found.force
            if is_pressed and most <= settings.accuracy and shift <= far:
                return Beginning(ShallowStart(asked, depth, **effects, shift=shift), result)
            ends.append(end)
        depth *= _DEEPER
    needed = _LIGHT * _steps(ends, asked)
    if needed <= settings.most_steps:
        return None
    last, end = ends[-2:]
    changes = {n: 100 * abs(v - last.values[n]) / abs(v) for n, v in end.values.items()}
    raise InputError(
        f"a march from a depth of {asked:.3g} h0 would take about {needed:.1g} steps, more than "
        f"{settings.most_steps}, and a shallower start would not do: from {last.depth:.3g} to "
        f"{end.depth:.3g} h0 the force still changes by {changes['force']:.2g} % and the work by "
        f"{changes['work']:.2g} %, and {100 * end.left:.2g} % of the creep is left at the "
        f"pull-off; start at {end.depth:.2g} h0, say, or retract more slowly"
    )


def _effects(last: _End | None, end: _End, modulus_ratio: float) -> dict[str, float]:
    """Return by how much force and work may change from a depth on, relative."""
    if modulus_ratio == 1:
        return dict.fromkeys(_SHARES, 0.0)
    if last is None:
        return dict.fromkeys(_SHARES, 1.0)  # nothing is known
    effects, lost = {}, last.left - end.left
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
