"""Contacts of elastic solids."""

from . import (
    adhesion_map,
    bradley,
    dmt,
    hertz,
    indenter,
    jkr,
    lennard_jones,
    maugis,
    profiles,
    relaxed,
    transition,
)

__all__ = [
    "adhesion_map",
    "bradley",
    "dmt",
    "hertz",
    "indenter",
    "jkr",
    "lennard_jones",
    "maugis",
    "profiles",
    "relaxed",
    "transition",
]
