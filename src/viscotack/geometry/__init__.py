"""What presses and what is pressed: rigid shapes, and the bodies under them."""

from .bases import Base, Bonded, Frictionless
from .bodies import Body, HalfSpace, Layer
from .shapes import (
    Cone,
    FlatPunch,
    PowerLawProfile,
    Shape,
    Sphere,
    equivalent_radius,
    numbers,
)

# Word in a file -> class.
SHAPES = {shape.word: shape for shape in (Sphere, Cone, PowerLawProfile, FlatPunch)}
BODIES = {body.word: body for body in (HalfSpace, Layer)}

__all__ = [
    "BODIES",
    "SHAPES",
    "Base",
    "Body",
    "Bonded",
    "Cone",
    "FlatPunch",
    "Frictionless",
    "HalfSpace",
    "Layer",
    "PowerLawProfile",
    "Shape",
    "Sphere",
    "equivalent_radius",
    "numbers",
]
