"""Follow the pages as a stranger does: each command after its own install line.

    python -m release && python benchmarks/follow.py [--extra lab] [--work out/follow] [PAGE ...]

A page begins in an environment with the package alone, installed from the release folder; below a
line that installs `viscotack[EXTRA]` or `.[EXTRA]`, or names `the extra EXTRA`, its commands run
with that extra. Commands of `viscotack` and Python are run, in order, in a folder with the
examples and the files that the page says to save; the page of the browser is served meanwhile.
Steps that need a checkout, a cluster or long are printed with the reason. Simulations are coarse
without --exact. Where uv is installed, it installs.

With --work, environments and finished steps are kept, so that a second call runs what failed and
what is new. A whole pass writes the record `follow`.
"""

import argparse
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import venv
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.error import URLError
from urllib.request import urlopen

from docs_check import PAGES, ROOT, records, stage

BLOCK = re.compile(r"```(console|sh|python)\n(.*?)```", re.DOTALL)
INSTALL = re.compile(
    r"pip install [^\n]*?(?:viscotack|\.)\[([\w,]+)\]|the \[extra\]\([^)]*\)\s+`(\w+)`"
)
# Blocks that the page says to save in a file, which their first line or the line above them names.
SAVED = (
    re.compile(r"```(?:python|toml)\n# (\w+\.(?:py|toml))\n(.*?)```", re.DOTALL),
    re.compile(r"`(\w+\.json)`[^\n]*\n\n```json\n(.*?)```", re.DOTALL),
)
TYPED = ("viscotack ", "python -m viscotack", "python -m pip install ", "curl ")
SERVER = "localhost:8642"
# What a folder with the examples and an installed package do not have.
ELSEWHERE = {
    r"tcp://|tls://": "a cluster",
    r"pip install (-e|\S* ?FOLDER|.*viscotack)": "what this script installs itself",
    r"api/jobs/ID\b": "the name of a job",
    r"viscotack\.datasets \w": "twenty minutes of simulations",
    r"(?m)^(from|import) (benchmarks|replication|training)\b": "a checkout",
}
COARSE = ["--until", "pull-off", "--accuracy", "1e-2"]


@dataclass(frozen=True)
class Step:
    """A command, or Python, with the extra whose install line stands above it."""

    extra: str
    text: str
    python: bool = False

    @property
    def elsewhere(self) -> str:
        """What the step needs that is not at hand."""
        return next((why for words, why in ELSEWHERE.items() if re.search(words, self.text)), "")

    @property
    def serves(self) -> bool:
        """Whether the step runs until it is told to end."""
        return not self.python and self.text.startswith("viscotack app")

    @property
    def asks(self) -> bool:
        """Whether the step asks a server."""
        return SERVER in self.text


def steps(page: str) -> Iterator[Step]:
    """Iterate over the steps of a page, in order."""
    extra, place = "", 0
    for block in BLOCK.finditer(page):
        for line in INSTALL.finditer(page[place : block.start()]):
            extra = line[1] or line[2]
        place = block.end()
        kind, text = block.groups()
        if kind == "python":
            yield Step(extra, text, True)
            continue
        for line in text.splitlines():
            if found := INSTALL.search(line):
                extra = found[1]
            command = line.removeprefix("$ ")
            if command.startswith(TYPED) and not found:
                yield Step(extra, command)


def save(page: str, folder: Path) -> None:
    """Save the blocks whose first line names a file."""
    for kind in SAVED:
        for found in kind.finditer(page):
            (folder / found[1]).write_text(found[2], "utf-8")


def environment(folder: Path, release: Path, extra: str) -> Path:
    """Install the package of a release folder with an extra; returns the programs."""
    uv, programs = shutil.which("uv"), folder / "bin"
    if (folder / "installed").exists():
        return programs
    venv.create(folder, with_pip=True, clear=True)
    python = programs / "python"
    pip = [uv, "pip", "install", "--python", python] if uv else [python, "-m", "pip", "install"]
    name = f"viscotack[{extra}]" if extra else "viscotack"
    install = [*pip, "--quiet", "--find-links", release, name]
    subprocess.run(install, check=True, env=surroundings(programs), stderr=subprocess.DEVNULL)
    (folder / "installed").touch()
    return programs


def surroundings(programs: Path) -> dict[str, str]:
    """Return the variables of a terminal in which an environment is active."""
    plain = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
    return plain | {"PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"}


def run(step: Step, programs: Path, folder: Path, exact: bool) -> str:
    """Run a step in a folder; return what went wrong, or nothing."""
    text = step.text
    if not exact and text.startswith("viscotack simulate ") and "--help" not in text:
        text += " " + " ".join(COARSE)
    if step.python:
        (folder / "step.py").write_text(text, "utf-8")
        text = "python step.py"
    text = text.replace("curl ", "curl --fail-with-body ", 1) if text.startswith("curl ") else text
    if step.serves:
        with served(text, programs, folder) as wrong:
            return wrong
    try:
        done = subprocess.run(
            ["sh", "-c", text],
            cwd=folder,
            env=surroundings(programs),
            capture_output=True,
            text=True,
            timeout=900,
        )
    except subprocess.TimeoutExpired:
        return "took more than 15 minutes"
    return "" if done.returncode == 0 else (done.stderr or done.stdout).strip()[-800:]


