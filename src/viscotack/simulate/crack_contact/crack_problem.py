"""Conversion of a problem to the units and arguments of the steady-crack contact theory.

Lengths along the surface are in beta, heights in beta^2/R, forces in R dg, times in the time unit
of the material, as in :mod:`viscotack.theory.crack.contact`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from viscotack.errors import OutOfRange
from viscotack.model.problem import Groups, Problem
from viscotack.model.protocol import (
    Apart,
    Approach,
    AtDepth,
    AtForce,
    AtRadius,
    Dwell,
    LoadTo,
    MoveTo,
    Retract,
    end_of,
)
from viscotack.simulate.crack_contact import not_covered
from viscotack.theory import lennard_jones
from viscotack.theory.crack.contact import Drive, Profile, radius_at_depth, radius_at_force

# R dg in 1.5 pi R dg, and beta in (pi R^2 dg/E0*)^(1/3).
LOAD, ROOT = 1.5 * np.pi, np.pi ** (1 / 3)


def groups_of(problem: Any) -> Groups:
    """Dimensionless groups of a problem; OutOfRange if the theory does not cover it."""
    if not isinstance(problem, Problem | Groups):
        raise TypeError(
            f"crack_contact needs a Problem or Groups, got {problem!r}; for a file use "
            "viscotack.read_case(path)"
        )
    groups = problem.groups()
    if reason := not_covered(groups):
        cure = "" if groups.in_plane_strain else "; use `viscotack simulate`"
        raise OutOfRange(f"the steady-crack contact model covers {reason}{cure}")
    return groups


def start_of(groups: Groups, profile: Profile) -> tuple[float, float]:
    """Contact radius at the start (0 if apart) and largest radius of the history [beta]."""
    states: list[Any] = [] if isinstance(groups.start, Apart) else [groups.start]
    for move in groups.moves:
        pressed = isinstance(move, MoveTo | LoadTo) and end_of(move).value > 0  # type: ignore[union-attr]
        if isinstance(move, Approach) or pressed:
            states.append(end_of(move))
    radii = [_relaxed_radius(state, groups, profile) for state in states]
    if isinstance(groups.start, Apart):
        return 0.0, max([1.0, *radii])
    return radii[0], max(1.0, *radii) if len(radii) > 1 else radii[0]


def _relaxed_radius(state: Any, groups: Groups, profile: Profile) -> float:
    match state:
        case AtDepth():
            return radius_at_depth(profile, state.depth / groups.tabor)
        case AtForce():
            # the short-range limit of this tension is larger by the pull-off ratio
            left = float(lennard_jones.pull_off_ratio(groups.effective_tabor))
            short = state.force / left if state.force < 0 else state.force
            return radius_at_force(profile, short * LOAD)
        case AtRadius():
            return state.contact_radius * ROOT
    raise AssertionError(state)


def drives_of(groups: Groups) -> tuple[Drive, ...]:
    """Return the moves of the machine in the units of the theory."""
    unit, mu = groups.material.time_unit, groups.tabor
    drives = []
    for move in groups.moves:
        match move:
            case Approach():
                drives.append(Drive("drive", move.speed * unit / mu, np.inf, _end(move.to, mu)))
            case Retract():
                drives.append(Drive("drive", -move.speed * unit / mu, np.inf, _end(move.to, mu)))
            case MoveTo():
                target = move.depth / mu
                drives.append(Drive("drive", 0.0, move.duration / unit, target=target))
            case LoadTo():
                target = move.force * LOAD
                drives.append(Drive("force", 0.0, move.duration / unit, target=target))
            case Dwell():
                drives.append(Drive(move.hold, 0.0, move.duration / unit))
    if groups.rate is not None:
        drives.append(Drive("drive", -groups.rate * unit / mu, np.inf))
    return tuple(drives)


def _end(state: Any, tabor: float) -> tuple[str, float]:
    match state:
        case AtDepth():
            return "depth", state.depth / tabor
        case AtForce():
            return "force", state.force * LOAD
        case AtRadius():
            return "radius", state.contact_radius * ROOT
    raise AssertionError(state)
