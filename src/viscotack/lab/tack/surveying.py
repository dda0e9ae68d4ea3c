"""Evaluate many files of tack tests, and list the unreadable ones with the reason."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from viscotack.errors import InputError

from .cycle import Cycle
from .evaluation import Evaluation, Refusal, evaluate
from .reading import groups, read

AnyPath = str | PathLike[str]


@dataclass(frozen=True)
class Unread:
    """An unreadable file (or the first file of a test), and the reason."""

    path: str
    reason: str


@dataclass(frozen=True, eq=False)
class Survey:
    """Evaluated records of many files, and the unreadable files."""

    evaluations: tuple[Evaluation, ...]
    unread: tuple[Unread, ...]

    @property
    def cycles(self) -> tuple[Cycle, ...]:
        """All evaluated cycles."""
        return tuple(cycle for one in self.evaluations for cycle in one.cycles)

    @property
    def refused(self) -> tuple[tuple[str, Refusal], ...]:
        """All rejected cycles, each with its file."""
        return tuple(
            (one.record.source.path, refusal) for one in self.evaluations for refusal in one.refused
        )

    @property
    def cautions(self) -> tuple[tuple[str, str], ...]:
        """File and caution of every cycle whose signal contradicts the theories."""
        return tuple(
            (one.source.path, f"cycle {one.number}: {said}")
            for one in self.cycles
            for said in one.cautions
        )

    @property
    def reasons(self) -> tuple[tuple[str, str], ...]:
        """File and reason of every rejected file and cycle."""
        files = [(one.path, one.reason.removeprefix(f"{one.path}: ")) for one in self.unread]
        cycles = [(path, f"cycle {one.number}: {one.reason}") for path, one in self.refused]
        return (*files, *cycles)


def survey(
    paths: Sequence[AnyPath],
    *,
    reading: Mapping[str, Any] | None = None,
    evaluation: Mapping[str, Any] | None = None,
) -> Survey:
    """Evaluate files of tack tests; an unreadable file does not stop the others.

    Parameters
    ----------
    paths : sequence of path-like
        Files, or folders, of which all files are read but hidden ones and those in folders
        inside; intervals of one test are joined as in :func:`read`.
    reading, evaluation : mapping, optional
        Keyword arguments of :func:`read` and :func:`evaluate`.

    Raises
    ------
    OSError
        If a file cannot be opened.
    ValueError
        If a folder contains no file.
    """
    found: list[Evaluation] = []
    unread: list[Unread] = []
    for group in groups([file for path in paths for file in _files(path)]):
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


def _files(path: AnyPath) -> list[AnyPath]:
    """Return the visible files of a folder by name; a file itself."""
    if not Path(path).is_dir():
        return [path]
    inside = sorted(Path(path).iterdir())
    found: list[AnyPath] = [x for x in inside if x.is_file() and not x.name.startswith(".")]
    if not found:
        raise InputError(f"{path}: the folder contains no file")
    return found
