"""Closed forms and implicit laws of adhesive contact and of the viscoelastic crack.

Everywhere below: SI units; force positive in compression, depth positive into the solid,
pressure positive in compression; the sphere is rigid, of radius R, and the half-space has the
contact modulus E* = E / (1 - nu^2). The varying quantity comes first and may be an array; the
parameters are keywords, and arrays of them broadcast. A scalar gives a float. A value outside
the domain of a formula, in any element, raises ``ValueError``.
"""

from . import (
    adhesion_map,
    bounds,
    bradley,
    crack_regimes,
    dmt,
    empirical,
    greenwood,
    hertz,
    jkr,
    lennard_jones,
    maugis,
    persson_brener,
    profiles,
    rate,
    tabulated,
    tabulated_modulus,
    transition,
    unloading,
)

__all__ = [
    "adhesion_map",
    "bounds",
    "bradley",
    "crack_regimes",
    "dmt",
    "empirical",
    "greenwood",
    "hertz",
    "jkr",
    "lennard_jones",
    "maugis",
    "persson_brener",
    "profiles",
    "rate",
    "tabulated",
    "tabulated_modulus",
    "transition",
    "unloading",
]
