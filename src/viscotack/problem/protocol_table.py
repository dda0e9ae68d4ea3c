"""Protocol from the table [protocol] of a case file, as text with units."""

from collections.abc import Mapping
from typing import Any

from viscotack.cards import cards
from viscotack.errors import InputError
from viscotack.problem.case_table import Table
from viscotack.protocol import (
    Apart,
    AtDepth,
    AtForce,
    AtRadius,
    Move,
    Retraction,
    Start,
    check_number_of_moves,
)
from viscotack.protocol.words import history_from_file, move_from_words, start_from_words

_TEST = cards(Retraction)
# Starts with their own keys; for a punch the force is a mean stress, with its own key.
_STARTS = {"preload_depth": AtDepth, "preload_force": AtForce, "preload_radius": AtRadius}
_STRESS_STARTS = {"preload_depth": AtDepth, "preload_stress": AtForce}


def protocol_from_table(
    table: Table, units: Mapping[str, str], equilibrium_gap: float
) -> Retraction:
    """Return the test stated by the table [protocol], in the units of a geometry.

    The equilibrium gap [m] defines the zero of the displacement of a history.
    """
    if "history" in table.values:
        start, moves = _history(table, units, equilibrium_gap)
    else:
        start, moves = _start(table, units), _moves(table, units)
    cycles = _cycles(table)
    table.make(check_number_of_moves, cycles * len(moves))
    moves *= cycles
    speed = stiffness = None
    if "speed" in table.values or not moves:
        speed = table.number(_TEST["speed"])
    if "stiffness" in table.values:
        stiffness = table.number(_TEST["stiffness"], unit=units["stiffness"])
    return table.make(Retraction, start=start, speed=speed, moves=moves, stiffness=stiffness)


def _history(
    table: Table, units: Mapping[str, str], equilibrium_gap: float
) -> tuple[Start | Apart, tuple[Move, ...]]:
    for key in (*_preloads(units), "start", "moves"):
        if key in table.values:
            raise InputError(f"{table.name} history states the start and the moves; omit {key}")
    return history_from_file(table.beside("history", '"drive.csv"'), equilibrium_gap)


def _start(table: Table, units: Mapping[str, str]) -> Start | Apart:
    preloads = _preloads(units)
    known = [*preloads, "start"]
    given = [key for key in known if key in table.values]
    if len(given) != 1:
        raise InputError(
            f"{table.name} needs exactly one of {', '.join(known)}, got "
            f"{' and '.join(given) or 'none'}; "
            'write for example preload_depth = "2 um", or start = "apart 20 um"'
        )
    if given == ["start"]:
        return table.make(start_from_words, str(table.get("start")), units)
    kind: Any = preloads[given[0]]
    (field,) = cards(kind).values()
    return kind(table.number(field, key=given[0], unit=units[field.card.measure]))


def _preloads(units: Mapping[str, str]) -> Mapping[str, type]:
    return _STARTS if units["force"] == "N" else _STRESS_STARTS


def _moves(table: Table, units: Mapping[str, str]) -> tuple[Move, ...]:
    if "moves" not in table.values:
        return ()
    moves = table.get("moves")
    if not isinstance(moves, list):
        raise InputError(
            f"{table.name} moves must be a list, got {moves!r}; write for example "
            'moves = ["approach 10 um/s to 1.5 mN", "dwell 60 s"]'
        )
    table.make(check_number_of_moves, len(moves))
    return tuple(table.make(move_from_words, move, units) for move in moves)


def _cycles(table: Table) -> int:
    """Return the number of repetitions of the moves."""
    if "cycles" not in table.values:
        return 1
    cycles = table.get("cycles")
    if not isinstance(cycles, int) or isinstance(cycles, bool) or cycles < 1:
        raise InputError(f"{table.name} cycles must be a positive integer, got {cycles!r}")
    return cycles
