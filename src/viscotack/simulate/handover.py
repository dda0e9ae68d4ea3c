"""Use of the steady-crack contact model when the adhesion range is too short to simulate."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from viscotack.model.problem import Groups, Problem
from viscotack.model.problem.revolution import ELASTIC_TABOR, SIMULATED_TABOR
from viscotack.result import Outcome, Result
from viscotack.simulate.crack_contact.by_crack import LARGEST_TABOR, METHOD, crack_contact
from viscotack.simulate.crack_contact.crack_problem import not_covered


def too_short(groups: Groups) -> bool:
    """Whether the model replaces the simulation because the range of the forces is too short."""
    if not_covered(groups):
        return False
    least = ELASTIC_TABOR if groups.modulus_ratio >= 1 else SIMULATED_TABOR[1]
    return least < groups.effective_tabor <= LARGEST_TABOR


def answered(problem: Problem | Groups, accuracy: float) -> Result:
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
