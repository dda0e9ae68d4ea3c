"""How many rows the surrogate needs, and what it says of materials that it has never seen.

`python -m benchmarks.surrogate_rows [--steps 1500]`: one network of the force each, between the
limits that the shipped surrogate has. First from more and more rows, drawn at random from those
learned from, judged by rows of `fresh`. Then without whole materials: modulus ratio and exponent
are cut into 6 x 6 cells, every sixth of which is left out at a time, in such a pattern that the
neighbours of a cell are there; it is judged by the cells left out. A quarter of an hour on one
core; docs/surrogate.md shows the tables.
"""

from __future__ import annotations

import argparse

import numpy as np

from training.fitting import Fit
from training.rows import Rows, certain, read
from training.train_sphere import parted
from viscotack.surrogate import physics

from .surrogate_candidates import between_limits

ROWS, BANDS = (1250, 2500, 5000, 10_000, 20_000), 6


def said_of(error: np.ndarray) -> str:
    """Return the cells of a table for errors of log10 of the force."""
    size = np.abs(error)
    return (
        f"{np.mean(error**2):.1e} | {np.median(size):.1e} | {np.quantile(size, 0.95):.1e} | "
        f"{size.max():.1e}"
    )


def learning_curve(rows: Rows, how: Fit) -> None:
    """Print errors by the number of rows learned from."""
    fresh = read("fresh").chosen(certain("fresh"))
    true = np.log10(fresh.force)
    print(f"| rows | MSE of {len(fresh)} of `fresh` | median | 95 % below | largest |")
    print("|---:|---|---|---|---|")
    order = np.random.default_rng(5).permutation(len(rows))
    for count in (*ROWS, len(rows)):
        error = between_limits(rows.chosen(order[:count]), how)(fresh) - true
        print(f"| {count:,} | {said_of(error)} |", flush=True)


def materials(rows: Rows, how: Fit) -> None:
    """Print errors of materials left out, those inside of the range and those at its ends."""
    place = (physics.scaled(rows.groups) + 1) / 2 * BANDS
    bands = np.clip(np.floor(place).astype(int), 0, BANDS - 1)
    k, n = (bands[:, column] for column in (physics.MODULUS_RATIO, physics.EXPONENT))
    part = (k + 2 * n) % BANDS
    edge = (k % (BANDS - 1) == 0) | (n % (BANDS - 1) == 0)
    print("| materials left out | rows | MSE | median | 95 % below | largest |")
    print("|---|---:|---|---|---|---|")
    errors = np.empty(len(rows))
    for number in range(BANDS):
        held = part == number
        found = between_limits(rows.chosen(~held), how)(rows.chosen(held))
        errors[held] = found - np.log10(rows.force[held])
    for words, some in (("between others", ~edge), ("at an end of the range", edge)):
        print(f"| {words} | {some.sum()} | {said_of(errors[some])} |", flush=True)


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=1500)
    how = Fit(steps=parser.parse_args().steps)
    learned, _ = parted()
    learning_curve(learned, how)
    materials(learned, how)


if __name__ == "__main__":
    main()
