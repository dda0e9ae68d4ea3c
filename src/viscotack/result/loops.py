r"""Hysteresis of a cycle, and the state in which its loop closed.

The work at the indenter over a closed loop,

.. math:: H = \oint F \, d\delta = \Delta W - \Delta U_K,

is the work of the drive minus the change of the energy in the machine's spring. If a cycle
begins and ends with the surfaces apart, they still attract each other across a finite gap, and the
change of that energy is not dissipated,

.. math:: H = \Delta W - \Delta U_K - \Delta U_I.

Elastic energy left in the modes of the solid dissipates later and counts as lost.
"""

from enum import StrEnum

import numpy as np
import numpy.typing as npt

from . import Result
from .parts import Span, touches

# Tolerance for the return of depth and force, relative to their range, or the accuracy of the run
# if that is larger.
_RETURNED = 1e-3
# Tolerance for the return of the energy in the contact, relative to the hysteresis.
_SMALL = 0.02


class Loop(StrEnum):
    """State in which the loop of a cycle closed, see :func:`.cycles.cycles`."""

    APART = "apart"
    """The surfaces are apart at its beginning and at its end."""
    CLOSED = "closed"
    """Depth and force return; for a viscoelastic solid also the energy stored in the contact."""
    DEPTH = "closed in depth only"
    """The depth returns, but the force or the stored energy does not, or is unknown."""
    OPEN = "open"
    """None of these: the hysteresis is undefined."""


def loop_of(result: Result, span: Span) -> Loop:
    """Return the state in which the loop of a cycle closed."""
    ends = [span.first, span.last]
    if not (span.closes and span.opens):
        return Loop.OPEN
    if touches(result, span) and not np.isfinite(result.contact_radius[ends]).any():
        return Loop.APART
    within = max(_RETURNED, result.accuracy or 0.0)
    if not returned(result.depth[span.states], within):
        return Loop.OPEN
    closed = returned(result.force[span.states], within) and _energy_returned(result, span)
    return Loop.CLOSED if closed else Loop.DEPTH


def lost_in(result: Result, span: Span, loop: Loop) -> float:
    """Return the hysteresis of a cycle with a given loop state [unit of work]; nan if open."""
    if loop is Loop.OPEN:
        return float("nan")
    energy = result.energy
    if energy is None:  # a contact whose edge is a steady crack has no forces across a gap
        return work_at_indenter(result.depth[span.states], result.force[span.states])
    indenter = energy.drive - energy.spring
    work = float(indenter[span.last] - indenter[span.first])
    if loop is Loop.APART:
        return work - float(energy.interface[span.last] - energy.interface[span.first])
    return work


def work_at_indenter(depth: npt.NDArray, force: npt.NDArray) -> float:
    """Integrate the force over the depth along a history."""
    return float(np.sum((force[1:] + force[:-1]) / 2 * np.diff(depth)))


def returned(values: npt.NDArray, within: float = _RETURNED) -> bool:
    """Return whether a series ends at its first value, within a fraction of its range."""
    return bool(abs(values[-1] - values[0]) <= within * np.ptp(values))


def _energy_returned(result: Result, span: Span) -> bool:
    """Return whether the energy stored in the contact returns; always true for elastic solids."""
    if result.groups.modulus_ratio >= 1:
        return True
    energy = result.energy
    if energy is None:
        return False
    stored = energy.elastic + energy.interface
    left = float(stored[span.last] - stored[span.first])
    return abs(left) <= _SMALL * abs(lost_in(result, span, Loop.CLOSED))
