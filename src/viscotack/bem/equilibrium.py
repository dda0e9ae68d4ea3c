r"""Balance of the surface at one instant: gaps at which tractions and displacements agree.

With the stiffness S of the relaxed solid, the compliance c of this instant or step and the gap b
that the drive and the past alone would leave, the gap g makes the energy

.. math:: \Pi(g) = \frac{1}{2c} (g-b)^T S\, (g-b) + \sum_i A_i\, \varphi(g_i)

stationary; :math:`\varphi` is the interface energy of the traction law. The tangent
S/c + diag(A phi'') is symmetric, and its Cholesky factor exists exactly where the state is stable.
:func:`descend` is Newton's method on this energy, always downhill: from a good guess it stays on
the branch in two or three iterations; from a bad one, or where a branch ends, it finds the stable
state that a contact without inertia would.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import get_lapack_funcs

from viscotack.bem.halfspace import Surface
from viscotack.traction import Traction

_potrf, _potrs = get_lapack_funcs(("potrf", "potrs"), dtype=np.float64)

# Newton converges quadratically: a last change of 1e-6 of the gap leaves an error near 1e-12.
_LAST_CHANGE = 1e-6
# What is added to an unstable tangent, as parts of its most negative curvature.
_STIFFER = (1e-3, 1e-2, 1e-1)
# A step may close at most this part of the gap at a node: beyond, the ninth power explodes.
_LARGEST_CLOSING = 0.3


@dataclass(frozen=True, eq=False)
class Balance:
    """A gap, how many iterations it took, and whether it is a stable equilibrium."""

    gap: npt.NDArray
    iterations: int
    stable: bool


def _factor(stiffness: npt.NDArray, diagonal: npt.NDArray):
    """Return the Cholesky factor of stiffness + diagonal, or None where it is not stable."""
    tangent = stiffness.copy(order="F")
    tangent.flat[:: len(tangent) + 1] += diagonal
    factor, info = _potrf(tangent, lower=1, overwrite_a=1, clean=0)
    return None if info else factor


def _stiffened(stiffness: npt.NDArray, curvature: npt.NDArray):
    """Return the factor of a tangent made just stiff enough to be positive definite.

    The first stiffness that serves is taken, because a step goes as far along the unstable
    direction as the stiffness lets it.
    """
    softest = -float(np.min(curvature))
    for share in _STIFFER:
        factor = _factor(stiffness, curvature + share * softest)
        if factor is not None:
            return factor
    return _factor(stiffness, np.maximum(curvature, 0.0))


def _limited(change: npt.NDArray, gap: npt.NDArray) -> float:
    """Return the largest part of the change that closes no gap too far."""
    closing = float(np.max(-change / gap))
    return min(1.0, _LARGEST_CLOSING / closing) if closing > 0 else 1.0


def descend(
    surface: Surface,
    law: Traction,
    free_gap: npt.NDArray,
    compliance: float,
    guess: npt.NDArray,
    *,
    most_iterations: int = 500,
) -> Balance:
    """Return the stable equilibrium downhill from a guess.

    Where the tangent is not positive definite it is stiffened, which keeps the direction downhill;
    the line search is in energy. Not stable if the iterations ran out.
    """
    S, A = surface.stiffness / compliance, surface.area
    gap, u = guess, guess - free_gap
    Su = S @ u
    elastic, interface = 0.5 * float(u @ Su), float(A @ law.energy(gap))
    energy = elastic + interface
    # Near the minimum the round-off of the two sums decides, not the slope.
    noise = 1e-12 * (elastic + abs(interface))
    for iteration in range(1, most_iterations + 1):
        curvature = A * law.stiffness(gap)
        factor = _factor(S, curvature)
        stable = factor is not None
        if factor is None:
            factor = _stiffened(S, curvature)
        residual = Su + A * law.traction(gap)
        change, _ = _potrs(factor, -residual, lower=1)
        part, slope = _limited(change, gap), float(residual @ change)
        while True:
            trial = gap + part * change
            u = trial - free_gap
            Su = S @ u
            trial_energy = 0.5 * float(u @ Su) + float(A @ law.energy(trial))
            if trial_energy <= energy + 1e-4 * part * slope + noise or part < 1e-6:
                break
            part *= 0.5
        gap, energy = trial, trial_energy
        if stable and part == 1.0 and np.max(np.abs(change) / gap) < _LAST_CHANGE:
            return Balance(gap, iteration, True)
    return Balance(gap, most_iterations, False)
