"""The command line: ``viscotack simulate sphere ...``. Words in, words and pictures out."""

import sys
from collections.abc import Sequence
from functools import lru_cache
from typing import Any


@lru_cache(maxsize=1)
def application() -> Any:
    """Return the application with all its commands.

    The command-line library is imported only here, because its import is slow; ``import viscotack``
    does not import it.
    """
    from . import page  # noqa: F401  # adds its command
    from .commands import add_commands, application

    add_commands()
    return application


@lru_cache(maxsize=1)
def command() -> Any:
    """Return the command that the library of the command line makes of the application."""
    from typer.main import get_command

    return get_command(application())


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line with these arguments, or with those of the process."""
    try:
        command()(None if arguments is None else list(arguments), prog_name="viscotack")
    except KeyboardInterrupt:  # while modules load; Typer handles a later one, with the same status
        sys.exit(130)
