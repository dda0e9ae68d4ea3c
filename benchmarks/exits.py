"""Exit statuses of real processes under load: ``python benchmarks/exits.py [--log LOG]``.

Runs ``campaign verify`` on an intact folder 300 times and every other command 50 times, beside
processes that keep all cores busy, and counts the exit statuses. It ends with 1 if one differs from
that of its command: threads that a library leaves running abort a process at its end. With a log,
runs are added to those that it has, up to the numbers; a row has the load of the machine after its
runs, too. With ``--only`` the other commands run only if they write what others read.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import psutil

# Commands and their exit statuses; {run} numbers the runs of a command.
VERIFY = "campaign verify c"
GROUPS = "--tabor 1 --modulus-ratio 0.1 --exponent 0.6 --preload 50 --rate 100"
CRACK = "--modulus-ratio 0.1 --exponent 0.6 --speed 1"
JKR = "--radius 1mm --contact-modulus 1MPa --work-of-adhesion 50mJ/m^2"
LENS = "lens_1_um_s.csv lens_1000_um_s.csv"
COMMANDS = {
    VERIFY: 0,
    "campaign status c": 0,
    "campaign export c --csv -": 0,
    "campaign plan plan.toml": 0,
    "campaign inputs lens.toml": 0,
    "campaign merge c --out merged-{run}": 0,
    "campaign merge c --out c": 2,
    "campaign run plan.toml --out c": 0,
    "campaign run plan.toml --out new-{run}": 0,
    f"predict sphere {GROUPS}": 0,
    f"simulate sphere {GROUPS} --accuracy 0.02 --save lens.npz": 0,
    f"simulate sphere {GROUPS} --time-limit 1us": 2,
    "simulate sphere --tabor -1": 2,
    "show lens.npz": 0,
    "show missing.npz": 2,
    f"advise {GROUPS}": 0,
    "sweep lens.toml cases.csv --accuracy 0.02": 0,
    "study predict.toml": 0,
    "schema": 0,
    "material list": 0,
    "material show pdms-10-1": 0,
    "material convert pdms-10-1 --temperature 0degC": 0,
    "material export pdms-10-1 --to abaqus --bulk-modulus 2GPa": 0,
    "material fit pdms_dma.csv --poisson-ratio 0.5 --model sls --reference-temperature 20degC"
    " --glass-transition=-115degC": 0,
    "test read lens_1_um_s.csv": 0,
    "theory crack-contact --tabor 1e4 --modulus-ratio 0.1 --exponent 0.6 --preload 2e5"
    " --rate 1e3": 0,
    f"theory disc {JKR} --strength 50kPa": 0,
    f"theory greenwood {CRACK}": 0,
    f"theory jkr {JKR}": 0,
    "theory maugis --tabor 1": 0,
    f"theory persson-brener {CRACK}": 0,
    "theory punch pad.toml --stress 60kPa": 0,
    f"theory steady-crack {CRACK}": 0,
    "identify slow lens_slow.csv --radius 5.19mm --model jkr": 0,
    "window window.toml": 0,
    f"identify rates {LENS} --material pdms-10-1 --radius 5.19mm -o study.toml": 0,
    "forecast study.toml --speed 10um/s": 0,
    "report study.toml --speed 10um/s -o report.html": 0,
}
PLAN = """[[grid]]
tabor = 1.0
modulus_ratio = 0.1
exponent = [0.4, 0.8]
preload = 5.0
rate = [1.0, 10.0]
"""
WINDOW = {"1 um/s..10 mm/s": "10 um/s", '["200 uN", "1 mN", "5 mN"]': '"1 mN"'}


def prepare(folder: Path) -> None:
    """Write the files of the commands, those of the examples with less to compute."""
    examples = Path(__file__).parents[1] / "examples"
    for file in (*examples.glob("from_*/*.csv"), *examples.glob("from_toml/*.toml")):
        shutil.copy(file, folder)
    window = (examples / "window/kinetic_stamp.toml").read_text(encoding="utf-8")
    for long, short in WINDOW.items():
        window = window.replace(long, short)
    study = (examples / "studies/predict.toml").read_text(encoding="utf-8")
    texts = {
        "plan.toml": PLAN,
        "window.toml": window,
        "predict.toml": study.replace("../from_toml/", ""),
        "cases.csv": "protocol.speed\n0.0001\n",
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    run = [sys.executable, "-m", "viscotack", "campaign", "run", "plan.toml", "--out", "c"]
    subprocess.run(run, cwd=folder, check=True, capture_output=True)


def busy() -> None:
    """Keep a core busy until the parent has ended."""
    parent = os.getppid()
    while os.getppid() == parent:
        sum(range(100_000))


def statuses(command: str, runs: int, folder: Path) -> tuple[Counter[int], str]:
    """Run a command, and count its exit statuses; return the last words of a wrong one, too."""
    found: Counter[int] = Counter()
    said = ""
    for number in range(runs):
        words = shlex.split(command.format(run=number))
        told = subprocess.run(
            [sys.executable, "-m", "viscotack", *words],
            cwd=folder,
            capture_output=True,
            text=True,
        )
        found[told.returncode] += 1
        said = told.stderr[-300:] if told.returncode != COMMANDS[command] else said
    return found, said


def recorded(log: Path | None) -> Counter[str]:
    """Return how often each command was run, by a log."""
    done: Counter[str] = Counter()
    if log is not None and log.exists():
        for row in map(json.loads, log.read_text(encoding="utf-8").splitlines()):
            done[row["command"]] += row["runs"]
    return done


def main() -> int:
    """Return 1 if a status is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--verify", type=int, default=300, help="runs of campaign verify")
    parser.add_argument("--others", type=int, default=50, help="runs of each other command")
    parser.add_argument("--load", type=int, default=os.cpu_count() or 1, help="busy processes")
    parser.add_argument("--only", default="", help="regular expression of the commands' beginnings")
    parser.add_argument("--log", type=Path, help="a line for each command that was run")
    asked = parser.parse_args()
    done = recorded(asked.log)
    load = [multiprocessing.Process(target=busy, daemon=True) for _ in range(asked.load)]
    wrong = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        prepare(folder)
        for process in load:
            process.start()
        for command, status in COMMANDS.items():
            wanted = asked.verify if command == VERIFY else asked.others
            left = wanted - done[command] if re.match(asked.only, command) else 0
            # later commands read files that it writes
            runs = max(left, int(" --save " in command or " -o " in command))
            if not runs:
                continue
            found, said = statuses(command, runs, folder)
            bad = runs - found[status]
            wrong += bad
            if asked.log:
                with asked.log.open("a", encoding="utf-8") as log:
                    row = {"command": command, "runs": runs, "statuses": found}
                    row["load"] = psutil.getloadavg()[0]
                    print(json.dumps(row), file=log)
            print(f"{bad or 'none'} of {runs} wrong: {command}: {dict(found)} {said}", flush=True)
        for process in load:
            process.terminate()
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
