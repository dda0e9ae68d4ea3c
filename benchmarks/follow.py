"""Follow the pages as a stranger does: each command after its own install line.

    python -m release && python benchmarks/follow.py [--extra lab] [PAGE ...]

A page begins in an environment with the package alone, installed from the release folder; below a
line that installs `viscotack[EXTRA]` or `.[EXTRA]` its commands run with that extra. Commands of
`viscotack` and Python are run, in order, in a folder with the examples; what needs a checkout, a
server or a cluster is not. Simulations are coarse without --exact. Where uv is installed, it
installs.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import venv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from docs_check import PAGES, ROOT, stage

BLOCK = re.compile(r"```(console|sh|python)\n(.*?)```", re.DOTALL)
INSTALL = re.compile(r"pip install [^\n]*?(?:viscotack|\.)\[([\w,]+)\]")
# What a folder with the examples and an installed package do not have.
ELSEWHERE = re.compile(r"viscotack app|tcp://|tls://|localhost|benchmarks|replication|training")
COARSE = ["--until", "pull-off", "--accuracy", "1e-2"]


@dataclass(frozen=True)
class Step:
    """A command, or Python, with the extra whose install line stands above it."""

    extra: str
    text: str
    python: bool = False


def steps(page: str) -> Iterator[Step]:
    """Iterate over the steps of a page, in order."""
    extra, place = "", 0
    for block in BLOCK.finditer(page):
        for line in INSTALL.findall(page[place : block.start()]):
            extra = line
        place = block.end()
        kind, text = block.groups()
        if kind == "python":
            yield Step(extra, text, True)
            continue
        for line in text.splitlines():
            if found := INSTALL.search(line):
                extra = found[1]
            command = line.removeprefix("$ ")
            if command.startswith(("viscotack ", "python -m viscotack")):
                yield Step(extra, command)


def environment(folder: Path, release: Path, extra: str) -> Path:
    """Install the package of a release folder with an extra; returns the programs."""
    uv, programs = shutil.which("uv"), folder / "bin"
    venv.create(folder, with_pip=not uv)
    python = programs / "python"
    pip = [uv, "pip", "install", "--python", python] if uv else [python, "-m", "pip", "install"]
    name = f"viscotack[{extra}]" if extra else "viscotack"
    install = [*pip, "--quiet", "--find-links", release, name]
    subprocess.run(install, check=True, stderr=subprocess.DEVNULL)
    return programs


def run(step: Step, programs: Path, folder: Path, exact: bool) -> str:
    """Run a step in a folder; return what went wrong, or nothing."""
    text = step.text
    if not exact and text.startswith("viscotack simulate ") and "--help" not in text:
        text += " " + " ".join(COARSE)
    command = [programs / "python", "-c", text] if step.python else ["sh", "-c", text]
    plain = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
    path = f"{programs}{os.pathsep}{os.environ['PATH']}"
    try:
        done = subprocess.run(
            command,
            cwd=folder,
            env=plain | {"PATH": path},
            capture_output=True,
            text=True,
            timeout=900,
        )
    except subprocess.TimeoutExpired:
        return "took more than 15 minutes"
    return "" if done.returncode == 0 else (done.stderr or done.stdout).strip()[-400:]


def main() -> int:
    """Follow the pages; print what fails, and count the steps by extra."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pages", nargs="*", type=Path, help="pages; all by default")
    parser.add_argument("--release", type=Path, default=ROOT / "out/release", help="its folder")
    parser.add_argument("--extra", action="append", help="only steps with it; '' for none")
    parser.add_argument("--exact", action="store_true", help="simulate as the pages state")
    given = parser.parse_args()
    failed, programs = 0, {}
    with tempfile.TemporaryDirectory() as place:
        for page in given.pages or PAGES:
            folder, began, count = Path(place) / "work" / page.stem, time.monotonic(), 0
            folder.mkdir(parents=True)
            stage(folder)
            for step in steps(page.read_text("utf-8")):
                if ELSEWHERE.search(step.text) or given.extra and step.extra not in given.extra:
                    continue
                if step.extra not in programs:
                    name = Path(place) / f"with {step.extra or 'nothing'}".replace(" ", "_")
                    programs[step.extra] = environment(name, given.release.resolve(), step.extra)
                wrong, count = run(step, programs[step.extra], folder, given.exact), count + 1
                if wrong:
                    failed += 1
                    print(f"{page.name} [{step.extra}]: {step.text.strip()[:200]}\n  {wrong}\n")
            if count:
                print(f"{page.name}: {count} steps, {time.monotonic() - began:.0f} s", flush=True)
    print(f"{failed} steps failed; extras: {', '.join(x or 'none' for x in programs)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
