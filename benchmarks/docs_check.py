"""Compare the pages with what their commands print, and their numbers with records of benchmarks.

With --write the pages are renewed; --count counts the numbers of their prose by source, and --list
prints results without one.

A session is a `viscotack` command behind `$ ` in a console block, and the lines below it. Numbers
agree to one unit of their last stated digit; a line `...` stands for any lines. A command without
lines below it is only run, by tests/test_readme.py. How a number names its source says
`records.py`, beside this file.
"""

import argparse
import itertools
import os
import re
import shlex
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(Path(__file__).parent))
import records  # noqa: E402

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
# Written whole by a command. Tests compare the first two, and this file the third; the last needs
# checkouts of public repositories: `public_files.py FOLDER... --compare docs/public-files.md`.
WHOLE = ("replication.md", "gallery.md", "verification.md", "public-files.md")
# Half a minute each, and what needs their files.
SLOW = ("viscotack identify rates", "viscotack forecast", "viscotack report")
# What another processor may change, relative.
PROCESSORS = 1e-5
_SECONDS = re.compile(r" in \d+\.\d+ s\b")
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


@dataclass(frozen=True)
class Session:
    """A command of a page, and the lines that the page shows below it."""

    command: str
    shown: tuple[str, ...]


def stage(folder: Path) -> None:
    """Fill a folder so that it looks like the checkout to the commands of the pages."""
    shutil.copytree(ROOT / "examples", folder / "examples")
    shutil.copy(ROOT / "examples/from_toml/lens.toml", folder)


def sessions(text: str) -> Iterator[Session]:
    """Sessions of a page, in order."""
    for block in re.findall(r"```console\n(.*?)```", text, re.DOTALL):
        for part in re.split(r"(?m)^\$ ", block)[1:]:
            command, *shown = part.rstrip("\n").split("\n")
            if shown and command.startswith("viscotack "):
                yield Session(command, tuple(shown))


def printed(command: str) -> list[str]:
    """Lines that a `viscotack` command prints, its messages included."""
    from typer.testing import CliRunner

    from viscotack.app.cli import application

    done = CliRunner().invoke(application(), shlex.split(command)[1:])
    if done.exit_code:
        raise RuntimeError(f"{command}\n{done.output}")
    return [line.rstrip() for line in done.output.rstrip("\n").split("\n")]


def agrees(shown: str, found: str) -> bool:
    """Whether two lines have the same words, and numbers that agree to the digits shown."""
    if NUMBER.sub("#", shown).split() != NUMBER.sub("#", found).split():
        return False
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(found), strict=True)
    return all(
        abs(float(a) - float(b)) <= max(_unit(a), PROCESSORS * abs(float(a))) for a, b in pairs
    )


def _unit(number: str) -> float:
    """One unit of the last digit; 0 for a whole number, which is a count."""
    digits, _, power = number.partition("e")
    decimals = len(digits.partition(".")[2])
    return 1.001 * 10.0 ** (int(power or 0) - decimals) if decimals or power else 0.0


def difference(session: Session, found: list[str]) -> str:
    """First line in which a session differs from what was printed; "" for none."""
    before, cut, after = _cut(session.shown)
    rest = len(found) - len(before) - len(after)
    if rest < 0 or (rest and not cut):
        return f"{len(session.shown)} lines shown, {len(found)} printed"
    pairs = [*zip(before, found), *zip(after, found[len(found) - len(after) :])]  # noqa: B905
    wrong = [pair for pair in pairs if not agrees(*pair)]
    return f"shown:   {wrong[0][0]}\n  printed: {wrong[0][1]}" if wrong else ""


def _cut(shown: tuple[str, ...]) -> tuple[tuple[str, ...], bool, tuple[str, ...]]:
    if "..." not in shown:
        return shown, False, ()
    place = shown.index("...")
    return shown[:place], True, shown[place + 1 :]


def apart(shown: str, found: str) -> list[tuple[str, str]]:
    """Return the lines in which two pages differ by more than the processor time of a run."""
    pairs = itertools.zip_longest(shown.splitlines(), found.splitlines(), fillvalue="")
    return [pair for pair in pairs if not agrees(*(_SECONDS.sub("", line) for line in pair))]


