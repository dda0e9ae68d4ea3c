"""What the machine does: a relaxed start, then a motion.

Depth is positive into the solid, force positive in compression. The three starts are statements
about one number. In a :class:`~viscotack.problem.Problem` the number is in SI; in
:class:`~viscotack.problem.Groups` it is in the dimensionless unit named there.
"""

from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

from viscotack.cards import Quantity, conform
from viscotack.errors import InputError

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


@dataclass(frozen=True)
class AtDepth:
    """Start relaxed at a depth, on the branch in contact.

    Parameters
    ----------
    depth : float
        Depth of the sphere below the undeformed surface [m; h_0 when dimensionless]. Positive into
        the solid; a negative one exists while adhesion holds the contact.
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

    def __post_init__(self) -> None:
        conform(self)


@dataclass(frozen=True)
class AtForce:
    """Start relaxed under a force, on the branch of the larger radius, which a dead load keeps.

    Parameters
    ----------
    force : float
        Force [N; 1.5 pi R Delta-gamma_0 when dimensionless], positive in compression. A negative
        one exists down to the elastic pull-off force.
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

    def __post_init__(self) -> None:
        conform(self)


@dataclass(frozen=True)
class AtRadius:
    """Start relaxed at a contact radius.

    Parameters
    ----------
    contact_radius : float
        Radius of the edge, where the gap is that of peak tension
        [m; (pi R^2 Delta-gamma_0/E_0*)^(1/3) when dimensionless]; positive.
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

    def __post_init__(self) -> None:
        conform(self)


Start = AtDepth | AtForce | AtRadius
# Of a test; each takes tens of steps, and a simulation ends after 200,000.
MOST_MOVES = 10_000


@dataclass(frozen=True)
class Apart:
    """Start out of contact and at rest.

    Parameters
    ----------
    gap : float
        Smallest gap between the undeformed surfaces [m; h_0 when dimensionless]; positive. Forces
        of finite range act there already: a few h_0 are needed to be out of contact, and more the
        softer the solid is; the search says so where contact is all there is.
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

    def __post_init__(self) -> None:
        conform(self)


@dataclass(frozen=True)
class Approach:
    """Move the drive into the solid at a constant speed.

    Parameters
    ----------
    speed : float
        Speed of the drive [m/s; h_0 per time unit when dimensionless]; positive.
    to : AtDepth, AtForce or AtRadius
        Where it ends: depth, force or contact radius of the indenter at that instant, not relaxed.
    """

    speed: Speed
    to: Start

    def __post_init__(self) -> None:
        _check_end(self.to, "Approach")
        conform(self)


@dataclass(frozen=True)
class Retract:
    """Move the drive out of the solid at a constant speed, to a depth, a force or a radius.

    Parameters
    ----------
    speed : float
        Speed of the drive [m/s; h_0 per time unit when dimensionless]; positive.
    to : AtDepth, AtForce or AtRadius
        Where it ends. The surfaces may have come apart by then.
    """

    speed: Speed
    to: Start

    def __post_init__(self) -> None:
        _check_end(self.to, "Retract")
        conform(self)


@dataclass(frozen=True)
class MoveTo:
    """Move the drive to a depth in a time: a stretch of any piecewise linear history.

    Parameters
    ----------
    depth : float
        Depth of the drive at the end [m; h_0 when dimensionless], positive into the solid. Without
        a spring it is the depth of the indenter.
    duration : float
        Time it takes [s; the time unit when dimensionless]; positive.
    """

    depth: Annotated[float, Quantity("m", "D", "depth of the drive at the end", measure="depth")]
    duration: Duration

    def __post_init__(self) -> None:
        conform(self)


@dataclass(frozen=True)
class Dwell:
    """Wait.

    Parameters
    ----------
    duration : float
        How long [s; the time unit when dimensionless]; positive.
    hold : {"drive", "depth", "force"}
        What stays as it is: the drive, the depth of the indenter (the same without a spring), or
        the force. A contact held at a tensile force may let go; the run then ends there.
    """

    duration: Duration
    hold: str = "drive"

    def __post_init__(self) -> None:
        conform(self)
        if self.hold not in HOLDS:
            raise InputError(f"hold must be one of {', '.join(HOLDS)}, got {self.hold!r}")


