"""Wall-time limit of a run, checked in every iteration of the solver."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from math import inf
from time import perf_counter

# Time at which the limit ends, and its length [s]; each thread has its own value.
_END: ContextVar[tuple[float, float]] = ContextVar("end", default=(inf, inf))


class TimeUp(Exception):
    """A run has reached its time limit."""

    def __init__(self, seconds: float) -> None:
        super().__init__(f"the time limit of {seconds:g} s was met")


@contextmanager
def limited(seconds: float | None) -> Iterator[None]:
    """Limit the wall time of the enclosed code; None is no limit.

    Of limits within each other, the one that ends first counts.

    Examples
    --------
    >>> with limited(1e-9):
    ...     look()
    Traceback (most recent call last):
    viscotack.clock.TimeUp: the time limit of 1e-09 s was met
    """
    given = inf if seconds is None else seconds
    before = _END.set(min(_END.get(), (perf_counter() + given, given)))
    try:
        yield
    finally:
        _END.reset(before)


def met() -> TimeUp | None:
    """Return the exception if the time limit has been reached, otherwise None."""
    end, seconds = _END.get()
    return TimeUp(seconds) if perf_counter() > end else None


def look() -> None:
    """Raise TimeUp when the time is over."""
    if limit := met():
        raise limit