def stale(page: Path, slow: bool = True) -> dict[Session, list[str]]:
    """Sessions of a page that differ from what their commands print now, with these lines."""
    found = {}
    for session in sessions(page.read_text("utf-8")):
        if slow or not session.command.startswith(SLOW):
            lines = printed(session.command)
            if difference(session, lines):
                found[session] = lines
    return found


def renewed(text: str, found: dict[Session, list[str]]) -> str:
    """Page with the lines of stale sessions replaced; what `...` stood for stays left out."""
    for session, lines in found.items():
        before, cut, after = _cut(session.shown)
        fresh = [*lines[: len(before)], "...", *lines[len(lines) - len(after) :]] if cut else lines
        old, new = ("\n".join((f"$ {session.command}", *x)) + "\n" for x in (session.shown, fresh))
        text = text.replace(old, new)
    return text


def counts(pages: list[Path]) -> str:
    """Return a table of the numbers in the prose of pages, by what they come from."""
    lines, total = [], Counter[str]()
    for page in pages:
        found = Counter(records.count(page.read_text("utf-8")))
        if page.name in WHOLE:
            found = Counter(written=found.total())
        found["all"] = found.total()
        total += found
        lines.append(_row(page.name, found))
    head = f"{'page':24s}" + "".join(f"{x:>10s}" for x in _KINDS)
    return "\n".join([head, *lines, _row("all pages", total)])


def sourceless(page: Path) -> list[str]:
    """Return the results of a page that name no source, with their lines."""
    if page.name in WHOLE:
        return []
    found = records.kinds(page.read_text("utf-8"))
    return [f"{page.name}:{line}: {x}" for line, x, kind in found if kind == "no source"]


_KINDS = ("all", records.GIVEN, "written", "measured", "as stated", "no source")


def _row(name: str, found: Counter[str]) -> str:
    return f"{name:24s}" + "".join(f"{found[x]:10d}" for x in _KINDS)


def main() -> int:
    """Check, or renew, the sessions of all pages or of those named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pages", nargs="*", type=Path, help="pages; all by default")
    parser.add_argument("--write", action="store_true", help="renew the pages")
    parser.add_argument("--count", action="store_true", help="count the numbers of the prose")
    parser.add_argument("--list", action="store_true", help="print results that name no source")
    parser.add_argument(
        "--quote",
        action="store_true",
        help="record marked blocks that no record has, as stated",
    )
    given = parser.parse_args()
    pages = [path.resolve() for path in given.pages] or PAGES
    if given.count:
        print(counts(pages))
        return 0
    if given.list:
        print("\n".join(line for page in pages for line in sourceless(page)))
        return 0
    if given.quote:
        print("\n".join(source for page in pages for source in records.quoted(page)))
        return 0
    wrong = 0
    for page in pages:
        text = page.read_text("utf-8")
        for quote in records.quotes(text):
            if not quote.agrees:
                wrong += 1
                print(f"{page.name}: {quote.source}\n  {quote.difference}", flush=True)
        if given.write:
            page.write_text(records.renewed(text), "utf-8")
        with tempfile.TemporaryDirectory() as folder:
            stage(Path(folder))
            os.chdir(folder)
            found = stale(page)
            os.chdir(ROOT)
        wrong += len(found)
        for session, lines in found.items():
            print(f"{page.name}: {session.command}\n  {difference(session, lines)}", flush=True)
        if page.name == "verification.md":
            from cases import SAMPLE
            from verification import ROWS, measured_page

            measured = measured_page(SAMPLE, ROWS)
            lines = apart(page.read_text("utf-8"), measured)
            wrong += len(lines)
            print("\n".join(f"{page.name}:\n  {a}\n  {b}" for a, b in lines))
            if given.write and lines:
                page.write_text(measured, "utf-8")
        if given.write and found:
            page.write_text(renewed(page.read_text("utf-8"), found), "utf-8")
    print(f"{wrong} stale sessions and numbers")
    return 1 if wrong and not given.write else 0


if __name__ == "__main__":
    sys.exit(main())