@dataclass(frozen=True)
class LoadTo:
    """Bring the force to a value in a time, under load control.

    Parameters
    ----------
    force : float
        Force at the end [N; 1.5 pi R Delta-gamma_0 when dimensionless], positive in compression.
        A tensile one beyond what the contact can bear pulls it off.
    duration : float
        Time it takes [s; the time unit when dimensionless]; positive.
    """

    force: Annotated[
        float,
        Quantity("N", "F", "force at the end, positive in compression", measure="force"),
    ]
    duration: Duration

    def __post_init__(self) -> None:
        conform(self)


HOLDS = ("drive", "depth", "force")
Move = Approach | Retract | MoveTo | Dwell | LoadTo


def _check_end(to: object, name: str) -> None:
    if not isinstance(to, Start):
        raise InputError(f"{name} ends AtDepth, AtForce or AtRadius, got {to!r}")


@dataclass(frozen=True)
class Retraction:
    """Pull away at a constant speed, from a state at rest and after what the machine did before.

    Parameters
    ----------
    start : AtDepth, AtForce, AtRadius or Apart
        The state at rest in which the test begins: a relaxed contact, or surfaces apart.
    speed : float or None
        Speed of the final retraction [m/s]; positive. The drive goes until the surfaces are apart.
        None if the test ends with the last of the moves.
    moves : tuple of Approach, Retract, MoveTo, Dwell and LoadTo
        What the machine does before; usually nothing.
    stiffness : float or None
        Stiffness of the machine between drive and indenter [N/m]; positive. None for a rigid one.

    Examples
    --------
    >>> Retraction(start=AtForce(force=1.5e-3), speed=100e-6).speed
    0.0001

    Press to 1.5 mN, wait for a minute, pull:

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
    """Refuse a test of so many moves."""
    if number > MOST_MOVES:
        raise InputError(
            f"a test has at most {MOST_MOVES:,} moves, got {number:,}; leave out rows of its "
            "history, make fewer cycles, or part it into several tests"
        )


def check_moves(moves: tuple[Move, ...], speed: float | None, name: str) -> None:
    """Refuse moves that are none or too many, and a test in which nothing moves."""
    check_number_of_moves(len(moves))
    for move in moves:
        if not isinstance(move, Move):
            raise InputError(
                f"moves must be Approach, Retract, MoveTo, Dwell or LoadTo, got {move!r}"
            )
    if speed is None and not moves:
        raise InputError(f"a test without moves needs the {name} of its retraction")


@dataclass(frozen=True)
class Units:
    """What one unit of each number of a protocol is, in other units."""

    depth: float
    force: float
    contact_radius: float
    time: float

    def retraction(
        self,
        start: Start | Apart,
        speed: float | None,
        moves: tuple[Move, ...],
        stiffness: float | None,
    ) -> Retraction:
        """Return a test whose parts are given, in the other units."""
        return Retraction(
            start=self.start(start),
            speed=self.speed(speed),
            moves=self.moves(moves),
            stiffness=self.stiffness(stiffness),
        )

    def start(self, start: Start | Apart) -> Start | Apart:
        """Return a start in the other units."""
        match start:
            case AtDepth():
                return AtDepth(start.depth * self.depth)
            case AtForce():
                return AtForce(start.force * self.force)
            case AtRadius():
                return AtRadius(start.contact_radius * self.contact_radius)
            case Apart():
                return Apart(start.gap * self.depth)

    def speed(self, speed: float | None) -> float | None:
        """Return a speed in the other units."""
        return None if speed is None else speed * self.depth / self.time

    def stiffness(self, stiffness: float | None) -> float | None:
        """Return a stiffness in the other units."""
        return None if stiffness is None else stiffness * self.force / self.depth

    def moves(self, moves: tuple[Move, ...]) -> tuple[Move, ...]:
        """Return moves in the other units."""
        return tuple(self._move(move) for move in moves)

    def _move(self, move: Move) -> Move:
        match move:
            case Approach() | Retract():
                return replace(move, speed=self.speed(move.speed), to=self.start(move.to))  # type: ignore[arg-type]
            case MoveTo():
                return MoveTo(move.depth * self.depth, move.duration * self.time)
            case LoadTo():
                return LoadTo(move.force * self.force, move.duration * self.time)
            case Dwell():
                return replace(move, duration=move.duration * self.time)


def states(protocol: Retraction) -> list[Start]:
    """Return the states that a test goes through, each as if it were relaxed."""
    found = [] if isinstance(protocol.start, Apart) else [protocol.start]
    for move in protocol.moves:
        match move:
            case Approach() | Retract():
                found.append(move.to)
            case MoveTo():
                found.append(AtDepth(move.depth))
            case LoadTo():
                found.append(AtForce(move.force))
    return found
