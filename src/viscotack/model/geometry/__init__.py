"""Rigid indenter shapes, and the bodies under them."""

from .bodies import Base, Body, Bonded, Frictionless, HalfSpace, Layer
from .shapes import (
    Cone,
    Disc,
    FlatPunch,
    MeasuredProfile,
    PowerLawProfile,
    Shape,
    Sphere,
    WavySphere,
    detail,
    effective_sphere,
    end,
    equivalent_radius,
    numbers,
)

# Word in a file -> class.
SHAPES = {
    shape.word: shape
    for shape in (Sphere, Cone, PowerLawProfile, WavySphere, MeasuredProfile, Disc, FlatPunch)
}
BODIES = {body.word: body for body in (HalfSpace, Layer)}

__all__ = [
    "BODIES",
    "SHAPES",
    "Base",
    "Body",
    "Bonded",
    "Cone",
    "Disc",
    "FlatPunch",
    "Frictionless",
    "HalfSpace",
    "Layer",
    "MeasuredProfile",
    "PowerLawProfile",
    "Shape",
    "Sphere",
    "WavySphere",
    "detail",
    "effective_sphere",
    "end",
    "equivalent_radius",
    "numbers",
]
