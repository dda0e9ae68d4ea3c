"""Parts of a test: its cycles, each with a closing and an opening part.

A cycle begins where the machine reverses to close the contact again. Its closing part includes all
moves into the solid and the dwells before, between and after them; the opening part begins with the
first move out of the solid and lasts until the next reversal.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.model.problem import Groups
from viscotack.model.protocol import Approach, Dwell, LoadTo, Move, MoveTo, Retract

from . import Outcome, Result


@dataclass(frozen=True)
class Span:
    """A cycle, by step indices.

    Attributes
    ----------
    first, turn, last : int
        First state, first state of the opening part, and last state.
    closes, opens : bool
        Whether the machine moves into the solid, and out of it, during the cycle.
    """

    first: int
    turn: int
    last: int
    closes: bool
    opens: bool

    @property
    def states(self) -> slice:
        """Slice of the states of the cycle, including both ends."""
        return slice(self.first, self.last + 1)

    @property
    def closing(self) -> slice:
        """Slice of the states of the closing part, including both ends."""
        return slice(self.first, self.turn + 1)

    @property
    def opening(self) -> slice:
        """Slice of the states of the opening part, including both ends."""
        return slice(self.turn, self.last + 1)


def moves_of(result: Result) -> tuple[Move | None, ...]:
    """Return the moves of a test; None is the final retraction."""
    return all_moves(result.groups)


def all_moves(groups: Groups) -> tuple[Move | None, ...]:
    """Return the moves of a problem; None is the final retraction."""
    return (*groups.moves, *((None,) if groups.rate is not None else ()))


def move_numbers(result: Result) -> npt.NDArray[np.intp]:
    """Return the index of the move that led to each step.

    For results without this record it is the last move, so earlier moves are not distinguished.
    """
    if result.move is None:
        return np.full(len(result.time), len(moves_of(result)) - 1)
    return result.move


def waits(move: Move | None, hold: str = "") -> bool:
    """Return whether a move is a dwell, optionally with a given held quantity."""
    return isinstance(move, Dwell) and hold in ("", move.hold)


def touches(result: Result, span: Span) -> bool:
    """Return whether there is contact in a cycle; without edges, according to the outcome."""
    known = np.isfinite(result.contact_radius)
    if not known.any():
        return result.outcome is not Outcome.NEVER
    return bool(known[span.first : span.last + 1].any())


def spans(result: Result) -> list[Span]:
    """Return the cycles of a test; a pure retraction is one cycle."""
    if result.move is None:
        end = len(result.depth) - 1
        deepest = int(np.flatnonzero(result.depth == result.depth.max())[-1])
        opens = not waits(moves_of(result)[-1])
        return [Span(0, deepest, end, closes=deepest > 0, opens=opens)]
    return spans_of(result.groups, result.move, result.depth, result.force)


def spans_of(
    groups: Groups, number: npt.NDArray[np.intp], depth: Array, force: Array
) -> list[Span]:
    """Return the cycles of a history, from the index of the move that led to each step."""
    moves, end = all_moves(groups), len(number) - 1
    found, first, turn, closes = [], 0, -1, False
    for move in np.unique(number):
        begin = max(int(np.searchsorted(number, move)) - 1, 0)
        way = _way(groups, moves[move], float(depth[begin]), float(force[begin]))
        if way > 0 and turn >= 0:
            found.append(Span(first, turn, begin, closes, opens=True))
            first, turn, closes = begin, -1, True
        elif way < 0 and turn < 0:
            turn = begin
        closes |= way > 0
    opens = turn >= 0
    return [*found, Span(first, turn if opens else end, end, closes, opens)]


def _way(groups: Groups, move: Move | None, depth: float, force: float) -> float:
    """Return a positive number for a move into the solid, a negative one for a move out of it.

    Depth and force are those at the beginning of the move.
    """
    match move:
        case Approach():
            return 1.0
        case Retract() | None:
            return -1.0
        case MoveTo():
            k = groups.stiffness
            return move.depth - (depth + (0.0 if k is None else force / k))
        case LoadTo():
            return move.force - force
        case Dwell():
            return 0.0
