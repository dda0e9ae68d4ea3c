r"""Hysteresis: what a cycle has lost, and in which state its loop closed.

The work at the indenter over a closed loop,

.. math:: H = \oint F \, d\delta = \Delta W - \Delta U_K,

is the work of the drive without the change of energy in the spring of the machine. Where a cycle
begins and ends with the surfaces apart they still attract each other across a finite gap, and the
change of that energy is none that is lost,

.. math:: H = \Delta W - \Delta U_K - \Delta U_I.

Elastic energy that is left in the modes of the solid then becomes heat, and counts as lost.
"""

from enum import StrEnum

import numpy as np
import numpy.typing as npt

from . import Result
from .parts import Span, touches

# Depth and force return within this part of their range, or the accuracy of the run if that is
# larger.
_RETURNED = 1e-3
# The energy in the contact returns within this part of the hysteresis.
_SMALL = 0.02


class Loop(StrEnum):
    """In which state the loop of a cycle closed."""

    APART = "apart"
    """The surfaces were apart at its beginning and at its end."""
    CLOSED = "closed"
    """Depth and force returned; of a viscoelastic solid also the energy stored in the contact."""
    DEPTH = "closed in depth only"
    """The depth returned, and the force or the stored energy did not, or is not known."""
    OPEN = "open"
    """None of these: a hysteresis is not defined."""


def loop_of(result: Result, span: Span) -> Loop:
    """Return in which state the loop of a cycle closed."""
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
    """Return the hysteresis of a cycle that closed in a state [unit of work]; nan where open."""
    if loop is Loop.OPEN:
        return float("nan")
    energy = result.energy
    if energy is None:  # of a contact whose edge is a steady crack, without forces across a gap
        return work_at_indenter(result.depth[span.states], result.force[span.states])
    indenter = energy.drive - energy.spring
    work = float(indenter[span.last] - indenter[span.first])
    if loop is Loop.APART:
        return work - float(energy.interface[span.last] - energy.interface[span.first])
    return work


def work_at_indenter(depth: npt.NDArray, force: npt.NDArray) -> float:
    """Return the integral of the force over the depth along a history."""
    return float(np.sum((force[1:] + force[:-1]) / 2 * np.diff(depth)))


def returned(values: npt.NDArray, within: float = _RETURNED) -> bool:
    """Return whether a series ends where it begins, within a part of its range."""
    return bool(abs(values[-1] - values[0]) <= within * np.ptp(values))


def _energy_returned(result: Result, span: Span) -> bool:
    """Return whether the energy stored in the contact returned; that of an elastic one follows."""
    if result.groups.modulus_ratio >= 1:
        return True
    energy = result.energy
    if energy is None:
        return False
    stored = energy.elastic + energy.interface
    left = float(stored[span.last] - stored[span.first])
    return abs(left) <= _SMALL * abs(lost_in(result, span, Loop.CLOSED))
