"""What others published, done again: ``python -m replication --list``, ``figure``, ``claim``."""

from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer
from typer import Option

from .bench import Hands
from .contents import CONTENTS
from .figures.catalogue import Figure, figures
from .kept import difference, kept, path_of
from .making import Maker, picture
from .words import application, wrong_input

app = application()

_OUT = Path("out/replication")
_Afresh = Annotated[
    bool, Option("--afresh", help="Make the numbers again instead of taking those that are kept.")
]
_Workers = Annotated[
    int, Option("--workers", metavar="N", min=1, help="Processes of this machine.")
]
_Folder = Annotated[
    Path, Option("--out", metavar="DIR", help="Folder of the pictures; made if missing.")
]


@app.callback(invoke_without_command=True, no_args_is_help=True)
def contents(
    context: typer.Context,
    listed: Annotated[
        bool, Option("--list", help="Each part: its command, what it says, how long it takes.")
    ] = False,
    every: Annotated[
        bool, Option("--all", help="Every figure and table, and the ledger of claims.")
    ] = False,
    afresh: _Afresh = False,
    workers: _Workers = 2,
    out: _Folder = _OUT,
) -> None:
    """Do again what others published about detachment, and say whether it holds.

    Run it from the root of the checkout. Numbers of figures are kept in replication/kept, so that
    a picture takes a second; --afresh makes them from nothing.

    Example: python -m replication figure 4.6
    """
    if listed:
        parts = [part.words() for part in CONTENTS]
        typer.echo("\n\n".join([*parts, *(each.words() for each in figures())]))
    if every:
        _all(afresh, workers, out)


@app.command(no_args_is_help=True)
def figure(
    name: Annotated[str, typer.Argument(help="Number in the thesis: 4.6, table-5.1, A.3.")],
    afresh: _Afresh = False,
    keep: Annotated[
        bool, Option("--keep", help="Keep what was made afresh in the repository.")
    ] = False,
    workers: _Workers = 2,
    out: _Folder = _OUT,
    svg: Annotated[bool, Option("--svg", help="SVG instead of PNG.")] = False,
) -> None:
    """Draw a figure or a table, and say what it claims, needs and costs.

    Example: python -m replication figure 4.6 --afresh
    """
    with wrong_input(), Hands(workers) as hands:
        said = Figure(name).words()
        before = kept(name) if path_of(name).exists() else None
        maker = Maker(hands, afresh=afresh, store=keep, say=_progress)
        path = picture(name, maker.of(name), out, ending="svg" if svg else "png")
    typer.echo(said)
    if afresh and before is not None:
        typer.echo(
            f"  Numbers made now beside those that were kept: {_beside(maker, name, before)}"
        )
    typer.echo(f"wrote {path}")


def _all(afresh: bool, workers: int, out: Path) -> None:
    """Draw all there is."""
    began = perf_counter()
    with wrong_input(), Hands(workers) as hands:
        maker = Maker(hands, afresh=afresh, say=_progress)
        for each in figures():
            path = picture(each.name, maker.of(each.name), out)
            words = f", {_beside(maker, each.name, kept(each.name))}" if afresh else ""
            typer.echo(f"{path}{words}")
        spent = hands.seconds
    typer.echo(f"{perf_counter() - began:.0f} s by the clock, {spent:.0f} s of processor time")


def _beside(maker: Maker, name: str, before: dict[str, object]) -> str:
    """Return how far numbers made now are from those that were kept."""
    off = difference(maker.of(name), before)
    return "of another kind" if off == float("inf") else f"they differ by {off:.1e} at most"


def _progress(words: str) -> None:
    typer.echo(words, err=True)


if __name__ == "__main__":
    app(prog_name="python -m replication")
