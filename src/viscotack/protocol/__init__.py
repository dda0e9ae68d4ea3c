"""What the machine does: the state at rest in which a test begins, its moves, its retraction."""

from .moves import (
    HOLDS,
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
    check_moves,
    states,
)

__all__ = [
    "Apart",
    "Approach",
    "AtDepth",
    "AtForce",
    "AtRadius",
    "Dwell",
    "HOLDS",
    "LoadTo",
    "Move",
    "MoveTo",
    "Retract",
    "Retraction",
    "Start",
    "Units",
    "check_moves",
    "states",
]
