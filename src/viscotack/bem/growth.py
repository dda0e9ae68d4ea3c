r"""An interface whose tension grows with the speed at which the gap opens, in a step.

A growing law (:mod:`viscotack.traction.growing`) has a tension of gap and opening speed,
:math:`\sigma = \sigma_0(h) + \sigma_0^+(h) \, G(\dot h)`, and no potential. Within one step it has
one all the same. The speed at its end is linear in the gap there,

.. math:: \dot h = \frac{h - s}{p}, \quad
          p = \frac{dt}{1+\beta}, \quad s = h_0 + \frac{\beta}{1+\beta} \, dt \, v_0, \quad
          \beta = \frac{dt}{dt + dt_0},

by the parabola through the gap now, that at the beginning and that of the step before, of length
:math:`dt_0` and mean speed :math:`v_0`: of second order. (At first, after rest, a jump or a turn of
the machine, :math:`\beta = 0`: of first order.) So at each node the tension is a function of the
gap alone, with the potential

.. math:: \psi(h) = \varphi_0(h) + \int_s^h \sigma_0^+(x) \, G\!\left(\frac{x - s}{p}\right) dx,

and the balance of :mod:`.equilibrium` and its descent go on as they are. Its second derivative is
the consistent tangent,

.. math:: \psi'' = \sigma_0' \, (1 + G) + \sigma_0^+ \, G'/p,

whose last term only stiffens: as dt vanishes it outgrows every softening. A contact that grows
never jumps, therefore; where its law at rest would, the edge runs, as fast as its heat allows.

**What is stable.** With the speeds frozen, and so the factor F = 1 + G at each node, the interface
has the potential

.. math:: \varphi_F(h) = F \, \varphi_0(h) \;\; (h \ge h_0), \quad
          \varphi_0(h) - (F - 1) \, \Delta\gamma_0 \;\; (h < h_0),

and the frozen-rate tangent S/c + A F sigma_0' is its second derivative. Where that is positive
definite, the state is the least of an energy, as with a law of the gap, and is left no sooner than
the machine moves it on: slow motion. Where it is not, a disturbance grows, at a finite rate: a
disturbance y that has grown for a time dt has done the work y (S/c + A F sigma_0') y/2 and made the
heat y (A sigma_0^+ G'/dt) y/2, and it proceeds at the speed at which the two add up to zero. That
is a crack that runs, which a law of the gap would have jump; no balance ends there. So a state is
lost only where the consistent tangent is not positive definite, which is the second derivative of
what is spent in the step, and that is the test of a step; a jump is left where the interface does
not grow, in closing, or where it grows by so little that the shortest step sees none of it.

New nodes are balanced with the potential of the last step: it is the end of that step that is made
again on them. The frozen one may have no least there.

**Heat.** In a step the tensions beyond those at rest, :math:`x = \sigma_0^+ G`, do the work
:math:`\sum A \frac{x_0 + x_1}{2} (h_1 - h_0)`, all of it heat. With linear forces that is what the
solid and the machine lose to it: the books close as well as they do with the law at rest, and what
they do not tell, whether speeds are right, the step control does (:func:`bend`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.bem.clock import look
from viscotack.bem.equilibrium import Balance, elastic_energy, factored, solved
from viscotack.bem.interface import Band
from viscotack.bem.machine import Hold
from viscotack.bem.span import room
from viscotack.bem.surface import Surface
from viscotack.traction import Traction, effective_range

# Newton's method for a step: iterations, what may be left unbalanced of the tensions, the part of
# the room that a gap may close at once, and of a speed that changes less the tangent is taken.
_ITERATIONS, _UNBALANCED, _LARGEST_CLOSING, _SETTLED = 40, 1e-8, 0.3, 0.3
# Points for the heat within a step; u^2 takes the sting out of a power of the speed below 1.
_U, _WEIGHT = np.polynomial.legendre.leggauss(10)
_U = (_U + 1) / 2
_SQUARE, _SLOPE = (_U**2)[:, None], _WEIGHT * _U


@dataclass(frozen=True, eq=False)
class Opening:
    """How fast the gap opens at the nodes, at an instant.

    Attributes
    ----------
    speed : ndarray, shape (N,)
        What the tension feels [h0 per time].
    mean : ndarray, shape (N,)
        Mean speed over the step before.
    length : float
        Length of that step; 0 where it tells nothing of the next.
    per : float
        Speed per gap at its end; 0 as well.
    """

    speed: npt.NDArray
    mean: npt.NDArray
    length: float = 0.0
    per: float = 0.0

    @classmethod
    def none(cls, gap: npt.NDArray) -> Opening:
        """Return the speeds at rest."""
        return cls(np.zeros_like(gap), np.zeros_like(gap))

    def forgotten(self) -> Opening:
        """Return the speeds where they tell nothing of the next step."""
        return Opening(self.speed, self.mean)

    def carried(self, spline: Callable[[npt.NDArray], npt.NDArray]) -> Opening:
        """Return the speeds on other nodes."""
        return replace(self, speed=spline(self.speed), mean=spline(self.mean))


class _AsAtRest:
    """What balances ask of a law beside its tension: the lengths and forces of the law at rest."""

    base: Traction

    @property
    def work_of_adhesion(self) -> float:
        """That of the law at rest."""
        return self.base.work_of_adhesion

    @property
    def equilibrium_gap(self) -> float:
        """That of the law at rest."""
        return self.base.equilibrium_gap

    @property
    def strength(self) -> float:
        """That of the law at rest."""
        return self.base.strength


@dataclass(frozen=True, eq=False)
class Frozen(_AsAtRest):
    """A law at rest, its tension multiplied at each node: that of frozen speeds."""

    base: Traction
    factor: npt.NDArray

    def traction(self, gap: npt.NDArray) -> npt.NDArray:
        """Return the tension [dg/h0]."""
        tension = self.base.traction(gap)
        return tension + np.maximum(tension, 0.0) * (self.factor - 1)

    def stiffness(self, gap: npt.NDArray) -> npt.NDArray:
        """Return its derivative by the gap."""
        return self.base.stiffness(gap) * np.where(gap > 1, self.factor, 1.0)

    def energy(self, gap: npt.ArrayLike) -> npt.NDArray:
        """Return its potential [dg], 0 far apart."""
        at_rest = self.base.energy(gap)
        return np.where(np.asarray(gap) > 1, self.factor * at_rest, at_rest - (self.factor - 1))

    @property
    def rim(self) -> Frozen:
        """The law at the last node, and on the flank beyond it."""
        return Frozen(self.base, self.factor[-1])


@dataclass(frozen=True, eq=False)
class Stepped(_AsAtRest):
    """A growing law in a step: at each node a function of the gap at its end.

    Attributes
    ----------
    base, growing : Traction, law that grows
        Reduced; the law at rest, and the one whose growth it is.
    since, per : ndarray, float
        Gap at which nothing opens at the end of the step, and speed per gap beyond it.
    """

    base: Traction
    growing: Any
    since: npt.NDArray
    per: float

    @classmethod
    def of(
        cls, base: Traction, growing: Any, gap: npt.NDArray, before: Opening, length: float
    ) -> Stepped:
        """Return the law in a step of this length from gaps that have opened so fast before."""
        beta = length / (length + before.length) if before.length else 0.0
        since = gap + length * beta / (1 + beta) * before.mean
        return cls(base, growing, since, (1 + beta) / length)

    @classmethod
    def again(cls, base: Traction, growing: Any, gap: npt.NDArray, ended: Opening) -> Stepped:
        """Return the law in the step that has ended with these gaps and speeds."""
        return cls(base, growing, gap - ended.speed / ended.per, ended.per)

    def traction(self, gap: npt.NDArray) -> npt.NDArray:
        """Return the tension [dg/h0]."""
        tension = self.base.traction(gap)
        return tension + np.maximum(tension, 0.0) * self._growth(gap)

    def stiffness(self, gap: npt.NDArray) -> npt.NDArray:
        """Return its derivative by the gap, the consistent tangent."""
        tension = self.base.traction(gap)
        slope = self.growing.growth_slope(self.speed(gap))
        grown = np.where(tension > 0, 1 + self._growth(gap), 1.0)
        return self.base.stiffness(gap) * grown + np.maximum(tension, 0.0) * slope * self.per

    def energy(self, gap: npt.NDArray) -> npt.NDArray:
        """Return its potential [dg]: stored energy, and the heat of opening in this step."""
        energy, begin = self.base.energy(gap), np.maximum(self.since, 1.0)
        opens = gap > begin
        if not opens.any():
            return energy
        way, begin = (gap - begin)[opens], begin[opens]
        x = begin + way * _SQUARE
        growth = self.growing.growth((x - self.since[opens]) * self.per)
        energy = energy.copy()
        energy[opens] += way * (_SLOPE @ (self.base.traction(x) * growth))
        return energy

    def opening(self, before: npt.NDArray, speed: npt.NDArray, length: float) -> Opening:
        """Return the speeds at the end of a step that began at these gaps, for those there."""
        mean = (self.since - before + speed / self.per) / length
        return Opening(speed, mean, length, self.per)

    def speed(self, gap: npt.NDArray) -> npt.NDArray:
        """Return the opening speeds at the end of the step."""
        return (gap - self.since) * self.per

    def _growth(self, gap: npt.NDArray) -> npt.NDArray:
        return self.growing.growth(self.speed(gap))


def driven(
    surface: Surface,
    law: Stepped,
    free: npt.NDArray,
    compliance: float,
    guess: npt.NDArray,
    hold: Hold,
) -> tuple[Balance, npt.NDArray] | tuple[None, None]:
    """Return the balance at the end of a step near a guess, and speeds; None where none is found.

    A growth that rises like a power of the speed below 1 has a slope that changes by decades, and
    none where the gap closes: Newton's method overshoots from the one to the other for ever. The
    heat of opening is concave in the SQUARE of the speed, however: a parabola through the present
    speed, with the secant G/v for a slope, lies above it, and leads monotonically to the balance,
    the logarithm of the speed being off by 1 - n times as much after each iteration. Where a node
    has settled, or comes from below, where it does not overshoot, the tangent takes over.

    Where surfaces are next to stuck, their opening in a step has more digits than their gap.
    """
    solid = elastic_energy(surface, compliance, free, hold)
    area, span = surface.area, effective_range(law.base)
    opened = guess - law.since
    gap, speed = law.since + opened, opened * law.per
    tangent = np.zeros(gap.shape, dtype=bool)
    for iteration in range(1, _ITERATIONS + 1):
        look()
        at_rest = law.base.traction(gap)
        pulls, growth = np.maximum(at_rest, 0.0), law.growing.growth(speed)
        tension = area * (at_rest + pulls * growth)
        residual = solid.at(gap)[1] + tension
        slope = law.growing.growth_slope(speed)
        steep = (speed > 0) & ~tangent
        slope[steep] = growth[steep] / speed[steep]
        slope = np.where(speed == 0, law.growing.growth_slope(np.finfo(float).tiny), slope)
        stiffness = law.base.stiffness(gap) * np.where(at_rest > 0, 1 + growth, 1.0)
        factor = factored(solid, Band(area * (stiffness + pulls * slope * law.per)))
        if factor is None:
            return None, None
        if np.sum(np.abs(residual)) < _UNBALANCED * np.sum(np.abs(tension)):
            stepped: Any = law
            faces = surface.interface.at(stepped, gap)
            return Balance(gap, faces, solid.depth(gap), iteration, True), speed
        change = solved(factor, -residual)
        closing = float(np.max(-change / room(gap, span)))
        opened = opened + change * min(1.0, _LARGEST_CLOSING / max(closing, _LARGEST_CLOSING))
        gap, before, speed = law.since + opened, speed, opened * law.per
        tangent = (speed > before) | (np.abs(speed - before) < _SETTLED * np.abs(speed))
    return None, None


def bend(law: Stepped, gap: npt.NDArray, opening: Opening, area: npt.NDArray) -> float:
    """Return how far the attraction would be off were speeds the mean ones of the step, relative.

    It is of first order in the step, and the error that is left of second.
    """
    attraction = area * np.maximum(law.base.traction(gap), 0.0)
    now, mean = law.growing.growth(opening.speed), law.growing.growth(opening.mean)
    whole = float(attraction @ (1 + now))
    return float(attraction @ np.abs(now - mean)) / whole if whole > 0 else 0.0
