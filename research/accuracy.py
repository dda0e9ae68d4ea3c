"""Is the default good to what it says? Cases over the whole range against converged runs.

`python -m research.accuracy [--count 30]`: force and work of the default setting beside those at
a 20 times better accuracy, the error estimate beside the true error, the energy residual, the time.

`python -m research.accuracy --drawn 200 --seed 1`: stated errors of force, work and depth of the
pull-off of random tests, spheres and punches of `drawn_tests.py`, beside runs ten times as
accurate. Ten minutes on two cores.
"""

from __future__ import annotations

import argparse
from time import perf_counter
from typing import Any

import numpy as np

from research.cases import spread, spread_out, words
from research.drawn_tests import drawn
from research.drawn_tests import words as test_words
from research.twins import plain_sphere
from viscotack import AtDepth, Groups, depth_at_pull_off, pull_off_force, solve, work_to_pull_off
from viscotack.errors import InputError
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.simulate import SimulationError

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
    plain = plain_sphere(
        groups,
        nodes=TWIN_SIZE,
        outer_radius=float(np.sqrt(2 * (60 + groups.start.depth) / groups.tabor)),
        steps=TWIN_SIZE,
        last_depth=2 * depth_at_pull_off(best) - groups.start.depth - 0.5,
    )
    force, converged = pull_off_force(plain), pull_off_force(best)
    return (
        f"{words(groups):62s} converged {converged:.4f}, plain twin {force:.4f}: "
        f"{100 * (converged / force - 1):+.3f} %"
    )


# Of what errors are stated, and whether that is relative.
STATED = {
    "force": (pull_off_force, True),
    "work": (work_to_pull_off, True),
    "depth": (depth_at_pull_off, False),
}
FINER = 10.0


def stated_beside_true(asked: tuple[int, int, float, float]) -> dict[str, Any]:
    """Return the stated and the true errors of a random test by name; none where it is refused."""
    seed, number, accuracy, limit = asked
    row: dict[str, Any] = {"number": number}
    try:
        groups = drawn(seed, number)
        row["case"] = test_words(groups)
        given: dict[str, Any] = {"until": "pull-off", "time_limit": limit}
        result = solve(groups, accuracy=accuracy, **given)
        best = solve(groups, accuracy=accuracy / FINER, estimate_error=False, **given)
    except (InputError, SimulationError) as refusal:
        return row | {"refused": str(refusal)}
    for name, (observable, relative) in STATED.items():
        try:
            value, true = observable(result), observable(best)
        except InputError:
            continue  # not told: there is no pull-off, or the work means nothing
        unit = abs(value) if relative else 1.0
        row[name] = (result.error_estimate or {}).get(name, np.nan), abs(value - true) / unit
    return row


def report_stated(rows: list[dict[str, Any]]) -> None:
    """Print how often stated errors cover the true ones, by how much, and the misses."""
    print(f"{len(rows)} tests, {sum('refused' in row for row in rows)} refused")
    for name in STATED:
        known = [(row, *row[name]) for row in rows if name in row]
        stated, true = np.array([pair[1:] for pair in known]).T
        ratio = np.median(stated / np.maximum(true, np.finfo(float).tiny))
        print(
            f"{name:6s} of {len(known)}: {100 * np.mean(stated >= true):.1f} % covered, stated "
            f"over true {ratio:.2f} in the median"
        )
        for row, said, off in sorted(known, key=lambda k: k[1] / max(k[2], 1e-300)):
            if off > said:
                print(f"  {row['number']:4d} stated {said:.2g}, true {off:.2g}: {row['case']}")


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
    parser.add_argument("--drawn", type=int, metavar="COUNT", help="random tests")
    parser.add_argument("--accuracy", type=float, default=DEFAULT_ACCURACY, help="of random tests")
    parser.add_argument("--limit", type=float, default=30.0, help="seconds of a simulation")
    parser.add_argument("--workers", type=int, default=2)
    chosen = parser.parse_args()
    if chosen.drawn:
        asked = [
            (chosen.seed, number, chosen.accuracy, chosen.limit) for number in range(chosen.drawn)
        ]
        report_stated(spread_out(stated_beside_true, asked, chosen.workers))
        return
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
