"""Traction laws: stress between the surfaces as a function of the gap, and its energy.

Traction is positive in TENSION (attraction). It is a function of the gap; for growing laws also
of the opening speed. Pressure in a result is its negative. The energy
vanishes at infinite gap and is negative in contact.
docs/traction-laws.md shows how to add a law.
"""

from viscotack.traction.dugdale import Dugdale
from viscotack.traction.exponential import Exponential
from viscotack.traction.growing import Eyring, GentSchultz, grows
from viscotack.traction.law import Traction, effective_range, softening
from viscotack.traction.lennard_jones import LennardJones
from viscotack.traction.tabulated import Tabulated

# Word in a file or option -> law. Every constant except work, gap and the reference speed of a
# growing law is dimensionless.
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
