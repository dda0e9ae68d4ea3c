r"""Interfaces whose tension grows with the opening speed, or with age, in one time step.

A growing law (:mod:`viscotack.model.traction.growing`) has a tension of gap and opening speed,
:math:`\sigma = \sigma_0(h) + \sigma_0^+(h) \, G(\dot h)`, and in general no potential. Within one
step, however, a potential exists. The speed at the end of the step is linear in the gap there,

.. math:: \dot h = \frac{h - s}{p}, \quad
          p = \frac{dt}{1+\beta}, \quad s = h_0 + \frac{\beta}{1+\beta} \, dt \, v_0, \quad
          \beta = \frac{dt}{dt + dt_0},

by the parabola through the gap now, that at the beginning and that of the step before, of length
:math:`dt_0` and mean speed :math:`v_0`: of second order. (At first, after rest, a jump or a turn of
the machine, :math:`\beta = 0`: of first order.) So at each node the tension is a function of the
gap alone, with the potential

.. math:: \psi(h) = \varphi_0(h) + \int_s^h \sigma_0^+(x) \, G\!\left(\frac{x - s}{p}\right) dx,

and the equilibrium solver of :mod:`.equilibrium` applies unchanged. The second derivative is the
consistent tangent,

.. math:: \psi'' = \sigma_0' \, (1 + G) + \sigma_0^+ \, G'/p,

whose last term is not negative. For dt to 0 it exceeds any softening, so a rate-dependent contact
never jumps. Where the quasi-static law would jump, the crack runs at a speed limited by its heat.

**Stability.** With the speeds frozen, and so the factor F = 1 + G at each node, the interface
has the potential

.. math:: \varphi_F(h) = F \, \varphi_0(h) \;\; (h \ge h_0), \quad
          \varphi_0(h) - (F - 1) \, \Delta\gamma_0 \;\; (h < h_0),

and the frozen-rate tangent S/c + A F sigma_0' is its second derivative. Where that is positive
definite, the state is the least of an energy, as with a law of the gap, and is left no sooner than
the machine moves it on: slow motion. Where it is not, a disturbance grows, at a finite rate: a
disturbance y that has grown for a time dt has done the work y (S/c + A F sigma_0') y/2 and made the
heat y (A sigma_0^+ G'/dt) y/2, and it proceeds at the speed at which the two add up to zero. That
is a running crack; with a quasi-static law the contact would jump, but here the branch continues. A
state is unstable only if the consistent tangent, the second derivative of the energy spent in the
step, is not positive definite. This is the stability test of a step. Jumps remain possible on
closing, or if the growth is too small to have an effect in the shortest step.

On new nodes the equilibrium uses the potential of the last step, so that the end of that step is
recomputed. The potential with frozen speeds may have no minimum there.

**Heat.** In a step the tensions beyond those at rest, :math:`x = \sigma_0^+ G`, do the work
:math:`\sum A \frac{x_0 + x_1}{2} (h_1 - h_0)`, all of it heat. With linear forces that is what the
solid and the machine lose to it. The energy balance therefore closes as well as with the
quasi-static law. It does not check the speeds; the step control does (:func:`bend`).

**Interface that ages in contact, in one time step.** An ageing law
(:mod:`viscotack.model.traction.growing`) multiplies the tension of each node by :math:`F = 1 + q
G(t)`, with the time t that the node has been in contact, and the share q of its bonds that hold. In
a step t grows by the length of the step at the nodes in contact at its beginning, whatever the gaps
do meanwhile, so F is known beforehand and the law has the potential
:class:`Frozen` of the gap, with which the equilibrium solver of
:mod:`.equilibrium` and its test of stability apply unchanged. The time of a node that comes into
contact within a step begins with the end of the step: of first order in the step, for the edge of
an approaching contact only.

A node is in contact where its gap is below that of the largest tension. Beyond, its time stands
still, so that a crack separates it with the work that it has reached. Its bonds break one after
another, so that no node snaps: q falls with the logarithm of the gap, from 1 where the law at rest
has 2 % of its work left to 0 where it has 0.2 %, and does not rise again. The work is then
:math:`\Delta\gamma_0 (1 + 0.99 \, G(t))`. When all are broken, the node is as new. Where a crack
turns earlier, the bonds that hold close again as they are, and gain back what has been paid for
them, no more: heat is never negative after a cycle.

**Heat.** The tensions beyond those at rest do work, all of which is heat. With the mean of the
growth over a step it is, at each node,

.. math:: \frac{G_0 + G_1}{2} \, \left[ \varphi_0(\max(h, h_0)) \right]_{\text{begin}}^{\text{end}},

whatever the way of the gap, also in a jump. The stored energy is that of the law at rest, so a
contact that ages at rest neither stores nor loses energy.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from viscotack.clock import look
from viscotack.model.traction import Traction, ages, effective_range
from viscotack.simulate.equilibrium import Balance, Elastic, factored, solved
from viscotack.simulate.machine import Hold
from viscotack.simulate.settings import Settings
from viscotack.simulate.surface import Band, Surface, room

# Newton's method for a step: maximum iterations, relative residual of the tensions, largest
# relative closing of a gap per iteration, and relative change of speed below which the tangent is
# used.
_ITERATIONS, _UNBALANCED, _LARGEST_CLOSING, _SETTLED = 40, 1e-8, 0.3, 0.3
# Gauss points for the heat in a step; u^2 removes the singularity of a speed exponent below 1.
_U, _WEIGHT = np.polynomial.legendre.leggauss(10)
_U = (_U + 1) / 2
_SQUARE, _SLOPE = (_U**2)[:, None], _WEIGHT * _U


@dataclass(frozen=True, eq=False)
class Opening:
    """Opening speed of the gap at the nodes, at one instant.

    Attributes
    ----------
    speed : ndarray, shape (N,)
        Opening speed that enters the tension [h0 per time].
    mean : ndarray, shape (N,)
        Mean speed over the previous step.
    length : float
        Length of that step; 0 if it must not be used for prediction.
    per : float
        Change of speed per gap at its end; 0 as for `length`.
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
        """Return the speeds without the data of the previous step."""
        return Opening(self.speed, self.mean)

    def carried(self, old: npt.NDArray, nodes: npt.NDArray) -> Opening:
        """Return the speeds on other nodes."""
        speed, mean = CubicSpline(old, np.vstack([self.speed, self.mean]), axis=-1)(nodes)
        return replace(self, speed=speed, mean=mean)

    def factor(self, growing: Any) -> npt.NDArray:
        """Return the factor of the tension at the nodes."""
        return 1 + growing.growth(self.speed)

    def stepped(self, base: Traction, growing: Any, gap: npt.NDArray, length: float) -> Stepped:
        """Return the law for a step of this length from these gaps."""
        return Stepped.of(base, growing, gap, self, length)


