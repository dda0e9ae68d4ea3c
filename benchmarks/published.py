"""The published table put beside the simulation, row by row.

`python benchmarks/published.py` prints what the sample in tests/data shows, in a few minutes;
`--table PATH` takes another table, `--count` so many rows at random. docs/published-data.md and its
pictures are of 6,430 rows, ten minutes of processor time, by `--table PATH --write`. Where the two
are apart by more than 2 % a converged run decides. Runs are kept in a folder (`--out`) and go on
where they were stopped.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from cases import SAMPLE, add_table, case, published_rows

from viscotack import pull_off_force, run_id, solve, work_to_pull_off
from viscotack.campaign import CaseSettings, Plan, Store, run
from viscotack.campaign.columns import KINDS
from viscotack.campaign.plan import Case

# Two programs that are apart by more need a third opinion.
APART = 0.02
CONVERGED = 1e-4
# What the published table holds where no work was found; their work is in pi R dg0 h0.
NO_WORK, WORK_UNIT = 0.01, 1.5
_SHOWN = ("pull_off_force", "work_to_pull_off", "error_estimate", "energy_residual", "wall_time_s")

Row = dict[str, Any]


def measure(row: dict[str, float]) -> Row:
    """Return how far a published row is from the simulation."""
    groups = case(row["mu"], row["k"], row["n"], row["alphaload"], -row["runload"])
    began = perf_counter()
    result = solve(groups, until="pull-off")
    assert result.error_estimate is not None
    return row | {
        "force": pull_off_force(result),
        "force_difference": row["outputAmplification"] / pull_off_force(result) - 1,
        "work_difference": row["workofSepration"] / WORK_UNIT / work_to_pull_off(result) - 1,
        "estimate": result.error_estimate["force"],
        "energy_residual": result.energy_residual,
        "time": perf_counter() - began,
    }


def inputs_of(row: Row) -> dict[str, float]:
    """Return the inputs of a published row in the words of a campaign."""
    return {
        "tabor": row["mu"],
        "modulus_ratio": row["k"],
        "exponent": row["n"],
        "preload": row["alphaload"],
        "rate": -row["runload"],
    }


def simulated(rows: Sequence[Row], folder: Path, accuracy: float, workers: int) -> dict[str, Row]:
    """Return the rows of a campaign over published rows by the name of their case."""
    sphere = KINDS["sphere"]
    named = {name_of(row): inputs_of(row) for row in rows}
    plan = Plan(
        kind=sphere,
        cases=tuple(Case(name, inputs) for name, inputs in named.items()),
        settings=CaseSettings(accuracy=accuracy),
    )
    run(plan, folder, workers=workers)
    found = {row["name"]: row for row in Store(folder).results().to_pylist()}
    missing = [named[name] for name in named if name not in found]
    if missing:
        raise RuntimeError(f"{len(missing)} cases have no result, the first is {missing[0]}")
    return found


def name_of(row: Row) -> str:
    """Return the name of a published row's case; repeated inputs have the same."""
    return run_id(KINDS["sphere"].problem(inputs_of(row)))


def compare(rows: Sequence[Row], folder: Path, workers: int) -> list[Row]:
    """Return the published rows with what the simulation says of them, and the decided ones."""
    ours = simulated(rows, folder / "default", CaseSettings.accuracy, workers)
    found = [_differences(row, ours[name_of(row)]) for row in rows]
    apart = [row for row in found if abs(row["force_difference"]) > APART]
    best = simulated(apart, folder / "converged", CONVERGED, workers) if apart else {}
    return [_decided(row, best) for row in found]


def _differences(row: Row, ours: Row) -> Row:
    work = row["workofSepration"] / WORK_UNIT / ours["work_to_pull_off"] - 1
    return row | {
        "name": ours["name"],
        "ours": {name: ours[name] for name in _SHOWN},
        "force_difference": row["outputAmplification"] / ours["pull_off_force"] - 1,
        "work_difference": work if row["workofSepration"] != NO_WORK else np.nan,
        "in_tension": ours["trajectory_force"][0] < 0,
    }


def _decided(row: Row, best: dict[str, Row]) -> Row:
    """Return a row with the errors of both programs by the converged run, where it was made."""
    if abs(row["force_difference"]) <= APART:
        return row
    force = best[row["name"]]["pull_off_force"]
    return row | {
        "published_error": row["outputAmplification"] / force - 1,
        "our_error": row["ours"]["pull_off_force"] / force - 1,
    }


def main() -> None:
    """Run and print, or write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_table(parser)
    parser.add_argument("--count", type=int, help="so many rows at random; all if left out")
    parser.add_argument("--seed", type=int, default=2026)
    parser.add_argument("--out", type=Path, default=Path("out/published"))
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--write", action="store_true", help="write docs/published-data.md")
    chosen = parser.parse_args()
    if chosen.write and chosen.table.resolve() == SAMPLE:
        parser.error("--write is for the complete table: give its path by --table")
    rows = published_rows(chosen.table, chosen.count or 1_000_000, chosen.seed)
    found = compare(rows, chosen.out, chosen.workers)
    from published_page import page, write

    if chosen.write:
        write(found)
    else:
        print(page(found))


if __name__ == "__main__":
    main()
