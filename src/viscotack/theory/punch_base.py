"""How an elastic layer rests on the rigid body below it; see :mod:`viscotack.layer`."""

from ..layer import Base, Bonded, Frictionless

__all__ = ["Base", "Bonded", "Frictionless"]
