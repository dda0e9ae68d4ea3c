"""Newton's method for the balance of the law's tractions and those of the solid.

The elastic crack of a law is the starting point of all others.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.traction import Dugdale, Exponential, Traction, effective_range
from viscotack.theory.crack.steady._mesh import Mesh

_ITERATIONS = 30
# Tolerance of the misfit of a gap [h0].
_CLOSE = 1e-10
# Number of halvings of a step that does not reduce the misfit before it is accepted, and largest
# number of such steps.
_SHORTEST, _MOST_SHORT = 0.02, 3
# Smallest gap [h0]; a crack that would need a smaller one counts as not found.
_LEAST_GAP = 0.4
# Change of the gap over an element below which its means are evaluated at the middle.
_FLAT, _FLAT_SLOPE = 1e-6, 1e-5


class Law(NamedTuple):
    """A reduced traction law and the gap at which the crack is pinned to position 0.

    For a law that grows with the opening speed: the law at rest, its growth with its derivative,
    the speed of the crack, and the divisor of all tractions. The opening speed of an element is the
    speed of the crack times its slope, which determines the growth of its mean tension
    (:func:`slopes`).
    """

    traction: Callable[[Array], Array]
    energy: Callable[[Array], Array]
    stiffness: Callable[[Array], Array]
    pinned: float
    growing: Any = None
    speed: float = 0.0
    strength: float = 1.0

    def means(self, gap: Array, mesh: Mesh) -> tuple[Array, Array, Array, Array | None]:
        """Return the mean traction of each element, and its derivatives.

        The derivatives are by the gaps at its ends, and by its slope (None if irrelevant).
        """
        mean, first, last = self.mean(gap)
        if self.growing is None:
            return mean, first, last, None
        pull, pull_first, pull_last = self._attracting().mean(gap)
        opening = self.speed * slopes(mesh, gap)
        growth = self.growing.growth(opening)
        return (
            (mean + growth * pull) / self.strength,
            (first + growth * pull_first) / self.strength,
            (last + growth * pull_last) / self.strength,
            self.growing.growth_slope(opening) * self.speed * pull / self.strength,
        )

    def _attracting(self) -> Law:
        """Return the attractive part of the law."""
        return self._replace(
            traction=lambda gap: np.maximum(self.traction(gap), 0.0),
            energy=lambda gap: np.where(gap > 1, self.energy(gap), -1.0),
            stiffness=lambda gap: np.where(gap > 1, self.stiffness(gap), 0.0),
            growing=None,
        )

    def mean(self, gap: Array) -> tuple[Array, Array, Array]:
        """Return the mean traction of each element over its gaps, and its two derivatives.

        This is the energy difference over the gap difference, so the work of all elements is
        exactly that of the law, including steps and kinks.
        """
        change, middle = np.diff(gap), (gap[1:] + gap[:-1]) / 2
        traction, slope = self.traction(gap), self.stiffness(middle) / 2
        wide, safe = np.abs(change) > _FLAT, np.where(np.abs(change) > _FLAT, change, 1.0)
        mean = np.where(wide, np.diff(self.energy(gap)) / safe, self.traction(middle))
        steep = np.abs(change) > _FLAT_SLOPE
        first = np.where(steep, (mean - traction[:-1]) / safe, slope)
        last = np.where(steep, (traction[1:] - mean) / safe, slope)
        return mean, first, last

    def mixed(self, other: Law, part: float) -> Law:
        """Interpolate between this law and another."""

        def between(first: Any, second: Any) -> Callable[[Array], Array]:
            return lambda gap: (1 - part) * first(gap) + part * second(gap)

        return Law(
            between(self.traction, other.traction),
            between(self.energy, other.energy),
            between(self.stiffness, other.stiffness),
            (1 - part) * self.pinned + part * other.pinned,
        )


def slopes(mesh: Mesh, gap: Array) -> Array:
    """Return the slopes of the elements, averaged over the two elements around each end.

    A single element may open while its neighbours close; without averaging, a gap that oscillates
    from node to node would cause growth.
    """
    x, around = mesh.x, np.empty_like(gap)
    wide = (x[2:] - x[:-2]).reshape(-1, *(1,) * (gap.ndim - 1))
    around[1:-1] = (gap[2:] - gap[:-2]) / wide
    around[0], around[-1] = (gap[1] - gap[0]) / mesh.dx[0], (gap[-1] - gap[-2]) / mesh.dx[-1]
    return (around[1:] + around[:-1]) / 2


class System(NamedTuple):
    """The balance of a crack: kernel u = spread(mean tractions) + inflow, gap = 1 + opening u.

    u is the field minus its far part, followed by the amplitude A of the far part. ``spread`` None
    is the identity.
    """

    mesh: Mesh
    law: Law
    opening: Array
    spread: Array | None = None
    inflow: Callable[[float], Array] | None = None


class Solution(NamedTuple):
    """Converged balance: u, gaps at the nodes, mean tractions of law and solid."""

    u: Array
    gap: Array
    traction: Array
    relaxed: Array

    @property
    def amplification(self) -> float:
        """Return the energy of the far field over the work of adhesion, pi A^2/16."""
        return float(np.pi * self.u[-1] ** 2 / 16)


def solved(system: System, guess: Array) -> Solution | None:
    """Solve the balance from a guess; None if Newton's method does not converge."""
    mesh, size = system.mesh, system.mesh.x.size
    kernel = np.concatenate([mesh.kernel, mesh.far_traction[:, None]], axis=1)
    largest = np.max(np.abs(mesh.kernel), axis=1)
    matrix = np.zeros((size + 1, size + 1))
    # one gap is pinned, and the field equals its far part at the open end
    matrix[-2] = system.opening[mesh.middle]
    matrix[-1, size - 2 : size] = -1.0, 1.0
    pinned = system.law.pinned - 1

    def state(u: Array) -> tuple[Array, Array, float, Any]:
        gap = 1 + system.opening @ u
        parts = system.law.means(np.maximum(gap, _LEAST_GAP / 2), mesh)
        right = parts[0] if system.spread is None else system.spread @ parts[0]
        if system.inflow is not None:
            right = right + system.inflow(u[-1])
        misfit = np.append(kernel @ u - right, [gap[mesh.middle] - 1 - pinned, u[-2] - u[-3]])
        # measure misfits as gaps, so that a stiff wall and a soft tail have equal weights
        stiff = largest + np.abs(parts[1]) + np.abs(parts[2])
        size_of = max(np.max(np.abs(misfit[:-2]) / stiff), np.max(np.abs(misfit[-2:])))
        return gap, misfit, float(size_of), (parts, right)

    opening_slopes = slopes(mesh, system.opening) if system.law.growing is not None else None
    u, short = guess, 0
    gap, misfit, size_now, parts = state(u)
    for _ in range(_ITERATIONS):
        if size_now < _CLOSE:
            return Solution(u, gap, parts[0][0], parts[1])
        _, first, last, steeper = parts[0]
        slope = first[:, None] * system.opening[:-1] + last[:, None] * system.opening[1:]
        if steeper is not None:
            slope += steeper[:, None] * opening_slopes
        matrix[:-2] = kernel - (slope if system.spread is None else system.spread @ slope)
        try:
            step = np.linalg.solve(matrix, -misfit)
        except np.linalg.LinAlgError:
            return None
        length = 1.0
        while True:
            found = state(u + length * step)
            better = found[0].min() > _LEAST_GAP and found[2] < size_now * (1 - 0.05 * length)
            if better or length < _SHORTEST or not np.isfinite(size_now):
                break
            length /= 2
        short += length < _SHORTEST
        if short > _MOST_SHORT:
            return None
        u = u + length * step
        gap, misfit, size_now, parts = found
    return None


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
    opening = np.concatenate([np.eye(mesh.x.size), mesh.far[:, None]], axis=1)
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
