r"""A flat punch on a layer in plane strain: scales, groups and limits.

With :math:`a_0 = \pi E_0^* \Delta\gamma_0/(2 \sigma_0^2)` (Eq. 3.3) and the strength
:math:`\sigma_0` of the interface, the groups are

.. math:: \frac{a}{a_0}, \quad \frac{b}{a_0}, \quad \Sigma_0 = \frac{\sigma_0}{E_0^*}, \quad k,
          \quad \frac{\delta_l}{h_0}, \quad \hat r = \frac{r\,\tau_0}{h_0}.

The cohesion :math:`\Sigma_0` determines only the ratio of h_0 to a_0: it affects crack speeds, but
no stress. Source: Maghami, PhD thesis (2025), chapter 3.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from viscotack.cards import Quantity
from viscotack.errors import InputError
from viscotack.model.problem.outputs import PLANE, InSI, Kind, time_unit
from viscotack.model.protocol import AtRadius, Units
from viscotack.model.protocol_words import PUNCH_UNITS

# Units of a protocol, in SI and dimensionless; forces are mean stresses.
SI = PUNCH_UNITS | {"stiffness": "Pa/m"}
GROUPS = {
    "depth": "h0",
    "force": "sigma0",
    "radius": "a0",
    "speed": "h0/tau0",
    "time": "tau0",
    "stiffness": "sigma0/h0",
}
# Cards of the dimensionless shape and body.
SIZES = {
    "size": Quantity("a0", "a/a0", "half width of the punch", above=0),
    "thickness": Quantity("a0", "b/a0", "thickness of the layer", above=0),
}


@dataclass(frozen=True)
class PunchScales:
    """SI values of the units of a punch's outputs, from :meth:`viscotack.Problem.scales`.

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
        Delta-gamma_0 [J/m^2], for works and energies per unit area.
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


def outputs(shape: Any) -> Kind:
    """Return the kind of a problem, which names its outputs."""
    return PLANE


def fracture_length(problem: Any) -> float:
    """Return the length a_0 [m], Eq. 3.3."""
    law = problem.traction
    return np.pi * problem.material.contact_modulus * law.work_of_adhesion / (2 * law.strength**2)


def scales_of(problem: Any) -> PunchScales:
    """Return the SI values of the units of the dimensionless outputs."""
    law, time = problem.traction, time_unit(problem.material, problem.traction)
    return PunchScales(
        stress=law.strength,
        length=law.equilibrium_gap,
        width=fracture_length(problem),
        half_width=problem.geometry.half_width,
        work=law.work_of_adhesion,
        time=time,
        crack_speed=law.equilibrium_gap / time,
    )


def to_groups(scales: PunchScales) -> Units:
    """Return the factors that convert a protocol from SI to groups."""
    return Units(1 / scales.length, 1 / scales.stress, 1 / scales.width, 1 / scales.time)


def check(problem: Any) -> None:
    """Raise an error for a start at a contact radius."""
    check_groups(problem.protocol)


def check_groups(test: Any) -> None:
    """Raise an error for groups, or the protocol of a problem, with a start at a contact radius."""
    if isinstance(test.start, AtRadius):
        raise InputError(
            "a punch cannot start at a contact radius, because its contact is as wide as the "
            f"punch; give a depth or a mean stress, got {test.start}"
        )


def lengths(problem: Any) -> tuple[float, float]:
    """Return the units of distances along the surface and of heights [m]: a_0 and h_0."""
    return fracture_length(problem), problem.traction.equilibrium_gap


def si_units(
    groups: Any,
    contact_modulus: float,
    radius: float | None,
    *,
    equilibrium_gap: float = 0.0,
    work_of_adhesion: float = 0.0,
) -> InSI:
    """Return the SI units of dimensionless groups, given either gap or work of adhesion."""
    if radius is not None:
        raise InputError(f"a punch has no radius, got {radius:g} m; omit it")
    strength, E = groups.cohesion * contact_modulus, contact_modulus
    w = work_of_adhesion or equilibrium_gap * strength / groups.traction.strength
    h0 = equilibrium_gap or groups.traction.strength * w / strength
    a0 = np.pi * E * w / (2 * strength**2)
    return InSI(h0, w, strength, contact_radius=a0, along=a0, height=h0)
