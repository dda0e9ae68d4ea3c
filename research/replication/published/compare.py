"""Rows of a table of detachments beside the simulation of the same cases."""

import csv
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.campaign import CaseSettings, Store, read_plan, run

from ..table import Detachments

# Two programs that are apart by more need a third opinion.
APART = 0.02
CONVERGED = 1e-4
INPUTS = ("tabor", "modulus_ratio", "exponent", "preload", "rate")
_SHOWN = (
    *("pull_off_force", "work_to_pull_off", "error_estimate", "error_estimate_work"),
    *("energy_residual", "wall_time_s"),
)

Row = dict[str, Any]
Inputs = tuple[float, ...]


def compare(table: Detachments, folder: Path, *, workers: int) -> list[Row]:
    """Return the rows of a table with what the simulation says of them.

    Where the two are apart by more than ``APART``, a converged run decides. Runs go on in their
    folder where they were stopped. A row has the five inputs; ``force`` and ``work`` of the table;
    ``ours``, numbers of the simulation by name; ``force_difference`` and ``work_difference``, the
    table's over ours, less one (nan where the table has no work); ``in_tension``, whether it starts
    so; where they are apart ``table_error`` and ``our_error`` of the force, by the converged run,
    and ``best``, its numbers.
    """
    ours = simulated(table, folder / "default", CaseSettings.accuracy, workers)
    rows = [_differences(table, i, ours) for i in range(len(table))]
    apart = np.array([abs(row["force_difference"]) > APART for row in rows])
    best = simulated(table.chosen(apart), folder / "converged", CONVERGED, workers)
    return [_decided(row, best) for row in rows]


def inputs_of(row: Row) -> Inputs:
    """Return the five numbers that state a case; repeated ones are the same case."""
    return tuple(float(row[name]) for name in INPUTS)


def simulated(
    table: Detachments, folder: Path, accuracy: float, workers: int
) -> dict[Inputs, dict[str, Any]]:
    """Return the rows of a campaign over the cases of a table, by their inputs."""
    cases = dict.fromkeys(zip(*(getattr(table, name).tolist() for name in INPUTS), strict=True))
    if not cases:
        return {}
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "cases.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([INPUTS, *cases])
    run(read_plan(folder / "cases.csv", accuracy=accuracy), folder / "runs", workers=workers)
    found = {inputs_of(row): row for row in Store(folder / "runs").results()}
    missing = [case for case in cases if case not in found]
    if missing:
        words = dict(zip(INPUTS, missing[0], strict=True))
        raise RuntimeError(f"{len(missing)} cases have no result, the first is {words}")
    return found


def _differences(table: Detachments, i: int, simulations: dict[Inputs, dict[str, Any]]) -> Row:
    row = {name: float(getattr(table, name)[i]) for name in INPUTS}
    ours = simulations[inputs_of(row)]
    force, work = float(table.pull_off_force[i]), float(table.work_to_pull_off[i])
    return row | {
        "force": force,
        "work": work,
        "ours": {name: ours[name] for name in _SHOWN},
        "force_difference": force / ours["pull_off_force"] - 1,
        "work_difference": work / ours["work_to_pull_off"] - 1 if table.work_known[i] else np.nan,
        "in_tension": ours["trajectory_force"][0] < 0,
    }


def _decided(row: Row, best: dict[Inputs, dict[str, Any]]) -> Row:
    """Return a row with the errors of both programs by the converged run, where it was made."""
    if abs(row["force_difference"]) <= APART:
        return row
    found = best[inputs_of(row)]
    force = found["pull_off_force"]
    return row | {
        "best": {name: found[name] for name in _SHOWN},
        "table_error": row["force"] / force - 1,
        "our_error": row["ours"]["pull_off_force"] / force - 1,
    }
