"""The wall time that a run may take; looked at in every iteration, wherever that is made."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from math import inf
from time import perf_counter

# When time is up, and how long that was [s]; each thread has its own.
_END: ContextVar[tuple[float, float]] = ContextVar("end", default=(inf, inf))


class TimeUp(Exception):
    """A run has met its time limit; in words."""

    def __init__(self, seconds: float) -> None:
        super().__init__(f"the time limit of {seconds:g} s was met")


@contextmanager
def limited(seconds: float | None) -> Iterator[None]:
    """Let what is within take so long; None for as long as it takes.

    Examples
    --------
    >>> with limited(1e-9):
    ...     look()
    Traceback (most recent call last):
    viscotack.bem.clock.TimeUp: the time limit of 1e-09 s was met
    """
    given = inf if seconds is None else seconds
    before = _END.set((perf_counter() + given, given))
    try:
        yield
    finally:
        _END.reset(before)


def met() -> TimeUp | None:
    """Return what says so when the time is over."""
    end, seconds = _END.get()
    return TimeUp(seconds) if perf_counter() > end else None


def look() -> None:
    """Raise TimeUp when the time is over."""
    if limit := met():
        raise limit
