"""Contacts of elastic solids."""

from . import (
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
    relaxed,
    transition,
    wavy,
)

__all__ = [
    "adhesion_map",
    "bradley",
    "disc",
    "dmt",
    "film",
    "hertz",
    "indenter",
    "jkr",
    "lennard_jones",
    "maugis",
    "profiles",
    "relaxed",
    "transition",
    "wavy",
]
