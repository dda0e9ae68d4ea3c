r"""A flat punch on a layer, in plane strain: its scales, its limits.

With :math:`a_0 = \pi E_0^* \Delta\gamma_0/(2 \sigma_0^2)` (Eq. 3.3) and the strength
:math:`\sigma_0` of the interface, the groups are

.. math:: \frac{a}{a_0}, \quad \frac{b}{a_0}, \quad \Sigma_0 = \frac{\sigma_0}{E_0^*}, \quad k,
          \quad \frac{\delta_l}{h_0}, \quad \hat r = \frac{r\,\tau_0}{h_0}.

The cohesion :math:`\Sigma_0` only says how many h_0 there are in a_0: it changes crack speeds, and
no stress. Source: Maghami, PhD thesis (2025), chapter 3.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.geometry import Bonded, Layer
from viscotack.problem.units import time_unit
from viscotack.protocol import Apart, AtRadius, Start, Units
from viscotack.protocol.words import PUNCH_UNITS

# What a protocol's numbers are in, in SI and dimensionless: forces are mean stresses.
SI = PUNCH_UNITS | {"stiffness": "Pa/m"}
GROUPS = {
    "depth": "h0",
    "force": "sigma0",
    "radius": "a0",
    "speed": "h0/tau0",
    "time": "tau0",
    "stiffness": "sigma0/h0",
}


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


def fracture_length(problem: Any) -> float:
    """Return the length a_0 [m], Eq. 3.3."""
    law = problem.traction
    return np.pi * problem.material.contact_modulus * law.work_of_adhesion / (2 * law.strength**2)


def scales_of(problem: Any) -> PunchScales:
    """Return what one unit of each dimensionless output is in SI."""
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
    """Return what takes the numbers of a protocol from SI to those of the groups."""
    return Units(1 / scales.length, 1 / scales.stress, 1 / scales.width, 1 / scales.time)


def check_start(start: Start | Apart) -> None:
    """Refuse a start at a contact radius."""
    if isinstance(start, AtRadius):
        raise InputError(
            "a punch does not start at a contact radius: its contact is as wide as the punch; "
            f"give a depth or a mean stress, got {start}"
        )


def check(problem: Any) -> None:
    """Refuse a punch without a layer, and a bonded one of another Poisson ratio than its material.

    Raises
    ------
    ValueError
        In these cases, and if it starts at a contact radius.
    """
    if not isinstance(problem.body, Layer):
        raise InputError(
            f"a flat punch presses a layer, got {problem.body}; try body=Layer(thickness=1e-4)"
        )
    check_start(problem.protocol.start)
    base, nu = problem.body.base, problem.material.poisson_ratio
    if isinstance(base, Bonded) and base.poisson_ratio != nu:
        raise InputError(
            f"a bonded layer has the Poisson ratio of its material, {nu:g}, got "
            f"{base.poisson_ratio:g}"
        )
