"""Steady crack with a full traction law, for any linear solid, opening and closing."""

from viscotack.theory.crack.steady.cracks import Comparison, compared

from ._branch import energy_of_odds
from .cracks import MESH_ERROR, Profile, SteadyCrack
from .neighbour import NeighbourCrack

__all__ = [
    "MESH_ERROR",
    "Comparison",
    "NeighbourCrack",
    "Profile",
    "SteadyCrack",
    "compared",
    "energy_of_odds",
]
