"""How large the errors of a simulation are: a coarser companion tells.

Every error is of second order, so that settings whose errors are four times as large differ by
three times the error. Errors may cancel in the difference, and none falls far below what the
settings are made for: hence a margin, and a floor.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from viscotack.bem.clock import TimeUp
from viscotack.bem.loop_error import hysteresis_errors
from viscotack.bem.preload import Beginning
from viscotack.result import Result
from viscotack.result.dead_load import time_held
from viscotack.result.observables import pull_off_force, work_lost, work_to_pull_off
from viscotack.result.parts import move_numbers, moves_of, waits

# The companion of a run is less accurate by this factor.
COARSER = 4.0
# The estimate is the difference to the companion over COARSER - 1, times these margins ...
_MARGIN = {"force": 3.4, "work": 5.0, "time": 3.4}
# ... but no less than these parts of the accuracy: errors may cancel in the difference. Of 52
# random problems with every law (`benchmarks/trust.py --finer`) the estimate then covers the error
# beside a run ten times as accurate in 96 % (force) and 94 % (work), and is in the median 4 and 5
# times as large. Of 11 dead loads (Tabor numbers 0.1 to 8, two solids) it covers that of the time.
_FLOOR = {"force": 0.4, "work": 0.7, "time": 1.0}
# An error of the force moves its minimum, and what the drive does beside it is lost or won: where
# the work is small, that is its error. Of 80 cases of Tabor numbers up to 1, elastic and
# viscoelastic, that start around the minimum, the estimate with this margin covers 79, and is in
# the median 2.1 times the error.
_MOVED = 2.5
# An error as large as the number: nothing is known of it.
_ALL = 1.0


def estimated(
    result: Result,
    companion: Callable[[], Result],
    beginning: Beginning | None,
    travel: float,
    accuracy: float,
) -> Result:
    """Return the result with its relative errors, from a coarser companion, none without one.

    The depth of the start adds what it might change where the march began at another one.
    """
    try:
        coarse = companion() if beginning is None else beginning.light
    except (ValueError, TimeUp):  # it has no start, no time: nothing is known
        return result
    errors = _of_pull_off(result, coarse, beginning, travel, accuracy) or {}
    loops = hysteresis_errors(result, coarse, accuracy, COARSER)
    if loops is not None:
        errors["hysteresis"] = float(np.nanmax(loops))
    return replace(result, error_estimate=errors or None, hysteresis_errors=loops)


def _of_pull_off(
    result: Result,
    coarse: Result,
    beginning: Beginning | None,
    travel: float,
    accuracy: float,
) -> dict[str, float] | None:
    """Return the relative errors of pull-off or time held by name, None where one has none."""
    try:
        values, others = _measures(result), _measures(coarse)
    except ValueError:
        return None
    if values.keys() != others.keys():
        return None
    estimate = {}
    for name, value in values.items():
        other = others[name]
        share = abs(value - other) / max(abs(value), np.finfo(float).tiny)
        estimate[name] = max(_MARGIN[name] * share / (COARSER - 1), _FLOOR[name] * accuracy)
    if work := values.get("work"):
        # without a way to the minimum nothing is known of the work on it
        lost = work_lost(result, estimate["force"] / travel)
        estimate["work"] = min(max(estimate["work"], _MOVED * lost / abs(work)), _ALL)
    elif "work" in values:
        estimate["work"] = _ALL
    if beginning is not None:
        for name in estimate:
            estimate[name] += getattr(beginning.start, name)
    return estimate


def _measures(result: Result) -> dict[str, float]:
    """Return what errors are stated of: the pull-off, or the time for which a load was borne."""
    last = int(move_numbers(result)[-1])
    if waits(moves_of(result)[last], "force"):
        return {"time": time_held(result)}
    return {"force": pull_off_force(result), "work": work_to_pull_off(result)}
