"""Pull-off forces of a sphere relaxed under a preload, for many interfaces and speeds at once.

The contact whose edge is a steady crack (:mod:`viscotack.theory.crack.contact`), with Lennard-Jones
forces: the forward model of a rate series and of its forecast. Where the interface grows with the
opening speed (:class:`Growth`), edges come from a lattice of cracks.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.geometry import Sphere
from viscotack.materials import Material
from viscotack.methods import CrackContact, crack_contact
from viscotack.methods.by_crack import crack_contacts
from viscotack.problem import Problem
from viscotack.protocol import Apart, AtForce, Move, Retraction
from viscotack.theory import SteadyCrack, jkr, lennard_jones
from viscotack.theory.crack.contact import (
    Curves,
    GrowingCracks,
    NeighbourEdges,
    profile_of,
    recede,
)
from viscotack.theory.crack.steady import NeighbourCrack
from viscotack.traction import GentSchultz, LennardJones
from viscotack.units import readable

from .travel import travels_of

_APART = 20.0  # ranges from which an approach begins
_SPEED = 1e-6  # at which groups are asked for; rates are in proportion
_AT_ONCE = 1500  # cases, which still fit in the memory that is near


class Growth(NamedTuple):
    """How an interface grows with the opening speed, after Gent and Schultz.

    Attributes
    ----------
    reference_speed : float or ndarray
        v0 [m/s]; infinite where it does not grow.
    exponent : float or ndarray
        n.
    """

    reference_speed: Any
    exponent: Any


class Pulled(NamedTuple):
    """Pull-offs, each array of the same shape.

    Attributes
    ----------
    force : ndarray
        Positive [N].
    effective_tabor : ndarray
        Tabor number of an elastic contact whose zone is as large beside it.
    crack_speed : ndarray
        Of the edge there [m/s].
    contact_radius : ndarray
        Of the relaxed start [m].
    travels : ndarray, shape (..., 4)
        From the start to zero force, and from there to parts of the pull-off [m], as
        :mod:`.travel` has them; nan where the start is in tension.
    energy, interface : ndarray
        What the edge takes there, and what the interface takes of it [works of adhesion]; the bulk
        multiplies by their ratio.
    """

    force: Array
    effective_tabor: Array
    crack_speed: Array
    contact_radius: Array
    travels: Array
    energy: Array
    interface: Array


class Changed(NamedTuple):
    """What a machine and a history do to pull-offs.

    Attributes
    ----------
    ratio : ndarray, shape (S,)
        Pull-off force over that of a relaxed contact and a rigid machine; 1 where it is refused.
    refused : dict
        Number of a speed -> why the theory does not answer it.
    """

    ratio: Array
    refused: dict[int, str]


@dataclass(frozen=True)
class Forward:
    """Pull-offs of a sphere of one material.

    Parameters
    ----------
    material : Material
        Of the half-space.
    radius : float
        Of the sphere [m].
    lattice : GrowingCracks, optional
        Of the material, for interfaces that grow.
    """

    material: Material
    radius: float
    lattice: GrowingCracks | None = None

    def problem(
        self,
        work: float,
        gap: float,
        preload: float,
        speed: float = _SPEED,
        growth: Growth | None = None,
    ) -> Problem:
        """Return one of the tests: work of adhesion [J/m2], h0 [m], preload [N], speed [m/s]."""
        law: Any = LennardJones(work_of_adhesion=work, equilibrium_gap=gap)
        if growth is not None:
            v0, n = (float(np.asarray(x)) for x in growth)
            law = GentSchultz.of(law, reference_speed=v0, exponent=n) if np.isfinite(v0) else law
        return Problem(
            material=self.material,
            traction=law,
            geometry=Sphere(radius=self.radius),
            protocol=Retraction(start=AtForce(preload), speed=speed),
        )

    @cached_property
    def crack(self) -> SteadyCrack:
        """Return the cracks of the material, which are the same for all interfaces."""
        return SteadyCrack(self.material.reduced(), LennardJones(1.0, 1.0))

    def changed(
        self,
        work: float,
        gap: float,
        speed: Array,
        preload: Array,
        *,
        stiffness: float | None = None,
        moves: tuple[Move, ...] = (),
        growth: Growth | None = None,
    ) -> "Changed":
        """Return by what a spring, or an approach and a dwell, change the pull-offs.

        Parameters
        ----------
        work, gap : float
            Of the interface.
        speed, preload : ndarray, shape (S,)
            Of the drive, and of the start.
        stiffness : float, optional
            Of the machine [N/m]; None for a rigid one.
        moves : tuple
            From apart to where the retraction begins; none for a contact that has relaxed.
        growth : Growth, optional
            Of the interface.
        """
        loads = np.broadcast_to(preload, speed.shape)
        problems = [
            self.problem(work, gap, float(load), float(v), growth)
            for v, load in zip(speed, loads, strict=True)
        ]
        if not moves and stiffness is None:
            # nothing changes them; retractions from rest are marched together
            return Changed(np.ones(speed.size), _refused(_rested(problems), speed))
        answers = [_pressed(problem, _APART * gap, moves, stiffness) for problem in problems]
        refused = _refused(answers, speed)
        rigid = self.pulled(work, gap, speed, preload, growth=growth).force
        unit = 1.5 * np.pi * self.radius * work
        ratio = np.ones(speed.size)
        for i, answer in enumerate(answers):
            if i not in refused:
                ratio[i] = answer.pull_off_force * unit / rigid[i]  # type: ignore
        return Changed(ratio, refused)

    def beside(self, material: Material) -> "Neighbour":
        """Return the pull-offs of a material near to this one, at no cost."""
        return Neighbour(material, self.radius, self.lattice, known=self)

    def edges(self, gap: Array, growth: Growth) -> Any:
        """Return an edge for each case, of its range and growth."""
        if self.lattice is None:
            raise ValueError("pull-offs with growth need a lattice of cracks")
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
        """Return pull-offs of interfaces, broadcast.

        Parameters
        ----------
        work, gap : array_like
            Work of adhesion [J/m2] and range of attraction h0 [m].
        speed, preload : array_like
            Of the retraction [m/s], and under which the contact relaxed [N].
        radii : int
            Of a curve, as of :func:`~viscotack.theory.crack.contact.recede`.
        growth : Growth, optional
            Of the interfaces.
        """
        given = (work, gap, speed, preload, *(growth or ()))
        cases = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in given))
        shape, flat = cases[0].shape, [x.ravel() for x in cases]
        # an edge of its own for each case is much to hold at once
        count = flat[0].size if growth is None else _AT_ONCE
        parts = [
            self._pulled([x[i : i + count] for x in flat], radii)
            for i in range(0, flat[0].size, count)
        ]
        joined = (np.concatenate(columns) for columns in zip(*parts, strict=True))
        return Pulled(*(one.reshape((*shape, *one.shape[1:])) for one in joined))

    def _pulled(self, cases: Sequence[Array], radii: int) -> Pulled:
        w, h0, v, P, *grown = cases
        # not by a problem of each: an interface far from the data may lie beyond small strain
        modulus, profile = self.material.contact_modulus, profile_of(Sphere(radius=1.0))
        mu = (self.radius * w**2 / modulus**2) ** (1 / 3) / h0
        rate = v * self.material.time_unit / h0 / mu
        # of a relaxed sphere, in beta, for forces in R dg
        start = np.asarray(
            jkr.contact_radius_at_force(
                P / (self.radius * w), radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0
            )
        )
        edge: Any = self.edges(h0, Growth(*grown)) if grown else self.crack
        found = recede(edge, profile, radius=start, rate=rate, tabor=mu, radii=radii)
        energy = np.maximum(found.amplification, 1.0)
        interface = edge.interface_work(found.speed) if grown else np.ones_like(energy)
        # of an interface Q times as strong, whose energy the bulk makes Gamma/Q times as large
        bulk = np.maximum(energy / interface, 1.0)
        effective = mu * interface ** (2 / 3) * bulk ** (-1 / 3)
        tension, pressed = _ranged(found, effective)
        at = np.argmax(tension, axis=0), np.arange(mu.size)
        beta = (self.radius**2 * w / modulus) ** (1 / 3)
        # heights in beta^2/R
        height = beta**2 / self.radius
        way = travels_of(found.depth[0] - found.depth, pressed, tension[at]) * height[:, None]
        return Pulled(
            tension[at] * self.radius * w,
            effective[at],
            found.speed[at] * modulus * h0**2 / w / self.material.time_unit,
            start * beta,
            way,
            energy[at],
            interface[at],
        )


def _rested(problems: Sequence[Problem]) -> Sequence[CrackContact | InputError]:
    """Crack contact of each retraction from rest, or the error that refuses it."""
    try:
        return crack_contacts([problem.groups() for problem in problems])
    except InputError as error:
        return [error] * len(problems)


def _pressed(
    problem: Problem, apart: float, moves: tuple[Move, ...], stiffness: float | None
) -> CrackContact | InputError:
    """Crack contact of a test with a history or a spring, or the error that refuses it."""
    drive = replace(problem.protocol, moves=moves, stiffness=stiffness)
    try:
        drive = replace(drive, start=Apart(apart)) if moves else drive
        return crack_contact(replace(problem, protocol=drive))
    except InputError as error:
        return error


def _refused(answers: Sequence[CrackContact | InputError], speed: Array) -> dict[int, str]:
    """Map the number of each test without a pull-off to the reason."""
    refused = {}
    for i, answer in enumerate(answers):
        if isinstance(answer, InputError):
            refused[i] = str(answer)
        elif answer.pull_off_force is None:
            refused[i] = (
                f"there is no pull-off at {readable(speed[i], 'm/s', digits=3)}; simulate it"
            )
    return refused


def _ranged(found: Curves, effective: Array) -> tuple[Array, Array]:
    """Return tensions and forces with the correction for the range of the forces."""
    ratio = np.asarray(lennard_jones.pull_off_ratio(effective))
    tension = np.where(found.force < 0, -ratio * found.force, 0.0)
    return tension, np.where(found.force < 0, -tension, found.force)


@dataclass(frozen=True)
class Neighbour(Forward):
    """Pull-offs of a material beside another whose cracks are known."""

    known: Forward = field(kw_only=True)

    @cached_property
    def crack(self) -> Any:
        """Return the cracks of the material, by those of its neighbour."""
        return NeighbourCrack(self.known.crack, self.material)

    def edges(self, gap: Array, growth: Growth) -> Any:
        """Return an edge for each case, by those of the neighbour."""
        return NeighbourEdges(super().edges(gap, growth), self.known.crack, self.crack)
