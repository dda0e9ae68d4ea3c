r"""Contact problem: material, traction law, geometry and protocol, in SI or dimensionless groups.

A problem is a shape on a body, with a traction law, a material and a protocol. The symmetry of
the shape defines its kind: an indenter of revolution (:mod:`.revolution`) or a punch in plane
strain (:mod:`.plane`), with their scales, groups, limits and outputs. With
:math:`E_0^* = E_0/(1-\nu^2)` the five groups of the sphere on a half-space are

.. math:: \mu = \left(\frac{R \Delta\gamma_0^2}{E_0^{*2} h_0^3}\right)^{1/3}, \quad
          k = \frac{E_0}{E_\infty}, \quad n, \quad
          \hat\delta_l = \frac{\delta_l}{h_0}, \quad \hat r = \frac{r\,\tau_0}{h_0}.

They do not determine :math:`R/h_0`: whether strains are small can be checked only in SI, and
converting groups to SI needs four scales. Source: Maghami, PhD thesis (2025), Eq. 4.19, 4.24 and
31, with the Tabor number as corrected in Eq. 31.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from viscotack.cards import Quantity, conform
from viscotack.errors import InputError
from viscotack.model.geometry import Body, FlatPunch, HalfSpace, Shape, Sphere, numbers
from viscotack.model.materials import Material
from viscotack.model.materials.constants import poisson_ratio as checked_poisson_ratio
from viscotack.model.materials.conversion import scaled
from viscotack.model.problem import plane, revolution
from viscotack.model.problem.outputs import Kind
from viscotack.model.problem.plane import PunchScales
from viscotack.model.problem.revolution import Scales
from viscotack.model.protocol import Apart, Move, Retraction, Start, Units, check_moves
from viscotack.model.traction import LennardJones, Traction, effective_range
from viscotack.model.traction.growing import in_si, reduced
from viscotack.units import positive

Tabor = Annotated[
    float,
    Quantity(
        "1", "mu", "Tabor number, (R dg0^2/(E0*^2 h0^3))^(1/3)", above=0, most=1e12, example="3.24"
    ),
]
if TYPE_CHECKING:
    _TaborOrNone = Any  # code for one symmetry need not check for None again
else:
    _TaborOrNone = Tabor | None
Cohesion = Annotated[
    float, Quantity("1", "Sigma0", "strength of the interface, sigma0/E0*", above=0)
]
Rate = Annotated[
    float,
    Quantity("h0 per time unit", "r", "retraction speed", above=0, measure="speed"),
]
Spring = Annotated[
    float,
    Quantity("force over h0", "K", "stiffness of the machine", above=0, measure="stiffness"),
]


class _OfKind:
    """What the symmetry of the shape decides, in SI and dimensionless."""

    geometry: Any

    @property
    def outputs(self) -> Kind:
        """Names and units of the outputs."""
        return self._kind.outputs(self.geometry)

    @property
    def _kind(self) -> Any:
        return _KINDS[self.geometry.symmetry]


@dataclass(frozen=True)
class Problem(_OfKind):
    """A contact problem in SI: a shape on a body.

    Parameters
    ----------
    material : Elastic, StandardSolid, Prony, RetardationPowerLaw or RelaxationPowerLaw
        Material of the soft body.
    traction : LennardJones, Dugdale, Exponential, Tabulated, or one that grows or ages
        Traction law of the interface.
    geometry : Sphere, Cone, PowerLawProfile, FlatPunch or a shape of the user's
        Rigid indenter.
    protocol : Retraction
        State at rest, moves and retraction. For a punch,
        AtForce and LoadTo are mean stresses [Pa], positive in compression, and a stiffness is per
        area [Pa/m].
    body : HalfSpace, Layer or a body of the user's
        Soft body, by default a half-space. A flat punch needs a layer, other shapes press either,
        or a body for their symmetry.

    Raises
    ------
    ValueError
        If a part is of the wrong kind, shape and body do not fit together, or the contact is too
        large for small strain: the relaxed contact radius of a sphere, estimated by JKR, may be up
        to half its radius, and so may sqrt(2 R h_0), the radius at which the undeformed gap is h_0;
        for another shape the slope of the flank may be up to 0.5 there.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.model.protocol import AtDepth, AtForce
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

    >>> from viscotack.model.geometry import FlatPunch, Layer
    >>> problem = Problem(
    ...     material=rubber,
    ...     traction=law,
    ...     geometry=FlatPunch(half_width=1e-3),
    ...     body=Layer(thickness=50e-6),
    ...     protocol=Retraction(start=AtDepth(1.5e-6), speed=100e-6),
    ... )
    >>> f"{problem.groups().geometry.half_width:.1f}"
    '22.4'
    """

    material: Material
    traction: Traction
    geometry: Shape | FlatPunch
    protocol: Retraction
    body: Body = HalfSpace()

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        from viscotack.plot.notebook import html_of_problem

        return html_of_problem(self)

    def __post_init__(self) -> None:
        _check_parts(self)
        own, nu = getattr(self.body, "poisson_ratio", None), self.material.poisson_ratio
        if own is not None and own != nu:
            raise InputError(
                f"a bonded layer must have the Poisson ratio of its material, {nu:g}, got {own:g}"
            )
        with np.errstate(over="ignore", under="ignore"):
            try:
                lost = [name for name, unit in vars(self._scales).items() if not 0 < unit < np.inf]
            except ArithmeticError:
                lost = ["length"]
            if lost:
                raise InputError(
                    f"the unit of {', '.join(lost)} of this problem overflows or underflows: "
                    f"{self.geometry}, {self.traction} and a contact modulus of "
                    f"{self.material.contact_modulus:.4g} Pa have incompatible magnitudes; check "
                    "their units"
                )
            self._kind.check(self)

    @property
    def tabor(self) -> float:
        """Tabor number mu of a shape of revolution: deformation over range of the forces."""
        return revolution.tabor_number(self)

    @cached_property
    def radius(self) -> float:
        """Radius R [m] of a sphere with the same Tabor number and scales."""
        if self._kind is plane:
            raise InputError("a flat punch has no radius and no Tabor number; see its cohesion")
        return revolution.radius_of(self)

    @property
    def cohesion(self) -> float:
        """Strength of the interface of a punch over the contact modulus, Sigma_0."""
        if self._kind is not plane:
            raise InputError(f"the cohesion is defined for a punch, got a {self.geometry}")
        return self.traction.strength / self.material.contact_modulus

    @property
    def fracture_length(self) -> float:
        """Length a_0 [m] of a punch, Eq. 3.3."""
        if self._kind is not plane:
            raise InputError(f"the length a_0 is defined for a punch, got a {self.geometry}")
        return plane.fracture_length(self)

    @property
    def units(self) -> Mapping[str, str]:
        """Units of the protocol."""
        return self._kind.SI

    def scales(self) -> Any:
        """Return the SI values of the units of the outputs, Scales or PunchScales."""
        return self._scales

    def groups(self) -> "Groups":
        """Return the dimensionless problem, in the material's time unit."""
        unit: Any = self._scales
        units: Units = self._kind.to_groups(unit)
        test = units.scaled(self.protocol)
        along, height = self._kind.lengths(self)
        return Groups(
            tabor=None if self._kind is plane else self.tabor,
            cohesion=self.cohesion if self._kind is plane else None,
            material=self.material.reduced(),
            start=test.start,
            rate=test.speed,
            traction=reduced(self.traction, unit.time),
            moves=test.moves,
            stiffness=test.stiffness,
            geometry=self.geometry.reduced(along, height),
            body=self.body.reduced(along),
        )

    @cached_property
    def _scales(self) -> Scales | PunchScales:
        return self._kind.scales_of(self)


