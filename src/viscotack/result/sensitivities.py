"""Derivatives of the pull-off by the inputs of a simulation, and where they are not meaningful."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.problem import Case
from viscotack.problem.inputs import Changed
from viscotack.problem.outputs import Unit
from viscotack.result.observables import equal_peak, number_of, pull_off, work_to
from viscotack.result.opening import edge_at, is_smooth
from viscotack.result.parts import spans
from viscotack.result.result import Result, Sensitivities

# What has derivatives, of the observables of a kind of problem.
_OUTPUTS = (
    "pull_off_force",
    "pull_off_stress",
    "work_to_pull_off",
    "depth_at_pull_off",
    "contact_radius_at_pull_off",
    "ligament_at_pull_off",
)
_EDGES = ("contact_radius_at_pull_off", "ligament_at_pull_off")
# Series that are moved, in the order of the derivatives of a march.
_SERIES = ("time", "depth", "force", "contact_radius")
# Steps after the pull-off that its interpolation may use.
_AFTER = 3
# Relative change of the unit of time, and the largest elasticity by it beside the largest by an
# input.
_SMALL, _NOISE = 1e-4, 0.05


@dataclass(frozen=True, eq=False)
class Slopes:
    """Derivatives of the series of a result by the logarithms of its inputs.

    Attributes
    ----------
    changes : sequence of Changed
        The inputs.
    rows : ndarray, shape (n, 4, P + 1)
        Derivatives of time, depth, force and contact radius at the first n steps; the last ones by
        the unit of time, on which no output depends: they are errors of the method.
    reason : str
        Why there are none at later steps.
    missing : mapping
        Inputs without derivatives, and the reason.
    """

    changes: Sequence[Changed]
    rows: npt.NDArray
    reason: str
    missing: Mapping[str, str]


def sensitivities(result: Result, slopes: Slopes) -> Sensitivities:
    """Return the derivatives of the outputs from those of the series.

    The outputs are computed from the series moved by a little in the direction of each input, in
    the problem with that input: so they have the same definition, interpolation and units.
    """
    kind = result.problem.outputs
    outputs = {name: kind.observables[name].unit for name in _OUTPUTS if name in kind.observables}
    refused = _refused(result, slopes, list(outputs))
    given = [name for name in outputs if name not in refused]
    values = _values(given, outputs, result)
    refused |= {name: why for name in given if (why := _undefined(name, values, result))}
    given = [name for name in given if name not in refused]
    derivatives: dict[str, dict[str, float]] = {name: {} for name in given}
    elasticities: dict[str, dict[str, float]] = {name: {} for name in given}
    for i, change in enumerate(slopes.changes):
        low, high = (_values(given, outputs, end) for end in _moved(result, slopes, i))
        step = np.log1p(change.up) - np.log1p(change.down)
        for name in given:
            slope = (high[name] - low[name]) / step
            if np.isfinite(slope):
                derivatives[name][change.name] = float(slope / change.value)
                if values[name]:
                    elasticities[name][change.name] = float(slope / abs(values[name]))
    errors = _of_null(result, slopes, given, outputs, values)
    for name in given:
        largest = max(map(abs, elasticities[name].values()), default=0.0)
        if errors[name] > _NOISE * largest:
            refused[name] = (
                "the nodes hold the edge: by frozen nodes the output depends on the unit of time, "
                f"by an elasticity of {errors[name]:.2g} beside {largest:.2g} of the largest input"
            )
            del elasticities[name], derivatives[name]
    return Sensitivities(
        errors={name: dict.fromkeys(each, errors[name]) for name, each in elasticities.items()},
        inputs={change.name: change.value for change in slopes.changes},
        derivatives=derivatives,
        elasticities=elasticities,
        refused={**refused, **slopes.missing},
    )


def _of_null(
    result: Result,
    slopes: Slopes,
    names: Iterable[str],
    units: Mapping[str, Unit],
    values: Mapping[str, float],
) -> dict[str, float]:
    """Return the size of the elasticities by the unit of time, which should be zero."""
    low, high = (
        _values(names, units, _along(result, slopes, -1, result.problem, by))
        for by in (-_SMALL, _SMALL)
    )
    return {x: abs(high[x] - low[x]) / (2 * _SMALL * abs(values[x])) for x in names}


def with_errors(found: Sensitivities, coarse: Sensitivities) -> Sensitivities:
    """Return the sensitivities with errors that count the difference to a coarser run."""
    errors = {
        name: {
            x: max(own, abs(found.elasticities[name][x] - coarse.elasticities[name][x]))
            if x in coarse.elasticities.get(name, {})
            else own
            for x, own in each.items()
        }
        for name, each in found.errors.items()
    }
    return replace(found, errors=errors)


def _moved(result: Result, slopes: Slopes, i: int) -> tuple[Result, Result]:
    """Return the result with a smaller and with a larger input."""
    change = slopes.changes[i]
    low = _along(result, slopes, i, change.low, float(np.log1p(change.down)))
    return low, _along(result, slopes, i, change.high, float(np.log1p(change.up)))


def _along(result: Result, slopes: Slopes, i: int, problem: Case, by: float) -> Result:
    """Return the result of a problem, with its series moved in one direction."""
    moved: dict[str, Any] = {}
    for k, name in enumerate(_SERIES):
        series = np.array(getattr(result, name))
        series[: len(slopes.rows)] += by * slopes.rows[:, k, i]
        moved[name] = series
    moved["time"] = np.maximum.accumulate(moved["time"])
    return replace(result, problem=problem, sensitivities=None, **moved)


def _values(names: Iterable[str], units: Mapping[str, Unit], result: Result) -> dict[str, float]:
    """Return the outputs at the pull-off, in SI where the problem is; nan without one."""
    scales, found = result.scales, {}
    at = pull_off(result)
    for name in names:
        if name in _EDGES:
            value = edge_at(result, spans(result)[-1], at)
        elif name == "work_to_pull_off":
            value = work_to(result, at)
        else:
            value = at.depth if name == "depth_at_pull_off" else at.force
        scale = units[name].scale
        found[name] = value * (getattr(scales, scale) if scales is not None and scale else 1.0)
    return found


def _undefined(name: str, values: Mapping[str, float], result: Result) -> str:
    """Return why an output is not defined, empty if it is."""
    value, note = number_of(name, result)
    if value is None or not np.isfinite(values[name]):
        return note or "it is not defined"
    return ""


def _refused(result: Result, slopes: Slopes, names: Iterable[str]) -> dict[str, str]:
    """Return the outputs without meaningful derivatives, and why."""
    try:
        why = _never(result, slopes)
    except InputError as error:
        why = str(error)
    if why:
        return dict.fromkeys(names, why)
    found, turn = pull_off(result), spans(result)[-1].turn
    jumps = [e for e in result.events if e.kind.startswith("jump")]
    if any(result.time[turn] <= e.time <= found.time for e in jumps):
        why = "the contact jumped on the way to the pull-off, and the jump moves with the inputs"
        return {"work_to_pull_off": why}
    return {}


def _never(result: Result, slopes: Slopes) -> str:
    """Return why no output has a meaningful derivative, empty if some have."""
    found, span = pull_off(result), spans(result)[-1]
    lowest = int(np.searchsorted(result.time, found.time))
    if len(slopes.rows) < min(lowest + _AFTER, len(result.time)):
        return f"there are no derivatives at the pull-off: {slopes.reason}"
    if not is_smooth(result, span):
        return (
            "the pull-off is not a smooth maximum of the tension: the force was set by the "
            "machine, or the tension is largest at the first or last step or at a jump"
        )
    if (other := equal_peak(result)) is not None:
        return (
            f"the tension has two peaks of equal height, at depths of {found.depth:.4g} and "
            f"{other.depth:.4g} h0, and a small change decides which is the pull-off"
        )
    jumps = [e for e in result.events if e.kind.startswith("jump") and e.time <= found.time]
    if jumps and result.groups.modulus_ratio < 1:
        return (
            f"the contact jumped before the pull-off, at a depth of {jumps[0].depth:.4g} h0; the "
            "jump moves with the inputs, and the solid remembers it"
        )
    return ""
