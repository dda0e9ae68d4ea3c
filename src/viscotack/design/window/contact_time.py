"""Contacts of interfaces that age, after a dwell."""

from dataclasses import replace
from typing import Any

from viscotack.errors import InputError
from viscotack.problem import Problem
from viscotack.traction import ages


def aged(problem: Problem, dwell: float) -> Problem:
    """Return a contact with the work of adhesion that its interface has after a dwell [s].

    The law at rest is multiplied by 1 + G(t) and no longer ages, which holds for a pull much
    shorter than the dwell. An interface that does not age is returned unchanged.

    Examples
    --------
    >>> from viscotack import AtForce, Elastic, LennardJones, Retraction, Sphere
    >>> from viscotack.traction import SaturatingAgeing
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
