"""Steady crack with a full traction law, for any linear solid, opening and closing."""

from ._branch import energy_of_odds
from .cracks import MESH_ERROR, Comparison, NeighbourCrack, Profile, SteadyCrack, compared

__all__ = [
    "MESH_ERROR",
    "Comparison",
    "NeighbourCrack",
    "Profile",
    "SteadyCrack",
    "compared",
    "energy_of_odds",
]
