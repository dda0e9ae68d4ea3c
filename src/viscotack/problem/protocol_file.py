"""The table [protocol] of a case file: what the machine does, in words with units."""

from typing import Any

from viscotack.protocol import Apart, AtDepth, AtForce, AtRadius, Move, Retraction, Start
from viscotack.protocol.words import (
    PUNCH_UNITS,
    SPHERE_UNITS,
    history_from_file,
    move_from_words,
    start_from_words,
)

from .traction_file import Table

# The forces of a punch are mean stresses.
_UNITS = {"sphere": SPHERE_UNITS, "punch": PUNCH_UNITS}
_PRELOADS: dict[str, dict[str, tuple[Any, str]]] = {
    "sphere": {
        "preload_depth": (AtDepth, "m"),
        "preload_force": (AtForce, "N"),
        "preload_radius": (AtRadius, "m"),
    },
    "punch": {"preload_depth": (AtDepth, "m"), "preload_stress": (AtForce, "Pa")},
}
_STIFFNESS = {"sphere": "N/m", "punch": "Pa/m"}


def protocol_from_table(table: Table, indenter: str, equilibrium_gap: float) -> Retraction:
    """Return the test that the table [protocol] states for a "sphere" or a "punch".

    The equilibrium gap [m] tells where the displacement of a history is zero.
    """
    if "history" in table.values:
        start, moves = _history(table, indenter, equilibrium_gap)
    else:
        start, moves = _start(table, indenter), _moves(table, indenter)
    moves *= _cycles(table)
    speed = stiffness = None
    if "speed" in table.values or not moves:
        speed = table.quantity("speed", "m/s")
    if "stiffness" in table.values:
        stiffness = table.quantity("stiffness", _STIFFNESS[indenter])
    return table.make(Retraction, start=start, speed=speed, moves=moves, stiffness=stiffness)


def _history(
    table: Table, indenter: str, equilibrium_gap: float
) -> tuple[Start | Apart, tuple[Move, ...]]:
    for key in (*_PRELOADS[indenter], "start", "moves"):
        if key in table.values:
            raise ValueError(
                f"{table.name} history states the start and the moves; leave out {key}"
            )
    return history_from_file(table.path.parent / str(table.get("history")), equilibrium_gap)


def _start(table: Table, indenter: str) -> Start | Apart:
    preloads = _PRELOADS[indenter]
    known = [*preloads, "start"]
    given = [key for key in known if key in table.values]
    if len(given) != 1:
        raise ValueError(
            f"{table.name} needs exactly one of {', '.join(known)}, "
            f"got {' and '.join(given) or 'none'}; "
            'write for example preload_depth = "2 um", or start = "apart 20 um"'
        )
    if given == ["start"]:
        return table.make(start_from_words, str(table.get("start")), _UNITS[indenter])
    kind, unit = preloads[given[0]]
    return table.make(kind, table.quantity(given[0], unit))


def _moves(table: Table, indenter: str) -> tuple[Move, ...]:
    if "moves" not in table.values:
        return ()
    moves = table.get("moves")
    if not isinstance(moves, list):
        raise ValueError(
            f"{table.name} moves must be a list, got {moves!r}; write for example "
            'moves = ["approach 10 um/s to 1.5 mN", "dwell 60 s"]'
        )
    return tuple(table.make(move_from_words, move, _UNITS[indenter]) for move in moves)


def _cycles(table: Table) -> int:
    """Return how often the moves are made."""
    if "cycles" not in table.values:
        return 1
    cycles = table.get("cycles")
    if not isinstance(cycles, int) or isinstance(cycles, bool) or cycles < 1:
        raise ValueError(f"{table.name} cycles must be a whole number from 1, got {cycles!r}")
    return cycles
