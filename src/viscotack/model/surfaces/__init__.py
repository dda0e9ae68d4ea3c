"""Surfaces as maps of heights: from files, generated, and their statistics."""

from .asperities import Asperities, drawn_asperities, summits
from .generated import bumps, pillars, self_affine, sphere
from .heights import HeightMap, Roughness, roughness
from .map_file import read_map

__all__ = [
    "Asperities",
    "HeightMap",
    "Roughness",
    "bumps",
    "drawn_asperities",
    "pillars",
    "read_map",
    "roughness",
    "self_affine",
    "sphere",
    "summits",
]
