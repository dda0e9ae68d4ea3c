"""Compare the pages with what their commands print; with --write renew the pages.

A session is a `viscotack` command behind `$ ` in a console block, and the lines below it. Numbers
agree to one unit of their last stated digit; a line `...` stands for any lines. A command without
lines below it is only run, by tests/test_readme.py.
"""

import argparse
import os
import re
import shlex
import shutil
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
# Half a minute each, and what needs their files.
SLOW = ("viscotack identify rates", "viscotack forecast", "viscotack report")
# What another processor may change, relative.
PROCESSORS = 1e-5
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


def main() -> int:
    """Check, or renew, the sessions of all pages or of those named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pages", nargs="*", type=Path, help="pages; all by default")
    parser.add_argument("--write", action="store_true", help="renew the pages")
    given = parser.parse_args()
    wrong = 0
    for page in [path.resolve() for path in given.pages] or PAGES:
        with tempfile.TemporaryDirectory() as folder:
            stage(Path(folder))
            os.chdir(folder)
            found = stale(page)
            os.chdir(ROOT)
        wrong += len(found)
        for session, lines in found.items():
            print(f"{page.name}: {session.command}\n  {difference(session, lines)}", flush=True)
        if given.write and found:
            page.write_text(renewed(page.read_text("utf-8"), found), "utf-8")
    print(f"{wrong} stale sessions")
    return 1 if wrong and not given.write else 0


if __name__ == "__main__":
    sys.exit(main())
