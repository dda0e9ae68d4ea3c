"""Simulation of a problem: single entry point, from the problem to the result.

Where the range of adhesion is too short to simulate, the steady-crack contact model replaces the
simulation.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np

from viscotack.cards import card_of
from viscotack.clock import TimeUp, limited, met
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
from viscotack.model.problem import Case, Groups, Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY, LOOSEST_ACCURACY, TimeLimit
from viscotack.model.problem.revolution import SIMULATED_TABOR
from viscotack.model.protocol import AtDepth, AtForce
from viscotack.model.traction import effective_range, has_rest
from viscotack.result import Energies, Outcome, Result, receding_speed
from viscotack.result.observables import peaks
from viscotack.simulate.bounds import check_bounds, check_clock, check_held
from viscotack.simulate.contacts.contact import Contact, Relaxed
from viscotack.simulate.contacts.punch import PunchContact
from viscotack.simulate.contacts.shape import DiscContact, ShapeContact
from viscotack.simulate.contacts.sphere import ProfileContact, SphereContact
from viscotack.simulate.crack_contact import not_covered, too_short
from viscotack.simulate.estimate import COARSER, estimated
from viscotack.simulate.growth import finer
from viscotack.simulate.history import History, Snapshot
from viscotack.simulate.machine import Leg, legs_of, longest_time, reached, spring_travel
from viscotack.simulate.march import Part, march
from viscotack.simulate.preload import shallower
from viscotack.simulate.sensitivities import changed_inputs, sensitivities_of
from viscotack.simulate.settings import Settings
from viscotack.simulate.surface import resolved
from viscotack.simulate.verdict import judged, out_of_time, status_of
from viscotack.threads import one_blas_thread

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
    law: Any = groups.traction
    if has_rest(law):
        # opening speeds and contact times are known only at the nodes
        word, law = law.word, law.base
        if not resolved(law):
            raise InputError(
                f"the law at rest of one of the kind {word} must be smooth enough "
                f"for nodes, and {law} falls too steeply; take a wider fall (dugdale: rise 0.3, "
                "fall 1), or lennard-jones"
            )
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
    profiles = None
    if fields:  # padded with nan to the largest mesh
        whole = np.full((3, len(time), max(len(p.gap) for p in history.profiles)), np.nan)
        for i, p in enumerate(history.profiles):
            position = p.position / contact.edge_unit
            whole[:, i, : len(p.gap)] = position, p.gap, p.pressure
        profiles = {"time": time} | dict(zip(("radius", "gap", "pressure"), whole, strict=True))
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
        fields=profiles,
        move=np.array(history.legs),
        **parts,
    )


_UNTIL = ("pull-off", "detached")
# Smallest node spacing over the contact radius: below it the influence coefficients lose digits (at
# 4e-7 a force was off by a fifth). Checked above this effective Tabor number only.
_DIGITS, _FINE_TABOR = 6e-7, 20.0


def solve(
    problem: Case,
    *,
    accuracy: float = DEFAULT_ACCURACY,
    until: str = "detached",
    settings: Settings | None = None,
    estimate_error: bool = True,
    whole: bool = False,
    fields: bool = False,
    throw: bool = True,
    progress: Progress = None,
    watch: Watch = None,
    time_limit: float | None = None,
    sensitivities: bool | Iterable[str] = False,
) -> Result:
    """Simulate the detachment of a rigid indenter from a viscoelastic solid.

    The test starts at rest, in a relaxed contact or apart, performs the moves of its protocol, and
    ends with a retraction at a constant rate or with the last move. Pressure and gap are computed
    from the traction law and the hereditary integral of the solid (Eq. 4.11 to 4.15 of Maghami,
    PhD thesis (2025)). The accuracy determines mesh, time steps and relaxation modes.

    Parameters
    ----------
    problem : Problem or Groups
        The problem, in SI or in dimensionless groups.
    accuracy : float
        Required relative error of the pull-off force, from 1e-6 to 0.02. The work to pull-off has
        up to five times this error, because the force minimum at its end is flat.
    until : {"detached", "pull-off"}
        End of the run: when the surfaces are apart, or as soon as no later tension can exceed the
        largest one so far, mostly just past the first force minimum. The latter is faster, but
        does not give the work of separation.
    settings : Settings, optional
        Mesh, steps and modes for experts; overrides those chosen from `accuracy`.
    estimate_error : bool
        Also run a coarser simulation and estimate the errors of force, work and depth at pull-off
        from the difference. If the error of the force is ten times the required one, the run stops
        with the status "unresolved".
    whole : bool
        Simulate the whole retraction from the given start, however deep. By default a retraction
        of a sphere, cone or power-law tip from more than 1000 h0, without moves before it, starts
        at a smaller depth for which coarse simulations show no influence of the start
        (:mod:`viscotack.simulate.preload`); ``result.shallow_start`` contains that depth.
    fields : bool
        Store the profiles of pressure and gap at every step.
    throw : bool
        Raise SimulationError if the run stops before its end. If False, the status of the result
        gives the reason.
    progress : callable, optional
        Called after every step with the completed fraction, from 0 to 1, including the coarser
        simulation.
    watch : callable, optional
        Called after every step of the main run with time, depth, force and contact radius,
        dimensionless as in a result; for example to draw the curve. An exception that it raises
        ends the run and is propagated.
    time_limit : float, optional
        Longest wall time [s] of both simulations. A run that reaches it stops; the result contains
        the steps so far, and its status gives the reason.
    sensitivities : bool or iterable of str
        Also compute the elasticities of force, work, depth and contact radius at the pull-off by
        all inputs of the problem, or by those of these names (``material.tau0``,
        ``protocol.speed``), with their errors: ``result.sensitivities``. Each input takes two more
        simulations, and two coarser ones.

    Returns
    -------
    Result
        Dimensionless series, status, events, energies, error estimate and statistics.

    Raises
    ------
    ValueError
        If the relaxed start does not exist or is not found within the time limit; if it is too
        deep to simulate and no shallower start gives the same result; if an argument or a number
        of the problem is out of range.
    SimulationError
        If the run stops before its end and `throw` is True.
    TypeError
        If the problem is neither a Problem nor Groups, such as the name of a file.

    Notes
    -----
    Above a Tabor number of 200 (elastic solids: 30) the steady-crack contact model replaces the
    simulation (:func:`viscotack.crack_contact`); `method` and `status` of the result state it, and
    its error of the force is the band of the model. The same holds if round-off prevents a
    sufficiently fine mesh, in a very large contact or at a very high accuracy.

    Tested for Tabor numbers from 0.01 to 100, modulus ratios down to 1e-4, preloads from 0.01 to
    500 h0 and rates from 0.1 to 1e10. Small strains are assumed, and inertia is neglected.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, RetardationPowerLaw, pull_off_force, solve
    >>> material = RetardationPowerLaw(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> groups = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73.0), rate=316.23)
    >>> result = solve(groups, until="pull-off")
    >>> f"{pull_off_force(result):.2f}"
    '7.33'
    """
    if not isinstance(problem, Problem | Groups):
        raise TypeError(
            f"solve needs a Problem or Groups, got {problem!r}; for a file use "
            "viscotack.read_case(path)"
        )
    if until not in _UNTIL:
        raise InputError(f"until must be one of {', '.join(map(repr, _UNTIL))}, got {until!r}")
    began = perf_counter()
    chosen = Settings.for_accuracy(accuracy) if settings is None else settings
    if time_limit is not None:
        time_limit = card_of(TimeLimit).checked("time_limit", time_limit)
    with one_blas_thread(), limited(time_limit):
        groups = problem.groups()
        if _too_short(groups, chosen):
            if fields:
                raise InputError(
                    "profiles exist for simulations only, and the range-corrected Tabor number "
                    f"of {groups.effective_tabor:.4g} is too large to simulate; use fields=False"
                )
            if sensitivities:
                raise InputError(
                    "derivatives exist for simulations only, and the range-corrected Tabor number "
                    f"of {groups.effective_tabor:.4g} is too large to simulate"
                )
            return _by_cracks(problem, chosen.accuracy)
        wanted = None if isinstance(sensitivities, bool) else sensitivities
        changes = {} if sensitivities is False else changed_inputs(problem, wanted)
        share = 1 / (1 + 2 * len(changes))
        result = simulate(
            problem,
            groups,
            settings=chosen,
            until=until,
            estimate_error=estimate_error,
            whole=whole,
            fields=fields,
            throw=throw,
            progress=part_of(progress, 0.0, share),
            watch=watch,
        )
        if not changes or result.outcome is Outcome.STOPPED:
            return result

        def run(changed: Case, level: Settings) -> Result:
            return simulate(changed, changed.groups(), settings=level, whole=whole)

        found = sensitivities_of(
            problem, changes, chosen, run, lambda n: progress and progress((1 + 2 * n) * share)
        )
        cost = dict(result.statistics) | {"wall_time_s": perf_counter() - began}
        return replace(result, sensitivities=found, statistics=cost).posed(groups)


def has_start(problem: Case) -> bool:
    """Whether the relaxed state at the start of a test exists; some milliseconds where in doubt.

    Pressed to a depth, or by a force, that is not negative, sphere and punch are always in
    contact: the gap in the middle is then at most h0, below that of peak tension. Else the state is
    searched at the lowest accuracy, with the range of the law, with which contacts exist beyond
    the end of JKR's.
    """
    start = problem.groups().start
    if (isinstance(start, AtDepth) and start.depth >= 0) or (
        isinstance(start, AtForce) and start.force >= 0
    ):
        return True
    with one_blas_thread():
        try:
            groups = problem.groups()
            if too_short(groups):
                _start_of_crack(groups)
            else:
                begun(groups, contact_of(groups), Settings.for_accuracy(LOOSEST_ACCURACY))
        except InputError:
            return False
    return True


def _too_short(groups: Groups, settings: Settings) -> bool:
    """Whether the range of the forces is too short for a simulation or for its round-off."""
    if too_short(groups):
        return True
    if not_covered(groups) or groups.effective_tabor < _FINE_TABOR:
        return False
    spacing = contact_of(groups).grading(settings, 0.0).spacing
    try:
        return spacing < _DIGITS * _start_of_crack(groups)[1]
    except InputError:  # no such contact by JKR, whose range of contacts is a little smaller
        return False


def _start_of_crack(groups: Groups) -> tuple[float, float]:
    from viscotack.simulate.crack_contact.crack_problem import start_of
    from viscotack.theory.crack.contact import profile_of

    return start_of(groups, profile_of(groups.geometry))


def _by_cracks(problem: Problem | Groups, accuracy: float) -> Result:
    """Convert the result of :func:`viscotack.crack_contact` to a :class:`viscotack.Result`.

    Energies are not available; the error of the force is the band.
    """
    # only here: most simulations do without steady cracks
    from viscotack.simulate.crack_contact.by_crack import METHOD, crack_contact

    began = perf_counter()
    found = crack_contact(problem)
    outcome = Outcome.DETACHED if found.status == "detached" else Outcome.IN_CONTACT
    if not np.any(found.contact_radius > 0):
        outcome = Outcome.NEVER
    groups, radius = problem.groups(), found.contact_radius
    return Result(
        problem=problem,
        time=found.time,
        depth=found.depth,
        force=found.force,
        contact_radius=np.where(radius > 0, radius, np.nan),
        edge_speed=np.where(radius > 0, found.edge_speed, np.nan),
        status=(
            f"{outcome}; the range of the forces, a Tabor number of {groups.effective_tabor:.4g}, "
            "is too short to simulate: computed with the steady-crack contact model"
        ),
        statistics={"steps": found.time.size - 1, "wall_time_s": perf_counter() - began},
        accuracy=accuracy,
        error_estimate=None if found.pull_off_force is None else {"force": found.band},
        move=found.move,
        method=METHOD,
    )
