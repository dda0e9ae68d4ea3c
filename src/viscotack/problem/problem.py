r"""A problem: material, traction law, geometry and protocol, in SI or in dimensionless groups.

With :math:`E_0^* = E_0/(1-\nu^2)` the five groups of the sphere are

.. math:: \mu = \left(\frac{R \Delta\gamma_0^2}{E_0^{*2} h_0^3}\right)^{1/3}, \quad
          k = \frac{E_0}{E_\infty}, \quad n, \quad
          \hat\delta_l = \frac{\delta_l}{h_0}, \quad \hat r = \frac{r\,\tau_0}{h_0}.

They do not fix :math:`R/h_0`: whether strains are small can be judged only in SI, and going from
groups to SI needs four scales. Source: Maghami, PhD thesis (2025), Eq. 4.19, 4.24 and 31, the
Tabor number as corrected in Eq. 31.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.geometry import Sphere
from viscotack.materials import Material, checks
from viscotack.protocol import (
    Apart,
    Approach,
    AtDepth,
    AtForce,
    AtRadius,
    LoadTo,
    Move,
    MoveTo,
    Retract,
    Retraction,
    Start,
    Units,
    check_moves,
)
from viscotack.traction import LennardJones, Traction
from viscotack.units import finite, positive

# Largest contact radius beside the sphere radius. At 0.5 the paraboloid's gap is 7 % off the
# sphere's and strains are of order a/R: linear elasticity of the half-space ends about here.
LARGEST_CONTACT = 0.5


@dataclass(frozen=True)
class Scales:
    """What one unit of each dimensionless output is in SI.

    Attributes
    ----------
    force : float
        1.5 pi R Delta-gamma_0 [N], the JKR pull-off force.
    length : float
        h_0 [m], for depths and gaps.
    radius : float
        (pi R^2 Delta-gamma_0/E_0*)^(1/3) [m], for contact radii.
    work : float
        1.5 pi R Delta-gamma_0 h_0 [J].
    time : float
        The material's time unit [s].
    edge_speed : float
        (R^2 Delta-gamma_0/E_0*)^(1/3) over the time unit [m/s]; no pi.
    stress : float
        Delta-gamma_0/h_0 [Pa], for pressures and tractions.
    """

    force: float
    length: float
    radius: float
    work: float
    time: float
    edge_speed: float
    stress: float


@dataclass(frozen=True)
class Problem:
    """A contact problem in SI.

    Parameters
    ----------
    material : Elastic, StandardSolid, Prony, RetardationPowerLaw or RelaxationPowerLaw
        The soft half-space.
    traction : LennardJones
        The forces across the gap.
    geometry : Sphere
        The rigid indenter.
    protocol : Retraction
        A relaxed start and the retraction from it.

    Raises
    ------
    ValueError
        If a part is of the wrong kind, or the contact is too large for small strain: the relaxed
        contact radius, estimated by JKR, may be up to half the sphere radius, and so may
        sqrt(2 R h_0), the radius over which an undeformed gap of h_0 is reached.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> problem = Problem(
    ...     material=StandardSolid(
    ...         rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5
    ...     ),
    ...     traction=LennardJones(work_of_adhesion=0.15, equilibrium_gap=1.5e-6),
    ...     geometry=Sphere(radius=5e-3),
    ...     protocol=Retraction(start=AtForce(force=1.5e-3), speed=100e-6),
    ... )
    >>> f"{problem.tabor:.3f}"
    '2.027'
    """

    material: Material
    traction: Traction
    geometry: Sphere
    protocol: Retraction

    def __post_init__(self) -> None:
        check_parts(
            self,
            geometry=((Sphere,), "Sphere(radius=5e-3)"),
            protocol=((Retraction,), "Retraction(start=AtForce(force=1e-3), speed=1e-4)"),
        )
        self._check_small_strain()

    @property
    def tabor(self) -> float:
        """Tabor number mu, range of the forces beside the elastic deformation; no unit."""
        return tabor_number(self.geometry.radius, self.material, self.traction)

    def scales(self) -> Scales:
        """Return what one unit of each dimensionless output is in SI."""
        return sphere_scales(self.geometry.radius, self.material, self.traction)

    def groups(self) -> "Groups":
        """Return the dimensionless problem; its time unit is that of the material."""
        return Groups(tabor=self.tabor, **reduced_parts(self, sphere_units(self.scales())))

    def _check_small_strain(self) -> None:
        R = self.geometry.radius
        for state in farthest(self.protocol):
            a = _relaxed_radius(self, state)
            if a <= LARGEST_CONTACT * R:
                continue
            raise ValueError(
                "the start lies beyond small strain: its relaxed contact radius is about "
                f"{a:.3g} m = {a / R:.2g} sphere radii, and the theory holds to {LARGEST_CONTACT}; "
                f"reduce the preload of {state}, or use a larger sphere"
            )
        rim = float(np.sqrt(2 * R * self.traction.equilibrium_gap))
        if rim > LARGEST_CONTACT * R:
            raise ValueError(
                f"equilibrium_gap of {self.traction.equilibrium_gap:.3g} m is too long beside the "
                f"sphere radius of {R:.3g} m: the forces would reach where a sphere is no longer a "
                f"paraboloid; it may be up to {LARGEST_CONTACT**2 / 2:g} radii"
            )


@dataclass(frozen=True)
class Groups:
    """The dimensionless sphere problem.

    Parameters
    ----------
    tabor : float
        Tabor number mu; positive.
    material : like that of a Problem
        Reduced material: rubbery modulus 1, Poisson ratio 0, times in the time unit of the case.
        ``material.reduced()`` makes one whose time unit is tau_0 (Prony: its longest time).
    start : AtDepth, AtForce or AtRadius
        Depth in h_0, force in 1.5 pi R Delta-gamma_0, radius in
        (pi R^2 Delta-gamma_0/E_0*)^(1/3).
    rate : float or None
        Retraction speed in h_0 per time unit; positive. None if the test ends with its moves.
    traction : LennardJones
        Reduced law; leave it out for Lennard-Jones.
    moves : tuple of Approach, Retract, MoveTo, Dwell and LoadTo
        What the machine does before the retraction, in the same units.
    stiffness : float or None
        Of the machine [1.5 pi R Delta-gamma_0/h_0]; None for a rigid one.

    Examples
    --------
    >>> from viscotack.materials import RetardationPowerLaw
    >>> material = RetardationPowerLaw(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> groups = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=316.23)
    >>> groups.modulus_ratio
    0.1
    """

    tabor: float
    material: Material
    start: Start | Apart
    rate: float | None
    traction: Traction = LennardJones(1.0, 1.0)
    moves: tuple[Move, ...] = ()
    stiffness: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "tabor", positive("tabor", self.tabor, "1"))
        check_reduced(self)

    @property
    def modulus_ratio(self) -> float:
        """Rubbery over glassy modulus, k, in (0, 1]; no unit."""
        return self.material.modulus_ratio

    def groups(self) -> "Groups":
        """Return itself, so that a problem in SI and one in groups can be treated alike."""
        return self

    def in_si(
        self,
        *,
        radius: float,
        contact_modulus: float,
        equilibrium_gap: float | None = None,
        work_of_adhesion: float | None = None,
        time_unit: float,
        poisson_ratio: float,
    ) -> Problem:
        """Return the problem in SI with these scales; give the gap or the work of adhesion.

        Parameters
        ----------
        radius : float
            Sphere radius R [m].
        contact_modulus : float
            E_0* = E_0/(1 - nu^2) [Pa].
        equilibrium_gap, work_of_adhesion : float, optional
            h_0 [m] or Delta-gamma_0 [J/m^2]: exactly one, the Tabor number fixes the other.
        time_unit : float
            What one unit of the groups' time is [s], tau_0 for a reduced material.
        poisson_ratio : float
            Poisson ratio of the half-space.

        Raises
        ------
        ValueError
            If both or neither of the last two are given, or the contact is too large.
        """
        R, E = positive("radius", radius, "m"), positive("contact_modulus", contact_modulus, "Pa")
        if (equilibrium_gap is None) == (work_of_adhesion is None):
            raise ValueError("give exactly one of equilibrium_gap [m] and work_of_adhesion [J/m^2]")
        if equilibrium_gap is not None:
            h0 = positive("equilibrium_gap", equilibrium_gap, "m")
            w = float(np.sqrt(self.tabor**3 * E**2 * h0**3 / R))
        else:
            w = positive("work_of_adhesion", work_of_adhesion, "J/m^2")
            h0 = (R * w**2 / (E**2 * self.tabor**3)) ** (1 / 3)
        T = positive("time_unit", time_unit, "s")
        nu = checks.poisson_ratio(finite("poisson_ratio", poisson_ratio, "1"))
        units = Units(h0, 1.5 * np.pi * R * w, (np.pi * R**2 * w / E) ** (1 / 3), T)
        return Problem(
            material=material_in_si(self.material, E * (1 - nu**2), T, nu),
            traction=replace(self.traction, work_of_adhesion=w, equilibrium_gap=h0),  # type: ignore[type-var]
            geometry=Sphere(radius=R),
            protocol=units.retraction(self.start, self.rate, self.moves, self.stiffness),
        )


def tabor_number(radius: float, material: Material, traction: Traction) -> float:
    """Return the Tabor number of a sphere of this radius [m]."""
    w, h0 = traction.work_of_adhesion, traction.equilibrium_gap
    return (radius * w**2 / (material.contact_modulus**2 * h0**3)) ** (1 / 3)


def sphere_scales(radius: float, material: Material, traction: Traction) -> Scales:
    """Return what one unit of each dimensionless output is for a sphere of this radius [m]."""
    w, h0 = traction.work_of_adhesion, traction.equilibrium_gap
    beta = (radius**2 * w / material.contact_modulus) ** (1 / 3)
    force, time = 1.5 * np.pi * radius * w, material.time_unit
    return Scales(
        force=force,
        length=h0,
        radius=np.pi ** (1 / 3) * beta,
        work=force * h0,
        time=time,
        edge_speed=beta / time,
        stress=w / h0,
    )


def sphere_units(scales: Scales) -> Units:
    """Return what takes the numbers of a sphere's protocol from SI to those of its groups."""
    return Units(1 / scales.length, 1 / scales.force, 1 / scales.radius, 1 / scales.time)


