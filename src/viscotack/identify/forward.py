"""Forward model: pull-off forces of relaxed spheres, vectorised over interfaces and speeds.

The model is the contact whose edge is a steady crack (:mod:`viscotack.theory.crack.contact`), with
Lennard-Jones forces. For an interface whose strength grows with the opening speed
(:class:`Growth`), the crack energies are interpolated from a lattice of cracks.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.geometry import HalfSpace, Layer, Sphere
from viscotack.model.materials import Material
from viscotack.model.problem import Problem
from viscotack.model.protocol import Apart, AtForce, Move, Retraction
from viscotack.model.traction import GentSchultz, LennardJones
from viscotack.model.traction.growing import reference_speed
from viscotack.simulate.crack_contact.by_crack import CrackContact, crack_contact, crack_contacts
from viscotack.theory import SteadyCrack, jkr, lennard_jones
from viscotack.theory.crack.contact import (
    Curves,
    GrowingCracks,
    NeighbourEdges,
    SpheresOnLayers,
    profile_of,
    recede,
)
from viscotack.theory.crack.contact.recession import ERROR_BY_ZONE, LEAST_RATIO, outside
from viscotack.theory.crack.steady import NeighbourCrack
from viscotack.units import readable

from .computed import Arrays, Computed, packaged
from .likelihood import Parameter
from .pull_off import travels_of

_APART = 20.0  # start of an approach, in ranges of attraction
_SPEED = 1e-6  # m/s: reference speed of the groups; rates scale with it
_AT_ONCE = 1500  # cases per batch, to fit into the processor's cache


class Growth(NamedTuple):
    """Growth of the interface's strength with the opening speed, after Gent and Schultz.

    Attributes
    ----------
    reference_speed : float or ndarray
        v0 [m/s]; infinite without growth.
    exponent : float or ndarray
        n [-].
    """

    reference_speed: Any
    exponent: Any


class Pulled(NamedTuple):
    """Pull-offs; all arrays have the same shape.

    Attributes
    ----------
    force : ndarray
        Pull-off force, positive [N].
    effective_tabor : ndarray
        Effective Tabor number: that of an elastic contact with the same ratio of zone to contact.
    crack_speed : ndarray
        Speed of the edge at pull-off [m/s].
    contact_radius : ndarray
        Contact radius of the relaxed start [m].
    travels : ndarray, shape (..., 4)
        Travels from the start to zero force, and from there to fractions of the pull-off force [m],
        see :mod:`.pull_off`; nan for starts in tension.
    energy, interface : ndarray
        Energy per area of the edge at pull-off, and the part dissipated by the interface [works of
        adhesion]; the bulk multiplies by their ratio.
    edge_radius : ndarray
        Contact radius at pull-off [m].
    zone, through : ndarray
        Length of the cohesive zone at pull-off on a layer [m], and this times the contact radius
        over the squared thickness; 0 on a half-space.
    """

    force: Array
    effective_tabor: Array
    crack_speed: Array
    contact_radius: Array
    travels: Array
    energy: Array
    interface: Array
    edge_radius: Array
    zone: Array
    through: Array


class _Receded(NamedTuple):
    """Dimensionless curves, shape (points, cases); length, tabor and start have shape (cases,)."""

    found: Curves
    length: Array  # beta [m]
    tabor: Array
    start: Array
    energy: Array
    interface: Array
    effective: Array


class Changed(NamedTuple):
    """Effect of machine stiffness and loading history on pull-offs.

    Attributes
    ----------
    ratio : ndarray, shape (S,)
        Pull-off force over that of a relaxed contact and a rigid machine; 1 where refused.
    band : ndarray, shape (S,)
        Relative half width of the theory's 90 % interval; 0 where it is not known.
    refused : ndarray of str, shape (S,)
        Reason why the theory does not hold for a test; empty where it holds.
    """

    ratio: Array
    band: Array
    refused: npt.NDArray[np.str_]

    @property
    def holds(self) -> npt.NDArray[np.bool_]:
        """Whether the theory holds for each test."""
        return self.refused == ""


class Interface(NamedTuple):
    """Lennard-Jones interface, which may grow with speed.

    Attributes
    ----------
    work, gap : float or ndarray
        Work of adhesion [J/m2] and range of attraction h0 [m].
    growth : Growth or None
        Growth with the opening speed.
    """

    work: Any
    gap: Any
    growth: Growth | None = None


def law_of(work: float, gap: float, growth: Growth | None = None) -> Any:
    """Return the traction law of an interface with work [J/m2], h0 [m] and growth."""
    law = LennardJones(work_of_adhesion=work, equilibrium_gap=gap)
    if growth is None:
        return law
    v0, n = (float(np.asarray(x)) for x in growth)
    return GentSchultz.of(law, reference_speed=v0, exponent=n) if np.isfinite(v0) else law


@dataclass(frozen=True)
class Forward:
    """Forward model of pull-offs of a sphere on one material.

    Parameters
    ----------
    material : Material
        Material of the half-space.
    radius : float
        Radius of the sphere [m].
    lattice : GrowingCracks, optional
        Cracks of the material for interfaces that grow.
    body : HalfSpace or Layer
        What the sphere presses; a layer of the material with its thickness in m.
    computed : Computed, optional
        Earlier results.
    """

    material: Material
    radius: float
    lattice: GrowingCracks | None = None
    body: HalfSpace | Layer = HalfSpace()
    computed: Computed | None = field(default=None, compare=False, repr=False)

    def check(self, **given: Any) -> None:
        """Raise an error for what has no theory on a layer: compliance, dwell, curves, growth."""
        unknown = [name for name, value in given.items() if value]
        if isinstance(self.body, Layer) and unknown:
            raise InputError(
                "on a layer pull-off forces of relaxed contacts with a stiff machine are known "
                f"only, without growth; omit {' and '.join(unknown)}"
            )

    def problem(
        self,
        work: float,
        gap: float,
        preload: float,
        speed: float = _SPEED,
        growth: Growth | None = None,
        *,
        stiffness: float | None = None,
        moves: tuple[Move, ...] = (),
    ) -> Problem:
        """Return the problem of a test on a half-space.

        In work [J/m2], h0 [m], preload [N], speed [m/s] and stiffness of the machine [N/m]. With
        moves before the retraction it starts apart.
        """
        return Problem(
            material=self.material,
            traction=law_of(work, gap, growth),
            geometry=Sphere(radius=self.radius),
            protocol=Retraction(
                start=Apart(_APART * gap) if moves else AtForce(preload),
                speed=speed,
                moves=moves,
                stiffness=stiffness,
            ),
        )

    @cached_property
    def crack(self) -> SteadyCrack:
        """Return the steady cracks of the material, shared by all interfaces."""
        return SteadyCrack(self.material.reduced(), LennardJones(1.0, 1.0))

    def changed(
        self,
        interface: Interface,
        speed: Array,
        preload: Array,
        *,
        stiffness: float | None = None,
        moves: Sequence[tuple[Move, ...]] = (),
    ) -> Changed:
        """Compute the effect of a spring, or of approach and dwell, on the pull-offs.

        Parameters
        ----------
        interface : Interface
            The interface.
        speed, preload : ndarray, shape (S,)
            Speed of the drive [m/s] and preload [N].
        stiffness : float, optional
            Stiffness of the machine [N/m]; None for a rigid one.
        moves : sequence of tuple, length S
            Moves of each test before the retraction; empty if all contacts are relaxed.
        """
        work, gap, growth = interface
        self.check(compliance=stiffness, dwell=moves, growth=growth)
        loads, none = np.broadcast_to(preload, speed.shape), np.zeros(speed.size)

        def compute() -> Changed:
            if isinstance(self.body, Layer):
                return Changed(none + 1, none, _outside_layer(self.pulled(work, gap, speed, loads)))
            rows = zip(loads.tolist(), speed.tolist(), moves or [()] * speed.size, strict=True)
            problems = [
                self.problem(work, gap, load, v, growth, stiffness=stiffness, moves=some)
                for load, v, some in rows
            ]
            at_rest = not moves and stiffness is None
            answers = _at_rest(problems) if at_rest else problems
            columns = [_force_band_reason(*row) for row in zip(answers, speed, strict=True)]
            force, band, refused = (np.array(column) for column in zip(*columns, strict=True))
            if at_rest:
                return Changed(none + 1, band, refused)
            rigid = self.pulled(work, gap, speed, preload, growth=growth).force
            unit = 1.5 * np.pi * self.radius * work
            return Changed(np.where(refused == "", force * unit / rigid, 1.0), band, refused)

        numbers = _numbers(work, gap, speed, preload, *(growth or ()))
        case = ("changed", *numbers, stiffness, moves)
        return Changed(**self.stored(case, lambda: compute()._asdict()))

    def stored(self, case: tuple[Any, ...], compute: Arrays) -> Mapping[str, npt.NDArray[Any]]:
        """Return arrays that were computed for a case earlier, or compute them."""
        store = self.computed
        if store is None or not packaged(self.material):
            return compute()
        lattice = None if self.lattice is None else self.lattice.given
        return store.of((*self._materials, self.radius, self.body, lattice, *case), compute)

    @property
    def _materials(self) -> tuple[Any, ...]:
        """Materials from which the cracks follow."""
        return (self.material,)

    def layer_error(self, work: float, gap: float, speed: Array, preload: Array) -> Array:
        """Return the part of the theory's relative error by which it grows on thin layers."""
        if not isinstance(self.body, Layer):
            return np.zeros(speed.size)
        return ERROR_BY_ZONE * self.pulled(work, gap, speed, preload).through

    def beside(self, material: Material) -> "Neighbour":
        """Return a fast approximate forward model for a similar material."""
        return Neighbour(material, self.radius, self.lattice, self.body, self.computed, known=self)

    def edges(self, gap: Array, growth: Growth) -> Any:
        """Return one edge law per case, for its range and growth."""
        if self.lattice is None:
            raise ValueError("pull-offs with growth need a lattice of cracks; pass lattice=")
        v0, n = growth
        return self.lattice.edges(np.asarray(v0) * self.material.time_unit / gap, n)

    def pulled(
        self,
        work: npt.ArrayLike,
        gap: npt.ArrayLike,
        speed: npt.ArrayLike,
        preload: npt.ArrayLike,
        radii: int = 160,
        growth: Growth | None = None,
    ) -> Pulled:
        """Compute pull-offs of interfaces; arguments are broadcast.

        Parameters
        ----------
        work, gap : array_like
            Work of adhesion [J/m2] and range of attraction h0 [m].
        speed, preload : array_like
            Retraction speed [m/s], and force under which the contact relaxed [N].
        radii : int
            Number of points of a curve, as in :func:`~viscotack.theory.crack.contact.recede`.
        growth : Growth, optional
            Growth of the interfaces.
        """
        given = (work, gap, speed, preload, *(growth or ()))

        def compute() -> Mapping[str, Array]:
            cases = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in given))
            shape, flat = cases[0].shape, [x.ravel() for x in cases]
            # with one edge law per case, process in batches to limit memory
            count = flat[0].size if growth is None else _AT_ONCE
            parts = [
                self._pulled([x[i : i + count] for x in flat], radii)
                for i in range(0, flat[0].size, count)
            ]
            joined = (np.concatenate(columns) for columns in zip(*parts, strict=True))
            columns = (one.reshape((*shape, *one.shape[1:])) for one in joined)
            return dict(zip(Pulled._fields, columns, strict=True))

        return Pulled(**self.stored(("pulled", *_numbers(*given), radii), compute))

    def curve(
        self, work: float, gap: float, speed: float, preload: float, growth: Growth | None = None
    ) -> tuple[Array, Array]:
        """Compute depth [m] and force [N], compression positive, of one retraction.

        The contact relaxed under the preload; its machine is rigid. Arguments as of
        :meth:`pulled`.
        """
        given = (work, gap, speed, preload, *(growth or ()))
        one = self._receded([np.atleast_1d(np.asarray(x, dtype=float)) for x in given], 160)
        _, force = _ranged(one.found, one.effective)
        height = one.length[0] ** 2 / self.radius
        return one.found.depth[:, 0] * height, force[:, 0] * self.radius * work

    def _receded(self, cases: Sequence[Array], radii: int) -> _Receded:
        w, h0, v, P, *grown = cases
        # without a Problem per case, which rejects interfaces far from the data as large strain
        modulus = self.material.contact_modulus
        mu = (self.radius * w**2 / modulus**2) ** (1 / 3) / h0
        rate = v * self.material.time_unit / h0 / mu
        beta = (self.radius**2 * w / modulus) ** (1 / 3)
        # relaxed sphere: radii in beta, forces in R dg
        load, profile = P / (self.radius * w), profile_of(Sphere(radius=1.0))
        if isinstance(self.body, Layer):
            profile = SpheresOnLayers(self.body.thickness / beta, self.body.base)
            start = profile.radius_at_force(load)
        else:
            unit = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}
            start = np.asarray(jkr.contact_radius_at_force(load, **unit))
        edge: Any = self.edges(h0, Growth(*grown)) if grown else self.crack
        found = recede(edge, profile, radius=start, rate=rate, tabor=mu, radii=radii)
        energy = np.maximum(found.amplification, 1.0)
        interface = edge.interface_work(found.speed) if grown else np.ones_like(energy)
        # interface Q times as strong, with bulk amplification Gamma/Q
        bulk = np.maximum(energy / interface, 1.0)
        effective = mu * interface ** (2 / 3) * bulk ** (-1 / 3)
        return _Receded(found, beta, mu, start, energy, interface, effective)

    def _pulled(self, cases: Sequence[Array], radii: int) -> Pulled:
        w, h0, *_ = cases
        found, beta, mu, start, energy, interface, effective = self._receded(cases, radii)
        tension, pressed = _ranged(found, effective)
        at = np.argmax(tension, axis=0), np.arange(mu.size)
        radius = found.radius[at] * beta
        zone = through = np.zeros(mu.size)
        if isinstance(self.body, Layer):
            zone = self.crack.zone_length * energy[at] / mu**2 * beta
            through = zone * radius / self.body.thickness**2
        # heights in beta^2/R
        height = beta**2 / self.radius
        way = travels_of(found.depth[0] - found.depth, pressed, tension[at]) * height[:, None]
        return Pulled(
            tension[at] * self.radius * w,
            effective[at],
            found.speed[at] * self.material.contact_modulus * h0**2 / w / self.material.time_unit,
            start * beta,
            way,
            energy[at],
            interface[at],
            radius,
            zone,
            through,
        )


