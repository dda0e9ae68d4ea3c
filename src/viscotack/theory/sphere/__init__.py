"""Theories of the detachment of a sphere from a viscoelastic solid."""

from . import bounds, detachment, rate, unloading

__all__ = ["bounds", "detachment", "rate", "unloading"]
