"""Can anybody make it lie? Random problems with every law, on several processors, beside theory.

``python benchmarks/trust.py --out FOLDER`` draws 600 problems (`random_problems.py`), runs them
with the kernels of every --core-type that is named, runs --noise of them with relative noise of
1e-14 in all that is worked out, and --finer of those that have an answer ten times as accurately.
Each run is a file of the folder, a line for each problem as it is done; a run that was cut short
goes on where it was. Then the figures are printed beside what is asked of them, and what is worst.
Without --out the files are not kept. ``--films`` draws shapes of revolution on layers.

``--report FILE ...`` prints them for files that are there, the first being what the others are held
against; ``--show NUMBER`` prints a problem and its record.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
import warnings
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

from in_time import spread_in_time
from random_problems import problem, words
from threadpoolctl import threadpool_info
from trust_report import read, report

import viscotack
from viscotack import pull_off, solve, time_to_detachment, to_dict, work_to_pull_off
from viscotack.problem.accuracy import DEFAULT_ACCURACY

PACKAGE = Path(viscotack.__file__).parent
# Round-off as another processor has it lies with the tests of the package at hand.
sys.path.append(str(PACKAGE.parents[1] / "tests"))
FINER = 10.0


@dataclass(frozen=True)
class Asked:
    """How all problems of a run are asked."""

    seed: int
    accuracy: float
    noise: bool = False
    estimate: bool = True
    films: bool = False

    def problem(self, number: int) -> Any:
        """Return one of its problems."""
        return problem(self.seed, number, films=self.films)


def answer(asked: Asked, number: int) -> dict[str, Any]:
    """Return how a problem ended, its numbers, and what it took."""
    began = process_time()
    row: dict[str, Any] = {"number": number, "case": "a law that the package refuses"}
    try:
        groups = asked.problem(number)
        row["case"] = words(groups)
        with warnings.catch_warnings(), noisy(number) if asked.noise else nullcontext():
            warnings.simplefilter("error")
            result = solve(
                groups, accuracy=asked.accuracy, estimate_error=asked.estimate, throw=False
            )
        stopped = result.outcome == viscotack.Outcome.STOPPED
        row |= {"end": "refused" if stopped else "answered", **observed(result)}
    except ValueError as refusal:
        row |= {"end": "refused", "status": str(refusal)}
    except Exception as failure:
        row |= {"end": "failed", "status": repr(failure)}
    kernels = sorted({lib["architecture"] for lib in threadpool_info() if "architecture" in lib})
    return row | {"seconds": process_time() - began, "kernels": ", ".join(kernels)}


def noisy(number: int) -> Any:
    from noise import noise

    return noise(number, 1e-14)


def observed(result: Any) -> dict[str, Any]:
    """Return what a result says, as far as it does."""
    found: dict[str, Any] = {
        "status": result.status,
        "outcome": str(result.outcome),
        "events": [event.kind for event in result.events],
        "estimate": dict(result.error_estimate or {}),
        "residual": result.energy_residual,
        "start_force": float(result.force[0]),
        "last_depth": float(result.depth[-1]),
        "statistics": {k: float(v) for k, v in result.statistics.items()},
    }
    for name, of in {
        "force": lambda r: pull_off(r).force,
        "work": work_to_pull_off,
        "time": time_to_detachment,
    }.items():
        try:
            found[name] = float(of(result))
        except ValueError:
            found[name] = None  # no pull-off, or no dead load
    return found


def source() -> str:
    """Return a short name of the package at hand by what is in its files."""
    content = b"".join(file.read_bytes() for file in sorted(PACKAGE.rglob("*.py")))
    return hashlib.sha256(content).hexdigest()[:12]


def run(
    file: Path, asked: Asked, numbers: Sequence[int], *, kernels: str, limit: float, workers: int
) -> None:
    """Ask what a file does not yet have, and write each answer at once."""
    head = {"kernels": kernels, "limit": limit, "source": source(), **vars(asked)}
    known = set()
    if file.exists():
        first, *rows = (json.loads(line) for line in file.read_text().splitlines())
        if first != head:
            raise SystemExit(f"{file} is of another run, {first}; take another folder")
        known = {row["number"] for row in rows}
    else:
        file.write_text(json.dumps(head) + "\n")
    left = [number for number in numbers if number not in known]
    work = partial(answer, asked)
    with file.open("a") as written:
        for number, row in spread_in_time(
            work, left, limit=limit, workers=workers, kernels=kernels
        ):
            if isinstance(row, str):
                case = words(asked.problem(number))
                end = "too slow" if row.startswith("more than") else "failed"
                row = {"number": number, "case": case, "end": end, "status": row}
            written.write(json.dumps(row) + "\n")
            written.flush()
            known.add(number)
            print(f"\r{file.name}: {len(known)} of {len(numbers)} ", end="", file=sys.stderr)
    print(file=sys.stderr)


def runs(given: argparse.Namespace, folder: Path) -> list[Path]:
    """Do all runs that are wanted, each in a file of a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    plain = Asked(given.seed, given.accuracy, films=given.films)
    first = given.core_type[0]
    files = []

    def add(name: str, asked: Asked, numbers: Sequence[int], kernels: str, longer: float) -> None:
        files.append(folder / f"{name}.jsonl")
        limit = longer * given.limit
        run(files[-1], asked, numbers, kernels=kernels, limit=limit, workers=given.workers)

    for kernels in given.core_type:
        add(kernels or "plain", plain, range(given.count), kernels, 1.0)
    if given.noise:
        numbers = range(min(given.noise, given.count))
        add("noise", replace(plain, noise=True), numbers, first, 1.0)
    if given.finer:
        answered = read(files[0]).answered
        order = sorted(answered, key=lambda n: answered[n]["seconds"] if given.cheapest else n)
        answered = order[: given.finer]
        finer = replace(plain, accuracy=given.accuracy / FINER, estimate=False)
        add("finer", finer, answered, first, FINER)
    return files


def main() -> None:
    """Run and report."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, metavar="FOLDER")
    parser.add_argument("--seed", type=int, default=17)
    parser.add_argument("--count", type=int, default=600)
    parser.add_argument("--films", action="store_true", help="shapes of revolution on layers")
    parser.add_argument("--core-type", nargs="+", default=[""], metavar="NAME", help="of OpenBLAS")
    parser.add_argument("--noise", type=int, default=0, metavar="COUNT")
    parser.add_argument("--finer", type=int, default=0, metavar="COUNT")
    parser.add_argument("--cheapest", action="store_true", help="finer runs of the cheapest")
    parser.add_argument("--accuracy", type=float, default=DEFAULT_ACCURACY)
    parser.add_argument("--limit", type=float, default=60.0, help="processor seconds a problem")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--report", type=Path, nargs="+", metavar="FILE")
    parser.add_argument("--show", type=int, metavar="NUMBER")
    given = parser.parse_args()
    if given.show is not None:
        shown = problem(given.seed, given.show, films=given.films)
        print(words(shown), json.dumps(to_dict(shown), indent=2), sep="\n")
        return
    if given.report:
        report(given.report)
        return
    with nullcontext(given.out) if given.out else TemporaryDirectory() as folder:
        report(runs(given, Path(folder)))


if __name__ == "__main__":
    main()
