"""Nothing crashes, nothing hangs: `python benchmarks/robust.py [--count 1000] [--until detached]`.

Random cases over the whole range; each ends with an answer or with a physical reason. Warnings are
errors here: an overflow or a division by zero is a failure. With --keep FILE each row is written at
once, and a run that was cut short goes on where it was.
"""

from __future__ import annotations

import argparse
import json
import warnings
from collections import Counter
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from cases import spread, spread_as_done, words

from viscotack import Groups, pull_off_force, solve


def measure(groups: Groups, until: str) -> dict[str, Any]:
    """Return how one case ended and what it took."""
    began = perf_counter()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            result = solve(groups, until=until)
            pull_off_force(result)
        estimate = result.error_estimate or {"force": np.nan}
        row = {
            "outcome": str(result.outcome),
            "residual": result.energy_residual,
            "estimate": estimate["force"],
        }
    except ValueError as reason:
        row = {"outcome": f"refused: {reason}"}
    except Exception as failure:
        row = {"outcome": f"FAILED: {failure!r}"}
    return row | {"case": words(groups), "time": perf_counter() - began}


def measured(cases: list[Groups], until: str, keep: Path | None) -> list[dict[str, Any]]:
    """Return a row for each case, and keep them in a file as they come."""
    rows = []
    if keep is not None and keep.exists():
        rows = [json.loads(line) for line in keep.read_text().splitlines()]
    file = keep.open("a") if keep is not None else nullcontext()
    with file as written:
        for row in spread_as_done(partial(measure, until=until), cases[len(rows) :]):
            rows.append(row)
            if written is not None:
                written.write(json.dumps(row) + "\n")
                written.flush()
    return rows


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--until", choices=("pull-off", "detached"), default="pull-off")
    parser.add_argument("--keep", type=Path, help="a file of rows, one JSON object a line")
    chosen = parser.parse_args()
    began = perf_counter()
    rows = measured(spread(chosen.count, chosen.seed), chosen.until, chosen.keep)
    times = np.array([row["time"] for row in rows])
    good = [row for row in rows if "residual" in row]
    residuals = np.array([row["residual"] for row in good])
    print(
        f"{len(rows)} cases to {chosen.until} in {perf_counter() - began:.0f} s, "
        f"{len(good)} answered"
    )
    for outcome, count in Counter(row["outcome"][:70] for row in rows).most_common(12):
        print(f"  {count:6d} {outcome}")
    median, most, longest = np.median(times), np.quantile(times, 0.99), times.max()
    print(f"seconds a case: median {median:.3f}, 99 % below {most:.2f}, longest {longest:.2f}")
    print(
        f"energy residual: 99 % below {np.quantile(residuals, 0.99):.1e}, "
        f"largest {residuals.max():.1e}, above 1e-3: {(residuals > 1e-3).sum()}"
    )
    print(f"error estimate of the force above 0.5 %: {sum(r['estimate'] > 5e-3 for r in good)}")
    for row in rows:
        if row["outcome"].startswith(("FAILED", "stopped")) or row["time"] > 30:
            print(f"  {row['case']}: {row['outcome']}, {row['time']:.1f} s")


if __name__ == "__main__":
    main()