@dataclass(frozen=True)
class Groups(_OfKind):
    """A dimensionless problem: a reduced shape on a reduced body.

    Parameters
    ----------
    tabor : float or None
        Tabor number mu of a shape of revolution; positive. None for a punch.
    material : like that of a Problem
        Reduced material: rubbery modulus 1, Poisson ratio 0, times in the time unit of the case.
        ``material.reduced()`` returns it with the time unit tau_0 (Prony: its longest time).
    start : AtDepth, AtForce, AtRadius or Apart
        State at rest: depth and gap in h_0, force in 1.5 pi R Delta-gamma_0, radius in
        (pi R^2 Delta-gamma_0/E_0*)^(1/3); for a punch mean stress in sigma_0 (positive in
        compression), and no radius.
    rate : float or None
        Retraction speed in h_0 per time unit; positive. None if the test ends with its moves.
    traction : LennardJones
        Reduced law, by default Lennard-Jones.
    moves : tuple of Approach, Retract, MoveTo, Dwell and LoadTo
        Moves of the machine before the retraction, in the same units.
    stiffness : float or None
        Stiffness of the machine [1.5 pi R Delta-gamma_0/h_0], for a punch [sigma_0/h_0]; None if
        rigid.
    geometry : Sphere, Cone, PowerLawProfile, FlatPunch or a shape of revolution of the user's
        Reduced shape, by default the sphere. A shape of revolution has slope 1 at distance 1;
        then R is the equivalent radius. The half width of a punch is in a_0.
    body : HalfSpace, Layer or a body of the user's
        Body with lengths in beta = (R^2 Delta-gamma_0/E_0*)^(1/3), under a punch in a_0; by default
        the half-space.
    cohesion : float or None
        For a punch, strength of the interface over the relaxed contact modulus, sigma_0/E_0*;
        positive. None for a shape of revolution.

    Notes
    -----
    Profiles were tested for exponents from 1 to 10, Tabor numbers from 0.01 to 10 and a modulus
    ratio of 0.1. Contacts of a cone are wide; at a Tabor number of 30 a simulation takes minutes.
    The elastic pull-off force of a cone exceeds that of JKR by 25, 4.7 and 0.7 % at Tabor numbers
    of 1, 3 and 10. The energy balance closes within 1e-3, except for viscoelastic cones under a
    compressive start force at large Tabor numbers: there the residual is 3e-3 at the default
    accuracy, while the work is still small, and 7e-4 at an accuracy of 5e-4. Elastic cones on
    layers at Tabor numbers above 10 have residuals up to 3e-3 at the default accuracy.

    Examples
    --------
    >>> from viscotack.model.materials import RetardationPowerLaw, StandardSolid
    >>> from viscotack.model.protocol import AtDepth
    >>> plateaus = {"rubbery_modulus": 1.5e6, "glassy_modulus": 15e6, "poisson_ratio": 0.5}
    >>> material = RetardationPowerLaw(**plateaus, exponent=0.8, tau0=0.1)
    >>> groups = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=316.23)
    >>> groups.modulus_ratio
    0.1

    A punch on a sliding layer:

    >>> from viscotack.model.geometry import FlatPunch, Layer
    >>> punch = Groups(
    ...     tabor=None, cohesion=0.05, geometry=FlatPunch(64.85), body=Layer(3.24),
    ...     material=StandardSolid(**plateaus, tau0=0.1).reduced(), start=AtDepth(1.0), rate=10.0,
    ... )
    >>> f"{punch.fracture_length:.1f} h0"
    '30.6 h0'
    """

    tabor: _TaborOrNone
    material: Material
    start: Start | Apart
    rate: Rate | None
    traction: Traction = LennardJones(1.0, 1.0)
    moves: tuple[Move, ...] = ()
    stiffness: Spring | None = None
    geometry: Shape | FlatPunch = Sphere(1.0)
    body: Body = HalfSpace()
    cohesion: Cohesion | None = None

    def __post_init__(self) -> None:
        _check_parts(self)
        plain = self.in_plane_strain
        if (self.tabor is None) != plain or (self.cohesion is None) == plain:
            needs = (
                "cohesion, sigma_0/E_0*, and no Tabor number"
                if plain
                else "Tabor number and no cohesion"
            )
            raise InputError(
                f"a {self.geometry.word} needs a {needs}: give for example "
                f"{'cohesion=0.05' if plain else 'tabor=3.24'}, got cohesion={self.cohesion} and "
                f"tabor={self.tabor}",
                field="cohesion" if plain else "tabor",
            )
        if self.material.rubbery_modulus != 1 or self.material.poisson_ratio != 0:
            raise InputError(
                "the material of dimensionless groups must have a rubbery modulus of 1 and a "
                f"Poisson ratio of 0, got {self.material}; use material.reduced()"
            )
        if self.traction.work_of_adhesion != 1 or self.traction.equilibrium_gap != 1:
            raise InputError(
                f"the traction law of dimensionless groups must be reduced, got {self.traction}; "
                "use traction.reduced()"
            )
        if not isinstance(self.start, Start | Apart):
            raise InputError(
                f"start must be AtDepth, AtForce, AtRadius or Apart, got {self.start!r}"
            )
        object.__setattr__(self, "moves", tuple(self.moves))
        check_moves(self.moves, self.rate, "rate")
        conform(self)
        self._kind.check_groups(self)

    @property
    def in_plane_strain(self) -> bool:
        """Whether the shape is a flat punch in plane strain."""
        return self._kind is plane

    @property
    def modulus_ratio(self) -> float:
        """Rubbery over glassy modulus, k, in (0, 1], dimensionless."""
        return self.material.modulus_ratio

    @property
    def effective_tabor(self) -> float:
        """Range-corrected Tabor number mu_s = mu/s, with the effective range s [h0] of the law.

        Equal to the Tabor number for Lennard-Jones. The effective Tabor number of a moving edge,
        ``mu_s Gamma^(-1/3)``, also counts the amplification of its energy.
        """
        if self.tabor is None:
            raise InputError("a flat punch has no Tabor number; see its cohesion")
        return self.tabor / effective_range(self.traction)

    @property
    def fracture_length(self) -> float:
        r"""Length a_0 of a punch over h_0, Eq. 3.5.

        .. math:: \frac{a_0}{h_0} = \frac{\pi}{2} \frac{\Delta\gamma_0}{\sigma_0 h_0 \Sigma_0}
        """
        if self.cohesion is None:
            raise InputError(f"the length a_0 is defined for a punch, got a {self.geometry}")
        return np.pi / (2 * self.traction.strength * self.cohesion)

    @property
    def units(self) -> Mapping[str, str]:
        """Units of the protocol."""
        return self._kind.GROUPS

    @property
    def inputs(self) -> dict[str, float | None]:
        """Input numbers repeated in a summary."""
        found: dict[str, float | None] = {} if self.tabor is None else {"tabor": self.tabor}
        found |= {**numbers(self.geometry), **numbers(self.body)}
        found |= {} if self.cohesion is None else {"cohesion": self.cohesion}
        return found | {"modulus_ratio": self.modulus_ratio, "rate": self.rate}

    def groups(self) -> "Groups":
        """Return itself, as :meth:`Problem.groups` does for a problem in SI."""
        return self

    def scales(self) -> None:
        """Return None, because the groups have no SI scales."""

    def in_si(
        self,
        *,
        contact_modulus: float,
        radius: float | None = None,
        equilibrium_gap: float | None = None,
        work_of_adhesion: float | None = None,
        time_unit: float,
        poisson_ratio: float,
    ) -> Problem:
        """Convert the problem to SI with given scales; give either the gap or the work of adhesion.

        Parameters
        ----------
        contact_modulus : float
            E_0* = E_0/(1 - nu^2) [Pa].
        radius : float, optional
            Sphere radius R [m], or the equivalent radius of another shape of revolution; None for a
            punch.
        equilibrium_gap, work_of_adhesion : float, optional
            h_0 [m] or Delta-gamma_0 [J/m^2]: exactly one; the other follows from the Tabor number,
            or from the cohesion of a punch.
        time_unit : float
            Time unit of the groups [s], tau_0 for a reduced material.
        poisson_ratio : float
            Poisson ratio of the body.

        Raises
        ------
        ValueError
            If both or neither of gap and work are given, a radius is missing or superfluous, or the
            contact is too large.
        """
        E = positive("contact_modulus", contact_modulus, "Pa")
        if (equilibrium_gap is None) == (work_of_adhesion is None):
            raise InputError("give exactly one of equilibrium_gap [m] and work_of_adhesion [J/m^2]")
        if equilibrium_gap is None:
            scale = {"work_of_adhesion": positive("work_of_adhesion", work_of_adhesion, "J/m^2")}
        else:
            scale = {"equilibrium_gap": positive("equilibrium_gap", equilibrium_gap, "m")}
        T = positive("time_unit", time_unit, "s")
        nu = checked_poisson_ratio(poisson_ratio)
        unit = self._kind.si_units(self, E, radius, **scale)
        units = Units(unit.length, unit.force, unit.contact_radius, T)
        test = Retraction(self.start, self.rate, self.moves, self.stiffness)
        shape = self.geometry.reduced(1 / unit.along, 1 / unit.height)
        material = scaled(self.material, modulus=E * (1 - nu**2), time=T)
        return Problem(
            material=replace(material, poisson_ratio=nu),
            traction=in_si(self.traction, unit.work, unit.length, T),
            # keep the radius of a sphere exact
            geometry=Sphere(radius) if isinstance(shape, Sphere) and radius else shape,
            body=self.body.reduced(1 / unit.along),
            protocol=units.scaled(test),
        )


