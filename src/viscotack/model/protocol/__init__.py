"""Loading protocols: the state at rest at the start, moves of the machine, and the retraction."""

from .moves import (
    Apart,
    Approach,
    AtDepth,
    AtForce,
    AtRadius,
    Dwell,
    LoadTo,
    Move,
    MoveTo,
    Retract,
    Retraction,
    Start,
    Units,
    end_of,
    states,
)

__all__ = [
    "Apart",
    "Approach",
    "AtDepth",
    "AtForce",
    "AtRadius",
    "Dwell",
    "LoadTo",
    "Move",
    "MoveTo",
    "Retract",
    "Retraction",
    "Start",
    "Units",
    "end_of",
    "states",
]
