"""The crack that runs through a viscoelastic solid."""

from . import crack_regimes, greenwood, modulus_file, persson_brener, tabulated, tabulated_modulus

__all__ = [
    "crack_regimes",
    "greenwood",
    "modulus_file",
    "persson_brener",
    "tabulated",
    "tabulated_modulus",
]
