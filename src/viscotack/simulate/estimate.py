"""Error estimate of a simulation, from a second run with coarser settings.

Every error is of second order. A run with errors four times as large differs from the main run by
three times the error of the main run. Errors may cancel in the difference, and no error is much
smaller than the accuracy of the settings. The estimate therefore has a safety factor and a floor.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from math import hypot

import numpy as np

from viscotack.clock import TimeUp
from viscotack.result import Outcome, Result
from viscotack.result.cycles import Loop, loop_of, lost_in, time_held
from viscotack.result.observables import PullOff, equal_peak, peaks, pull_off, work_to
from viscotack.result.opening import between_steps, lost_beside, reach_of_fold
from viscotack.result.parts import move_numbers, moves_of, spans, waits
from viscotack.simulate.preload import Beginning

# Ratio of the errors of the coarser run to those of the main run.
COARSER = 4.0
# Safety factors on the difference of the two runs over COARSER - 1 ...
_MARGIN = {"force": 3.0, "work": 3.5, "time": 3.4, "depth": 3.3}
# ... and smallest errors as fractions of the accuracy, because errors may cancel in the difference.
# They are relative to the value itself; for the depth, to the travel in tension.
_FLOOR = {"force": 0.2, "work": 0.4, "time": 1.0, "depth": 0.4}
# An error of the force moves its minimum, and what the drive does beside it is lost or won. Error
# of the force, in units of the accuracy, assumed where it changes over the depths of the contact.
_MOVED = {"work": 0.85, "depth": 0.5}
# Additional factor for elastic solids: only the nodes hold the edge, and the error of its position
# on the nodes does not decrease with second order.
_ELASTIC = 1.6
# Springs side by side snap off node by node: their errors are of first order in the distance of the
# nodes, which is sqrt(2) times as large in the companion (tests/ladder/test_bodies.py).
_SPRINGS = 3.0
# Relative error 1: the value is unknown.
_ALL = 1.0


def estimated(
    result: Result,
    companion: Callable[[], Result],
    beginning: Beginning | None,
    travel: float,
    accuracy: float,
) -> Result:
    """Return the result with its errors by name from a coarser companion, none without one.

    Those of force, work, hysteresis and time are relative, that of the depth of the pull-off is in
    h0. Where the force has several peaks, that of the companion which is nearest to the pull-off is
    compared with it. The depth of the start adds what it might change where the march began at
    another one.
    """
    try:
        coarse = companion() if beginning is None else beginning.light
    except (ValueError, TimeUp):  # no start or no time left: no estimate
        return result
    errors = dict[str, float]()
    held = [
        waits(moves_of(each)[int(move_numbers(each)[-1])], "force") for each in (result, coarse)
    ]
    # without an estimate if there is no pull-off or no time held, or only one has it
    with suppress(ValueError):
        if all(held):
            value, other = time_held(result), time_held(coarse)
            errors["time"] = from_difference("time", abs(value - other) / value, accuracy)
        elif not any(held):
            found = pull_off(result)
            alike = min(peaks(coarse), key=lambda peak: abs(peak.depth - found.depth))
            errors = _of_pull_off(result, found, coarse, alike, travel, accuracy)
    if beginning is not None and errors:
        start = beginning.start
        for name, more in (("force", start.force), ("work", start.work), ("depth", start.shift)):
            errors[name] += more
    if "force" in errors:
        _add_branch(result, errors)
    loops = hysteresis_errors(result, coarse, accuracy)
    if loops is not None:
        errors["hysteresis"] = float(np.nanmax(loops))
    return replace(result, error_estimate=errors or None, hysteresis_errors=loops)


def _of_pull_off(
    result: Result, found: PullOff, coarse: Result, alike: PullOff, travel: float, accuracy: float
) -> dict[str, float]:
    """Return the errors at a pull-off, from the matching peak of the coarser run."""
    work, other = work_to(result, found), work_to(coarse, alike)
    to_unit = result.problem.outputs.energy_factor(result.groups)
    energy = found.force * to_unit
    off = {"work": abs(work - other), "depth": abs(found.depth - alike.depth)}
    size = {"work": abs(work), "depth": abs(work) / energy}
    slope, more = accuracy / travel, _ELASTIC if result.groups.modulus_ratio == 1 else 1.0
    if result.groups.body.decay_length == 0:
        more *= _SPRINGS
    last = spans(result)[-1]
    beside = slope * lost_beside(result, last)
    shift = {"work": beside * to_unit, "depth": beside / found.force}
    share = abs(found.force - alike.force) / found.force
    force = more * from_difference("force", share, accuracy)
    # under a growing load both end by chance near the largest force, and may end at one place;
    # where the force bends within a step, both may have their minimum at the same wrong place
    fold = force**0.5 * reach_of_fold(result, last)
    place = hypot(fold, between_steps(result, last))
    chance = {"work": place * energy, "depth": place}
    error = {
        name: hypot(
            chance[name],
            more
            * hypot(
                _MARGIN[name] * off[name] / (COARSER - 1),
                _FLOOR[name] * accuracy * size[name],
                _MOVED[name] * shift[name],
            ),
        )
        for name in off
    }
    return {
        "force": force,
        # without a way to the minimum nothing is known of the work on it
        "work": min(error["work"] / abs(work), _ALL) if work else _ALL,
        "depth": error["depth"],
    }


def from_difference(name: str, share: float, accuracy: float) -> float:
    """Return the error estimated from a relative difference to the coarser run."""
    return max(_MARGIN[name] * share / (COARSER - 1), _FLOOR[name] * accuracy)


def _add_branch(result: Result, estimate: dict[str, float]) -> None:
    """Extend the errors of work and depth to a second peak if either may be the larger."""
    known = replace(result, error_estimate=estimate).posed(result.groups)
    if (other := equal_peak(known)) is None:
        return
    found = pull_off(result)
    work = work_to(result, found)
    away = abs(work_to(result, other) - work) / abs(work) if work else _ALL
    estimate["work"] = min(max(estimate["work"], away), _ALL)
    estimate["depth"] = max(estimate["depth"], abs(other.depth - found.depth))


# Shares in the error: of the difference to the companion over what its errors exceed those of the
# run by; of the energy that is missing after the cycle; of what moving between meshes took; and of
# the hysteresis times the accuracy. Each alone is small by chance now and then.
_DIFFERENCE, _MESHES, _OF_LOSS = 1.5, 0.5, 0.15


def hysteresis_errors(result: Result, coarse: Result, accuracy: float) -> tuple[float, ...] | None:
    """Return the relative error of the hysteresis of each cycle, nan where its loop is open.

    None where no loop closed, or the companion went another way.
    """
    cycles, others = spans(result), spans(coarse)
    loops = [loop_of(result, span) for span in cycles]
    if coarse.outcome is Outcome.STOPPED or len(cycles) != len(others):
        return None
    if all(loop is Loop.OPEN for loop in loops):
        return None
    errors, energy = [], result.energy
    assert energy is not None, "a simulation has its energies"
    spent = energy.elastic + energy.interface + energy.spring + energy.heat + energy.interface_heat
    missing = energy.drive - spent - energy.jumps - energy.transfer
    for span, other, loop in zip(cycles, others, loops, strict=True):
        lost, ends = lost_in(result, span, loop), [span.first, span.last]
        differs = abs(lost - lost_in(coarse, other, loop))
        error = _DIFFERENCE * differs / (COARSER - 1) + abs(float(np.diff(missing[ends])[0]))
        error += _MESHES * abs(float(np.diff(energy.transfer[ends])[0]))
        error += _OF_LOSS * accuracy * abs(lost)
        errors.append(error / max(abs(lost), np.finfo(float).tiny))
    return tuple(float(error) for error in errors)
