"""Run a request from the command line: its progress, its files, and its answer."""

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from time import monotonic
from typing import Any

import typer

from viscotack.app.operations.options import Output
from viscotack.app.operations.request import Caller, Request, answered
from viscotack.files.text import harmless

from .writing import checked, finish

# Seconds between two lines of progress.
LINES = 10.0


def carry_out(
    asked: Request,
    files: Mapping[Output, Path | None],
    own: Iterable[str | Path],
    *,
    force: bool,
    as_json: bool,
    study: Path | None = None,
) -> None:
    """Run a request, show its progress, write the wanted outputs, and exit with its status.

    Parameters
    ----------
    asked : Request
        The request.
    files : mapping
        Output -> file; None if not wanted.
    own : iterable of path
        Files with user-defined classes.
    force : bool
        Whether files that exist may be replaced.
    as_json : bool
        Whether the answer is printed as one JSON object.
    study : Path, optional
        File with the request, in whose folder its file names are.
    """
    from viscotack.model.problem.nouns import own_nouns

    files = checked(files, force=force, as_json=as_json)
    wants = frozenset(output.name for output, file in files.items() if file is not None)
    paths = tuple(str(Path(file).resolve()) for file in own)
    with progress() as tell:
        caller = Caller(tell, wants, own_nouns(own), paths, study.parent if study else Path())
        caller.read.extend([*map(Path, paths), *([study] if study else [])])
        answer = answered(asked, caller)
    finish(answer, files, as_json, caller.read)


@contextmanager
def progress() -> Iterator[Callable[[Mapping[str, Any]], None]]:
    """Show a progress bar on standard error if it is a terminal; yields its update function."""
    if not sys.stderr.isatty():
        yield _lines()
        return
    from rich import progress as rich
    from rich.console import Console

    # the remaining time assumes that work is proportional to the completed share
    times = rich.TimeElapsedColumn(), rich.TextColumn("gone,"), rich.TimeRemainingColumn()
    words = rich.TextColumn("to go  {task.fields[words]}", markup=False)
    columns = rich.TextColumn("{task.description}"), rich.BarColumn(), *times, words
    with rich.Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=1.0, visible=False, words="")

        def tell(told: Mapping[str, Any]) -> None:
            if "share" in told:
                said = {"description": told.get("doing", ""), "words": told.get("words", "")}
                bar.update(task, completed=told["share"], visible=True, **said)

        yield tell


def _lines() -> Callable[[Mapping[str, Any]], None]:
    """Return a function that prints progress lines, for output that is not a terminal."""
    last = monotonic()

    def tell(told: Mapping[str, Any]) -> None:
        nonlocal last
        is_due = told.get("urgent") or monotonic() - last > LINES
        if "words" in told and is_due:
            last = monotonic()
            typer.echo(harmless(told["words"]), err=True)

    return tell
