r"""A contact through any history: annuli, each with its viscoelastic spring, and two kinds of edge.

An annulus s in contact has the opening :math:`\chi_u = D - g(s)`, one outside what its creep has
left; its elastic part :math:`\chi_e` follows from the chain
:math:`\chi_u = c \chi_e + \sum_j w_j d_j`, :math:`\tau_j d_j' = \chi_e - d_j`, and is zero outside.
The force is :math:`P = 2 \int_0^a \chi_e ds`. An edge that opens has
:math:`\chi_e(a)^2/2 \pi a = \Gamma(V)`, one that closes :math:`[\chi_u(a)]^2/2 \pi a = \Gamma(-V)`
with the jump of :math:`\chi_u` there: in front of a crack that opens nothing has crept, and behind
one that closes the shape is given.

**Two memories.** In front of the edge lies what the outside remembers, behind it what the inside
does. Of a relaxed contact the one is zero and the other :math:`d_j = \chi_e`, so that lift and
jump are both D - g(a), both energies are 1, and the edge rests. Each memory evolves on its own. An
annulus that is closed starts from its outer memory; one that is opened keeps its inner one. The two
annuli beside the edge have both, and take over the part of the other that the edge has passed of
the way between them. The jump is measured a zone in front of the edge, an annulus at least: right
at the edge an opening of 1e-12 would leave the memory of the inside, hence the jump
:math:`c \chi_e` of energy k^2.

**Which energy holds.** Only that of opening above 1: the edge opens; only that of closing below 1:
it closes; neither: it rests. In motion both hold: just opened annuli have a small jump, just closed
ones a large lift. Then it goes on as before, unless the drive moves the other way and the edge is
slower than :math:`|\dot a| g'(a) < 3 |\dot D|` (the 3 is that of slow reversals: 10 gives forces
3 % low, 1 gives 7 % high). The rate of the last step counts: that of a trial would decide about
itself. An edge that turned does not turn back before the drive does.

**Steps.** Memories are exact for elastic parts straight in time. The rate of the edge at the end of
a step is that of the parabola through this step and the one before, of second order, where the edge
goes on as before.

**Range.** The machine feels, holds and is sprung by tensions that the range of the law has reduced,
by a part that depends on the opening speed (`tension` of :class:`Contact`).

Units as in :mod:`._profile`, times in the unit of the material. Between the annuli the memory is
straight in g, which is exact for what was brought in at rest.
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
from viscotack.theory.crack.steady import SteadyCrack

from ._edge import Edge
from ._memory import Chain, chain_of
from ._profile import Profile

# Annuli, the part of them below the tenth of the largest radius, and how far beyond the start.
_ANNULI, _SMALLEST = 360, 0.01
# Bounds of a step: change of the radius over it, of the drive over the height of JKR's pull-off,
# of its length over the one before; and the first one over the time of a move.
_TRAVEL, _DRIVE, _GROWTH, _FIRST = 0.008, 0.07, 1.6, 1e-5
# Rounds of a root and its tolerance; steps of a history at most.
_ROUNDS, _CLOSE, _MOST_STEPS = 60, 1e-10, 20_000
# Radius [beta] below which nothing is left of a contact; and in the last retraction, where one that
# snaps off behind a spring would close and open again without end, and without inertia.
_GONE, _LEFT = 0.02, 0.1
# An energy is that of an edge at rest within round-off. An edge that could open as well as close
# turns with the drive where it is slower than so many times what the drive asks of it.
_EQUAL, _AGAINST = 1e-10, 3.0


@dataclass(frozen=True)
class Drive:
    """What the machine does for a while.

    Parameters
    ----------
    control : str
        "drive", "depth" or "force": what is given.
    speed : float
        How fast the given one grows [beta^2/R or R dg, per time unit].
    duration : float
        How long at most [time unit]; infinite until the end is met.
    end : tuple of (str, float), or None
        "depth", "force" or "radius" at which it ends before.
    target : float or None
        In place of the speed: the given value when the duration is over.
    """

    control: str
    speed: float
    duration: float
    end: tuple[str, float] | None = None
    target: float | None = None


class Curve(NamedTuple):
    """A history: arrays over its steps.

    Attributes
    ----------
    time, depth, force, radius : ndarray
        Depth [beta^2/R], force that the machine feels [R dg], contact radius [beta].
    speed, amplification : ndarray
        Of the edge, positive where it opens [E0* h0^2/(dg tau)], and its energy [dg].
    move : ndarray
        Number of the drive.
    detached : bool
        Whether the last step let go.
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
    """Time, given value, depth, force, radius, and what the annuli remember.

    `memory` is that of the inside for annuli of less than the radius, of the outside for the
    others. The two annuli beside the edge have the other one too, to interpolate up to the edge
    from either side: `beside` is that of the inside at the first annulus beyond, and that of the
    outside at the last one before. `elastic` goes one annulus beyond the edge. `travel` is the mean
    rate of the radius over the last step and `step` its length, infinite where it was a jump or
    there was none; `rate` is that of the radius at the end of it. `left` is the part of a tension
    of short range that is left at this speed of the edge. `way` is the
    sign of the last travel, 0 where there was none.
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
    """A shape on a solid with a steady crack for its edge.

    Parameters
    ----------
    crack : SteadyCrack
        Of the solid and the reduced law.
    profile : Profile
        Of the reduced shape.
    tabor : float
        Tabor number.
    largest : float
        Largest radius of the history [beta].
    stiffness : float or None
        Of the machine [R dg over beta^2/R]; None for a rigid one.
    tension : callable, optional
        Part of a tension of short range that the range of the law leaves, at opening speeds: what
        the machine feels, holds and is sprung by. None where the range is no length at all.
    """

    def __init__(
        self,
        crack: SteadyCrack,
        profile: Profile,
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
        # at even distances beyond the innermost
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
        """Return surfaces that do not touch, at a depth below zero."""
        memory = np.zeros((self._s.size, self._chain.times.size))
        elastic = np.zeros(self._s.size)
        beside, left = np.zeros_like(memory[:2]), self._at_rest
        return _State(0.0, depth, depth, 0.0, 0.0, elastic, memory, beside, left)

    def last_inside(self, radius: float) -> int:
        """Return the number of the last annulus of less than a radius, -1 if there is none."""
        if radius <= 0:
            return -1
        i = self.interval(radius)
        return i if self._s[i] < radius else i - 1

    def interval(self, radius: float) -> int:
        """Return the number of the annulus from which on a radius lies."""
        i = int(max(radius - self._inner, 0.0) / self._apart) + (radius > self._inner)
        return min(i, self._s.size - 2)

    def run(self, start: _State, drives: tuple[Drive, ...]) -> Curve:
        """Return the history of a start, until the contact lets go in the last drive or it ends."""
        rows = [(start, 0.0, 1.0, 0)]
        state, detached, begins = start, False, [0.0]
        for number, drive in enumerate(drives):
            last = number == len(drives) - 1
            # a time of its own for each drive: after a long one, short steps would be round-off
            state, detached = self._through(state._replace(time=0.0), drive, number, rows, last)
            begins.append(begins[-1] + state.time)
        columns = list(zip(*((*row[0][:5], *row[1:]) for row in rows), strict=True))
        time, _, depth, force, radius, speed, energy, move = (np.array(c) for c in columns)
        time = time + np.array(begins)[move.astype(int)]
        return Curve(time, depth, force, radius, speed, energy, move.astype(int), detached)

    def _through(
        self, state: _State, drive: Drive, number: int, rows: list[Any], last: bool
    ) -> tuple[_State, bool]:
        """Go through one drive; append its steps."""
        given = {"drive": state.drive, "depth": state.depth, "force": state.force}[drive.control]
        begin, end = state.time, state.time + drive.duration
        if drive.target is not None:
            drive = replace(drive, speed=(drive.target - given) / drive.duration)
        longest = min(self._longest(drive), drive.duration)
        dt = min(_FIRST * self._slowest(drive), longest)
        least = 1e-7 * dt
        for _ in range(_MOST_STEPS):
            dt = min(dt, longest, end - state.time)
            found, jumped = self._tried(state, drive, given, begin, dt, least)
            while found is None:
                dt /= 2
                found, jumped = self._tried(state, drive, given, begin, dt, least)
            if drive.end is not None and _reached(found, drive):
                dt, found = self._to_the_end(state, drive, given, begin, dt)
            moved = found.radius - state.radius
            if last and found.radius < min(_LEFT, state.radius) and drive.speed < 0:
                found = found._replace(radius=0.0, force=0.0)
            self._note(rows, found, number)
            gone = state.radius > 0 and found.radius == 0
            met = drive.end is not None and dt > 0 and _reached(found, drive)
            state = found
            if (gone and last) or met or state.time >= end * (1 - 1e-12):
                return state, gone or (last and state.radius == 0)
            scale = max(state.radius, 0.05)
            fast = abs(moved) > _TRAVEL * scale and not jumped
            dt *= max(0.3, _TRAVEL * scale / abs(moved)) if fast else _GROWTH
        raise OutOfRange(
            f"the history needs more than {_MOST_STEPS:,} steps; make it shorter, or simulate it"
        )

    def _drive(self, depth: float, force: float) -> float:
        return depth if self._stiffness is None else depth + force / self._stiffness

    def _left(self, rate: float) -> float:
        """Return the part of a tension that is left while the radius changes at a rate."""
        if self._tension is None or rate >= 0:
            return self._at_rest
        return self._tension.one(log(-self._mu2 * rate))

    def _longest(self, drive: Drive) -> float:
        if drive.speed == 0:
            return np.inf if not self._chain.times.size else drive.duration / 20
        return _DRIVE / abs(drive.speed)

    def _slowest(self, drive: Drive) -> float:
        return drive.duration if drive.speed == 0 else 1.0 / abs(drive.speed)

    def _note(self, rows: list[Any], now: _State, number: int) -> None:
        speed = -self._mu2 * now.rate
        edge = self._opening if speed >= 0 else self._closing
        rows.append((now, speed, edge.one(abs(speed)), number))

    def _to_the_end(
        self, state: _State, drive: Drive, given: float, begin: float, dt: float
    ) -> tuple[float, _State]:
        """Return the step that ends where the drive does."""
        low, high = 0.0, dt
        found = state
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
        return high, found if found is not state else trial

    def _tried(
        self, state: _State, drive: Drive, given: float, begin: float, dt: float, least: float
    ) -> tuple[_State | None, bool]:
        """Return the state after a step, None where it moved too far; and whether it jumped."""
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
    """One step of a contact: what follows from a radius at its end."""

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
        """Return the integral of a memory, straight in g, up to each annulus."""
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
        """Return the memory of the inside at a radius, and its integral."""
        i = min(self._of.interval(a), max(self._last, 0))
        return self._memory_at(a, self._in, self._sum_in, i)

    def _outside(self, a: float) -> tuple[float, float]:
        """Return the memory of the outside at a radius, and its integral."""
        i = max(self._of.interval(a), self._last)
        return self._memory_at(a, self._out, self._sum_out, i)

    def at(self, a: float) -> tuple[float, float, float]:
        """Return depth, force and memory in front of the edge for a radius at the end."""
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
            # without force the depth is the drive
            soft = 2 / (c * stiffness) * (left if value * a < whole else 1.0)
            depth = (value + soft * whole) / (1 + soft * a)
        force = 2 / c * (depth * a - whole)
        return depth, force * left if force < 0 else force, lag

    def edge(self) -> float:
        """Return the radius at the end of the step."""
        before = self._before.radius
        if before == 0:
            return self._closed(0.0) if self._touches() else 0.0
        depth, _, lag = self.at(before)
        opens = self._lift(before, depth, lag) > 1 + _EQUAL
        closes = self._jump(before, depth) < 1 - _EQUAL
        drive, way = (depth - self._before.depth) / self._dt, self._before.way
        if opens and closes:
            opens = self._goes_on_opening(drive)
            closes = not opens
        elif way * drive > 0:
            # it turns with the drive, not against it: what it has just left would bring it back
            opens, closes = opens and way < 0, closes and way > 0
        if closes:
            return self._closed(before)
        return self._opened(before) if opens else before

    def _lift(self, a: float, depth: float, lag: float) -> float:
        """Return the energy of an edge that opens."""
        lift = min((depth - float(self._of._profile.depth(a)) - lag) / self._c, 0.0)
        return lift**2 / (2 * np.pi * a)

    def _jump(self, a: float, depth: float) -> float:
        """Return the energy of an edge that closes."""
        of = self._of
        out, _ = self._outside(min(a + of._ahead, float(of._s[-1])))
        jump = min(depth - float(of._profile.depth(a)) - out, 0.0)
        return jump**2 / (2 * np.pi * a)

    def _goes_on_opening(self, drive: float) -> bool:
        """Return whether an edge opens that could as well close, from the rate of the depth."""
        travel = self._before.travel
        if travel == 0:
            return drive < 0
        if travel * drive < 0:
            # the drive moves against it
            rise = float(self._of._profile.depth(1.001 * self._before.radius))
            rise -= float(self._of._profile.depth(0.999 * self._before.radius))
            slope = rise / (0.002 * self._before.radius)
            if abs(travel) * slope < _AGAINST * abs(drive):
                return drive < 0
        return travel < 0

    def rate(self, a: float) -> float:
        """Return the rate of the radius at the end, of second order where it goes on as before."""
        mean, before = (a - self._before.radius) / self._dt, self._before
        if mean * before.travel <= 0:
            return mean
        ratio = self._dt / before.step
        rate = ((1 + 2 * ratio) * mean - ratio * before.travel) / (1 + ratio)
        # a crack that slows down does not turn
        return rate if rate * mean > 0 else 0.0

    def _touches(self) -> bool:
        if self._control == "force":
            return self._value > 0
        return self._value > float(self._out[0])

    def _opened(self, before: float) -> float:
        """Return the largest radius at which the energy is that of a crack that opens."""

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
        """Return the smallest radius at which the energy is that of a crack that closes."""
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
                    "the contact grows beyond the largest radius that was expected; simulate it"
                )
            grow *= 2

    def state(self, radius: float, time: float) -> _State:
        """Return the state at the end of the step with a radius."""
        before, of = self._before, self._of
        if radius > 0:
            depth, force, _ = self.at(radius)
        else:
            depth = before.depth if self._control == "force" else self._value
            force = 0.0
        b, was, now = before.radius, self._last, of.last_inside(radius)
        lag = self._out.copy()
        lag[: was + 1] = self._in[: was + 1]
        # of the inside, at the first annulus beyond the edge; of the outside, at the last before
        memory, then = before.memory * self._decay, before.elastic.copy()
        beyond, behind = before.beside * self._decay
        if was >= 0:
            beyond = beyond + then[was + 1] * self._old
            then[was + 1] = 0.0
        memory += then[:, None] * self._old
        outside = memory[max(now, 0)].copy()
        if now == was:
            # what the edge passed of the way between two annuli, it passed of their memories
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
        left = of._left(rate)
        edge = (left, travel, self._dt, rate, float(np.sign(travel)) or before.way)
        return _State(time, drive, depth, force, radius, elastic, memory, beside, *edge)


def _bisected(excess: Callable[[float], float], negative: float, positive: float) -> float:
    """Return where a function changes its sign, by regula falsi (Illinois)."""
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


def _quantity(state: _State, name: str) -> float:
    return {"depth": state.depth, "force": state.force, "radius": state.radius}[name]


def _reached(state: _State, drive: Drive) -> bool:
    assert drive.end is not None
    name, value = drive.end
    now = _quantity(state, name)
    return now >= value if drive.speed > 0 else now <= value
