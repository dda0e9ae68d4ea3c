"""What presses and what is pressed: rigid shapes, and the bodies under them."""

from .layer import Base, Bonded, Frictionless, Layer
from .shapes import Cone, FlatPunch, PowerLawProfile, Sphere, profile_exponent

__all__ = [
    "Base",
    "Bonded",
    "Cone",
    "FlatPunch",
    "Frictionless",
    "Layer",
    "PowerLawProfile",
    "Sphere",
    "profile_exponent",
]
