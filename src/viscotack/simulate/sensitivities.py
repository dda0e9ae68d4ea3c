"""Elasticities of the pull-off by the inputs of a problem: differences of whole simulations.

Each input x is multiplied by exp(-h) and by exp(h). The elasticity d ln y/d ln x of an output y is
the slope at x of the parabola through the three simulations, in logarithms where y is positive. At
the end of its range, like a Poisson ratio of 0.5, x is changed twice to the same side.

The same simulations with four times the numerical error give another parabola. The stated error of
an elasticity is the difference of their slopes at x, or half of the difference of their changes of
the slope between the points if that is larger, because two slopes may agree by chance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from math import exp

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.model.problem import Case
from viscotack.model.problem.inputs import changed, inputs_of
from viscotack.result import Result
from viscotack.result.observables import number_of, peaks, pull_off
from viscotack.result.result import Sensitivities
from viscotack.simulate.estimate import COARSER
from viscotack.simulate.settings import Settings

# Change of the logarithm of an input.
_STEP = 0.02
# Largest error of an elasticity, and largest difference between the slopes on both sides of the
# input, as a part of 1 + |elasticity|.
_UNSURE, _KINK = 0.1, 0.15
_OUTPUTS = (
    "pull_off_force",
    "pull_off_stress",
    "work_to_pull_off",
    "depth_at_pull_off",
    "contact_radius_at_pull_off",
    "ligament_at_pull_off",
)

# Two changes of the logarithm of an input, and the problems with them.
Changed = Mapping[float, Case]


def changed_inputs(problem: Case, names: Iterable[str] | None = None) -> dict[str, Changed]:
    """Return the problem with each input changed, by default with all that can change alone.

    An input is named by its path, ``material.branches.2.0``. In groups the reduced numbers, like a
    rubbery modulus of 1, are not inputs.

    Raises
    ------
    InputError
        If there is no input of a given name, or it cannot change alone.
    """
    entries = inputs_of(problem)
    able: dict[str, Changed] = {}
    for name, entry in entries.items():
        for way in ((-_STEP, _STEP), (-2 * _STEP, -_STEP), (_STEP, 2 * _STEP)):
            if entry.value and name not in able:
                try:
                    able[name] = {u: changed(problem, {name: entry.value * exp(u)}) for u in way}
                except InputError:  # out of range
                    continue
    if names is None:
        return able
    if missing := [name for name in names if name not in able]:
        raise InputError(
            f"{missing[0]!r} is not an input that can change; the inputs are {', '.join(able)}"
        )
    return {name: able[name] for name in names}


def sensitivities_of(
    problem: Case,
    changes: Mapping[str, Changed],
    settings: Settings,
    run: Callable[[Case, Settings], Result],
    done: Callable[[int], None],
) -> Sensitivities:
    """Return the elasticities of the outputs at the pull-off.

    `run` simulates a problem with settings up to its pull-off; `done` is called with the number of
    inputs that are finished.
    """
    entries, levels = inputs_of(problem), (settings, settings.coarser(COARSER))
    inputs = {name: float(entries[name].value or 0.0) for name in changes}
    outputs = [name for name in problem.outputs.observables if name in _OUTPUTS]
    try:
        middle = [_pull_off(run(problem, level)) for level in levels]
    except InputError as error:
        return Sensitivities(inputs, {}, {}, dict.fromkeys(outputs, str(error)))
    course = middle[0][1]
    elasticities, errors = ({name: dict[str, float]() for name in outputs} for _ in range(2))
    refused: dict[str, str] = {}
    for number, (name, points) in enumerate(changes.items(), 1):
        try:
            sides = [[_pull_off(run(each, level)) for each in points.values()] for level in levels]
        except InputError as error:
            refused[name] = str(error)
            continue
        finally:
            done(number)
        if any(other != course for _, other in sides[0]):
            refused[name] = (
                "a change by 2 % moves the pull-off to another peak of the force, or adds or "
                "removes a jump before it"
            )
            continue
        fine, coarse = (
            _parabola([0.0, *points], [here, *(values for values, _ in side)])
            for (here, _), side in zip(middle, sides, strict=True)
        )
        off = np.maximum(*np.abs(fine - coarse) * [[1.0], [0.5]])
        for output, slope, kink, error in zip(outputs, *fine, off, strict=True):
            why = ""
            if not np.isfinite(error):
                why = "one of the simulations does not define it"
            elif abs(kink) > _KINK * (1 + abs(slope)):
                why = f"the slopes for a smaller and a larger value differ by {abs(kink):.2g}"
            elif error > _UNSURE * (1 + abs(slope)):
                why = f"its numerical error is {error:.2g}; a smaller accuracy helps"
            if why:
                refused[f"{output} by {name}"] = why
                continue
            elasticities[output][name], errors[output][name] = float(slope), float(error)
    known = [{k: v for k, v in x.items() if v} for x in (elasticities, errors)]
    return Sensitivities(inputs, known[0], known[1], refused)


def _pull_off(result: Result) -> tuple[npt.NDArray, tuple[int, list[str]]]:
    """Return the outputs at the pull-off, in SI where the problem is, and what led to it.

    That is the number of its peak of the tension, and the jumps before it.
    """
    found, tensions = pull_off(result), [peak.force for peak in peaks(result)]
    jumps = [event.kind for event in result.events if event.time <= found.time]
    values = []
    for name, output in result.problem.outputs.observables.items():
        if name in _OUTPUTS:
            value, _ = number_of(name, result)
            scale = 1.0 if result.scales is None else getattr(result.scales, output.unit.scale)
            values.append(np.nan if value is None else value * scale)
    return np.array(values), (int(np.argmax(tensions)), jumps)


def _parabola(u: list[float], values: list[npt.NDArray]) -> npt.NDArray:
    """Return the elasticities at u = 0, and the change of the slope between the points.

    The first of three points is that at 0; u is the change of the logarithm of the input.
    """
    y = np.array(values)
    positive = np.all(y > 0, axis=0)
    y = np.where(positive, np.log(np.where(positive, y, 1.0)), y / np.abs(y[0]))
    bend, slope = np.linalg.solve(np.vander(u, 3), y)[:2]
    return np.array([slope, bend * np.ptp(u)])
