"""What the workers of a run have in common, here and on a cluster.

A crew is given cases by number and brings back answers, or word of a loss. What to run next, what
to store and what to try again is decided in :mod:`viscotack.campaign.running`.
"""

from dataclasses import dataclass
from typing import Protocol

from .case import Answer


@dataclass(frozen=True)
class Lost:
    """A case that has not come back.

    Attributes
    ----------
    reason : str
        What became of its worker.
    blame : bool
        Whether the case may be the cause: a process that did this case and no other has ended.
        False where a machine of a cluster left with all that was on it.
    """

    reason: str
    blame: bool = True


class Gone(ConnectionError):
    """The cluster's scheduler cannot be reached any more."""


class Crew(Protocol):
    """Workers that take cases."""

    def room(self) -> int:
        """Return how many more cases may be handed in now; NoWorker if there will be none."""
        ...

    def hand(self, number: int, problem: str) -> None:
        """Give a case, by a number of the caller's, to a worker that has room."""
        ...

    def collect(self, seconds: float) -> list[tuple[int, Answer | Lost]]:
        """Return what has come back, after waiting so long at most for something to come [s]."""
        ...

    def workers(self) -> int:
        """Return how many cases are done at once."""
        ...
