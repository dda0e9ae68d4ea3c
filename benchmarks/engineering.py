"""Which contacts of engineers `viscotack.predict` answers, by what, and whether intervals hold.

`python -m benchmarks.engineering [--count 75] [--seed SEED] [--labels FOLDER]`: so many contacts of
each family of `training/contacts.py`, in SI. The seed is that of the record of
`benchmarks/judging.py` if left out. Prints how many each tier answers at the default budget, and
how many are refused within milliseconds. With --labels, those answered by surrogates or theories
are simulated at an accuracy of 2e-4, up to a Tabor number of 30; a run that was stopped continues.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from pathlib import Path
from time import perf_counter

import numpy as np

from training.contacts import FAMILIES, contact
from training.fresh_cases import Case, labelled
from viscotack import OutOfRange, predict
from viscotack.forecast.simulation import SIMULATION
from viscotack.forecast.tiers import SOON

from .fresh_coverage import OF, answered, judged, report
from .judging import record_path, words, worst

ACCURACY, LARGEST = 2e-4, 30.0


def cases(count: int, seed: int) -> list[Case]:
    """Return contacts of all families, in turns."""
    found = []
    for number, family in enumerate(FAMILIES):
        random = np.random.default_rng([seed, 100 + number])
        found.append([Case(family, "contact", contact(family, random)) for _ in range(count)])
    return [case for turn in zip(*found, strict=True) for case in turn]


def tier(case: Case) -> str:
    """Return the name of the tier that answers at the default budget."""
    try:
        return predict(case.problem).method
    except OutOfRange:
        return "refused"


def main() -> None:
    """Draw, predict, compare and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=75)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--labels", type=Path)
    given = parser.parse_args()
    seed = given.seed
    if seed is None:
        seed = int(json.loads(record_path().read_text(encoding="utf-8"))["seed"])
    drawn = cases(given.count, seed)
    began = perf_counter()
    soon = [answered(case) for case in drawn]
    print(f"seed {seed}; {1e3 * (perf_counter() - began) / len(drawn):.1f} ms a contact at once")
    tiers = [tier(case) for case in drawn]
    print("| family | contacts | Tabor number: 5, 50, 95 % | at once | tiers at the default budget |")
    print("|---|---:|---|---:|---|")
    for family in FAMILIES:
        of = [i for i, case in enumerate(drawn) if case.design == family]
        tabor = [drawn[i].problem.tabor for i in of if not drawn[i].inputs["stamp"]]
        range_ = ", ".join(f"{x:.3g}" for x in np.quantile(tabor, [0.05, 0.5, 0.95])) if tabor else ""
        counts = Counter(tiers[i] for i in of).most_common()
        share = np.mean([soon[i] for i in of])
        some = ", ".join(f"{name} {number}" for name, number in counts)
        print(f"| {family} | {len(of)} | {range_} | {share:.0%} | {some} |")
    if given.labels is None:
        return
    asked = [
        case
        for case, name in zip(drawn, tiers, strict=True)
        if name not in ("refused", SIMULATION)
        and (case.inputs["stamp"] or case.problem.tabor <= LARGEST)
    ]
    found = []
    for number, (case, label) in enumerate(labelled(asked, given.labels, ACCURACY), 1):
        if "failed" not in label:
            found.append(judged(case, label, budget=SOON))
        print(f"\r{number} of {len(asked)}", end="", flush=True)
    print(f"\n| tier | {', '.join(OF)} |")
    for name in dict.fromkeys(one.method for one in found):
        print(f"| {name} | {report([one for one in found if one.method == name])}")
    print(f"| all | {report(found)}")
    for one in worst(found):
        print(words(one))


if __name__ == "__main__":
    main()
