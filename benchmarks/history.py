"""What the package costs from version to version, in numbers that do not depend on the machine.

`python benchmarks/history.py` adds a line to `history.jsonl`: date, commit, processor, processor
times as ratios measured in the same minute, and the instructions of three answers, counted by
Valgrind (`apt-get install valgrind`; without it that part is left out). Five minutes. `--source
CHECKOUT/src --commit ID --date DAY` measures another version. `--check` compares the last line with
the one before and exits with 1 where a ratio rose by more than its share: 25 % of a time, 5 % of a
count. `--figure` draws `docs/history.png`.

A count is that of a process that answers a problem, less that of one which only imports the same
modules. It repeats to 1 % on one kind of processor; another takes other kernels of linear algebra.
"""

from __future__ import annotations

import os

for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")

import argparse  # noqa: E402
import json  # noqa: E402
import re  # noqa: E402
import shutil  # noqa: E402
import subprocess  # noqa: E402
import sys  # noqa: E402
import tempfile  # noqa: E402
from datetime import date  # noqa: E402
from pathlib import Path  # noqa: E402
from typing import Any  # noqa: E402

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import records  # noqa: E402
import start  # noqa: E402

HISTORY = HERE / "history.jsonl"
FIGURE = HERE.parent / "docs/history.png"
# By which share a ratio, or a count, may rise from one line to the next.
SHARES = {"times": 0.25, "instructions": 0.05}
# Statements that each process executes; the second element of a pair is what is counted.
_IMPORTS = """
import viscotack as vt
from viscotack import forecast
from viscotack.theory import steady
solid = vt.StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
sphere = vt.Groups(tabor=6.0, material=solid, start=vt.AtDepth(20.0), rate=30.0)
power = vt.RetardationPowerLaw(rubbery_modulus=1.0, glassy_modulus=10.0, exponent=0.8, tau0=1.0,
                               poisson_ratio=0.0)
known = vt.Groups(tabor=3.24, material=power, start=vt.AtDepth(73.0), rate=316.23)
punch = vt.Groups(tabor=None, cohesion=0.05, geometry=vt.FlatPunch(64.85), body=vt.Layer(3.24),
                  material=solid, start=vt.AtDepth(1.0), rate=10.0)
vt.solve(vt.Groups(tabor=0.3, material=solid, start=vt.AtDepth(1.0), rate=10.0), until="pull-off",
         accuracy=2e-2, estimate_error=False)
"""
ANSWERS = {
    "sphere": 'vt.solve(sphere, until="pull-off")',
    "punch": 'vt.solve(punch, until="pull-off")',
    "prediction": "vt.predict(known)",
}
# Plain twin of the solver, with as many equal nodes as give the same error: the unit of time.
_TIMES = """
from time import process_time
from speed import CASES, twin
def least(work, repeat=5):
    times = []
    for _ in range(repeat):
        began = process_time()
        work()
        times.append(process_time() - began)
    return min(times)
case, nodes, steps = CASES[0]
found = vt.solve(case, until="pull-off")
unit = least(lambda: twin(case, nodes, steps, vt.depth_at_pull_off(found)), 2)
print(*(least(work) / unit for work in (ANSWERS)))
"""


def environment(source: Path) -> dict[str, str]:
    """Return the environment of a process with one version of the package."""
    paths = os.pathsep.join([str(source), str(HERE)])
    return os.environ | {"PYTHONPATH": paths, "PYTHONHASHSEED": "0"}


def times(source: Path) -> dict[str, float]:
    """Return processor times: of answers beside the plain twin, of starts beside NumPy's import."""
    answers = ", ".join(f"lambda: {words}" for words in ANSWERS.values())
    program = _IMPORTS + _TIMES.replace("ANSWERS", answers)
    command = [sys.executable, "-c", program]
    done = subprocess.run(
        command, env=environment(source), check=True, capture_output=True, text=True
    )
    names = (f"{name} over the plain twin" for name in ANSWERS)
    found = dict(zip(names, map(float, done.stdout.split()), strict=True))
    chosen = ("import numpy", "import viscotack", "viscotack --help")
    rounds = [
        [start.processor_time(start.PROGRAMS[x], environment(source)) for x in chosen]
        for _ in range(5)
    ]
    unit, *others = (min(each) for each in zip(*rounds, strict=True))
    return found | {
        f"{name} over an import of NumPy": other / unit
        for name, other in zip(chosen[1:], others, strict=True)
    }


