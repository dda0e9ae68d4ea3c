"""Histories of the contact with a steady crack for its edge against simulation, drawn by a seed.

    python benchmarks/crack_histories.py --seed 7 --count 150 --store simulated.csv

History i of a seed is the same whatever else is asked: a dwell at rest, an approach with and
without a dwell, a reversal, cycles, dead loads, every fourth behind a spring; Tabor numbers of 8 to
60, standard solids, power laws and Prony series, spheres, cones and r^4. With --turns a sphere is
pressed and pulled up to 100 times faster. The store keeps what simulations cost; the theory is
asked anew each time. --only simulates without asking the theory. Prints a line a history, and how
often the band held, by kind.
"""

import argparse
import csv
import time
from pathlib import Path

import numpy as np
from crack_contact import ACCURACY, material

import viscotack as vt

TABOR, RATIO = (8.0, 60.0), (0.03, 0.5)
KINDS = ("rest", "approach", "approach, dwell", "reversal", "cycles", "dead load")
# Every so manieth history is one of a cone, one of r^4.
SHAPES = ((7, vt.Cone(1.0)), (5, vt.PowerLawProfile(0.25, 4.0)))
COLUMNS = ("history", "kind", "simulated", "largest", "time", "seconds", "note")


def history(seed, i):
    """Return the kind of history i of a seed, and its groups."""
    rng = np.random.default_rng([seed, i])
    mu = float(np.exp(rng.uniform(*np.log(TABOR))))
    solid_kind, solid = material(rng, float(np.exp(rng.uniform(*np.log(RATIO)))))
    shape = next((s for every, s in SHAPES if i % every == every - 1), vt.Sphere(1.0))

    def speed():
        return mu * float(10 ** rng.uniform(-0.5, 1.5))

    def dwell(hold):
        return vt.Dwell(float(10 ** rng.uniform(-1, 1)), hold)

    depth = mu * float(rng.uniform(5, 20))
    start, to = vt.AtDepth(depth), vt.AtDepth(depth)
    hold = str(rng.choice(["drive", "depth", "force"]))
    kind = KINDS[int(rng.integers(len(KINDS)))]
    match kind:
        case "rest":
            moves = [dwell(hold)]
        case "approach":
            start, moves = vt.Apart(30.0), [vt.Approach(speed(), to)]
        case "approach, dwell":
            start, moves = vt.Apart(30.0), [vt.Approach(speed(), to), dwell(hold)]
        case "reversal":
            back = vt.AtDepth(depth * float(rng.uniform(0.2, 0.8)))
            moves = [vt.Retract(speed(), back), vt.Approach(speed(), to)]
            moves += [dwell(hold)] if rng.uniform() < 0.3 else []
        case "cycles":
            # back until it is apart, or part of the way
            back = vt.AtDepth(-20 * mu if rng.uniform() < 0.3 else depth * float(rng.uniform(0, 1)))
            cycle = [vt.Approach(speed(), to), vt.Retract(speed(), back)]
            start, moves = vt.Apart(30.0), [*cycle, vt.Approach(cycle[0].speed, to)]
        case "dead load":
            start = vt.AtForce(float(rng.uniform(0.5, 10)))
            load = float(rng.uniform(-0.9, 10))
            moves = [vt.LoadTo(load, float(10 ** rng.uniform(-2, 1))), dwell("force")]
    spring = float(rng.uniform(0.1, 3)) / mu if rng.uniform() < 0.25 else None
    groups = vt.Groups(
        tabor=mu,
        material=solid,
        start=start,
        moves=tuple(moves),
        rate=speed(),
        geometry=shape,
        stiffness=spring,
    )
    words = f"{kind}{', spring' if spring else ''} ({shape.word}, {solid_kind})"
    return words, groups


def turn(seed, i):
    """Return the same of a fast turn: a pull up to 100 times faster than the approach before it."""
    rng = np.random.default_rng([seed, 1, i])
    mu = float(np.exp(rng.uniform(np.log(TABOR[0]), np.log(25.0))))
    solid_kind, solid = material(rng, float(np.exp(rng.uniform(*np.log(RATIO)))))
    speed = mu * float(10 ** rng.uniform(-0.5, 1.5))
    moves = [vt.Approach(speed, vt.AtDepth(mu * float(rng.uniform(5, 20))))]
    if rng.uniform() < 0.5:
        moves.append(vt.Dwell(float(10 ** rng.uniform(-2, 0)), str(rng.choice(["drive", "force"]))))
    rate = speed * float(10 ** rng.uniform(0, 2))
    groups = vt.Groups(
        tabor=mu, material=solid, start=vt.Apart(30.0), moves=tuple(moves), rate=rate
    )
    return f"turn{', dwell' if len(moves) > 1 else ''} (sphere, {solid_kind})", groups


