r"""Reduced contact of a sphere: force from depth, with a contact radius and a memory of the bulk.

Its numbers follow from a problem: units, arms, cells and the tables of its edge.

**State.** The half-space is the set of annuli of :mod:`viscotack.theory.crack.contact.history`,
joined to cells :math:`[s_i, s_{i+1}]`. With E* = 1 an annulus has the relaxed stiffness 1 and, for
each relaxation time, a Maxwell arm of modulus :math:`E_m` and strain :math:`e_m`. Inside the
contact radius a its surface is at :math:`u = \delta - s^2`, where it carries
:math:`\chi = u + \sum_m E_m e_m`; outside it is free, :math:`u_f = -\sum_m E_m e_m`. A cell has one
:math:`e_m` for its part inside and one for its part outside. Force and storage are

.. math:: F = 2 \int_0^a \chi\, ds, \qquad V = \int_0^\infty \Big(u^2 + \sum_m E_m e_m^2\Big) ds
          - f_0 \pi a^2,

the latter bounded from below by the JKR contact without load, :math:`-11.02 f_0^{5/3}`.

**A step** from depth :math:`\delta_0` to :math:`\delta_1` in the time dt has four parts. None of
them creates energy, so that :math:`\bar F (\delta_1 - \delta_0) \ge V_1 - V_0` for every step:

1. *Bulk.* At constant a, :math:`\dot e_m = \dot\delta - e_m/\tau_m` is integrated exactly for a
   constant speed. :math:`\bar F` is the mean of the force over this motion, so that its work is the
   change of V plus the heat in the arms.
2. *Pressed ground.* Annuli that the sphere meets before the edge arrives are taken into the
   contact. Their energy is the work of a force that is added to :math:`\bar F`.
3. *Recovery* of free annuli by a backward Euler step: V falls. Those that would rise into the
   sphere wait.
4. *Edge*, at constant depth. It opens where :math:`\chi(a)^2/2\pi a > \Gamma(v)` and closes where
   :math:`(u - u_f)^2/2\pi a < \Gamma(-v)`, with the steady crack's energy :math:`\Gamma` at the
   speed of this step (implicit, hence stable). In the zone of the crack, which is shorter than a
   cell, a crossing annulus relaxes for a time T(v). T is such that in a relaxed bulk the energy it
   sets free is exactly :math:`f_0 2 \pi a`: modes faster than the zone lose their strain, slower
   ones keep it. Where the bulk is not relaxed, the strains are multiplied by the largest factor up
   to 1 with which V does not rise; if there is none, the edge waits.

Mixing parts of a cell takes the mean of :math:`e_m`, and V, convex in it, does not rise.

**Range of attraction.** :math:`\Gamma` contains the factor f by which a law of finite range reduces
the tension, :math:`f_0` is that of an edge at rest. Contact begins where the sphere touches.

The edge is never faster than the last row of its table, so that the force is continuous in time.
Units inside: depths in beta^2/R, radii in beta, forces in R dg; arguments and results are in SI.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.model.geometry import Sphere
from viscotack.model.materials.modes import reciprocal
from viscotack.model.problem import Problem
from viscotack.model.traction import grows
from viscotack.simulate.crack_contact.by_crack import tension_left
from viscotack.simulate.crack_contact.crack_problem import LOAD, ROOT, groups_of
from viscotack.theory.crack.contact import Edge
from viscotack.theory.crack.steady import SteadyCrack
from viscotack.units import readable

# Doublings of the first trial of a step of the edge, and halvings of the bracket then found.
DOUBLINGS, HALVINGS = 50, 32
# First trial, over the radius; smallest radius for it, and radius below which the contact is gone.
FIRST, SMALL, GONE = 1e-7, 0.05, 1e-3
# Tolerance of an edge at rest. An edge that may open and close follows the drive if it is slower
# than this factor times the rate that the drive imposes.
REST, AGAINST = 1e-10, 3.0
# Part of the start of a step below which a series replaces the mean of a mean.
SERIES = 1e-3


class ContactState(NamedTuple):
    """State of n contacts, in the units of this module.

    Attributes
    ----------
    depth, radius : ndarray, shape (n,)
        Depth and contact radius, 0 without contact.
    rate, way : ndarray, shape (n,)
        Rate of the radius in the last step, and sign of its last motion.
    front : ndarray, shape (n,)
        Radius up to which the strains of the outermost cell inside are a mean.
    inner, outer : ndarray, shape (n, cells, modes)
        Strains of the arms inside and outside the contact.
    """

    depth: Array
    radius: Array
    rate: Array
    way: Array
    front: Array
    inner: Array
    outer: Array


@dataclass(frozen=True, eq=False)
class ReducedContact:
    """Sphere on a viscoelastic half-space with adhesion, as a force with state.

    Attributes
    ----------
    node : ndarray, shape (cells + 1,)
        Ends of the cells, from 0 [beta].
    modulus, relaxation_time : ndarray, shape (modes,)
        Arms of the solid, over its relaxed modulus, and their times [s].
    first, per : ndarray, shape (2,)
        ln of the rate [beta/s] in the first row of the tables, and rows per unit of it, of an
        opening and of a closing edge.
    energy, zone_time : ndarray, shape (2, rows)
        ln of the energy at the edge [dg], and of the time in its zone [s].
    surface : float
        Energy of the surface at rest, f0 [dg].
    length, force_unit, radius_unit : float
        Units of depths [m], forces [N] and radii [m].
    of : str
        The contact in words.
    range : str
        Where it holds.
    fastest : float
        Speed of an opening edge [m/s] up to which the bands hold until the pull-off; its zone is
        then 0.065 beta long. Infinite where zones are shorter at all speeds.
    force_band, work_band : (float, float)
        Relative half widths of bands that hold 19 of 20 simulated pull-off forces, and works to
        pull-off, of random approaches, dwells and pulls: of a slow edge, and of the fastest one.
    """

    node: Array
    modulus: Array
    relaxation_time: Array
    first: Array
    per: Array
    energy: Array
    zone_time: Array
    surface: float
    length: float
    force_unit: float
    radius_unit: float
    of: str
    range: str
    fastest: float
    force_band: tuple[float, float]
    work_band: tuple[float, float]

    def apart(self, depth: Any) -> ContactState:
        """Return contacts that are apart and relaxed, at depths [m] not above 0."""
        D = np.atleast_1d(np.asarray(depth, dtype=float)) / self.length
        if not np.all(D <= 0):
            raise InputError(f"depth apart must be 0 or negative, got {float(np.max(D)):.4g}")
        zero, field = np.zeros_like(D), np.zeros((D.size, self.node.size - 1, self.modulus.size))
        return ContactState(D, zero, zero, zero, zero, field, field)

    def step(self, state: ContactState, depth: Any, dt: float) -> tuple[ContactState, Array]:
        """Advance contacts by a time step.

        Parameters
        ----------
        state : ContactState
            The contacts at the start.
        depth : array_like
            Depths at the end [m], positive into the solid.
        dt : float
            Time step [s], positive.

        Returns
        -------
        state : ContactState
            The contacts at the end.
        mean : ndarray
            Mean forces of the step [N]: times the change of depth, the work.

        Raises
        ------
        ValueError
            If the time step is not positive or a depth is not finite.
        """
        D = np.broadcast_to(np.asarray(depth, dtype=float) / self.length, state.depth.shape)
        if not dt > 0 or not np.all(np.isfinite(D)):
            raise InputError(f"a step needs dt > 0 and finite depths, got dt = {dt!r} s")
        moved, x = D - state.depth, dt / self.relaxation_time
        inner, mean = self._bulk(state, D, x)
        radius, inner, work = self._pressed(state, inner, D, x)
        mean += np.divide(work, moved, out=np.zeros_like(work), where=work > 0)
        outer, rise = self._recovered(state.outer, x)
        low = np.maximum(self.node[:-1], radius[:, None])
        waits = D[:, None] - low**2 > rise
        outer = np.where(waits[..., None], state.outer, outer)
        front = np.where(radius > state.radius, radius, state.front)
        met = ContactState(D, radius, state.rate, state.way, front, inner, outer)
        return self._edge(met, moved / dt, dt), mean * self.force_unit

    def force(self, state: ContactState) -> Array:
        """Return the forces [N], positive in compression."""
        D, a = state.depth, state.radius
        arms = np.sum(self._inside(a) * (state.inner @ self.modulus), axis=1)
        return 2 * (a * (D - a * a / 3) + arms) * self.force_unit

    def radius(self, state: ContactState) -> Array:
        """Return the contact radii [m]."""
        return state.radius * self.radius_unit

    def edge_speed(self, state: ContactState) -> Array:
        """Return the speeds of the edges in the last step [m/s], positive where they open."""
        return -state.rate * self.radius_unit

    def stiffness(self, radius: float) -> float:
        """Return the largest stiffness at a contact radius [m], that of the glassy solid [N/m].

        A semi-implicit integrator of a mass m is stable for time steps below 2 sqrt(m/stiffness).
        """
        glassy = 1 + float(np.sum(self.modulus))
        return 2 * radius / self.radius_unit * glassy * self.force_unit / self.length

    def storage(self, state: ContactState) -> Array:
        """Return the stored energies V [J], 0 if relaxed and apart."""
        a, inside = state.radius, self._inside(state.radius)
        total = _pressed_energy(state.depth, 0 * a, a) - self.surface * np.pi * a * a
        total = total + np.sum(inside * (state.inner**2 @ self.modulus), axis=1)
        total = total + np.sum((np.diff(self.node) - inside) * self._stored(state.outer), axis=1)
        return total * self.force_unit * self.length

    def _inside(self, a: Array) -> Array:
        """Return the lengths of the cells inside radii."""
        return np.clip(a[:, None] - self.node[:-1], 0.0, np.diff(self.node))

    def _stored(self, e: Array) -> Array:
        """Return twice the energy of free annuli."""
        return (e @ self.modulus) ** 2 + e**2 @ self.modulus

    def _between(self, a: Array, b: Array) -> tuple[Array, Array, Array]:
        """Return the ends and lengths of the cells between two radii, a <= b."""
        low = np.maximum(self.node[:-1], a[:, None])
        high = np.minimum(self.node[1:], b[:, None])
        part = np.maximum(high - low, 0.0)
        return np.where(part > 0, low, 0.0), np.where(part > 0, high, 0.0), part

    def _bulk(self, state: ContactState, D: Array, x: Array) -> tuple[Array, Array]:
        """Return the strains inside after a step at constant radius, and the mean force."""
        lost = -np.expm1(-x)
        mean = lost / x
        half = np.where(x < SERIES, 0.5 - x / 6 + x * x / 24, (1 - mean) / x)
        moved, a = (D - state.depth)[:, None, None], state.radius
        arms = np.sum(
            self._inside(a) * ((state.inner * mean + moved * half) @ self.modulus), axis=1
        )
        force = 2 * (a * ((state.depth + D) / 2 - a * a / 3) + arms)
        return state.inner * (1 - lost) + moved * mean, force

    def _pressed(
        self, state: ContactState, inner: Array, D: Array, x: Array
    ) -> tuple[Array, Array, Array]:
        """Return radius and strains after the sphere met annuli outside, and the work of that."""
        a, outer = state.radius, state.outer
        height = D[:, None] + outer @ self.modulus
        touched = np.minimum(np.sqrt(np.maximum(height, 0.0)), self.node[1:])
        touched = np.where(touched > np.maximum(self.node[:-1], a[:, None]), touched, 0.0)
        b = np.where(state.depth < D, np.maximum(np.max(touched, axis=1), a), a)
        low, high, part = self._between(a, b)
        overlap = height - _square(low, high)
        e = outer + (-np.expm1(-x) / x) * overlap[..., None]
        gained = _pressed_energy(D[:, None], low, high)
        gained = gained + part * (e**2 @ self.modulus - self._stored(outer))
        work = np.maximum(np.sum(np.where(part > 0, gained, 0.0), axis=1), 0.0)
        return b, _mixed(inner, self._inside(a), e, part), work

    def _recovered(self, e: Array, x: Array) -> tuple[Array, Array]:
        """Return the strains of free annuli after a time x, over that of the arms, and surfaces."""
        below = -(e @ self.modulus)[..., None] - e
        arm = self.modulus / (1 + x)
        rise = np.sum(below * arm, axis=-1) / (1 + np.sum(arm, axis=-1))
        return (rise[..., None] - below) / (1 + x), rise

    def _row(self, rows: Array, side: int, rate: Array) -> Array:
        """Return values of a table at rates of an opening (0) or closing (1) edge."""
        x = (np.log(np.maximum(rate, 1e-300)) - self.first[side]) * self.per[side]
        x = np.clip(x, 0.0, rows.shape[1] - 1.0)
        i = np.minimum(x.astype(int), rows.shape[1] - 2)
        return np.exp(rows[side, i] + (x - i) * (rows[side, i + 1] - rows[side, i]))

    def _edge(self, state: ContactState, drive: Array, dt: float) -> ContactState:
        """Return the state after the step of the edge, for rates of the depth."""
        D, a, rate, way, _, inner, outer = state
        arms, height = inner @ self.modulus, D[:, None] + outer @ self.modulus
        each, last = np.arange(a.size), self.node.size - 2

        centre = (self.node[:-1] + np.minimum(self.node[1:], state.front[:, None])) / 2
        slope = np.diff(arms, axis=1, prepend=arms[:, :1]) / np.diff(
            centre, axis=1, prepend=centre[:, :1] - 1
        )

        def lift(r: Array) -> Array:
            i = np.clip(np.searchsorted(self.node, r, side="left") - 1, 0, last)
            arm = arms[each, i] + slope[each, i] * (r - centre[each, i])
            return np.minimum(D - r * r + arm, 0.0) ** 2 / (2 * np.pi * r)

        def jump(r: Array) -> Array:
            i = np.clip(np.searchsorted(self.node, r, side="right") - 1, 0, last)
            return np.minimum(height[each, i] - r * r, 0.0) ** 2 / (2 * np.pi * r)

        r = np.maximum(a, 1e-12)
        opens = (a > 0) & (lift(r) > self.surface * (1 + REST))
        closes = jump(r) < self.surface * (1 - REST)
        slow = np.abs(rate) * 2 * a < AGAINST * np.abs(drive)
        turns = (way == 0) | ((way * drive < 0) & slow)
        onwards = np.where(turns, drive < 0, way < 0)
        free = way * drive <= 0
        both = opens & closes
        opens, closes = (
            np.where(both, onwards, opens & (free | (way < 0))),
            np.where(both, ~onwards, closes & (free | (way > 0))),
        )
        fastest = np.exp(self.first[0] + (self.energy.shape[1] - 1) / self.per[0])
        b = a
        if np.any(opens):
            least = np.maximum(a - fastest * dt, 1e-12)
            found = _followed(
                lambda r: lift(r) - self._row(self.energy, 0, (a - r) / dt),
                lambda width: np.maximum(a * (1 - width), least),
                a,
            )
            b = np.where(opens, found, b)
            b = np.where(opens & (b < GONE), 0.0, b)
        if np.any(closes):
            found = _followed(
                lambda r: self._row(self.energy, 1, (r - a) / dt) - jump(r),
                lambda width: a + width * np.maximum(a, SMALL),
                a,
            )
            b = np.where(closes, found, b)
        return self._crossed(state, b, dt)

    def _crossed(self, state: ContactState, b: Array, dt: float) -> ContactState:
        """Return the state after its edge went to radii b, where V allows that."""
        D, a, _, way, front, inner, outer = state
        low, high, part = self._between(np.minimum(a, b), np.maximum(a, b))
        level = D[:, None] - _square(low, high)
        rate = np.abs(b - a) / dt
        area = self.surface * np.pi * np.abs(b * b - a * a)
        elastic = np.sum(_pressed_energy(D[:, None], low, high), axis=1)
        inside = self._inside(a)

        # opening: released and relaxed for the time in the zone
        chi = (level + inner @ self.modulus) / (1 + np.sum(self.modulus))
        x = self._row(self.zone_time, 0, rate)[:, None, None] / self.relaxation_time
        opened, _ = self._recovered(inner - chi[..., None], x)
        spare = elastic + np.sum(part * (inner**2 @ self.modulus), axis=1) - area
        kept = np.sum(part * self._stored(opened), axis=1)
        out = (b < a) & (spare >= 0)
        opened = opened * _factor(spare, kept)
        beyond = np.diff(self.node) - inside
        outer_now = _mixed(outer, beyond, opened, np.where(out[:, None], part, 0.0))

        # closing: jumped to the sphere and relaxed for the time in the zone
        x = self._row(self.zone_time, 1, rate)[:, None, None] / self.relaxation_time
        jumped = (outer + (level + outer @ self.modulus)[..., None]) / (1 + x)
        spare = np.sum(part * self._stored(outer), axis=1) + area - elastic
        needed = np.sum(part * (jumped**2 @ self.modulus), axis=1)
        into = (b > a) & (spare >= 0)
        jumped = jumped * _factor(spare, needed)
        inner_now = _mixed(inner, inside, jumped, np.where(into[:, None], part, 0.0))

        b = np.where(out | into, b, a)
        moved = np.sign(b - a)
        way, front = np.where(moved == 0, way, moved), np.where(moved > 0, b, front)
        return ContactState(D, b, (b - a) / dt, way, front, inner_now, outer_now)


def _square(low: Array, high: Array) -> Array:
    """Return the mean of s^2 between radii."""
    return (low * low + low * high + high * high) / 3


def _pressed_energy(D: Array, low: Array, high: Array) -> Array:
    """Return the integral of (D - s^2)^2 between radii."""
    a, b = high - low, (high + low) / 2
    level = D - b * b
    return a * (level * level + a * a * ((4 * b * b - 2 * level) / 12 + a * a / 80))


def _mixed(e: Array, length: Array, other: Array, part: Array) -> Array:
    """Return the means of strains of lengths of cells with others of parts that join them."""
    share = np.divide(part, length + part, out=np.zeros_like(part), where=part > 0)
    return e + share[..., None] * (other - e)


def _factor(spare: Array, energy: Array) -> Array:
    """Return the factors of strains, at most 1, whose energies are spare."""
    spare = np.maximum(spare, 0.0)
    ratio = np.divide(spare, energy, out=np.ones_like(spare), where=energy > spare)
    return np.sqrt(ratio)[:, None, None]


def _followed(excess: Any, trial: Any, start: Array) -> Array:
    """Return the radii nearest to a start, trials of ever larger widths, where an excess ends."""
    near, far, width = start, trial(FIRST), FIRST
    more = excess(far) >= 0
    for _ in range(DOUBLINGS):
        if not np.any(more):
            break
        width *= 2
        beyond = trial(width)
        more = more & (beyond != far)
        near, far = np.where(more, far, near), np.where(more, beyond, far)
        more = more & (excess(far) >= 0)
    ends = excess(far) < 0
    for _ in range(HALVINGS):
        middle = (near + far) / 2
        below = excess(middle) < 0
        near, far = (
            np.where(ends & ~below, middle, near),
            np.where(ends & below, middle, far),
        )
    return far


# Least Tabor number, and longest zone [beta]: within them histories were compared with simulations.
LEAST, _LONGEST_ZONE = 8.0, 0.065
# Bands of force and work, and their growth with the longest zone: 19 in 20 of these histories lay
# within. A closing edge lags behind that of the model, and a pull of few zones is not steady.
_BAND, _BY_ZONE = (0.02, 0.03), (2.5, 4.0)
# Cells: equal ones up to a radius [beta], then each longer by a factor; the last has no end.
_EQUAL, _UP_TO, _LONGER, _FACTOR, _END = 80, 3.0, 20, 1.15, 1e6
# Window of the arms [s], and their error over the rubbery compliance.
_WINDOW, _TOLERANCE = (1e-6, 1e6), 2e-3
# Rows of the tables, and their ends for an elastic solid.
_ROWS, _ELASTIC = 256, (-10.0, 300.0)
# By this factor edges are faster than where their energy is that of a glassy solid, e^10.
_FASTER = 10.0
# Ends of the time in the zone, over the shortest and the longest of the arms.
_SHORT, _LONG = 1e-4, 1e4


def reduced_contact(problem: Problem) -> ReducedContact:
    """Return the reduced contact of a sphere on a half-space.

    Parameters
    ----------
    problem : Problem
        Solid, law and sphere; its protocol does not matter.

    Returns
    -------
    ReducedContact
        The numbers, from the steady cracks of the solid and the law.

    Raises
    ------
    OutOfRange
        If the range of attraction is too long: a Tabor number below 8.
    ValueError
        If the problem is not a sphere on a half-space without a spring, in SI, or if the law grows
        with the opening speed.

    Examples
    --------
    >>> from viscotack import AtForce, LennardJones, Retraction, StandardSolid
    >>> rubber = StandardSolid(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.01, poisson_ratio=0.5
    ... )
    >>> law = LennardJones(work_of_adhesion=0.05, equilibrium_gap=5e-9)
    >>> ball = Problem(rubber, law, Sphere(1e-3), protocol=Retraction(AtForce(1e-3), speed=1e-6))
    >>> contact = reduced_contact(ball)
    >>> state = contact.apart(0.0)
    >>> for depth in range(1, 101):
    ...     state, _ = contact.step(state, depth * 1e-8, 0.01)
    >>> f"{contact.force(state)[0] * 1e6:.0f} uN at {contact.radius(state)[0] * 1e6:.1f} um"
    '53 uN at 45.8 um'
    """
    if not isinstance(problem, Problem):
        raise InputError(f"a contact for simulators is in SI and needs a Problem, got {problem!r}")
    groups = groups_of(problem)
    if not isinstance(problem.geometry, Sphere):
        raise InputError(f"the reduced contact is that of a sphere, got {problem.geometry}")
    if problem.protocol.stiffness is not None:
        raise InputError("leave out stiffness: the simulator has the spring of the machine")
    if grows(problem.traction):
        raise InputError("interface: a law that grows with the opening speed has no reduction")
    if groups.effective_tabor < LEAST:
        raise OutOfRange(
            f"the Tabor number is {groups.effective_tabor:.3g}, and the reduction holds from "
            f"{LEAST:g}, where the zone of the crack is short beside the contact; for such a long "
            "equilibrium_gap tabulate the force, `viscotack control`"
        )
    crack, scales = SteadyCrack(groups.material, groups.traction), problem.scales()
    # the zone of an edge grows with its energy
    most = _LONGEST_ZONE * problem.tabor**2 / crack.zone_length
    zone, fastest, until = crack.zone_length * crack.largest / problem.tabor**2, np.inf, "any speed"
    if crack.largest > most:
        rate = float(np.asarray(crack.speed(most))) / problem.tabor**2 / problem.material.time_unit
        zone, fastest = _LONGEST_ZONE, rate * scales.radius / ROOT
        until = f"speeds up to {readable(fastest, 'm/s', digits=3)}"
    modulus, time = _arms(problem.material)
    rest = float(tension_left(groups, crack, np.ones(1), np.zeros(1))[0])
    # V = mu^2 |da/dt| tau, with the rate of the radius in beta/s
    shift = np.log(problem.tabor**2 * problem.material.time_unit)
    first, per, energy = [], [], []
    for sign in (1, -1):
        edge = Edge(crack, sign)
        ends = _ELASTIC if edge.elastic else (edge.span[0], edge.span[1] + _FASTER)
        speed = np.exp(np.linspace(*ends, _ROWS))
        gamma = np.asarray(edge.amplification(speed))
        left = tension_left(groups, crack, gamma, speed) if sign > 0 else rest
        first.append(ends[0] - shift)
        per.append((_ROWS - 1) / (ends[1] - ends[0]))
        energy.append(gamma * left)
    zones = crack.zone_length / problem.tabor**2, zone
    force_band, work_band = (
        (least + more * zones[0], least + more * zones[1])
        for least, more in zip(_BAND, _BY_ZONE, strict=True)
    )
    return ReducedContact(
        node=np.concatenate(
            [
                np.linspace(0, _UP_TO, _EQUAL + 1),
                _UP_TO * _FACTOR ** np.arange(1, _LONGER),
                [_END],
            ]
        ),
        modulus=modulus,
        relaxation_time=time,
        first=np.array(first),
        per=np.array(per),
        energy=np.log(energy),
        zone_time=np.log([_zone_time(modulus, time, rest / e, s) for s, e in enumerate(energy)]),
        surface=rest,
        length=scales.length * problem.tabor,
        force_unit=scales.force / LOAD,
        radius_unit=scales.radius / ROOT,
        of=f"{problem.geometry} on {problem.material}, {problem.traction}",
        range=f"Tabor number {groups.effective_tabor:.3g}; edges that open at {until} up to the "
        f"pull-off; times of {readable(_WINDOW[0], 's')} and more",
        fastest=fastest,
        force_band=force_band,
        work_band=work_band,
    )


def _arms(material: Any) -> tuple[Array, Array]:
    """Return moduli over the relaxed one and relaxation times [s]; one of modulus 0 if elastic."""
    shortest, longest = _WINDOW
    modes = material.retardation_modes(shortest=shortest, longest=longest, tolerance=_TOLERANCE)
    if not modes.times:
        return np.zeros(1), np.ones(1)
    total = modes.instantaneous + sum(modes.weights)
    weights = np.array(modes.weights) / total
    return reciprocal(modes.instantaneous / total, weights, np.array(modes.times))


def _zone_time(modulus: Array, time: Array, ratio: Array, side: int) -> Array:
    """Return the times in the zone with which a relaxed bulk releases or takes the surface energy.

    `ratio` is the energy of the surface over that at the edge: released by an annulus of energy 1
    that opens (side 0), taken by one that closes (side 1).
    """
    low = np.full(ratio.shape, np.log(_SHORT * time.min()))
    high = np.full(ratio.shape, np.log(_LONG * time.max()))
    for _ in range(60):
        x = np.exp((low + high) / 2)[:, None] / time
        if side == 0:
            arm = modulus / (1 + x)
            y = 1 - 1 / (1 + modulus.sum())
            # backward Euler, as the recovery of a step
            rise = y * arm.sum(1) / (1 + arm.sum(1))
            strain = (rise - y)[:, None] / (1 + x)
            lacks = (strain @ modulus) ** 2 + strain**2 @ modulus > 1 - ratio
        else:
            lacks = 1 + (1 / (1 + x)) ** 2 @ modulus > ratio
        low, high = np.where(lacks, (low + high) / 2, low), np.where(lacks, high, (low + high) / 2)
    return np.exp(high)
