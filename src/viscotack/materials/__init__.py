"""Linear viscoelastic solids, and their memory as exponential modes."""

from viscotack.materials.material import Material
from viscotack.materials.modes import Modes
from viscotack.materials.power_law import RelaxationPowerLaw, RetardationPowerLaw
from viscotack.materials.solids import Elastic, Prony, StandardSolid

__all__ = [
    "Elastic",
    "Material",
    "Modes",
    "Prony",
    "RelaxationPowerLaw",
    "RetardationPowerLaw",
    "StandardSolid",
]
