r"""Energies of a simulation, each derived a second way from what the result shows.

- The work of the drive: integral of the force over the travel of the drive, depth + force/K.
- The energy of the spring: F^2/(2K).
- The interface energy: integral of the law over the gap profile.
- The elastic energy and the heat of each mode: from the recorded pressures alone. They are moved
  with the edge between two instants, each mode follows :math:`\tau \dot d = e - d` on nodes that
  stay, and its heat is the work :math:`\int p \cdot \dot d` of the pressure less what its spring
  stores; the simulation sums it from the dashpot.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack import Groups, Result, solve
from viscotack.simulate.solver import contact_of

Array = npt.NDArray[np.float64]

# Parts of the zone in which an edge goes on between two profiles; the largest number of them.
_PART, _MOST = 0.25, 400
# Nodes that stay are no nearer to each other than this part of the finest mesh.
_CLOSE = 0.7
_TIME_LIMIT = 240.0


@dataclass(frozen=True, eq=False)
class Derived:
    """The energies of a run at every step, and the heat of each mode in all, derived again."""

    drive: Array
    spring: Array
    interface: Array
    elastic: Array
    heat: Array
    mode_heat: Array


def derived(result: Result) -> Derived:
    """Return the energies of a result from its series, its profiles and the law."""
    groups, force = result.groups, result.force
    soft = 0.0 if groups.stiffness is None else 1 / groups.stiffness
    drive = result.depth + soft * force
    elastic, heat, mode_heat = _of_solid(result)
    return Derived(
        drive=np.cumsum([0.0, *((force[1:] + force[:-1]) / 2 * np.diff(drive))]),
        spring=soft * force**2 / 2,
        interface=np.array([_interface(result, i) for i in range(force.size)]),
        elastic=elastic,
        heat=heat,
        mode_heat=mode_heat,
    )


def _profile(result: Result, i: int) -> tuple[Array, Array, Array]:
    """Return places [unit of the mesh], gap and pressure at a step."""
    fields, contact = result.fields, contact_of(result.groups)
    assert fields is not None
    known = np.isfinite(fields["gap"][i])
    place = fields["radius"][i][known] * contact.edge_unit
    return place, fields["gap"][i][known], fields["pressure"][i][known]


def _interface(result: Result, i: int) -> float:
    """Return the interface energy: the law's, by straight lines over the gap, and on the flank."""
    groups, (x, gap, _) = result.groups, _profile(result, i)
    law = groups.traction
    if groups.in_plane_strain:
        return float(law.energy(gap) @ _areas(x, True)) / (
            2 * groups.geometry.half_width * law.strength
        )
    inner = float(law.energy(gap) @ _areas(x, False)) / (2 * np.pi)
    return 4 / 3 * (groups.tabor * inner + float(law.energy_beyond(gap[-1])))


def _of_solid(result: Result) -> tuple[Array, Array, Array]:
    """Return elastic energy and heat at every step, and the heat of each mode, from pressures."""
    contact, groups, energy = contact_of(result.groups), result.groups, result.energy
    assert energy is not None
    tau = energy.mode_time
    weights, instantaneous = energy.mode_weight, 1 - float(np.sum(energy.mode_weight))
    steps = [_profile(result, i) for i in range(result.time.size)]
    places = np.unique(np.concatenate([x for x, _, _ in steps]))
    finest = min(float(np.min(np.diff(x))) for x, _, _ in steps)
    grid = _apart_by(places, _CLOSE * finest)
    plane = groups.in_plane_strain
    area = _areas(grid, plane)
    surface, known = None, np.empty(0)
    edges = result.contact_radius * contact.edge_unit
    zone = contact.zone

    def relaxed(i: int) -> tuple[Array, Array, Array, float]:
        """Return places, displacement of the relaxed solid, pressure, and half their product."""
        nonlocal surface, known
        x, _, p = steps[i]
        if not np.array_equal(known, x):
            surface, known = contact.surface(x), x
        assert surface is not None
        nodal = p * surface.area
        e = np.linalg.solve(surface.stiffness, nodal)
        return x, e, p, float(e @ nodal) / 2

    unit = contact.surface(steps[0][0]).unit
    before = relaxed(0)
    e, p = CubicSpline(*before[:2])(grid), CubicSpline(*before[:3:2])(grid)
    d, z = np.tile(e, (tau.size, 1)), np.tile(p, (tau.size, 1))
    elastic = [unit * (instantaneous * before[3] + _slow(weights, d, z, area))]
    heat = [np.zeros(tau.size)]
    for i in range(1, result.time.size):
        now, total = relaxed(i), heat[-1].copy()
        went = edges[i] - edges[i - 1]
        parts = int(np.clip(np.ceil(abs(went) / (_PART * zone)), 1, _MOST)) if went == went else 1
        dt = (result.time[i] - result.time[i - 1]) / parts
        for part in range(1, parts + 1):
            e1, p1 = _between(before[:3], now[:3], part / parts, edges[i - 1], went, grid)
            if tau.size:
                work, d, z = _step(dt, tau, weights, (e, p, d, z), (e1, p1), area)
                total += unit * work
            e, p = e1, p1
        heat.append(total)
        elastic.append(unit * (instantaneous * now[3] + _slow(weights, d, z, area)))
        before = now
    made = np.array(heat)
    return np.array(elastic), made.sum(axis=1), made[-1]


