"""Exit statuses of real processes under load: ``python benchmarks/exits.py [--verify 300]``.

Runs ``campaign verify`` on an intact folder 300 times and every other command 50 times, beside
processes that keep all cores busy, and counts the exit statuses. It ends with 1 if one differs from
that of its command: threads that a library leaves running abort a process at its end.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import shlex
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

# Commands and their exit statuses.
VERIFY = "campaign verify c"
COMMANDS = {
    VERIFY: 0,
    "campaign status c": 0,
    "campaign export c --csv -": 0,
    "campaign plan plan.toml": 0,
    "campaign run plan.toml --out c": 0,
    "predict sphere --tabor 1 --modulus-ratio 0.1 --exponent 0.6 --preload 1 --rate 10": 0,
    "simulate sphere --tabor 1 --modulus-ratio 0.1 --exponent 0.6 --preload 1 --rate 10"
    " --accuracy 0.02 --until pull-off": 0,
    "simulate sphere --tabor -1": 2,
    "theory maugis --tabor 1": 0,
    "material list": 0,
    "material show pdms-10-1": 0,
    "show missing.npz": 2,
    "schema": 0,
}
PLAN = """[[grid]]
tabor = 1.0
modulus_ratio = 0.1
exponent = [0.4, 0.8]
preload = 5.0
rate = [1.0, 10.0]
"""


def busy() -> None:
    """Keep a core busy."""
    while True:
        sum(range(100_000))


def statuses(command: str, runs: int, folder: Path) -> tuple[Counter[int], str]:
    """Run a command, and count its exit statuses; return the last words of a wrong one, too."""
    found: Counter[int] = Counter()
    said = ""
    for _ in range(runs):
        told = subprocess.run(
            [sys.executable, "-m", "viscotack", *shlex.split(command)],
            cwd=folder,
            capture_output=True,
            text=True,
        )
        found[told.returncode] += 1
        said = told.stderr[-300:] if told.returncode != COMMANDS[command] else said
    return found, said


def main() -> int:
    """Return 1 if a status is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--verify", type=int, default=300, help="runs of campaign verify")
    parser.add_argument("--others", type=int, default=50, help="runs of each other command")
    parser.add_argument("--load", type=int, default=os.cpu_count() or 1, help="busy processes")
    asked = parser.parse_args()
    load = [multiprocessing.Process(target=busy, daemon=True) for _ in range(asked.load)]
    wrong = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        (folder / "plan.toml").write_text(PLAN, encoding="utf-8")
        run = [sys.executable, "-m", "viscotack", "campaign", "run", "plan.toml", "--out"]
        subprocess.run([*run, "c"], cwd=folder, check=True, capture_output=True)
        for process in load:
            process.start()
        for command, status in COMMANDS.items():
            runs = asked.verify if command == VERIFY else asked.others
            found, said = statuses(command, runs, folder)
            bad = runs - found[status]
            wrong += bad
            print(f"{bad or 'none'} of {runs} wrong: {command}: {dict(found)} {said}", flush=True)
        for process in load:
            process.terminate()
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
