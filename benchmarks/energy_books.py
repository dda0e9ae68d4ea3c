r"""Energy books of random histories, each term derived a second way; and errors of hysteresis.

``python benchmarks/energy_books.py [count] [seed]`` simulates random histories of spheres and
punches (springs, dead loads, starts pressed and apart, approaches, dwells, retractions, cycles;
five solids, three laws), and derives from what a result shows

- the work of the drive: integral of the force over the travel of the drive, depth + force/K;
- the energy of the spring: F^2/(2K);
- the interface energy: integral of the law over the gap profile;
- the elastic energy and the heat of each mode: from the recorded pressures alone. They are moved
  with the edge between two instants, each mode follows :math:`\tau \dot d = e - d` on nodes that
  stay, and its heat is the work :math:`\int p \cdot \dot d` of the pressure less what its spring
  stores; the simulation sums it from the dashpot.

It prints how far each is from the booked term and what the derived ones miss each other by (jumps
and transfer, which nothing but the balance tells, as they are booked), over the work: the largest
of the drive's work and of that at the indenter, of any sign.

``... --hysteresis`` compares stated errors of hysteresis with runs ten times as accurate.
Rows are added to ``--out FILE``; ``--read FILE`` only prints the table. Time: 3 s a history.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from random_problems import Luck, solid
from scipy.interpolate import CubicSpline, PchipInterpolator

from viscotack import (
    Apart,
    Approach,
    AtDepth,
    AtForce,
    Bonded,
    Dugdale,
    Dwell,
    Exponential,
    Frictionless,
    Groups,
    LennardJones,
    LoadTo,
    MoveTo,
    Result,
    Retract,
    cycles,
    solve,
)
from viscotack.bem.interface import resolved
from viscotack.bem.solver import contact_of
from viscotack.geometry import FlatPunch, Layer

Array = npt.NDArray[np.float64]

# Of the work: what terms derived in two ways may differ by.
LIMIT = 1e-3
# Points of a panel for the interface energy; parts of the zone in which an edge goes on between two
# profiles; the largest number of them.
_POINTS, _PART, _MOST = 4, 0.25, 400
# Nodes that stay are no nearer to each other than this part of the finest mesh.
_CLOSE = 0.7
_TIME_LIMIT = 240.0


def drawn(seed: int, number: int) -> Groups:
    """Return a random problem with a history; those of one seed are always the same."""
    luck = Luck(seed, number)
    material, traction = solid(luck), law(luck)
    if luck.happens(0.3):
        thickness = luck.decades(1, 30)
        travel = thickness / (0.64 * traction.strength) + 1
        start = luck.one({AtForce(luck.within(0.02, 0.6)): 1, Apart(luck.within(5, 30)): 1})
        stiffness = luck.decades(1e-3, 10) if luck.happens(0.7) else None
        return Groups(
            tabor=None,
            cohesion=luck.decades(0.02, 0.1),
            geometry=FlatPunch(luck.decades(3, 60)),
            body=Layer(
                thickness,
                Bonded(poisson_ratio=luck.within(0.3, 0.49))
                if luck.happens(0.3)
                else Frictionless(),
            ),
            material=material,
            traction=traction,
            stiffness=stiffness,
            **machine(luck, start, travel, 0.5, stiffness),
        )
    tabor = luck.decades(0.1, 6)
    travel = tabor + 1
    stiffness = luck.decades(1e-3, 1e2) if luck.happens(0.7) else None
    pressed = {AtForce(luck.within(-0.5, 4.0)): 1, AtDepth(travel * luck.within(0.2, 3)): 1}
    start = luck.one({**pressed, Apart(luck.within(5, 30)): 1})
    return Groups(
        tabor=tabor,
        material=material,
        traction=traction,
        stiffness=stiffness,
        **machine(luck, start, travel, 1.0, stiffness),
    )


def law(luck: Luck) -> Any:
    """Return a reduced law."""
    match luck.one({"lennard-jones": 0.5, "exponential": 0.3, "dugdale": 0.2}):
        case "exponential":
            return Exponential(1.0, 1.0, decay=float(np.exp(-1)) / luck.decades(0.7, 5))
        case "dugdale":
            return Dugdale(1.0, 1.0, rise=luck.decades(0.03, 0.3), fall=luck.decades(0.1, 1.0))
    return LennardJones(1.0, 1.0)


def machine(
    luck: Luck, start: Any, travel: float, load: float, stiffness: float | None
) -> dict[str, Any]:
    """Return a start, moves, and a retraction or none."""
    lost = 0.0 if stiffness is None else load / (stiffness * travel)

    def speed() -> float:
        return travel * (1 + lost) * luck.decades(0.03, 300)

    def deep() -> Any:
        return luck.one(
            {AtDepth(travel * luck.within(0.5, 4)): 1, AtForce(load * luck.within(0.5, 5)): 1}
        )

    held = [Approach(speed(), deep())]
    if luck.happens(0.5):
        held += [Dwell(luck.decades(0.03, 30), luck.one({"drive": 1, "depth": 1, "force": 1}))]
    more = luck.one({"none": 2, "load": 1, "move": 1, "back": 2})
    if more == "load":
        held += [LoadTo(load * luck.within(0.0, 5), luck.decades(0.03, 30))]
    elif more == "move" and stiffness is None:
        held += [MoveTo(travel * luck.within(0.2, 3), luck.decades(0.03, 30))]
    elif more == "back":
        held += [Retract(speed(), AtDepth(travel * luck.within(-0.3, 0.3))), *held]
    return {"start": start, "moves": tuple(held), "rate": speed() if luck.happens(0.7) else None}


# --- the second derivation ----------------------------------------------------------------------


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
    """Return the interface energy: the law's, over the gap and on the flank.

    Of a smooth law by straight lines from node to node, as the simulation has the pressures; of one
    with kinks by quadrature between them.
    """
    groups, (x, gap, _) = result.groups, _profile(result, i)
    law = groups.traction
    if groups.in_plane_strain and resolved(law):
        return float(law.energy(gap) @ _areas(x, True)) / (
            2 * groups.geometry.half_width * law.strength
        )
    if resolved(law):
        inner = float(law.energy(gap) @ _areas(x, False)) / (2 * np.pi)
        return 4 / 3 * (groups.tabor * inner + float(law.energy_beyond(gap[-1])))
    at, weight = np.polynomial.legendre.leggauss(_POINTS)
    h = np.diff(x)
    points = x[:-1, None] + h[:, None] * (at + 1) / 2
    energy = groups.traction.energy(CubicSpline(x, gap)(points)) * (weight * h[:, None] / 2)
    if groups.in_plane_strain:
        return float(np.sum(energy)) / (groups.geometry.half_width * groups.traction.strength)
    flank = float(groups.traction.energy_beyond(gap[-1]))
    return 4 / 3 * (groups.tabor * float(np.sum(points * energy)) + flank)


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
    # a law with kinks leaves pressures through which no smooth curve goes
    curve = CubicSpline if resolved(groups.traction) else PchipInterpolator

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
    e, p = CubicSpline(*before[:2])(grid), curve(before[0], before[2])(grid)
    d, z = np.tile(e, (tau.size, 1)), np.tile(p, (tau.size, 1))
    elastic = [unit * (instantaneous * before[3] + _slow(weights, d, z, area))]
    heat = [np.zeros(tau.size)]
    for i in range(1, result.time.size):
        now, total = relaxed(i), heat[-1].copy()
        went = edges[i] - edges[i - 1]
        parts = int(np.clip(np.ceil(abs(went) / (_PART * zone)), 1, _MOST)) if went == went else 1
        dt = (result.time[i] - result.time[i - 1]) / parts
        for part in range(1, parts + 1):
            e1, p1 = _between(before[:3], now[:3], part / parts, edges[i - 1], went, grid, curve)
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
    drawn_through: Any,
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
    p = (1 - share) * drawn_through(*before[::2])(back) + share * drawn_through(*now[::2])(ahead)
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
    at_contact = float(np.ptp(held)) / work
    return found | {
        "at_indenter": at_contact,
        "residual": float(result.energy_residual or 0.0),
        "steps": result.time.size,
    }


def loops(groups: Groups, accuracy: float) -> list[dict[str, Any]]:
    """Return stated and true errors of the hysteresis of each cycle."""
    found = cycles(solve(groups, accuracy=accuracy, time_limit=_TIME_LIMIT))
    true = cycles(
        solve(groups, accuracy=accuracy / 10, estimate_error=False, time_limit=_TIME_LIMIT)
    )
    return [
        {
            "loop": str(one.loop),
            "hysteresis": one.hysteresis,
            "stated": one.hysteresis_error * abs(one.hysteresis),
            "true": abs(one.hysteresis - other.hysteresis),
        }
        for one, other in zip(found, true, strict=True)
        if np.isfinite(one.hysteresis) and one.loop is other.loop
    ]


def cyclic(seed: int, number: int) -> Groups:
    """Return a random problem of which a cycle closes."""
    luck = Luck(seed, number, 1)
    groups = drawn(seed, number)
    punch = groups.in_plane_strain
    travel = 1 + (
        groups.body.thickness / (0.64 * groups.traction.strength) if punch else groups.tabor
    )
    lost = 0.0 if groups.stiffness is None else 1 / (groups.stiffness * travel)

    def speed() -> float:
        return travel * (1 + lost) * luck.decades(0.03, 300)

    apart = luck.happens(0.5)
    gap, low = luck.within(5, 30), travel * luck.within(0.3, 1.5)
    back = AtDepth(-gap - 5 * travel * groups.modulus_ratio**-0.5) if apart else AtDepth(low)
    tap = (
        Approach(speed(), AtDepth(low + travel * luck.within(0.5, 2))),
        *((Dwell(luck.decades(0.03, 30), "depth"),) if luck.happens(0.3) else ()),
        Retract(speed(), back),
    )
    start = Apart(gap) if apart else AtDepth(low)
    changed = {"start": start, "moves": tap * luck.count(1, 2), "rate": None}
    return type(groups)(**(vars(groups) | changed))


def table(rows: list[dict[str, Any]]) -> None:
    """Print how the differences are distributed, and which are beyond the limit."""
    good = [row for row in rows if "drive" in row]
    if good:
        print(f"{len(good)} histories, {len(rows) - len(good)} without an answer; of the work:")
        print(f"{'':>10}{'half':>10}{'9 of 10':>10}{'99 %':>10}{'worst':>10}")
        for name in ("drive", "spring", "interface", "elastic", "heat", "mode", "missing"):
            values = np.array([row[name] for row in good])
            tail = "".join(f"{v:10.1e}" for v in np.quantile(values, [0.5, 0.9, 0.99, 1.0]))
            print(f"{name:>10}{tail}   {np.mean(values <= LIMIT):.1%} within {LIMIT:g}")
        alone = np.array([row["missing"] / row["at_indenter"] for row in good])
        tail = "".join(f"{v:10.1e}" for v in np.quantile(alone, [0.5, 0.9, 0.99, 1.0]))
        print(f"   missing{tail}   of the work at the indenter alone")
        bad = [row for row in good if row["missing"] > LIMIT or row["drive"] > LIMIT]
        for row in bad:
            print({k: v if isinstance(v, int) else float(f"{v:.2g}") for k, v in row.items()})
    if made := [loop for row in rows for loop in row.get("loops", [])]:
        known = [loop for loop in made if np.isfinite(loop["stated"])]
        print(f"{len(made) - len(known)} loops of a run whose coarser companion stopped")
        made = known
        stated, true = (np.array([loop[k] for loop in made]) for k in ("stated", "true"))
        ratio = stated / np.maximum(true, 1e-300)
        print(
            f"hysteresis of {len(made)} loops: covered {np.mean(ratio >= 1):.1%}, "
            f"median stated over true {np.median(ratio):.2g}"
        )
        for loop in sorted(made, key=lambda one: one["stated"] / max(one["true"], 1e-300))[:8]:
            print(loop)
    for row in rows:
        if "why" in row:
            print(row["number"], row["why"][:150])


def main() -> None:
    """Simulate, compare and print."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("count", type=int, nargs="?", default=20)
    options.add_argument("seed", type=int, nargs="?", default=1)
    options.add_argument("--first", type=int, default=0)
    options.add_argument("--accuracy", type=float, default=2e-3)
    options.add_argument("--hysteresis", action="store_true")
    options.add_argument("--out", type=Path)
    options.add_argument("--read", type=Path)
    asked = options.parse_args()
    if asked.read:
        table([json.loads(line) for line in asked.read.read_text().splitlines()])
        return
    rows = []
    for number in range(asked.first, asked.first + asked.count):
        row: dict[str, Any] = {"number": number}
        try:
            if asked.hysteresis:
                row["loops"] = loops(cyclic(asked.seed, number), asked.accuracy)
            else:
                row |= compared(drawn(asked.seed, number), asked.accuracy)
        except (ValueError, RuntimeError) as error:
            row["why"] = f"{type(error).__name__}: {error}"
        rows.append(row)
        if asked.out:
            with asked.out.open("a") as file:
                file.write(json.dumps(row) + "\n")
    table(rows)


if __name__ == "__main__":
    main()
