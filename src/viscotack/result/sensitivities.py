"""Derivatives of the pull-off by the inputs of a simulation, and where they are not meaningful."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
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
