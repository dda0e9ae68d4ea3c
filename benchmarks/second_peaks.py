"""Solve rows of the data sets again whose force may have a second, larger peak.

`python benchmarks/second_peaks.py [--sets broad rough] [--accuracy 0.01]`: suspects are contacts
from starts deeper than 5 h0 whose stored pull-off lies within the first 15 % of the depth,
retracted by 0.05 to 10 depths in the retardation time. An earlier `solve` ended their runs at the
first peak; each is simulated again to the largest tension of the whole retraction, and those that
change once more, ten times as accurately. Prints how many change by more than 1 % (force) or 5 %
(work), and these rows. `--correct rough 2799` writes today's answer into a row of a file and prints
its new checksum, for `src/viscotack/datasets/SHA256SUMS`.
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from viscotack import datasets, pull_off_force, solve, work_to_pull_off
from viscotack.campaign.case import CaseSettings, measure
from viscotack.campaign.columns import KINDS
from viscotack.campaign.random_solids import creep_spectrum
from viscotack.datasets.columns import KEPT
from viscotack.datasets.files import checksum

SPHERES = ("broad", "thesis", "chosen", "steep", "fresh", "unseen", "hard", "deep")
SOLIDS = ("solids", "rough", "sharp")
PUNCHES = ("punch", "punch_starts", "punch_faces")
# Least depth [h0], largest travel over depth, and rate times retardation time over depth.
_DEEP, _EARLY, _RATES = 5.0, 0.15, (0.05, 10.0)
# Changes of force and work that count, and how much finer they are confirmed.
_CHANGED, _FINER = np.array([0.01, 0.05]), 10.0


def suspects(name: str) -> list[int]:
    """Return the indices of the suspects of a set."""
    table = datasets.load(name)
    depth, rate, travel = (
        table.column(n).to_numpy() for n in ("preload", "rate", "travel_to_pull_off")
    )
    near = np.flatnonzero((depth > _DEEP) & (travel < _EARLY * depth))
    times = np.ones(len(depth))
    if name in SOLIDS:
        number, k = (table.column(n).to_numpy() for n in ("solid", "modulus_ratio"))
        for i in near:
            weights, tau = creep_spectrum(number[i], k[i])
            times[i] = np.exp(weights @ np.log(tau))
    part = rate * times / depth
    return [int(i) for i in near if _RATES[0] <= part[i] <= _RATES[1]]


def solved(name: str, row: dict[str, Any], accuracy: float) -> np.ndarray:
    """Return force (or stress) and work of a row by today's simulation."""
    kind = KINDS["punch" if name in PUNCHES else "solid" if name in SOLIDS else "sphere"]
    problem = kind.problem({n: row[n] for n in (*kind.columns, "preload")})
    result = solve(problem, accuracy=accuracy, until="pull-off", estimate_error=False)
    return np.array([pull_off_force(result), work_to_pull_off(result)])


def corrected(name: str, index: int) -> str:
    """Write a row of a set again, at its accuracy, and return the checksum of the file."""
    path, kind = datasets.path(name), KINDS["solid" if name in SOLIDS else "sphere"]
    table = pq.read_table(path)
    old = table.slice(index, 1).to_pylist()[0]
    inputs = {n: old[n] for n in (*kind.columns, "preload")}
    row = measure(kind.problem(inputs), CaseSettings(accuracy=old["accuracy"], until="pull-off"))
    row |= inputs | {"accuracy": old["accuracy"]}
    values = {column.name: column.value(row) for column in KEPT[kind.name]}
    new = pa.table({n: pa.array([values[n]], table.schema.field(n).type) for n in old}).cast(
        table.schema
    )
    parts = table.slice(0, index), new, table.slice(index + 1)
    whole = pa.concat_tables(parts).combine_chunks().replace_schema_metadata(table.schema.metadata)
    pq.write_table(whole, path, compression="zstd", compression_level=19)
    return checksum(path.read_bytes())


def main() -> None:
    """Check and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sets", nargs="+", default=(*SPHERES, *SOLIDS, *PUNCHES))
    parser.add_argument("--accuracy", type=float, default=0.01)
    parser.add_argument("--count", action="store_true", help="count suspects only")
    parser.add_argument("--correct", nargs=2, metavar=("SET", "ROW"))
    given = parser.parse_args()
    if given.correct:
        name, index = given.correct
        print(f"{corrected(name, int(index))}  {name}.parquet")
        return
    for name in given.sets:
        found, table = suspects(name), datasets.load(name)
        if given.count:
            print(f"{name}: {len(found)} suspects of {table.num_rows}")
            continue
        changed = 0
        for i in found:
            row = table.slice(i, 1).to_pylist()[0]
            force = row["pull_off_stress" if name in PUNCHES else "pull_off_force"]
            stored = np.array([force, row["work_to_pull_off"]])
            now = solved(name, row, given.accuracy)
            if np.any(np.abs(now / stored - 1) > _CHANGED):
                now = solved(name, row, given.accuracy / _FINER)
            if np.any(np.abs(now / stored - 1) > _CHANGED):
                changed += 1
                print(f"  {name} {i}: stored {stored.round(4)}, now {now.round(4)}", flush=True)
        print(f"{name}: {changed} of {len(found)} suspects changed", flush=True)


if __name__ == "__main__":
    main()
