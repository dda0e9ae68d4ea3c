"""Surfaces as maps of heights: from files, generated, and their statistics."""

from .heights import HeightMap, Roughness, bumps, pillars, roughness, self_affine, sphere
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
