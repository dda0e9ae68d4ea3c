"""How far ten measured points move the answers towards labs whose truth differs.

`python benchmarks/moved_lab.py [--labs 60] [--points 10]`: labs whose work of adhesion, times,
modulus ratio and exponent are others than they believe (a fifth, half a decade, a third, a tenth,
standard deviations), and whose forces are measured to 3 %. The truth is the surrogate at their true
inputs times a smooth error of rate and depth. Errors at 200 other points of the lab's
own tests: its solid, all rates, other depths.
"""

from __future__ import annotations

import argparse

import numpy as np

from viscotack.surrogate import physics
from viscotack.surrogate.moving import moved
from viscotack.surrogate.store import shipped

_NOISE, _TESTED = 0.03, 200


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--labs", type=int, default=60)
    parser.add_argument("--points", type=int, nargs="+", default=[3, 5, 10, 20])
    given = parser.parse_args()
    print("| points | error before, median of labs | after | ratio | labs halved | 90 % held |")
    print("|---|---|---|---|---|---|")
    for count in given.points:
        found = np.array([lab(seed, count) for seed in range(given.labs)])
        before, after, held = found.T
        print(
            f"| {count} | {np.median(before):.1%} | {np.median(after):.1%} | "
            f"{np.median(after / before):.2f} | {np.mean(after < before / 2):.0%} | "
            f"{np.mean(held):.0%} |"
        )


def lab(seed: int, count: int) -> tuple[float, float, float]:
    """Return the root mean square errors of a lab before and after, and what intervals held."""
    random = np.random.default_rng(seed)
    low, high = physics.LOW * 3, physics.HIGH / 3
    believed = low * (high / low) ** random.random(5)
    factor = 10 ** (random.normal(size=5) * [0.05, 0.12, 0.04, 0.0, 0.5])
    believed[physics.EXPONENT] = np.clip(believed[physics.EXPONENT], 0.25, 1.6)
    rows = np.tile(believed, (count + _TESTED, 1))
    rows[:, physics.RATE] = 10 ** random.uniform(-1, 8, len(rows))
    rows[:, physics.PRELOAD] = 10 ** random.uniform(0, 2.3, len(rows))
    true = np.clip(rows * factor, physics.LOW, physics.HIGH)
    adhesion, slope = 10 ** (0.08 * random.normal()), 0.02 * random.normal(size=2)
    place = physics.scaled(rows)[:, [physics.PRELOAD, physics.RATE]]
    truth = shipped().evaluate(true).pull_off_force * adhesion * 10 ** (place @ slope)
    measured = truth[:count] * np.exp(_NOISE * random.normal(size=count))
    learned = moved(shipped(), rows[:count], measured, error=_NOISE)
    others, wanted = rows[count:], truth[count:]
    said = learned.evaluate(others)
    held = learned.intervals(others, said).pull_off_force
    before = np.log(shipped().evaluate(others).pull_off_force / wanted)
    after = np.log(said.pull_off_force / wanted)
    inside = (held[:, 0] <= wanted) & (wanted <= held[:, 1])
    return (
        float(before.std() + abs(before.mean())),
        float(after.std() + abs(after.mean())),
        float(inside.mean()),
    )


if __name__ == "__main__":
    main()
