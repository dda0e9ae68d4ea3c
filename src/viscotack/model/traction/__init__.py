"""Traction laws: stress between the surfaces as a function of the gap, and its energy.

Traction is positive in TENSION (attraction). It is a function of the gap; for growing laws also
of the opening speed, for ageing laws of the time in contact. Pressure in a result is its negative.
The energy vanishes at infinite gap and is negative in contact.
docs/own.md shows how to add a law.
"""

from viscotack.model.traction.formulas import Dugdale, Exponential, LennardJones
from viscotack.model.traction.growing import (
    Eyring,
    GentSchultz,
    LogarithmicAgeing,
    SaturatingAgeing,
    ages,
    at_rest,
    grows,
    has_rest,
)
from viscotack.model.traction.law import Traction, effective_range, softening
from viscotack.model.traction.tabulated import Tabulated

# Word in a file or option -> law. Every constant except work, gap and the reference speed or time
# of a law that grows or ages is dimensionless.
LAWS = {
    law.word: law
    for law in (
        LennardJones,
        Dugdale,
        Exponential,
        Tabulated,
        GentSchultz,
        Eyring,
        LogarithmicAgeing,
        SaturatingAgeing,
    )
}

__all__ = [
    "LAWS",
    "Dugdale",
    "Exponential",
    "Eyring",
    "GentSchultz",
    "LennardJones",
    "LogarithmicAgeing",
    "SaturatingAgeing",
    "Tabulated",
    "Traction",
    "ages",
    "at_rest",
    "effective_range",
    "grows",
    "has_rest",
    "softening",
]
