"""Closed forms and implicit laws of adhesive contact and of the viscoelastic crack.

Conventions: SI units; force positive in compression, depth positive into the solid,
pressure positive in compression; the sphere is rigid, of radius R, and the half-space has the
contact modulus E* = E / (1 - nu^2). The flat punch of ``punch`` is on a layer, in plane strain,
with stress positive in tension. The varying quantity is the first argument and may be an array,
followed by an object if there is one (``CrackLaw``, ``punch.Pad``); the parameters are
keywords, and arrays of them broadcast. A scalar gives a float. A value outside the domain of a
formula, in any element, raises ``InputError``, which is a ``ValueError``.

Four rooms, each of which imports only itself and earlier ones: ``elastic``, ``crack``, ``sphere``,
``punch``. The modules of the first three are also available directly, as ``theory.jkr``.
"""

from . import crack, elastic, punch, sphere
from .crack import (
    CrackLaw,
    SteadyCrack,
    crack_regimes,
    empirical,
    greenwood,
    persson_brener,
    steady,
    tabulated_modulus,
)
from .elastic import (
    adhesion_map,
    bradley,
    disc,
    dmt,
    film,
    hertz,
    indenter,
    jkr,
    lennard_jones,
    maugis,
    profiles,
    transition,
    wavy,
)
from .sphere import bounds, detachment, edge_law, rate, unloading

__all__ = [
    "CrackLaw",
    "SteadyCrack",
    "adhesion_map",
    "bounds",
    "bradley",
    "crack",
    "crack_regimes",
    "detachment",
    "disc",
    "dmt",
    "edge_law",
    "elastic",
    "empirical",
    "film",
    "greenwood",
    "hertz",
    "indenter",
    "jkr",
    "lennard_jones",
    "maugis",
    "persson_brener",
    "profiles",
    "punch",
    "rate",
    "sphere",
    "steady",
    "tabulated_modulus",
    "transition",
    "unloading",
    "wavy",
]
