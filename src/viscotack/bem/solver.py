"""From a problem to a result: the one entry point of the simulation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from viscotack.bem import handover
from viscotack.bem.books import History, Snapshot
from viscotack.bem.bounds import check_bounds, check_clock, check_held
from viscotack.bem.clock import TimeUp, limited, met
from viscotack.bem.contacts.contact import Contact, Relaxed
from viscotack.bem.contacts.profile import ProfileContact
from viscotack.bem.contacts.punch import PunchContact
from viscotack.bem.contacts.shape import ShapeContact
from viscotack.bem.contacts.sphere import SphereContact
from viscotack.bem.crack_problem import largest_radius
from viscotack.bem.estimate import COARSER, estimated
from viscotack.bem.interface import resolved
from viscotack.bem.legs import legs_of, longest_time, reached, spring_travel
from viscotack.bem.machine import Leg, spring_energy
from viscotack.bem.march import march
from viscotack.bem.preload import Beginning, shallower
from viscotack.bem.settings import Settings
from viscotack.bem.verdict import judged, out_of_time, status_of
from viscotack.cards import card_of
from viscotack.errors import InputError
from viscotack.geometry import Cone, PowerLawProfile, Sphere
from viscotack.materials import Material, Modes
from viscotack.problem import Case, Groups, Problem, PunchGroups
from viscotack.problem.accuracy import DEFAULT_ACCURACY, LOOSEST_ACCURACY, TimeLimit
from viscotack.problem.revolution import SIMULATED_TABOR
from viscotack.protocol import AtDepth
from viscotack.result import Energies, Outcome, Result, receding_speed
from viscotack.result.observables import peaks
from viscotack.traction import effective_range, grows

# Is told the done share of the work.
Progress = Callable[[float], None] | None
# Is told time, depth, force and contact radius of each step, as a `Result` has them.
Watch = Callable[[float, float, float, float], None] | None

_UNTIL = ("pull-off", "detached")
# Modes that are faster than this part of the first step are instantaneous for all purposes.
_FASTEST = 0.2
# Influences of nodes so near to each other, in parts of the contact radius, have too few digits: at
# 4e-7 a force was a fifth off. Not looked at below this effective Tabor number.
_DIGITS, _FINE_TABOR = 6e-7, 20.0
# Share of the work in a run that has one.
_MAIN = 0.8


class SimulationError(RuntimeError):
    """A simulation that stopped before its end; `result` holds what there is, and the reason."""

    def __init__(self, result: Result) -> None:
        super().__init__(result.status)
        self.result = result

    def __reduce__(self) -> tuple[type[SimulationError], tuple[Result]]:
        """Say how to make it again in another process: from its result, not from its words."""
        return type(self), (self.result,)


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
) -> Result:
    """Simulate the detachment of a rigid indenter from a viscoelastic solid.

    The test begins at rest, in a relaxed contact or apart, goes through the moves of its protocol,
    and ends with a retraction at a constant rate, or with the last move. Pressure and gap follow
    from the traction law and from the hereditary solid (Eq. 4.11 to 4.15 of Maghami, PhD thesis
    (2025)); mesh, steps and relaxation modes follow from the accuracy.

    Parameters
    ----------
    problem : Problem, Groups or PunchGroups
        What is tested, in SI or in dimensionless groups.
    accuracy : float
        Wanted relative error of the pull-off force, from 1e-6 to 0.02; the work to pull-off, whose
        end is a flat minimum, has up to five times this error.
    until : {"detached", "pull-off"}
        Run until the surfaces are apart, or only until no later tension can exceed the largest one
        so far, mostly just past the first force minimum (faster; the work of separation is then not
        known).
    settings : Settings, optional
        Mesh, steps and modes for experts, in place of those that follow from `accuracy`.
    estimate_error : bool
        Also run a coarser companion and state the errors of force, work and depth at pull-off from
        the difference. A run whose force is known ten times worse than asked for is stopped as
        unresolved.
    whole : bool
        March the whole retraction from the start that is asked for, however deep. Else one from
        more than 1000 h0, by sphere, cone or power-law tip and without moves before it, begins
        where light marches tell that the depth no longer matters
        (:mod:`viscotack.bem.preload`); ``result.shallow_start`` says where.
    fields : bool
        Keep the profiles of pressure and gap at every step.
    throw : bool
        Raise when the run stops before its end; else the result's status says so.
    progress : callable, optional
        Called after every step with the done share of the way, from 0 to 1, that of the coarser
        companion being the last part.
    watch : callable, optional
        Called after every step of the run itself with its time, depth, force and contact radius,
        dimensionless as the series of a result: a curve to be drawn while it grows. What it raises
        ends the run and is raised here.
    time_limit : float, optional
        Longest time [s] for the run and its companion. A run that meets it is stopped: it keeps
        what there is, and its status says so.

    Returns
    -------
    Result
        Dimensionless series, status, events, energies, error estimate and statistics.

    Raises
    ------
    ValueError
        If the relaxed start does not exist, or is not found within the time limit; if it is too
        deep to be marched and none that is shallower gives the same answer; if an argument, or a
        number of the problem, is out of range.
    SimulationError
        If the run stops before its end, unless throw is False.

    Notes
    -----
    Beyond Tabor numbers of 200, elastic solids of 30, a contact whose edge is a steady crack is
    the answer (:func:`crack_contact`), and the result says so: its `method`, its status, and its
    band for the error of the force. So where nodes would be nearer to each other than digits
    tell, in a large contact or at a high accuracy.

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
    if until not in _UNTIL:
        raise InputError(f"until must be one of {', '.join(map(repr, _UNTIL))}, got {until!r}")
    began = perf_counter()
    chosen = Settings.for_accuracy(accuracy) if settings is None else settings
    if time_limit is not None:
        time_limit = card_of(TimeLimit).checked("time_limit", time_limit)
    share = _MAIN if estimate_error else 1.0
    # The matrices are small: a second BLAS thread costs many times what it brings.
    with threadpool_limits(limits=1, user_api="blas"), limited(time_limit):
        groups = problem.groups()
        if isinstance(groups, Groups) and _too_short(groups, chosen):
            if fields:
                raise InputError(
                    "profiles are known of simulations only, and the Tabor number of "
                    f"{groups.effective_tabor:.4g} is too large for one; ask for none"
                )
            assert not isinstance(problem, PunchGroups)
            return _handed_over(problem, chosen.accuracy, began)
        contact = contact_of(groups)
        check_bounds(problem, groups, contact)

        def light(
            marched: Groups | PunchGroups, seen: Progress = None, *, whole: bool = False
        ) -> Result:
            # after moves the force may have a minimum before the pull-off: one end for both then
            end = until if groups.moves else "detached" if whole else "pull-off"
            return _run(problem, marched, chosen.coarser(COARSER), end, False, seen)

        try:
            beginning = None if whole else _beginning(groups, contact, chosen, light)
            marched = groups if beginning is None else _from(groups, beginning.start.depth)
            result = _run(
                problem, marched, chosen, until, fields, _part(progress, 0.0, share), watch
            )
        except TimeUp as limit:
            raise InputError(
                f"{limit} before the relaxed start was found; give more time, or ask for less "
                "accuracy"
            ) from None
        if estimate_error and result.outcome is not Outcome.STOPPED:
            result = estimated(
                result,
                lambda: light(groups, _part(progress, share, 1.0), whole=len(peaks(result)) > 1),
                beginning,
                contact.travel,
                chosen.accuracy,
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


def _too_short(groups: Groups, settings: Settings) -> bool:
    """Return whether the range of the forces is too short for a simulation, or for its digits."""
    if handover.too_short(groups):
        return True
    if groups.effective_tabor < _FINE_TABOR:
        return False
    spacing = contact_of(groups).grading(settings, 0.0).spacing
    try:
        return spacing < _DIGITS * largest_radius(groups)
    except InputError:  # there is no such contact by JKR, which ends a little sooner
        return False


def _handed_over(problem: Problem | Groups, accuracy: float, began: float) -> Result:
    """Return the answer of the theory for forces of too short a range."""
    result = handover.answered(problem)
    cost = dict(result.statistics) | {"wall_time_s": perf_counter() - began}
    return replace(result, accuracy=accuracy, statistics=cost)


def _part(progress: Progress, begin: float, end: float) -> Progress:
    """Return what reports the progress of a part of the work, which never falls."""
    if progress is None:
        return None
    reached = begin

    def tell(done: float) -> None:
        # behind a soft spring the contact may jump ahead of the way that is left
        nonlocal reached
        reached = max(reached, begin + (end - begin) * done)
        progress(reached)

    return tell


def has_start(problem: Case) -> bool:
    """Return whether the state at rest exists in which a test begins; some milliseconds.

    It is looked for at the loosest accuracy.
    """
    with threadpool_limits(limits=1, user_api="blas"):
        try:
            groups = problem.groups()
            if isinstance(groups, Groups) and handover.too_short(groups):
                return handover.has_start(groups)
            _begun(groups, contact_of(groups), Settings.for_accuracy(LOOSEST_ACCURACY))
        except InputError:
            return False
    return True


def _run(
    problem: Case,
    groups: Groups | PunchGroups,
    settings: Settings,
    until: str,
    fields: bool,
    progress: Progress,
    watch: Watch = None,
) -> Result:
    contact = contact_of(groups)
    start, legs = _begun(groups, contact, settings)
    depths = reached(start, groups.moves, contact)
    check_clock(legs, groups.moves, depths, contact)
    k = groups.material.modulus_ratio
    spring = spring_travel(start, depths, groups.moves, groups.stiffness, k, contact)
    longest = longest_time(depths, groups.moves, groups.rate, contact, spring)
    modes = _modes(groups.material, legs, longest, settings)
    grading = contact.grading(settings, max(depths))
    if not modes.weights:
        grading = replace(grading, scar_half_width=0.0)

    def seen(step: Snapshot) -> None:
        if watch is not None:
            watch(step.time, step.depth, step.force, step.edge / contact.edge_unit)

    history = march(
        contact,
        start,
        modes,
        legs,
        grading,
        settings,
        until=until,
        stiffness=groups.stiffness,
        growing=groups.traction if grows(groups.traction) else None,
        profiles=fields,
        progress=progress,
        watch=None if watch is None else seen,
    )
    result = _result(problem, groups, contact, history, modes, fields)
    return replace(result, accuracy=settings.accuracy).posed(groups)


def _begun(
    groups: Groups | PunchGroups, contact: Contact, settings: Settings
) -> tuple[Relaxed, tuple[Leg, ...]]:
    """Return the relaxed state in which a test begins, and its legs: the first one holds it."""
    start = contact.relaxed(groups.start, settings)
    legs = legs_of(groups.moves, groups.rate, groups.stiffness, contact, settings)
    check_held(start, contact, legs[0])
    return start, legs


def contact_of(groups: Groups | PunchGroups) -> Contact:
    """Return the contact that dimensionless groups describe, its law being the one at rest."""
    law = _at_rest(groups.traction)
    if isinstance(groups, PunchGroups):
        return PunchContact(groups.size, groups.thickness, groups.base, law)
    low, high = SIMULATED_TABOR
    if not low <= groups.effective_tabor <= high:
        span = effective_range(groups.traction)
        over = "" if span == 1 else f" over the range of the traction law ({span:.3g} h0)"
        raise InputError(
            f"the Tabor number{over} must be between {low:g} and {high:g} for a simulation, got "
            f"{groups.effective_tabor:.4g}; below take theory.bradley, above theory.jkr"
        )
    match groups.geometry:
        case Sphere():
            return SphereContact(groups.tabor, law)
        case Cone() | PowerLawProfile():
            return ProfileContact(groups.tabor, law, groups.geometry.exponent)
        case shape:
            return ShapeContact(groups.tabor, law, shape)


def _at_rest(law: Any) -> Any:
    """Return a law of the gap: of one that grows that at rest, which nodes must be able to follow.

    Speeds are known at nodes, and not between them.
    """
    if not grows(law):
        return law
    if not resolved(law.base):
        raise InputError(
            "the law at rest of one that grows with the opening speed must be smooth enough for "
            f"nodes, and {law.base} falls too steeply; take a wider fall (dugdale: rise 0.3, fall "
            "1), or lennard-jones"
        )
    return law.base


def _modes(material: Material, legs: tuple[Leg, ...], longest: float, settings: Settings) -> Modes:
    """Return the retardation modes that this run can tell apart."""
    shortest = _FASTEST * min(leg.least_step for leg in legs)
    # Relative to the compliance at the shortest time: where k is tiny, that is tiny as well.
    compliance = float(material.creep(shortest))
    return material.retardation_modes(
        shortest=shortest, longest=longest, tolerance=settings.mode_tolerance * compliance
    )


def _result(
    problem: Case,
    groups: Groups | PunchGroups,
    contact: Contact,
    history: History,
    modes: Modes,
    fields: bool,
) -> Result:
    states, books = history.snapshots, history.books
    force = np.array([s.force for s in states])
    spring = spring_energy(force, groups.stiffness)
    time = np.array([s.time for s in states])
    edge = np.array([s.edge for s in states])
    heat = np.array([b.heat for b in books])
    residual = float(np.max(np.abs(history.imbalances())))
    return Result(
        problem=problem,
        time=time,
        depth=np.array([s.depth for s in states]),
        force=force,
        contact_radius=edge / contact.edge_unit,
        edge_speed=receding_speed(time, edge),
        status=status_of(history, residual, contact.law),
        events=tuple(history.events),
        statistics={
            "steps": len(states) - 1,
            "newton_iterations": history.iterations,
            "rejected_steps": history.rejected,
            "meshes": history.meshes,
            "nodes": history.nodes,
            "modes": len(modes.weights),
        },
        energy=Energies(
            drive=np.array([b.work for b in books]) + (spring - spring[0]),
            elastic=np.array([s.elastic for s in states]),
            interface=np.array([s.interface for s in states]),
            spring=spring,
            heat=heat.sum(axis=1),
            jumps=np.array([b.jumps for b in books]),
            transfer=np.array([b.transfer for b in books]),
            interface_heat=np.array([b.interface for b in books]),
            mode_time=np.array(modes.times),
            mode_heat=heat[-1],
            mode_weight=np.array(modes.weights),
        ),
        energy_residual=residual,
        fields=_fields(history, contact, time) if fields else None,
        move=np.array(history.legs),
    )


def _fields(history: History, contact: Contact, time: np.ndarray) -> dict[str, np.ndarray]:
    """Return the profiles, padded with nan to the longest mesh; radius in the outputs' unit."""
    longest = max(len(p.gap) for p in history.profiles)

    def padded(values: np.ndarray) -> np.ndarray:
        return np.concatenate([values, np.full(longest - len(values), np.nan)])

    return {
        "time": time,
        "radius": np.array([padded(p.position / contact.edge_unit) for p in history.profiles]),
        "gap": np.array([padded(p.gap) for p in history.profiles]),
        "pressure": np.array([padded(p.pressure) for p in history.profiles]),
    }


def _beginning(
    groups: Groups | PunchGroups,
    contact: Contact,
    settings: Settings,
    light: Callable[[Groups | PunchGroups], Result],
) -> Beginning | None:
    """Return where the march begins instead of at a start that is too deep; None for the start."""
    return shallower(groups, contact, settings, lambda depth: light(_from(groups, depth)))


def _from(groups: Groups | PunchGroups, depth: float) -> Groups | PunchGroups:
    """Return the test from a relaxed contact at this depth [h0]."""
    return replace(groups, start=AtDepth(depth))
