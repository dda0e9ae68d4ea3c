"""Which contacts of engineers `viscotack.predict` answers, by what, and whether intervals hold.

`python -m benchmarks.engineering [--count 75] [--seed SEED] [--labels FOLDER] [--most N]`: so many
contacts of each family of `training/contacts.py`, in SI. The seed is that of the record of
`benchmarks/judging.py` if left out. Prints how many the surrogates answer within milliseconds, and
which tier covers the others. With --labels, those answered are simulated at an accuracy of 2e-4, up
to a Tabor number of 30 and so many at most; a run that was stopped continues.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from dataclasses import replace
from pathlib import Path
from time import perf_counter

import numpy as np

from training.contacts import FAMILIES, contact
from training.fresh_cases import Case, labelled
from viscotack import OutOfRange, predict
from viscotack.forecast.tiers import AT_ONCE, EXACT, LEARNED, THEORIES

from .fresh_coverage import judged, table
from .judging import record_path, words, worst

ACCURACY, LARGEST = 2e-4, 30.0
AT_ONCE_NAMES = {one.name for one in LEARNED}


def cases(count: int, seed: int) -> list[Case]:
    """Return contacts of all families, in turns."""
    found = []
    for number, family in enumerate(FAMILIES):
        random = np.random.default_rng([seed, 100 + number])
        found.append([Case(family, "contact", contact(family, random)) for _ in range(count)])
    return [case for turn in zip(*found, strict=True) for case in turn]


def tier(case: Case) -> str:
    """Return the name of the surrogate that answers, or of the next tier that covers a contact."""
    try:
        return predict(case.problem, budget=AT_ONCE).method
    except OutOfRange as reason:
        if "not certain" in str(reason):
            return "simulation, as the surrogate abstains"
    return next(one.name for one in (*THEORIES, EXACT) if not one.covers(case.problem))


def main() -> None:
    """Draw, predict, compare and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=75)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--labels", type=Path)
    parser.add_argument("--most", type=int, help="simulate so many at most")
    given = parser.parse_args()
    seed = given.seed
    if seed is None:
        seed = int(json.loads(record_path().read_text(encoding="utf-8"))["seed"])
    drawn = cases(given.count, seed)
    began = perf_counter()
    tiers = [tier(case) for case in drawn]
    each = 1e3 * (perf_counter() - began) / len(drawn)
    print(f"Seed {seed}; {each:.1f} ms a contact:\n")
    print("| family | contacts | Tabor number: 5, 50, 95 % | answered at once | by |")
    print("|---|---:|---|---:|---|")
    for family in FAMILIES:
        of = [i for i, case in enumerate(drawn) if case.design == family]
        tabor = [drawn[i].problem.tabor for i in of if not drawn[i].inputs["stamp"]] or [np.nan]
        between = ", ".join(f"{x:.3g}" for x in np.quantile(tabor, [0.05, 0.5, 0.95]))
        counts = Counter(tiers[i] for i in of).most_common()
        share = np.mean([tiers[i] in AT_ONCE_NAMES for i in of])
        some = ", ".join(f"{name} {number}" for name, number in counts)
        print(f"| {family} | {len(of)} | {between} | {share:.0%} | {some} |")
    if given.labels is None:
        return
    asked = [
        case
        for case, name in zip(drawn, tiers, strict=True)
        if name in AT_ONCE_NAMES and (case.inputs["stamp"] or case.problem.tabor <= LARGEST)
    ]
    known = list(labelled(asked[: given.most], given.labels, ACCURACY))
    found = [judged(case, label) for case, label in known if "failed" not in label]
    print(f"\n{len(found)} of {len(asked)} simulated:")
    by_tier = [replace(one, case=replace(one.case, design=one.method)) for one in found]
    print(table(by_tier))
    for one in worst(found):
        print(words(one))


if __name__ == "__main__":
    main()
