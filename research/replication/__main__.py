"""What others published, done again: ``python -m research.replication --list``, ``figure``."""

from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer
from typer import Option

from .archive import file_of
from .bench import Bench, picture
from .figures.catalogue import figures
from .figures.catalogue import named as figure_named
from .kept import Numbers, difference, kept, path_of, without_errors
from .ledger.claim import named
from .ledger.page import PAGE, page
from .ledger.page import ledger as whole_ledger
from .table import read_detachments
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
_Archive = Annotated[
    Path | None,
    Option(
        "--archive",
        metavar="DIR",
        help="A checkout of the authors' public archive, for what is made of its rows.",
        show_default=False,
    ),
]


@app.callback(invoke_without_command=True, no_args_is_help=True)
def contents(
    listed: Annotated[
        bool, Option("--list", help="Each figure: what it claims, needs and costs.")
    ] = False,
    every: Annotated[
        bool, Option("--all", help="Every figure and table, and the ledger of claims.")
    ] = False,
    afresh: _Afresh = False,
    workers: _Workers = 2,
    out: _Folder = _OUT,
    archive: _Archive = None,
) -> None:
    """Do again what others published about detachment, and say whether it holds.

    Run it from the root of the checkout. Numbers of figures are kept in replication/kept, so that
    a picture takes a second; --afresh makes them from nothing.

    Example: python -m research.replication figure 4.6
    """
    if listed:
        typer.echo("\n\n".join(each.words() for each in figures().values()))
    if every:
        with wrong_input():
            _all(afresh, workers, out, archive)


@app.command(no_args_is_help=True)
def figure(
    name: Annotated[str, typer.Argument(help="Number in the thesis: 4.6, table-5.1, A.3.")],
    afresh: _Afresh = False,
    keep: Annotated[
        bool, Option("--keep", help="Keep what is made afresh in the repository.")
    ] = False,
    workers: _Workers = 2,
    out: _Folder = _OUT,
    svg: Annotated[bool, Option("--svg", help="SVG instead of PNG.")] = False,
    archive: _Archive = None,
) -> None:
    """Draw a figure or a table, and say what it claims, needs and costs.

    Example: python -m research.replication figure 4.6 --afresh
    """
    options = {"afresh": afresh, "store": keep, "archive": archive, "say": _progress}
    with wrong_input(), Bench(workers, **options) as bench:
        drawn = figure_named(name)
        before = kept(name) if path_of(name).exists() else None
        path = picture(name, bench.of(name), out, ending="svg" if svg else "png")
        typer.echo(drawn.words())
    if afresh and before is not None:
        typer.echo(f"  Beside the numbers that were kept: {_beside(bench, name, before)}")
    typer.echo(f"wrote {path}")


@app.command(no_args_is_help=True)
def claim(
    name: Annotated[str, typer.Argument(help="As the ledger has it: alpha, reduction.")],
    afresh: _Afresh = False,
    workers: _Workers = 2,
    archive: _Archive = None,
) -> None:
    """Measure a claim of the ledger, and say whether its verdict stands.

    Example: python -m research.replication claim alpha --afresh
    """
    with wrong_input(), Bench(workers, afresh=afresh, archive=archive, say=_progress) as bench:
        one = named(name)
        found, standing = one.judged(bench.of)
        typer.echo(f"{one.says} ({one.place})")
        typer.echo(f"  thesis: {one.thesis}\n  here: {found.said()}")
        typer.echo(f"  {one.verdict}, {standing}: {one.evidence}")


@app.command()
def ledger(
    written: Annotated[
        bool, Option("--write", help="Write it and docs/replication.md instead of printing it.")
    ] = False,
    out: _Folder = _OUT,
) -> None:
    """Measure all claims from theory and kept numbers, and say what became of them.

    Example: python -m research.replication ledger --write
    """
    with wrong_input():
        text = whole_ledger(kept)
        if written:
            PAGE.write_text(page(kept), encoding="utf-8", newline="")
            _write_ledger(text, out)
    typer.echo(f"wrote {PAGE} and {out / 'ledger.md'}" if written else text)


def _write_ledger(text: str, out: Path) -> None:
    out.mkdir(parents=True, exist_ok=True)
    (out / "ledger.md").write_text(text, encoding="utf-8", newline="")


@app.command()
def gallery() -> None:
    """Write the pictures of research/replication/gallery from the kept numbers."""
    from PIL import Image

    folder = Path(__file__).with_name("gallery")
    for name in figures():
        path = picture(name, kept(name), folder, dpi=64)
        with Image.open(path) as drawn:
            # the 256 colours that lines and words need
            few = drawn.convert("RGB").quantize(
                256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE
            )
        few.save(path, optimize=True)
    typer.echo(f"wrote {folder}")


def _all(afresh: bool, workers: int, out: Path, archive: Path | None) -> None:
    """Draw all there is, and measure all claims."""
    began = perf_counter()
    with Bench(workers, afresh=afresh, archive=archive, say=_progress) as bench:
        for name in figures():
            path = picture(name, bench.of(name), out)
            beside = f", {_beside(bench, name, kept(name))}" if afresh else ""
            typer.echo(f"{path}{beside}")
        if afresh and archive is not None:
            _published(archive, out, workers)
        _write_ledger(whole_ledger(bench.of), out)
        typer.echo(f"{out / 'ledger.md'}: every verdict stands")
        spent = sum(bench.spent.values()) if afresh else bench.seconds
    typer.echo(f"{perf_counter() - began:.0f} s by the clock, {spent:.0f} s of processor time")


def _published(archive: Path, out: Path, workers: int) -> None:
    """Simulate all rows of the authors' table, and compare their page with the kept one."""
    # needs the extra `campaign`
    from .published import page as published
    from .published.compare import compare

    _progress("the published table ...")
    began = perf_counter()
    table = read_detachments(file_of(archive, "comb_1to9.csv"))
    rows = compare(table, out / "published", workers=workers)
    lines = published.changed(rows, Path(published.__file__).with_name("README.md").read_text())
    time = sum(row[x]["wall_time_s"] for row in rows for x in ("ours", "best") if x in row)
    typer.echo(
        f"the published table: {len(rows):,} rows, {time:.0f} s in the workers, "
        f"{perf_counter() - began:.0f} s by the clock, {len(lines)} lines of its page differ"
    )
    typer.echo("".join(f"  {line}\n" for line in lines), nl=False)


def _beside(bench: Bench, name: str, before: Numbers) -> str:
    """Return how far numbers made now are from those that were kept, and which most."""
    now, before = without_errors(bench.of(name)), without_errors(before)
    off = difference(now, before)
    if off == float("inf"):
        return "of another kind"
    most = max(now, key=lambda key: difference(now[key], before[key])) if off else ""
    return f"they differ by {off:.1e} at most{f', in {most!r}' if most else ''}"


def _progress(words: str) -> None:
    typer.echo(words, err=True)


if __name__ == "__main__":
    app(prog_name="python -m research.replication")
