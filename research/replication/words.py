"""What the commands of this folder share: an application, and input that is refused in words."""

from collections.abc import Iterator
from contextlib import contextmanager

import typer


def application() -> typer.Typer:
    """Return an application without commands."""
    return typer.Typer(
        add_completion=False,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
        context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    )


@contextmanager
def wrong_input() -> Iterator[None]:
    """Turn what is wrong with the input into a sentence on standard error and exit status 2."""
    try:
        yield
    except (ValueError, OSError, ModuleNotFoundError) as error:
        typer.echo(f"replication: {error}", err=True)
        raise typer.Exit(2) from None
