"""Surfaces as maps of heights: from files, generated, and their statistics."""

from .generated import bumps, pillars, self_affine, sphere
from .heights import HeightMap, Roughness, roughness
from .map_file import read_map

__all__ = [
    "HeightMap",
    "Roughness",
    "bumps",
    "pillars",
    "read_map",
    "roughness",
    "self_affine",
    "sphere",
]
