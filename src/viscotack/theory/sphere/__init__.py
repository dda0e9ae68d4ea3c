"""Theories of the detachment of a sphere from a viscoelastic solid."""

from . import bounds, detachment, edge_law, rate, unloading

__all__ = ["bounds", "detachment", "edge_law", "rate", "unloading"]
