"""The published table put beside the simulation: `python benchmarks/published.py [--count 200]`."""

from __future__ import annotations

import argparse
from time import perf_counter
from typing import Any

import numpy as np
from cases import PUBLISHED, case, published_rows, spread_out

from viscotack import pull_off_force, solve, work_to_pull_off


def measure(row: dict[str, float]) -> dict[str, Any]:
    """Return how far a published row is from the simulation."""
    groups = case(row["mu"], row["k"], row["n"], row["alphaload"], -row["runload"])
    began = perf_counter()
    result = solve(groups, until="pull-off")
    assert result.error_estimate is not None
    return row | {
        "force": pull_off_force(result),
        "force_difference": row["outputAmplification"] / pull_off_force(result) - 1,
        # their work is in pi R dg h0
        "work_difference": row["workofSepration"] / 1.5 / work_to_pull_off(result) - 1,
        "estimate": result.error_estimate["force"],
        "energy_residual": result.energy_residual,
        "time": perf_counter() - began,
    }


def decide(row: dict[str, Any]) -> float:
    """Return the converged force of a row, which decides where two programs differ."""
    groups = case(row["mu"], row["k"], row["n"], row["alphaload"], -row["runload"])
    return pull_off_force(solve(groups, until="pull-off", accuracy=1e-4, estimate_error=False))


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=2026)
    parser.add_argument("--outliers", type=float, default=0.03, help="decide rows off by more")
    chosen = parser.parse_args()
    rows = published_rows(chosen.count, chosen.seed)
    if not rows:
        print(f"skipped: the published table is not at {PUBLISHED}")
        return
    began = perf_counter()
    found = spread_out(measure, rows)
    force = np.array([row["force_difference"] for row in found])
    work = np.array([row["work_difference"] for row in found])
    times = np.array([row["time"] for row in found])
    print(f"rows                        {len(found)} in {perf_counter() - began:.0f} s")
    print(f"force, median difference    {100 * np.median(np.abs(force)):.3f} %")
    print(f"force, 95th percentile      {100 * np.quantile(np.abs(force), 0.95):.2f} %")
    print(f"work, median difference     {100 * np.median(np.abs(work)):.2f} %")
    print(f"seconds a row, median       {np.median(times):.3f}, largest {times.max():.2f}")
    print(f"energy residual, largest    {max(row['energy_residual'] for row in found):.1e}")
    outliers = [row for row in found if abs(row["force_difference"]) > chosen.outliers]
    print(f"rows off by more than {100 * chosen.outliers:g} %: {len(outliers)}")
    for row, best in zip(outliers, spread_out(decide, outliers), strict=True):
        theirs, ours = row["outputAmplification"], row["force"]
        print(
            f"  mu {row['mu']:g}, k {row['k']:g}, n {row['n']:g}, depth {row['alphaload']:.4g}, "
            f"rate {-row['runload']:.3g}: published {theirs:.4f}, here {ours:.4f}, "
            f"converged {best:.4f}: published off by {100 * (theirs / best - 1):+.1f} %, "
            f"here by {100 * (ours / best - 1):+.2f} %"
        )


if __name__ == "__main__":
    main()
