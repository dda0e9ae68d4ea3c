"""Does what is answered a little beyond the learned range hold? Simulation judges.

`python benchmarks/beyond.py [--count 24] [--seed 5]`: cases with Tabor numbers of 0.001 to 0.01,
with rates of 1e10 to 1e16 h0/tau0, and with modulus ratios of 1e-6 to 1e-4, other inputs evenly in
logarithms of their ranges. How many forces and works the 90 % intervals of `viscotack.predict`
hold, and the largest errors in half widths. docs/predict.md shows the result; a second or two a
case.
"""

from __future__ import annotations

import argparse

import numpy as np

from viscotack import OutOfRange, predict, solve
from viscotack.campaign.columns import KINDS
from viscotack.forecast.beyond import LEAST_RATIO, LEAST_TABOR, MOST_RATE
from viscotack.result.observables import pull_off_force, work_to_pull_off
from viscotack.surrogate.physics import HIGH, INPUTS, LIMITS, LOW, MODULUS_RATIO, RATE, TABOR

ENDS = {
    "Tabor numbers below 0.01": (TABOR, LEAST_TABOR, LIMITS["tabor"][0]),
    "rates beyond 1e10": (RATE, LIMITS["rate"][1], MOST_RATE),
    "modulus ratios below 1e-4": (MODULUS_RATIO, LEAST_RATIO, LIMITS["modulus_ratio"][0]),
}


def main() -> None:
    """Run and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=24)
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--only", choices=list(ENDS), help="one of the ends")
    given = parser.parse_args()
    print("| beyond | cases | held: force, work | largest errors, half widths |")
    print("|---|---|---|---|")
    ends = ENDS if given.only is None else {given.only: ENDS[given.only]}
    for name, (column, low, high) in ends.items():
        random, errors = np.random.default_rng(given.seed), []
        for part in random.random((given.count, len(INPUTS))):
            row = LOW * (HIGH / LOW) ** part
            row[column] = low * (high / low) ** part[column]
            problem = KINDS["sphere"].problem(dict(zip(INPUTS, row.tolist(), strict=True)))
            said = predict(problem)
            try:
                result = solve(problem, accuracy=1e-3, until="pull-off", estimate_error=False)
            except OutOfRange as refusal:
                print(refusal)
                continue
            errors.append([_off(pull_off_force(result), said.pull_off_force, said.interval)])
            if said.work_to_pull_off is not None and said.work_interval is not None:
                work = said.work_to_pull_off, said.work_interval
                errors[-1].append(_off(work_to_pull_off(result), *work))
        found = np.array(errors)
        held = ", ".join(map(str, (found <= 1).sum(axis=0)))
        worst = ", ".join(f"{x:.1f}" for x in found.max(axis=0))
        print(f"| {name} | {len(found)} | {held} | {worst} |", flush=True)


def _off(true: float, value: float, interval: tuple[float, float]) -> float:
    """Return an error in half widths of the interval on its side."""
    end = interval[1] if true > value else interval[0]
    return float(np.log(true / value) / np.log(end / value))


if __name__ == "__main__":
    main()
