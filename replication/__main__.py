"""What there is to replicate: ``python -m replication --list``."""

from typing import Annotated

import typer
from typer import Option

from .contents import CONTENTS
from .words import application

app = application()


@app.command(no_args_is_help=True)
def contents(
    listed: Annotated[
        bool, Option("--list", help="Each part: its command, what it says, how long it takes.")
    ] = False,
) -> None:
    """Do again what others published about detachment, and say whether it holds.

    Each part has a command of its own; run them from the root of the checkout.

    Example: python -m replication --list
    """
    if listed:
        typer.echo("\n\n".join(part.words() for part in CONTENTS))


if __name__ == "__main__":
    app(prog_name="python -m replication")
