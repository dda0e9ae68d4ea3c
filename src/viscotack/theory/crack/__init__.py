"""The crack that runs through a viscoelastic solid."""

from . import (
    crack_regimes,
    empirical,
    greenwood,
    law,
    modulus_file,
    persson_brener,
    tabulated,
    tabulated_modulus,
)
from .law import CrackLaw

__all__ = [
    "CrackLaw",
    "crack_regimes",
    "empirical",
    "greenwood",
    "law",
    "modulus_file",
    "persson_brener",
    "tabulated",
    "tabulated_modulus",
]
