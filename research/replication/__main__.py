"""Do again what others published about detachment, and say whether it holds.

Run it from the root of the checkout. Numbers of figures are kept in replication/kept, so that a
picture takes a second; --afresh makes them from nothing. For example, a figure, a claim, and all:

  python -m research.replication figure 4.6
  python -m research.replication claim alpha --afresh
  python -m research.replication --all
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter

from .archive import file_of
from .bench import Bench, picture
from .figures.catalogue import figures
from .figures.catalogue import named as figure_named
from .kept import Numbers, difference, kept, path_of, without_errors
from .ledger.claim import named
from .ledger.page import PAGE, page
from .ledger.page import ledger as whole_ledger
from .table import read_detachments

Given = argparse.Namespace


def contents(given: Given) -> None:
    """List the figures, or draw all there is and measure all claims."""
    if given.listed:
        print("\n\n".join(each.words() for each in figures().values()))
    if not given.all:
        if not given.listed:
            _parser().print_help()
        return
    began = perf_counter()
    with _bench(given) as bench:
        for name in figures():
            path = picture(name, bench.of(name), given.out)
            beside = f", {_beside(bench, name, kept(name))}" if given.afresh else ""
            print(f"{path}{beside}")
        if given.afresh and given.archive is not None:
            _published(given)
        _write_ledger(whole_ledger(bench.of), given.out)
        print(f"{given.out / 'ledger.md'}: every verdict stands")
        spent = sum(bench.spent.values()) if given.afresh else bench.seconds
    print(f"{perf_counter() - began:.0f} s by the clock, {spent:.0f} s of processor time")


def figure(given: Given) -> None:
    """Draw a figure or a table, and say what it claims, needs and costs."""
    name = given.name
    with _bench(given) as bench:
        drawn = figure_named(name)
        before = kept(name) if path_of(name).exists() else None
        path = picture(name, bench.of(name), given.out)
        print(drawn.words())
    if given.afresh and before is not None:
        print(f"  Beside the numbers that were kept: {_beside(bench, name, before)}")
    print(f"wrote {path}")


def claim(given: Given) -> None:
    """Measure a claim of the ledger, and say whether its verdict stands."""
    with _bench(given) as bench:
        one = named(given.name)
        found, standing = one.judged(bench.of)
        print(f"{one.says} ({one.place})")
        print(f"  thesis: {one.thesis}\n  here: {found.words}")
        print(f"  {one.verdict}, {standing}: {one.evidence}")


def ledger(given: Given) -> None:
    """Measure all claims from theory and kept numbers, and say what became of them."""
    text = whole_ledger(kept)
    if given.write:
        PAGE.write_text(page(kept), encoding="utf-8", newline="")
        _write_ledger(text, given.out)
    print(f"wrote {PAGE} and {given.out / 'ledger.md'}" if given.write else text)


def gallery(_: Given) -> None:
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
    print(f"wrote {folder}")


def _bench(given: Given) -> Bench:
    store = getattr(given, "keep", False)
    options = {"afresh": given.afresh, "store": store, "archive": given.archive}
    return Bench(given.workers, **options, say=_progress)


def _write_ledger(text: str, out: Path) -> None:
    out.mkdir(parents=True, exist_ok=True)
    (out / "ledger.md").write_text(text, encoding="utf-8", newline="")


def _published(given: Given) -> None:
    """Simulate all rows of the authors' table, and compare their page with the kept one."""
    # needs the extra `campaign`
    from .published import page as published
    from .published.compare import compare

    _progress("the published table ...")
    began = perf_counter()
    table = read_detachments(file_of(given.archive, "comb_1to9.csv"))
    rows = compare(table, given.out / "published", workers=given.workers)
    lines = published.changed(rows, Path(published.__file__).with_name("README.md").read_text())
    time = sum(row[x]["wall_time_s"] for row in rows for x in ("ours", "best") if x in row)
    print(
        f"the published table: {len(rows):,} rows, {time:.0f} s in the workers, "
        f"{perf_counter() - began:.0f} s by the clock, {len(lines)} lines of its page differ"
    )
    print("".join(f"  {line}\n" for line in lines), end="")


def _beside(bench: Bench, name: str, before: Numbers) -> str:
    """Return how far numbers made now are from those that were kept, and which most."""
    now, before = without_errors(bench.of(name)), without_errors(before)
    off = difference(now, before)
    if off == float("inf"):
        return "of another kind"
    most = max(now, key=lambda key: difference(now[key], before[key])) if off else ""
    return f"they differ by {off:.1e} at most{f', in {most!r}' if most else ''}"


def _progress(words: str) -> None:
    print(words, file=sys.stderr)


def _parser() -> argparse.ArgumentParser:
    out = argparse.ArgumentParser(add_help=False)
    out.add_argument("--out", type=Path, default=Path("out/replication"), help="folder of results")
    made = argparse.ArgumentParser(add_help=False, parents=[out])
    made.add_argument("--afresh", action="store_true", help="make the numbers again")
    made.add_argument("--workers", type=int, default=2, help="processes")
    made.add_argument("--archive", type=Path, help="checkout of the authors' public archive")
    kind = argparse.RawDescriptionHelpFormatter
    name = "python -m research.replication"
    parser = argparse.ArgumentParser(
        prog=name, description=__doc__, formatter_class=kind, parents=[made]
    )
    parser.add_argument("--list", action="store_true", dest="listed", help="figures and their cost")
    parser.add_argument("--all", action="store_true", help="every figure, table and claim")
    parser.set_defaults(run=contents)
    rooms = parser.add_subparsers(metavar="COMMAND")
    for run, parent in ((figure, made), (claim, made), (ledger, out), (gallery, out)):
        room = rooms.add_parser(run.__name__, help=run.__doc__, parents=[parent])
        room.set_defaults(run=run)
        if run in (figure, claim):
            room.add_argument("name", help="4.6, table-5.1, A.3; of a claim as the ledger has it")
        if run is figure:
            room.add_argument("--keep", action="store_true", help="keep what is made afresh")
        if run is ledger:
            room.add_argument("--write", action="store_true", help="write it and its summary")
    return parser


def main(words: Sequence[str] | None = None) -> None:
    """Run a command; what is wrong with its input is said on standard error."""
    parser = _parser()
    given = parser.parse_args(words)
    try:
        given.run(given)
    except (ValueError, OSError, ModuleNotFoundError) as error:
        parser.error(str(error))


if __name__ == "__main__":
    main()
