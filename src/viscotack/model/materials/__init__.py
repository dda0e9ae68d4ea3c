"""Linear viscoelastic solids, their exponential modes, temperature shifts and passports."""

from viscotack.model.materials.branched_solids import Elastic, Prony, StandardSolid
from viscotack.model.materials.conversion import effective_solid
from viscotack.model.materials.fractional import FractionalZener
from viscotack.model.materials.library import published
from viscotack.model.materials.material import Material
from viscotack.model.materials.modes import Modes
from viscotack.model.materials.passport import Passport
from viscotack.model.materials.passport_file import read_passport, write_passport
from viscotack.model.materials.power_law import RelaxationPowerLaw, RetardationPowerLaw
from viscotack.model.materials.shift import WLF, Arrhenius, TabulatedShift

# Word in a file -> class.
MODELS = {
    kind.word: kind
    for kind in (
        Elastic,
        StandardSolid,
        Prony,
        RetardationPowerLaw,
        RelaxationPowerLaw,
        FractionalZener,
    )
}

__all__ = [
    "MODELS",
    "WLF",
    "Arrhenius",
    "Elastic",
    "FractionalZener",
    "Material",
    "Modes",
    "Passport",
    "Prony",
    "RelaxationPowerLaw",
    "RetardationPowerLaw",
    "StandardSolid",
    "TabulatedShift",
    "effective_solid",
    "published",
    "read_passport",
    "write_passport",
]