def _numbers(*given: npt.ArrayLike) -> tuple[list[Any], ...]:
    """Return arrays as lists, which have all their digits in text."""
    return tuple(np.asarray(x, dtype=float).tolist() for x in given)


def _outside_layer(pulled: Pulled) -> npt.NDArray[np.str_]:
    """Return the reason why the theory does not hold on a layer at each speed, or ""."""
    start = pulled.contact_radius / pulled.edge_radius
    zones = (pulled.contact_radius - pulled.edge_radius) / pulled.zone
    rows = zip(pulled.effective_tabor, start, pulled.through, zones, strict=True)
    reasons = [outside(*map(float, row)) or "" for row in rows]
    for i in np.flatnonzero(pulled.energy > 1 / LEAST_RATIO):
        reasons[i] = (
            f"the edge takes {pulled.energy[i]:.3g} works of adhesion; compared with simulations "
            f"on layers up to {1 / LEAST_RATIO:.3g}"
        )
    return np.array(reasons)


def _at_rest(problems: Sequence[Problem]) -> Sequence[CrackContact | InputError]:
    """Return the crack contact of each retraction from rest, or its error."""
    try:
        return crack_contacts([problem.groups() for problem in problems])
    except InputError as error:
        return [error] * len(problems)


def _force_band_reason(
    answer: CrackContact | InputError | Problem, speed: float
) -> tuple[float, float, str]:
    """Return the pull-off force of an answer or a problem, its band, and why there is none."""
    try:
        answer = crack_contact(answer) if isinstance(answer, Problem) else answer
    except InputError as error:
        answer = error
    if isinstance(answer, InputError):
        return np.nan, 0.0, str(answer)
    if answer.pull_off_force is None:
        at = readable(speed, "m/s", digits=3)
        return np.nan, answer.band, f"there is no pull-off at {at}; simulate it"
    return answer.pull_off_force, answer.band, ""


