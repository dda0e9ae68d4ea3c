"""What a figure is given to work with: helping hands, and the numbers of other figures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from time import process_time
from types import TracebackType
from typing import Any

Numbers = dict[str, Any]
# Processes that know nothing of what runs beside them: a copy of threads would wait for ever.
_FRESH = get_context("spawn")
# Like the built-in ``map``, of one function and one iterable.
Each = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]


@dataclass(frozen=True)
class Bench:
    """Where numbers are made.

    Attributes
    ----------
    each : callable
        Like the built-in ``map``, of one function and one iterable; in several processes or not.
    of : callable
        Returns the numbers of another figure by its name.
    archive : path or None
        A checkout of the authors' public archive, where it is at hand.
    """

    each: Each
    of: Callable[[str], Numbers]
    archive: Path | None = None


class Hands:
    """Some processes that share work, and the processor time that all of it took."""

    def __init__(self, workers: int) -> None:
        self._pool = ProcessPoolExecutor(workers, mp_context=_FRESH) if workers > 1 else None
        self._seconds = 0.0

    def __enter__(self) -> Hands:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)

    @property
    def seconds(self) -> float:
        """Processor time [s] of this process and of what the others have done."""
        return process_time() + self._seconds

    def each(self, function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[Any]:
        """Yield what the function makes of each item, in order."""
        if self._pool is None:
            yield from map(function, items)
            return
        for answer, seconds in self._pool.map(partial(_timed, function), items):
            self._seconds += seconds
            yield answer


def _timed(function: Callable[[Any], Any], item: Any) -> tuple[Any, float]:
    began = process_time()
    answer = function(item)
    return answer, process_time() - began
