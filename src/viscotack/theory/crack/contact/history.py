r"""Contact with any loading history: annuli of viscoelastic springs and a moving edge.

An annulus s in contact has the opening :math:`\chi_u = D - g(s)`; outside the contact the opening
is the remaining creep. Its elastic part :math:`\chi_e` follows from the chain :math:`\chi_u = c
\chi_e + \sum_j w_j d_j`, :math:`\tau_j d_j' = \chi_e - d_j`, and is zero outside. The force is
:math:`P = 2 \int_0^a \chi_e ds`. An opening edge satisfies :math:`\chi_e(a)^2/2 \pi a = \Gamma(V)`,
a closing edge :math:`[\chi_u(a)]^2/2 \pi a = \Gamma(-V)` with the jump of :math:`\chi_u` there: the
material ahead of an opening crack has no creep due to it, and the shape behind a closing crack is
given.

**Two memories.** The material ahead of the edge has the outer memory, that behind it the inner
memory. In a relaxed contact the outer one is zero and the inner one :math:`d_j = \chi_e`, so lift
and jump are both D - g(a), both energies are 1, and the edge is at rest. Each memory evolves
separately. An annulus that closes starts from its outer memory; one that opens keeps its inner one.
The two annuli next to the edge have both, and mix them by the fraction of the distance between them
that the edge has passed. The jump is evaluated one zone ahead of the edge, at least one annulus:
directly at the edge an opening of 1e-12 would leave the inner memory, hence a jump of :math:`c
\chi_e` and energy k^2.

**Direction of motion.** If only the opening energy exceeds 1, the edge opens; if only the closing
energy is below 1, it closes; if neither, it rests. During motion both may hold: just opened annuli
have a small jump, just closed ones a large lift. Then the edge keeps its direction, until
the drive moves the other way and the edge is slower than :math:`|\dot a| g'(a) < 1.5 |\dot D|`. An
edge that closes turns only if it could open across the whole zone that it has just closed: at the
edge itself the lift depends on the age of the last annulus, and with it on the step. The factor is
calibrated to simulations of 78 spheres that are pulled 3 to 300 times more slowly than they were
pressed, without a dwell: forces are 0.2 % high in the mean and scatter by 0.8 %; with 1 they are
0.9 % high, with 2.5 they are 0.4 % low. The rate of the last step is used, because that of a trial
step would depend on the decision. After a reversal the edge does not reverse again before the drive
does.

**Steps.** Memories are exact for elastic parts linear in time. The rate of the edge at the end of
a step is that of the parabola through this step and the previous one, of second order, if the edge
keeps its direction.

**Range.** The force on the machine is reduced for the finite range of the law, by a fraction that
depends on the opening speed (`tension` of :class:`Contact`).

Units as in :mod:`._profile`, times in the material's unit. Between annuli the memory is
linear in g, which is exact for contacts formed at rest.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import log
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import OutOfRange
from viscotack.model.materials import Modes
from viscotack.model.materials.modes import reciprocal
from viscotack.theory.crack.contact._profile import HalfSpaceProfile
from viscotack.theory.crack.steady import SteadyCrack, energy_of_odds
from viscotack.theory.crack.steady._mesh import mean_decay

# ln of the odds of Gamma at both ends of the table, and number of rows.
_ODDS, _ROWS = (-14.0, 12.0), 8000
# Number of rows of other tables over the speed.
_OTHERS = 1000
# Gamma - 1 of the slowest crack of an interface that grows with the opening speed.
_GAINED = 1e-6


class Even:
    """Linear interpolation on a uniform grid, constant beyond the ends."""

    def __init__(self, first: float, last: float, values: Array) -> None:
        self._first, self._per = first, (values.size - 1) / (last - first)
        self._values, self._last = values, values.size - 1
        self._rise = np.append(np.diff(values), 0.0)

    def __call__(self, x: Any) -> Any:
        """Return the values at x."""
        # minimum and maximum, because np.clip dominates the time for small arrays
        place = np.minimum(np.maximum((x - self._first) * self._per, 0.0), self._last)
        i = place.astype(np.intp)
        return self._values[i] + (place - i) * self._rise[i]

    def one(self, x: float) -> float:
        """Return the value at a scalar x, without array overhead."""
        place = min(max((x - self._first) * self._per, 0.0), float(self._last))
        i = int(place)
        return float(self._values[i] + (place - i) * self._rise[i])


class Edge:
    """Gamma as a function of ln V for an opening (sign 1) or closing (-1) crack."""

    def __init__(self, crack: SteadyCrack, sign: int) -> None:
        k = crack.modes.instantaneous
        self.limit, self.sign = (crack.largest if sign > 0 else k), sign
        # an interface that grows with the opening speed has no such limit
        grown = sign > 0 and crack.largest != 1 / k
        self.elastic, self.span = k == 1 and not grown, (0.0, 0.0)
        if self.elastic:
            return
        ends = energy_of_odds(np.exp(np.array(_ODDS)), k, sign)
        if grown:
            ends = 1 + np.array([_GAINED, (1 - 1e-9) * (crack.largest - 1)])
        first, last = np.log(np.abs(np.asarray(crack.speed(ends))))
        speed = np.exp(np.linspace(first, last, _ROWS))
        self._gamma = Even(first, last, np.asarray(crack.amplification(sign * speed)))
        self.span = first, last

    def amplification(self, speed: Any) -> Any:
        """Return Gamma at speeds, not negative."""
        if self.elastic:
            return np.ones(np.shape(speed))
        with np.errstate(divide="ignore"):
            return self._gamma(np.log(speed))

    def one(self, speed: float) -> float:
        """Return Gamma at one speed; negative speeds count as zero (round-off of the edge)."""
        if self.elastic or speed <= 0:
            return 1.0
        return self._gamma.one(log(speed))

    def table(self, quantity: Callable[[Array], Array]) -> Even | None:
        """Tabulate a function of the speed over ln V; None if Gamma is constant."""
        if self.elastic:
            return None
        first, last = self.span
        return Even(first, last, quantity(np.exp(np.linspace(first, last, _OTHERS))))


class Chain(NamedTuple):
    """Creep in exponential modes: instantaneous compliance, weights, retardation times."""

    instantaneous: float
    weights: Array
    times: Array

    def step(self, dt: float) -> tuple[Array, Array, Array, float]:
        """Return decay, weights of the old and the new e, and the compliance of a step."""
        x = dt / self.times
        mean, decay = mean_decay(x), np.exp(-x)
        compliance = self.instantaneous + float(self.weights @ (1 - mean))
        return decay, mean - decay, 1 - mean, compliance


def chain_of(modes: Modes) -> Chain:
    """Return the modes as arrays."""
    return Chain(modes.instantaneous, np.array(modes.weights), np.array(modes.times))


def hereditary_travel(chain: Chain, time: Array) -> Array:
    r"""Return :math:`\int_0^t \psi(s) ds`, psi the relaxation from 1/k to 1.

    It is the travel of an elastic solid equivalent to a retraction at constant unit speed.
    """
    if not chain.times.size:
        return np.asarray(time, dtype=float)
    weights, times = reciprocal(chain.instantaneous, chain.weights, chain.times)
    x = np.asarray(time)[..., None] / times
    return np.asarray(time) + (-np.expm1(-x) * times) @ weights


# Number of annuli, fraction of them below a tenth of the largest radius, and margin beyond the
# start.
_ANNULI, _SMALLEST = 360, 0.01
# Limits of a step: change of the radius, of the drive relative to the depth of JKR's pull-off,
# and of its length relative to the previous one; and first step relative to the time of a move.
# An edge that turns does so at a rate, which steps that grew by 1.6 overran: forces were up to 3 %
# off.
_TRAVEL, _DRIVE, _GROWTH, _FIRST = 0.008, 0.07, 1.15, 1e-5
# Number of steps of a wait, at least, and of the rest of it before its end: an edge that reverses
# then depends on the memory which it has left last. With 20 even steps forces were 10 % off.
_WAIT, _BEFORE_END = 60, 3
# Iterations of a root and its tolerance; largest number of steps of a history.
_ROUNDS, _CLOSE, _MOST_STEPS = 60, 1e-10, 20_000
# Radius [beta] below which the contact has vanished; and the same in the last retraction, where
# without inertia a contact behind a spring would otherwise close and open again repeatedly.
_GONE, _LEFT = 0.02, 0.1
# Tolerance for the energy of an edge at rest. An edge that can both open and close follows the
# drive if it is slower than this factor times the rate imposed by the drive.
_EQUAL, _AGAINST = 1e-10, 1.5


@dataclass(frozen=True)
class Drive:
    """A motion of the machine.

    Parameters
    ----------
    control : str
        Controlled quantity: "drive", "depth" or "force".
    speed : float
        Rate of the controlled quantity [beta^2/R or R dg, per time unit].
    duration : float
        Largest duration [time unit]; infinite if only the end condition stops it.
    end : tuple of (str, float), or None
        Optional end condition: "depth", "force" or "radius", and its value.
    target : float or None
        In place of the speed: value of the controlled quantity at the end of the duration.
    """

    control: str
    speed: float
    duration: float
    end: tuple[str, float] | None = None
    target: float | None = None


class Curve(NamedTuple):
    """Computed history: arrays over its steps.

    Attributes
    ----------
    time, depth, force, radius : ndarray
        Depth [beta^2/R], force on the machine [R dg], contact radius [beta].
    speed, amplification : ndarray
        Speed of the edge, positive for opening [E0* h0^2/(dg tau)], and its energy [dg].
    move : ndarray
        Index of the drive.
    detached : bool
        Whether the contact detached in the last step.
    """

    time: Array
    depth: Array
    force: Array
    radius: Array
    speed: Array
    amplification: Array
    move: npt.NDArray[np.intp]
    detached: bool


class _State(NamedTuple):
    """Time, controlled value, depth, force, radius, and memories of the annuli.

    `memory` is the inner one for annuli below the radius, and the outer one for the
    others. The two annuli next to the edge also have the other one, for interpolation up to the
    edge from either side: `beside` is the inner memory at the first annulus beyond the edge, and
    the outer one at the last annulus before it. `elastic` extends one annulus beyond the edge.
    `travel` is the mean rate of the radius over the last step and `step` its length, infinite after
    a jump or at the start; `rate` is the rate of the radius at its end. `left` is the fraction of
    the short-range tension at this edge speed. `way` is the sign of the last motion of the edge, 0
    at the start.
    """

    time: float
    drive: float
    depth: float
    force: float
    radius: float
    elastic: Array
    memory: Array
    beside: Array
    left: float
    travel: float = 0.0
    step: float = np.inf
    rate: float = 0.0
    way: float = 0.0


class Contact:
    """A shape on a solid whose contact edge is a steady crack.

    Parameters
    ----------
    crack : SteadyCrack
        Crack of the solid with the reduced law.
    profile : HalfSpaceProfile
        Profile of the reduced shape.
    tabor : float
        Tabor number.
    largest : float
        Largest radius of the history [beta].
    stiffness : float or None
        Stiffness of the machine [R dg over beta^2/R]; None for a rigid one.
    tension : callable, optional
        Fraction of the short-range tension for the finite range of the law, as a function of
        opening speeds; applied to the force on the machine. None for a law of zero range.
    """

    def __init__(
        self,
        crack: SteadyCrack,
        profile: HalfSpaceProfile,
        *,
        tabor: float,
        largest: float,
        stiffness: float | None = None,
        tension: Callable[[Array], Array] | None = None,
    ) -> None:
        self._profile, self._mu2, self._stiffness = profile, tabor**2, stiffness
        self._chain: Chain = chain_of(crack.modes)
        self._opening, self._closing = Edge(crack, 1), Edge(crack, -1)
        inner = _SMALLEST * largest
        # equidistant beyond the innermost ones
        self._s = np.append(0.0, np.linspace(inner, largest, _ANNULI))
        self._inner, self._apart = inner, (largest - inner) / (_ANNULI - 1)
        self._g = np.asarray(profile.depth(self._s))
        self._ds, self._dg = np.diff(self._s), np.diff(self._g)
        self._whole = np.asarray(profile.total(self._s))
        self._total = np.diff(self._whole)
        self._at_rest, self._tension = 1.0, None
        if tension is not None:
            self._at_rest = float(tension(np.zeros(1))[0])
            self._tension = self._opening.table(tension)
        self._ahead = max(crack.zone_length / self._mu2, self._apart)

    def relaxed(self, radius: float) -> _State:
        """Return a relaxed contact of a radius."""
        depth = float(self._profile.relaxed_depth(radius))
        elastic, modes = depth - self._g, self._chain.times.size
        last = self.last_inside(radius)
        elastic[last + 2 :] = 0.0
        memory = np.repeat(elastic[:, None], modes, axis=1)
        memory[last + 1] = 0.0
        beside = np.zeros((2, modes))
        beside[0] = elastic[last + 1]
        force = float(self._profile.relaxed_force(radius))
        force *= self._at_rest if force < 0 else 1.0
        drive, left = self._drive(depth, force), self._at_rest
        return _State(0.0, drive, depth, force, radius, elastic, memory, beside, left)

    def apart(self, depth: float) -> _State:
        """Return separated surfaces, at a negative depth."""
        memory = np.zeros((self._s.size, self._chain.times.size))
        elastic = np.zeros(self._s.size)
        beside, left = np.zeros_like(memory[:2]), self._at_rest
        return _State(0.0, depth, depth, 0.0, 0.0, elastic, memory, beside, left)

    def last_inside(self, radius: float) -> int:
        """Return the index of the last annulus below a radius, -1 if there is none."""
        if radius <= 0:
            return -1
        i = self.interval(radius)
        return i if self._s[i] < radius else i - 1

    def interval(self, radius: float) -> int:
        """Return the index of the annulus at the lower end of the interval of a radius."""
        i = int(max(radius - self._inner, 0.0) / self._apart) + (radius > self._inner)
        return min(i, self._s.size - 2)

    def run(self, start: _State, drives: tuple[Drive, ...]) -> Curve:
        """Compute the history of a start, until detachment in the last drive or its end."""
        rows = [(start, 0.0, 1.0, 0)]
        state, detached, begins = start, False, [0.0]
        for number, drive in enumerate(drives):
            last = number == len(drives) - 1
            # use a separate time for each drive, because short steps after a long one would be lost
            # in round-off
            state, detached = self._through(state._replace(time=0.0), drive, number, rows, last)
            begins.append(begins[-1] + state.time)
        columns = list(zip(*((*row[0][:5], *row[1:]) for row in rows), strict=True))
        time, _, depth, force, radius, speed, energy, move = (np.array(c) for c in columns)
        time = time + np.array(begins)[move.astype(int)]
        return Curve(time, depth, force, radius, speed, energy, move.astype(int), detached)

    def _through(
        self, state: _State, drive: Drive, number: int, rows: list[Any], last: bool
    ) -> tuple[_State, bool]:
        """Compute one drive and append its steps."""
        given = getattr(state, drive.control)
        begin, end = state.time, state.time + drive.duration
        if drive.target is not None:
            drive = replace(drive, speed=(drive.target - given) / drive.duration)
        slowest = drive.duration if drive.speed == 0 else 1.0 / abs(drive.speed)
        dt = min(_FIRST * slowest, self._longest(drive, drive.duration))
        least = 1e-7 * dt
        for _ in range(_MOST_STEPS):
            dt = min(dt, self._longest(drive, end - state.time))
            found, jumped = self._tried(state, drive, given, begin, dt, least)
            while found is None:
                dt /= 2
                found, jumped = self._tried(state, drive, given, begin, dt, least)
            if drive.end is not None and _reached(found, drive):
                dt, found = self._to_the_end(state, drive, given, begin, dt, found)
            moved = found.radius - state.radius
            if last and found.radius < min(_LEFT, state.radius) and drive.speed < 0:
                found = found._replace(radius=0.0, force=0.0)
            speed = -self._mu2 * found.rate
            edge = self._opening if speed >= 0 else self._closing
            rows.append((found, speed, edge.one(abs(speed)), number))
            gone = state.radius > 0 and found.radius == 0
            met = drive.end is not None and dt > 0 and _reached(found, drive)
            state = found
            if (gone and last) or met or state.time >= end * (1 - 1e-12):
                return state, gone or (last and state.radius == 0)
            scale = max(state.radius, 0.05)
            fast = abs(moved) > _TRAVEL * scale and not jumped
            dt *= max(0.3, _TRAVEL * scale / abs(moved)) if fast else _GROWTH
        raise OutOfRange(
            f"the history needs more than {_MOST_STEPS:,} steps; shorten it, or simulate it"
        )

    def _drive(self, depth: float, force: float) -> float:
        return depth if self._stiffness is None else depth + force / self._stiffness

    def _longest(self, drive: Drive, rest: float) -> float:
        """Return the longest step in what is left of a drive."""
        if drive.speed != 0:
            return min(_DRIVE / abs(drive.speed), rest)
        if not self._chain.times.size or rest < _FIRST * drive.duration:
            return rest
        return min(drive.duration / _WAIT, rest / _BEFORE_END)

    def _to_the_end(
        self, state: _State, drive: Drive, given: float, begin: float, dt: float, found: _State
    ) -> tuple[float, _State]:
        """Return the step that ends at the end of the drive, from one and its end beyond it."""
        low, high = 0.0, dt
        for _ in range(40):
            middle = (low + high) / 2
            trial, _ = self._tried(state, drive, given, begin, middle, np.inf)
            assert trial is not None
            if _reached(trial, drive):
                high, found = middle, trial
            else:
                low = middle
            if high - low < 1e-6 * high:
                break
        return high, found

    def _tried(
        self, state: _State, drive: Drive, given: float, begin: float, dt: float, least: float
    ) -> tuple[_State | None, bool]:
        """Return the state after a step (None if it moved too far), and whether it jumped."""
        time = state.time + dt
        value = given + drive.speed * (time - begin)
        step = _Step(self, state, drive.control, value, dt)
        radius = step.edge()
        scale = max(state.radius, radius, 0.05)
        far = abs(radius - state.radius) > 4 * _TRAVEL * scale
        if far and dt > least:
            return None, False
        found = step.state(radius, time)
        return (found._replace(step=np.inf) if far else found), far


class _Step:
    """One step of a contact, as a function of the radius at its end."""

    def __init__(
        self, contact: Contact, state: _State, control: str, value: float, dt: float
    ) -> None:
        self._of, self._before, self._control, self._value = contact, state, control, value
        self._dt = dt
        chain = contact._chain
        self._decay, self._old, self._new, self._c = chain.step(dt)
        self._last = last = contact.last_inside(state.radius)
        kept = chain.weights * self._decay
        lag = state.memory @ kept + float(chain.weights @ self._old) * state.elastic
        self._in, self._out = lag, lag.copy()
        if last >= 0:
            beyond = last + 1
            self._out[beyond] -= float(chain.weights @ self._old) * state.elastic[beyond]
            self._in[beyond] += float(kept @ (state.beside[0] - state.memory[beyond]))
            self._out[last] = float(kept @ state.beside[1])
        self._sum_in, self._sum_out = (self._cumulated(m) for m in (self._in, self._out))
        self._until = self._outside(state.radius)[1]

    def _cumulated(self, memory: Array) -> Array:
        """Return the integral of a memory, linear in g, up to each annulus."""
        of = self._of
        rise = np.diff(memory) / of._dg
        parts = memory[:-1] * of._ds + rise * (of._total - of._g[:-1] * of._ds)
        return np.append(0.0, np.cumsum(parts))

    def _memory_at(self, a: float, memory: Array, total: Array, i: int) -> tuple[float, float]:
        """Return a memory at a radius beyond annulus i, and its integral up to there."""
        of = self._of
        rise = (memory[i + 1] - memory[i]) / of._dg[i]
        g, s = float(of._profile.depth(a)), float(of._s[i])
        whole = float(of._profile.total(a)) - of._whole[i]
        part = memory[i] * (a - s) + rise * (whole - of._g[i] * (a - s))
        return float(memory[i] + rise * (g - of._g[i])), float(total[i] + part)

    def _inside(self, a: float) -> tuple[float, float]:
        """Return the inner memory at a radius, and its integral."""
        i = min(self._of.interval(a), max(self._last, 0))
        return self._memory_at(a, self._in, self._sum_in, i)

    def _outside(self, a: float) -> tuple[float, float]:
        """Return the outer memory at a radius, and its integral."""
        i = max(self._of.interval(a), self._last)
        return self._memory_at(a, self._out, self._sum_out, i)

    def at(self, a: float) -> tuple[float, float, float]:
        """Return depth, force and memory ahead of the edge for a radius at the end."""
        before = self._before.radius
        a = float(a)
        lag, whole = self._inside(min(a, before))
        if a > before:
            lag, beyond = self._outside(a)
            whole += beyond - self._until
        whole += float(self._of._profile.total(a))
        c, value, stiffness = self._c, self._value, self._of._stiffness
        left = self._before.left
        if self._control == "force":
            short = value / left if value < 0 else value
            depth = (short * c / 2 + whole) / max(a, 1e-12)
        elif self._control == "depth" or stiffness is None:
            depth = value
        else:
            # without force the depth equals the drive
            soft = 2 / (c * stiffness) * (left if value * a < whole else 1.0)
            depth = (value + soft * whole) / (1 + soft * a)
        force = 2 / c * (depth * a - whole)
        return depth, force * left if force < 0 else force, lag

    def edge(self) -> float:
        """Return the radius at the end of the step."""
        before = self._before.radius
        if before == 0:
            out = 0.0 if self._control == "force" else float(self._out[0])
            return self._closed(0.0) if self._value > out else 0.0
        depth, _, lag = self.at(before)
        opens = self._lift(before, depth, lag) > 1 + _EQUAL
        closes = self._jump(before, depth) < 1 - _EQUAL
        drive, way = (depth - self._before.depth) / self._dt, self._before.way
        if way * drive > 0:
            # the edge reverses with the drive only; otherwise material it has just left would
            # reverse it again
            opens, closes = opens and way < 0, closes and way > 0
        elif closes and way > 0:
            closes = not (self._turns(drive) and self._lift_behind(before, depth) > 1)
            opens = opens and not closes
        elif opens and way < 0:
            opens = not (closes and self._turns(drive))
            closes = closes and not opens
        elif opens and closes:
            opens, closes = drive < 0, drive >= 0
        if closes:
            return self._closed(before)
        return self._opened(before) if opens else before

    def _lift(self, a: float, depth: float, lag: float) -> float:
        """Return the energy of an opening edge."""
        lift = min((depth - float(self._of._profile.depth(a)) - lag) / self._c, 0.0)
        return lift**2 / (2 * np.pi * a)

    def _lift_behind(self, a: float, depth: float) -> float:
        """Return the energy of an edge that opens across the zone that it has just closed."""
        behind = max(a - self._of._ahead, self._of._inner)
        return self._lift(behind, depth, self._inside(behind)[0])

    def _jump(self, a: float, depth: float) -> float:
        """Return the energy of a closing edge."""
        of = self._of
        out, _ = self._outside(min(a + of._ahead, float(of._s[-1])))
        jump = min(depth - float(of._profile.depth(a)) - out, 0.0)
        return jump**2 / (2 * np.pi * a)

    def _turns(self, drive: float) -> bool:
        """Return whether a drive against the edge outruns it, at this rate of the depth."""
        radius = self._before.radius
        inner, outer = (float(self._of._profile.depth(x * radius)) for x in (0.999, 1.001))
        slope = (outer - inner) / (0.002 * radius)
        return abs(self._before.travel) * slope < _AGAINST * abs(drive)

    def rate(self, a: float) -> float:
        """Return the rate of the radius at the end of the step.

        It is of second order in the time step if the edge keeps its direction; otherwise it is the
        mean rate of the step.
        """
        mean, before = (a - self._before.radius) / self._dt, self._before
        if mean * before.travel <= 0:
            return mean
        ratio = self._dt / before.step
        rate = ((1 + 2 * ratio) * mean - ratio * before.travel) / (1 + ratio)
        # a decelerating crack does not reverse
        return rate if rate * mean > 0 else 0.0

    def _opened(self, before: float) -> float:
        """Return the largest radius at which the energy equals that of an opening crack."""

        def excess(a: float) -> float:
            depth, _, lag = self.at(a)
            speed = -self._of._mu2 * self.rate(a)
            return self._lift(a, depth, lag) - self._of._opening.one(speed)

        low, shrink = before, 1e-7
        while low > _GONE and shrink < 1:
            high, low = low, before * (1 - shrink)
            if excess(low) < 0:
                return _bisected(excess, low, high)
            shrink *= 2
        return 0.0

    def _closed(self, before: float) -> float:
        """Return the smallest radius at which the energy equals that of a closing crack."""
        largest = float(self._of._s[-1])

        def excess(a: float) -> float:
            speed = self._of._mu2 * self.rate(a)
            return self._of._closing.one(speed) - self._jump(a, self.at(a)[0])

        grow, low, high = 1e-7, before, before
        while True:
            low, high = high, min(before + grow * max(before, 0.05), largest)
            if excess(high) < 0:
                return _bisected(excess, high, low)
            if high >= largest:
                raise OutOfRange(
                    "the contact grows beyond the largest expected radius; simulate it"
                )
            grow *= 2

    def state(self, radius: float, time: float) -> _State:
        """Return the state at the end of the step for a radius."""
        before, of = self._before, self._of
        if radius > 0:
            depth, force, _ = self.at(radius)
        else:
            depth = before.depth if self._control == "force" else self._value
            force = 0.0
        b, was, now = before.radius, self._last, of.last_inside(radius)
        lag = self._out.copy()
        lag[: was + 1] = self._in[: was + 1]
        # inner memory at the first annulus beyond the edge, outer memory at the last one before it
        memory, then = before.memory * self._decay, before.elastic.copy()
        beyond, behind = before.beside * self._decay
        if was >= 0:
            beyond = beyond + then[was + 1] * self._old
            then[was + 1] = 0.0
        memory += then[:, None] * self._old
        outside = memory[max(now, 0)].copy()
        if now == was:
            # mix the memories by the fraction of the distance between two annuli that the edge has
            # passed
            closed = max(radius - b, 0.0) / (of._s[was + 1] - b) if radius > 0 else 0.0
            beyond = beyond + closed * (memory[now + 1] - beyond)
            lag[now + 1] = (1 - closed) * self._in[now + 1] + closed * self._out[now + 1]
        else:
            beyond = memory[now + 1]
        elastic = np.zeros_like(before.elastic)
        if now >= 0:
            elastic[: now + 2] = (depth - of._g[: now + 2] - lag[: now + 2]) / self._c
            beyond = beyond + elastic[now + 1] * self._new
            memory[: now + 1] += elastic[: now + 1, None] * self._new
        if now == was >= 0:
            opened = max(b - radius, 0.0) / (b - of._s[was])
            behind = behind + opened * (memory[now] - behind)
        else:
            behind = outside if now > was else memory[now]
        beside = np.array([beyond, behind])
        travel, rate = (radius - b) / self._dt, self.rate(radius)
        drive = self._value if self._control == "drive" else of._drive(depth, force)
        # the fraction of the short-range tension that remains at this speed
        left = of._at_rest
        if of._tension is not None and rate < 0:
            left = of._tension.one(log(-of._mu2 * rate))
        edge = (left, travel, self._dt, rate, float(np.sign(travel)) or before.way)
        return _State(time, drive, depth, force, radius, elastic, memory, beside, *edge)


def _bisected(excess: Callable[[float], float], negative: float, positive: float) -> float:
    """Return the sign change of a function, by regula falsi (Illinois)."""
    x0, x1 = negative, positive
    f0, f1 = excess(x0), max(excess(x1), 0.0)
    side = 0
    for _ in range(_ROUNDS):
        x = (x0 * f1 - x1 * f0) / (f1 - f0) if f1 > 0 else x1
        f = excess(x)
        if abs(x1 - x0) < _CLOSE * abs(x1) or f == 0 or abs(f) < _CLOSE:
            return x
        if f < 0:
            x0, f0 = x, f
            f1 = f1 / 2 if side < 0 else f1
            side = -1
        else:
            x1, f1 = x, f
            f0 = f0 / 2 if side > 0 else f0
            side = 1
    return (x0 + x1) / 2


def _reached(state: _State, drive: Drive) -> bool:
    assert drive.end is not None
    name, value = drive.end
    now = getattr(state, name)
    return now >= value if drive.speed > 0 else now <= value