def reduced_parts(problem: Any, units: Units) -> dict[str, Any]:
    """Return what the dimensionless groups of all problems have: material, law and test."""
    protocol = problem.protocol
    return {
        "material": problem.material.reduced(),
        "start": units.start(protocol.start),
        "rate": units.speed(protocol.speed),
        "traction": problem.traction.reduced(),
        "moves": units.moves(protocol.moves),
        "stiffness": units.stiffness(protocol.stiffness),
    }


def check_parts(problem: Any, **parts: tuple[tuple[type, ...], str]) -> None:
    """Refuse a problem in SI of which a part is of the wrong kind; an example for each."""
    check_material(problem.material)
    check_traction(problem.traction)
    for name, (kinds, example) in parts.items():
        part = getattr(problem, name)
        if not isinstance(part, kinds):
            wanted = " or ".join(kind.__name__ for kind in kinds)
            raise ValueError(f"{name} must be a {wanted}, got {type(part).__name__}; try {example}")


def check_material(material: Any) -> None:
    """Refuse what is not a material."""
    if not hasattr(material, "retardation_modes") or not hasattr(material, "reduced"):
        raise ValueError(
            f"material must be one of viscotack.materials, got {type(material).__name__}; "
            "for example Elastic(rubbery_modulus=1e6, poisson_ratio=0.5)"
        )


