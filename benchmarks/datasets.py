"""Do the stated errors of the datasets hold? Random rows beside runs of ten times the accuracy.

`python benchmarks/datasets.py [--count 300] [--set thesis]`: the share of rows whose stated errors
of force and work hold, the errors themselves, and how far trajectories are off. Two processes take
about two minutes for 300 rows of `thesis` and `punch` and ten for `broad`.
"""

from __future__ import annotations

import argparse
from time import perf_counter
from typing import Any

import numpy as np
from cases import spread_out

from viscotack import Result, datasets, solve
from viscotack.campaign.case import curve
from viscotack.campaign.columns import KINDS
from viscotack.observables import pull_off, work_to_pull_off

FINER = 10.0
# The solver's finest accuracy.
FINEST = 1e-6


def inputs_of(row: dict[str, Any]) -> tuple[str, dict[str, float]]:
    """Return kind and inputs of a row."""
    kind = "punch" if "size" in row else "sphere"
    names = {*KINDS[kind].columns, "preload"}
    return kind, {name: row[name] for name in names}


def again(row: dict[str, Any], finer: float = FINER) -> Result:
    """Return a row's case, simulated with its accuracy made finer by a factor."""
    kind, inputs = inputs_of(row)
    accuracy = max(row["accuracy"] / finer, FINEST)
    problem = KINDS[kind].problem(inputs)
    return solve(problem, accuracy=accuracy, until="pull-off", estimate_error=False)


def measure(row: dict[str, Any]) -> dict[str, Any]:
    """Return how far a row is from its case at ten times the accuracy."""
    best = again(row)
    name = "stress" if "size" in row else "force"
    peak = pull_off(best).force
    line = curve(best, pull_off(best))
    sign = -1 if name == "stress" else 1
    trajectory = np.subtract(row[f"trajectory_{name}"], np.multiply(sign, line["trajectory_force"]))
    return {
        "force": abs(row[f"pull_off_{name}"] / peak - 1),
        "work": abs(row["work_to_pull_off"] / work_to_pull_off(best) - 1),
        "force_stated": row["force_error"],
        "work_stated": row["work_error"],
        # Compression at the start may be many times the pull-off.
        "trajectory": np.max(np.abs(trajectory)) / max(peak, *np.abs(line["trajectory_force"])),
        "row": row,
    }


def words(row: dict[str, Any]) -> str:
    """Return the inputs of a row in a line."""
    return ", ".join(f"{name} {value:.3g}" for name, value in sorted(inputs_of(row)[1].items()))


def report(name: str, count: int, seed: int, workers: int) -> None:
    """Measure a set and print its figures."""
    began, table = perf_counter(), datasets.load(name)
    chosen = np.random.default_rng(seed).choice(
        table.num_rows, min(count, table.num_rows), replace=False
    )
    found = spread_out(measure, table.take(np.sort(chosen)).to_pylist(), workers)
    print(f"{name}: {len(found)} of {table.num_rows} rows in {perf_counter() - began:.0f} s")
    for what in ("force", "work"):
        error = np.array([row[what] for row in found])
        stated = np.array([row[f"{what}_stated"] for row in found])
        print(
            f"  {what}: stated errors hold in {np.mean(error <= stated):.1%}; true error "
            f"{np.median(error):.2e} in the median, 95 % below {np.quantile(error, 0.95):.2e}, "
            f"largest {error.max():.2e}; stated {np.median(stated):.1e} in the median, "
            f"largest {stated.max():.1e}"
        )
        worst = max(found, key=lambda row: row[what] / row[f"{what}_stated"])
        print(f"    worst beside what is stated ({worst[what]:.1e}): {words(worst['row'])}")
    off = np.array([row["trajectory"] for row in found])
    print(
        f"  force along the trajectory, beside its largest: off by {np.median(off):.1e} in the "
        f"median, 95 % below {np.quantile(off, 0.95):.1e}, largest {off.max():.1e}"
    )


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--set", choices=datasets.NAMES, action="append")
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=2026)
    parser.add_argument("--workers", type=int, default=2)
    chosen = parser.parse_args()
    for name in chosen.set or datasets.NAMES:
        report(name, chosen.count, chosen.seed, chosen.workers)


if __name__ == "__main__":
    main()