class _AsAtRest:
    """Work, equilibrium gap and strength of the quasi-static law `base`."""

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
    """Quasi-static law with its tension multiplied by a factor per node.

    The speeds of a law that grows, or the times of one that ages, are frozen.
    """

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
    """Rate-dependent law in one step: at each node a function of the gap at its end.

    Attributes
    ----------
    base, growing : Traction, law that grows
        Quasi-static law and rate-dependent law, both reduced.
    since, per : ndarray, float
        Gap with zero opening speed at the end of the step, and speed per gap beyond it.
    """

    base: Traction
    growing: Any
    since: npt.NDArray
    per: float

    @classmethod
    def of(
        cls, base: Traction, growing: Any, gap: npt.NDArray, before: Opening, length: float
    ) -> Stepped:
        """Return the law for a step of this length, from these gaps and earlier speeds."""
        beta = length / (length + before.length) if before.length else 0.0
        since = gap + length * beta / (1 + beta) * before.mean
        return cls(base, growing, since, (1 + beta) / length)

    @classmethod
    def again(cls, base: Traction, growing: Any, gap: npt.NDArray, ended: Opening) -> Stepped:
        """Return the law of the step that ended with these gaps and speeds."""
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
        """Return the opening data after a step from the gaps `before`, for these final speeds."""
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
    """Return equilibrium and opening speeds at the end of a step near a guess, or (None, None).

    If the growth is a power of the speed with an exponent n below 1, its slope changes by decades
    and is zero where the gap closes. Newton's method would then oscillate without converging. But
    the heat of opening is concave in the SQUARE of the speed. A parabola through the present speed
    with the secant slope G/v is an upper bound, so its minimisation converges monotonically: the
    error of the logarithm of the speed is multiplied by 1 - n in each iteration. The tangent is
    used for nodes that have settled or approach from below, where it does not overshoot.

    The iteration uses the opening instead of the gap, because for nearly closed surfaces the
    opening in a step has more significant digits.
    """
    solid = Elastic.of(surface, compliance, free, hold)
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
        factor = factored(solid.matrix, Band(area * (stiffness + pulls * slope * law.per)))
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
    """Return the relative change of attraction if speeds are replaced by the means of the step.

    It is of first order in the step length; the error of the step itself is of second order.
    """
    attraction = area * np.maximum(law.base.traction(gap), 0.0)
    now, mean = law.growing.growth(opening.speed), law.growing.growth(opening.mean)
    whole = float(attraction @ (1 + now))
    return float(attraction @ np.abs(now - mean)) / whole if whole > 0 else 0.0


