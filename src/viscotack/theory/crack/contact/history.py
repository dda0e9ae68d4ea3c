r"""A contact through any history: annuli, each with its viscoelastic spring, and two kinds of edge.

An annulus s in contact has the opening :math:`\chi_u = D - g(s)`, one outside what its creep has
left; its elastic part :math:`\chi_e` follows from the chain
:math:`\chi_u = c \chi_e + \sum_j w_j d_j`, :math:`\tau_j d_j' = \chi_e - d_j`, and is zero outside.
The force is :math:`P = 2 \int_0^a \chi_e ds`. An edge that opens has
:math:`\chi_e(a)^2/2 \pi a = \Gamma(V)`, one that closes :math:`[\chi_u(a)]^2/2 \pi a = \Gamma(-V)`
with the jump of :math:`\chi_u` there: in front of a crack that opens nothing has crept, and behind
one that closes the shape is given.

Units as in :mod:`._profile`, times in the unit of the material. Between the annuli the memory is
straight in g, which is exact for what was brought in at rest.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.errors import OutOfRange
from viscotack.theory.crack.steady import SteadyCrack

from ._edge import Edge
from ._memory import Chain, chain_of
from ._profile import Profile

Array = npt.NDArray[np.float64]

# Annuli, the part of them below the tenth of the largest radius, and how far beyond the start.
_ANNULI, _SMALLEST = 360, 0.01
# Bounds of a step: change of the radius over it, of the drive over the height of JKR's pull-off,
# of its length over the one before; and the first one over the time of a move.
_TRAVEL, _DRIVE, _GROWTH, _FIRST = 0.006, 0.05, 1.6, 1e-5
# Rounds of a root and its tolerance; steps of a history at most.
_ROUNDS, _CLOSE, _MOST_STEPS = 60, 1e-10, 20_000
# Radius [beta] below which nothing is left of a contact; and in the last retraction, where one that
# snaps off behind a spring would close and open again without end, and without inertia.
_GONE, _LEFT = 0.02, 0.1


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
        Depth [beta^2/R], force of short range [R dg], contact radius [beta].
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
    """Time, given value, depth, force, radius, elastic parts and memories of the annuli."""

    time: float
    drive: float
    depth: float
    force: float
    radius: float
    elastic: Array
    memory: Array


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
    """

    def __init__(
        self,
        crack: SteadyCrack,
        profile: Profile,
        *,
        tabor: float,
        largest: float,
        stiffness: float | None = None,
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

    def relaxed(self, radius: float) -> _State:
        """Return a relaxed contact of a radius."""
        depth = float(self._profile.relaxed_depth(radius))
        elastic = depth - self._g
        # the annulus behind the edge goes on like those before it, for what lies between them
        inside = self._s < radius + np.append(self._ds, 0.0)
        memory = np.where(inside, elastic, 0.0)[:, None] * np.ones(self._chain.times.size)
        force = float(self._profile.relaxed_force(radius))
        return _State(0.0, self._drive(depth, force), depth, force, radius, elastic, memory)

    def apart(self, depth: float) -> _State:
        """Return surfaces that do not touch, at a depth below zero."""
        memory = np.zeros((self._s.size, self._chain.times.size))
        return _State(0.0, depth, depth, 0.0, 0.0, np.zeros(self._s.size), memory)

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
            self._note(rows, state, found, number)
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

    def _longest(self, drive: Drive) -> float:
        if drive.speed == 0:
            return np.inf if not self._chain.times.size else drive.duration / 20
        return _DRIVE / abs(drive.speed)

    def _slowest(self, drive: Drive) -> float:
        return drive.duration if drive.speed == 0 else 1.0 / abs(drive.speed)

    def _note(self, rows: list[Any], before: _State, now: _State, number: int) -> None:
        dt, moved = now.time - before.time, before.radius - now.radius
        speed = self._mu2 * moved / dt if dt > 0 else 0.0
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
        return step.state(radius, time), far


class _Step:
    """One step of a contact: what follows from a radius at its end."""

    def __init__(
        self, contact: Contact, state: _State, control: str, value: float, dt: float
    ) -> None:
        self._of, self._before, self._control, self._value = contact, state, control, value
        self._dt = dt
        chain = contact._chain
        self._decay, old, self._new, self._c = chain.step(dt)
        kept = state.memory @ (chain.weights * self._decay)
        self._old = old
        self._out = kept
        self._in = kept + float(chain.weights @ old) * state.elastic
        self._sum_in, self._sum_out = (self._cumulated(m) for m in (self._in, self._out))

    def _cumulated(self, memory: Array) -> Array:
        """Return the integral of a memory, straight in g, up to each annulus."""
        of = self._of
        rise = np.diff(memory) / of._dg
        parts = memory[:-1] * of._ds + rise * (of._total - of._g[:-1] * of._ds)
        return np.append(0.0, np.cumsum(parts))

    def _memory_at(self, a: float, memory: Array, total: Array) -> tuple[float, float]:
        """Return a memory at a radius, and its integral up to there."""
        a = float(a)
        of = self._of
        i = min(int(max(a - of._inner, 0.0) / of._apart) + (a > of._inner), of._s.size - 2)
        rise = (memory[i + 1] - memory[i]) / of._dg[i]
        g, s = float(of._profile.depth(a)), float(of._s[i])
        whole = float(of._profile.total(a)) - of._whole[i]
        part = memory[i] * (a - s) + rise * (whole - of._g[i] * (a - s))
        return float(memory[i] + rise * (g - of._g[i])), float(total[i] + part)

    def at(self, a: float) -> tuple[float, float, float]:
        """Return depth, force and memory in front of the edge for a radius at the end."""
        before = self._before.radius
        a = float(a)
        lag, whole = self._memory_at(min(a, before), self._in, self._sum_in)
        if a > before:
            _, until = self._memory_at(before, self._out, self._sum_out)
            lag, beyond = self._memory_at(a, self._out, self._sum_out)
            whole += beyond - until
        whole += float(self._of._profile.total(a))
        c, value, stiffness = self._c, self._value, self._of._stiffness
        if self._control == "force":
            depth = (value * c / 2 + whole) / max(a, 1e-12)
        elif self._control == "depth" or stiffness is None:
            depth = value
        else:
            soft = 2 / (c * stiffness)
            depth = (value + soft * whole) / (1 + soft * a)
        return depth, 2 / c * (depth * a - whole), lag

    def edge(self) -> float:
        """Return the radius at the end of the step."""
        before = self._before.radius
        of = self._of
        if before == 0:
            return self._closed(0.0) if self._touches() else 0.0
        depth, _, lag = self.at(before)
        g, around = float(of._profile.depth(before)), 2 * np.pi * before
        lift = min((depth - g - lag) / self._c, 0.0)
        out, _ = self._memory_at(before, self._out, self._sum_out)
        jump = min(depth - g - out, 0.0)
        opens, closes = lift**2 / around > 1, jump**2 / around < 1
        if closes and depth >= self._before.depth:
            return self._closed(before)
        return self._opened(before) if opens else before

    def _touches(self) -> bool:
        if self._control == "force":
            return self._value > 0
        return self._value > float(self._out[0])

    def _opened(self, before: float) -> float:
        """Return the largest radius at which the energy is that of a crack that opens."""

        def excess(a: float) -> float:
            depth, _, lag = self.at(a)
            lift = min((depth - float(self._of._profile.depth(a)) - lag) / self._c, 0.0)
            speed = self._of._mu2 * (before - a) / self._dt
            asked = self._of._opening.one(speed)
            return lift**2 / (2 * np.pi * a) - asked

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
            depth, _, _ = self.at(a)
            out = self._memory_at(a, self._out, self._sum_out)[0]
            jump = min(depth - float(self._of._profile.depth(a)) - out, 0.0)
            speed = self._of._mu2 * (a - before) / self._dt
            return self._of._closing.one(speed) - jump**2 / (2 * np.pi * a)

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
        inside = of._s < before.radius
        memory = np.where(inside, self._in, self._out)
        # behind the edge too, for what lies between two annuli
        reach = np.append(of._ds, 0.0)
        lagging = np.where(of._s < before.radius + reach, self._in, memory)
        elastic = (depth - of._g - lagging) / self._c
        then = np.where(of._s < before.radius + reach, before.elastic, 0.0)
        now = np.where(of._s < radius + reach, elastic, 0.0) if radius > 0 else 0.0 * elastic
        memories = before.memory * self._decay
        memories = memories + then[:, None] * self._old + now[:, None] * self._new
        drive = self._value if self._control == "drive" else of._drive(depth, force)
        return _State(time, drive, depth, force, radius, elastic, memories)


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
