"""Runs to the pull-off beside whole ones: second peaks of the force, and what looking costs.

`python benchmarks/peaks.py [--count 150] [--seed 3]`: random pulls at an accuracy of 0.01, each to
the pull-off and until detached. Deep and fast spheres, those of the whole range (`cases.spread`),
and punches. About ten minutes.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

from cases import case, spread, spread_out, standard_solid
from random_problems import Luck

from viscotack import AtDepth, FlatPunch, Groups, Layer, peaks, pull_off_force, solve
from viscotack.bem import SimulationError
from viscotack.bem.books import Lowest
from viscotack.errors import InputError

ACCURACY = 0.01
# Forces that differ by less are of one peak: past the pull-off steps may be longer.
SAME = 1e-3


def fast(seed: int, number: int) -> Groups:
    """Return a deep sphere that is pulled about as fast as its bulk relaxes."""
    luck = Luck(seed, number)
    tabor, ratio = luck.decades(0.1, 10), luck.decades(1e-4, 0.05)
    depth = min(tabor * luck.decades(10, 100), 500.0)
    rate = depth * luck.decades(0.4, 1.6)
    if luck.happens(0.5):
        solid = standard_solid(ratio)
        return Groups(tabor=tabor, material=solid, start=AtDepth(depth), rate=rate)
    return case(tabor, ratio, luck.within(1.0, 2.0), depth, rate)


def punch(seed: int, number: int) -> Groups:
    """Return a punch of a standard solid."""
    luck = Luck(seed, number)
    depth = luck.decades(0.1, 30)
    return Groups(
        tabor=None,
        cohesion=0.05,
        geometry=FlatPunch(luck.decades(5, 200)),
        body=Layer(luck.decades(0.3, 300)),
        material=standard_solid(luck.decades(1e-3, 0.1)),
        start=AtDepth(depth),
        rate=depth * luck.decades(0.2, 30),
    )


def looked_at(groups: Groups) -> dict[str, Any] | None:
    """Return both forces, the number of peaks, and steps to where the force had risen by 3 %."""
    try:
        ended, whole = (
            solve(groups, accuracy=ACCURACY, until=until, estimate_error=False)
            for until in ("pull-off", "detached")
        )
        forces = [peak.force for peak in peaks(whole)]
        row = {"missed": pull_off_force(whole) / pull_off_force(ended) - 1, "peaks": len(forces)}
    except (InputError, SimulationError):
        return None
    lowest, first = Lowest(), len(ended.force)
    for step, force in enumerate(ended.force):
        lowest = lowest.after(force)
        if lowest.behind(force):
            first = step + 1
            break
    later = len(forces) > 1 and forces[0] < max(forces)
    return row | {"larger": later, "steps": len(ended.force), "first": first}


def report(name: str, problems: list[Any]) -> None:
    """Print what is said of some pulls."""
    rows = [row for row in spread_out(looked_at, problems) if row is not None]
    steps, first = (sum(row[key] for row in rows) for key in ("steps", "first"))
    print(
        f"{name}: {len(rows)} pulls, {sum(row['peaks'] > 1 for row in rows)} with two peaks, the "
        f"second larger in {sum(row['larger'] for row in rows)}; missed "
        f"{sum(row['missed'] > SAME for row in rows)}; {100 * (steps / first - 1):.1f} % more "
        "steps than to a rise of 3 %",
        flush=True,
    )


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=150)
    parser.add_argument("--seed", type=int, default=3)
    chosen = parser.parse_args()

    def drawn(make: Callable[[int, int], Any]) -> list[Any]:
        return [make(chosen.seed, number) for number in range(chosen.count)]

    report("deep and fast spheres", drawn(fast))
    report("spheres of the whole range", spread(chosen.count, chosen.seed))
    report("punches", drawn(punch))


if __name__ == "__main__":
    main()
