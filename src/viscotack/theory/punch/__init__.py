"""Detachment of a flat punch from a layer; one module per topic, and the main functions."""

from viscotack.model.geometry import Bonded, Frictionless

from . import crossover, curve, rectangle, unloading
from .pad import (
    REGIMES,
    Limits,
    Pad,
    Thicknesses,
    fracture_length,
    half_plane_pull_off_stress,
    limits,
    pull_off_stress,
    regime,
    regime_thicknesses,
    stiffening,
    thin_layer_depth_at_pull_off,
    thin_layer_pull_off_stress,
)
from .unloading import PullOff, RegimeMap, pull_off, regime_map, thickness_at_speed

__all__ = [
    "REGIMES",
    "Bonded",
    "Frictionless",
    "Limits",
    "Pad",
    "PullOff",
    "RegimeMap",
    "Thicknesses",
    "crossover",
    "curve",
    "fracture_length",
    "half_plane_pull_off_stress",
    "limits",
    "pull_off",
    "pull_off_stress",
    "rectangle",
    "regime",
    "regime_map",
    "regime_thicknesses",
    "stiffening",
    "thickness_at_speed",
    "thin_layer_depth_at_pull_off",
    "thin_layer_pull_off_stress",
    "unloading",
]
