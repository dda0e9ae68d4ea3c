"""Choice of the method for a problem: simulation or the steady-crack contact model.

**Use of the steady-crack contact model when the adhesion range is too short to simulate.**
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from time import perf_counter

import numpy as np

from viscotack.cards import card_of
from viscotack.clock import limited
from viscotack.errors import InputError
from viscotack.model.problem import Case, Groups, Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY, LOOSEST_ACCURACY, TimeLimit
from viscotack.model.protocol import AtDepth, AtForce
from viscotack.result import Outcome, Result
from viscotack.simulate.crack_contact.by_crack import METHOD, crack_contact, too_short
from viscotack.simulate.crack_contact.crack_problem import not_covered, start_of
from viscotack.simulate.sensitivities import changed_inputs, sensitivities_of
from viscotack.simulate.settings import Settings
from viscotack.simulate.solver import Progress, Watch, begun, contact_of, part_of, simulate
from viscotack.theory.crack.contact import profile_of
from viscotack.threads import one_blas_thread

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
                start_of(groups, profile_of(groups.geometry))
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
        return spacing < _DIGITS * start_of(groups, profile_of(groups.geometry))[1]
    except InputError:  # no such contact by JKR, whose range of contacts is a little smaller
        return False


def _by_cracks(problem: Problem | Groups, accuracy: float) -> Result:
    """Convert the result of :func:`crack_contact` to a :class:`viscotack.Result`.

    Energies are not available; the error of the force is the band.
    """
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
