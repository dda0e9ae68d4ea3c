"""How far predictions jump where the surrogate of simulations meets that of the crack theory.

`python benchmarks/seam.py [--count 400] [--seed 9] [--judged 30]`: spheres on power laws just below
and above a Tabor number of 10, other inputs even in the logarithm in both ranges. Prints the share
that both answer, the jump of the force, and how often the two intervals do not overlap. `--judged`
simulates so many cases at Tabor numbers of 10 to 20, a second each, and prints the errors of the
force with and without the factor that makes it continuous.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator

import numpy as np

from viscotack import OutOfRange, predict, pull_off_force, solve
from viscotack.campaign.columns import KINDS
from viscotack.forecast.prediction import Prediction
from viscotack.forecast.tiers import AT_ONCE
from viscotack.surrogate import physics

_BESIDE = 1e-6


def drawn(count: int, seed: int) -> Iterator[dict[str, float]]:
    """Yield the inputs of cases, even in the logarithm, with Tabor numbers of 10 to 20."""
    random = np.random.default_rng(seed)
    low, high = physics.LOW.copy(), np.minimum(physics.HIGH, [np.inf, 0.5, 2.0, 500.0, 1e7])
    low[physics.TABOR], high[physics.TABOR] = 10.0, 20.0
    for part in random.random((count, len(physics.INPUTS))):
        yield dict(zip(physics.INPUTS, (low * (high / low) ** part).tolist(), strict=True))


def jumps(count: int, seed: int) -> str:
    """Return how far forces jump at a Tabor number of 10, in words."""
    found, apart = [], 0
    for inputs in drawn(count, seed):
        sides = (_said(inputs | {"tabor": 10 * side}) for side in (1 - _BESIDE, 1 + _BESIDE))
        both = [said for said in sides if said is not None]
        if len(both) < 2:
            continue
        below, above = both
        found.append(abs(above.pull_off_force / below.pull_off_force - 1))
        ends = max(x.interval[0] for x in both), min(x.interval[1] for x in both)
        apart += ends[0] > ends[1]
    return (
        f"{len(found)} of {count} answered on both sides: jump of the force {np.median(found):.2%} "
        f"in the median, {np.quantile(found, 0.9):.2%} in nine of ten, {np.max(found):.2%} at "
        f"most; intervals that do not overlap: {apart}"
    )


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
    given = parser.parse_args()
    print(jumps(given.count, given.seed))
    if given.judged:
        print(errors(given.judged, given.seed))


if __name__ == "__main__":
    main()
