r"""Balance of the surface at one instant: gaps at which tractions and displacements agree.

With the stiffness S of the relaxed solid, the compliance c of this instant or step and the gap b
that depth and past alone would leave, the gap g makes the energy

.. math:: \Pi(g) = \frac{1}{2c} (g-b)^T S\, (g-b) + \sum_i A_i\, \varphi(g_i)

stationary; :math:`\varphi` is the interface energy of the traction law. The tangent
S/c + diag(A phi'') is symmetric, and its Cholesky factor exists exactly where the state is stable.
:func:`descend` is Newton's method on this energy, always downhill: from a good guess it stays on
the branch in two or three iterations, mostly with the factor of the first; from a bad one, or where
a branch ends, it finds the stable state that a contact without inertia would.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.linalg import get_lapack_funcs

from viscotack.bem.clock import look
from viscotack.bem.interface import Band, Faces
from viscotack.bem.machine import Hold
from viscotack.bem.span import released, room
from viscotack.bem.surface import Surface
from viscotack.traction import Traction, effective_range

_potrf, _potrs = get_lapack_funcs(("potrf", "potrs"), dtype=np.float64)

# Newton converges quadratically: a last change of 1e-6 of the room leaves an error near 1e-12.
_LAST_CHANGE = 1e-6
# What is added to an unstable tangent, as parts of its most negative curvature.
_STIFFER = (1e-3, 1e-2, 1e-1)
# The least of that curvature, as part of the stiffness of a node.
_SLIGHT = 1e-9
# A last change of a part x of the room may leave this part of the tractions unbalanced, and so many
# x^2. A smooth law leaves less than half of that; the kinks of another leave 1e-5 after a tiny
# change, which the audit of the energies would take for a jump.
_UNBALANCED = 1e-6
_CURVED = 30.0
# A gap [h0] that is gone: a law that repels without bound lets none come near, and where another is
# pressed harder than it repels, every step closes the gap further.
GONE = 1e-6
# A factor is kept for the next iteration where an undamped one has left less than this part of the
# unbalanced forces. It converges linearly, so what it may leave in the end is this part of the
# tractions, about what Newton would: the books feel it in first order. Where gaps no longer change,
# the last iteration has a factor of its own.
_KEPT, _KEPT_LEAVES = 0.1, 1e-8
# A step may close at most this part of the room at a node: beyond, the repulsion explodes.
_LARGEST_CLOSING = 0.3


@dataclass(frozen=True, eq=False)
class Balance:
    """A gap and a depth, how many iterations they took, and whether they are stable.

    `faces` is the interface at these gaps. `released` says that a dead load has pulled the surfaces
    apart: nothing holds it.
    """

    gap: npt.NDArray
    faces: Faces
    depth: float
    iterations: int
    stable: bool
    released: bool = False


@dataclass(frozen=True, eq=False)
class _Elastic:
    """The elastic energy of solid and machine, v M v/2 + f v, with v the gap beyond the free one.

    A rigid machine fixes the depth. Behind a spring the depth is where the energy is least,
    delta = (P - s v)/(K + k) with s = S 1/c and K = 1 S 1/c, which leaves a matrix M that is S/c
    less a part of rank one.
    """

    matrix: npt.NDArray
    linear: npt.NDArray | float
    free: npt.NDArray
    hold: Hold
    pushed: npt.NDArray | None
    softness: float

    @classmethod
    def of(cls, stiffness: npt.NDArray, free_gap: npt.NDArray, hold: Hold) -> _Elastic:
        if hold.rigid:
            return cls(stiffness, 0.0, free_gap - hold.depth, hold, None, 0.0)
        s = stiffness.sum(axis=1)
        softness = 1 / (float(s.sum()) + hold.stiffness)
        matrix = stiffness - softness * np.outer(s, s)
        return cls(matrix, softness * hold.load * s, free_gap, hold, s, softness)

    def depth(self, gap: npt.NDArray) -> float:
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


def elastic_energy(
    surface: Surface, compliance: float, free_gap: npt.NDArray, hold: Hold
) -> _Elastic:
    """Return the elastic energy of solid and machine as a function of the gap."""
    return _Elastic.of(surface.stiffness / compliance, free_gap, hold)


def factored(solid: _Elastic, curvature: Band) -> npt.NDArray | None:
    """Return the factor of the tangent, None where it is not stable."""
    return _factor(solid.matrix, curvature)


def solved(factor: Any, right: npt.NDArray) -> npt.NDArray:
    """Return what a factored tangent makes of a right side."""
    return _potrs(factor, right, lower=1)[0]


def _factor(stiffness: npt.NDArray, curvature: Band):
    """Return the Cholesky factor of stiffness + curvature, or None where it is not stable."""
    tangent, next_diagonal = stiffness.copy(), len(stiffness) + 1
    entries = tangent.reshape(-1)
    entries[::next_diagonal] += curvature.diagonal
    if curvature.beside is not None:  # only the upper half is used
        entries[1::next_diagonal] += curvature.beside
    # rows are columns to LAPACK, and the upper half is the lower one
    factor, info = _potrf(tangent.T, lower=1, overwrite_a=1, clean=0)
    return None if info else factor


def _stiffened(stiffness: npt.NDArray, curvature: Band):
    """Return the factor of a tangent made just stiff enough to be positive definite.

    The first stiffness that serves is taken, because a step goes as far along the unstable
    direction as the stiffness lets it.
    """
    # out of the range of a law there is no curvature, and under a dead load nothing else either
    diagonal, beside = curvature
    softest = max(-float(np.min(diagonal)), _SLIGHT * float(np.max(np.diag(stiffness))))
    for share in _STIFFER:
        factor = _factor(stiffness, Band(diagonal + share * softest, beside))
        if factor is not None:
            return factor
    factor = _factor(stiffness, Band(np.maximum(diagonal, 0.0)))
    # under a dead load the solid alone does not resist all of them
    return _factor(stiffness, Band(diagonal + 1.1 * softest)) if factor is None else factor


def descend(
    surface: Surface,
    law: Traction,
    free_gap: npt.NDArray,
    compliance: float,
    guess: npt.NDArray,
    hold: Hold,
    *,
    least_gain: float = 0.0,
    most_iterations: int = 500,
) -> Balance:
    """Return the stable equilibrium downhill from a guess.

    The free gap is the one at depth zero. Where the tangent is not positive definite it is
    stiffened, which keeps the direction downhill; the line search is in energy. Done when the gaps
    no longer change, or sooner when an iteration gains less than this part of the energy: at large
    Tabor numbers the energy hardly depends on where the edge is, and iterations would go on along
    that valley. Not stable if they ran out.
    """
    solid = _Elastic.of(surface.stiffness / compliance, free_gap, hold)
    face, gap, span = surface.interface, guess, effective_range(law)
    elastic, pull = solid.at(gap)
    faces = face.at(law, gap)
    energy = elastic + faces.energy
    # Near the minimum the round-off of the two sums decides, not the slope.
    size = abs(elastic) + abs(faces.energy)
    residual = pull + faces.tension
    left, factor, stable, kept = float(np.abs(residual).sum()), None, False, False
    for iteration in range(1, most_iterations + 1):
        look()
        if factor is None:
            curvature = faces.tangent()
            factor = _factor(solid.matrix, curvature)
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
            # So small a change of a stable state gains less than the round-off of the energies,
            # sums of large terms that cancel where a soft spring is far out: they have no say here,
            # and would refuse it for ever.
            gap = gap + change
            return Balance(gap, face.at(law, gap), solid.depth(gap), iteration, True)
        gap, energy, residual = trial, trial_energy, pull + faces.tension
        before, left = left, float(np.abs(residual).sum())
        whole = stable and part == 1.0
        # no more unbalanced than a smooth law is after such a change
        most = _KEPT_LEAVES if kept else _UNBALANCED + _CURVED * largest**2
        balanced = left < most * float(np.abs(faces.tension).sum())
        little = -slope < least_gain * size
        if whole and ((last and not kept) or (little and balanced)):
            return Balance(gap, faces, solid.depth(gap), iteration, True)
        smallest = int(gap.argmin())
        if gap[smallest] < GONE:
            return Balance(gap, faces, solid.depth(gap), iteration, False)
        opens = change[smallest] > 0  # a load that grows brings them together from there
        if hold.stiffness == 0 and opens and released(gap, span):
            return Balance(gap, faces, solid.depth(gap), iteration, False, released=True)
        kept = whole and not last and left < _KEPT * before
        if not kept:
            factor = None
    return Balance(gap, faces, solid.depth(gap), most_iterations, False)
