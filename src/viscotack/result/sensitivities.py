"""Derivatives of the pull-off by the inputs of a simulation, and where they are not meaningful."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.problem.inputs import Changed
from viscotack.result.observables import equal_peak, number_of, pull_off
from viscotack.result.opening import is_smooth
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
# Series that are moved, in the order of the derivatives of a march.
_SERIES = ("time", "depth", "force", "contact_radius")
# Steps after the pull-off that its interpolation may use.
_AFTER = 3


@dataclass(frozen=True, eq=False)
class Slopes:
    """Derivatives of the series of a result by the logarithms of its inputs.

    Attributes
    ----------
    changes : sequence of Changed
        The inputs.
    rows : ndarray, shape (n, 4, P)
        Derivatives of time, depth, force and contact radius at the first n steps.
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
    refused = {name: why for name in outputs if (why := _refused(result, slopes, name))}
    derivatives: dict[str, dict[str, float]] = {}
    elasticities: dict[str, dict[str, float]] = {}
    pairs = [_moved(result, slopes, i) for i in range(len(slopes.changes))]
    for name, unit in outputs.items():
        if name in refused:
            continue
        value = _value(name, unit, result)
        if value is None:
            refused[name] = number_of(name, result)[1] or "it is not defined"
            continue
        derivatives[name], elasticities[name] = {}, {}
        for change, (low, high) in zip(slopes.changes, pairs, strict=True):
            ends = _value(name, unit, low), _value(name, unit, high)
            if ends[0] is None or ends[1] is None:
                continue
            slope = (ends[1] - ends[0]) / (np.log1p(change.up) - np.log1p(change.down))
            derivatives[name][change.name] = float(slope / change.value)
            if value:
                elasticities[name][change.name] = float(slope / abs(value))
    return Sensitivities(
        inputs={change.name: change.value for change in slopes.changes},
        derivatives=derivatives,
        elasticities=elasticities,
        refused={**refused, **slopes.missing},
    )


def with_errors(found: Sensitivities, coarse: Sensitivities) -> Sensitivities:
    """Return the sensitivities with the errors of the elasticities, from those of a coarser run."""
    errors = {
        name: {x: abs(value - coarse.elasticities[name][x]) for x, value in each.items()}
        for name, each in found.elasticities.items()
        if coarse.elasticities.get(name, {}).keys() >= each.keys()
    }
    return replace(found, errors=errors)


def _moved(result: Result, slopes: Slopes, i: int) -> tuple[Result, Result]:
    """Return the result with a smaller and with a larger input."""
    change, many = slopes.changes[i], len(slopes.rows)
    ends = []
    for problem, by in ((change.low, change.down), (change.high, change.up)):
        moved = {}
        for k, name in enumerate(_SERIES):
            series = np.array(getattr(result, name))
            series[:many] += np.log1p(by) * slopes.rows[:, k, i]
            moved[name] = series
        moved["time"] = np.maximum.accumulate(moved["time"])
        ends.append(replace(result, problem=problem, sensitivities=None, **moved))
    return ends[0], ends[1]


def _value(name: str, unit: Any, result: Result) -> float | None:
    """Return an output, in SI where the problem is."""
    value, scales = number_of(name, result)[0], result.scales
    if value is None or scales is None or not unit.scale:
        return value
    return value * getattr(scales, unit.scale)


def _refused(result: Result, slopes: Slopes, name: str) -> str:
    """Return why an output has no meaningful derivative, empty if it has."""
    try:
        found = pull_off(result)
    except InputError as error:
        return str(error)
    span = spans(result)[-1]
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
    if name == "work_to_pull_off" and any(e.time >= result.time[span.turn] for e in jumps):
        return "the contact jumped on the way to the pull-off, and the jump moves with the inputs"
    return ""
