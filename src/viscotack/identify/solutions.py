"""Separate interfaces that fit the same forces, and the test that distinguishes them."""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.stats import chi2

from viscotack.arrays import Array
from viscotack.theory.crack.contact.films import MOST_ZONE
from viscotack.units import readable

from .forward import Forward
from .growth import Opening
from .objective import Best, Interval, Objective, Parameter
from .search import LEAST_TABOR

_SAME = 0.05  # relative difference of equal solutions
_TRIALS = 32  # values of a parameter between the ends of its interval
# Tests that could distinguish two solutions: speeds up to this factor beyond those measured, their
# number, and preloads over the mean preload.
_BEYOND, _SPEEDS, _LOADS = 10.0, 13, (0.3, 1.0, 3.0)


def solutions(
    objective: Objective, best: Best, intervals: Mapping[str, Interval], level: float
) -> tuple[Best, ...]:
    """Return the most likely interface and, where intervals are split, the others inside them.

    Each is a local minimum of the misfit; the most likely is first.
    """
    limit = best.misfit + float(chi2.ppf(level, 1))
    found = [best]
    for parameter in objective.parameters:
        if intervals[parameter.name].split:
            for one in _others(objective, parameter, best, intervals[parameter.name], limit):
                if not any(_equal(one, other) for other in found):
                    found.append(one)
    return tuple(sorted(found, key=lambda one: one.misfit))


def _equal(one: Best, other: Best) -> bool:
    return bool(np.allclose(list(one.values.values()), list(other.values.values()), rtol=_SAME))


def _others(
    objective: Objective, parameter: Parameter, best: Best, ends: Interval, limit: float
) -> list[Best]:
    """Return the best fit of each likely range of a parameter that does not contain the best."""
    name, near = parameter.name, best
    ranges: list[list[Best]] = [[]]
    middle = parameter.inner(best.values[name])
    trials = np.linspace(parameter.inner(ends.low), parameter.inner(ends.high), _TRIALS)
    for x in np.sort(np.append(trials, middle)):
        near = best if x == middle else objective.best({name: parameter.outer(x)}, near)
        if near.misfit <= limit:
            ranges[-1].append(near)
        elif ranges[-1]:
            ranges.append([])
    likely = (min(one, key=lambda fit: fit.misfit) for one in ranges if one and best not in one)
    return [objective.best(near=one) for one in likely]


def solution_words(
    found: Sequence[Best],
    forward: Forward,
    opening: Opening | None,
    speed: Array,
    load: Array,
    theory: float,
) -> list[str]:
    """Describe the solutions and the test that distinguishes the two most likely."""
    if len(found) < 2:
        return []
    described = [
        f"{readable(one.values['work_of_adhesion'], 'J/m2', digits=3)} with "
        f"{readable(one.values['equilibrium_gap'], 'm', digits=3)} "
        f"(likelihood {np.exp((found[0].misfit - one.misfit) / 2):.2g})"
        for one in found
    ]
    return [
        f"{len(found)} interfaces fit these forces: {', '.join(described)}",
        _telling(found[0], found[1], forward, opening, speed, load, theory),
    ]


def _telling(
    one: Best,
    other: Best,
    forward: Forward,
    opening: Opening | None,
    speed: Array,
    load: Array,
    theory: float,
) -> str:
    """Name the speed and preload at which two solutions differ most."""
    v = np.geomspace(speed.min() / _BEYOND, speed.max() * _BEYOND, _SPEEDS)
    at, loads = np.meshgrid(v, float(load.mean()) * np.array(_LOADS))
    forces, holds = [], np.ones(at.shape, dtype=bool)
    for values in (one.values, other.values):
        growth = None if opening is None else opening.of(values)
        w, gap = values["work_of_adhesion"], values["equilibrium_gap"]
        pulled = forward.pulled(w, gap, at, loads, growth=growth)
        forces.append(pulled.force)
        holds &= (pulled.effective_tabor >= LEAST_TABOR) & (pulled.through <= MOST_ZONE)
    ratio = np.where(holds, np.abs(np.log(forces[0] / forces[1])), 0.0)
    i = np.unravel_index(int(np.argmax(ratio)), ratio.shape)
    if ratio[i] < 2 * theory:
        return (
            "no speed or preload within the range of the theory distinguishes them; a slow test "
            "with a camera, or a sphere of another radius, would"
        )
    pair = sorted((float(forces[0][i]), float(forces[1][i])))
    return (
        f"a test at {readable(at[i], 'm/s', digits=2)} under a preload of "
        f"{readable(loads[i], 'N', digits=2)} distinguishes them: "
        f"{readable(pair[0], 'N', digits=3)} or {readable(pair[1], 'N', digits=3)}"
    )
