"""Loading protocols: a state at rest, then motions of the drive.

Depth is positive into the solid, force positive in compression. Each relaxed start is defined
by one number. In a :class:`~viscotack.model.problem.Problem` it is in SI; in
:class:`~viscotack.model.problem.Groups` it is in the dimensionless unit named there.
"""

from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, TypeVar

from viscotack.cards import Checked, Quantity, cards, conform
from viscotack.errors import InputError

_Noun = TypeVar("_Noun")

Speed = Annotated[
    float,
    Quantity("m/s", "r", "speed of the drive", above=0, measure="speed", example="100 um/s"),
]
Duration = Annotated[
    float, Quantity("s", "t", "how long it takes", above=0, measure="time", example="60 s")
]
Stiffness = Annotated[
    float,
    Quantity(
        "N/m",
        "K",
        "stiffness of the machine; rigid when left out",
        above=0,
        measure="stiffness",
        example="500 N/m",
    ),
]


class _State(Checked):
    """A state at rest, of one number."""

    word: ClassVar[str]

    @property
    def value(self) -> float:
        """The number."""
        (value,) = vars(self).values()
        return value

    def __str__(self) -> str:
        return f"{self.word} {self.value:g}"


@dataclass(frozen=True)
class AtDepth(_State):
    """Relaxed contact at a given depth.

    Parameters
    ----------
    depth : float
        Depth of the sphere below the undeformed surface [m; h_0 when dimensionless], positive into
        the solid. Negative depths exist while adhesion maintains the contact.

    Examples
    --------
    >>> AtDepth(depth=2e-6)
    AtDepth(depth=2e-06)
    """

    word: ClassVar[str] = "depth"

    depth: Annotated[
        float,
        Quantity(
            "m",
            "delta",
            "depth of the relaxed start, positive into the solid",
            measure="depth",
            example="2 um",
        ),
    ]


@dataclass(frozen=True)
class AtForce(_State):
    """Relaxed contact under a given force, on the branch of larger radius, stable at fixed load.

    Parameters
    ----------
    force : float
        Force [N; 1.5 pi R Delta-gamma_0 when dimensionless], positive in compression. Negative
        forces exist down to the elastic pull-off force.

    Examples
    --------
    >>> AtForce(force=1.5e-3)
    AtForce(force=0.0015)
    """

    word: ClassVar[str] = "force"

    force: Annotated[
        float,
        Quantity(
            "N",
            "F",
            "force of the relaxed start, positive in compression",
            measure="force",
            example="1.5 mN",
        ),
    ]


@dataclass(frozen=True)
class AtRadius(_State):
    """Relaxed contact with a given contact radius.

    Parameters
    ----------
    contact_radius : float
        Radius of the edge, defined by the gap of peak tension
        [m; (pi R^2 Delta-gamma_0/E_0*)^(1/3) when dimensionless], positive.

    Examples
    --------
    >>> AtRadius(contact_radius=200e-6)
    AtRadius(contact_radius=0.0002)
    """

    word: ClassVar[str] = "radius"

    contact_radius: Annotated[
        float,
        Quantity(
            "m",
            "a",
            "contact radius of the relaxed start",
            above=0,
            measure="radius",
            example="200 um",
        ),
    ]


Start = AtDepth | AtForce | AtRadius
# Largest number of moves of a test; each takes tens of steps, and a simulation ends after 200,000.
MOST_MOVES = 10_000


@dataclass(frozen=True)
class Apart(_State):
    """Start out of contact and at rest.

    Parameters
    ----------
    gap : float
        Smallest gap between the undeformed surfaces [m; h_0 when dimensionless], positive. Because
        the forces have a finite range, the gap must be a few h_0, and more for softer solids; the
        simulation raises an error if only a state in contact exists.

    Examples
    --------
    >>> Apart(gap=20e-6)
    Apart(gap=2e-05)
    """

    word: ClassVar[str] = "apart"

    gap: Annotated[
        float,
        Quantity(
            "m",
            "h",
            "gap between the undeformed surfaces at a start apart",
            above=0,
            measure="depth",
            example="20 um",
        ),
    ]