# Shares of the work of adhesion left at the gaps between which bonds break, 8.2 and 26 h0 with
# Lennard-Jones forces, and the largest such gap [h0].
_BREAKS, _BROKEN, _FARTHEST = 2e-2, 2e-3, 1e3


def finer(settings: Settings, law: Any, longest: float = np.inf) -> Settings:
    """Return settings with as many more nodes as the zone of a crack shrinks when a law ages.

    The zone is as long as energy over squared strength, and both grow by the same factor in the
    longest time. A growth without an end has no such factor for an infinite time.
    """
    if not ages(law) or np.isinf(last := min(longest, law.settled)):
        return settings
    factor = 1 + float(law.growth_after(last))
    return replace(settings, nodes_per_zone=factor * settings.nodes_per_zone)


@dataclass(frozen=True, eq=False)
class Contacted:
    """Time in contact at the nodes, at one instant; 0 where there is no bond.

    Attributes
    ----------
    time : ndarray, shape (N,)
        Time in contact [time unit of the modes].
    held : ndarray, shape (N,)
        Share of the bonds that hold, 0 to 1; 0 where there never were any.
    """

    time: npt.NDArray
    held: npt.NDArray

    @classmethod
    def relaxed(cls, base: Traction, ageing: Any, gap: npt.NDArray) -> Contacted:
        """Return the times of a relaxed contact, closed for ever; base is the law at rest."""
        closed = gap < base.edge_gap
        return cls(np.where(closed, ageing.settled, 0.0), np.where(closed, 1.0, 0.0))

    def forgotten(self) -> Contacted:
        """Return the times as they are: they predict nothing."""
        return self

    def carried(self, old: npt.NDArray, nodes: npt.NDArray) -> Contacted:
        """Return the times on other nodes; linear, because they are discontinuous at an edge."""
        time, held = (np.interp(nodes, old, values) for values in (self.time, self.held))
        return Contacted(time, held)

    def factor(self, ageing: Any) -> npt.NDArray:
        """Return the factor of the tension at the nodes."""
        return 1 + self.held * ageing.growth_after(self.time)

    def stepped(self, base: Traction, ageing: Any, gap: npt.NDArray, length: float) -> Frozen:
        """Return the law for a step of this length from these gaps."""
        return Frozen(base, self._older(base, gap, length).factor(ageing))

    def after(
        self, base: Traction, before: npt.NDArray, gap: npt.NDArray, length: float
    ) -> Contacted:
        """Return the times after a step of this length, from the gaps `before` to these."""
        first, last = _gap_with(base, _BREAKS), _gap_with(base, _BROKEN)
        share = np.log(last / np.maximum(gap, first)) / np.log(last / first)
        held = np.clip(np.minimum(self.held, share), 0.0, None)
        new = (held == 0) & (gap < base.edge_gap)
        time = self._older(base, before, length).time
        return Contacted(np.where(held > 0, time, 0.0), np.where(new, 1.0, held))

    def heat(
        self, base: Traction, ageing: Any, before: npt.NDArray, gap: npt.NDArray, length: float
    ) -> npt.NDArray:
        """Return the heat [dg] at the nodes in a step from the gaps `before` to these."""
        older = self._older(base, before, length)
        growth = 0.5 * (self.factor(ageing) + older.factor(ageing)) - 1
        return growth * (base.energy(np.maximum(gap, 1.0)) - base.energy(np.maximum(before, 1.0)))

    def _older(self, base: Traction, gap: npt.NDArray, length: float) -> Contacted:
        ages = (gap < base.edge_gap) & (self.held > 0)
        return replace(self, time=self.time + np.where(ages, length, 0.0))


@lru_cache(maxsize=64)
def _gap_with(base: Traction, share: float) -> float:
    """Return the gap [h0] at which a law at rest has this share of its work left."""

    def left(gap: float) -> float:
        return float(-base.energy(gap)) - share

    if left(_FARTHEST) > 0:
        return _FARTHEST * share / _BROKEN
    return float(brentq(left, base.edge_gap, _FARTHEST))  # type: ignore[arg-type]
