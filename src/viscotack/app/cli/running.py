"""Run a request from the command line: its progress, its answer, and its files.

Output files are checked before the work, and failures are reported after it.
"""

import json
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from errno import EEXIST
from itertools import combinations
from pathlib import Path
from time import monotonic
from typing import Any

import typer

from viscotack.app.operations.flags import in_flags
from viscotack.app.operations.options import Output
from viscotack.app.operations.request import Answer, Caller, Request, answered
from viscotack.errors import InputError
from viscotack.files.text import harmless
from viscotack.files.whole import NotWritten, check_target, is_standard_output, same_file
from viscotack.plot.style import check_format


def checked(
    files: Mapping[Output, Path | None], *, force: bool, as_json: bool
) -> dict[Output, Path | None]:
    """Return the files to write, including default ones, checked before the work starts.

    Parameters
    ----------
    files : mapping
        Output -> file; None where not given.
    force : bool
        Whether files that exist may be replaced.
    as_json : bool
        Whether the answer is one JSON object on standard output.

    Raises
    ------
    InputError
        If a file is missing or used twice, has the ending of another format, exists or cannot be
        written.
    """
    found: dict[Output, Path | None] = {}
    for output, file in files.items():
        flag, usual = output.flag, output.usual and not as_json
        file = found[output] = Path(output.usual) if file is None and usual else file
        if file is None:
            if output.needed:
                raise InputError(f"{flag} is missing; give the output file")
        elif is_standard_output(file):
            if output.kind != "text" or as_json:
                why = "is for text" if output.kind != "text" else "has the answer of --json"
                raise InputError(f"{flag} {file}: standard output {why}; give a file name")
        else:
            if output.kind == "picture":
                check_format(file)
            if output.endings and file.suffix.lower() not in ("", *output.endings):
                raise InputError(f"{flag} {file}: the ending must be {' or '.join(output.endings)}")
            check_target(file)
            # an empty file, of mktemp for example, holds nothing to lose
            if not force and file.is_file() and file.stat().st_size:
                raise InputError(
                    f"{flag} {file} exists; give another name, or --force to replace it"
                )
    given = [(output.flag, file) for output, file in found.items() if file is not None]
    for (one, first), (other, second) in combinations(given, 2):
        if same_file(first, second):
            raise InputError(
                f"{one} {first} and {other} {second} are the same file; give two different names"
            )
    return found


def finish(
    answer: Answer,
    files: Mapping[Output, Path | None],
    as_json: bool,
    read: Sequence[Path],
    kind: type[Request] | None,
) -> None:
    """Write the files of an answer, print it, and exit with its status.

    A file that cannot be written, or was read, does not stop the others; the status is then 2. If a
    table goes to standard output, the answer goes to standard error.
    """
    failed, is_taken = False, False
    reader_left: BrokenPipeError | None = None
    for output, file in files.items():
        if file is None or output.name not in answer.files.keys() | answer.pictures.keys():
            continue
        to_output = is_standard_output(file)
        is_taken |= to_output
        try:
            if any(same_file(file, each) for each in read):
                words = f"cannot write {file}: it is an input of this command; give another name"
                raise NotWritten(EEXIST, words)
            answer.write(output.name, typer.get_binary_stream("stdout") if to_output else file)
        except BrokenPipeError as error:
            reader_left = error
        except OSError as error:
            known = isinstance(error, NotWritten)
            words = error if known else f"cannot write to standard output: {error.strerror}"
            typer.echo(f"viscotack: {words}", err=True)
            failed = True
        else:
            if not to_output:
                typer.echo(f"wrote {file}", err=True)
    for note in answer.notes:
        typer.echo(harmless(in_flags(note, kind)), err=True)
    if as_json:
        text = json.dumps(answer.record(), indent=2, allow_nan=False)
    else:
        text = in_flags(str(answer), kind)
    try:
        if text:
            typer.echo(harmless(text), err=is_taken)
    except BrokenPipeError:
        raise
    except OSError as error:
        name = "standard error" if is_taken else "standard output"
        raise InputError(f"cannot write to {name}: {error.strerror}") from None
    if failed:
        raise typer.Exit(2)
    if reader_left is not None:
        raise reader_left  # Typer ends the command silently
    if answer.status:
        raise typer.Exit(answer.status)


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
    # a study has options by name, not flags
    finish(answer, files, as_json, caller.read, None if study else type(asked))


@contextmanager
def progress() -> Iterator[Callable[[Mapping[str, Any]], None]]:
    """Show a progress bar on standard error if it is a terminal, else lines; yields its update."""
    last = monotonic()

    def tell_lines(told: Mapping[str, Any]) -> None:
        nonlocal last
        if "words" in told and (told.get("urgent") or monotonic() - last > LINES):
            last = monotonic()
            typer.echo(harmless(told["words"]), err=True)

    if not sys.stderr.isatty():
        yield tell_lines
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