@dataclass(frozen=True)
class _Motion(Checked):
    """A move at constant speed to a state."""

    speed: Speed
    to: Start

    def __post_init__(self) -> None:
        if not isinstance(self.to, Start):
            raise InputError(
                f"{type(self).__name__} must end at AtDepth, AtForce or AtRadius, got {self.to!r}"
            )
        super().__post_init__()


@dataclass(frozen=True)
class Approach(_Motion):
    """Move the drive into the solid at constant speed.

    Parameters
    ----------
    speed : float
        Speed of the drive [m/s; h_0 per time unit when dimensionless], positive.
    to : AtDepth, AtForce or AtRadius
        End of the move: current (not relaxed) depth, force or contact radius of the indenter.

    Examples
    --------
    >>> Approach(speed=10e-6, to=AtForce(force=1.5e-3))
    Approach(speed=1e-05, to=AtForce(force=0.0015))
    """


@dataclass(frozen=True)
class Retract(_Motion):
    """Move the drive out of the solid at constant speed, to a depth, a force or a radius.

    Parameters
    ----------
    speed : float
        Speed of the drive [m/s; h_0 per time unit when dimensionless], positive.
    to : AtDepth, AtForce or AtRadius
        End of the move. The surfaces may have separated by then.

    Examples
    --------
    >>> Retract(speed=10e-6, to=AtDepth(depth=-2e-6))
    Retract(speed=1e-05, to=AtDepth(depth=-2e-06))
    """


@dataclass(frozen=True)
class MoveTo(Checked):
    """Move the drive linearly to a depth in a given time, for piecewise linear histories.

    Parameters
    ----------
    depth : float
        Depth of the drive at the end [m; h_0 when dimensionless], positive into the solid. With a
        rigid machine it equals the depth of the indenter.
    duration : float
        Duration [s; the time unit when dimensionless], positive.

    Examples
    --------
    >>> MoveTo(depth=3e-6, duration=0.5)
    MoveTo(depth=3e-06, duration=0.5)
    """

    depth: Annotated[float, Quantity("m", "D", "depth of the drive at the end", measure="depth")]
    duration: Duration


@dataclass(frozen=True)
class Dwell:
    """Hold the drive, the depth or the force constant for a time.

    Parameters
    ----------
    duration : float
        Duration [s; the time unit when dimensionless], positive.
    hold : {"drive", "depth", "force"}
        Quantity held constant: the drive, the depth of the indenter (the same for a rigid machine),
        or the force. A contact held at a tensile force may detach; the run then ends.

    Examples
    --------
    >>> Dwell(duration=60.0)
    Dwell(duration=60.0, hold='drive')
    """

    duration: Duration
    hold: str = "drive"

    def __post_init__(self) -> None:
        conform(self)
        if self.hold not in HOLDS:
            raise InputError(f"hold must be one of {', '.join(HOLDS)}, got {self.hold!r}")


@dataclass(frozen=True)
class LoadTo(Checked):
    """Change the force linearly to a value in a given time, under load control.

    Parameters
    ----------
    force : float
        Force at the end [N; 1.5 pi R Delta-gamma_0 when dimensionless], positive in compression.
        A tension above the strength of the contact detaches it.
    duration : float
        Duration [s; the time unit when dimensionless], positive.

    Examples
    --------
    >>> LoadTo(force=-1e-3, duration=2.0)
    LoadTo(force=-0.001, duration=2.0)
    """

    force: Annotated[
        float,
        Quantity("N", "F", "force at the end, positive in compression", measure="force"),
    ]
    duration: Duration


HOLDS = ("drive", "depth", "force")
Move = Approach | Retract | MoveTo | Dwell | LoadTo


