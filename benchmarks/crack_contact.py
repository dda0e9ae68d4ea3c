"""Contact with a steady crack for its edge against simulation, on random problems.

    python benchmarks/crack_contact.py --first 0 --count 10 --store compared.csv

Problem i is the same whatever else is asked; with --learned it is a sphere on a power law, drawn
from the whole range of the learned theory at Tabor numbers of 10 to 200, with --other the same on a
Prony series of 1 to 8 arms. Rows that the store has
are not run again, so that an interrupted comparison goes on; without --store nothing is kept.
Prints a line a problem and, at the end, errors of the pull-off force by Tabor number, of the time,
and how often the band held.
"""

import argparse
import csv
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

import viscotack as vt
from viscotack.forecast import predict
from viscotack.forecast.tiers import AT_ONCE

# The problems: Tabor numbers, modulus ratios, and every fifth one a whole history.
TABOR, RATIO, HISTORY_EVERY = (3.0, 100.0), (0.03, 0.5), 5
# What a simulation is asked to know the force to.
ACCURACY = 2e-3
# Those of the learned theory: Tabor numbers that can be simulated, and decades of modulus ratio,
# exponent, and of depth and rate over the Tabor number.
LEARNED_TABOR = (10.0, 200.0)
LEARNED = ((-4.0, -0.3), (-0.82, 0.3), (-1.0, 3.0), (-6.0, 6.0))
COLUMNS = (
    *("problem", "kind", "tabor", "modulus_ratio", "amplification", "zones", "force", "simulated"),
    *("error", "band", "time_error", "work_error", "hysteresis_error", "largest_error"),
    *("learned_error", "learned_band", "seconds", "seconds_simulated", "note"),
)


def problem(i, tabor=TABOR):
    """Return the words for a random problem and the problem."""
    rng = np.random.default_rng([2026, i])
    mu = float(np.exp(rng.uniform(*np.log(tabor))))
    k = float(np.exp(rng.uniform(*np.log(RATIO))))
    kind, solid = material(rng, k)
    shape, geometry = [
        ("sphere", vt.Sphere(1.0)),
        ("sphere", vt.Sphere(1.0)),
        ("cone", vt.Cone(1.0)),
        ("power", vt.PowerLawProfile(0.25, 4.0)),
    ][int(rng.integers(4))]
    rate = mu * float(10 ** rng.uniform(-0.5, 2))
    if i % HISTORY_EVERY:
        # a relaxed start about as wide as the pull-off of the fastest crack, and wider
        q, bare = {"sphere": (2, 1.65), "cone": (1, 5.73), "power": (4, 1.18)}[shape]
        k_start = max(k, 0.3) if shape == "cone" else k
        radius = bare * k_start ** (-1 / (2 * q - 1)) * float(rng.uniform(0.9, 2.0))
        start = vt.AtRadius(radius / np.pi ** (1 / 3))
        stiffness = float(rng.uniform(0.1, 3)) / mu if rng.uniform() < 0.2 else None
        return f"{shape} {kind}", vt.Groups(
            tabor=mu, material=solid, start=start, rate=rate, geometry=geometry, stiffness=stiffness
        )
    speed = mu * float(10 ** rng.uniform(-0.5, 1.5))
    moves = [vt.Approach(speed, vt.AtDepth(mu * float(rng.uniform(5, 20))))]
    if rng.uniform() < 0.5:
        moves.append(vt.Dwell(float(10 ** rng.uniform(-1, 1)), str(rng.choice(["drive", "force"]))))
    return f"{shape} {kind} history", vt.Groups(
        tabor=mu,
        material=solid,
        start=vt.Apart(20.0),
        moves=tuple(moves),
        rate=rate,
        geometry=geometry,
    )


