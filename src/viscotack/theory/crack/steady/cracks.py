r"""Steady crack with a full traction law, without fitted constants.

A crack moves at constant speed v between a rigid flat and a viscoelastic half-space in plane
strain. Along it

.. math:: \sigma(1 + w) = -\frac{1}{2\pi} PV \int \frac{e'(s)}{x - s} ds, \quad
          w = c_\infty e + \sum_j w_j d_j, \quad v \tau_j d_j' = e - d_j,

with gaps in h0, lengths in :math:`\lambda = E_0^* h_0^2/\Delta\gamma_0` and stresses in
:math:`\Delta\gamma_0/h_0`. e is the opening that the tractions would cause in the relaxed solid;
far away :math:`e \to A \sqrt x`, and the energy per area of the crack is :math:`\Gamma = \pi
A^2/16` works of adhesion. Speeds are in :math:`\lambda/\tau`, with the material's ``time_unit`` for
tau. An opening crack has positive speed, and Gamma rises from 1 to glassy over rubbery modulus,
1/k; a closing one negative speed, and Gamma, the energy available for closing, falls from 1 to k.

It is the limit of large Tabor numbers of every contact, for any linear solid and any law. Source:
this package; docs/steady_crack.md derives it. No DOI: for cohesive zones
see Greenwood (2004), J. Phys. D 37, 2557, and Barber, Donley & Langer (1989),
doi:10.1103/PhysRevA.40.366.

**Deviation of simpler theories from the steady crack, for one solid and one law.** The theories of
Persson and Brener and of Greenwood need a length, which follows from the strength of the law:
:math:`l_0 = \lambda/(\pi \alpha^2 \bar\sigma_0^2)` (Eq. 4.23) with any alpha, :math:`l = \pi
\lambda/(4 \bar\sigma_0^2)`, :math:`\bar\sigma_0 = \sigma_0 h_0/\Delta\gamma_0`. The slow asymptote
is :math:`1 + s V`, the fast one 1/k. All are for opening cracks.

**Crack of a solid similar to one with known cracks, without further computation.** The energy of an
edge follows from the creep of the solid during the passage of the zone, :math:`1/\Gamma = \bar
c(t)`, :math:`t = x \Gamma/V` (Schapery's argument), with a number x of about a third that depends
on law and spectrum. Passage times are distributed, so the creep is averaged,

.. math:: \bar c(t) = \int_0^\infty c(s) e^{-s/t} ds/t = k + \sum_j w_j \frac{t}{t + \tau_j} .

The number x is determined from the known crack, for every :math:`\Gamma` between 1 and 1/k,
and used for the neighbour. The error is the change of x between the solids, of second
order in their difference. (With c(t) itself instead of the mean, the error is 5 % for solids of
few arms.)
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from typing import Any, NamedTuple

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials import Modes
from viscotack.model.traction import Dugdale, Traction, effective_range, grows
from viscotack.model.traction.growing import check_ageless, check_of_gap_alone, reduced
from viscotack.theory._checks import Number, Values, plain, positive
from viscotack.theory.crack import greenwood, persson_brener
from viscotack.theory.crack.steady import _balance, _branch, _grown, _mesh
from viscotack.theory.crack.steady._balance import Law, Solution
from viscotack.theory.crack.steady._branch import energy_of_odds
from viscotack.theory.crack.steady._mesh import lengths_of, opening_matrix

# Half-length of the mesh over the length of the glassy zone.
_REACH = 3e4
# Tolerance of the creep in glassy compliances, and time window of its modes [time units].
_MODES_TOLERANCE, _WINDOW = 2e-4, (1e-30, 1e30)
# Total weight, relative to the rubbery compliance, of the slowest modes that are merged.
_FAINT = 1e-8
# Largest relative mesh error of Gamma, from meshes three times finer, with the laws
# of this package, k from 1e-3, both signs.
MESH_ERROR = 5e-4
# Relative error per softening of Dugdale's rise and fall, from comparison with
# Greenwood's crack (without softening) and with half the softening.
_RISE_ERROR, _FALL_ERROR = 0.25, 0.02
# Fraction of the strength that defines the end of the zone.
_ZONE_ENDS = 0.1


@dataclass(frozen=True)
class Profile:
    """One steady crack: its shape and its energies, returned by :meth:`SteadyCrack.at`.

    Attributes
    ----------
    speed : float
        Speed [E0* h0^2/(dg tau)].
    amplification : float
        Energy over the work of adhesion.
    heat : float
        Dissipation in the solid, in works of adhesion, positive; the amplification is 1 + heat
        for an opening crack, 1 - heat for a closing one.
    zone_length : float
        Length from the gap of the largest tension to that of a tenth of it [E0* h0^2/dg].
    position, gap : ndarray, shape (n,)
        Position [E0* h0^2/dg], ascending towards the open side; 0 where half of the work is done.
        Gap [h0].
    middle, traction : ndarray, shape (n - 1,)
        Midpoints of the elements, and mean tractions there [dg/h0], tension positive.
    interface_heat : float
        Dissipation in an interface that grows with the opening speed [works of adhesion], in
        addition to 1 + heat of an opening crack.
    """

    speed: float
    amplification: float
    heat: float
    zone_length: float
    position: Array
    gap: Array
    middle: Array
    traction: Array
    interface_heat: float = 0.0


@dataclass(frozen=True)
class SteadyCrack:
    r"""Steady cracks of a solid with a traction law.

    Parameters
    ----------
    material : viscoelastic material of :mod:`viscotack.model.materials`
        Its normalised creep is used; its contact modulus defines :attr:`speed_unit`.
    traction : LennardJones, Exponential, Dugdale, Tabulated or a law of the user's
        Law in SI or reduced. A rise below 0.02 and a fall below 0.5 of Dugdale's law are raised to
        these values; the stated error includes this. A law that grows with the opening speed
        increases the energy of opening cracks; closing cracks follow the law at rest.

    Notes
    -----
    The first evaluation at a speed takes 10 to 40 ms, later ones are immediate: cracks are computed
    a quarter of a decade apart, cached for equal solids and laws, and interpolated.
    :meth:`error` states the error.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.model.traction import LennardJones
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> crack = SteadyCrack(solid, LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-9))
    >>> f"{crack.amplification(10.0):.2f} opening, {crack.amplification(-10.0):.3f} closing"
    '3.96 opening, 0.335 closing'
    >>> f"{crack.speed_unit * 1e9:.1f} nm/s is a speed of 1"
    '26.7 nm/s is a speed of 1'
    """

    material: Any
    traction: Traction

    def __post_init__(self) -> None:
        for name, wanted in (("material", "retardation_modes"), ("traction", "stiffness")):
            if not hasattr(getattr(self, name), wanted):
                raise InputError(
                    f"{name} must be one of viscotack.{'materials' if name == 'material' else name}"
                    f", got {getattr(self, name)!r}"
                )
        check_ageless(self.traction, "a steady crack")

    @property
    def speed_unit(self) -> float:
        """Return the unit of speeds in m/s, E0* h0^2/(dg tau)."""
        return self.length_unit / self.material.time_unit

    @property
    def length_unit(self) -> float:
        """Return the unit of lengths in m, E0* h0^2/dg."""
        law = self.traction
        return self.material.contact_modulus * law.equilibrium_gap**2 / law.work_of_adhesion

    @property
    def largest(self) -> float:
        """Return the amplification at infinite speed, glassy over rubbery modulus.

        For a growing interface, which has no such limit, that of the last computed crack.
        """
        return 1 / self.modes.instantaneous if self._grown is None else self._grown.largest

    def amplification(self, speed: Values) -> Number:
        """Return the energy over the work of adhesion at speeds [E0* h0^2/(dg tau)], any sign."""
        v = _finite("speed", speed)
        gamma = np.ones(v.shape)
        for sign, moving, cracks in self._moving(v > 0, v < 0):
            gamma[moving] = cracks.gamma(np.log(sign * v[moving]))
        return plain(gamma)

    def interface_work(self, speed: Values) -> Number:
        """Return the energy dissipated by the interface at speeds [works of adhesion].

        1 for a law of the gap alone; otherwise larger by the heat in the interface of an opening
        crack.
        """
        v = _finite("speed", speed)
        work = np.ones(v.shape)
        if self._grown is not None:
            work[v > 0] = self._grown.work(np.log(v[v > 0]))
        return plain(work)

    def speed(self, amplification: Values) -> Number:
        """Return speeds [E0* h0^2/(dg tau)]: opening for amplifications above 1, otherwise closing.

        The amplification must lie between k and 1/k.
        """
        gamma, k = _finite("amplification", amplification), self.modes.instantaneous
        most = self.largest
        if np.any((gamma <= k) | (gamma >= most)) and np.any(gamma != 1):
            raise InputError(
                f"amplification must lie between {k:.6g} and {most:.6g}, the limits at infinite "
                f"speed, got {gamma[(gamma <= k) | (gamma >= most)].flat[0]:g}"
            )
        v = np.zeros(gamma.shape)
        for sign, moving, cracks in self._moving(gamma > 1, gamma < 1):
            v[moving] = sign * np.exp(cracks.log_speed(gamma[moving]))
        return plain(v)

    def error(self, speed: Values) -> Number:
        """Return the relative error of :meth:`amplification`: mesh, interpolation and softening."""
        v = _finite("speed", speed)
        if not self.modes.times and self._grown is None:
            return plain(np.zeros(v.shape))
        between = np.zeros(v.shape)
        self.amplification(v)
        for sign, moving, cracks in self._moving(v > 0, v < 0):
            between[moving] = cracks.interpolation_error(np.log(sign * v[moving]))
            if cracks is not self._grown:
                # d ln Gamma/d ln odds is below a quarter of ln(1/k), and below 1
                between[moving] *= min(1.0, np.log(self.largest) / 4)
        return plain(MESH_ERROR + between + self._softening)

    def at(self, speed: float) -> Profile:
        """Return the crack at one speed [E0* h0^2/(dg tau)], computed without interpolation."""
        v, found = float(speed), self._elastic
        if v > 0 and self._grown is not None:
            found, work = self._grown.at(float(np.log(v)))
            at_rest, _, _ = self._law.mean(found.gap)
            interface = np.sum((work * found.traction - at_rest) * np.diff(found.gap))
            return self._profile(v, found, work, float(interface))
        if v != 0 and self.modes.times:
            found = self._branch(1 if v > 0 else -1).at(float(np.log(abs(v))))
        return self._profile(v, found)

    @cached_property
    def zone_length(self) -> float:
        """Return the length of the zone of the elastic crack [E0* h0^2/dg], see `Profile`."""
        return self.at(0.0).zone_length

    @property
    def slow_coefficient(self) -> float:
        r"""Return s of the slowest cracks, :math:`\Gamma \to 1 + s \, V`, for both signs.

        .. math:: s = - \langle\tau\rangle \int \sigma'(w) \, (w')^2 dx, \quad
                  \langle\tau\rangle = \sum_j w_j \tau_j

        over the elastic crack: a constant of the law times the mean retardation time of the solid.
        """
        return _slow_of(self._elastic, self._grid, self.modes)

    @cached_property
    def modes(self) -> Modes:
        """Creep in modes: times in the time unit, compliances relative to the relaxed solid."""
        return modes_of(self.material)

    @property
    def _reduced(self) -> Any:
        law: Any = self.traction
        return _balance.softened((law.at_rest if grows(law) else law).reduced())

    @cached_property
    def _grown(self) -> _grown.Grown | None:
        if not grows(self.traction):
            return None
        law = reduced(self.traction, self.material.time_unit)
        return _kept(_grown_of, self._reduced, self.modes, law)

    @cached_property
    def _softening(self) -> float:
        law: Any = self.traction
        law = law.base if grows(law) else law
        if not isinstance(law, Dugdale):
            return 0.0
        rise = max(_balance.LEAST_RISE - law.rise, 0.0) * _RISE_ERROR
        return rise + max(_balance.LEAST_FALL - law.fall, 0.0) * _FALL_ERROR

    @cached_property
    def _law(self) -> Law:
        return _balance.pinned(self._reduced)

    @cached_property
    def _grid(self) -> _mesh.Mesh:
        return _grid_of(self._reduced, self.modes.instantaneous)

    @property
    def _elastic(self) -> Solution:
        return _kept(_elastic_of, self._reduced, self.modes.instantaneous)

    def _branch(self, sign: int) -> _branch.Branch:
        return _kept(_branch_of, self._reduced, self.modes, sign)

    def _moving(self, opening: Any, closing: Any) -> Iterator[tuple[int, Any, Any]]:
        """Yield the sign and the places of opening and closing cracks, and their branch."""
        for sign, moving in ((1, opening), (-1, closing)):
            if np.any(moving):
                if sign > 0 and self._grown is not None:
                    yield sign, moving, self._grown
                elif self.modes.times:
                    yield sign, moving, self._branch(sign)

    def _profile(
        self, speed: float, found: Solution, work: float = 1.0, interface: float = 0.0
    ) -> Profile:
        """Return the profile of a crack computed in units in which its interface energy is 1."""
        mesh, law = self._grid, self._law
        calibrated = work * found.amplification / self._elastic.amplification
        if speed > 0 and self._grown is not None:
            heat = calibrated - 1 - interface
        elif speed < 0:
            heat = float(np.sum((found.traction - found.relaxed) * np.diff(found.gap)))
        else:
            relaxed = found.u[:-1] + found.u[-1] * mesh.far
            heat = float(np.sum(found.traction * np.diff(relaxed - found.gap)))
        return Profile(
            speed=speed,
            amplification=calibrated,
            heat=heat,
            zone_length=_zone_length(mesh, found.gap, self._reduced, law) / work,
            position=mesh.x / work,
            # a copy: other callers have the same cached crack
            gap=found.gap.copy(),
            middle=(mesh.x[1:] + mesh.x[:-1]) / 2 / work,
            traction=found.traction * work,
            interface_heat=interface,
        )


def _zone_length(mesh: _mesh.Mesh, gap: Array, traction: Any, law: Law) -> float:
    """Return the length over which the tension falls from its largest to a tenth."""
    gaps = np.geomspace(traction.edge_gap, 1e3 * traction.edge_gap, 4000)
    tension = law.traction(gaps)
    end = gaps[np.flatnonzero(tension >= _ZONE_ENDS * traction.strength)[-1]]
    # the gap rises along the crack
    rising = np.maximum.accumulate(gap)
    begin, stop = np.interp([traction.edge_gap, end], rising, mesh.x)
    return float(stop - begin)


def _finite(name: str, value: Values) -> Array:
    x = np.asarray(value, dtype=float)
    if not np.all(np.isfinite(x)):
        raise InputError(f"{name} must be finite, got {x[~np.isfinite(x)].flat[0]}")
    return x


def modes_of(material: Any) -> Modes:
    """Return the modes of a solid; weights are dimensionless, times in its time unit.

    Parameters
    ----------
    material : Material
        Viscoelastic solid of :mod:`viscotack.model.materials`.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> modes_of(solid).times
    (1.0,)
    """
    unit, k = material.time_unit, material.modulus_ratio
    shortest, longest = (unit * edge for edge in _WINDOW)
    tolerance = min(_MODES_TOLERANCE * k, 0.5)
    modes = material.retardation_modes(shortest=shortest, longest=longest, tolerance=tolerance)
    total = modes.instantaneous + sum(modes.weights)
    weights, times = _without_faint_tail(np.array(modes.weights), np.array(modes.times))
    return Modes(modes.instantaneous / total, weights / total, times / unit, modes.error)


def _without_faint_tail(weights: Array, times: Array) -> tuple[Array, Array]:
    """Merge the slowest modes of negligible weight with the previous one.

    The first computed crack is slow even for the slowest mode. If that mode has negligible weight,
    the crack differs from the elastic one by less than round-off. The merged mode has the total
    weight and the same initial creep rate.
    """
    heavier = int(np.count_nonzero(np.cumsum(weights[::-1]) > _FAINT))
    if heavier in (0, weights.size):
        return weights, times
    first = heavier - 1
    weight, rate = np.sum(weights[first:]), np.sum(weights[first:] / times[first:])
    return np.append(weights[:first], weight), np.append(times[:first], weight / rate)


def _kept(maker: Any, *key: Any) -> Any:
    """Return the result of a function of a key, cached if the key is hashable."""
    try:
        hash(key)
    except TypeError:
        return maker.__wrapped__(*key)
    return maker(*key)


def _grid_of(law: Traction, modulus_ratio: float) -> _mesh.Mesh:
    length = effective_range(law) ** 2
    return _mesh.mesh(length, _REACH * length / modulus_ratio)


@lru_cache(maxsize=32)
def _elastic_of(law: Traction, modulus_ratio: float) -> Solution:
    return _balance.elastic(law, _grid_of(law, modulus_ratio))


@lru_cache(maxsize=64)
def _branch_of(law: Traction, modes: Modes, sign: int) -> _branch.Branch:
    start = _kept(_elastic_of, law, modes.instantaneous)
    grid = _grid_of(law, modes.instantaneous)
    slow = _slow_of(start, grid, modes)
    return _branch.Branch(grid, _balance.pinned(law), modes, start, slow, sign)


@lru_cache(maxsize=64)
def _grown_of(law: Traction, modes: Modes, growing: Any) -> _grown.Grown:
    start = _kept(_elastic_of, law, modes.instantaneous)
    grid = _grid_of(law, modes.instantaneous)
    opening = partial(_kept, _opening_of, law, modes)
    return _grown.Grown(grid, _balance.pinned(law), modes, opening, growing, start)


# 0.6 MB each; a solid has about 70, at speeds that all growing laws on it share
@lru_cache(maxsize=128)
def _opening_of(law: Traction, modes: Modes, log_speed: float) -> Array:
    grid = _grid_of(law, modes.instantaneous)
    return opening_matrix(grid, lengths_of(grid, modes, float(np.exp(log_speed))))


def _slow_of(elastic: Solution, grid: _mesh.Mesh, modes: Modes) -> float:
    """Return s of the slowest cracks, the mean time times the integral of -sigma' w'^2 dx.

    The prime of sigma is its derivative by w, that of w its derivative by x; so the integrand is
    -(d sigma/dx)(dw/dx).
    """
    slope = np.diff(elastic.gap) / grid.dx
    mean_time = float(np.dot(modes.weights, modes.times))
    return -mean_time * float(np.sum(np.diff(elastic.traction) * (slope[1:] + slope[:-1]) / 2))


# Value of the thesis, fitted to simulations of a sphere at a Tabor number of 3.24.
THESIS_RATIO = np.pi / 9


class Comparison(NamedTuple):
    """Amplifications of an opening crack by theory, returned by :func:`compared`.

    All are dimensionless arrays of the shape of the speeds.

    Attributes
    ----------
    speed : ndarray
        Speed [E0* h0^2/(dg tau)].
    steady, error : ndarray
        Steady crack with the full law, and its relative error.
    persson_brener, greenwood, slow, fast : ndarray
        Other theories and asymptotes.
    """

    speed: Array
    steady: Array
    error: Array
    persson_brener: Array
    greenwood: Array
    slow: Array
    fast: Array

    def off(self, theory: str) -> Array:
        """Return the signed relative deviation of a theory from the steady crack."""
        return getattr(self, theory) / self.steady - 1


def compared(
    crack: SteadyCrack, speed: Values, *, strength_ratio: float = THESIS_RATIO
) -> Comparison:
    """Compare theories of an opening crack at speeds [E0* h0^2/(dg tau)].

    Parameters
    ----------
    crack : SteadyCrack
        Solid and law.
    speed : array_like
        Dimensionless speeds, positive.
    strength_ratio : float
        Alpha of the Persson-Brener length.

    Raises
    ------
    InputError
        If a speed or the ratio is not positive and finite.
    OutOfRange
        If the law depends on more than the gap.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.model.traction import LennardJones
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> found = compared(SteadyCrack(solid, LennardJones(1, 1)), 10.0)
    >>> f"Persson-Brener {found.off('persson_brener'):+.1%}"
    'Persson-Brener +6.4%'
    """
    check_of_gap_alone(crack.traction, "a comparison of theories")
    v, alpha = positive(speed=speed, strength_ratio=strength_ratio)
    law = crack.traction.reduced()
    case = {"contact_modulus": 1.0, "work_of_adhesion": 1.0, "strength": law.strength}
    tip = persson_brener.crack_tip_length(**case, strength_ratio=alpha)
    zone = greenwood.cohesive_zone_length(**case)
    solid = crack.material
    return Comparison(
        speed=v,
        steady=np.asarray(crack.amplification(v)),
        error=np.asarray(crack.error(v)),
        persson_brener=np.asarray(persson_brener.amplification(v / tip, material=solid)),
        greenwood=np.asarray(greenwood.amplification(v / zone, material=solid)),
        slow=1 + crack.slow_coefficient * v,
        fast=np.full(v.shape, crack.largest),
    )


# ln of the odds (Gamma - 1)/(1/k - Gamma) at which both are compared, and their number.
_ODDS = np.linspace(-14.0, 12.0, 400)
_OF = np.exp(_ODDS)


@dataclass(frozen=True)
class NeighbourCrack:
    r"""Opening cracks of a solid similar to one with known cracks, with the same law.

    Parameters
    ----------
    known : SteadyCrack
        Crack of the known solid.
    material : Material
        The neighbour, with constants that differ by at most a few ten per cent.

    Notes
    -----
    Speeds are in the neighbour's own unit. For power laws with a constant changed by 10
    to 100 %, and Prony series with arms changed by 20 %, the energies agree with those of its own
    cracks within 1.1 % (`tests/ladder/test_steady_crack.py`).

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.model.traction import LennardJones
    >>> solid = dict(rubbery_modulus=1, tau0=1, poisson_ratio=0)
    >>> known = SteadyCrack(StandardSolid(glassy_modulus=10, **solid), LennardJones(1, 1))
    >>> neighbour = NeighbourCrack(known, StandardSolid(glassy_modulus=11, **solid))
    >>> f"{float(neighbour.amplification(10.0)):.2f}, not {known.amplification(10.0):.2f}"
    '4.05, not 3.96'
    """

    known: SteadyCrack
    material: Any

    @cached_property
    def modes(self) -> Modes:
        """Creep in modes, as for :class:`SteadyCrack`."""
        return modes_of(self.material)

    @property
    def largest(self) -> float:
        """Amplification at infinite speed."""
        return 1 / self.modes.instantaneous

    @property
    def zone_length(self) -> float:
        """Length of the cohesive zone at rest [E0* h0^2/dg], which depends on the law alone."""
        return self.known.zone_length

    def speed(self, amplification: Values) -> Array:
        """Return opening speeds [E0* h0^2/(dg tau)] of energies between 1 and 1/k."""
        gamma = np.asarray(amplification, dtype=float)
        odds = np.log((gamma - 1) / (self.largest - gamma))
        return np.exp(np.interp(odds, _ODDS, self._log_speeds))

    def amplification(self, speed: Values) -> Array:
        """Return the energy over the work of adhesion at opening speeds [E0* h0^2/(dg tau)]."""
        v = np.log(np.asarray(speed, dtype=float))
        return energy_of_odds(
            np.exp(np.interp(v, self._log_speeds, _ODDS)), self.modes.instantaneous
        )

    @cached_property
    def _log_speeds(self) -> Array:
        known = self.known
        energy = energy_of_odds(_OF, self.modes.instantaneous)
        of_known = energy_of_odds(_OF, known.modes.instantaneous)
        first = np.log(np.asarray(known.speed(of_known)))
        # V = x Gamma/t, with the same x at the same odds
        change = np.log(energy / of_known)
        return np.maximum.accumulate(first + change - _passing(self.modes) + _passing(known.modes))


def _passing(modes: Modes) -> Array:
    """Return ln of the times at which the averaged creep has the energies of :data:`_ODDS`."""
    tau, weights = np.array(modes.times), np.array(modes.weights)
    time = np.geomspace(1e-8 * tau[0], 1e8 * tau[-1], 2000)
    part = time[:, None] / (time[:, None] + tau)
    crept, rest = part @ weights, (1 - part) @ weights
    # odds = k (1 - c)/(c - k), decreasing with time
    odds = np.log(modes.instantaneous) + np.log(rest) - np.log(crept)
    return np.interp(-_ODDS, -odds, np.log(time))
