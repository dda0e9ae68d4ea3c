"""How often the interval of the predicted depth at pull-off holds the simulated depth.

`python benchmarks/depth_interval.py [--count 400]`: rows of sets that no network of the answers
learned from, drawn at random; the 90 % interval beside the depth of the row. About a minute.
"""

from __future__ import annotations

import argparse

import numpy as np

from viscotack import predict
from viscotack.campaign.columns import KINDS
from viscotack.datasets import load
from viscotack.errors import InputError

SETS = {"fresh": "sphere", "punch_faces": "punch"}


def measure(name: str, kind: str, count: int, seed: int) -> str:
    """Return how often the intervals hold, and how wide they are beside the errors."""
    stored = load(name)
    table = {column: stored[column].to_numpy() for column in (*_columns(kind), "depth_at_pull_off")}
    rows = np.random.default_rng(seed).permutation(len(table["rate"]))[:count]
    held, ratio = [], []
    for row in rows:
        case = {column: float(table[column][row]) for column in _columns(kind)}
        try:
            found = predict(KINDS[kind].problem(case))
        except InputError:
            continue
        if found.depth_interval is None or found.curve is None:
            continue
        (low, high), true = found.depth_interval, table["depth_at_pull_off"][row]
        held.append(low <= true <= high)
        ratio.append((high - low) / 2 / max(abs(found.curve.depth[-1] - true), 1e-12))
    return (
        f"{name}: {len(held)} rows, {100 * np.mean(held):.1f} % inside, half width over error "
        f"{np.median(ratio):.1f} in the median"
    )


def _columns(kind: str) -> tuple[str, ...]:
    return (*KINDS[kind].columns, "preload")


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    for name, kind in SETS.items():
        print(measure(name, kind, chosen.count, chosen.seed))


if __name__ == "__main__":
    main()
