"""Simulate every row of the published table and say how far the two are apart.

``python -m research.replication.published --table FILE``. Where they are apart by more than 2 % a
converged run decides. The whole table takes a quarter of an hour of processor time, the sample in
tests/data, of 1,200 rows, a few minutes.
"""

import argparse
from pathlib import Path

import numpy as np

from viscotack import InputError

from ..table import SAMPLE, Detachments, read_detachments
from .compare import compare
from .corrected import write_corrected
from .page import page, write


def main() -> None:
    """Compare the tables, and print or write the page."""
    parser = argparse.ArgumentParser(
        prog="python -m research.replication.published", description=__doc__
    )
    add = parser.add_argument
    add("--table", type=Path, default=SAMPLE, help="the authors' table (CSV); if left out a sample")
    add("--count", type=int, help="so many rows at random; all if left out")
    add("--seed", type=int, default=2026, help="of the draw")
    add("--out", type=Path, default=Path("out/published"), help="runs; they go on where they ended")
    add("--workers", type=int, default=2, help="processes")
    add("--corrected", type=Path, help="write inputs, both forces and works, and our errors (CSV)")
    add("--write", type=Path, help="folder for README.md and its pictures; for the whole table")
    given = parser.parse_args()
    try:
        if given.write is not None and given.table.resolve() == SAMPLE:
            raise InputError("--write is for the complete table: give its path by --table")
        rows = read_detachments(given.table)
    except (ValueError, OSError, ModuleNotFoundError) as error:
        parser.error(str(error))
    found = compare(drawn(rows, given.count, given.seed), given.out, workers=given.workers)
    if given.corrected is not None:
        write_corrected(found, read_detachments(SAMPLE), given.corrected)
    if given.write is None:
        print(page(found))
    else:
        write(found, given.write)


def drawn(rows: Detachments, count: int | None, seed: int) -> Detachments:
    """Return some rows at random; all of them, in their order, where no count is given."""
    if count is None:
        return rows
    some = min(count, len(rows))
    return rows.chosen(np.random.default_rng(seed).choice(len(rows), some, replace=False))


if __name__ == "__main__":
    main()
