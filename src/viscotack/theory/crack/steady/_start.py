"""Elastic crack of a law, the starting point of all other cracks."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.traction import Dugdale, Exponential, Traction, effective_range

from ._balance import Law, Solution, System, solved
from ._mesh import Mesh

# Smallest rise and fall of Dugdale's law [h0] for which Newton's method converges.
LEAST_RISE, LEAST_FALL = 0.02, 0.5
_SOFT_RISE, _SOFT_FALL, _HARDER = 0.2, 1.0, 1.5
# First and smallest fraction of the continuation from one law to another.
_FIRST_PART, _LEAST_PART = 0.25, 1e-3
# Amplitude of the elastic crack, and width of its guess over its length.
_AMPLITUDE, _WIDTH = 4 / np.sqrt(np.pi), 0.5
_FARTHEST_GAP = 1e6


def softened(traction: Any) -> Any:
    """Return the law, with rise and fall of Dugdale's law limited for convergence."""
    if not isinstance(traction, Dugdale):
        return traction
    rise, fall = max(traction.rise, LEAST_RISE), max(traction.fall, LEAST_FALL)
    return replace(traction, rise=rise, fall=fall)


def pinned(traction: Traction) -> Law:
    """Return a reduced law for the crack, pinned where half of the work is done."""

    def half_left(gap: float) -> float:
        return float(traction.energy(gap)) + 0.5

    gap = scipy.optimize.brentq(half_left, 1.0, _FARTHEST_GAP)
    return Law(traction.traction, traction.energy, traction.stiffness, float(gap))  # type: ignore[arg-type]


def elastic(traction: Traction, mesh: Mesh) -> Solution:
    """Compute the elastic crack of a reduced law.

    Raises
    ------
    ValueError
        If there is no convergence, because the law is too steep for the mesh.
    """
    decay = effective_range(traction) / effective_range(Exponential(1.0, 1.0, 1.0))
    known = pinned(Exponential(1.0, 1.0, decay))
    opening = _identity(mesh)
    found = solved(System(mesh, known, opening), _guess(mesh, known))
    for law in (pinned(stage) for stage in _stages(traction)):
        done, part = 0.0, _FIRST_PART
        while done < 1 and found is not None:
            aim = min(1.0, done + part)
            next_one = solved(System(mesh, known.mixed(law, aim), opening), found.u)
            if next_one is None:
                part /= 2
                found = found if part > _LEAST_PART else None
            else:
                found, done, part = next_one, aim, 2 * part
        known = law
    if found is None:
        raise InputError(
            f"no steady crack was found for the law {traction}, because its traction is too steep "
            "for its range; smooth it, or simulate the contact"
        )
    return found


def _stages(traction: Any) -> list[Any]:
    """Return softer laws that lead to a stiff law, which is the last one."""
    if not isinstance(traction, Dugdale):
        return [traction]
    rise, fall = _SOFT_RISE, _SOFT_FALL
    stages = []
    while rise > traction.rise or fall > traction.fall:
        rise, fall = max(rise, traction.rise), max(fall, traction.fall)
        stages.append(replace(traction, rise=rise, fall=fall))
        rise, fall = rise / _HARDER, fall / _HARDER**0.5
    return [*stages, traction]


def _guess(mesh: Mesh, law: Law) -> Array:
    """Return the far field, with its tip at the pinned gap."""
    real, width = (law.pinned - 1) / _AMPLITUDE, _WIDTH * mesh.width
    imaginary = width / (2 * real)
    z = mesh.x + real**2 - imaginary**2 + 1j * width
    return np.append(_AMPLITUDE * (np.real(np.sqrt(z)) - mesh.far), _AMPLITUDE)


def _identity(mesh: Mesh) -> Array:
    return np.concatenate([np.eye(mesh.x.size), mesh.far[:, None]], axis=1)