def _slow(weights: Array, d: Array, z: Array, area: Array) -> float:
    """Return the energy in the springs of the modes [dg beta^2]."""
    return 0.5 * float(weights @ ((d * z) @ area))


def _apart_by(places: Array, least: float) -> Array:
    """Return places of which none is nearer to the one before than this; the ends are kept."""
    kept = [places[0]]
    for place in places[1:-1]:
        if place - kept[-1] >= least and places[-1] - place >= least:
            kept.append(place)
    return np.array([*kept, places[-1]])


def _areas(grid: Array, plane: bool) -> Array:
    """Return the area of each node of a grid: of straight lines between them."""
    if plane:
        h = np.diff(grid)  # on either side of the middle
        return np.append(h, 0) + np.append(0, h)
    left, right = grid[:-1], grid[1:]
    h = right - left
    inner, outer = h * (2 * left + right) / 6, h * (left + 2 * right) / 6
    return 2 * np.pi * (np.append(inner, 0) + np.append(0, outer))


def _between(
    before: tuple[Array, Array, Array],
    now: tuple[Array, Array, Array],
    share: float,
    edge: float,
    went: float,
    grid: Array,
) -> tuple[Array, Array]:
    """Return displacement and pressure between two steps, moved along with the edge."""
    if not went == went:
        went = 0.0
    reach = max(np.max(before[0]), 1e-9)
    fade = np.clip(1 - np.maximum(grid - edge, 0) / reach, 0, 1) * np.minimum(
        grid / max(min(edge, edge + went), 1e-9), 1.0
    )
    fade = fade if edge == edge else np.zeros_like(grid)
    back = np.clip(grid - share * went * fade, 0, before[0][-1])
    ahead = np.clip(grid + (1 - share) * went * fade, 0, now[0][-1])
    e = (1 - share) * CubicSpline(*before[:2])(back) + share * CubicSpline(*now[:2])(ahead)
    p = (1 - share) * CubicSpline(*before[::2])(back) + share * CubicSpline(*now[::2])(ahead)
    return e, p


def _step(
    dt: float,
    tau: Array,
    weights: Array,
    start: tuple[Array, Array, Array, Array],
    end: tuple[Array, Array],
    area: Array,
) -> tuple[Array, Array, Array]:
    """Return heat of each mode over a step, and its displacements and pressures after it."""
    (e, p, d, z), (e1, p1) = start, end
    x = np.maximum(dt / tau, 1e-300)[:, None]
    decay, phi = np.exp(-x), -np.expm1(-x) / x

    def after(was: Array, first: Array, last: Array) -> Array:
        return decay * was + (phi - decay) * first + (1 - phi) * last

    d1, z1 = after(d, e, e1), after(z, p, p1)
    # the integral of p dd: by parts, with that of d from the equation of the mode
    mean = (e + e1) / 2 - (d1 - d) / x
    work = (p1 * (d1 - d) + (p1 - p) * (d - mean)) @ area
    stored = 0.5 * ((d1 * z1) @ area - (d * z) @ area)
    return weights * (work - stored), d1, z1


# --- how far they are from what is booked -------------------------------------------------------


def compared(groups: Groups, accuracy: float) -> dict[str, float]:
    """Return by what derived terms differ from booked ones, over the work; and what is missing."""
    result = solve(
        groups, accuracy=accuracy, estimate_error=False, fields=True, time_limit=_TIME_LIMIT
    )
    booked, again = result.energy, derived(result)
    assert booked is not None
    held = booked.drive - booked.spring
    work = max(float(np.max(np.abs(booked.drive))), float(np.ptp(held)))
    found = {}
    for name in ("drive", "spring", "interface", "elastic", "heat"):
        one, other = getattr(booked, name), getattr(again, name)
        found[name] = float(np.max(np.abs((one - one[0]) - (other - other[0]))))
    modes = np.abs(booked.mode_heat - again.mode_heat)
    found["mode"] = float(np.max(modes, initial=0.0))
    stored = again.spring + again.interface + again.elastic
    lost = again.heat + booked.jumps + booked.transfer + booked.interface_heat
    found["missing"] = float(np.max(np.abs(again.drive - (stored - stored[0]) - lost)))
    found = {name: value / work for name, value in found.items()}
    return found | {"at_indenter": float(np.ptp(held)) / work}