Case = Problem | Groups
# Modules by symmetry of the shape: scales, groups, limits and outputs.
_KINDS: Mapping[str, Any] = {"revolution": revolution, "plane": plane}


# What a part of a problem must have, and an example of one.
_PARTS = {
    "material": ("retardation_modes", "Elastic(rubbery_modulus=1e6, poisson_ratio=0.5)"),
    "traction": ("energy_beyond", "LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-6)"),
    "geometry": ("symmetry", "Sphere(radius=5e-3)"),
    "body": ("symmetries", "Layer(thickness=1e-4)"),
    "protocol": ("moves", "Retraction(start=AtForce(force=1e-3), speed=1e-4)"),
}


def _check_parts(problem: Any) -> None:
    """Raise an error for a part of another kind, or a body that does not support the shape."""
    for name, part in vars(problem).items():
        member, example = _PARTS.get(name, ("", ""))
        if member and (isinstance(part, type) or not hasattr(part, member)):
            given = part.__name__ if isinstance(part, type) else type(part).__name__
            raise InputError(f"{name} cannot be a {given}; try {example}", field=name)
    shape, body = problem.geometry, problem.body
    plain = shape.symmetry == "plane"
    if shape.symmetry not in _KINDS or (plain and not isinstance(shape, FlatPunch)):
        raise InputError(
            "a shape must have the symmetry 'revolution' (only a FlatPunch is 'plane'), got "
            f"{shape.symmetry!r} of {shape!r}"
        )
    if shape.symmetry not in body.symmetries:
        raise InputError(
            f"a flat punch needs a layer, got {body}; try body=Layer(thickness=1e-4)"
            if plain
            else f"the body {body} is for plane strain, not for a {shape.word}; omit it, or use a "
            "FlatPunch"
        )