def learned_problem(i, tabor=LEARNED_TABOR):
    """Return the words for a random problem of the learned theory and the problem."""
    rng = np.random.default_rng([2027, i])
    mu = float(np.exp(rng.uniform(*np.log(tabor))))
    k, exponent, depth, rate = (float(10 ** rng.uniform(*decades)) for decades in LEARNED)
    solid = vt.RetardationPowerLaw(
        rubbery_modulus=1.0, glassy_modulus=1 / k, exponent=exponent, tau0=1.0, poisson_ratio=0.0
    )
    words = f"sphere power-law {exponent:.2f}"
    return words, vt.Groups(tabor=mu, material=solid, start=vt.AtDepth(depth * mu), rate=rate * mu)


def other_problem(i, tabor=LEARNED_TABOR):
    """Return the problem of the learned theory with the same numbers and another kind of solid."""
    _, case = learned_problem(i, tabor)
    rng = np.random.default_rng([2028, i])
    k = case.modulus_ratio
    common = dict(rubbery_modulus=1.0, poisson_ratio=0.0)
    number = int(rng.integers(1, 9))
    if number == 1:
        solid = vt.StandardSolid(glassy_modulus=1 / k, tau0=1.0, **common)
    else:
        # arms whose strengths, and times, are spread over decades, as those of a rubber
        strength = 10 ** rng.uniform(-2, 0, number)
        times = np.sort(10 ** rng.uniform(-6, 0, number))
        arms = zip(strength / strength.sum() * (1 / k - 1), times, strict=True)
        solid = vt.Prony(branches=tuple(arms), **common)
    return f"sphere {number} arms", replace(case, material=solid)


def material(rng, k):
    """Return a word and a reduced solid of modulus ratio k."""
    match int(rng.integers(3)):
        case 0:
            kind = "sls"
            solid = vt.StandardSolid(
                rubbery_modulus=1.0, glassy_modulus=1 / k, tau0=1.0, poisson_ratio=0.0
            )
        case 1:
            kind, n = "power-law", float(rng.uniform(0.4, 1.6))
            solid = vt.RetardationPowerLaw(
                rubbery_modulus=1.0, glassy_modulus=1 / k, exponent=n, tau0=1.0, poisson_ratio=0.0
            )
        case _:
            kind, number = "prony", int(rng.integers(2, 6))
            weights = rng.dirichlet(np.ones(number)) * (1 / k - 1)
            times = np.sort(10 ** rng.uniform(-2, 0, number))
            solid = vt.Prony(
                rubbery_modulus=1.0,
                poisson_ratio=0.0,
                branches=tuple(zip(weights, times, strict=True)),
            )
    return kind, solid


def compared(i, drawn, accuracy, time_limit):
    """Return the row of problem i, whose words and groups are given."""
    words, case = drawn
    row = dict.fromkeys(COLUMNS, "") | {
        "problem": i,
        "kind": words,
        "tabor": case.tabor,
        "modulus_ratio": case.modulus_ratio,
    }
    try:
        vt.crack_contact(case)  # solves the cracks of a new solid
        begin = time.perf_counter()
        answer = vt.crack_contact(case)
        row["seconds"] = time.perf_counter() - begin
        begin = time.perf_counter()
        until = "detached" if case.moves else "pull-off"
        result = vt.solve(
            case, until=until, accuracy=accuracy, estimate_error=False, time_limit=time_limit
        )
        row["seconds_simulated"] = time.perf_counter() - begin
        if result.method == answer.method:
            row["note"] = "too short a range for a simulation"
            return row
        found = vt.pull_off(result)
        row |= errors(answer, result, found) | learned_errors(case, found.force)
    except (ValueError, vt.SimulationError) as error:
        row["note"] = str(error)[:120]
    return row


def errors(answer, result, found):
    """Return what the theory is off."""
    # a simulation leaves out what a deep start goes without the edge
    rate, from_rest = result.groups.rate, not result.groups.moves
    skipped = (answer.depth[0] - result.depth[0]) / rate if from_rest else 0.0
    row = {
        "amplification": answer.amplification_at_pull_off,
        "zones": answer.zones,
        "force": answer.pull_off_force,
        "simulated": found.force,
        "error": answer.pull_off_force / found.force - 1,
        "band": answer.band,
        "time_error": (answer.time_at_pull_off - skipped) / found.time - 1,
        "work_error": answer.work_to_pull_off / vt.work_to_pull_off(result) - 1,
    }
    if answer.hysteresis is not None:
        loop = np.sum((result.force[1:] + result.force[:-1]) / 2 * np.diff(result.depth))
        row["hysteresis_error"] = answer.hysteresis / loop - 1
    if result.groups.moves:
        row["largest_error"] = answer.force.max() / result.force.max() - 1
    return row


