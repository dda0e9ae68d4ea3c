"""Theories of the steady crack in a viscoelastic solid."""

from . import (
    crack_regimes,
    empirical,
    greenwood,
    law,
    modulus_file,
    persson_brener,
    steady,
    tabulated_modulus,
)
from .law import CrackLaw
from .steady import SteadyCrack

__all__ = [
    "CrackLaw",
    "SteadyCrack",
    "crack_regimes",
    "empirical",
    "greenwood",
    "law",
    "modulus_file",
    "persson_brener",
    "steady",
    "tabulated_modulus",
]
