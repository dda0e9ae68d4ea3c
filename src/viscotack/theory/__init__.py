"""Closed forms and implicit laws of adhesive contact and of the viscoelastic crack.

Everywhere below: SI units; force positive in compression, depth positive into the solid,
pressure positive in compression; the sphere is rigid, of radius R, and the half-space has the
contact modulus E* = E / (1 - nu^2). The flat punch of ``punch`` and its companions sits on a
layer, in plane strain, and counts stress positive in tension. The varying quantity comes first
and may be an array; the parameters are keywords, and arrays of them broadcast. A scalar gives a
float. A value outside the domain of a formula, in any element, raises ``ValueError``.
"""

from .crack import (
    crack_regimes,
    greenwood,
    modulus_file,
    persson_brener,
    tabulated,
    tabulated_modulus,
)
from .elastic import adhesion_map, bradley, dmt, hertz, jkr, lennard_jones, maugis, profiles
from .punch import (
    punch,
    punch_crossover,
    punch_curve,
    punch_design,
    punch_laws,
    punch_map,
    punch_rate,
    punch_unloading,
)
from .sphere import bounds, detachment, empirical, rate, transition, unloading

__all__ = [
    "adhesion_map",
    "bounds",
    "bradley",
    "crack_regimes",
    "detachment",
    "dmt",
    "empirical",
    "greenwood",
    "hertz",
    "jkr",
    "lennard_jones",
    "maugis",
    "modulus_file",
    "persson_brener",
    "profiles",
    "punch",
    "punch_crossover",
    "punch_curve",
    "punch_design",
    "punch_laws",
    "punch_map",
    "punch_rate",
    "punch_unloading",
    "rate",
    "tabulated",
    "tabulated_modulus",
    "transition",
    "unloading",
]
