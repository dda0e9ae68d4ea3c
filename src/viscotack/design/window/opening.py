"""Which of two contacts in series opens: by steady cracks, and by simulation where undecided."""

from __future__ import annotations

from dataclasses import replace
from math import isnan
from typing import Any

from viscotack.errors import InputError, OutOfRange
from viscotack.model.problem import Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.model.protocol import AtForce
from viscotack.model.traction import ages
from viscotack.simulate.in_series import SIMULATION, SeriesOpening, opening_by_cracks

from .simulated import simulate_in_series


def which_opens(
    first: Problem,
    second: Problem,
    *,
    simulate: bool = False,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
) -> SeriesOpening:
    """Return which of two contacts in series opens first when one machine pulls them apart.

    Parameters
    ----------
    first, second : Problem
        Both contacts of the rigid object, in SI, with equal protocols: a relaxed start at a force
        (:class:`viscotack.AtForce`), a speed of the drive, and perhaps the stiffness of the
        machine. Each has its own shape, body, material and law.
    simulate : bool
        Simulate both contacts in one march if steady cracks do not decide.
    accuracy, time_limit : float
        Of the simulation, as for :func:`viscotack.solve`.

    Returns
    -------
    SeriesOpening
        The contact that opens, or None with the reason.

    Raises
    ------
    ValueError
        If the protocols differ or are of another kind, a shape is not one of revolution, or a
        contact has no relaxed start under the common force.

    Examples
    --------
    An elastic donor against an elastic stamp: the smaller pull-off force decides.

    >>> from viscotack import AtForce, Elastic, LennardJones, Problem, Retraction, Sphere
    >>> from dataclasses import replace
    >>> donor = Problem(
    ...     material=Elastic(rubbery_modulus=2e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-7),
    ...     geometry=Sphere(radius=1e-3),
    ...     protocol=Retraction(start=AtForce(1e-4), speed=1e-5),
    ... )
    >>> stamp = replace(donor, geometry=Sphere(radius=2e-3))
    >>> found = which_opens(donor, stamp)
    >>> found.opened, f"{found.tension * 1e6:.0f} uN"
    (0, '238 uN')
    """
    check_pair(first, second)
    try:
        found = opening_by_cracks(first, second)
    except OutOfRange as reason:
        found = SeriesOpening(why=str(reason))
    if found.opened is not None or not simulate:
        return found
    try:
        result = simulate_in_series(first, second, accuracy=accuracy, time_limit=time_limit)
    except OutOfRange as reason:
        return SeriesOpening(method=SIMULATION, why=f"{found.why}; {reason}")
    opened, held = result.opened, result.held
    return SeriesOpening(
        opened,
        result.tension,
        None if isnan(held) else held,
        nominal=opened,
        corners=(opened, opened),
        method=SIMULATION,
        why=found.why
        if opened is not None
        else f"both contacts open together, or the run stopped: {result.status}",
    )


def check_pair(first: Problem, second: Problem) -> None:
    """Raise an InputError unless two problems are contacts of one object in a machine."""
    for problem in (first, second):
        if problem.geometry.symmetry != "revolution":
            raise InputError(
                f"two contacts in series need shapes of revolution, got a {problem.geometry.word} "
                "in plane strain, whose force is per length; take a disc"
            )
        test = problem.protocol
        if not isinstance(test.start, AtForce) or test.moves or test.speed is None:
            raise InputError(
                "two contacts in series start relaxed at a common force and are pulled apart at a "
                "speed, without other moves; take Retraction(start=AtForce(force), speed=speed)"
            )
    if first.protocol != second.protocol:
        raise InputError(
            "both contacts of an object need the same protocol, got "
            f"{first.protocol} and {second.protocol}"
        )


def aged(problem: Problem, dwell: float) -> Problem:
    """Return a contact with the work of adhesion that its interface has after a dwell [s].

    The law at rest is multiplied by 1 + G(t) and no longer ages, which holds for a pull much
    shorter than the dwell. An interface that does not age is returned unchanged.

    Examples
    --------
    >>> from viscotack import AtForce, Elastic, LennardJones, Retraction, Sphere
    >>> from viscotack.model.traction import SaturatingAgeing
    >>> law = SaturatingAgeing(0.05, 1e-7, reference_time=10.0, largest_growth=2.0)
    >>> rubber = Elastic(rubbery_modulus=1e6, poisson_ratio=0.5)
    >>> contact = Problem(rubber, law, Sphere(1e-3), Retraction(AtForce(1e-3), 1e-5))
    >>> aged(contact, 1e3).traction
    LennardJones(work_of_adhesion=0.15000000000000002, equilibrium_gap=1e-07)
    """
    if not dwell >= 0:
        raise InputError(f"a dwell must not be negative, got {dwell:.4g} s")
    law: Any = problem.traction
    if not ages(law):
        return problem
    work = law.work_of_adhesion * (1 + float(law.growth_after(dwell)))
    return replace(problem, traction=replace(law.at_rest, work_of_adhesion=work))
