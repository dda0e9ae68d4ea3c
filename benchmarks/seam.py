"""How far predictions jump where the range of the surrogate of simulations ends.

`python benchmarks/seam.py [--count 400] [--seed 9] [--judged 30] [--write]`: spheres on power laws
just below and above a Tabor number of 10, where the surrogate of the crack theory begins, other
inputs even in the logarithm in both ranges; and on both sides of the ends of the range beyond which
it is extrapolated. Prints the share that both sides answer, the jumps of force and work, and how
often the two intervals do not overlap. `--judged` simulates so many cases at Tabor numbers of 10 to
20, a second each, and prints the errors of the force with and without the factor that makes it
continuous. `--write` puts the largest jumps into the records that docs/surrogate.md quotes.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator

import numpy as np

from viscotack import OutOfRange, predict, pull_off_force, solve
from viscotack.campaign.columns import KINDS
from viscotack.forecast.prediction import Prediction
from viscotack.forecast.tiers import AT_ONCE
from viscotack.surrogate import physics

_BESIDE = 1e-6
# Ends of the range with predictions on both sides: of the crack theory, and extrapolations.
ENDS = ("tabor", 1), ("tabor", 0), ("modulus_ratio", 0), ("rate", 1)


def drawn(count: int, seed: int) -> Iterator[dict[str, float]]:
    """Yield the inputs of cases, even in the logarithm, with Tabor numbers of 10 to 20."""
    random = np.random.default_rng(seed)
    low, high = physics.LOW.copy(), np.minimum(physics.HIGH, [np.inf, 0.5, 2.0, 500.0, 1e7])
    low[physics.TABOR], high[physics.TABOR] = 10.0, 20.0
    for part in random.random((count, len(physics.INPUTS))):
        yield dict(zip(physics.INPUTS, (low * (high / low) ** part).tolist(), strict=True))


def at_end(name: str, end: int, count: int, seed: int) -> Iterator[tuple[dict[str, float], ...]]:
    """Yield the inputs of pairs of cases just inside and just outside an end of the range."""
    limit, outward = physics.LIMITS[name][end], 1 if end else -1
    if (name, end) == ENDS[0]:
        cases = drawn(count, seed)
    else:
        rows = np.random.default_rng(seed).random((count, len(physics.INPUTS)))
        rows = physics.LOW * (physics.HIGH / physics.LOW) ** rows
        cases = (dict(zip(physics.INPUTS, row, strict=True)) for row in rows.tolist())
    for inputs in cases:
        yield tuple(inputs | {name: limit * (1 + side * outward * _BESIDE)} for side in (-1, 1))


def jumps(name: str, end: int, count: int, seed: int) -> tuple[str, str]:
    """Return how far force and work jump at an end of the range, in words and as a line of a table.

    The line has the largest jumps.
    """
    pairs = [tuple(map(_said, pair)) for pair in at_end(name, end, count, seed)]
    both = [(a, b) for a, b in pairs if a is not None and b is not None]
    inside, limit = sum(a is not None for a, _ in pairs), physics.LIMITS[name][end]
    words = [f"{name} {limit:g}: {inside} of {count} answered inside, {len(both)} on both sides"]
    cells = [f"{name.replace('_', ' ')} {limit:g}", f"{inside}, {len(both)}"]
    for number, interval in (
        ("pull_off_force", "interval"),
        ("work_to_pull_off", "work_interval"),
    ):
        known = [
            [(getattr(x, number), *getattr(x, interval)) for x in pair]
            for pair in both
            if all(getattr(x, interval) is not None for x in pair)
        ]
        if not known:
            words.append(f"{number}: never on both sides")
            cells.append("not given beyond")
            continue
        (inner, low, high), (outer, least, most) = np.array(known).transpose(1, 2, 0)
        jump, apart = np.abs(outer / inner - 1), np.maximum(low, least) > np.minimum(high, most)
        cells.append(f"{jump.max():.2%}")
        words.append(
            f"{number}, {len(known)}: jump of {np.median(jump):.2%} in the median, "
            f"{np.quantile(jump, 0.9):.2%} in nine of ten, {jump.max():.2%} at most; intervals "
            f"that do not overlap: {apart.sum()}"
        )
    return "; ".join(words), f"| {' | '.join(cells)} |"


def errors(count: int, seed: int) -> str:
    """Return the errors of forces above a Tabor number of 10, in words."""
    found, held = [], []
    for inputs in drawn(100 * count, seed):
        if len(found) == count:
            break
        said = _said(inputs)
        if said is None:
            continue
        words = said.why.split("times ")
        factor = float(words[1].split(",")[0]) if len(words) > 1 else 1.0
        problem = KINDS["sphere"].problem(inputs)
        true = pull_off_force(solve(problem, until="pull-off", estimate_error=False))
        ratios = said.pull_off_force / true, said.pull_off_force / factor / true
        found.append([abs(x - 1) for x in ratios])
        held.append(said.interval[0] <= true <= said.interval[1])
    (median, plain), (most, largest) = np.median(found, axis=0), np.max(found, axis=0)
    return (
        f"{len(found)} simulated at Tabor numbers of 10 to 20: the force is off by {median:.2%} in "
        f"the median and {most:.2%} at most, without the factor by {plain:.2%} and {largest:.2%}; "
        f"{np.sum(held)} in their interval"
    )


def _said(inputs: dict[str, float]) -> Prediction | None:
    try:
        return predict(KINDS["sphere"].problem(inputs), budget=AT_ONCE)
    except OutOfRange:
        return None


def main() -> None:
    """Draw, predict and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=400)
    parser.add_argument("--seed", type=int, default=9)
    parser.add_argument("--judged", type=int, default=0)
    parser.add_argument("--write", action="store_true", help="the table, into the records")
    given = parser.parse_args()
    found = [jumps(name, end, given.count, given.seed) for name, end in ENDS]
    print("\n".join(words for words, _ in found))
    if given.write:
        head = "| end | answered inside, on both sides | largest jump: force | work |"
        print(
            json.dumps(
                {"table": [head, "|---|---|---:|---:|", *(row for _, row in found)]}, indent=1
            )
        )
    if given.judged:
        print(errors(given.judged, given.seed))


if __name__ == "__main__":
    main()
