"""Simulation of a problem: single entry point, from the problem to the result."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np

from viscotack.clock import TimeUp, met
from viscotack.errors import InputError
from viscotack.model.geometry import (
    Cone,
    Disc,
    FlatPunch,
    HalfSpace,
    PowerLawProfile,
    Sphere,
    detail,
)
from viscotack.model.materials import Material, Modes
from viscotack.model.problem import Case, Groups
from viscotack.model.problem.revolution import SIMULATED_TABOR
from viscotack.model.traction import effective_range, has_rest
from viscotack.result import Energies, Outcome, Result, receding_speed
from viscotack.result.observables import peaks
from viscotack.simulate.bounds import check_bounds, check_clock, check_held
from viscotack.simulate.contacts.contact import Contact, Relaxed
from viscotack.simulate.contacts.punch import PunchContact
from viscotack.simulate.contacts.shape import DiscContact, ShapeContact
from viscotack.simulate.contacts.sphere import ProfileContact, SphereContact
from viscotack.simulate.estimate import COARSER, estimated
from viscotack.simulate.growth import finer
from viscotack.simulate.history import History, Snapshot
from viscotack.simulate.interface import resolved
from viscotack.simulate.machine import Leg, legs_of, longest_time, reached, spring_travel
from viscotack.simulate.march import Part, march
from viscotack.simulate.preload import shallower
from viscotack.simulate.settings import Settings
from viscotack.simulate.verdict import judged, out_of_time, status_of

# Called with the completed fraction of the work, 0 to 1.
Progress = Callable[[float], None] | None
# Called after each step with time, depth, force and contact radius, in the units of `Result`.
Watch = Callable[[float, float, float, float], None] | None

# Modes faster than this fraction of the first step are treated as instantaneous.
_FASTEST = 0.2
# Share of the main run in the total work if a coarser run follows for the error estimate.
_MAIN = 0.8


class SimulationError(RuntimeError):
    """A simulation stopped early; `result` holds the steps computed so far and the reason."""

    def __init__(self, result: Result) -> None:
        super().__init__(result.status)
        self.result = result

    def __reduce__(self) -> tuple[type[SimulationError], tuple[Result]]:
        """Support pickling: the exception is rebuilt from its result, not from its message."""
        return type(self), (self.result,)


def simulate(
    problem: Case,
    groups: Groups,
    *,
    settings: Settings,
    until: str = "pull-off",
    estimate_error: bool = False,
    whole: bool = False,
    fields: bool = False,
    throw: bool = False,
    progress: Progress = None,
    watch: Watch = None,
) -> Result:
    """Simulate a problem, also given by its dimensionless groups, for any range of adhesion.

    The other parameters and the errors are the same as for :func:`viscotack.solve`, which checks
    the parameters and sets the limits on time and threads.
    """
    began = perf_counter()
    share = _MAIN if estimate_error else 1.0
    contact = contact_of(groups)
    check_bounds(groups, contact)

    def light(marched: Groups, seen: Progress = None, *, whole: bool = False) -> Result:
        # after moves the force may have a minimum before pull-off: end both runs at the same event
        end = until if groups.moves else "detached" if whole else "pull-off"
        coarser = settings.coarser(COARSER)
        return _run(problem, marched, coarser, end, False, seen)

    try:
        beginning = None if whole else shallower(groups, contact, settings, light)
        marched = groups if beginning is None else beginning.light.groups
        own = part_of(progress, 0.0, share)
        result = _run(problem, marched, settings, until, fields, own, watch)
    except TimeUp as limit:
        raise InputError(
            f"{limit} before the relaxed start was found; give more time, or ask for less accuracy"
        ) from None
    if estimate_error and result.outcome is not Outcome.STOPPED:
        result = estimated(
            result,
            lambda: light(groups, part_of(progress, share, 1.0), whole=len(peaks(result)) > 1),
            beginning,
            contact.travel,
            settings.accuracy,
        )
        if result.error_estimate is None and (limit := met()):
            status = out_of_time(limit, "while the error was estimated")
            result = replace(result, status=status)
    result = replace(
        result,
        shallow_start=None if beginning is None else beginning.start,
        statistics=dict(result.statistics) | {"wall_time_s": perf_counter() - began},
    ).posed(groups)
    result = judged(result)
    if throw and result.outcome is Outcome.STOPPED:
        raise SimulationError(result)
    return result


def part_of(progress: Progress, begin: float, end: float) -> Progress:
    """Return a callback for the progress of one part of the work; reported values never fall."""
    if progress is None:
        return None
    reached = begin

    def tell(done: float) -> None:
        # with a soft spring a jump of the contact may make the computed progress non-monotonic
        nonlocal reached
        reached = max(reached, begin + (end - begin) * done)
        progress(reached)

    return tell


def _run(
    problem: Case,
    groups: Groups,
    settings: Settings,
    until: str,
    fields: bool,
    progress: Progress,
    watch: Watch = None,
) -> Result:
    contact = contact_of(groups)
    start, legs = begun(groups, contact, settings)
    depths = reached(start, groups.moves, contact)
    check_clock(legs, groups.moves, depths, contact)
    k = groups.material.modulus_ratio
    spring = spring_travel(start, depths, groups.moves, groups.stiffness, k, contact)
    longest = longest_time(depths, groups.moves, groups.rate, contact, spring)
    part = part_of_run(groups, contact, start, legs, longest, max(depths), settings)

    def seen(step: Snapshot) -> None:
        if watch is not None:
            watch(step.time, step.depth, step.force, step.edge / contact.edge_unit)

    history = march(
        part,
        legs,
        settings,
        until=until,
        stiffness=groups.stiffness,
        profiles=fields,
        progress=progress,
        watch=None if watch is None else seen,
    )
    result = _result(problem, groups, contact, history, part.modes, fields)
    return replace(result, accuracy=settings.accuracy).posed(groups)


def relaxed_start(groups: Groups, contact: Contact, settings: Settings) -> Relaxed:
    """Return the relaxed start of a test."""
    try:
        return contact.relaxed(groups.start, finer(settings, groups.traction))
    except ArithmeticError as reason:
        raise InputError(f"the relaxed start was not found: {reason}") from reason


def begun(groups: Groups, contact: Contact, settings: Settings) -> tuple[Relaxed, tuple[Leg, ...]]:
    """Return the relaxed start of a test and its legs; check that the first leg can hold it."""
    start = relaxed_start(groups, contact, settings)
    legs = legs_of(groups.moves, groups.rate, groups.stiffness, contact, settings)
    check_held(start, contact, legs[0])
    return start, legs


def contact_of(groups: Groups) -> Contact:
    """Return the contact described by dimensionless groups, with the quasi-static law."""
    law = _base(groups.traction)
    if isinstance(groups.geometry, FlatPunch):
        return PunchContact(groups.geometry.half_width, groups.body, law)
    low, high = SIMULATED_TABOR
    if not low <= groups.effective_tabor <= high:
        span = effective_range(groups.traction)
        over = "" if span == 1 else f" (over the range of the law, {span:.3g} h0)"
        raise InputError(
            f"the range-corrected Tabor number{over} must be between {low:g} and {high:g} for a "
            f"simulation, got {groups.effective_tabor:.4g}; below take theory.bradley, above "
            "theory.jkr on a half-space and theory.elastic.indenter on another body"
        )
    assert groups.tabor is not None
    match groups.geometry, groups.body:
        case Sphere(), HalfSpace():
            return SphereContact(groups.tabor, law)
        case Cone() | PowerLawProfile() as tip, HalfSpace():
            return ProfileContact(groups.tabor, law, tip.exponent)
        case Disc() as disc, body:
            return DiscContact(groups.tabor, law, disc, body=body)
        case shape, body:
            return ShapeContact(groups.tabor, law, shape, body=body)


def _base(law: Any) -> Any:
    """Return the law at rest; reject laws that grow or age and are too steep for the nodes.

    They are evaluated at the nodes because opening speeds and contact times are known only there.
    """
    if has_rest(law) and not resolved(law.base):
        raise InputError(
            f"the law at rest of one of the kind {law.word} must be smooth enough for nodes, and "
            f"{law.base} falls too steeply; take a wider fall (dugdale: rise 0.3, fall 1), or "
            "lennard-jones"
        )
    return law.base if has_rest(law) else law


def modes_of_run(
    material: Material, legs: tuple[Leg, ...], longest: float, settings: Settings
) -> Modes:
    """Return the retardation modes with times inside the time range of this run."""
    shortest = _FASTEST * min(leg.least_step for leg in legs)
    # Relative to the compliance at the shortest time, which is small where k is small.
    compliance = float(material.creep(shortest))
    return material.retardation_modes(
        shortest=shortest, longest=longest, tolerance=settings.mode_tolerance * compliance
    )


def part_of_run(
    groups: Groups,
    contact: Contact,
    start: Relaxed,
    legs: tuple[Leg, ...],
    longest: float,
    deepest: float,
    settings: Settings,
) -> Part:
    """Return a contact ready for a run of these legs, longest time and largest depth."""
    modes = modes_of_run(groups.material, legs, longest, settings)
    grading = contact.grading(finer(settings, groups.traction, longest), deepest)
    if not modes.weights:  # an elastic solid does not remember where the edge has been
        grading = replace(grading, scar_half_width=0.0)
    growing = groups.traction if has_rest(groups.traction) else None
    return Part(contact, start, modes, grading, growing)


def _result(
    problem: Case,
    groups: Groups,
    contact: Contact,
    history: History,
    modes: Modes,
    fields: bool,
) -> Result:
    time, edge = history.seen("time"), history.seen("edge")
    residual = float(np.max(np.abs(history.imbalances())))
    parts: dict[str, Any] = {}
    if not np.isinf(detail(groups.geometry)):  # the contact may have several edges
        parts["inner_radius"] = history.seen("hole") / contact.edge_unit
        parts["rings"] = history.seen("rings")
    return Result(
        problem=problem,
        time=time,
        depth=history.seen("depth"),
        force=history.seen("force"),
        contact_radius=edge / contact.edge_unit,
        edge_speed=receding_speed(time, edge),
        status=status_of(history, residual, contact.law),
        events=tuple(history.events),
        statistics=history.statistics
        | {"meshes": history.meshes, "nodes": history.nodes, "modes": len(modes.weights)},
        energy=Energies(
            **history.energies(),
            mode_time=np.array(modes.times),
            mode_heat=history.books[-1].heat,
            mode_weight=np.array(modes.weights),
        ),
        energy_residual=residual,
        fields=_fields(history, contact, time) if fields else None,
        move=np.array(history.legs),
        **parts,
    )


def _fields(history: History, contact: Contact, time: np.ndarray) -> dict[str, np.ndarray]:
    """Return the profiles, padded with nan to the largest mesh; radius in the output unit."""
    longest = max(len(p.gap) for p in history.profiles)

    def padded(values: np.ndarray) -> np.ndarray:
        return np.concatenate([values, np.full(longest - len(values), np.nan)])

    return {
        "time": time,
        "radius": np.array([padded(p.position / contact.edge_unit) for p in history.profiles]),
        "gap": np.array([padded(p.gap) for p in history.profiles]),
        "pressure": np.array([padded(p.pressure) for p in history.profiles]),
    }
