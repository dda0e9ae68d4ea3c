"""Compare the headline of every interface, and its band with the simulation.

`python -m benchmarks.headline [--count 200] [--seed 1]` draws contacts as the fuzzer does, half of
them in or near the range of the surrogates, half of any shape, solid, law and history. Each is
stated in SI to `predict`, `advise`, the page and HTTP with the default budget: all must have the
same pull-off force, or none. Then `predict(exact=True)`, `solve` and a campaign must agree to the
last digit, and their force must lie in the interval of the headline, widened by the stated error of
the simulation, in nine of ten cases. Fifteen minutes.
"""

from __future__ import annotations

import argparse
from collections import Counter
from pathlib import Path
from typing import Any

import viscotack as vt
from fuzz.cases import OWN, Luck, contact
from fuzz.doors import client, in_words, learned_punch, learned_sphere
from fuzz.relations import in_si
from viscotack.app.engine.overview import quick
from viscotack.app.engine.page_tasks import ask_verdict
from viscotack.campaign import CaseSettings, measure
from viscotack.operations.declare.state import state_of_toml
from viscotack.traction import Tabulated

# Largest effective Tabor number that is simulated beside: seconds each.
_SIMULATED = 40.0


def drawn(luck: Luck) -> vt.Problem:
    """Return a random problem in SI, as its case file states it."""
    while True:
        kind = luck.one({contact: 0.5, learned_sphere: 0.4, learned_punch: 0.1})
        try:
            problem = in_si(kind(luck), luck)
        except vt.InputError:  # strains are not small, or the start is out of all range
            continue
        # tables of laws are files, and a user's own nouns are not on the page
        nouns = (problem.traction, problem.material, problem.geometry)
        if not any(isinstance(noun, (Tabulated, *OWN)) for noun in nouns):
            return problem


def headlines(problem: vt.Problem) -> dict[str, float | str]:
    """Return the pull-off force by each interface [N, of a punch Pa], or "refused"."""
    scales: Any = problem.scales()
    punch = isinstance(problem.geometry, vt.FlatPunch)
    unit = scales.stress if punch else scales.force
    found: dict[str, Any] = {}
    try:
        found["predict"] = vt.predict(problem).pull_off_force * unit
    except vt.InputError:
        found["predict"] = "refused"
    try:
        force = vt.advise(problem).pull_off_force
        found["advise"] = "refused" if force is None else force * unit
    except vt.InputError:  # advice is for spheres that are pulled at once
        pass
    said = client().post("/api/predict", json={"problem": vt.to_dict(problem)})
    name = "pull_off_stress_Pa" if punch else "pull_off_force_N"
    found["HTTP"] = said.json()[name] if said.status_code == 200 else "refused"
    state = state_of_toml(in_words(problem, Path()))
    numbers = quick(state)["numbers"] or ask_verdict({"tables": state.tables}, print, ())["numbers"]
    found["page"] = numbers[0]["value"] if numbers else "refused"
    return found


def beside(problem: vt.Problem) -> tuple[bool, bool] | None:
    """Return whether the exact answers agree, and whether they lie in the band of the headline."""
    groups = problem.groups()
    if getattr(groups, "effective_tabor", 0.0) > _SIMULATED:
        return None
    try:
        predicted = vt.predict(problem)
        exact = vt.predict(problem, exact=True)
    except vt.InputError:
        return None
    result = vt.solve(problem, until="pull-off")
    row = measure(problem, CaseSettings(until="pull-off"))
    name = "pull_off_stress" if groups.in_plane_strain else "pull_off_force"
    alike = exact.pull_off_force == vt.pull_off_force(result) == row[name]
    (low, high), (least, most) = predicted.interval, exact.interval
    return alike, low <= most and least <= high


def main() -> None:
    """Draw, compare, and print the counts."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    counts: Counter[str] = Counter()
    methods: dict[str, Counter[bool]] = {}
    for number in range(asked.count):
        problem = drawn(Luck(asked.seed, number))
        found = headlines(problem)
        if len({f"{x:.12g}" if isinstance(x, float) else x for x in found.values()}) > 1:
            counts["headlines differ"] += 1
            print(f"{number}: {found}\n  {problem!r}", flush=True)
        if found["predict"] == "refused":
            counts["refused"] += 1
            continue
        counts["answered"] += 1
        if (pair := beside(problem)) is None:
            continue
        alike, inside = pair
        counts["exact answers differ"] += not alike
        method = vt.predict(problem).method
        methods.setdefault(method, Counter())[inside] += 1
        if not (alike and inside):
            print(f"{number}: alike {alike}, inside {inside}, {method}\n  {problem!r}", flush=True)
    print(dict(counts))
    for method, held in methods.items():
        print(f"  {method:22} {held[True]} of {held.total()} inside")
    total = sum(methods.values(), Counter())
    print(f"  {'all':22} {total[True]} of {total.total()} inside")


if __name__ == "__main__":
    main()
