"""Linear viscoelastic solids, their exponential modes, temperature shifts and passports."""

from viscotack.materials.branched_solids import Elastic, Prony, StandardSolid
from viscotack.materials.fractional import FractionalZener
from viscotack.materials.library import published
from viscotack.materials.material import Material
from viscotack.materials.modes import Modes
from viscotack.materials.passport import Passport
from viscotack.materials.passport_file import read_passport, write_passport
from viscotack.materials.power_law import RelaxationPowerLaw, RetardationPowerLaw
from viscotack.materials.shift import WLF, Arrhenius, TabulatedShift
from viscotack.materials.springpots import FractionalKelvinVoigt, FractionalMaxwell
from viscotack.materials.two_bodies import effective_solid

__all__ = [
    "WLF",
    "Arrhenius",
    "Elastic",
    "FractionalKelvinVoigt",
    "FractionalMaxwell",
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
