"""Do the stated errors of the datasets hold? Random rows beside runs of ten times the accuracy.

`python benchmarks/datasets.py [--count 300] [--set thesis]`: the share of rows whose stated errors
of force and work hold, the errors themselves, and how far trajectories and crack speeds are off.
Two processes take about three minutes for 300 rows of `thesis`, one for `punch`, five for `broad`,
nine for `fast` and twenty for 150 rows of `chosen`, the slowest of which take minutes each.
"""

from __future__ import annotations

import argparse
from time import perf_counter
from typing import Any

import numpy as np
from cases import spread_out
from scipy.interpolate import PchipInterpolator

from viscotack import Result, datasets, solve
from viscotack.campaign.case import retraction
from viscotack.campaign.columns import KINDS
from viscotack.result.observables import crack_speed_at_pull_off, pull_off, work_to_pull_off

FINER = 10.0
# The solver's finest accuracy.
FINEST = 1e-6
# What has no stated error.
BESIDE = {
    "compression": "trajectory in compression, beside its largest force",
    "tension": "trajectory in tension, beside the pull-off force",
    "crack_speed": "crack speed at the pull-off",
}


def inputs_of(row: dict[str, Any]) -> tuple[str, dict[str, float]]:
    """Return kind and inputs of a row."""
    kind = "punch" if "size" in row else "solid" if "solid" in row else "sphere"
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
    speed = row["crack_speed_at_pull_off"]
    compression, tension = along(row, best)
    return {
        "force": abs(row[f"pull_off_{name}"] / pull_off(best).force - 1),
        "work": abs(row["work_to_pull_off"] / work_to_pull_off(best) - 1),
        "force_stated": row["force_error"],
        "work_stated": row["work_error"],
        "compression": compression,
        "tension": tension,
        # There is none at a jump.
        "crack_speed": speed and abs(speed / crack_speed_at_pull_off(best) - 1),
        "row": row,
    }


def along(row: dict[str, Any], best: Result) -> tuple[float | None, float]:
    """Return how far a row's trajectory is from the force of a finer run at the same depths.

    The largest distance in compression beside the largest compression, None for a start in
    tension, and the largest in tension beside the pull-off force: a deep start is pressed with many
    times that.
    """
    sign, name = (-1, "stress") if "size" in row else (1, "force")
    force = sign * np.array(row[f"trajectory_{name}"])
    depth, exact, _ = retraction(best)
    # A place beyond the finer run's own pull-off is compared with its last step.
    wanted = np.clip(
        row["depth_at_pull_off"] + np.array(row["trajectory_travel_left"]), *depth[[-1, 0]]
    )
    off = np.abs(force - PchipInterpolator(-depth, exact)(-wanted))
    pressed = force > 1e-6 * np.abs(force).max()
    compression = off[pressed].max() / force.max() if np.any(pressed) else None
    return compression, off[~pressed].max() / pull_off(best).force


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
    for what, title in BESIDE.items():
        off = np.array([row[what] for row in found if row[what] is not None])
        print(
            f"  {title}, {off.size} rows: off by {np.nanmedian(off):.1e} in the median, "
            f"95 % below {np.nanquantile(off, 0.95):.1e}, largest {np.nanmax(off):.1e}"
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
