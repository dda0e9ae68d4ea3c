"""A sphere comes off a viscoelastic solid."""

from . import bounds, detachment, rate, unloading

__all__ = ["bounds", "detachment", "rate", "unloading"]