def check_traction(traction: Any) -> None:
    """Refuse what is not a traction law."""
    if not hasattr(traction, "stiffness") or not hasattr(traction, "reduced"):
        raise ValueError(
            f"traction must be a traction law, got {type(traction).__name__}; "
            "for example LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-6)"
        )


def check_reduced(groups: Any) -> None:
    """Refuse dimensionless groups whose parts are not reduced, or in which nothing moves."""
    check_material(groups.material)
    check_traction(groups.traction)
    if groups.material.rubbery_modulus != 1 or groups.material.poisson_ratio != 0:
        raise ValueError(
            "the material of dimensionless groups must have a rubbery modulus of 1 and a "
            f"Poisson ratio of 0, got {groups.material}; pass material.reduced()"
        )
    if groups.traction.work_of_adhesion != 1 or groups.traction.equilibrium_gap != 1:
        raise ValueError(
            f"the traction law of dimensionless groups must be reduced, got {groups.traction}; "
            "pass traction.reduced()"
        )
    if not isinstance(groups.start, Start | Apart):
        raise ValueError(f"start must be AtDepth, AtForce, AtRadius or Apart, got {groups.start!r}")
    object.__setattr__(groups, "moves", tuple(groups.moves))
    check_moves(groups.moves, groups.rate, "rate")
    if groups.rate is not None:
        object.__setattr__(groups, "rate", positive("rate", groups.rate, "h0 per time unit"))
    if groups.stiffness is not None:
        stiffness = positive("stiffness", groups.stiffness, "force over h0")
        object.__setattr__(groups, "stiffness", stiffness)


