"""What a simulation costs: processor time in LU factorisations, beside an earlier version.

`python benchmarks/cost.py [--against CHECKOUT] [--random 60] [--repeat 4]`: twelve reference cases,
or as many random problems, to the pull-off with their error estimate. Time is the least of a few
runs in units of 225 LU factorisations of a 120 x 120 matrix, the least of a few as well. With
another checkout, a folder with src/, both versions run each case in turn.
"""

from __future__ import annotations

import os

for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")

import argparse  # noqa: E402
import json  # noqa: E402
import subprocess  # noqa: E402
import sys  # noqa: E402
from pathlib import Path  # noqa: E402
from time import process_time  # noqa: E402
from typing import Any  # noqa: E402

import numpy as np  # noqa: E402
from cases import REFINED, case  # noqa: E402
from random_problems import problem  # noqa: E402
from scipy.linalg import lu_factor  # noqa: E402

from viscotack import Groups, Outcome, pull_off_force, solve, work_to_pull_off  # noqa: E402

# Those of `speed.py` that have no refined value, those that have one, and a fast one.
REFERENCE: list[Groups] = [
    case(6.0, 0.1, 0.8, 20.0, 30.0),
    case(8.0, 0.1, 1.6, 20.0, 10.0),
    case(10.0, 0.03, 0.8, 30.0, 30.0),
    *(groups for groups, _ in REFINED.values()),
    case(0.3, 1e-3, 0.4, 30.0, 1e5),
]
SEED, FACTORISATIONS, SIZE = 36, 225, 120
# A random problem that takes longer is left out [s].
LIMIT = 8.0


def unit() -> float:
    """Return the processor time of 225 LU factorisations of a 120 x 120 matrix."""
    matrix = np.random.default_rng(0).random((SIZE, SIZE))
    began = process_time()
    for _ in range(FACTORISATIONS):
        lu_factor(matrix, check_finite=False)
    return process_time() - began


def measured(number: int, *, random: bool) -> dict[str, Any] | None:
    """Return time, steps, force and work of a case; None where it has none."""
    groups = problem(SEED, number) if random else REFERENCE[number]
    began = process_time()
    try:
        result = solve(groups, until="pull-off", throw=False, time_limit=LIMIT)
        if result.outcome == Outcome.STOPPED:
            return None
        found = pull_off_force(result), work_to_pull_off(result)
    except ValueError:
        return None
    took = process_time() - began
    return {"time": took, "steps": result.statistics["steps"], "found": found}


class Version:
    """A process with one version of the package."""

    def __init__(self, source: Path) -> None:
        self._process = subprocess.Popen(
            [sys.executable, __file__, "--serve"],
            env=os.environ | {"PYTHONPATH": str(source.resolve())},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def ask(self, number: int, *, random: bool) -> dict[str, Any] | None:
        """Return the measurement of a case."""
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.write(json.dumps([number, random]) + "\n")
        self._process.stdin.flush()
        return json.loads(self._process.stdout.readline())

    def close(self) -> None:
        """End the process."""
        self._process.communicate()


def serve() -> None:
    """Answer the numbers of cases that come in."""
    for line in sys.stdin:
        number, random = json.loads(line)
        print(json.dumps(measured(number, random=random)), flush=True)


def least(
    versions: list[Version], number: int, repeat: int, *, random: bool
) -> list[dict[str, Any]] | None:
    """Return the quickest of a few runs of each version, in turn; None where one has no answer."""
    runs: list[list[Any]] = [[] for _ in versions]
    for _ in range(repeat):
        for found, version in zip(runs, versions, strict=True):
            found.append(version.ask(number, random=random))
            if found[-1] is None:
                return None
    return [min(found, key=lambda run: run["time"]) for found in runs]


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--against", type=Path, metavar="CHECKOUT")
    parser.add_argument("--random", type=int, default=0, metavar="COUNT")
    parser.add_argument("--repeat", type=int, default=4)
    parser.add_argument("--serve", action="store_true", help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.serve:
        serve()
        return
    here = Path(sys.modules["viscotack"].__file__ or "").parents[1]
    sources = [here] if chosen.against is None else [chosen.against / "src", here]
    versions = [Version(source) for source in sources]
    count, one = chosen.random or len(REFERENCE), min(unit() for _ in range(5))
    rows = []
    for number in range(count):
        found = least(versions, number, chosen.repeat, random=bool(chosen.random))
        one = min(one, unit())
        if found is None:
            continue
        rows.append([run["time"] for run in found])
        moved = abs(np.array(found[-1]["found"]) / np.array(found[0]["found"]) - 1)
        print(
            f"{number:3d} " + ", ".join(f"{r['time']:.3f} s {r['steps']} steps" for r in found),
            f"force {moved[0]:.1e} work {moved[1]:.1e}",
            flush=True,
        )
    for version in versions:
        version.close()
    times = np.array(rows)
    units = ", ".join(f"{x:.1f}" for x in np.median(times / one, axis=0))
    print(f"{len(rows)} cases, median in units of {FACTORISATIONS} factorisations: {units}")
    ratio = times[:, 0] / times[:, -1]
    print(f"times faster: median {np.median(ratio):.2f}, {ratio.min():.2f} to {ratio.max():.2f}")


if __name__ == "__main__":
    main()
