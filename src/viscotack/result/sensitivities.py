"""Derivatives of the pull-off by the inputs of a simulation, and where they are not meaningful."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from numpy.polynomial.polynomial import polyder, polyval

from viscotack.errors import InputError
from viscotack.problem.changed import Changed
from viscotack.result.observables import equal_peak, number_of, pull_off
from viscotack.result.opening import PullOff, around, curve_through, is_smooth, tension_parts
from viscotack.result.parts import spans
from viscotack.result.result import Result, Sensitivities

# What has derivatives, of the observables of a kind of problem, and what it is.
_OUTPUTS: dict[str, str] = {
    "pull_off_force": "force",
    "pull_off_stress": "force",
    "work_to_pull_off": "work",
    "depth_at_pull_off": "depth",
    "contact_radius_at_pull_off": "edge",
    "ligament_at_pull_off": "edge",
}
# Steps after the pull-off that its interpolation may use.
_AFTER = 3
# Steps on each side of the pull-off in local fits, and the largest degree of these.
_BESIDE, _DEGREE = 5, 4
# Largest change of an elasticity by the pull of the nodes, beside the largest elasticity, and
# the change that is always accepted.
_NOISE, _LITTLE = 0.3, 0.02
# Motion of an edge that counts as rest, relative to the fastest.
_STILL = 0.005


@dataclass(frozen=True, eq=False)
class Slopes:
    """Derivatives of the series of a result by the logarithms of its inputs.

    Attributes
    ----------
    changes : sequence of Changed
        The inputs.
    rows : ndarray, shape (n, 4, P + 1)
        Derivatives of time, depth, force and contact radius at the first n steps; the last ones by
        the length of the time steps of the last move, on which no output depends.
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
    """Return the derivatives of the outputs from those of the series."""
    kind = result.problem.outputs
    units = {name: kind.observables[name].unit for name in _OUTPUTS if name in kind.observables}
    refused = _refused(result, slopes, list(units))
    values = {name: _value(name, result) for name in units if name not in refused}
    refused |= {name: why for name, (_, why) in values.items() if why}
    given = [name for name in values if name not in refused]
    found = _moved(result, slopes) if given else {}
    derivatives: dict[str, dict[str, float]] = {name: {} for name in given}
    elasticities: dict[str, dict[str, float]] = {name: {} for name in given}
    errors: dict[str, dict[str, float]] = {name: {} for name in given}
    for name in given:
        value, scale = values[name][0], units[name].scale
        slope, error = found[_OUTPUTS[name]]
        for i, change in enumerate(slopes.changes):
            y, dy = value, float(slope[i])
            if scale:
                y, dy = _in_si(result, change, scale, value, dy)
            if np.isfinite(dy):
                derivatives[name][change.name] = dy / change.value
                if y:
                    elasticities[name][change.name] = dy / abs(y)
                    errors[name][change.name] = float(error[i]) / abs(value)
        largest = max(map(abs, elasticities[name].values()), default=0.0)
        if (worst := max(errors[name].values(), default=0.0)) > max(_NOISE * largest, _LITTLE):
            refused[name] = (
                "the nodes hold the edge: their pull on it changes an elasticity by "
                f"{worst:.2g}, beside {largest:.2g} of the largest; a smaller accuracy helps"
            )
            del elasticities[name], derivatives[name], errors[name]
    return Sensitivities(
        errors=errors,
        inputs={change.name: change.value for change in slopes.changes},
        derivatives=derivatives,
        elasticities=elasticities,
        refused={**refused, **slopes.missing},
    )


def _in_si(
    result: Result, change: Changed, name: str, value: float, slope: float
) -> tuple[float, float]:
    """Return a value in SI and its derivative; the scale changes with the input as well."""
    if result.scales is None:
        return value, slope
    low, here, high = (getattr(x.scales(), name) for x in (change.low, result.problem, change.high))
    return value * here, slope * here + value * (high - low) / change.step


