"""Which contacts of engineers `viscotack.predict` answers within milliseconds, and by what.

`python -m benchmarks.engineering [--count 75] [--seed SEED] [--write]`: so many contacts of each
family of `training/contacts.py`, in SI; how many the surrogates answer, and which tier covers the
others. With --write the table goes into the records that docs/surrogate.md quotes.
`benchmarks/judging.py` compares those answered with simulations.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter

import numpy as np

from training.contacts import FAMILIES
from training.fresh_cases import Case, drawn
from viscotack import OutOfRange, predict
from viscotack.forecast.tiers import AT_ONCE, EXACT, LEARNED, THEORIES

AT_ONCE_NAMES = {one.name for one in LEARNED}


def tier(case: Case) -> str:
    """Return the name of the surrogate that answers, or of the next tier that covers a contact."""
    try:
        return predict(case.problem, budget=AT_ONCE).method
    except OutOfRange as reason:
        if "not certain" in str(reason):
            return "simulation, as the surrogate abstains"
    return next(one.name for one in (*THEORIES, EXACT) if not one.covers(case.problem))


def table(count: int, seed: int) -> list[str]:
    """Return the lines of the table of families."""
    rows = [
        "| family | contacts | Tabor number: 5, 50, 95 % | answered at once | by |",
        "|---|---:|---|---:|---|",
    ]
    for family in FAMILIES:
        cases = drawn(seed, {family: count})
        tiers = [tier(case) for case in cases]
        tabor = [case.problem.tabor for case in cases if not case.inputs["stamp"]]
        between = (
            ", ".join(f"{x:.3g}" for x in np.quantile(tabor, [0.05, 0.5, 0.95])) if tabor else ""
        )
        share = np.mean([name in AT_ONCE_NAMES for name in tiers])
        some = ", ".join(f"{name} {number}" for name, number in Counter(tiers).most_common())
        rows.append(f"| {family} | {count} | {between} | {share:.0%} | {some} |")
    return rows


def main() -> None:
    """Draw, predict and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=75)
    parser.add_argument("--seed", type=int, default=1334094891)
    parser.add_argument("--write", action="store_true", help="into the records")
    given = parser.parse_args()
    rows = table(given.count, given.seed)
    print("\n".join(rows))
    if given.write:
        print(json.dumps({"tiers": rows}, indent=1))


if __name__ == "__main__":
    main()
