"""A problem with cached intermediate results, as input of the tiers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

from viscotack.model.problem import Case, Groups, Problem
from viscotack.model.protocol import Start

if TYPE_CHECKING:
    from viscotack.prediction.surrogate.model import Surrogate

_T = TypeVar("_T")


@dataclass(frozen=True, eq=False)
class Question:
    """A problem, and the confidence of the requested intervals.

    Attributes
    ----------
    problem : Problem or Groups
        Problem as stated by the user.
    confidence : float
        Fraction of cases inside the intervals.
    joint : bool
        Whether force, work and curve of a surrogate are to be inside together.
    model : Surrogate or None
        The surrogate to use in place of that of the package.
    """

    problem: Case
    confidence: float = 0.9
    joint: bool = False
    model: Surrogate | None = None
    _known: dict[Callable[[Question], Any], Any] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        if not isinstance(self.problem, Problem | Groups):
            raise TypeError(
                f"predict needs a Problem or Groups, got {self.problem!r}; for a file use "
                "viscotack.read_case(path)"
            )

    @property
    def groups(self) -> Any:
        """The dimensionless problem."""
        return self.once(_groups)

    @property
    def relaxed_start(self) -> bool:
        """Whether the test begins in a relaxed contact."""
        return isinstance(self.groups.start, Start)

    def once(self, compute: Callable[[Question], _T]) -> _T:
        """Return the result of a function of this question, computed on the first call only."""
        if compute not in self._known:
            self._known[compute] = compute(self)
        return self._known[compute]


def _groups(asked: Question) -> Any:
    return asked.problem.groups()
