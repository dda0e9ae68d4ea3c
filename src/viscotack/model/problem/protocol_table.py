"""Tests as tables: [protocol] of a problem in SI, [groups] of a dimensionless one."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from viscotack.cards import Exact, Quantity, cards
from viscotack.errors import InputError
from viscotack.model.problem.problem import Cohesion, Groups, Rate, Spring, Tabor
from viscotack.model.protocol import (
    Apart,
    AtDepth,
    AtForce,
    AtRadius,
    Move,
    Retraction,
    Start,
)
from viscotack.model.protocol.moves import Speed, Stiffness, check_number_of_moves
from viscotack.model.protocol.words import (
    PURE_NUMBERS,
    history_from_file,
    move_from_words,
    start_from_words,
    words_of_move,
)
from viscotack.model.tables import Reading, read_as

_Depth = Annotated[float, cards(AtDepth)["depth"].card]
_Force = Annotated[float, cards(AtForce)["force"].card]
_Radius = Annotated[float, cards(AtRadius)["contact_radius"].card]
_Apart = Annotated[float, cards(Apart)["gap"].card]
_Stress = Annotated[
    float,
    Quantity("Pa", "p", "mean stress of the relaxed start of a punch", measure="force"),
]
# Keys of starts in [protocol], by the unit of a force: that of a punch is a mean stress.
STARTS: Mapping[str, Mapping[str, Any]] = {
    "N": {"preload_depth": AtDepth, "preload_force": AtForce, "preload_radius": AtRadius},
    "Pa": {"preload_depth": AtDepth, "preload_stress": AtForce},
}
# Keys of starts in [groups].
STARTS_IN_GROUPS: Mapping[str, Any] = {
    "preload": AtDepth,
    "preload_force": AtForce,
    "preload_radius": AtRadius,
    "apart": Apart,
}


@dataclass(frozen=True)
class ProtocolTable:
    """The table [protocol]: one start, moves and their repetitions, a retraction, the machine."""

    preload_depth: _Depth | None = None
    preload_force: _Force | None = None
    preload_stress: _Stress | None = None
    preload_radius: _Radius | None = None
    start: str | None = None
    history: str | None = None
    moves: tuple[str | dict[str, str | float], ...] = ()
    cycles: Annotated[int, Exact] = 1
    speed: Speed | None = None
    stiffness: Stiffness | None = None

    def __post_init__(self) -> None:
        if self.cycles < 1:
            raise InputError(f"cycles must be a positive integer, got {self.cycles!r}")


@dataclass(frozen=True)
class GroupsTable:
    """The table [groups]: the dimensionless numbers of a problem and its test."""

    tabor: Tabor | None = None
    cohesion: Cohesion | None = None
    preload: _Depth | None = None
    preload_force: _Force | None = None
    preload_radius: _Radius | None = None
    apart: _Apart | None = None
    moves: tuple[str, ...] = ()
    rate: Rate | None = None
    stiffness: Spring | None = None


def protocol_from_table(given: Any, reading: Reading, equilibrium_gap: float) -> Retraction:
    """Return the test stated by the table [protocol].

    The equilibrium gap [m] defines the zero of the displacement of a history.
    """
    table = read_as(ProtocolTable, given, reading, "protocol")
    where = f"{reading.where}, [protocol]"
    history = None
    if table.history is not None:
        for key in (*STARTS["N"], *STARTS["Pa"], "start", "moves"):
            if getattr(table, key):
                raise InputError(
                    f"{where} history states the start and the moves; omit {key}",
                    field=f"protocol.{key}",
                )
        file = reading.file("protocol", "history", table.history)
        history = history_from_file(file, equilibrium_gap)
    try:
        if history is not None:
            start, moves = history
        else:
            start = _start(table, reading.units)
            check_number_of_moves(len(table.moves))
            moves = tuple(move_from_words(move, reading.units) for move in table.moves)
        check_number_of_moves(table.cycles * len(moves))
        if table.speed is None and not moves:
            raise InputError(
                'speed is missing; write for example speed = "100 um/s"', field="protocol.speed"
            )
        return Retraction(
            start=start, speed=table.speed, moves=moves * table.cycles, stiffness=table.stiffness
        )
    except ValueError as error:
        field = getattr(error, "field", "") or "protocol"
        raise InputError(f"{where} {error}", field=field) from None


def _start(table: ProtocolTable, units: Mapping[str, str]) -> Start | Apart:
    starts = STARTS[units["force"]]
    example = '; write for example preload_depth = "2 um", or start = "apart 20 um"'
    key = _only(table, (*STARTS["N"], *STARTS["Pa"], "start"), (*starts, "start"), example)
    if table.start is not None:
        return start_from_words(table.start, units)
    return starts[key](getattr(table, key))


def _only(table: Any, keys: Iterable[str], possible: Iterable[str], example: str = "") -> str:
    """Return the key of the start that a table states; InputError unless it is a single one."""
    given = [key for key in dict.fromkeys(keys) if getattr(table, key) is not None]
    if len(given) != 1 or given[0] not in possible:
        raise InputError(
            f"needs exactly one of {', '.join(possible)}, got "
            f"{' and '.join(given) or 'none'}{example}"
        )
    return given[0]


def table_of_protocol(test: Retraction, units: Mapping[str, str]) -> dict[str, Any]:
    """Return the table [protocol] of a test, with numbers in SI."""
    starts = {kind: key for key, kind in STARTS[units["force"]].items()}
    value = test.start.value
    if isinstance(test.start, Apart):
        found: dict[str, Any] = {"start": f"apart {value!r} {units['depth']}"}
    else:
        found = {starts[type(test.start)]: value}
    return found | _drive(test.moves, units, speed=test.speed, stiffness=test.stiffness)


def test_of_groups(given: Any, reading: Reading) -> dict[str, Any]:
    """Return the numbers and the test of the table [groups], as arguments of Groups."""
    table = read_as(GroupsTable, given, reading, "groups")
    where = f"{reading.where}, [groups]"
    try:
        key = _only(table, STARTS_IN_GROUPS, STARTS_IN_GROUPS)
        moves = tuple(move_from_words(move, PURE_NUMBERS) for move in table.moves)
        start = STARTS_IN_GROUPS[key](getattr(table, key))
    except ValueError as error:
        raise InputError(f"{where} {error}", field="groups") from None
    numbers = ("tabor", "cohesion", "rate", "stiffness")
    return {"start": start, "moves": moves, **{name: getattr(table, name) for name in numbers}}


def table_of_groups(groups: Groups) -> dict[str, Any]:
    """Return the table [groups] of a dimensionless problem."""
    starts = {kind: key for key, kind in STARTS_IN_GROUPS.items()}
    size = {"tabor": groups.tabor} if groups.cohesion is None else {"cohesion": groups.cohesion}
    return {
        **size,
        starts[type(groups.start)]: groups.start.value,
        **_drive(groups.moves, PURE_NUMBERS, rate=groups.rate, stiffness=groups.stiffness),
    }


def _drive(
    moves: tuple[Move, ...], units: Mapping[str, str], **numbers: float | None
) -> dict[str, Any]:
    found: dict[str, Any] = {}
    if moves:
        found["moves"] = [words_of_move(move, units) for move in moves]
    return found | {name: value for name, value in numbers.items() if value is not None}
