"""Simulations with progress reports, and their data for the page."""

from collections.abc import Callable, Mapping
from time import perf_counter
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.model.geometry import FlatPunch
from viscotack.model.problem import Problem
from viscotack.model.problem.outputs import Kind
from viscotack.result import Outcome, Result, columns

from ..request import Told
from .json_data import drawn

Tell = Callable[[Told], None]
# Seconds between two tellings of a curve that grows.
_EVERY = 0.04
# Profiles that are kept of a run, and nodes of each.
_PROFILES, _NODES = 60, 160
_NO_UNITS = (1.0, 1.0, 1.0, 1.0)
# Of the largest contact, what is drawn of the surface.
_SEEN = 2.5


def run(problem: Any, tell: Tell, *, points: bool, profiles: bool, **options: Any) -> Result:
    """Simulate a problem, telling its curve as it grows.

    Tells ``share`` of the work, and the new ``points`` where they are wanted: time, depth, force,
    contact radius, in SI where the problem is. Other keywords are those of
    :func:`viscotack.solve`.
    """
    told = _Told(tell, _units_of(problem) if points else _NO_UNITS)
    options |= {"throw": False, "progress": told.progress}
    options |= {"watch": told.watch} if points else {}
    result = _solved(problem, options, profiles)
    told.flush()
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


class _Told:
    """Progress reports of a run, about twenty times a second."""

    def __init__(self, tell: Tell, units: tuple[float, float, float, float]) -> None:
        self._tell, self._units = tell, units
        self._points: list[list[float | None]] = []
        self._share, self._last = 0.0, 0.0

    def progress(self, share: float) -> None:
        self._share = max(self._share, share)
        self._now_and_then()

    def watch(self, *step: float) -> None:
        self._points.append(drawn([x * u for x, u in zip(step, self._units, strict=True)]))
        self._now_and_then()

    def flush(self) -> None:
        self._tell({"doing": "pulling", "share": self._share, "points": self._points})
        self._points = []

    def _now_and_then(self) -> None:
        now = perf_counter()
        if now - self._last > _EVERY:
            self._last = now
            self.flush()


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
    """Return pressure and gap over the radius at some steps, in SI where the problem is."""
    fields = result.fields
    if fields is None:
        return None
    _, depth, _, along = _units_of(result.problem)
    pressure = 1.0
    if isinstance(result.problem, Problem):
        law = result.problem.traction
        pressure = law.work_of_adhesion / law.equilibrium_gap
    seen = _SEEN * float(np.nanmax(result.contact_radius, initial=0.0))
    steps = np.unique(np.linspace(0, len(result.time) - 1, _PROFILES).astype(int))
    lowest = int(np.argmin(result.force))
    found = []
    for step in sorted({*steps.tolist(), lowest}):
        radius = fields["radius"][step]
        known = np.flatnonzero(np.isfinite(radius) & ((radius <= seen) | (seen == 0)))
        every = known[np.unique(np.linspace(0, len(known) - 1, _NODES).astype(int))]
        found.append(
            {
                "step": step,
                "radius": drawn(radius[every] * along),
                "gap": drawn(fields["gap"][step][every] * depth),
                "pressure": drawn(fields["pressure"][step][every] * pressure),
                "flank": _flank(result.problem, radius[every] * along),
            }
        )
    return found


def _flank(problem: Any, radius: Any) -> list[float | None] | None:
    """Return the height of an indenter above its tip, in SI; None without dimensions."""
    if not isinstance(problem, Problem):
        return None
    if isinstance(problem.geometry, FlatPunch):
        return drawn(np.zeros_like(radius))
    return drawn(problem.geometry.gap(radius))