def _ranged(found: Curves, effective: Array) -> tuple[Array, Array]:
    """Correct tensions and forces for the finite range of the forces."""
    ratio = np.asarray(lennard_jones.pull_off_ratio(effective))
    tension = np.where(found.force < 0, -ratio * found.force, 0.0)
    return tension, np.where(found.force < 0, -tension, found.force)


@dataclass(frozen=True)
class Neighbour(Forward):
    """Forward model of a material similar to another one with known cracks."""

    known: Forward = field(kw_only=True)

    @property
    def _materials(self) -> tuple[Any, ...]:
        return (self.material, *self.known._materials)

    @cached_property
    def crack(self) -> Any:
        """Return the cracks of the material, extrapolated from those of its neighbour."""
        return NeighbourCrack(self.known.crack, self.material)

    def edges(self, gap: Array, growth: Growth) -> Any:
        """Return one edge law per case, extrapolated from those of the neighbour."""
        return NeighbourEdges(super().edges(gap, growth), self.known.crack, self.crack)


STRENGTHENING, EXPONENT = "strengthening", "exponent"
# The largest strengthening searched, the unknowns of growth, and exponents of the lattice.
LARGEST = 30.0
UNKNOWNS = (
    Parameter(STRENGTHENING, 1.0, LARGEST, 2.0),
    Parameter(EXPONENT, 0.2, 0.8, 0.4, logarithmic=False),
)
_LATTICE = (0.2, 0.32, 0.5, 0.8)
# Of the lattice: its least growth, its margin beyond the largest one, and how much faster similar
# solids may be.
_LEAST, _MORE, _FASTER = 0.03, 1.5, 3.0
# Growth that is negligible.
_LEAST_TOLD = 1e-3