def instructions(source: Path) -> dict[str, float]:
    """Return the instructions of each answer, in 1e9; nothing without Valgrind."""
    if shutil.which("valgrind") is None:
        print("valgrind is not installed: no instructions are counted", file=sys.stderr)
        return {}
    idle = counted(_IMPORTS, source)
    return {
        name: (counted(f"{_IMPORTS}\n{words}", source) - idle) / 1e9
        for name, words in ANSWERS.items()
    }


def counted(program: str, source: Path) -> int:
    """Return the instructions of a process, the end of the interpreter excluded."""
    with tempfile.TemporaryDirectory() as folder:
        tool = ["--tool=cachegrind", "--cache-sim=no", f"--cachegrind-out-file={folder}/out"]
        ended = f"{program}\nimport os\nos._exit(0)"
        command = ["valgrind", *tool, sys.executable, "-c", ended]
        done = subprocess.run(command, env=environment(source), capture_output=True, text=True)
    found = re.search(r"I +refs: +([\d,]+)", done.stderr)
    if done.returncode or found is None:
        raise RuntimeError(done.stderr[-2000:])
    return int(found[1].replace(",", ""))


def read() -> list[dict[str, Any]]:
    """Return the lines of the history, none where there is no file."""
    if not HISTORY.exists():
        return []
    return [json.loads(line) for line in HISTORY.read_text("utf-8").splitlines()]


def slipped(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Return what costs more than a line before by more than its share, in words.

    Counts are compared on one kind of processor only.
    """
    found = []
    for kind, share in SHARES.items():
        if kind == "instructions" and before["processor"] != now["processor"]:
            continue
        for name, value in now[kind].items():
            then = before[kind].get(name)
            if then is not None and value > (1 + share) * then:
                rise = 100 * (value / then - 1)
                found.append(f"{kind}, {name}: {then:.4g} -> {value:.4g} (+{rise:.0f} %)")
    return found


def draw(lines: list[dict[str, Any]]) -> None:
    """Draw the history, each quantity over its first value."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(9.0, 3.4), sharey=True, layout="constrained")
    for ax, kind in zip(axes, SHARES, strict=True):
        for name in lines[-1][kind]:
            known = [(i, line[kind][name]) for i, line in enumerate(lines) if name in line[kind]]
            ax.plot([i for i, _ in known], [x / known[0][1] for _, x in known], "o-", label=name)
        ax.set_xticks(range(len(lines)), [f"{x['commit']}\n{x['date'][5:]}" for x in lines])
        ax.set_title({"times": "processor time", "instructions": "instructions"}[kind])
        ax.axhline(1.0, color="0.8", zorder=0)
        ax.legend(fontsize=7)
    axes[0].set_ylabel("over the first value")
    figure.savefig(FIGURE, dpi=110)


def main() -> int:
    """Measure and append, compare, or draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--source", type=Path, default=HERE.parent / "src")
    parser.add_argument("--commit", default="", help="of the source; of this checkout by default")
    parser.add_argument("--date", default=date.today().isoformat())
    parser.add_argument("--check", action="store_true", help="compare the last two lines")
    parser.add_argument("--figure", action="store_true", help=f"draw {FIGURE.name}")
    given = parser.parse_args()
    if given.check or given.figure:
        lines = read()
        if given.figure:
            draw(lines)
        words = slipped(*lines[-2:]) if given.check else []
        print("\n".join(words or ["nothing costs more than its share"] * given.check))
        return 1 if words else 0
    found = {
        "date": given.date,
        "commit": given.commit or records.commit(),
        "processor": records.processor(),
        "times": {name: float(f"{x:.4g}") for name, x in times(given.source).items()},
        "instructions": {name: float(f"{x:.5g}") for name, x in instructions(given.source).items()},
    }
    # an earlier version stands before later ones
    lines = sorted([*read(), found], key=lambda line: line["date"])
    HISTORY.write_text("".join(f"{json.dumps(line)}\n" for line in lines), "utf-8")
    print(json.dumps(found, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
