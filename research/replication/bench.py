"""Where numbers are made, or taken as they are kept, and drawn."""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from time import process_time
from typing import Any

from .figures.catalogue import named
from .figures.style import saved
from .kept import Numbers, keep, kept, rounded

# Processes that know nothing of what runs beside them: a copy of threads would wait for ever.
_FRESH = get_context("spawn")


class Bench:
    """Makes each figure's numbers once, in some processes, or takes those that are kept.

    With `afresh` numbers are made that are kept already, and with `store` kept in their place.
    What needs the authors' archive is taken as it is kept where there is no checkout of it. `say`
    is told what is being made.
    """

    def __init__(
        self,
        workers: int = 1,
        *,
        afresh: bool = False,
        store: bool = False,
        archive: Path | None = None,
        say: Callable[[str], None] = lambda words: None,
    ) -> None:
        self._pool = ProcessPoolExecutor(workers, mp_context=_FRESH) if workers > 1 else None
        self._afresh, self._store, self.archive, self._say = afresh, store, archive, say
        self._made: dict[str, Numbers] = {}
        self._elsewhere = 0.0
        # processor time [s] of each figure that was made
        self.spent: dict[str, float] = {}

    def __enter__(self) -> "Bench":
        return self

    def __exit__(self, *error: object) -> None:
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)

    @property
    def seconds(self) -> float:
        """Processor time [s] of this process and of what the others have done."""
        return process_time() + self._elsewhere

    def each(self, function: Callable[[Any], Any], items: Iterable[Any]) -> Iterator[Any]:
        """Yield what the function makes of each item, in order."""
        if self._pool is None:
            yield from map(function, items)
            return
        for answer, seconds in self._pool.map(partial(_timed, function), items):
            self._elsewhere += seconds
            yield answer

    def of(self, name: str) -> Numbers:
        """Return the numbers of a figure as they are kept, to so many digits."""
        if name not in self._made:
            lacking = self._afresh and named(name).archive and self.archive is None
            if lacking:
                self._say(f"figure {name} needs the authors' archive (--archive): as it is kept")
            self._made[name] = self._make(name) if self._afresh and not lacking else kept(name)
        return self._made[name]

    def _make(self, name: str) -> Numbers:
        self._say(f"figure {name} ...")
        of_others, began = sum(self.spent.values()), self.seconds
        found = rounded(named(name).numbers(self))
        # what it took from other figures is counted there
        of_others = sum(self.spent.values()) - of_others
        self.spent[name] = self.seconds - began - of_others
        if self._store:
            keep(name, found, seconds=self.spent[name])
        return found


def _timed(function: Callable[[Any], Any], item: Any) -> tuple[Any, float]:
    began = process_time()
    answer = function(item)
    return answer, process_time() - began


def picture(name: str, numbers: Numbers, folder: Path, *, dpi: int = 150) -> Path:
    """Draw a figure into a folder and return the file."""
    figure = named(name)
    path = folder / f"{name.replace('.', '_')}.png"
    return saved(figure.draw, numbers, path, size=figure.size, note=figure.note, dpi=dpi)
