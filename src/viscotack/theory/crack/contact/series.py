r"""Receding contacts in series: a rigid object between two contacts that a drive pulls apart.

Both contacts carry the force F, and their depths and the spring K add up to the drive,

.. math:: \delta_1 + \delta_2 + F/K = D_0 - V t .

The opening inside a receding contact has been zero at all times (:mod:`.recession`), so its
pressure is that of the relaxed solid at an effective depth :math:`D_e`. On a half-space

.. math:: \frac{F}{f} = 2 \int_0^a (D_e - g)\, ds, \qquad
          \frac{(D_e - g(a))^2}{2 \pi a} = \Gamma(v), \quad \dot a = -\frac{v}{\mu^2}, \qquad
          \delta = c D_e + \sum_j w_j d_j, \quad \tau_j \dot d_j = D_e - d_j,

with the fraction f of the short-range tension that the range of the law leaves, and the creep c,
w, tau of the solid. For given F and radii, :math:`D_e` and the speeds of the cracks are explicit.
The rates of the depths add up to -V, which gives

.. math:: \dot F \Big( \frac1K + \sum \frac{c}{2 a f} \Big) = -V - \sum \Big( r + c\,
          \frac{(g(a) - D_e)\, \dot a}{a} \Big), \quad r = \sum_j \frac{w_j}{\tau_j} (D_e - d_j).

An elastic contact follows its equilibrium curve, so only its compliance
:math:`d\delta/dF` enters. The stiff differential equation of F, the radii and the memories is
solved by LSODA, or by Radau's method where that fails. Edges at rest do not close again.

A contact opens when its force reaches its maximum while the other could carry more: its crack then
accelerates, the force falls, and the other contact keeps its radius. At equal force two elastic
contacts need no history: the one with the smaller pull-off force opens.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass
from math import exp, log, nan, pi
from typing import NamedTuple, Self

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.errors import OutOfRange
from viscotack.theory.crack.contact.history import Chain, chain_of
from viscotack.theory.crack.steady import SteadyCrack
from viscotack.threads import caught_warnings

from ._profile import HalfSpaceProfile

# Rows of the tables of a crack and of an elastic contact, and the slowest crack, Gamma - 1.
_ROWS, _SLOWEST = 2000, 1e-9
# Fraction of the energy of the fastest crack, or of an elastic pull-off force, at which a contact
# opens.
_LAST = 1 - 1e-5
# Fraction of the largest tension at which a run ends, and of the radius at the start below which a
# contact has gone.
_FALLEN, _GONE = 0.5, 1e-2
# Tolerance and most steps of the differential equation; rounds for the range of the law.
_TOLERANCE, _MOST_STEPS, _ROUNDS = 1e-6, 20_000, 4
# Radii fall together if their logarithms differ by less than this fraction.
_TOGETHER = 1e-3
_TINY = 1e-300
# LSODA is the faster of both methods, and fails more often.
_METHODS = "LSODA", "Radau"
# Retardation times below this fraction of the time in which the drive extends both contacts to a
# unit of force count as instantaneous.
_INSTANT = 1e-5
# Tension [R dg] at which the range of the law, and a band, take half their effect.
_ONSET = 0.1
# Change of the force in the first step, over its scale.
_FIRST = 1e-6
# Longest time of a run, over that in which the drive extends both contacts to a unit of force.
_LONGEST = 1e6


@dataclass(frozen=True)
class Scales:
    """SI values of the units of a contact: depth beta^2/R [m], force R dg [N], time [s]."""

    depth: float
    force: float
    time: float


class Flow(NamedTuple):
    """Compliance dd/dF [m/N] of a contact, its rate at constant force [m/s], rates of its state."""

    compliance: float
    creep: float
    rates: Array


class _Strong:
    """Units and strength of a contact."""

    scales: Scales
    _strength = 1.0

    @property
    def softness(self) -> float:
        """Scale of the compliance [m/N]."""
        return self.scales.depth / self.scales.force

    def stronger(self, strength: float) -> Self:
        """Return the same contact with a factor on its tension."""
        other = copy(self)
        other._strength = strength
        return other


class Receding(_Strong):
    """A viscoelastic contact whose edge recedes as a steady crack.

    Its state is ln of the radius [beta] and the memories d_j [beta^2/R].

    Parameters
    ----------
    crack : SteadyCrack
        Crack of the solid with the reduced law.
    profile : HalfSpaceProfile
        Profile of the reduced shape on a half-space.
    tabor, radius : float
        Tabor number, and radius of the relaxed start [beta].
    scales : Scales
        Its units in SI.
    left : callable
        Fraction of the short-range tension as a function of energies and speeds of the crack.
    """

    def __init__(
        self,
        crack: SteadyCrack,
        profile: HalfSpaceProfile,
        *,
        tabor: float,
        radius: float,
        scales: Scales,
        left: Callable[[Array, Array], Array],
    ) -> None:
        self._profile, self._mu2, self._radius = profile, tabor**2, radius
        self.scales = scales
        self._chain = chain_of(crack.modes)
        self._limit = _LAST * crack.largest
        gained = np.geomspace(_SLOWEST, self._limit - 1, _ROWS)
        speed = np.maximum(np.asarray(crack.speed(1 + gained)), _TINY)
        self._gained, self._speeds = np.log(gained), np.log(speed)
        self._left = np.asarray(left(1 + gained, speed))

    def over(self, time: float) -> Receding:
        """Return the same contact for a pull of this length [s]; much faster modes are instant."""
        chain = self._chain
        is_fast = chain.times * self.scales.time < _INSTANT * time
        other = copy(self)
        other._chain = Chain(
            chain.instantaneous + float(chain.weights[is_fast].sum()),
            chain.weights[~is_fast],
            chain.times[~is_fast],
        )
        return other

    def start(self) -> Array:
        """Return the state of the relaxed contact."""
        depth = float(self._profile.relaxed_depth(self._radius))
        return np.append(log(self._radius), np.full(self._chain.times.size, depth))

    def radius(self, state: Array) -> float:
        """Return the radius [beta]."""
        return exp(state[0])

    def energy(self, force: float, state: Array) -> float:
        """Return the energy release rate at the edge [dg] under a force [N]."""
        return self._loaded(force, exp(state[0]))[0]

    def gone(self, force: float, state: Array) -> bool:
        """Return whether the contact opens without limit."""
        a = exp(state[0])
        return a < _GONE * self._radius or self._loaded(force, a)[0] > self._limit

    def flow(self, force: float, state: Array) -> Flow:
        """Return how the contact changes under a force [N]."""
        a, scales, chain = exp(state[0]), self.scales, self._chain
        energy, effective, part = self._loaded(force, a)
        falls = 0.0  # of an edge at rest
        if energy > 1 + _SLOWEST:
            log_speed = float(np.interp(self._log(energy), self._gained, self._speeds))
            falls = exp(log_speed) / self._mu2
        lag = (effective - state[1:]) / chain.times
        lift = float(self._profile.depth(a)) - effective
        # at constant force the effective depth falls as the contact shrinks
        sinks = lift * falls / a
        creep = float(chain.weights @ lag) - chain.instantaneous * sinks
        per_force = chain.instantaneous / (2 * a * part)
        return Flow(
            per_force * scales.depth / scales.force,
            creep * scales.depth / scales.time,
            np.append(-falls / a, lag) / scales.time,
        )

    def _loaded(self, force: float, a: float) -> tuple[float, float, float]:
        """Return energy and effective depth under a force [N], and f times the strength."""
        profile, P = self._profile, force / self.scales.force
        total, bare = float(profile.total(a)), float(profile.depth(a))
        # the fraction sets in smoothly with the tension, without a kink for the integrator
        share = P**2 / (P**2 + _ONSET**2) if P < 0 else 0.0
        part = 1 + (self._strength - 1) * share
        for _ in range(_ROUNDS):
            effective = (P / part / 2 + total) / a
            energy = max(bare - effective, 0.0) ** 2 / (2 * pi * a)
            if P >= 0:
                break
            left = float(np.interp(self._log(energy), self._gained, self._left))
            part = 1 + (left * self._strength - 1) * share
        return energy, effective, part

    def _log(self, energy: float) -> float:
        return log(max(energy - 1, _TINY))


class Elastic(_Strong):
    """An elastic contact, which follows its equilibrium curve; it has no state.

    Parameters
    ----------
    profile : HalfSpaceProfile
        Profile of the reduced shape on a half-space.
    radius : float
        Radius of the relaxed start [beta].
    scales : Scales
        Its units in SI.
    left : float
        Pull-off force over that of adhesion of short range.
    """

    def __init__(
        self,
        profile: HalfSpaceProfile,
        *,
        radius: float,
        scales: Scales,
        left: float = 1.0,
    ) -> None:
        least = profile.elastic_radius
        a = np.linspace(least, max(radius, least) * 1.01, _ROWS)
        force, depth = profile.relaxed_force(a), profile.relaxed_depth(a)
        force = np.where(force < 0, left * force, force)
        self._middle = (force[1:] + force[:-1]) / 2 * scales.force
        self._compliance = np.diff(depth) / np.diff(force) * scales.depth / scales.force
        self._pull_off = -float(force[0]) * scales.force
        self.scales = scales

    @property
    def pull_off_force(self) -> float:
        """Largest tension [N]."""
        return self._pull_off * self._strength

    def over(self, time: float) -> Elastic:
        """Return the same contact, which has no modes."""
        return self

    def start(self) -> Array:
        """Return the state, which is empty."""
        return np.zeros(0)

    def radius(self, state: Array) -> float:
        """Return nan: the radius follows from the force."""
        return nan

    def energy(self, force: float, state: Array) -> float:
        """Return the energy release rate at the edge [dg], that of equilibrium."""
        return 1.0

    def gone(self, force: float, state: Array) -> bool:
        """Return whether the force exceeds the pull-off force."""
        return -force > _LAST * self.pull_off_force

    def flow(self, force: float, state: Array) -> Flow:
        """Return how the contact changes under a force [N]."""
        P = force / self.scales.force
        share = P**2 / (P**2 + _ONSET**2) if force < 0 else 0.0
        short = force / (1 + (self._strength - 1) * share)
        compliance = float(np.interp(short, self._middle, self._compliance))
        return Flow(compliance, 0.0, state)


class Pulled(NamedTuple):
    """How two contacts in series come apart.

    Attributes
    ----------
    opened : int
        The contact that opens, 0 or 1; -1 if they open together, to the tolerance.
    tension, time : float
        Largest common tension [N], and when [s].
    energy : tuple of float
        Energy at both edges at that time [dg].
    radius : tuple of float
        Both radii at that time over those at the start; nan for an elastic contact.
    held : float
        Radius of the contact that holds at the end, over that at the start; nan if elastic.
    """

    opened: int
    tension: float
    time: float
    energy: tuple[float, float]
    radius: tuple[float, float]
    held: float


def pull_apart(
    contacts: tuple[Receding | Elastic, Receding | Elastic],
    *,
    preload: float,
    speed: float,
    stiffness: float | None = None,
) -> Pulled:
    """Pull two contacts in series apart, from rest under a common preload.

    Parameters
    ----------
    contacts : two of Receding and Elastic
        Both contacts.
    preload : float
        Common force of the relaxed start [N], positive in compression.
    speed : float
        Speed of the drive [m/s], positive.
    stiffness : float or None
        Stiffness of the machine [N/m]; None for a rigid one.

    Raises
    ------
    OutOfRange
        If the differential equation cannot be solved.
    """
    first, second = contacts
    if isinstance(first, Elastic) and isinstance(second, Elastic):
        # the one with the smaller pull-off force opens
        forces = first.pull_off_force, second.pull_off_force
        opened = -1 if forces[0] == forces[1] else int(forces[1] < forces[0])
        return Pulled(opened, min(forces), nan, (1.0, 1.0), (nan, nan), nan)
    soft = 0.0 if stiffness is None else 1 / stiffness
    scale = max(abs(preload), first.scales.force, second.scales.force)
    natural = scale * (soft + first.softness + second.softness) / speed
    contacts = first, second = first.over(natural), second.over(natural)
    end = 1 + first.start().size

    def parts(y: Array) -> tuple[float, list[Array]]:
        return scale * float(y[0]), [y[1:end], y[end:]]

    def rates(_: float, y: Array) -> Array:
        force, states = parts(y)
        flows = [x.flow(force, state) for x, state in zip(contacts, states, strict=True)]
        compliance = soft + sum(flow.compliance for flow in flows)
        change = -(speed + sum(flow.creep for flow in flows)) / compliance
        return np.concatenate([[change / scale], *(flow.rates for flow in flows)])

    begin = np.concatenate([[preload / scale], first.start(), second.start()])
    longest = _LONGEST * natural
    first_step = _FIRST / abs(rates(0.0, begin)[0])
    for method in _METHODS:
        solver = getattr(scipy.integrate, method)(
            rates, 0.0, begin, longest, first_step=first_step, rtol=_TOLERANCE, atol=_TOLERANCE
        )
        top, top_time, at_top = 0.0, 0.0, begin
        for _ in range(_MOST_STEPS):
            with caught_warnings("ignore"):  # after a failure the next method is tried
                solver.step()
            force, states = parts(solver.y)
            if not np.all(np.isfinite(solver.y)) or solver.status != "running":
                break
            if -force > top:
                top, top_time, at_top = -force, float(solver.t), solver.y.copy()
            gone = [x.gone(force, state) for x, state in zip(contacts, states, strict=True)]
            if any(gone) or (top > 0 and -force < _FALLEN * top):
                return _pulled(contacts, gone, (top, top_time), parts(at_top)[1], (force, states))
    raise OutOfRange(
        "the equations of two steady cracks in series were not solved to a pull-off; simulate them"
    )


def _pulled(
    contacts: tuple[Receding | Elastic, Receding | Elastic],
    gone: list[bool],
    top: tuple[float, float],
    at_top: list[Array],
    end: tuple[float, list[Array]],
) -> Pulled:
    """Return the result of a run, from the states at the largest tension and at the end."""
    force, states = end
    pairs = list(zip(contacts, at_top, strict=True))
    start = [x.radius(x.start()) for x in contacts]
    radius = [x.radius(state) / a for (x, state), a in zip(pairs, start, strict=True)]
    last = [x.radius(state) / a for x, state, a in zip(contacts, states, start, strict=True)]
    # an elastic contact recedes with the force only
    receded = [0.0 if a != a else -log(a) for a in last]
    if gone[0] != gone[1]:
        opened = int(gone[1])
    elif abs(receded[1] - receded[0]) <= _TOGETHER * max(receded):
        opened = -1
    else:
        opened = int(receded[1] > receded[0])
    energy = tuple(x.energy(-top[0], state) for x, state in pairs)
    held = nan if opened < 0 else last[1 - opened]
    return Pulled(opened, *top, energy, tuple(radius), held)  # type: ignore[arg-type]