@dataclass(frozen=True)
class Opening:
    r"""Opening speed at which the strength of an interface is compared.

    Reference speed and exponent of the Gent-Schultz law are strongly correlated: a series
    determines the strength of the interface at the measured speeds, and its power of speed.
    Therefore the unknowns are the exponent n and the *strengthening*

    .. math:: S = 1 + G(\omega/h_0) ,

    the strength over that at rest, at the opening speed under an edge in the middle of the series.
    An edge of speed v opens the gap at about :math:`v \Delta\gamma_0/(E_0^* h_0)`, so that
    :math:`\omega = v \Delta\gamma_0/E_0^*` is the same for all ranges h0. S = 1 is an interface
    without growth.

    Parameters
    ----------
    product : float
        Opening speed times range of attraction [m2/s].
    """

    product: float

    def speed(self, gap: npt.ArrayLike) -> Array:
        """Return the opening speed [m/s] at ranges h0 [m]."""
        return self.product / np.asarray(gap, dtype=float)

    def growth(self, values: Mapping[str, Any]) -> Growth:
        """Return the growth law of a set of parameters, or of arrays of them."""
        more, exponent = np.asarray(values[STRENGTHENING], dtype=float) - 1, values[EXPONENT]
        more = np.where(more > _LEAST_TOLD, more, 0.0)
        speed = self.speed(values["equilibrium_gap"])
        return Growth(reference_speed(more, speed, exponent), exponent)


