"""Output files of commands: checked before the work, and failures reported after it."""

from collections.abc import Callable, Mapping
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from viscotack.app.operations.request import Output
from viscotack.errors import InputError
from viscotack.files.text import harmless
from viscotack.files.whole import (
    NotWritten,
    Target,
    check_target,
    is_standard_output,
    same_file,
)
from viscotack.plot.style import check_format, save_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def check_files(
    files: Mapping[Output, Path | None], *, force: bool = False, as_json: bool = False
) -> None:
    """Raise InputError for output files that cannot be written, before the work starts.

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
        If a file is used twice, has the ending of another format, exists or cannot be written.
    """
    given = {output: file for output, file in files.items() if file is not None}
    for output, file in given.items():
        flag = output.flag
        if is_standard_output(file):
            if output.kind != "text":
                what = "a picture" if output.kind == "picture" else "this file"
                raise InputError(
                    f"{flag} {file}: {what} is binary and cannot go to standard output; give a "
                    "file name"
                )
            if as_json:
                raise InputError(
                    f"--json and {flag} {file} both go to standard output; remove one, or give "
                    f"{flag} a file name"
                )
        else:
            if output.kind == "picture":
                check_format(file)
            known = ("", *output.endings)
            if output.endings and file.suffix.lower() not in known:
                raise InputError(f"{flag} {file}: the ending must be {' or '.join(output.endings)}")
            check_target(file)
            # an empty file, of mktemp for example, holds nothing to lose
            if not force and file.is_file() and file.stat().st_size:
                raise InputError(
                    f"{flag} {file} exists; give another name, or --force to replace it"
                )
    for (one, first), (other, second) in combinations(given.items(), 2):
        if same_file(first, second):
            raise InputError(
                f"{one.flag} {first} and {other.flag} {second} are the same file; give two "
                "different names"
            )


class Writing:
    """Writer of the output files of a command; continues with the others if one fails."""

    def __init__(self) -> None:
        self._failed = False
        self._reader_left: BrokenPipeError | None = None
        self._taken = False

    def __call__(self, done: str, file: Path | None, writer: Callable[[Target], None]) -> None:
        """Write a file if requested, and report success or failure on standard error."""
        if file is None:
            return
        goes_on = is_standard_output(file)
        self._taken |= goes_on
        try:
            writer(typer.get_binary_stream("stdout") if goes_on else file)
        except BrokenPipeError as error:
            self._reader_left = error
        except OSError as error:
            known = isinstance(error, NotWritten)
            words = error if known else f"cannot write to standard output: {error.strerror}"
            typer.echo(f"viscotack: {words}", err=True)
            self._failed = True
        else:
            if not goes_on:
                typer.echo(f"{done} {file}", err=True)

    def picture(self, file: Path | None, draw: Callable[[], "Figure"]) -> None:
        """Draw a figure and write it."""
        if file is not None:
            self("drew", file, lambda _: save_figure(draw(), file))

    def answer(self, text: str) -> None:
        """Print the answer; on standard error if a table is written to standard output."""
        try:
            typer.echo(harmless(text), err=self._taken)
        except BrokenPipeError:
            raise
        except OSError as error:
            name = "standard error" if self._taken else "standard output"
            raise InputError(f"cannot write to {name}: {error.strerror}") from None

    def end(self) -> None:
        """End the command with exit status 2 if a file could not be written."""
        if self._failed:
            raise typer.Exit(2)
        if self._reader_left is not None:
            # Typer ends the command silently
            raise self._reader_left
