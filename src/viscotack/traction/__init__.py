"""Forces across the gap: traction laws, and the surface energy they come from.

Traction is positive in TENSION (the surfaces attract) and is a function of the gap, of growing laws
of the speed at which it opens as well. Pressure in a result is its negative. A law's energy
vanishes at infinite gap, so contact has a negative one.
docs/traction-laws.md shows how a law is added.
"""

from viscotack.traction.dugdale import Dugdale
from viscotack.traction.exponential import Exponential
from viscotack.traction.growing import Eyring, GentSchultz, grows
from viscotack.traction.law import Traction, effective_range, softening
from viscotack.traction.lennard_jones import LennardJones
from viscotack.traction.tabulated import Tabulated

# Word in a file or a flag -> law. Every constant beside work and gap is a pure number, but for
# the reference speed of a law that grows.
LAWS = {
    law.word: law for law in (LennardJones, Dugdale, Exponential, Tabulated, GentSchultz, Eyring)
}

__all__ = [
    "LAWS",
    "Dugdale",
    "Exponential",
    "Eyring",
    "GentSchultz",
    "LennardJones",
    "Tabulated",
    "Traction",
    "effective_range",
    "grows",
    "softening",
]
