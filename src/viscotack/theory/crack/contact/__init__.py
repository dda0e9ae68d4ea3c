"""Contacts whose edge is a steady crack: recession from rest, and any loading history.

Lengths along the surface are in beta, heights in beta^2/R, forces in R dg, times in the material's
unit; :func:`viscotack.crack_contact` accepts a problem in any units.
"""

from ._profile import (
    Profile,
    SpheresOnLayers,
    profile_of,
    profile_on,
    radius_at_depth,
    radius_at_force,
)
from .growing import GrowingCracks, NeighbourEdges
from .history import Contact, Curve, Drive, Edge
from .recession import Curves, recede
from .series import Elastic, Pulled, Receding, Scales, pull_apart

__all__ = [
    "Contact",
    "Curve",
    "Curves",
    "Drive",
    "Edge",
    "Elastic",
    "GrowingCracks",
    "NeighbourEdges",
    "Profile",
    "Pulled",
    "Receding",
    "Scales",
    "SpheresOnLayers",
    "profile_of",
    "profile_on",
    "pull_apart",
    "radius_at_depth",
    "radius_at_force",
    "recede",
]
