"""Many files of tack tests at once: what each says, and why the others say nothing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from typing import Any

from viscotack.errors import InputError

from .cycle import Cycle
from .evaluation import Evaluation, Refusal, evaluate
from .reading import groups, read

AnyPath = str | PathLike[str]


@dataclass(frozen=True)
class Unread:
    """A file, or the first of the files of one test, that gave nothing, and why."""

    path: str
    reason: str


@dataclass(frozen=True, eq=False)
class Survey:
    """The records of many files, evaluated; and the files that could not be read."""

    evaluations: tuple[Evaluation, ...]
    unread: tuple[Unread, ...]

    @property
    def cycles(self) -> tuple[Cycle, ...]:
        """All cycles that gave numbers."""
        return tuple(cycle for one in self.evaluations for cycle in one.cycles)

    @property
    def refused(self) -> tuple[tuple[str, Refusal], ...]:
        """All cycles that did not, each with the file it stands in."""
        return tuple(
            (one.record.source.path, refusal) for one in self.evaluations for refusal in one.refused
        )

    @property
    def reasons(self) -> tuple[tuple[str, str], ...]:
        """Why files and cycles were refused, each with the file."""
        files = [(one.path, one.reason.removeprefix(f"{one.path}: ")) for one in self.unread]
        cycles = [(path, f"cycle {one.number}: {one.reason}") for path, one in self.refused]
        return (*files, *cycles)


def survey(
    paths: Sequence[AnyPath],
    *,
    reading: Mapping[str, Any] | None = None,
    evaluation: Mapping[str, Any] | None = None,
) -> Survey:
    """Return what files of tack tests say, one bad file not hiding the others.

    Parameters
    ----------
    paths : sequence of path-like
        Files; intervals of one test are joined as :func:`read` does.
    reading, evaluation : mapping, optional
        Keywords of :func:`read` and :func:`evaluate`.

    Raises
    ------
    OSError
        If a file cannot be opened.
    """
    found: list[Evaluation] = []
    unread: list[Unread] = []
    for group in groups(paths):
        try:
            records = read(group, **(reading or {}))
        except InputError as error:
            unread.append(Unread(fspath(group[0]), str(error)))
            continue
        for record in records:
            try:
                found.append(evaluate(record, **(evaluation or {})))
            except InputError as error:
                unread.append(Unread(record.source.path, str(error)))
    return Survey(tuple(found), tuple(unread))
