"""Relations between answers: of materials, laws, simulations and the steady-crack contact.

Each relation is a function of a case and of further random numbers. It builds a partner whose
answer follows from that of the case, and returns what is wrong, in words; an empty list where it
holds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from viscotack import (
    Apart,
    Approach,
    AtDepth,
    AtForce,
    AtRadius,
    Dwell,
    Elastic,
    Exponential,
    Groups,
    InputError,
    LennardJones,
    MoveTo,
    PowerLawProfile,
    Prony,
    Result,
    Retract,
    Sphere,
    StandardSolid,
    Tabulated,
    cycles,
)
from viscotack.materials import FractionalZener
from viscotack.materials.conversion import slowed
from viscotack.result.loops import Loop
from viscotack.result.parts import Span, spans
from viscotack.traction import has_rest
from viscotack.traction.resting import scaled

from . import cases
from .answers import (
    ACCURACY,
    Answer,
    by_crack,
    by_simulation,
    compared,
    differences,
    of_result,
    solved,
)
from .cases import Case, Luck

Found = list[str]
Check = Callable[[Any, Luck], Found]
_SPHERE_TABOR = 40.0  # largest Tabor number of relations that need the march


@dataclass(frozen=True)
class Relation:
    """What must hold of cases of a kind.

    Attributes
    ----------
    name : str
        As the command line has it.
    draw : callable
        Returns a case.
    check : callable
        Returns what is wrong with a case, in words.
    share : float
        How often it is drawn, beside the others.
    """

    name: str
    draw: Callable[[Luck], Any]
    check: Check
    share: float = 1.0


# --- materials -------------------------------------------------------------------------------


def passive(material: Any, luck: Luck) -> Found:
    """Check moduli that fall, compliances that rise, E C <= 1, losses >= 0, and modes."""
    unit = material.time_unit
    time = unit * np.geomspace(1e-8, 1e8, 161) * luck.decades(0.5, 2)
    E, C = material.relaxation(time), material.creep(time)
    modulus, compliance = material.complex_modulus(1 / time), material.complex_compliance(1 / time)
    E0, glassy = material.rubbery_modulus, material.glassy_modulus
    tight = 1e-9
    steps = np.diff(time)
    noise = 8 * np.finfo(float).eps * glassy / np.minimum(steps[1:], steps[:-1])
    claims = {
        "relaxation falls": np.all(np.diff(E) <= tight * E[1:]),
        "relaxation is convex": np.all(
            np.diff(np.diff(E) / steps) >= -noise - tight * glassy / unit
        ),
        "creep rises": np.all(np.diff(C) >= -tight * C[1:]),
        "E C <= 1": np.all(E * C <= 1 + tight),
        "relaxation within the moduli": np.all(
            (E >= E0 * (1 - tight)) & (E <= glassy * (1 + tight))
        ),
        "storage modulus rises": np.all(np.diff(modulus.real[::-1]) >= -tight * modulus.real[:-1]),
        "loss modulus not negative": np.all(modulus.imag >= -tight * np.abs(modulus)),
        "compliance is the inverse": np.allclose(modulus * compliance, 1, rtol=1e-8),
        "limits": np.allclose([E[-1] * C[-1], E[0] * C[0]], 1, atol=0.5),
    }
    tolerance = luck.decades(1e-6, 1e-2) * material.modulus_ratio
    first, last = 1e-3 * unit * luck.decades(1e-3, 1), 1e3 * unit
    modes = material.retardation_modes(shortest=first, longest=last, tolerance=tolerance)
    inside = np.geomspace(first, last, 400)
    missed = np.max(np.abs(modes.creep(inside) - E0 * material.creep(inside)))
    claims |= {
        "weights of modes not negative": min(modes.weights, default=0.0) >= 0,
        "modes sum to 1": abs(modes.instantaneous + sum(modes.weights) - 1) <= 1e-9,
        f"modes within their error {modes.error:.2g}, off by {missed:.2g}": (
            missed <= modes.error * 1.01 + 1e-12
        ),
        "error of modes within the tolerance": modes.error <= tolerance * (1 + 1e-9),
    }
    return [claim for claim, holds in claims.items() if not holds]


def prony(luck: Luck) -> Prony:
    """Return a Prony series with well separated arms."""
    while True:
        found = cases.material(luck)
        if isinstance(found, Prony):
            return found


def _same_solid(one: Any, other: Any, tolerance: float) -> Found:
    time = one.time_unit * np.geomspace(1e-6, 1e6, 121)
    found = []
    for name in ("relaxation", "creep", "complex_modulus", "complex_compliance"):
        at = 1 / time if "complex" in name else time
        a, b = getattr(one, name)(at), getattr(other, name)(at)
        apart = float(np.max(np.abs(a - b) / np.abs(a)))
        if not apart <= tolerance:
            found.append(f"{name} apart by {apart:.2g}, allowed {tolerance:.2g}")
    return found


def split_of(material: Prony, luck: Luck) -> Prony:
    """Return the same series with one arm in two; a series has no two equal times."""
    at = luck.count(0, len(material.branches) - 1)
    (E, t), share = material.branches[at], luck.within(0.1, 0.9)
    rest = [arm for i, arm in enumerate(material.branches) if i != at]
    return replace(material, branches=(*rest, (E * share, t), (E * (1 - share), t * (1 + 1e-7))))


def with_lost_arms(material: Prony, luck: Luck) -> Prony:
    """Return the series with an arm of next to no modulus, and one that relaxes at once."""
    E, longest = 1e-13 * material.rubbery_modulus, material.time_unit
    return replace(material, branches=(*material.branches, (E, longest * luck.decades(1e-3, 1))))


def split_material(material: Prony, luck: Luck) -> Found:
    """Check that an arm in two halves is the arm."""
    return _same_solid(material, split_of(material, luck), 1e-6)


def lost_arm_material(material: Prony, luck: Luck) -> Found:
    """Check that an arm without a modulus changes nothing."""
    return _same_solid(material, with_lost_arms(material, luck), 1e-8)


def as_prony(solid: StandardSolid) -> Prony:
    """Return the one-armed series that is the standard solid."""
    arm = solid.glassy_modulus - solid.rubbery_modulus
    relaxes = solid.tau0 * solid.modulus_ratio
    return Prony(
        rubbery_modulus=solid.rubbery_modulus,
        branches=((arm, relaxes),),
        poisson_ratio=solid.poisson_ratio,
    )


def standard(luck: Luck) -> StandardSolid:
    """Return a standard solid."""
    return StandardSolid(
        rubbery_modulus=1.0, glassy_modulus=luck.decades(1.01, 1e4), tau0=1.0, poisson_ratio=0.0
    )


def one_arm_material(solid: StandardSolid, luck: Luck) -> Found:
    """Check that one arm is the standard solid, and so is a springpot of order 1, if allowed."""
    found = _same_solid(solid, as_prony(solid), 1e-8)
    try:
        whole = FractionalZener(**vars(solid), order=1.0)
    except InputError:
        return found
    return found + _same_solid(solid, whole, 1e-8)


def slower_material(material: Any, luck: Luck) -> Found:
    """Check that a solid slowed by a factor is the solid at times that are shorter by it."""
    factor = luck.decades(1e-3, 1e3)
    slow, time = slowed(material, factor), np.geomspace(1e-6, 1e6, 121) * material.time_unit
    found = []
    for name in ("relaxation", "creep"):
        a, b = getattr(material, name)(time), getattr(slow, name)(time * factor)
        if not np.allclose(a, b, rtol=1e-9):
            found.append(f"{name} apart by {np.max(np.abs(a / b - 1)):.2g}")
    return found


# --- laws ------------------------------------------------------------------------------------


def law_adds_up(law: Any, luck: Luck) -> Found:
    """Check that traction and stiffness are derivatives, and that a law scales."""
    rest = law.base if has_rest(law) else law
    end = rest.points[-1][0] if isinstance(rest, Tabulated) else 30.0
    # between kinks: of a law in pieces a difference over one is no derivative
    gap = np.sort(luck.within(0.75, min(end, 8.0), 400))
    step = 1e-6
    W, h0 = luck.decades(1e-3, 10), luck.decades(1e-9, 1e-4)
    bigger = scaled(law, W, h0, luck.decades(1e-3, 1e3))
    peak = float(np.max(rest.traction(np.linspace(0.9, end, 20_001))))

    def slope(function: Any) -> Any:
        return (function(gap + step) - function(gap - step)) / (2 * step)

    def most(a: Any, b: Any, tolerance: float) -> bool:
        close = np.abs(a - b) <= tolerance * (np.abs(b) + rest.strength)
        return float(np.mean(close)) > 0.97

    claims = {
        "traction is the slope of the energy": most(slope(rest.energy), rest.traction(gap), 1e-4),
        "stiffness is the slope of the traction": most(
            slope(rest.traction) / rest.strength, rest.stiffness(gap) / rest.strength, 1e-3
        ),
        "energy is the slope of that beyond": most(
            -slope(rest.energy_beyond), rest.energy(gap), 1e-4
        ),
        "work of adhesion": abs(float(rest.energy(1.0)) + 1) < 1e-9,
        "strength is the largest tension": abs(peak / rest.strength - 1) < 1e-3,
        "strength is at the edge": abs(float(rest.traction(rest.edge_gap)) / rest.strength - 1)
        < 1e-6,
        "scaled traction": np.allclose(
            bigger.traction(gap * h0), law.traction(gap) * W / h0, rtol=1e-9
        ),
        "scaled energy": np.allclose(bigger.energy(gap * h0), law.energy(gap) * W, rtol=1e-9),
    }
    return [claim for claim, holds in claims.items() if not holds]


# --- the same problem written otherwise ------------------------------------------------------


def in_si(case: Case, luck: Luck) -> Any:
    """Return a case in SI with random scales."""
    base = getattr(case.body, "base", None)
    scales = {
        "contact_modulus": luck.decades(1e4, 1e9),
        # an elastic solid has no time of its own: its unit is 1 s
        "time_unit": 1.0 if isinstance(case.material, Elastic) else luck.decades(1e-4, 1e4),
        # that of a bonded layer is one of its numbers
        "poisson_ratio": getattr(base, "poisson_ratio", luck.within(0.0, 0.5)),
    }
    if case.in_plane_strain:
        return case.in_si(**scales, work_of_adhesion=luck.decades(1e-3, 1))
    # large beside the range of the forces, so that strains are small
    gap = luck.decades(1e-10, 1e-7)
    return case.in_si(**scales, radius=gap * luck.decades(1e6, 1e9), equilibrium_gap=gap)


def si_scale(case: Case, luck: Luck) -> Found:
    """Check that lengths, moduli and times scale out."""
    one, other = in_si(case, luck), in_si(case, luck)
    return compared(one, other) or _si_columns(other)


def _si_columns(problem: Any) -> Found:
    """Check that numbers in SI are the dimensionless ones times the scale."""
    answer = solved(problem, until="pull-off")
    said = of_result(answer, ACCURACY).numbers
    from viscotack import summary

    whole, units = summary(answer), answer.problem.outputs.observables
    found = []
    for name, value in said.items():
        unit = units[name].unit if name in units else None
        if unit is None or not unit.scale or value is None:
            continue
        expected = value * getattr(answer.scales, unit.scale)
        if not np.isclose(whole[f"{name}_{unit.tail}"], expected, rtol=1e-12):
            found.append(f"{name} in SI {whole[f'{name}_{unit.tail}']}, expected {expected}")
    return found


def split_arm(case: Case, luck: Luck, crack: bool = False) -> Found:
    """Check that an arm in two halves is the arm."""
    case = replace(
        case, material=prony(luck) if not isinstance(case.material, Prony) else case.material
    )
    return compared(case, replace(case, material=split_of(case.material, luck)), crack=crack)


def lost_arm(case: Case, luck: Luck, crack: bool = False) -> Found:
    """Check that an arm without a modulus changes nothing."""
    case = replace(
        case, material=prony(luck) if not isinstance(case.material, Prony) else case.material
    )
    return compared(case, replace(case, material=with_lost_arms(case.material, luck)), crack=crack)


def one_arm(case: Case, luck: Luck, crack: bool = False) -> Found:
    """Check that one arm is the standard solid."""
    if not isinstance(case.material, StandardSolid):
        case = replace(case, material=standard(luck))
    return compared(case, replace(case, material=as_prony(case.material)), crack=crack)


def time_shift(case: Case, luck: Luck, crack: bool = False) -> Found:
    """Check that a slower solid at slower speeds does the same, later."""
    factor = luck.decades(1e-2, 1e2)
    partner = in_time(case, factor)
    ask = by_crack if crack else by_simulation
    return differences(ask(case), timed(ask(partner), 1 / factor))


def in_time(case: Case, factor: float) -> Case:
    """Return the case with all times multiplied."""

    def longer(move: Any) -> Any:
        if isinstance(move, Approach | Retract):
            return replace(move, speed=move.speed / factor)
        return replace(move, duration=move.duration * factor)

    law: Any = case.traction
    if has_rest(law):
        law = replace(law, reference_speed=law.reference_speed / factor)
    return replace(
        case,
        material=slowed(case.material, factor)
        if not isinstance(case.material, Elastic)
        else case.material,
        rate=None if case.rate is None else case.rate / factor,
        moves=tuple(longer(move) for move in case.moves),
        traction=law,
    )


def timed(answer: Answer, factor: float) -> Answer:
    """Return an answer with its times multiplied."""
    kinds = {"begin": 1, "end": 1, "time_to_detachment": 1, "time_at_pull_off": 1}
    power = {n: kinds.get(n.split()[-1], -1 if "speed" in n else 0) for n in answer.numbers}

    def moved(values: Any) -> Any:
        return {n: None if v is None else v * factor ** power[n] for n, v in values.items()}

    series = dict(answer.series) | {"time": answer.series["time"] * factor}
    return replace(
        answer,
        numbers=moved(answer.numbers),
        spread=moved(answer.spread),
        floor=moved(answer.floor),
        series=series,
    )


def table_of_law(case: Case, luck: Luck) -> Found:
    """Check that a law in a fine table is its formula."""
    law: Any = case.traction
    if has_rest(law) or isinstance(law, Tabulated):
        return []
    near = float(law.edge_gap)
    # a law that repels softly presses surfaces closer
    least = 0.6 if -float(law.traction(0.6)) > 10 * law.strength else 0.05
    gap = np.unique(
        np.concatenate(
            [np.linspace(least, 2 * near, 600), np.geomspace(2 * near, 60.0, 400), [1.0]]
        )
    )
    traction = law.traction(gap)
    traction[-1] = 0.0
    try:
        table = Tabulated.of_points(gap, traction).reduced()
    except InputError:
        return []
    return compared(case, replace(case, traction=table), factor=1.5)


def square_profile(case: Groups, luck: Luck, crack: bool = False) -> Found:
    """Check that a profile of exponent 2 is the sphere."""
    case = replace(case, geometry=Sphere(1.0))
    return compared(case, replace(case, geometry=PowerLawProfile(0.5, 2.0)), crack=crack)


def stiff_spring(case: Case, luck: Luck, crack: bool = False) -> Found:
    """Check that a very stiff spring is a rigid machine."""
    rigid = replace(case, stiffness=None)
    return compared(rigid, replace(rigid, stiffness=1e9), crack=crack)


def elastic_time(case: Case, luck: Luck) -> Found:
    """Check that an elastic solid has no time: speeds and waiting change nothing."""
    if has_rest(case.traction) or any(
        isinstance(m, Dwell) and m.hold == "force" for m in case.moves
    ):
        return []
    elastic = replace(case, material=Elastic(rubbery_modulus=1.0, poisson_ratio=0.0))
    factor = luck.decades(1e-3, 1e3)
    one, other = by_simulation(elastic), by_simulation(in_time(elastic, factor))
    return differences(one, timed(other, 1 / factor))


def start_by(case: Case, luck: Luck, crack: bool = False) -> Found:
    """Check that a start by depth, force or radius is the same start."""
    if isinstance(case.start, Apart):
        return []
    answer = (by_crack if crack else by_simulation)(case).series
    depth, force, radius = (float(answer[n][0]) for n in ("depth", "force", "contact_radius"))
    # on the stable side of a dead load, the one which a start by force takes
    starts = [AtDepth(depth)]
    if isinstance(case, Groups) and np.isfinite(radius) and radius > 1.3:
        starts += [AtRadius(radius)]
    if force > 0:
        starts += [AtForce(force)]
    start = luck.one(dict.fromkeys(starts, 1))
    return compared(case, replace(case, start=start), crack=crack)


def split_retraction(case: Case, luck: Luck, crack: bool = False) -> Found:
    """Check that a retraction in two moves of the same speed is the retraction."""
    if case.rate is None or (isinstance(case.start, Apart) and not case.moves):
        return []
    ask = by_crack if crack else by_simulation
    one = ask(case)
    depth = one.series["depth"]
    last = np.flatnonzero(one.series["move"] == len(case.moves))
    if not np.isfinite(one.series["contact_radius"][last[:1]]).any():
        return []  # it has let go before
    begin, end = depth[max(last[0] - 1, 0)], depth[last[-1]]
    to = AtDepth(float(begin + luck.within(0.1, 0.9) * (end - begin)))
    other = ask(replace(case, moves=(*case.moves, Retract(case.rate, to))))
    last = len(case.moves)
    series = dict(other.series) | {"move": np.minimum(other.series["move"], last)}
    return differences(one, replace(other, series=series))


def rest(case: Case, luck: Luck, crack: bool = False) -> Found:
    """Check that waiting at a relaxed start changes nothing, neither then nor later."""
    hold = luck.one({"drive": 1, "depth": 1, "force": 1})
    pulled = isinstance(case.start, AtForce) and case.start.force < -0.7
    if isinstance(case.start, Apart) or (hold == "force" and (pulled or _negative(case.start))):
        return []
    duration = luck.decades(1e-2, 1e2)
    ask = by_crack if crack else by_simulation
    one, other = ask(case), ask(replace(case, moves=(Dwell(duration, hold), *case.moves)))
    wait = other.series["move"] == 0
    found = []
    for name in ("force", "depth", "contact_radius"):
        values = other.series[name][wait]
        drift = float(np.max(np.abs(values - values[0]), initial=0.0))
        if drift > 1e-6 * (abs(float(values[0])) + 1):
            found.append(f"{name} drifts by {drift:.2g} at rest, from {values[0]:.4g}")
    return found + differences(one, without_first(other, duration))


def _negative(start: Any) -> bool:
    return isinstance(start, AtDepth) and start.depth < 0


def without_first(answer: Answer, duration: float) -> Answer:
    """Return an answer without its first move, which took so long."""
    keep = np.flatnonzero(answer.series["move"] > 0)
    keep = np.concatenate([[keep[0] - 1], keep]) if keep.size else keep
    series = {n: v[keep] for n, v in answer.series.items()}
    series["time"] = series["time"] - duration
    series["move"] = np.maximum(series["move"] - 1, 0)
    shifted = {
        n: v - duration
        if v is not None and n.split()[-1] in ("begin", "end", "time_at_pull_off")
        else v
        for n, v in answer.numbers.items()
    }
    if "cycle 1 begin" in shifted:
        shifted["cycle 1 begin"] = answer.numbers["cycle 1 begin"]
    return replace(answer, numbers=shifted, series=series)


def long_dwell(case: Case, luck: Luck) -> Found:
    """Check that a contact is the relaxed one long after it was pressed from a light touch."""
    if isinstance(case.start, Apart) or isinstance(case, Groups) and case.tabor > _SPHERE_TABOR:
        return []
    case = replace(case, material=standard(luck), moves=(), stiffness=None, rate=case.rate or 1.0)
    depth = float(by_simulation(case).series["depth"][0])
    if depth <= 0:
        return []
    pressed = replace(
        case,
        start=AtDepth(depth * luck.within(0.3, 0.8)),
        moves=(Approach(luck.decades(1e-2, 10) * (1 + depth), AtDepth(depth)), Dwell(200.0)),
    )
    one, other = by_simulation(case), by_simulation(pressed)
    names = ("pull_off_force", "pull_off_stress", "depth_at_pull_off", "contact_radius_at_pull_off")
    names += ("ligament_at_pull_off", "work_to_pull_off", "work_of_separation")
    return differences(_only(one, names), _only(other, names))


def _only(answer: Answer, names: tuple[str, ...]) -> Answer:
    numbers = {n: v for n, v in answer.numbers.items() if n in names}
    move = np.full(1, -1)
    series = dict(answer.series) | {"move": move}
    return replace(answer, numbers=numbers, series=series, words={})


def until(case: Case, luck: Luck) -> Found:
    """Check that what happens until the pull-off does not depend on what comes after it."""
    whole, part = by_simulation(case), by_simulation(case, until="pull-off")
    late = ("work_of_separation", "hysteresis", "end", "time_to_detachment")

    def early(answer: Answer) -> Answer:
        kept = {n: v for n, v in answer.numbers.items() if not n.endswith(late)}
        return replace(answer, numbers=kept, words={})

    found = differences(early(whole), early(part))
    return [f"until detached and until pull-off: {words}" for words in found]


# --- bounds ----------------------------------------------------------------------------------


def between_limits(case: Groups, luck: Luck) -> Found:
    """Check that the force lies between those of a slow and of a fast retraction."""
    found = by_simulation(case, until="pull-off")
    force = found.numbers["pull_off_force"]
    slow = by_simulation(replace(case, material=_rubber(case)), until="pull-off")
    least = slow.numbers["pull_off_force"]
    if force is None or least is None:
        return []
    words = []
    if force < least * (1 - 3 * ACCURACY):
        words.append(f"force {force:.5g} below the slow limit {least:.5g}")
    # a glassy solid of the radius R/k, and the most that any range of forces gives: 4/3 of JKR
    most = 4 / 3 / case.modulus_ratio
    if force > most * (1 + 3 * ACCURACY):
        words.append(f"force {force:.5g} above the fast limit {most:.5g}")
    return words


def _rubber(case: Case) -> Any:
    return Elastic(rubbery_modulus=case.material.rubbery_modulus, poisson_ratio=0.0)


def energy(case: Case, luck: Luck) -> Found:
    """Check work = stored + heat + jumps, with drive and spring derived from the force."""
    result = solved(case)
    e = result.energy
    if e is None:
        return []
    K = case.stiffness
    spring = np.zeros_like(result.force) if K is None else result.force**2 / (2 * K)
    stored = e.elastic + e.interface + spring
    heat = e.heat + e.interface_heat
    missing = e.drive - (stored - stored[0]) - heat - e.jumps - e.transfer
    gross = float(np.abs(np.diff(result.depth)) @ np.abs(result.force[1:] + result.force[:-1]) / 2)
    largest = max(float(np.max(np.abs(v - v[0]))) for v in (e.drive, *_terms(e), spring))
    scale = max(largest, gross, 0.1)
    tight = 2e-2  # the audit at an accuracy of 0.01
    words = []
    if np.max(np.abs(missing)) > tight * scale:
        words.append(f"{np.max(np.abs(missing)):.3g} of {scale:.3g} is missing")
    if np.max(np.abs(spring - e.spring)) > 1e-6 * scale:
        at = int(np.argmax(np.abs(spring - e.spring)))
        words.append(f"spring {e.spring[at]:.6g}, by its force {spring[at]:.6g}, step {at}")
    words += _drive(result, K, scale)
    for name, values in {"heat": heat, "jumps": e.jumps}.items():
        if np.any(np.diff(values) < -1e-3 * scale) or values[0] != 0:
            words.append(f"{name} falls by {-np.min(np.diff(values)):.2g} of {scale:.3g}")
    if abs(float(np.sum(e.mode_heat)) - float(e.heat[-1])) > 1e-9 * scale:
        words.append(f"heat of modes {np.sum(e.mode_heat):.6g}, in all {e.heat[-1]:.6g}")
    if np.min(e.elastic) < -1e-3 * scale:
        words.append(f"elastic energy {np.min(e.elastic):.2g} of {scale:.3g}")
    return words


def _terms(e: Any) -> tuple[Any, ...]:
    return e.elastic, e.interface, e.heat, e.jumps, e.transfer, e.interface_heat


def _drive(result: Any, stiffness: float | None, scale: float) -> Found:
    """Compare the work of the drive with the trapezoid of the force over the drive."""
    place = result.depth + (0.0 if stiffness is None else result.force / stiffness)
    work = (result.force[1:] + result.force[:-1]) / 2 * np.diff(place)
    booked = np.diff(result.energy.drive)
    # over a jump the curve is not drawn
    jumped = np.isin(result.time[1:], [event.time for event in result.events])
    apart = float(np.abs(np.sum((work - booked)[~jumped])))
    # the trapezoid over steps twice as long tells how far it is off
    coarse = (result.force[2::2] + result.force[:-2:2]) / 2 * np.diff(place[::2])
    doubt = abs(float(np.sum(coarse)) - float(np.sum(work[: 2 * len(coarse)])))
    if jumped.any():
        doubt = 0.01 * scale
    allowed = doubt + 0.02 * scale
    if apart > allowed:
        return [
            f"drive work off by {apart:.3g} from the integral of the force, allowed {allowed:.2g}"
        ]
    return []


def hysteresis(case: Case, luck: Luck) -> Found:
    """Check that a loop takes at least the work that it leaves stored in the solid.

    A cycle that begins in a dent that an earlier one left may give work: the dent recovers.
    """
    result = solved(case)
    gross = float(np.abs(np.diff(result.depth)) @ np.abs(result.force[1:] + result.force[:-1]) / 2)
    words = []
    for number, (span, cycle) in enumerate(zip(spans(result), cycles(result), strict=True), 1):
        H = cycle.hysteresis
        least = _left(result, span, cycle.loop)
        if np.isfinite(H) and H < least - 5 * ACCURACY * gross:
            words.append(
                f"cycle {number} has hysteresis {H:.4g} and leaves {least:.4g} stored, "
                f"gross work {gross:.4g}"
            )
        if np.isfinite(H) and isinstance(case.material, Elastic) and not result.events:
            if abs(H) > 5 * ACCURACY * gross and not has_rest(case.traction):
                words.append(f"cycle {number} of an elastic solid has hysteresis {H:.4g}")
    return words


def _left(result: Result, span: Span, loop: Loop) -> float:
    """Return the energy that a cycle leaves stored, of that which its hysteresis counts."""
    e = result.energy
    if e is None or loop is Loop.CLOSED:
        return 0.0
    stored = e.elastic if loop is Loop.APART else e.elastic + e.interface
    return float(stored[span.last] - stored[span.first])


def observables_of_series(case: Case, luck: Luck) -> Found:
    """Check that observables are those of the series, and that works are in order."""
    result = solved(case)
    said = of_result(result, ACCURACY)
    numbers = said.numbers
    force = numbers.get("pull_off_force", numbers.get("pull_off_stress"))
    words = []
    pulled = case.rate is not None and not result.events
    if pulled and force is not None:
        most = -float(np.min(result.force[spans(result)[-1].turn :]))
        if abs(force - most) > 2 * ACCURACY * max(abs(most), 0.1):
            words.append(f"pull-off {force:.5g}, largest tension of the retraction {most:.5g}")
    work, whole = numbers.get("work_to_pull_off"), numbers.get("work_of_separation")
    if work is not None and whole is not None and whole < work - 0.05 * abs(work) - 0.01:
        words.append(f"work of separation {whole:.5g} below the work to pull-off {work:.5g}")
    if np.any(np.diff(result.time) < 0) or np.any(result.contact_radius < 0):
        words.append("time or radius falls below what is possible")
    return words


def refinement(case: Case, luck: Luck) -> Found:
    """Check that a finer run moves the answer by less than three times the stated error."""
    rough = by_simulation(case, estimate=True, until="pull-off")
    fine = by_simulation(case, accuracy=ACCURACY / 5, until="pull-off")
    stated = rough.result.error_estimate or {}
    words = []
    for name, key in (
        ("pull_off_force", "force"),
        ("pull_off_stress", "force"),
        ("work_to_pull_off", "work"),
    ):
        a, b, e = rough.numbers.get(name), fine.numbers.get(name), stated.get(key)
        if a is None or b is None or e is None:
            continue
        floor = 1e-3 * max(abs(b), 0.1)
        if (
            abs(a - b)
            > 3 * e * abs(a) + ACCURACY / 5 * (5 if key == "work" else 1) * abs(b) + floor
        ):
            words.append(f"{name} {a:.6g}, finer {b:.6g}, stated error {e:.2g}")
    return words


def deep_start(case: Groups, luck: Luck) -> Found:
    """Check that a start whose depth does not matter gives what the whole march gives."""
    if case.tabor > 5 or case.moves:
        return []
    case = replace(
        case, start=AtDepth(1000 * luck.within(1.1, 2)), stiffness=None, rate=case.rate or 1.0
    )
    one = by_simulation(case, until="pull-off", estimate=True)
    other = by_simulation(case, until="pull-off", whole=True)
    names = ("pull_off_force", "depth_at_pull_off", "work_to_pull_off")
    return differences(_only(one, names), _only(other, names))


def moves_in_words(case: Case, luck: Luck) -> Found:
    """Check that an approach to a depth by a rigid machine is a move to it in its time."""
    if case.stiffness is not None or isinstance(case.start, Apart):
        return []
    depth = float(by_simulation(case, until="pull-off").series["depth"][0])
    speed = luck.decades(0.01, 100) * (1 + abs(depth))
    deeper = depth + luck.within(0.2, 2) * (1 + abs(depth))
    rest = {"moves": (), "rate": case.rate or speed}
    one = replace(case, **rest | {"moves": (Approach(speed, AtDepth(deeper)),)})
    other = replace(case, **rest | {"moves": (MoveTo(deeper, (deeper - depth) / speed),)})
    return compared(one, other)


# --- which are drawn, and how often ----------------------------------------------------------


def _far(luck: Luck) -> Groups:
    """Return a contact for the tier of steady cracks."""
    while True:
        found = cases.contact(luck)
        # a crack of another law or of many modes takes seconds
        known = isinstance(found.traction, LennardJones | Exponential)
        if isinstance(found, Groups) and known:
            return replace(found, tabor=luck.decades(8, 3000))


def _tip(luck: Luck) -> Groups:
    while True:
        found = cases.contact(luck)
        if isinstance(found, Groups):
            return found


def _loop(luck: Luck) -> Case:
    """Return a contact that goes through cycles."""
    while True:
        found = cases.contact(luck)
        if any(isinstance(m, Approach | MoveTo) for m in found.moves):
            return found


def _with_spring(luck: Luck) -> Case:
    found = cases.contact(luck)
    return found if found.stiffness else replace(found, stiffness=luck.decades(1e-3, 1e2))


def of_crack(relation: Any) -> Check:
    """Return the relation for the contact with a steady crack."""
    return lambda case, luck: relation(case, luck, crack=True)


PHYSICS: tuple[Relation, ...] = (
    Relation("passive", cases.material, passive, 2.5),
    Relation("split-material", prony, split_material, 0.5),
    Relation("lost-arm-material", prony, lost_arm_material, 0.5),
    Relation("one-arm-material", standard, one_arm_material, 0.5),
    Relation("slower-material", cases.material, slower_material, 0.5),
    Relation("law", cases.law, law_adds_up, 2.0),
    Relation("si-scale", cases.contact, si_scale, 2.0),
    Relation("split-arm", cases.contact, split_arm),
    Relation("lost-arm", cases.contact, lost_arm),
    Relation("one-arm", cases.contact, one_arm),
    Relation("time-shift", cases.contact, time_shift),
    Relation("table", cases.contact, table_of_law),
    Relation("square-profile", _tip, square_profile),
    Relation("stiff-spring", cases.contact, stiff_spring),
    Relation("elastic-time", cases.contact, elastic_time),
    Relation("start-by", cases.contact, start_by),
    Relation("split-retraction", cases.contact, split_retraction),
    Relation("rest", cases.contact, rest, 1.5),
    Relation("long-dwell", cases.contact, long_dwell),
    Relation("until", cases.contact, until, 1.5),
    Relation("between-limits", cases.relaxed, between_limits),
    Relation("energy", cases.contact, energy, 2.0),
    Relation("energy-spring", _with_spring, energy, 1.0),
    Relation("hysteresis", _loop, hysteresis, 1.5),
    Relation("series", cases.contact, observables_of_series, 1.5),
    Relation("refinement", cases.contact, refinement, 1.5),
    Relation("deep-start", cases.relaxed, deep_start, 0.5),
    Relation("moves", cases.contact, moves_in_words),
    Relation("crack-split-arm", _far, of_crack(split_arm), 0.25),
    Relation("crack-lost-arm", _far, of_crack(lost_arm), 0.25),
    Relation("crack-one-arm", _far, of_crack(one_arm), 0.25),
    Relation("crack-time-shift", _far, of_crack(time_shift), 0.25),
    Relation("crack-square-profile", _far, of_crack(square_profile), 0.25),
    Relation("crack-stiff-spring", _far, of_crack(stiff_spring), 0.25),
    Relation("crack-start-by", _far, of_crack(start_by), 0.25),
    Relation("crack-split-retraction", _far, of_crack(split_retraction), 0.25),
    Relation("crack-rest", _far, of_crack(rest), 0.25),
)
