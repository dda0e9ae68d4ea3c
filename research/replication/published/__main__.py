"""The published table tested: ``python -m research.replication.published --table FILE``."""

from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from typer import Option

from viscotack import InputError

from ..table import SAMPLE, Detachments, read_detachments
from ..words import application, wrong_input
from .compare import compare
from .corrected import write_corrected
from .page import page, write

app = application()


@app.command()
def published(
    table: Annotated[
        Path,
        Option(
            "--table",
            metavar="FILE",
            help="The table that the authors of the thesis published (CSV); a sample of it if left "
            "out.",
            show_default=False,
        ),
    ] = SAMPLE,
    count: Annotated[
        int | None,
        Option("--count", metavar="N", min=1, help="So many rows at random; all if left out."),
    ] = None,
    seed: Annotated[int, Option("--seed", min=0, help="Of the draw.")] = 2026,
    out: Annotated[
        Path,
        Option("--out", metavar="DIR", help="Folder of the runs; they go on where they stopped."),
    ] = Path("out/published"),
    workers: Annotated[
        int, Option("--workers", metavar="N", min=1, help="Processes of this machine.")
    ] = 2,
    corrected: Annotated[
        Path | None,
        Option(
            "--corrected",
            metavar="FILE",
            help="Write the corrected table: the same inputs, both forces and works, our errors.",
        ),
    ] = None,
    written: Annotated[
        Path | None,
        Option(
            "--write",
            metavar="DIR",
            help="Write README.md and its pictures into a folder, instead of printing the page; "
            "for the complete table.",
        ),
    ] = None,
) -> None:
    """Simulate every row of the published table and say how far the two are apart.

    Where they are apart by more than 2 % a converged run decides. The whole table takes a quarter
    of an hour of processor time, the sample in tests/data, of 1,200 rows, a few minutes.

    Example: python -m research.replication.published --table rows.csv --count 1000
    """
    with wrong_input():
        if written is not None and table.resolve() == SAMPLE:
            raise InputError("--write is for the complete table: give its path by --table")
        rows = read_detachments(table)
    found = compare(drawn(rows, count, seed), out, workers=workers)
    if corrected is not None:
        write_corrected(found, read_detachments(SAMPLE), corrected)
    if written is None:
        typer.echo(page(found))
    else:
        write(found, written)


def drawn(rows: Detachments, count: int | None, seed: int) -> Detachments:
    """Return some rows at random; all of them, in their order, where no count is given."""
    if count is None:
        return rows
    some = min(count, len(rows))
    return rows.chosen(np.random.default_rng(seed).choice(len(rows), some, replace=False))


if __name__ == "__main__":
    app(prog_name="python -m research.replication.published")
