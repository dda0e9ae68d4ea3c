"""A sphere comes off a viscoelastic solid."""

from . import bounds, detachment, empirical, rate, transition, unloading

__all__ = ["bounds", "detachment", "empirical", "rate", "transition", "unloading"]
