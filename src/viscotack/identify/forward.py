"""Pull-off forces of a sphere relaxed under a preload, for many interfaces and speeds at once.

The contact whose edge is a steady crack (:mod:`viscotack.theory.crack.contact`), with Lennard-Jones
forces: the forward model of a rate series and of its forecast.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.bem import crack_contact
from viscotack.errors import OutOfRange
from viscotack.geometry import Sphere
from viscotack.materials import Material
from viscotack.problem import Problem
from viscotack.protocol import Apart, AtForce, Move, Retraction
from viscotack.theory import SteadyCrack, jkr, lennard_jones
from viscotack.theory.crack.contact import profile_of, recede
from viscotack.theory.crack.steady import NeighbourCrack
from viscotack.traction import LennardJones

from .travel import travels_of

Array = npt.NDArray[np.float64]

_APART = 20.0  # ranges from which an approach begins
_SPEED = 1e-6  # at which groups are asked for; rates are in proportion


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
    """

    force: Array
    effective_tabor: Array
    crack_speed: Array
    contact_radius: Array
    travels: Array


@dataclass(frozen=True)
class Forward:
    """Pull-offs of a sphere of one material.

    Parameters
    ----------
    material : Material
        Of the half-space.
    radius : float
        Of the sphere [m].
    """

    material: Material
    radius: float

    def problem(self, work: float, gap: float, preload: float, speed: float = _SPEED) -> Problem:
        """Return one of the tests: work of adhesion [J/m2], h0 [m], preload [N], speed [m/s]."""
        return Problem(
            material=self.material,
            traction=LennardJones(work_of_adhesion=work, equilibrium_gap=gap),
            geometry=Sphere(radius=self.radius),
            protocol=Retraction(start=AtForce(preload), speed=speed),
        )

    @cached_property
    def crack(self) -> SteadyCrack:
        """Return the cracks of the material, which are the same for all interfaces."""
        groups = self.problem(0.1, 1e-9, 1e-3).groups()
        return SteadyCrack(groups.material, groups.traction)

    def changed(
        self,
        work: float,
        gap: float,
        speed: Array,
        preload: Array,
        *,
        stiffness: float | None = None,
        moves: tuple[Move, ...] = (),
    ) -> Array:
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

        Returns
        -------
        ndarray, shape (S,)
            Pull-off force over that of a relaxed contact and a rigid machine.
        """
        if stiffness is None and not moves:
            return np.ones(speed.size)
        found = []
        for v, load in zip(speed, np.broadcast_to(preload, speed.shape), strict=True):
            plain = self.problem(work, gap, float(load), float(v))
            start = Apart(_APART * gap) if moves else AtForce(float(load))
            protocol = Retraction(start=start, moves=moves, speed=float(v), stiffness=stiffness)
            pair = [crack_contact(plain), crack_contact(replace(plain, protocol=protocol))]
            rigid, other = (one.pull_off_force for one in pair)
            if rigid is None or other is None:
                raise OutOfRange(f"there is no pull-off at {v:.3g} m/s; simulate it")
            found.append(other / rigid)
        return np.array(found)

    def beside(self, material: Material) -> "Neighbour":
        """Return the pull-offs of a material near to this one, at no cost."""
        return Neighbour(material, self.radius, self)

    def pulled(
        self,
        work: npt.ArrayLike,
        gap: npt.ArrayLike,
        speed: npt.ArrayLike,
        preload: npt.ArrayLike,
        radii: int = 160,
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
        """
        w, h0, v, P = np.broadcast_arrays(
            *(np.asarray(x, dtype=float) for x in (work, gap, speed, preload))
        )
        one = self.problem(float(w.flat[0]), float(h0.flat[0]), float(P.flat[0])).groups()
        unit, profile = one.material.time_unit, profile_of(one.geometry)
        # mu and the rate scale with powers of the interface
        tabor = one.tabor * (w / w.flat[0]) ** (2 / 3) * h0.flat[0] / h0
        rate = (one.rate or 0.0) * unit * (h0.flat[0] / h0) * (v / _SPEED) / tabor
        # of a relaxed sphere, in beta, for forces in R dg
        start = np.asarray(
            jkr.contact_radius_at_force(
                P / (self.radius * w), radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0
            )
        )
        crack: Any = self.crack
        found = recede(
            crack,
            profile,
            radius=start.ravel(),
            rate=rate.ravel(),
            tabor=tabor.ravel(),
            radii=radii,
        )
        mu = tabor.ravel()
        effective = mu * np.maximum(found.amplification, 1.0) ** (-1 / 3)
        ratio = np.asarray(lennard_jones.pull_off_ratio(effective))
        tension = np.where(found.force < 0, -ratio * found.force, 0.0)
        pressed = np.where(found.force < 0, -tension, found.force)
        at = np.argmax(tension, axis=0), np.arange(mu.size)
        modulus = self.material.contact_modulus
        beta = (self.radius**2 * w / modulus) ** (1 / 3)
        crack_speed = found.speed[at].reshape(w.shape) * modulus * h0**2 / w / unit
        # heights in beta^2/R
        height = (beta**2 / self.radius).ravel()
        way = travels_of(found.depth[0] - found.depth, pressed, tension[at]) * height[:, None]
        return Pulled(
            tension[at].reshape(w.shape) * self.radius * w,
            effective[at].reshape(w.shape),
            crack_speed,
            start * beta,
            way.reshape(*w.shape, -1),
        )


@dataclass(frozen=True)
class Neighbour(Forward):
    """Pull-offs of a material beside another whose cracks are known."""

    known: Forward

    @cached_property
    def crack(self) -> Any:
        """Return the cracks of the material, by those of its neighbour."""
        return NeighbourCrack(self.known.crack, self.material)
