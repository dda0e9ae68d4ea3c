"""Is the default good to what it says? Cases over the whole range against converged runs.

`python benchmarks/accuracy.py [--count 30]`: force and work of the default setting beside those at
a 20 times better accuracy, the error estimate beside the true error, the energy residual, the time.
"""

from __future__ import annotations

import argparse
from time import perf_counter
from typing import Any

import numpy as np
from cases import spread, spread_out, words

from viscotack import AtDepth, Groups, pull_off_depth, pull_off_force, solve, work_to_pull_off
from viscotack.bem.twins.plain import plain_solve

CONVERGED = 1e-4
# The plain twin is at hand where its equal nodes and steps resolve the case.
TWIN_SIZE, TWINS = 500, 6


def measure(groups: Groups) -> dict[str, Any]:
    """Return errors, estimates, residual and time of one case."""
    began = perf_counter()
    result = solve(groups, until="pull-off")
    elapsed = perf_counter() - began
    best = solve(groups, until="pull-off", accuracy=CONVERGED, estimate_error=False)
    assert result.error_estimate is not None
    return {
        "case": words(groups),
        "force_error": pull_off_force(result) / pull_off_force(best) - 1,
        "work_error": work_to_pull_off(result) / work_to_pull_off(best) - 1,
        "force_estimate": result.error_estimate["force"],
        "work_estimate": result.error_estimate["work"],
        "energy_residual": result.energy_residual,
        "time": elapsed,
    }


def twin(groups: Groups) -> str:
    """Return the converged force beside that of the plain twin, which shares no code with it."""
    best = solve(groups, until="pull-off", accuracy=CONVERGED, estimate_error=False)
    assert isinstance(groups.start, AtDepth)
    plain = plain_solve(
        groups,
        nodes=TWIN_SIZE,
        outer_radius=float(np.sqrt(2 * (60 + groups.start.depth) / groups.tabor)),
        steps=TWIN_SIZE,
        last_depth=2 * pull_off_depth(best) - groups.start.depth - 0.5,
    )
    force, converged = pull_off_force(plain), pull_off_force(best)
    return (
        f"{words(groups):62s} converged {converged:.4f}, plain twin {force:.4f}: "
        f"{100 * (converged / force - 1):+.3f} %"
    )


def summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the figures that the project states."""

    def column(name: str) -> np.ndarray:
        return np.abs([row[name] for row in rows])

    figures: dict[str, Any] = {"cases": len(rows)}
    for name in ("force", "work"):
        error, estimate = column(f"{name}_error"), column(f"{name}_estimate")
        figures |= {
            f"{name}_error_largest": error.max(),
            f"{name}_error_median": np.median(error),
            f"{name}_covered": int((estimate >= error).sum()),
            f"{name}_estimate_over_error": np.median(estimate / error),
        }
    return figures | {
        "energy_residual_largest": column("energy_residual").max(),
        "time_median": np.median(column("time")),
        "time_largest": column("time").max(),
    }


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--seed", type=int, default=2026)
    chosen = parser.parse_args()
    cases = spread(chosen.count, chosen.seed)
    rows = spread_out(measure, cases)
    for row in rows:
        print(
            f"{row['case']:62s} force {100 * row['force_error']:+.3f} % "
            f"(said {100 * row['force_estimate']:.3f}), work {100 * row['work_error']:+.3f} % "
            f"(said {100 * row['work_estimate']:.3f}), residual {row['energy_residual']:.0e}, "
            f"{row['time']:.3f} s"
        )
    for name, value in summary(rows).items():
        print(f"{name:28s} {value:.4g}")
    easy = [g for g in cases if g.tabor < 1 and g.start.depth < 5][:TWINS]
    for line in spread_out(twin, easy):
        print(line)


if __name__ == "__main__":
    main()
