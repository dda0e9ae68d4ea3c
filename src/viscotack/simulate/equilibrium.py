r"""Equilibrium of the surface at one instant: gaps at which tractions and elastic forces balance.

Let S be the stiffness of the relaxed solid, c the compliance of this instant or step, and b the gap
due to depth and loading history alone. The equilibrium gap g makes the energy

.. math:: \Pi(g) = \frac{1}{2c} (g-b)^T S\, (g-b) + \sum_i A_i\, \varphi(g_i)

stationary; :math:`\varphi` is the interface energy of the traction law. The tangent
S/c + diag(A phi'') is symmetric, and its Cholesky factor exists if and only if the state is stable.
:func:`descend` minimises this energy by Newton's method with line search. From a good initial guess
it converges on the same branch in two or three iterations, mostly with the factor of the first.
From a poor guess, or past the end of a branch, it finds the stable state that a contact without
inertia would reach.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.linalg import get_lapack_funcs

from viscotack.clock import look
from viscotack.errors import InputError
from viscotack.model.traction import Traction, effective_range
from viscotack.simulate.machine import Hold
from viscotack.simulate.surface import Band, Faces, Surface, released, room

_potrf, _potrs = get_lapack_funcs(("potrf", "potrs"), dtype=np.float64)

# Newton converges quadratically: a last change of 1e-6 of the room leaves an error near 1e-12.
_LAST_CHANGE = 1e-6
# Stiffness added to an unstable tangent, as fractions of its most negative curvature.
_STIFFER = (1e-3, 1e-2, 1e-1)
# Lower bound of that curvature, as a fraction of the largest nodal stiffness.
_SLIGHT = 1e-9
# After a last relative change x, the unbalanced fraction of the tractions may be at most
# _UNBALANCED + _CURVED x^2. A smooth law leaves less than half of that. The kinks of a piecewise
# law leave 1e-5 after a tiny change, which the energy balance would interpret as a jump.
_UNBALANCED = 1e-6
_CURVED = 30.0
# Gaps [h0] below this are closed. A law with unbounded repulsion never comes near this value. If a
# law with bounded repulsion is pressed harder than it repels, every step closes the gap further.
GONE = 1e-6
# A factor is reused in the next iteration if an undamped iteration has reduced the unbalanced
# forces below this fraction. Convergence is then linear, so the final residual is limited to this
# fraction of the tractions, about that of Newton: the energy balance depends on it in first order.
# When gaps no longer change, the last iteration computes a new factor.
_KEPT, _KEPT_LEAVES = 0.1, 1e-8
# Largest relative closing of a node per iteration; the repulsion diverges beyond.
_LARGEST_CLOSING = 0.3


@dataclass(frozen=True, eq=False)
class Balance:
    """Equilibrium gap and depth, the number of iterations, and whether the state is stable.

    `faces` is the interface at these gaps. `released` is true if a dead load has pulled the
    surfaces apart, so that no equilibrium exists.
    """

    gap: npt.NDArray
    faces: Faces
    depth: float
    iterations: int
    stable: bool
    released: bool = False


@dataclass(frozen=True, eq=False)
class Elastic:
    """Elastic energy of solid and machine, v M v/2 + f v, with v the gap minus the free gap.

    A rigid machine fixes the depth. With a spring, the depth minimises the energy,
    delta = (P - s v)/(K + k) with s = S 1/c and K = 1 S 1/c. Eliminating it gives a matrix M that
    is S/c minus a matrix of rank one.
    """

    matrix: npt.NDArray
    linear: npt.NDArray | float
    free: npt.NDArray
    hold: Hold
    pushed: npt.NDArray | None
    softness: float

    @classmethod
    def of(cls, surface: Surface, compliance: float, free_gap: npt.NDArray, hold: Hold) -> Elastic:
        """Return the energy for a compliance of the solid and a gap without load."""
        stiffness = surface.stiffness / compliance
        if hold.rigid:
            return cls(stiffness, 0.0, free_gap - hold.depth, hold, None, 0.0)
        s = stiffness.sum(axis=1)
        softness = 1 / (float(s.sum()) + hold.stiffness)
        matrix = stiffness - softness * np.outer(s, s)
        return cls(matrix, softness * hold.load * s, free_gap, hold, s, softness)

    def depth(self, gap: npt.NDArray) -> float:
        """Return the depth [h0] at which the machine is in equilibrium with a gap."""
        if self.pushed is None:
            return self.hold.depth
        return self.softness * (self.hold.load - float(self.pushed @ (gap - self.free)))

    def at(self, gap: npt.NDArray) -> tuple[float, npt.NDArray]:
        """Return the energy and its gradient."""
        v = gap - self.free
        Mv = self.matrix @ v
        if self.pushed is None:
            return 0.5 * float(v @ Mv), Mv
        return 0.5 * float(v @ Mv) + float(self.linear @ v), Mv + self.linear  # type: ignore[operator]


def solved(factor: Any, right: npt.NDArray) -> npt.NDArray:
    """Solve a linear system with a factored tangent."""
    return _potrs(factor, right, lower=1)[0]


def factored(stiffness: npt.NDArray, curvature: Band) -> npt.NDArray | None:
    """Return the Cholesky factor of stiffness + curvature, None if not positive definite."""
    tangent, next_diagonal = stiffness.copy(), len(stiffness) + 1
    entries = tangent.reshape(-1)
    entries[::next_diagonal] += curvature.diagonal
    if curvature.beside is not None:  # only the upper half is used
        entries[1::next_diagonal] += curvature.beside
    # LAPACK uses column order, so the upper half here is its lower half
    factor, info = _potrf(tangent.T, lower=1, overwrite_a=1, clean=0)
    return None if info else factor


def _stiffened(stiffness: npt.NDArray, curvature: Band):
    """Return the factor of a tangent with just enough added stiffness to be positive definite.

    The smallest sufficient stiffness is used, because the added stiffness limits how far a step
    moves along the unstable direction.
    """
    # outside the range of a law the curvature is zero; under a dead load nothing else resists
    diagonal, beside = curvature
    softest = max(-float(np.min(diagonal)), _SLIGHT * float(np.max(np.diag(stiffness))))
    for share in _STIFFER:
        factor = factored(stiffness, Band(diagonal + share * softest, beside))
        if factor is not None:
            return factor
    factor = factored(stiffness, Band(np.maximum(diagonal, 0.0)))
    # under a dead load the solid alone does not resist every displacement
    return factored(stiffness, Band(diagonal + 1.1 * softest)) if factor is None else factor


def descend(
    surface: Surface,
    law: Traction,
    free_gap: npt.NDArray,
    compliance: float,
    guess: npt.NDArray,
    hold: Hold,
    *,
    least_gain: float = 0.0,
    largest_gain: float = np.inf,
    most_iterations: int = 500,
) -> Balance:
    """Minimise the energy from an initial guess and return the stable equilibrium.

    The free gap is the gap at depth zero. If the tangent is not positive definite, stiffness is
    added so that the search direction remains downhill; the line search uses the energy. The
    iteration ends when the gaps no longer change, or when an iteration reduces the energy by less
    than the fraction `least_gain` and than `largest_gain` [nodal force times h0]. At large Tabor
    numbers the energy depends very little on the edge position, and without `least_gain` the
    iteration would continue along that flat valley. If the iterations run out, the returned balance
    is marked as not stable.
    """
    solid = Elastic.of(surface, compliance, free_gap, hold)
    face, gap, span = surface.interface, guess, effective_range(law)
    elastic, pull = solid.at(gap)
    faces = face.at(law, gap)
    energy = elastic + faces.energy
    # Scale of the round-off of the two sums, which dominates the slope near the minimum.
    size = abs(elastic) + abs(faces.energy)
    residual = pull + faces.tension
    left, factor, stable, kept = float(np.abs(residual).sum()), None, False, False
    for iteration in range(1, most_iterations + 1):
        look()
        if factor is None:
            curvature = faces.tangent()
            factor = factored(solid.matrix, curvature)
            stable = factor is not None
            if factor is None:
                factor = _stiffened(solid.matrix, curvature)
        change = -solved(factor, residual)
        slope, relative = float(residual @ change), change / room(gap, span)
        closing = -float(relative.min())
        largest = max(closing, float(relative.max()))
        part = min(1.0, _LARGEST_CLOSING / closing) if closing > 0 else 1.0
        while True:
            trial = gap + part * change
            elastic, pull = solid.at(trial)
            faces = face.at(law, trial)
            trial_energy = elastic + faces.energy
            if trial_energy <= energy + 1e-4 * part * slope + 1e-12 * size or part < 1e-6:
                break
            part *= 0.5
        last = stable and largest < _LAST_CHANGE
        if last and part < 1.0 and (iteration == most_iterations or np.array_equal(trial, gap)):
            # Such a small change of a stable state reduces the energy by less than its round-off:
            # with a soft spring, large terms cancel in the sums. The line search would reject it
            # in every iteration, so the change is accepted without it.
            gap = gap + change
            return Balance(gap, face.at(law, gap), solid.depth(gap), iteration, True)
        gap, energy, residual = trial, trial_energy, pull + faces.tension
        before, left = left, float(np.abs(residual).sum())
        whole = stable and part == 1.0
        # limit: the residual that a smooth law leaves after such a change
        most = _KEPT_LEAVES if kept else _UNBALANCED + _CURVED * largest**2
        balanced = left < most * float(np.abs(faces.tension).sum())
        little = -slope < min(least_gain * size, largest_gain)
        if whole and ((last and not kept) or (little and balanced)):
            return Balance(gap, faces, solid.depth(gap), iteration, True)
        smallest = int(gap.argmin())
        if gap[smallest] < GONE:
            return Balance(gap, faces, solid.depth(gap), iteration, False)
        opens = change[smallest] > 0  # a growing load closes the gap from here
        if hold.stiffness == 0 and opens and released(gap, span):
            return Balance(gap, faces, solid.depth(gap), iteration, False, released=True)
        kept = whole and not last and left < _KEPT * before
        if not kept:
            factor = None
    return Balance(gap, faces, solid.depth(gap), most_iterations, False)


class ClosedGap(InputError):
    """Surfaces are pressed together harder than the traction law can repel.

    The repulsion of a law may be finite at zero gap (exponential, Dugdale, tabulated). A larger
    pressure closes the gap to 0, where the law ends: the reason is not missing adhesion.
    """


def pressed_shut(surface: Surface, gap: npt.NDArray, relaxed: npt.NDArray) -> float:
    """Return the pressure [dg/h0] where the gap is closed completely, 0 if it is open.

    Parameters
    ----------
    surface : Surface
        The surface.
    gap : ndarray, shape (N,)
        Gap at the end of a search without equilibrium [h0].
    relaxed : ndarray, shape (N,)
        Displacement of the relaxed solid under this pressure [h0].
    """
    gone = gap < GONE
    if not gone.any():
        return 0.0
    return float(np.max((surface.stiffness @ relaxed / surface.area)[gone]))


def why(law: Traction, pressure: float) -> str:
    """Return the explanation for the error message."""
    most = -float(law.traction(GONE * law.equilibrium_gap))
    return (
        f"the contact presses with up to {pressure:.4g} dg0/h0, and the traction law repels with "
        f"{most:.4g} dg0/h0 at most, at a gap of 0, where it ends; press less, or take a law that "
        "repels more strongly, such as lennard-jones or one of shorter range"
    )


def check_open(surface: Surface, law: Traction, gap: npt.NDArray, depth: float, of: str) -> None:
    """Raise `ClosedGap` if the search for a relaxed contact has closed the gap."""
    if pressure := pressed_shut(surface, gap, gap - surface.rigid_gap + depth):
        raise ClosedGap(
            f"no relaxed contact exists at a depth of {depth:g} h0 ({of}): {why(law, pressure)}"
        )
