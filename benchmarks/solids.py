"""Do the intervals of solids hold where somebody picks the solid? Simulation judges.

`python benchmarks/solids.py [--count 25] [--seed 7]`: of each of four designs so many solids that
are as unlike power laws as can be had, and a Prony series fitted to a published measurement
(tests/data/dma_published), shifted over its 26 decades as a temperature does; tests evenly in the
range. How many forces and works the 90 % intervals of `viscotack.predict` hold, the largest errors,
and how many are refused. docs/surrogate.md shows the result; a second a case.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

import numpy as np

from viscotack import AtDepth, Groups, OutOfRange, Prony, solve
from viscotack.forecast import predict
from viscotack.forecast.tiers import AT_ONCE
from viscotack.lab import fit, read_dma
from viscotack.materials.conversion import RetardationSeries, relaxation_series
from viscotack.result.observables import pull_off_force, work_to_pull_off

MEASURED = Path(__file__).parents[1] / "tests/data/dma_published/freq_user_master.csv"
LOW, HIGH = np.log10([0.01, 0.005]), np.log10([10.0, 500.0])


def solid(k: float, steps: list[tuple[float, float]]) -> Prony:
    """Return a solid whose creep climbs in steps: parts of the logarithm, and log10 of times."""
    steps = sorted(steps, key=lambda step: step[1])
    shares = np.array([share for share, _ in steps])
    climbed = k ** (1 - np.cumsum(shares) / shares.sum())
    weights, times = np.diff(climbed, prepend=k), [10**time for _, time in steps]
    series = RetardationSeries(
        glassy_modulus=1 / k, elements=tuple(zip(weights, times, strict=True)), poisson_ratio=0.0
    )
    branches = relaxation_series(series).branches
    return Prony(rubbery_modulus=1.0, branches=branches, poisson_ratio=0.0)


def two_steps(random: np.random.Generator) -> Prony:
    """Return one with steps 2 to 6 decades apart, the test between or at one of them."""
    apart, middle = random.uniform(2, 6), random.uniform(-1.5, 1.5)
    part = random.uniform(0.2, 0.8)
    steps = [(part, middle - apart / 2), (1 - part, middle + apart / 2)]
    return solid(10 ** random.uniform(-4, -0.5), steps)


def one_step(random: np.random.Generator) -> Prony:
    """Return one with one step right at the time of the test."""
    return solid(10 ** random.uniform(-4, -0.5), [(1.0, random.uniform(-0.5, 1.5))])


def near_elastic(random: np.random.Generator) -> Prony:
    """Return one with a ratio of 0.5 to 0.7, one or two steps around the test."""
    steps = [(random.random() + 0.1, random.uniform(-2, 2)) for _ in range(2)]
    return solid(random.uniform(0.5, 0.7), steps)


def plateau(random: np.random.Generator) -> Prony:
    """Return glass up to the time of the test, which climbs at its end or just after."""
    steps = [(1.0, random.uniform(0.5, 1.0)), (random.random() + 0.05, random.uniform(1.2, 3.5))]
    return solid(10 ** random.uniform(-4, -1), steps)


DESIGNS: dict[str, Callable[[np.random.Generator], Prony]] = {
    "two steps far apart": two_steps,
    "one step at the time of the test": one_step,
    "nearly elastic": near_elastic,
    "glassy until the test": plateau,
}


def cases(count: int, seed: int) -> dict[str, list[Groups]]:
    """Return the cases of each design; the time h0 over the speed is one."""
    random, found = np.random.default_rng(seed), {}

    def test(material: Prony, rate: float) -> Groups:
        tabor, depth = 10 ** (LOW + (HIGH - LOW) * random.random(2))
        return Groups(tabor=tabor, material=material, start=AtDepth(depth), rate=rate)

    for name, draw in DESIGNS.items():
        found[name] = [test(draw(random), 1.0) for _ in range(count)]
    measured = fit(read_dma(MEASURED, kind="E"), model="prony", poisson_ratio=0.4, draws=0).material
    slowest = float(np.log10(measured.time_unit))
    found["measured polymer, shifted"] = [
        test(measured.reduced(), 10 ** random.uniform(-12 + slowest, 15 + slowest))
        for _ in range(count)
    ]
    return found


def main() -> None:
    """Run and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=25)
    parser.add_argument("--seed", type=int, default=7)
    given = parser.parse_args()
    print("| solids | answered | held: force, work | median error, force | largest, half widths |")
    print("|---|---|---|---|---|")
    for name, some in cases(given.count, given.seed).items():
        ratios, errors = [], []
        for groups in some:
            try:
                said = predict(groups, budget=AT_ONCE)
            except OutOfRange:
                continue
            result = solve(groups, until="pull-off", accuracy=5e-4, throw=False)
            force, work = pull_off_force(result), work_to_pull_off(result)
            pairs = [(force, said.pull_off_force, said.interval)]
            if said.work_to_pull_off is not None and said.work_interval is not None:
                pairs.append((work, said.work_to_pull_off, said.work_interval))
            found = [abs(np.log(t / v)) / np.log(ends[1] / v) for t, v, ends in pairs]
            ratios.append([*found, np.nan][:2])
            errors.append(abs(said.pull_off_force / force - 1))
        if not ratios:
            print(f"| {name} | 0 of {len(some)} | | | |", flush=True)
            continue
        held = np.sum(np.array(ratios) <= 1, axis=0)
        works = np.isfinite(np.array(ratios)[:, 1]).sum()
        worst = np.nanmax(ratios, axis=0)
        print(
            f"| {name} | {len(ratios)} of {len(some)} | {held[0]}, {held[1]} of {works} | "
            f"{np.median(errors):.2%} | {worst[0]:.1f}, {worst[1]:.1f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
