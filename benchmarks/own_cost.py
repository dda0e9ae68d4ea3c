"""Forecasts of the processor time of simulations against measured ones.

``python benchmarks/own_cost.py --seed 41 --count 50 --log out/own_cost_41.jsonl`` draws problems
(spheres, cones, power laws, discs, punches, spheres on layers; with and without histories; Tabor
numbers 0.1 to 200) and simulates them; ``--judge LOG`` compares the forecasts of
`viscotack.methods.cost` with a log and ends with 1 if one is off by more than a factor of 3. The
formula was fitted to seed 40.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any

from random_problems import BASES, Luck, Scene, detailed, driven, geometry, solid, words

from viscotack import (
    AtDepth,
    AtForce,
    Dugdale,
    Exponential,
    Groups,
    HalfSpace,
    LennardJones,
    solve,
)
from viscotack.geometry import FlatPunch, Layer, Sphere
from viscotack.methods.cost import processor_time
from viscotack.result import Outcome
from viscotack.traction import effective_range

KINDS = {"sphere": 0.35, "layer": 0.2, "punch": 0.15, "cone": 0.1, "power": 0.1, "disc": 0.1}
TABOR = (0.1, 200.0)
ACCURACY = {2e-3: 0.5, 2e-2: 0.2, 5e-3: 0.15, 1e-3: 0.15}
HISTORIES = 1 / 3
# A simulation that takes longer is left out [s].
LIMIT = 60.0
WITHIN = 3.0


def drawn(seed: int, number: int) -> tuple[Groups, dict[str, Any]]:
    """Return a problem and the options of its simulation."""
    luck = Luck(seed, number)
    material, kind = solid(luck), luck.one(KINDS)
    laws = {
        LennardJones(1.0, 1.0): 0.7,
        Exponential(1.0, 1.0, decay=luck.decades(0.2, 1.0)): 0.15,
        Dugdale(1.0, 1.0, rise=luck.decades(0.01, 0.1), fall=luck.decades(0.1, 1.0)): 0.15,
    }
    traction = luck.one(laws)
    reach = effective_range(traction)
    tabor = luck.decades(*TABOR)
    body: Any = Layer(luck.decades(0.2, 20), luck.one(dict.fromkeys(BASES, 1.0)))
    travel = tabor + reach
    if kind == "punch":
        body = Layer(luck.decades(1, 30), luck.one(dict.fromkeys(BASES[:4], 1.0)))
        travel = body.thickness / (0.64 * traction.strength) + reach

    def press() -> Any:
        if luck.happens(0.6):
            return AtDepth(travel * luck.decades(0.05, 3 if kind == "punch" else 30))
        return AtForce(luck.decades(0.01, 3 if kind == "punch" else 100))

    load = 0.1 if kind == "punch" else 1.0
    scene = Scene(travel, 10 * reach + 6 * travel, load, press)
    stiffness, machine = driven(luck, material, scene, luck.happens(HISTORIES))
    if kind == "punch":
        machine |= {"cohesion": luck.decades(0.01, 0.1)}
        shape: Any = FlatPunch(luck.decades(3, 300))
    else:
        machine |= {"tabor": tabor}
        shape = detailed(luck, kind) or geometry(luck, kind) if kind != "layer" else Sphere(1.0)
    groups = Groups(
        material=material,
        traction=traction,
        geometry=shape,
        body=body if kind in ("punch", "layer") else HalfSpace(),
        stiffness=stiffness,
        **({"tabor": None} | machine),
    )
    until = luck.one({"pull-off": 1, "detached": 1})
    return groups, {"accuracy": luck.one(ACCURACY), "until": until}


def measured(seed: int, number: int) -> dict[str, Any]:
    """Return processor time and statistics of a simulation, or why there are none."""
    row: dict[str, Any] = {"seed": seed, "number": number}
    try:
        groups, options = drawn(seed, number)
        row |= {"words": words(groups)} | options
        began = process_time()
        result = solve(groups, throw=False, time_limit=2 * LIMIT, **options)
    except ValueError as error:
        return row | {"why": str(error)}
    row["seconds"] = process_time() - began
    if result.outcome is Outcome.STOPPED or row["seconds"] > LIMIT:
        row["why"] = result.status
    return row | {"statistics": dict(result.statistics)}


def judged(log: Path) -> int:
    """Compare forecasts with a log, the worst last; return how many are off by too much."""
    rows, found = [json.loads(line) for line in log.read_text().splitlines()], []
    for row in rows:
        if "why" not in row:
            groups, options = drawn(row["seed"], row["number"])
            began = process_time()
            forecast = processor_time(groups, **options)
            if forecast is not None:
                ratio = forecast / row["seconds"]
                found.append((max(ratio, 1 / ratio), ratio, process_time() - began, row))
    for _, ratio, took, row in sorted(found, key=lambda each: each[0]):
        print(f"{ratio:5.2f} of {row['seconds']:6.2f} s, told after {took:.2f} s: {row['words']}")
    factors = [off for off, *_ in found]
    wrong = sum(off > WITHIN for off in factors)
    print(
        f"{len(found)} forecasts, {wrong} off by more than a factor of {WITHIN:g}; median factor "
        f"{median(factors):.2f}, largest {max(factors):.2f}"
    )
    return wrong


def main() -> int:
    """Return 1 if a forecast is off by too much."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=41)
    parser.add_argument("--count", type=int, default=50, help="simulations")
    parser.add_argument("--log", type=Path, default=Path("out/own_cost.jsonl"))
    parser.add_argument("--judge", type=Path, metavar="LOG")
    asked = parser.parse_args()
    measured(0, 0)  # imports
    if asked.judge is not None:
        return int(judged(asked.judge) > 0)
    found = number = 0
    while found < asked.count:
        row = measured(asked.seed, number)
        found, number = found + ("why" not in row), number + 1
        with asked.log.open("a", encoding="utf-8") as file:
            print(json.dumps(row), file=file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