@dataclass(frozen=True)
class FoundGrowth:
    """What follows from the fitted strengthening and exponent of an interface.

    Parameters
    ----------
    opening_speed : float
        Opening speed of the gap under an edge in the middle of the series [m/s].
    reference_speed : float
        v0 of the Gent-Schultz law [m/s]; infinite without growth.
    better_by : float
        Reduction of the misfit compared with the best interface without growth, which has two
        parameters fewer.
    pulled : Pulled
        Pull-offs at the speeds of the series, whose energy is the product of two factors on the
        work of adhesion, by bulk and interface.
    """

    opening_speed: float
    reference_speed: float
    better_by: float
    pulled: Pulled

    @property
    def chance(self) -> float:
        """Probability of such a reduction of the misfit for an interface without growth."""
        # the noise is known, so the difference of misfits is chi-squared; without growth the
        # exponent is free and growth is not negative, which makes chance even less likely
        return float(chi2.sf(self.better_by, 2))


def growing(forward: Forward, opening: Opening, gaps: tuple[float, float]) -> Forward:
    """Return a forward model with a lattice of cracks for all growth laws searched."""
    unit = forward.material.time_unit
    speeds = [float(opening.speed(gap)) * unit / gap for gap in gaps]
    given = (
        (_LEAST, _MORE * (LARGEST - 1)),
        (min(speeds) / _FASTER, max(speeds) * _FASTER),
        _LATTICE,
    )
    kept = partial(forward.stored, ("lattice", *given))
    return replace(forward, lattice=GrowingCracks(forward.material, *given, kept=kept))
