"""Simulations with progress reports, and their data for the page."""

from collections.abc import Callable, Mapping
from time import perf_counter
from typing import Any

import numpy as np

from viscotack.app.operations.parts.tables import drawn
from viscotack.errors import InputError
from viscotack.model.geometry import FlatPunch
from viscotack.model.problem import Problem
from viscotack.model.problem.outputs import Kind
from viscotack.result import Outcome, Result, columns

from ..request import Told

Tell = Callable[[Told], None]
# Seconds between two tellings of a curve that grows.
_EVERY = 0.04
# Profiles that are kept of a run, and nodes of each.
_PROFILES, _NODES = 60, 160
# Of the largest contact, what is drawn of the surface.
_SEEN = 2.5


def run(problem: Any, tell: Tell, *, profiles: bool, **options: Any) -> Result:
    """Simulate a problem, telling its curve as it grows.

    Tells ``share`` of the work, and the new ``points``: time, depth, force, contact radius, in SI
    where the problem is. Other keywords are those of :func:`viscotack.solve`.
    """
    units, points = _units_of(problem), list[list[float | None]]()
    share, last = 0.0, 0.0

    def flush() -> None:
        tell({"doing": "pulling", "share": share, "points": points.copy()})
        points.clear()

    def progress(now: float) -> None:
        nonlocal share, last
        share = max(share, now)
        if perf_counter() - last > _EVERY:
            last = perf_counter()
            flush()

    def watch(*step: float) -> None:
        points.append(drawn([x * u for x, u in zip(step, units, strict=True)]))
        progress(share)

    options |= {"throw": False, "progress": progress, "watch": watch}
    result = _solved(problem, options, profiles)
    flush()
    return result


def drawn_of(result: Result) -> dict[str, Any]:
    """Return the data of a result for the page: columns, energies, profiles."""
    return {
        "columns": {name: drawn(values) for name, values in columns(result).items()},
        "energy": _energy(result),
        "profiles": _profiles(result),
        "failed": result.outcome is Outcome.STOPPED,
    }


def _solved(problem: Any, options: Mapping[str, Any], profiles: bool) -> Result:
    """Return the result, with profiles where they are wanted and there are any."""
    from viscotack.simulate import solve

    if profiles:
        try:
            return solve(problem, fields=True, **options)
        except InputError as error:
            # a contact too sharp to be simulated is answered by a theory, which has no profiles
            if "profiles" not in str(error):
                raise
    return solve(problem, **options)


def _units_of(problem: Any) -> tuple[float, float, float, float]:
    """Return the factors for time, depth, force and contact radius in progress reports."""
    kind: Kind = problem.outputs
    groups, scales = problem.groups(), problem.scales()

    def factor(source: str) -> float:
        series = kind.of(source)
        # forces are positive in compression, for a punch as well
        sign = 1.0 if source == "force" else series.factor(groups)
        return sign * (1.0 if scales is None else getattr(scales, series.unit.scale))

    return factor("time"), factor("depth"), factor("force"), factor("contact_radius")


def _energy(result: Result) -> dict[str, Any] | None:
    """Return the energy balance as changes since the start, in SI if the problem is."""
    if result.energy is None:
        return None
    kind, scales, energy = result.problem.outputs, result.scales, result.energy
    factor = kind.energy_factor(result.groups)
    factor *= 1.0 if scales is None else getattr(scales, kind.energy.scale)
    losses = ("heat", "interface_heat", "jumps", "transfer")
    names = ("drive", "interface", "elastic", "spring", *losses)
    series = {name: np.asarray(getattr(energy, name)) for name in names}
    changes = {name: drawn((x - x[0]) * factor) for name, x in series.items()}
    return {
        "unit": kind.energy.text if scales is None else kind.energy.si,
        "series": {name: x for name, x in changes.items() if name == "drive" or any(x)},
    }


def _profiles(result: Result) -> list[dict[str, Any]] | None:
    """Return pressure and gap over the radius at some steps, of a problem in SI."""
    fields, problem = result.fields, result.problem
    if fields is None or not isinstance(problem, Problem):
        return None
    _, depth, _, along = _units_of(problem)
    law: Any = problem.traction
    shape: Any = problem.geometry
    pressure = law.work_of_adhesion / law.equilibrium_gap
    seen = _SEEN * float(np.nanmax(result.contact_radius, initial=0.0))
    steps = np.unique(np.linspace(0, len(result.time) - 1, _PROFILES).astype(int))
    lowest = int(np.argmin(result.force))
    found = []
    for step in sorted({*steps.tolist(), lowest}):
        radius = fields["radius"][step]
        known = np.flatnonzero(np.isfinite(radius) & ((radius <= seen) | (seen == 0)))
        every = known[np.unique(np.linspace(0, len(known) - 1, _NODES).astype(int))]
        flat, place = isinstance(shape, FlatPunch), radius[every] * along
        found.append(
            {
                "step": step,
                "radius": drawn(place),
                "gap": drawn(fields["gap"][step][every] * depth),
                "pressure": drawn(fields["pressure"][step][every] * pressure),
                "flank": drawn(np.zeros_like(place) if flat else shape.gap(place)),
            }
        )
    return found
