r"""A flat punch on a layer, in SI or in dimensionless groups.

With :math:`a_0 = \pi E_0^* \Delta\gamma_0/(2 \sigma_0^2)` (Eq. 3.3) and the strength
:math:`\sigma_0` of the interface, the groups are

.. math:: \frac{a}{a_0}, \quad \frac{b}{a_0}, \quad \Sigma_0 = \frac{\sigma_0}{E_0^*}, \quad k,
          \quad \frac{\delta_l}{h_0}, \quad \hat r = \frac{r\,\tau_0}{h_0}.

The cohesion :math:`\Sigma_0` only says how many h_0 there are in a_0: it changes crack speeds, and
no stress. Source: Maghami, PhD thesis (2025), chapter 3.
"""

from dataclasses import dataclass, replace

import numpy as np

from viscotack.geometry import Base, Bonded, FlatPunch, Frictionless, Layer
from viscotack.materials import Material, checks
from viscotack.protocol import Apart, AtRadius, Move, Retraction, Start, Units
from viscotack.traction import LennardJones, Traction
from viscotack.units import finite, positive

from . import check_parts, check_reduced, material_in_si, reduced_parts


@dataclass(frozen=True)
class PunchScales:
    """What one unit of each dimensionless output of a punch is in SI.

    Attributes
    ----------
    stress : float
        Strength of the interface sigma_0 [Pa].
    length : float
        h_0 [m], for depths and gaps.
    width : float
        a_0 [m], for lengths along the surface.
    half_width : float
        a [m], for the ligament.
    work : float
        Delta-gamma_0 [J/m^2], for works and energies of unit area.
    time : float
        The material's time unit [s].
    crack_speed : float
        h_0 over the time unit [m/s].
    """

    stress: float
    length: float
    width: float
    half_width: float
    work: float
    time: float
    crack_speed: float


@dataclass(frozen=True)
class PunchProblem:
    """A flat punch on a layer, in SI; all forces are per area of the punch, mean stresses.

    Parameters
    ----------
    material : like that of a Problem
        The soft layer.
    traction : LennardJones
        The forces across the gap.
    punch : FlatPunch
        The rigid indenter.
    layer : Layer
        Thickness of the layer, and how it rests on what is below.
    protocol : Retraction
        The test. AtForce and LoadTo are mean stresses [Pa] here, positive in compression, and a
        stiffness is per area [Pa/m].

    Raises
    ------
    ValueError
        If a part is of the wrong kind, or a bonded layer has another Poisson ratio than its
        material.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> from viscotack.protocol import AtDepth
    >>> problem = PunchProblem(
    ...     material=StandardSolid(
    ...         rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5
    ...     ),
    ...     traction=LennardJones(work_of_adhesion=0.15, equilibrium_gap=1.5e-6),
    ...     punch=FlatPunch(half_width=1e-3),
    ...     layer=Layer(thickness=50e-6),
    ...     protocol=Retraction(start=AtDepth(1.5e-6), speed=100e-6),
    ... )
    >>> f"{problem.groups().size:.1f}"
    '22.4'
    """

    material: Material
    traction: Traction
    punch: FlatPunch
    layer: Layer
    protocol: Retraction

    def __post_init__(self) -> None:
        check_parts(
            self,
            punch=((FlatPunch,), "FlatPunch(half_width=1e-3)"),
            layer=((Layer,), "Layer(thickness=1e-4)"),
            protocol=((Retraction,), "Retraction(start=AtDepth(1e-6), speed=1e-4)"),
        )
        base, nu = self.layer.base, self.material.poisson_ratio
        if isinstance(base, Bonded) and base.poisson_ratio != nu:
            raise ValueError(
                f"a bonded layer has the Poisson ratio of its material, {nu:g}, got "
                f"{base.poisson_ratio:g}"
            )

    @property
    def fracture_length(self) -> float:
        """Length a_0 [m], Eq. 3.3."""
        law = self.traction
        return np.pi * self.material.contact_modulus * law.work_of_adhesion / (2 * law.strength**2)

    def scales(self) -> PunchScales:
        """Return what one unit of each dimensionless output is in SI."""
        law, time = self.traction, self.material.time_unit
        return PunchScales(
            stress=law.strength,
            length=law.equilibrium_gap,
            width=self.fracture_length,
            half_width=self.punch.half_width,
            work=law.work_of_adhesion,
            time=time,
            crack_speed=law.equilibrium_gap / time,
        )

    def groups(self) -> "PunchGroups":
        """Return the dimensionless problem; its time unit is that of the material."""
        unit = self.scales()
        units = Units(1 / unit.length, 1 / unit.stress, 1 / unit.width, 1 / unit.time)
        return PunchGroups(
            size=self.punch.half_width / unit.width,
            thickness=self.layer.thickness / unit.width,
            cohesion=unit.stress / self.material.contact_modulus,
            base=self.layer.base,
            **reduced_parts(self, units),
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

    size: float
    thickness: float
    cohesion: float
    material: Material
    start: Start | Apart
    rate: float | None
    base: Base = Frictionless()
    traction: Traction = LennardJones(1.0, 1.0)
    moves: tuple[Move, ...] = ()
    stiffness: float | None = None

    def __post_init__(self) -> None:
        for name, unit in (("size", "a0"), ("thickness", "a0"), ("cohesion", "1")):
            object.__setattr__(self, name, positive(name, getattr(self, name), unit))
        check_reduced(self)
        if not isinstance(self.base, Base):
            raise ValueError(
                f"base must be Frictionless() or Bonded(poisson_ratio=...), got {self.base!r}"
            )
        if isinstance(self.start, AtRadius):
            raise ValueError(
                "a punch does not start at a contact radius: its contact is as wide as the punch; "
                "give a depth or a force"
            )

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

    def groups(self) -> "PunchGroups":
        """Return itself, so that a problem in SI and one in groups can be treated alike."""
        return self

    def in_si(
        self,
        *,
        contact_modulus: float,
        work_of_adhesion: float,
        time_unit: float,
        poisson_ratio: float,
    ) -> PunchProblem:
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
        nu = checks.poisson_ratio(finite("poisson_ratio", poisson_ratio, "1"))
        strength = self.cohesion * E
        h0 = self.traction.strength * w / strength
        a0 = np.pi * E * w / (2 * strength**2)
        units = Units(h0, strength, a0, T)
        return PunchProblem(
            material=material_in_si(self.material, E * (1 - nu**2), T, nu),
            traction=replace(self.traction, work_of_adhesion=w, equilibrium_gap=h0),  # type: ignore[type-var]
            punch=FlatPunch(half_width=self.size * a0),
            layer=Layer(thickness=self.thickness * a0, base=self.base),
            protocol=units.retraction(self.start, self.rate, self.moves, self.stiffness),
        )