def material_in_si(material: Any, modulus: float, time: float, poisson_ratio: float) -> Any:
    """Return a reduced material with moduli and times multiplied; fields are told by name."""
    changed: dict[str, Any] = {}
    for field in fields(material):
        value = getattr(material, field.name)
        if field.name.endswith("_modulus"):
            changed[field.name] = value * modulus
        elif field.name == "tau0":
            changed[field.name] = value * time
        elif field.name == "branches":
            changed[field.name] = tuple((E * modulus, t * time) for E, t in value)
    return replace(material, **changed, poisson_ratio=poisson_ratio)


def farthest(protocol: Retraction) -> list[Start]:
    """Return the states that a test goes through, each as if it were relaxed."""
    states = [] if isinstance(protocol.start, Apart) else [protocol.start]
    for move in protocol.moves:
        match move:
            case Approach() | Retract():
                states.append(move.to)
            case MoveTo():
                states.append(AtDepth(move.depth))
            case LoadTo():
                states.append(AtForce(move.force))
    return states


def _relaxed_radius(problem: Problem, start: Start) -> float:
    """Return the JKR contact radius of a relaxed state [m], or 0 where JKR has none."""
    E = problem.material.contact_modulus
    R, w = problem.geometry.radius, problem.traction.work_of_adhesion
    if isinstance(start, AtRadius):
        return start.contact_radius
    if isinstance(start, AtForce):
        P, P1 = start.force, 1.5 * np.pi * R * w
        # eq. (2.3) solved for the radius, on the branch that a dead load keeps
        return float((3 * R / (4 * E) * (np.sqrt(max(P + P1, 0)) + np.sqrt(P1)) ** 2) ** (1 / 3))
    # eq. (2.4), delta = a^2/R - sqrt(2 pi a w/E*), with sqrt(a) = y (c R)^(1/3)
    c = np.sqrt(2 * np.pi * w / E)
    roots: Sequence[complex] | npt.NDArray = np.roots(
        [1, 0, 0, -1, -start.depth * R / (c * R) ** (4 / 3)]
    )
    real = [y.real for y in roots if abs(y.imag) < 1e-9 * max(1.0, abs(y))]
    return float(max(real, default=0.0) ** 2 * (c * R) ** (2 / 3))