@dataclass(frozen=True)
class Retraction:
    """A test: a state at rest, optional moves, and a retraction at constant speed.

    Parameters
    ----------
    start : AtDepth, AtForce, AtRadius or Apart
        State at rest at the beginning: a relaxed contact, or surfaces apart.
    speed : float or None
        Speed of the final retraction [m/s], positive; it lasts until the surfaces have separated.
        None if the test ends with the last move.
    moves : tuple of Approach, Retract, MoveTo, Dwell and LoadTo
        Motions before the retraction; by default none.
    stiffness : float or None
        Stiffness of the machine between drive and indenter [N/m], positive. None for a rigid one.

    Examples
    --------
    >>> Retraction(start=AtForce(force=1.5e-3), speed=100e-6).speed
    0.0001

    Approach to 1.5 mN, dwell for a minute, retract:

    >>> protocol = Retraction(
    ...     start=Apart(gap=20e-6),
    ...     moves=(Approach(speed=10e-6, to=AtForce(force=1.5e-3)), Dwell(duration=60)),
    ...     speed=100e-6,
    ...     stiffness=500.0,
    ... )
    """

    start: Start | Apart
    speed: Speed | None
    moves: tuple[Move, ...] = ()
    stiffness: Stiffness | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.start, Start | Apart):
            raise InputError(
                f"start must be AtDepth, AtForce, AtRadius or Apart, got {self.start!r}; "
                "for example AtForce(force=1.5e-3)"
            )
        object.__setattr__(self, "moves", tuple(self.moves))
        check_moves(self.moves, self.speed, "speed")
        conform(self)


def check_number_of_moves(number: int) -> None:
    """Raise an error if a test has too many moves."""
    if number > MOST_MOVES:
        raise InputError(
            f"a test has at most {MOST_MOVES:,} moves, got {number:,}; remove rows of its "
            "history, use fewer cycles, or split it into several tests"
        )


def check_moves(moves: tuple[Move, ...], speed: float | None, name: str) -> None:
    """Raise an error for invalid or too many moves, and for a test without motion."""
    check_number_of_moves(len(moves))
    for move in moves:
        if not isinstance(move, Move):
            raise InputError(
                f"moves must be Approach, Retract, MoveTo, Dwell or LoadTo, got {move!r}"
            )
    if speed is None and not moves:
        raise InputError(f"a test without moves needs the {name} of a retraction")


@dataclass(frozen=True)
class Units:
    """Scale factors from one system of units of a protocol to another."""

    depth: float
    force: float
    contact_radius: float
    time: float

    def scaled(self, noun: _Noun) -> _Noun:
        """Convert a test, a move or a start, by the measures of its cards."""
        factors = {
            "depth": (self.depth, 1.0),
            "force": (self.force, 1.0),
            "radius": (self.contact_radius, 1.0),
            "time": (self.time, 1.0),
            "speed": (self.depth, self.time),
            "stiffness": (self.force, self.depth),
        }
        whole: Any = noun
        new: dict[str, Any] = {}
        for name, value in vars(whole).items():
            if isinstance(value, tuple):
                new[name] = tuple(map(self.scaled, value))
            elif isinstance(value, _State):
                new[name] = self.scaled(value)
            elif isinstance(value, float):
                above, below = factors[cards(type(whole))[name].card.measure]
                new[name] = value * above / below
        return replace(whole, **new)


def end_of(move: Move) -> Start | None:
    """Return the state to which a move leads, interpreted as a relaxed one; None of a dwell."""
    match move:
        case Approach() | Retract():
            return move.to
        case MoveTo():
            return AtDepth(move.depth)
        case LoadTo():
            return AtForce(move.force)
        case Dwell():
            return None


def states(protocol: Retraction) -> list[Start]:
    """Return the states at the start and at the ends of the moves, interpreted as relaxed ones."""
    found = (protocol.start, *map(end_of, protocol.moves))
    return [state for state in found if state is not None and not isinstance(state, Apart)]
