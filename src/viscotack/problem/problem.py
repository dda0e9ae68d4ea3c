r"""A problem: material, traction law, geometry and protocol, in SI or in dimensionless groups.

A shape on a body is one of two kinds, an indenter of revolution (:mod:`.revolution`) or a punch in
plane strain (:mod:`.plane`); these say what its scales, groups, limits and outputs are. With
:math:`E_0^* = E_0/(1-\nu^2)` the five groups of the sphere are

.. math:: \mu = \left(\frac{R \Delta\gamma_0^2}{E_0^{*2} h_0^3}\right)^{1/3}, \quad
          k = \frac{E_0}{E_\infty}, \quad n, \quad
          \hat\delta_l = \frac{\delta_l}{h_0}, \quad \hat r = \frac{r\,\tau_0}{h_0}.

They do not fix :math:`R/h_0`: whether strains are small can be judged only in SI, and going from
groups to SI needs four scales. Source: Maghami, PhD thesis (2025), Eq. 4.19, 4.24 and 31, the
Tabor number as corrected in Eq. 31.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any

import numpy as np

from viscotack.cards import Quantity, conform
from viscotack.errors import InputError
from viscotack.geometry import (
    Base,
    Body,
    FlatPunch,
    Frictionless,
    HalfSpace,
    Layer,
    Shape,
    Sphere,
    numbers,
)
from viscotack.materials import Material
from viscotack.materials.checks import rests
from viscotack.materials.constants import poisson_ratio as checked_poisson_ratio
from viscotack.problem import plane, revolution
from viscotack.problem.outputs import PLANE, REVOLUTION, Kind
from viscotack.problem.plane import PunchScales
from viscotack.problem.revolution import Scales
from viscotack.problem.units import material_in_si
from viscotack.protocol import Apart, Move, Retraction, Start, Units, check_moves
from viscotack.traction import LennardJones, Traction, effective_range
from viscotack.traction.growing import reduced, scaled
from viscotack.units import positive

Rate = Annotated[
    float,
    Quantity("h0 per time unit", "r", "retraction speed", above=0, measure="speed"),
]
Spring = Annotated[
    float,
    Quantity("force over h0", "K", "stiffness of the machine", above=0, measure="stiffness"),
]


@dataclass(frozen=True)
class Problem:
    """A contact problem in SI: a shape on a body.

    Parameters
    ----------
    material : Elastic, StandardSolid, Prony, RetardationPowerLaw or RelaxationPowerLaw
        The soft body's.
    traction : LennardJones, Dugdale, Exponential, Tabulated, GentSchultz or Eyring
        The forces across the gap.
    geometry : Sphere, Cone, PowerLawProfile or FlatPunch
        The rigid indenter.
    protocol : Retraction
        A relaxed start and the retraction from it, and what the machine does between. Of a punch
        AtForce and LoadTo are mean stresses [Pa], positive in compression, and a stiffness is per
        area [Pa/m].
    body : HalfSpace or Layer
        What is pressed; a half-space when left out. A flat punch needs a layer, the others a
        half-space.

    Raises
    ------
    ValueError
        If a part is of the wrong kind, shape and body do not go together, or the contact is too
        large for small strain: the relaxed contact radius of a sphere, estimated by JKR, may be up
        to half its radius, and so may sqrt(2 R h_0), the radius over which an undeformed gap of h_0
        is reached; of another shape the flank may be up to 0.5 there.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> from viscotack.protocol import AtDepth, AtForce
    >>> rubber = StandardSolid(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> law = LennardJones(work_of_adhesion=0.15, equilibrium_gap=1.5e-6)
    >>> problem = Problem(
    ...     material=rubber,
    ...     traction=law,
    ...     geometry=Sphere(radius=5e-3),
    ...     protocol=Retraction(start=AtForce(force=1.5e-3), speed=100e-6),
    ... )
    >>> f"{problem.groups().tabor:.3f}"
    '2.027'

    A punch on a layer:

    >>> problem = Problem(
    ...     material=rubber,
    ...     traction=law,
    ...     geometry=FlatPunch(half_width=1e-3),
    ...     body=Layer(thickness=50e-6),
    ...     protocol=Retraction(start=AtDepth(1.5e-6), speed=100e-6),
    ... )
    >>> f"{problem.groups().size:.1f}"
    '22.4'
    """

    material: Material
    traction: Traction
    geometry: Shape | FlatPunch
    protocol: Retraction
    body: Body = HalfSpace()

    def __post_init__(self) -> None:
        _check_material(self.material)
        _check_traction(self.traction)
        for name, wanted, example in (
            ("geometry", ("symmetry",), "Sphere(radius=5e-3)"),
            ("body", ("word",), "Layer(thickness=1e-4)"),
            ("protocol", ("start", "moves"), "Retraction(start=AtForce(force=1e-3), speed=1e-4)"),
        ):
            part = getattr(self, name)
            if isinstance(part, type) or not all(hasattr(part, name) for name in wanted):
                given = part.__name__ if isinstance(part, type) else type(part).__name__
                raise InputError(f"{name} cannot be a {given}; try {example}")
        if self.geometry.symmetry not in ("revolution", "plane") or (
            self.geometry.symmetry == "plane" and not isinstance(self.geometry, FlatPunch)
        ):
            raise InputError(
                "a shape has the symmetry 'revolution', and only a FlatPunch is 'plane', got "
                f"{self.geometry.symmetry!r} of {self.geometry!r}"
            )
        with np.errstate(over="ignore", under="ignore"):
            self._check_digits()
            self._kind.check(self)

    def _check_digits(self) -> None:
        """Raise an InputError where a unit of the dimensionless problem is not a number."""
        try:
            lost = [name for name, unit in vars(self._scales).items() if not 0 < unit < np.inf]
        except ArithmeticError:
            lost = ["length"]
        if lost:
            raise InputError(
                f"no number holds the unit of {', '.join(lost)} of this problem: {self.geometry}, "
                f"{self.traction} and a contact modulus of {self.material.contact_modulus:.4g} Pa "
                "lie too far apart; check their units"
            )

    @property
    def tabor(self) -> float:
        """Tabor number mu of a shape of revolution, range of the forces beside the deformation."""
        return revolution.tabor_number(self.radius, self.material, self.traction)

    @cached_property
    def radius(self) -> float:
        """Radius R [m] of the sphere with the Tabor number and scales of a shape of revolution."""
        if self._kind is plane:
            raise InputError("a flat punch has no radius and no Tabor number; see PunchGroups")
        return revolution.radius_of(self)

    @property
    def fracture_length(self) -> float:
        """Length a_0 [m] of a punch, Eq. 3.3."""
        if self._kind is not plane:
            raise InputError(f"the length a_0 is one of a punch, and this is a {self.geometry}")
        return plane.fracture_length(self)

    @property
    def outputs(self) -> Kind:
        """What the numbers of its answer are called and given in."""
        return PLANE if self._kind is plane else REVOLUTION

    @property
    def units(self) -> Mapping[str, str]:
        """What its protocol is measured in."""
        return self._kind.SI

    def scales(self) -> Any:
        """Return what one unit of each dimensionless output is in SI, Scales or PunchScales."""
        return self._scales

    def groups(self) -> Any:
        """Return the dimensionless problem, Groups or PunchGroups, in the material's time unit."""
        unit: Any = self._scales
        units: Units = self._kind.to_groups(unit)
        protocol = self.protocol
        parts: dict[str, Any] = {
            "material": self.material.reduced(),
            "start": units.start(protocol.start),
            "rate": units.speed(protocol.speed),
            "traction": reduced(self.traction, unit.time),
            "moves": units.moves(protocol.moves),
            "stiffness": units.stiffness(protocol.stiffness),
        }
        if isinstance(self.geometry, FlatPunch):
            assert isinstance(self.body, Layer)
            return PunchGroups(
                size=self.geometry.half_width / unit.width,
                thickness=self.body.thickness / unit.width,
                cohesion=unit.stress / self.material.contact_modulus,
                base=self.body.base,
                **parts,
            )
        R, law = self.radius, self.traction
        along = (R**2 * law.work_of_adhesion / self.material.contact_modulus) ** (1 / 3)
        shape = self.geometry.reduced(along, along**2 / R)
        return Groups(tabor=self.tabor, geometry=shape, **parts)

    @property
    def _kind(self) -> Any:
        return {"revolution": revolution, "plane": plane}[self.geometry.symmetry]

    @cached_property
    def _scales(self) -> Scales | PunchScales:
        if self._kind is plane:
            return plane.scales_of(self)
        return revolution.scales_of(self.radius, self.material, self.traction)


@dataclass(frozen=True)
class Groups:
    """A dimensionless problem: an indenter of revolution on a half-space.

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
    geometry : Sphere, Cone, PowerLawProfile or a shape of revolution of the user's
        Reduced shape, of slope 1 at distance 1: leave it out for the sphere. Then R is the
        equivalent radius.

    Notes
    -----
    Profiles were tested for exponents from 1 to 10, Tabor numbers from 0.01 to 10 and a modulus
    ratio of 0.1; a cone has wide contacts, and at a Tabor number of 30 it takes minutes. The
    elastic pull-off force of a cone is above that of JKR by 25, 4.7 and 0.7 % at Tabor numbers of
    1, 3 and 10. The energy audit closes within 1e-3, but for viscoelastic cones pressed by a force
    above zero at large Tabor numbers: there 3e-3 at the default accuracy, while next to no work has
    been done, and 7e-4 at an accuracy of 5e-4.

    Examples
    --------
    >>> from viscotack.materials import RetardationPowerLaw
    >>> from viscotack.protocol import AtDepth
    >>> material = RetardationPowerLaw(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> groups = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=316.23)
    >>> groups.modulus_ratio
    0.1
    """

    tabor: Annotated[
        float,
        Quantity("1", "mu", "Tabor number, (R dg0^2/(E0*^2 h0^3))^(1/3)", above=0, example="3.24"),
    ]
    material: Material
    start: Start | Apart
    rate: Rate | None
    traction: Traction = LennardJones(1.0, 1.0)
    moves: tuple[Move, ...] = ()
    stiffness: Spring | None = None
    geometry: Shape = Sphere(1.0)

    def __post_init__(self) -> None:
        bare = isinstance(self.geometry, type)
        if bare or getattr(self.geometry, "symmetry", "") != "revolution":
            raise InputError(
                f"geometry must be a reduced shape of revolution, got {self.geometry!r}; leave it "
                "out for a sphere"
            )
        slope = float(self.geometry.flank(1.0))
        if abs(slope - 1) > 1e-6:
            raise InputError(
                "the geometry of dimensionless groups must be reduced, of slope 1 at distance 1, "
                f"got {self.geometry!r} of slope {slope:g}; problem.groups().geometry is so"
            )
        _check_reduced(self)

    @property
    def modulus_ratio(self) -> float:
        """Rubbery over glassy modulus, k, in (0, 1]; no unit."""
        return self.material.modulus_ratio

    @property
    def effective_tabor(self) -> float:
        """Tabor number over the effective range of the law: how near the contact is to JKR."""
        return self.tabor / effective_range(self.traction)

    @property
    def outputs(self) -> Kind:
        """What the numbers of its answer are called and given in."""
        return REVOLUTION

    @property
    def units(self) -> Mapping[str, str]:
        """What its protocol is measured in."""
        return revolution.GROUPS

    @property
    def inputs(self) -> dict[str, float | None]:
        """The numbers that a summary repeats."""
        shape = dict(numbers(self.geometry))
        return {
            "tabor": self.tabor,
            **shape,
            "modulus_ratio": self.modulus_ratio,
            "rate": self.rate,
        }

    def groups(self) -> "Groups":
        """Return itself, so that a problem in SI and one in groups can be treated alike."""
        return self

    def scales(self) -> None:
        """Return None: there is nothing to go back to."""

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
            Sphere radius R [m]; of another shape its equivalent radius.
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
            raise InputError("give exactly one of equilibrium_gap [m] and work_of_adhesion [J/m^2]")
        if equilibrium_gap is not None:
            h0 = positive("equilibrium_gap", equilibrium_gap, "m")
            w = float(np.sqrt(self.tabor**3 * E**2 * h0**3 / R))
        else:
            w = positive("work_of_adhesion", work_of_adhesion, "J/m^2")
            h0 = (R * w**2 / (E**2 * self.tabor**3)) ** (1 / 3)
        T = positive("time_unit", time_unit, "s")
        nu = checked_poisson_ratio(poisson_ratio)
        units = Units(h0, 1.5 * np.pi * R * w, (np.pi * R**2 * w / E) ** (1 / 3), T)
        along = (R**2 * w / E) ** (1 / 3)
        own = isinstance(self.geometry, Sphere)
        return Problem(
            material=material_in_si(self.material, E * (1 - nu**2), T, nu),
            traction=scaled(self.traction, w, h0, T),
            geometry=Sphere(R) if own else self.geometry.reduced(1 / along, R / along**2),
            protocol=units.retraction(self.start, self.rate, self.moves, self.stiffness),
        )


@dataclass(frozen=True)
class PunchGroups:
    """The dimensionless punch on a layer.

    Parameters
    ----------
    size : float
        Half width a/a_0; positive.
    thickness : float
        Thickness b/a_0; positive.
    cohesion : float
        Strength of the interface over the relaxed contact modulus, sigma_0/E_0*; positive.
    material : like that of a Problem
        Reduced material, see :class:`viscotack.Groups`.
    start : AtDepth, AtForce or Apart
        Depth and gap in h_0, mean stress in sigma_0 (positive in compression).
    rate : float or None
        Retraction speed in h_0 per time unit; positive. None if the test ends with its moves.
    base : Frictionless or Bonded
        How the layer rests on the rigid body below it.
    traction : LennardJones
        Reduced law; leave it out for Lennard-Jones.
    moves : tuple of Approach, Retract, MoveTo, Dwell and LoadTo
        What the machine does before the retraction, in the same units.
    stiffness : float or None
        Of the machine [sigma_0/h_0]; None for a rigid one.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> from viscotack.protocol import AtDepth
    >>> material = StandardSolid(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> PunchGroups(
    ...     size=64.85, thickness=3.24, cohesion=0.05, material=material.reduced(),
    ...     start=AtDepth(1.0), rate=10.0,
    ... ).modulus_ratio
    0.1
    """

    size: Annotated[float, Quantity("a0", "a/a0", "half width of the punch", above=0)]
    thickness: Annotated[float, Quantity("a0", "b/a0", "thickness of the layer", above=0)]
    cohesion: Annotated[
        float, Quantity("1", "Sigma0", "strength of the interface, sigma0/E0*", above=0)
    ]
    material: Material
    start: Start | Apart
    rate: Rate | None
    base: Base = Frictionless()
    traction: Traction = LennardJones(1.0, 1.0)
    moves: tuple[Move, ...] = ()
    stiffness: Spring | None = None

    def __post_init__(self) -> None:
        _check_reduced(self)
        if not isinstance(self.base, Base):
            raise InputError(
                f"base must be Frictionless() or Bonded(poisson_ratio=...), got {self.base!r}"
            )
        plane.check_start(self.start)

    @property
    def modulus_ratio(self) -> float:
        """Rubbery over glassy modulus, k, in (0, 1]; no unit."""
        return self.material.modulus_ratio

    @property
    def fracture_length(self) -> float:
        r"""Length a_0 over h_0, Eq. 3.5.

        .. math:: \frac{a_0}{h_0} = \frac{\pi}{2} \frac{\Delta\gamma_0}{\sigma_0 h_0 \Sigma_0}
        """
        return np.pi / (2 * self.traction.strength * self.cohesion)

    @property
    def outputs(self) -> Kind:
        """What the numbers of its answer are called and given in."""
        return PLANE

    @property
    def units(self) -> Mapping[str, str]:
        """What its protocol is measured in."""
        return plane.GROUPS

    @property
    def inputs(self) -> dict[str, float | None]:
        """The numbers that a summary repeats."""
        names = ("size", "thickness", "cohesion", "modulus_ratio", "rate")
        return {name: getattr(self, name) for name in names}

    def groups(self) -> "PunchGroups":
        """Return itself, so that a problem in SI and one in groups can be treated alike."""
        return self

    def scales(self) -> None:
        """Return None: there is nothing to go back to."""

    def in_si(
        self,
        *,
        contact_modulus: float,
        work_of_adhesion: float,
        time_unit: float,
        poisson_ratio: float,
    ) -> Problem:
        """Return the problem in SI with these scales; the cohesion fixes strength and gap.

        Parameters
        ----------
        contact_modulus : float
            E_0* = E_0/(1 - nu^2) [Pa].
        work_of_adhesion : float
            Delta-gamma_0 [J/m^2].
        time_unit : float
            What one unit of the groups' time is [s].
        poisson_ratio : float
            Poisson ratio of the layer.
        """
        E = positive("contact_modulus", contact_modulus, "Pa")
        w = positive("work_of_adhesion", work_of_adhesion, "J/m^2")
        T = positive("time_unit", time_unit, "s")
        nu = checked_poisson_ratio(poisson_ratio)
        strength = self.cohesion * E
        h0 = self.traction.strength * w / strength
        a0 = np.pi * E * w / (2 * strength**2)
        units = Units(h0, strength, a0, T)
        return Problem(
            material=material_in_si(self.material, E * (1 - nu**2), T, nu),
            traction=scaled(self.traction, w, h0, T),
            geometry=FlatPunch(half_width=self.size * a0),
            body=Layer(thickness=self.thickness * a0, base=self.base),
            protocol=units.retraction(self.start, self.rate, self.moves, self.stiffness),
        )


Case = Problem | Groups | PunchGroups


def _check_material(material: Any) -> None:
    """Refuse what is not a material."""
    rests(material)
    if not hasattr(material, "retardation_modes") or not hasattr(material, "reduced"):
        raise InputError(
            f"material must be one of viscotack.materials, got {type(material).__name__}; "
            "for example Elastic(rubbery_modulus=1e6, poisson_ratio=0.5)"
        )


def _check_traction(traction: Any) -> None:
    """Refuse what is not a traction law."""
    if not hasattr(traction, "stiffness") or not hasattr(traction, "reduced"):
        raise InputError(
            f"traction must be a traction law, got {type(traction).__name__}; "
            "for example LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-6)"
        )


def _check_reduced(groups: Any) -> None:
    """Refuse dimensionless groups whose parts are not reduced, or in which nothing moves."""
    _check_material(groups.material)
    _check_traction(groups.traction)
    if groups.material.rubbery_modulus != 1 or groups.material.poisson_ratio != 0:
        raise InputError(
            "the material of dimensionless groups must have a rubbery modulus of 1 and a "
            f"Poisson ratio of 0, got {groups.material}; pass material.reduced()"
        )
    if groups.traction.work_of_adhesion != 1 or groups.traction.equilibrium_gap != 1:
        raise InputError(
            f"the traction law of dimensionless groups must be reduced, got {groups.traction}; "
            "pass traction.reduced()"
        )
    if not isinstance(groups.start, Start | Apart):
        raise InputError(f"start must be AtDepth, AtForce, AtRadius or Apart, got {groups.start!r}")
    object.__setattr__(groups, "moves", tuple(groups.moves))
    check_moves(groups.moves, groups.rate, "rate")
    conform(groups)
