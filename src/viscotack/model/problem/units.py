"""The units of a problem."""

from dataclasses import dataclass
from typing import Any

from viscotack.model.materials import Elastic
from viscotack.model.traction import has_rest


@dataclass(frozen=True)
class InSI:
    """SI values of the units of dimensionless groups.

    Attributes
    ----------
    length : float
        Unit of gaps and depths, h_0 [m].
    work : float
        Unit of work per area, Delta-gamma_0 [J/m^2].
    force : float
        Unit of the forces [N] of a protocol; for a punch, unit of its stresses [Pa].
    contact_radius : float
        Unit of the contact radii of a protocol [m].
    along, height : float
        Units of distances along the surface, and of heights of a shape [m].
    """

    length: float
    work: float
    force: float
    contact_radius: float
    along: float
    height: float


def time_unit(material: Any, traction: Any) -> float:
    """Return the unit of dimensionless times [s]: the material's.

    An elastic solid has none; where the traction law grows or ages, its own time is the only one
    there is: that in which a gap opens by h_0 at its reference speed, or its reference time.
    """
    if isinstance(material, Elastic) and has_rest(traction):
        return traction.own_time
    return material.time_unit