def learned_errors(case, simulated):
    """Return what the learned theory is off, nothing where it has no answer."""
    try:
        said = predict(case, budget=AT_ONCE)
    except vt.OutOfRange:
        return {}
    band = said.interval[1] / said.pull_off_force - 1
    return {"learned_error": said.pull_off_force / simulated - 1, "learned_band": band}


def summary(rows):
    """Print errors by Tabor number and what the bands held."""
    good = [
        {k: float(v) for k, v in row.items() if k not in ("kind", "note") and v != ""}
        | {"history": "history" in row["kind"]}
        for row in rows
        if row["error"] != ""
    ]
    print(f"{len(rows)} problems, {len(good)} compared")
    for low, high in ((3, 5), (5, 10), (10, 20), (20, 50), (50, 100), (100, 201)):
        for history in (False, True):
            part = [r for r in good if low <= r["tabor"] < high and r["history"] == history]
            if part:
                off = np.abs([r["error"] for r in part])
                late = np.abs([r["time_error"] for r in part])
                words = "histories" if history else "from rest"
                print(
                    f"mu {low:>3} to {high:<3} {words:9} {len(part):3}:"
                    f" force median {np.median(off):.2%} worst {off.max():.2%},"
                    f" time median {np.median(late):.2%} worst {late.max():.2%}"
                )
    if good:
        held = np.mean([abs(r["error"]) <= r["band"] for r in good])
        print(f"bands held {held:.0%}, median band {np.median([r['band'] for r in good]):.2%}")
    if learned := [r for r in good if "learned_error" in r]:
        off = np.abs([r["learned_error"] for r in learned])
        bands = np.array([r["learned_band"] for r in learned])
        print(
            f"learned, {len(learned)}: off by {np.median(off):.2%} in the median, bands held "
            f"{np.sum(off <= bands)}, median band {np.median(bands):.2%}"
        )
    if loops := [abs(r["hysteresis_error"]) for r in good if "hysteresis_error" in r]:
        print(f"hysteresis: median {np.median(loops):.2%}, worst {np.max(loops):.2%}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--learned", action="store_true", help="of the learned theory's range")
    parser.add_argument("--other", action="store_true", help="of this range, other solids")
    parser.add_argument("--tabor", type=float, nargs=2, help="smallest and largest Tabor number")
    parser.add_argument("--accuracy", type=float, default=ACCURACY)
    parser.add_argument("--time-limit", type=float, default=None, help="seconds of a simulation")
    parser.add_argument("--store", type=Path)
    asked = parser.parse_args()
    drawn = other_problem if asked.other else learned_problem if asked.learned else problem
    tabor = () if asked.tabor is None else (tuple(asked.tabor),)
    known = {}
    if asked.store and asked.store.exists():
        with asked.store.open(newline="") as file:
            known = {int(row["problem"]): row for row in csv.DictReader(file)}
    rows = []
    for i in range(asked.first, asked.first + asked.count):
        row = known.get(i)
        if row is None:
            row = compared(i, drawn(i, *tabor), asked.accuracy, asked.time_limit)
            if asked.store:
                new = not asked.store.exists()
                with asked.store.open("a", newline="") as file:
                    writer = csv.DictWriter(file, COLUMNS)
                    if new:
                        writer.writeheader()
                    writer.writerow(row)
        rows.append(row)
        numbers = "  ".join(
            f"{name} {float(row[name]):.4g}" for name in COLUMNS[2:-1] if row[name] != ""
        )
        print(f"{row['problem']:>3} {row['kind']:<28} {numbers} {row['note']}", flush=True)
    summary(rows)


if __name__ == "__main__":
    main()
