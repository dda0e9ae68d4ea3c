"""An adversary that looks for the worst violation of an interval; simulation is the judge.

`python benchmarks/adversary.py [--cases 120] [--seed 1] [--out FILE.jsonl]`: an evolution over the
whole range of the five inputs. It begins with the cases of the shipped sets that lie furthest out
of their intervals, and with some at random; each round it varies those that were worst, simulates
the new ones at an accuracy of 1e-3, and keeps what is worse, in half widths of the 90 % interval of
force or work, whichever is larger. A simulation counts as far as it knows itself: its stated error
is taken off. One or two seconds a case; with --out it goes on where it was stopped.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np

from viscotack import solve
from viscotack.campaign.columns import KINDS
from viscotack.result.observables import pull_off_force, work_to_pull_off
from viscotack.surrogate.physics import HIGH, INPUTS, LOW
from viscotack.surrogate.store import shipped
from viscotack.surrogate.training.rows import LEARNED, read

# Cases that are varied at a time, how far the first variations reach in halves of the range, and by
# what they shrink each round.
_KEPT, _REACH, _SHRINK = 6, 0.15, 0.9
_LOW, _HIGH = np.log10(LOW), np.log10(HIGH)


def violation(row: np.ndarray, true: tuple[float, float], stated: tuple[float, float]) -> float:
    """Return how many half widths the worse of force and work is off, less their stated errors."""
    said = shipped().evaluate(row[None])
    held = shipped().intervals(row[None], said)
    found = []
    for value, pair, of, error in zip(
        (said.pull_off_force, said.work_to_pull_off),
        (held.pull_off_force, held.work_to_pull_off),
        true,
        stated,
        strict=True,
    ):
        half = np.log(pair[0, 1] / value[0])
        found.append(max(abs(np.log(value[0] / of)) - error, 0.0) / half)
    return float(max(found))


def simulated(row: np.ndarray) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Return force and work of a case and their stated errors; None where there is no answer."""
    problem = KINDS["sphere"].problem(dict(zip(INPUTS, row.tolist(), strict=True)))
    result = solve(problem, accuracy=1e-3, until="pull-off", throw=False)
    error = result.error_estimate
    if error is None or "work" not in error:
        return None
    try:
        return (pull_off_force(result), work_to_pull_off(result)), (error["force"], error["work"])
    except ValueError:
        return None


def worst_known(count: int) -> list[tuple[float, list[float]]]:
    """Return the cases of the sets that lie furthest out of their intervals."""
    rows = read(*LEARNED)
    said = shipped().evaluate(rows.groups)
    held = shipped().intervals(rows.groups, said)
    off = np.abs(np.log(said.pull_off_force / rows.force))
    off /= np.log(held.pull_off_force[:, 1] / said.pull_off_force)
    worst = np.argsort(-off)[:count]
    return [(float(off[i]), rows.groups[i].tolist()) for i in worst]


def main() -> None:
    """Search and print what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=120)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    random = np.random.default_rng(given.seed)
    done: list[tuple[float, list[float]]] = []
    if given.out is not None and given.out.exists():
        done = [tuple(json.loads(line)) for line in given.out.read_text().splitlines()]
    beginning = [row for _, row in worst_known(_KEPT)]
    beginning += (10 ** (_LOW + random.random((_KEPT, 5)) * (_HIGH - _LOW))).tolist()
    while len(done) < given.cases:
        number = len(done)
        if number < len(beginning):
            row = np.array(beginning[number])
        else:
            best = sorted(done, reverse=True)[:_KEPT]
            reach = _REACH * _SHRINK ** (number / _KEPT) + 0.01
            parent = np.log10(best[number % len(best)][1])
            step = reach * random.standard_t(3, 5) * (_HIGH - _LOW) / 2
            row = 10 ** np.clip(parent + step, _LOW, _HIGH)
        found = simulated(row)
        done.append((-1.0 if found is None else violation(row, *found), row.tolist()))
        if given.out is not None:
            with given.out.open("a") as file:
                file.write(json.dumps(done[-1]) + "\n")
    off = np.array([each for each, _ in done if each >= 0])
    print(f"{len(off)} simulated; {np.mean(off > 1):.0%} beyond their interval")
    print("worst, half widths, and its case:")
    for each, row in sorted(done, reverse=True)[:5]:
        words = ", ".join(f"{n} {x:.4g}" for n, x in zip(INPUTS, row, strict=True))
        print(f"  {each:.2f}  {words}")


if __name__ == "__main__":
    main()
