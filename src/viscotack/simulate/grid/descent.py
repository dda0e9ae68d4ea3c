r"""Equilibrium of a surface on a grid: Newton's method with truncated conjugate gradients.

With v the displacement of the domain in this step and c the compliance of the step, the energy per
area of a pixel is

.. math:: \Pi = \frac{1}{2c} v^T S\, v + \sum_i \varphi(b_i - \delta + v_i) + \tfrac{1}{2} k
          \delta^2 - P \delta ,

b being the gap at depth 0 that the memory of the solid leaves, and the last terms those of the
machine. The tangent S/c + diag(phi'') is only applied, never stored. Conjugate gradients stop where
they meet negative curvature, and the search continues along what they have found, so the iteration
descends to a stable state. The elastic energy is quadratic along a search direction, so that the
line search evaluates only the law. Where a few pixels would limit a step, as at a front that jumps
into contact, these stop alone, if the energy falls.

Conjugate gradients, which find a direction to 3 %, are in single precision; residuals, energies and
states are in double precision.

The tangent is stiff in contact, where the law repels, and soft elsewhere. With D+ its positive
part, s the median of S over c and :math:`\theta = D_+/(D_+ + s/10)`, the preconditioner

.. math:: M^{-1} r = \frac{\theta r}{D_+ + s} + \sqrt{1-\theta}\, c\, G \sqrt{1-\theta}\, r

inverts the law in contact and the solid elsewhere.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from viscotack.clock import look
from viscotack.model.traction import Traction, effective_range
from viscotack.model.traction.law import energy_and_traction
from viscotack.simulate.equilibrium import GONE
from viscotack.simulate.grid.plane import Plane
from viscotack.simulate.machine import Hold
from viscotack.simulate.surface import least_gap, released, room

# Residual of conjugate gradients relative to that of Newton's method, and their largest number.
_INNER, _MOST_INNER = 0.03, 300
# Weight of the elastic stiffness in the share of the law in the preconditioner.
_SHARE = 0.01
# Largest relative closing of a gap per iteration; the repulsion diverges beyond.
_LARGEST_CLOSING = 0.3
# Smallest mean of the tractions to which the unbalanced ones are related [strength of the law].
_LEAST = 1e-6
# Length of a step out of an equilibrium that is not stable [range of the law], and iterations after
# which it is taken.
_KICK, _LINGERED = 0.05, 5
# A search along a direction of negative curvature goes at most so far, and what conjugate gradients
# have found is prolonged by so much of it [range of the law].
_FAR, _PROLONGED = 1.0, 0.3
# Largest number of halvings of a step.
_HALVINGS = 20
# Part of a step below which the pixels that limit it stop alone.
_LIMITED = 0.9


@dataclass(frozen=True, eq=False)
class Found:
    """Equilibrium on a grid.

    Attributes
    ----------
    moved : ndarray
        Displacement of the domain in the step [h0].
    gap, tension : ndarray, shape (N,)
        Gaps [h0] and tensions [dg/h0] of the pixels.
    held : ndarray, shape (N,)
        Pressures that hold the displacement, to the tolerance minus the tensions [dg/h0]. With
        them the elastic energy has an error of second order in what is unbalanced.
    energy : float
        Interface energy, sum over the pixels [dg].
    depth : float
        Depth of the indenter [h0].
    iterations : int
        Iterations of Newton's method.
    stable : bool
        Whether a stable equilibrium was found.
    released : bool
        Whether a dead load has pulled the surfaces apart.
    """

    moved: npt.NDArray
    gap: npt.NDArray
    tension: npt.NDArray
    held: npt.NDArray
    energy: float
    depth: float
    iterations: int
    stable: bool
    released: bool = False


@dataclass(frozen=True, eq=False)
class _Tangent:
    """Second derivative of the energy by displacements and, with a spring, the depth.

    Fields and transforms are in single precision, tractions have no mean that the body cannot hold.
    """

    plane: Plane
    elastic: npt.NDArray  # transform of S/c
    inverse: npt.NDArray  # transform of c G
    compliance: float  # c
    curvature: npt.NDArray  # of the law, on the surface
    spring: float | None  # of the machine, None if rigid

    def times(self, v: npt.NDArray, depth: float) -> tuple[npt.NDArray, float]:
        rows, columns = self.plane.shape
        at_surface = v[:rows, :columns]
        bent = self.curvature * (at_surface - depth) if depth else self.curvature * at_surface
        result = self.plane.applied(self.elastic, v)
        result[:rows, :columns] += bent
        if self.plane.mean_is_zero:
            result -= result.mean()
        if self.spring is None:
            return result, 0.0
        return result, self.spring * depth - float(bent.sum(dtype=float))

    def preconditioner(self) -> Callable[[npt.NDArray, float], tuple[npt.NDArray, float]]:
        positive = np.maximum(self.curvature, 0.0)
        usual = self.plane.usual_stiffness / self.compliance
        share = positive / (positive + _SHARE * usual)
        own, rest = share / (positive + usual), np.sqrt(1 - share)
        plane, inverse = self.plane, self.inverse
        rows, columns = plane.shape

        def times(r: npt.NDArray) -> npt.NDArray:
            z = r.copy()
            z[:rows, :columns] *= rest
            z = plane.applied(inverse, z)
            z[:rows, :columns] *= rest
            z[:rows, :columns] += own * r[:rows, :columns]
            if plane.mean_is_zero:
                z -= z.mean()
            return z

        if self.spring is None:
            return lambda r, s: (times(r), 0.0)
        softness = 1 / (self.spring + float(positive.sum(dtype=float)) + _SHARE * usual)
        return lambda r, s: (times(r), softness * s)


def equilibrium(
    plane: Plane,
    law: Traction,
    free: npt.NDArray,
    compliance: float,
    guess: npt.NDArray,
    hold: Hold,
    *,
    depth: float = 0.0,
    tolerance: float = 1e-4,
    most_iterations: int = 60,
) -> Found:
    """Return the stable equilibrium that the energy descends to from a guess.

    Parameters
    ----------
    plane : Plane
        The surface, with lengths in the unit in which E* h0^2 = dg l.
    law : Traction
        Reduced traction law.
    free : ndarray, shape (N,)
        Gap at depth zero due to the loading history alone [h0].
    compliance : float
        Compliance of the step.
    guess : ndarray
        Displacement of the domain [h0].
    hold : Hold
        The machine; its stiffness and load are per area of a pixel.
    depth : float
        Guess of the depth with a spring or a dead load [h0].
    tolerance : float
        Largest sum of unbalanced tractions over that of the tractions.
    most_iterations : int
        Largest number of iterations of Newton's method.
    """
    depth = float(hold.depth if hold.rigid else depth)
    # numbers of NumPy would make fields of single precision double
    spring, compliance = None if hold.rigid else float(hold.stiffness), float(compliance)
    span = effective_range(law)
    elastic = plane.stiffness / compliance
    single = elastic.astype(np.float32), (plane.compliance * compliance).astype(np.float32)
    v, gap = _admitted(plane, free - depth, guess, span)
    held = plane.applied(elastic, v)
    if float(gap.min()) < GONE:  # the mean plane is pressed through the surface
        none = np.zeros_like(gap)
        return Found(v, gap, none, plane.within(held), 0.0, depth, 0, False)
    energies, tension = energy_and_traction(law, gap)
    energy = float(energies.sum())
    stable, beyond = False, not plane.periodic

    def found(iterations: int, stable: bool, released: bool = False) -> Found:
        pressure = plane.within(held)
        if plane.mean_is_zero:
            pressure = pressure - tension.mean()
        return Found(v, gap, tension, pressure, energy, depth, iterations, stable, released)

    for iteration in range(1, most_iterations + 1):
        look()
        residual, unheld = _residual(plane, held, tension, depth, hold)
        missing = float(np.abs(residual).sum()) + abs(unheld)
        scale = max(float(np.abs(tension).sum()), _LEAST * law.strength * gap.size)
        if iteration > 1 and stable and missing <= tolerance * scale:
            if not beyond:
                return found(iteration, True)
            # what is still unbalanced beyond the map would be a load without its energy
            held, beyond = plane.widened(plane.within(held)), False
            v = compliance * plane.applied(plane.compliance, held)
            gap = np.maximum(free - depth + plane.within(v), GONE)
            energies, tension = energy_and_traction(law, gap)
            energy = float(energies.sum())
            continue
        curvature = law.stiffness(gap).astype(np.float32).reshape(plane.shape)
        tangent = _Tangent(plane, *single, compliance, curvature, spring)
        saddle = iteration > _LINGERED and missing <= tolerance * scale
        step, lowered, stable = _direction(tangent, residual, unheld, span, saddle)
        change = plane.within(step) - lowered
        part = _longest(change, gap, span, stable)
        ways = [(step, lowered, part, _HALVINGS)]
        if part < _LIMITED:
            ways.insert(0, (*_stopped(plane, step, lowered, change, gap, span, stable), 1.0, 0))
        for step, lowered, part, halvings in ways:
            at_surface = plane.within(step) - lowered
            slope = float(np.vdot(residual, step)) + unheld * lowered
            stretched = plane.applied(elastic, step)
            quadratic = float(np.vdot(step, stretched))
            quadratic += spring * lowered**2 if spring else 0.0
            linear = float(np.vdot(held, step))
            linear += (spring * depth - hold.load) * lowered if spring is not None else 0.0
            trial = gap + part * at_surface
            while True:
                energies, pulls = energy_and_traction(law, np.maximum(trial, GONE))
                total = float(energies.sum())
                gained = part * linear + 0.5 * part**2 * quadratic + total - energy
                falls = gained <= 1e-4 * part * slope + 1e-13 * abs(energy)
                if falls or not halvings:
                    break
                part, halvings = 0.5 * part, halvings - 1
                trial = gap + part * at_surface
            if falls:
                break
        v, held = v + part * step, held + part * stretched
        depth, gap, tension, energy = depth + part * lowered, trial, pulls, total
        smallest = int(gap.argmin())
        if gap[smallest] < GONE:
            return found(iteration, False)
        opens = at_surface[smallest] > 0
        if spring == 0 and opens and released(gap, span):
            return found(iteration, False, True)
        stable = stable and len(ways) == 1 and (part == 1.0 or missing < 10 * tolerance * scale)
    return found(most_iterations, False)


def _residual(
    plane: Plane, held: npt.NDArray, tension: npt.NDArray, depth: float, hold: Hold
) -> tuple[npt.NDArray, float]:
    """Return the gradient of the energy by displacements and depth."""
    residual = held + plane.widened(tension)
    if plane.mean_is_zero:
        residual = residual - residual.mean()
    if hold.rigid:
        return residual, 0.0
    return residual, float(hold.stiffness * depth - hold.load - tension.sum())


def _longest(change: npt.NDArray, gap: npt.NDArray, span: float, stable: bool) -> float:
    """Return the longest part of a step that closes no gap too far, 1 at most."""
    closing = -float((change / room(gap, span)).min())
    part = min(1.0, _LARGEST_CLOSING / closing) if closing > 0 else 1.0
    if not stable:
        largest = float(np.abs(change).max())
        part = min(part, _FAR * span / largest) if largest > 0 else part
    return part


def _stopped(
    plane: Plane,
    step: npt.NDArray,
    lowered: float,
    change: npt.NDArray,
    gap: npt.NDArray,
    span: float,
    stable: bool,
) -> tuple[npt.NDArray, float]:
    """Return a step in which each pixel stops by itself where its gap would close too far."""
    part = 1.0 if stable else min(1.0, _FAR * span / float(np.abs(change).max()))
    least = -_LARGEST_CLOSING * room(gap, span)
    raised = plane.widened(np.maximum(least - part * change, 0.0))
    if plane.mean_is_zero:
        raised -= raised.mean()
    return part * step + raised, part * lowered


def _direction(
    tangent: _Tangent,
    residual: npt.NDArray,
    unheld: float,
    span: float,
    saddle: bool,
) -> tuple[npt.NDArray, float, bool]:
    """Return a direction of descent by conjugate gradients, and whether no curvature is negative.

    The direction is that of Newton's method unless negative curvature is met; then it is what was
    found before, prolonged along the negative curvature, or the first direction. At an equilibrium
    that is not stable, a saddle, it is that of the negative curvature, a part of the range long.
    """
    apply = tangent.preconditioner()
    r, s = -residual.astype(np.float32), -unheld
    x, lowered = np.zeros_like(r), 0.0
    z, y = apply(r, s)
    p, d = z.copy(), y
    product = float(np.vdot(r, z)) + s * y
    first = product
    if not first > 0:  # an even surface in equilibrium
        return x.astype(float), lowered, True
    held = np.empty_like(r)
    stable = True
    for many in range(1, _MOST_INNER + 1):
        bent, unbalanced = tangent.times(p, d)
        curvature = float(np.vdot(p, bent)) + d * unbalanced
        if not curvature > 0:
            stable = False
            largest = max(float(np.abs(p).max()), abs(d))
            if saddle:
                length, x, lowered = _KICK * span / largest, np.zeros_like(r), 0.0
            elif many == 1:
                length = 1.0
            else:
                length = _PROLONGED * span / largest
            x, lowered = x + length * p, lowered + length * d
            break
        length = product / curvature
        x += np.multiply(p, length, out=held)
        r -= np.multiply(bent, length, out=held)
        lowered, s = lowered + length * d, s - length * unbalanced
        z, y = apply(r, s)
        before, product = product, float(np.vdot(r, z)) + s * y
        if product <= _INNER**2 * first:
            break
        p *= product / before
        p += z
        d = y + (product / before) * d
    x = x.astype(float)
    if tangent.plane.mean_is_zero:  # prolonging magnifies a mean that rounding has left
        x -= x.mean()
    return x, lowered, stable


def _admitted(
    plane: Plane, free: npt.NDArray, guess: npt.NDArray, span: float
) -> tuple[npt.NDArray, npt.NDArray]:
    """Return a guess whose gaps the law can repel, and these gaps.

    Where the mean displacement is zero, raising some pixels lowers all others.
    """
    least = least_gap(span)
    if not plane.mean_is_zero:
        missing = np.maximum(least - (free + plane.within(guess)), 0.0)
        v = guess + plane.widened(missing) if missing.any() else guess
        return v, free + plane.within(v)
    low, own = least - free, guess.ravel()
    if not (low > own).any():
        return guess, free + own
    if low.mean() >= 0:  # pressed deeper than any guess: even gaps
        v = free.mean() - free
    else:

        def raised(by: float) -> npt.NDArray:
            return np.maximum(own - by, low)

        most = float((own - low).max())
        v = raised(float(brentq(lambda by: float(raised(by).mean()), 0.0, most)))  # type: ignore[arg-type]
        v = v - v.mean()
    return v.reshape(plane.shape), free + v
