"""Detachment of a flat punch from a layer; one module per topic, and the main functions."""

from viscotack.model.geometry import Bonded, Frictionless

from . import crossover, curve, laws, map, pad, rate, rectangle, regimes, unloading
from .laws import (
    fracture_length,
    half_plane_pull_off_stress,
    stiffening,
    thin_layer_depth_at_pull_off,
    thin_layer_pull_off_stress,
)
from .map import RegimeMap, regime_map
from .pad import Pad
from .regimes import (
    REGIMES,
    Limits,
    Thicknesses,
    limits,
    pull_off_stress,
    regime,
    regime_thicknesses,
)
from .unloading import PullOff, pull_off, thickness_at_speed

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
    "laws",
    "limits",
    "map",
    "pad",
    "pull_off",
    "pull_off_stress",
    "rate",
    "rectangle",
    "regime",
    "regime_map",
    "regime_thicknesses",
    "regimes",
    "stiffening",
    "thickness_at_speed",
    "thin_layer_depth_at_pull_off",
    "thin_layer_pull_off_stress",
    "unloading",
]