@contextmanager
def served(command: str, programs: Path, folder: Path) -> Iterator[str]:
    """Serve the page meanwhile; yields what went wrong, or nothing."""
    with (folder / "served.txt").open("w+", encoding="utf-8") as said:
        server = subprocess.Popen(
            ["sh", "-c", f"exec {command.removesuffix(' --no-browser')} --no-browser"],
            cwd=folder,
            env=surroundings(programs),
            stdout=said,
            stderr=said,
        )
        wrong, until = f"{SERVER} does not answer", time.monotonic() + 60
        while wrong and server.poll() is None and time.monotonic() < until:
            try:
                wrong = "" if b"<html" in urlopen(f"http://{SERVER}").read() else "there is no page"
            except URLError:
                time.sleep(0.2)
        try:
            yield wrong and f"{wrong}\n{(folder / 'served.txt').read_text('utf-8')[-400:]}"
        finally:
            server.send_signal(signal.SIGINT)
            server.wait(30)


def follow(pages: list[Path], given: argparse.Namespace, place: Path) -> list[dict[str, Any]]:
    """Run the steps of pages that are not done yet, and return what is known of all of them."""
    log, found, programs = place / "steps.jsonl", list[dict[str, Any]](), dict[str, Path]()
    lines = log.read_text("utf-8").splitlines() if log.exists() else []
    done = {(x["page"], x["extra"], x["text"]): x for x in map(json.loads, lines)}

    def ready(extra: str) -> Path:
        if extra not in programs:
            name = place / f"with_{extra.replace(',', '_') or 'nothing'}"
            programs[extra] = environment(name, given.release.resolve(), extra)
        return programs[extra]

    for page in pages:
        folder, text = place / "work" / page.stem, page.read_text("utf-8")
        if not folder.exists():
            folder.mkdir(parents=True)
            stage(folder)
            # other pages use the classes that this one writes
            save((ROOT / "docs/own.md").read_text("utf-8"), folder)
        save(text, folder)
        for step in steps(text):
            if given.extra and step.extra not in given.extra:
                continue
            key = {"page": page.name, "extra": step.extra, "text": step.text}
            row = key | {"seconds": 0.0, "wrong": "", "left out": step.elsewhere}
            before = done.get((page.name, step.extra, step.text))
            if before and not before["wrong"]:
                row = before
            elif not step.elsewhere:
                server = served("viscotack app", ready("app"), folder)
                server = server if step.asks else nullcontext()
                environs = ready(step.extra)
                began = time.monotonic()
                with server:
                    row["wrong"] = run(step, environs, folder, given.exact)
                row["seconds"] = round(time.monotonic() - began, 1)
                with log.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
            found.append(row)
            words = f"{page.name} [{step.extra}]: {step.text.strip()[:200]}"
            if row["left out"]:
                print(f"left out, needs {row['left out']}: {words}\n")
            if row["wrong"]:
                print(f"FAILED {words}\n  {row['wrong']}\n", flush=True)
        rows = [row for row in found if row["page"] == page.name and not row["left out"]]
        if rows:
            seconds = sum(row["seconds"] for row in rows)
            print(f"{page.name}: {len(rows)} steps, {seconds:.0f} s", flush=True)
    return found


def measured(found: list[dict[str, Any]]) -> dict[str, Any]:
    """Return what the record has: counts of all steps, and of those of each extra."""
    ran = [row for row in found if not row["left out"]]
    steps, failed = (
        Counter(row["extra"] or "none" for row in rows)
        for rows in (ran, [row for row in ran if row["wrong"]])
    )
    return {
        "pages": len({row["page"] for row in ran}),
        "steps": len(ran),
        "failed": failed.total(),
        "left_out": len(found) - len(ran),
        "seconds": sum(row["seconds"] for row in ran),
        "extras": {name: {"steps": steps[name], "failed": failed[name]} for name in steps},
    }


def main() -> int:
    """Follow the pages; print what fails, and count the steps by extra."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pages", nargs="*", type=Path, help="pages; all by default")
    parser.add_argument("--release", type=Path, default=ROOT / "out/release", help="its folder")
    parser.add_argument("--extra", action="append", help="only steps with it; '' for none")
    parser.add_argument("--exact", action="store_true", help="simulate as the pages state")
    parser.add_argument("--work", type=Path, help="keep environments and finished steps here")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        found = follow(given.pages or PAGES, given, (given.work or Path(place)).resolve())
    values = measured(found)
    print(json.dumps(values, indent=1))
    if not (given.pages or given.extra):
        records.write("follow", values)
    return 1 if values["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
