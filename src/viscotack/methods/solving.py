"""By which method a problem is solved: a simulation, or a contact whose edge is a steady crack."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

from threadpoolctl import threadpool_limits

from viscotack.bem.clock import limited
from viscotack.bem.settings import Settings
from viscotack.bem.solver import Progress, Watch, begun, contact_of, simulate
from viscotack.cards import card_of
from viscotack.errors import InputError
from viscotack.methods import handover
from viscotack.methods.crack_problem import largest_radius
from viscotack.problem import Case, Groups, Problem
from viscotack.problem.accuracy import DEFAULT_ACCURACY, LOOSEST_ACCURACY, TimeLimit
from viscotack.result import Result

_UNTIL = ("pull-off", "detached")
# Influences of nodes so near to each other, in parts of the contact radius, have too few digits: at
# 4e-7 a force was a fifth off. Not looked at below this effective Tabor number.
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
) -> Result:
    """Simulate the detachment of a rigid indenter from a viscoelastic solid.

    The test begins at rest, in a relaxed contact or apart, goes through the moves of its protocol,
    and ends with a retraction at a constant rate, or with the last move. Pressure and gap follow
    from the traction law and from the hereditary solid (Eq. 4.11 to 4.15 of Maghami, PhD thesis
    (2025)); mesh, steps and relaxation modes follow from the accuracy.

    Parameters
    ----------
    problem : Problem or Groups
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
    # The matrices are small: a second BLAS thread costs many times what it brings.
    with threadpool_limits(limits=1, user_api="blas"), limited(time_limit):
        groups = problem.groups()
        if _too_short(groups, chosen):
            if fields:
                raise InputError(
                    "profiles are known of simulations only, and the Tabor number of "
                    f"{groups.effective_tabor:.4g} is too large for one; ask for none"
                )
            return _handed_over(problem, chosen.accuracy, began)
        return simulate(
            problem,
            groups,
            settings=chosen,
            until=until,
            estimate_error=estimate_error,
            whole=whole,
            fields=fields,
            throw=throw,
            progress=progress,
            watch=watch,
        )


def has_start(problem: Case) -> bool:
    """Return whether the state at rest exists in which a test begins; some milliseconds.

    It is looked for at the loosest accuracy.
    """
    with threadpool_limits(limits=1, user_api="blas"):
        try:
            groups = problem.groups()
            if handover.too_short(groups):
                return handover.has_start(groups)
            begun(groups, contact_of(groups), Settings.for_accuracy(LOOSEST_ACCURACY))
        except InputError:
            return False
    return True


def _too_short(groups: Groups, settings: Settings) -> bool:
    """Return whether the range of the forces is too short for a simulation, or for its digits."""
    if handover.too_short(groups):
        return True
    if not handover.knows(groups) or groups.effective_tabor < _FINE_TABOR:
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