def simulated(i, drawn, time_limit):
    """Return the row of the simulation of history i, whose words and groups are given."""
    words, groups = drawn
    row = dict.fromkeys(COLUMNS, "") | {"history": i, "kind": words}
    begin = time.perf_counter()
    try:
        result = vt.solve(
            groups, accuracy=ACCURACY, estimate_error=False, throw=False, time_limit=time_limit
        )
        row["seconds"] = time.perf_counter() - begin
        found = vt.pull_off(result)
        row |= {"simulated": found.force, "largest": result.force.max(), "time": found.time}
    except (ValueError, vt.SimulationError) as error:
        row["note"] = str(error)[:120]
    return row


def compared(i, drawn, row):
    """Return what the theory says of history i beside its simulation."""
    words, groups = drawn
    told = {"i": i, "kind": words, "tabor": groups.tabor, "k": groups.modulus_ratio}
    begin = time.perf_counter()
    try:
        answer = vt.crack_contact(groups)
    except ValueError as error:
        return told | {"note": f"refused: {error}"[:100]}
    told["seconds"] = time.perf_counter() - begin
    told |= {"force": answer.pull_off_force, "band": answer.band, "inside": answer.inside}
    told["zones"] = answer.zones
    if row["simulated"] == "":
        return told | {"note": f"not simulated: {row['note']}"}
    if answer.pull_off_force is None:
        return told | {"note": "no pull-off"}
    told["simulated"] = float(row["simulated"])
    told["error"] = answer.pull_off_force / told["simulated"] - 1
    told["held"] = abs(told["error"]) <= answer.band
    told["largest_error"] = answer.force.max() / float(row["largest"]) - 1
    return told


def rows_of(path):
    """Return the rows of a store by the number of the history."""
    if path is None or not path.exists():
        return {}
    with path.open(newline="") as file:
        return {int(row["history"]): row for row in csv.DictReader(file)}


def summary(told):
    """Print how far the theory is off, and how often the band held, by kind."""
    good = [found for found in told if "error" in found]
    kinds = {found["kind"].split(" (")[0].replace(", spring", "") for found in good}
    for kind in ("", *sorted(kinds)):
        part = [found for found in good if not kind or found["kind"].split(" (")[0] == kind]
        part += [f for f in good if kind and f["kind"].split(" (")[0] == f"{kind}, spring"]
        off = np.abs([found["error"] for found in part])
        held = sum(bool(found["held"]) for found in part)
        print(
            f"{kind or 'all':16} {len(part):3} compared, held {held}, median {np.median(off):.2%},"
            f" 9 of 10 {np.quantile(off, 0.9):.2%}, worst {off.max():.2%},"
            f" median band {np.median([found['band'] for found in part]):.2%}"
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--time-limit", type=float, default=60.0, help="seconds of a simulation")
    parser.add_argument("--turns", action="store_true", help="fast turns after an approach")
    parser.add_argument("--store", type=Path)
    parser.add_argument("--only", action="store_true", help="simulate without asking the theory")
    asked = parser.parse_args()
    known, told = rows_of(asked.store), []
    draw = turn if asked.turns else history
    for i in range(asked.first, asked.first + asked.count):
        if (row := known.get(i)) is None:
            row = simulated(i, draw(asked.seed, i), asked.time_limit)
            if asked.store:
                new = not asked.store.exists()
                with asked.store.open("a", newline="") as file:
                    writer = csv.DictWriter(file, COLUMNS)
                    if new:
                        writer.writeheader()
                    writer.writerow(row)
        if asked.only:
            continue
        told.append(found := compared(i, draw(asked.seed, i), row))
        line = f"{i:>3} {found['kind']:<46} mu {found['tabor']:4.1f} k {found['k']:.2f}"
        if "error" in found:
            line += f" force {found['force']:.3f} error {found['error']:+.2%}"
            line += f" band {found['band']:.2%} {'' if found['held'] else 'OUTSIDE'}"
        print(line, found.get("note", ""), flush=True)
    if any("error" in found for found in told):
        summary(told)


if __name__ == "__main__":
    main()