def _moved(result: Result, slopes: Slopes) -> dict[str, tuple[npt.NDArray, npt.NDArray]]:
    """Return the derivatives of force, depth, edge and work at the pull-off, with their errors.

    The series are moved by the inputs. Their motion at fixed depth is fitted over several steps
    around the pull-off, because the depth there changes by the slope of this motion over the
    curvature of the force. An error is the part that the nodes have in the motion of a point along
    the curve (:func:`_level`).
    """
    at, span = pull_off(result), spans(result)[-1]
    steps = around(result, span, _BESIDE, len(slopes.rows))
    assert steps is not None
    x, place = -result.depth, -at.depth
    width = float(np.ptp(x[steps])) / 2
    u = (x[steps] - place) / width
    fit = np.linalg.pinv(np.vander(u, min(_DEGREE, len(u) - 2) + 1, increasing=True))
    force, edge = (fit @ y[steps] for y in (result.force, result.contact_radius))
    found = {}
    for rows in (_level(slopes), slopes.rows[:, :, :-1]):
        _, depth, moved_force, moved_edge = rows[steps].transpose(1, 0, 2)
        motion = fit @ (moved_force + polyval(u, polyder(force))[:, None] / width * depth)
        along = -width * motion[1] / (2 * force[2])
        radius = (fit @ (moved_edge + polyval(u, polyder(edge))[:, None] / width * depth))[0]
        work = _moved_work(result, slopes, rows, at) - at.force * -along
        each = -motion[0], -along, radius + edge[1] / width * along, work
        for name, value in zip(("force", "depth", "edge", "work"), each, strict=True):
            found.setdefault(name, []).append(value)
    return {name: (best, np.abs(best - raw)) for name, (best, raw) in found.items()}


def _moved_work(result: Result, slopes: Slopes, rows: npt.NDArray, at: PullOff) -> npt.NDArray:
    """Return the derivatives of the work to the fixed depth of the pull-off."""
    total = np.zeros(rows.shape[2])
    for steps, curve, begin, end in tension_parts(result, spans(result)[-1], at, until=-at.depth):
        steps = steps[steps < len(rows)]
        x = -result.depth[steps]
        motion = rows[steps, 2] + curve(x, 1)[:, None] * rows[steps, 1]
        total -= curve_through(x, motion).integrate(begin, end)
        if begin == x[0]:
            total -= float(curve(begin)) * slopes.rows[steps[0], 1, :-1]
        if end < -at.depth:
            total += float(curve(end)) * slopes.rows[steps[-1], 1, :-1]
    return total


def _level(slopes: Slopes) -> npt.NDArray:
    """Return the derivatives with each point moved along the curve to where the edge stays.

    Longer time steps move each point along the same curve, so any multiple of the derivatives by
    their length may be subtracted. With this multiple the edge stays at its place between the
    nodes, whose pull on the edge differs from place to place.
    """
    rows = slopes.rows
    edge, along = rows[:, 3, None, :-1], rows[:, 3, None, -1:]
    known = np.isfinite(edge) & np.isfinite(along) & (along != 0)
    least = _STILL * np.max(np.abs(along), initial=0.0, where=np.isfinite(along))
    with np.errstate(invalid="ignore"):
        factor = np.where(known, edge * along / (along**2 + least**2), 0.0)
    return rows[:, :, :-1] - np.where(factor == 0, 0.0, factor * rows[:, :, -1:])


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


def _value(name: str, result: Result) -> tuple[float, str]:
    """Return an output without dimensions, and why it is not defined, empty if it is."""
    kind, note = _OUTPUTS[name], None
    if kind == "work":
        value, note = number_of(name, result)
    else:
        at = pull_off(result)
        value = {"force": at.force, "depth": at.depth, "edge": at.contact_radius}[kind]
    if value is None or not np.isfinite(value):
        return np.nan, note or "it is not defined"
    return value, ""


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
