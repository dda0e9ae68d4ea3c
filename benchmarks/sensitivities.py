"""Derivatives of simulations against fits through simulations with changed inputs.

Draws random tests of a sphere: standard solids, Prony series and power laws, three traction laws,
starts by depth or force, some with a dwell, a spring, an approach or a layer. For each of up to 8
inputs a cubic in the logarithm of the input is fitted to finer simulations with changed inputs; its
slope at the middle is the reference, and the scatter around it gives the error of the reference.
The first command computes the references and continues where it was stopped, the second compares.
Needs: nothing. Time: 10 s a case, then 1 s a case.

    python benchmarks/sensitivities.py reference --cases 100 --seed 1
    python benchmarks/sensitivities.py compare --seed 1
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from time import process_time

import numpy as np
from scipy.interpolate import CubicSpline

from viscotack import (
    AtDepth,
    AtForce,
    Dwell,
    Groups,
    LennardJones,
    Prony,
    RetardationPowerLaw,
    StandardSolid,
    pull_off,
    solve,
)
from viscotack.errors import InputError
from viscotack.geometry import Layer
from viscotack.problem.changed import changed, moved
from viscotack.protocol import Approach
from viscotack.result.observables import work_to
from viscotack.result.opening import around
from viscotack.result.parts import spans
from viscotack.traction import Dugdale, Exponential

OUTPUTS = ("pull_off_force", "work_to_pull_off", "depth_at_pull_off", "contact_radius_at_pull_off")
# Relative changes of an input in the references, and the accuracy of their simulations.
CHANGES, FINE = (0.02, 0.04, 0.06), 4e-4
# Inputs per case, and processor time of a fine simulation [s] above which a case is left out.
INPUTS, LONGEST = 8, 0.4
# An elasticity is right within this part of it, or within this much; a reference is converged where
# its own error is below half of that.
RELATIVE, ABSOLUTE = 0.01, 0.002


def case(rng: np.random.Generator) -> Groups:
    """Return a random test."""
    k = 10 ** rng.uniform(-2, -0.3)
    plateaus = {"rubbery_modulus": 1.0, "poisson_ratio": 0.0}
    match rng.integers(3):
        case 0:
            solid = StandardSolid(**plateaus, glassy_modulus=1 / k, tau0=1.0)
        case 1:
            share = rng.dirichlet([2, 2, 2]) * (1 / k - 1)
            times = (1e-3, 10 ** rng.uniform(-2, -1), 1.0)
            solid = Prony(**plateaus, branches=tuple(zip(share, times, strict=True)))
        case _:
            n = rng.uniform(0.3, 1.5)
            solid = RetardationPowerLaw(**plateaus, glassy_modulus=1 / k, exponent=n, tau0=1.0)
    tabor = 10 ** rng.uniform(-0.5, 0.6)
    law = [
        LennardJones(1.0, 1.0),
        LennardJones(1.0, 1.0),
        Exponential(1.0, 1.0, decay=0.4),
        Dugdale(1.0, 1.0, rise=0.3, fall=1.0),
    ][rng.integers(3 if tabor > 1.5 else 4)]
    rate = 10 ** rng.uniform(-0.5, 3)
    extra, moves, options = rng.integers(6), (), {}
    start = (
        AtDepth(tabor * rng.uniform(1, 8)) if rng.random() < 0.6 else AtForce(rng.uniform(0, 20))
    )
    if extra == 0:
        options["stiffness"] = rng.uniform(0.2, 3.0)
    elif extra == 1:
        options["body"] = Layer(rng.uniform(1.0, 4.0))
    elif extra == 2:
        moves = (
            Approach(to=AtForce(rng.uniform(5, 20)), speed=rate / 3),
            Dwell(rng.uniform(0.1, 3)),
        )
        start = AtForce(rng.uniform(0.0, 3.0))
    return Groups(
        tabor=tabor, material=solid, start=start, rate=rate, traction=law, moves=moves, **options
    )


def outputs(problem: Groups) -> list[float]:
    """Return the outputs at the pull-off of a fine simulation."""
    result = solve(problem, until="pull-off", accuracy=FINE, estimate_error=False)
    at = pull_off(result)
    near = around(result, spans(result)[-1], 2, len(result.time))
    if near is None:
        raise InputError("the pull-off is no smooth maximum of the tension")
    edge = CubicSpline(-result.depth[near], result.contact_radius[near])(-at.depth)
    return [float(x) for x in (at.force, work_to(result, at), at.depth, edge)]


def reference(seed: int, number: int) -> dict:
    """Return the outputs of simulations with changed inputs."""
    rng = np.random.default_rng([seed, number])
    problem = case(rng)
    record: dict = {"seed": seed, "number": number}
    try:
        began = process_time()
        record["middle"] = outputs(problem)
        record["seconds"] = process_time() - began
        if record["seconds"] > LONGEST:
            return record | {"failed": "too long"}
        names = [each.name for each in changed(problem)]
        names = [names[i] for i in sorted(rng.permutation(len(names))[:INPUTS])]
        record["inputs"] = {}
        for name in names:
            ways = [way for change in CHANGES for way in (-change, change)]
            cases = [moved(problem, name, 1 + way) for way in ways]
            able = [each for each in cases if isinstance(each, Groups)]
            if len(able) == len(cases):  # not at the end of its range
                points = zip(ways, able, strict=True)
                record["inputs"][name] = [[float(np.log1p(x)), outputs(each)] for x, each in points]
    except (InputError, RuntimeError) as error:
        record["failed"] = str(error)
    return record


def slope(middle: list[float], points: list) -> tuple[np.ndarray, np.ndarray]:
    """Return the elasticities of a cubic through the simulations, and their standard errors."""
    x = np.array([0.0, *(by for by, _ in points)]) / max(by for by, _ in points)
    y = np.array([middle, *(values for _, values in points)]) / np.abs(middle)
    columns = np.vander(x, 4, increasing=True)
    found, *_ = np.linalg.lstsq(columns, y, rcond=None)
    rest = np.sum((columns @ found - y) ** 2, axis=0) / (len(x) - 4)
    error = np.sqrt(np.linalg.inv(columns.T @ columns)[1, 1] * rest)
    scale = max(by for by, _ in points)
    return found[1] / scale, error / scale


def compared(record: dict, accuracy: float) -> list[dict]:
    """Return the elasticities of a simulation beside their references."""
    problem = case(np.random.default_rng([record["seed"], record["number"]]))
    names = list(record["inputs"])
    found = solve(problem, until="pull-off", accuracy=accuracy, sensitivities=names).sensitivities
    assert found is not None
    rows = []
    for name in names:
        best, unsure = slope(record["middle"], record["inputs"][name])
        for i, output in enumerate(OUTPUTS):
            row = {"number": record["number"], "output": output, "input": name}
            row |= {"best": best[i], "unsure": unsure[i]}
            if (value := found.elasticities.get(output, {}).get(name)) is None:
                row["refused"] = found.refused.get(output) or found.refused.get(name) or "undefined"
            else:
                row |= {"value": value, "stated": found.errors[output][name]}
            rows.append(row)
    return rows


def cost(problem: Groups, names: list[str]) -> float:
    """Return the additional processor time of five derivatives over that of a simulation."""

    def least(**options) -> float:
        times = []
        for _ in range(5):
            began = process_time()
            solve(problem, until="pull-off", estimate_error=False, **options)
            times.append(process_time() - began)
        return min(times)

    return least(sensitivities=names[:5]) / least() - 1


def main() -> None:
    """Compute references, or compare with them."""
    parser = argparse.ArgumentParser(description="Derivatives against fits")
    parser.add_argument("task", choices=("reference", "compare"))
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="first case that is compared")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--accuracy", type=float, default=2e-3)
    parser.add_argument("--costs", type=int, default=10, help="cases whose cost is measured")
    parser.add_argument("--folder", type=Path, default=Path("out"))
    asked = parser.parse_args()
    path = asked.folder / f"sensitivities-{asked.seed}.jsonl"
    if asked.task == "reference":
        asked.folder.mkdir(parents=True, exist_ok=True)
        done = len(path.read_text().splitlines()) if path.exists() else 0
        for number in range(done, asked.cases):
            with path.open("a") as file:
                file.write(json.dumps(reference(asked.seed, number)) + "\n")
        return
    records = [json.loads(line) for line in path.read_text().splitlines()][asked.first :]
    whole = [r for r in records if "failed" not in r]
    for record in records:
        if "failed" in record:
            print(f"case {record['number']}: no reference: {record['failed']}")
    rows = []
    for record in whole:
        try:
            rows += compared(record, asked.accuracy)
        except (InputError, RuntimeError) as error:
            print(f"case {record['number']}: {error}")
    out = asked.folder / f"sensitivities-{asked.seed}-{asked.accuracy:g}.json"
    out.write_text(json.dumps(rows))
    report(rows)
    costs = [
        cost(case(np.random.default_rng([r["seed"], r["number"]])), list(r["inputs"]))
        for r in whole[: asked.costs]
    ]
    if costs:
        print(f"five derivatives take {np.median(costs):.0%} more time (median of {len(costs)})")


def report(rows: list[dict]) -> None:
    """Print the shares of elasticities within 1 % and within the stated error, by output."""
    print(f"{'output':28}{'number':>7}{'refused':>8}{'converged':>10}{'1 %':>7}{'or 0.002':>9}"
          f"{'stated':>8}{'median off':>12}{'95 %':>9}")  # fmt: skip
    for output in OUTPUTS:
        mine = [r for r in rows if r["output"] == output]
        known = [r for r in mine if "value" in r]
        if not known:
            continue
        value, best, unsure, stated = (
            np.array([r[k] for r in known]) for k in ("value", "best", "unsure", "stated")
        )
        allowed = np.maximum(RELATIVE * np.abs(best), ABSOLUTE)
        sure, off = unsure < allowed / 2, np.abs(value - best)
        strict = np.abs(best) * RELATIVE
        held = off <= stated + allowed + 2 * unsure
        print(
            f"{output:28}{len(mine):7d}{len(mine) - len(known):8d}{sure.sum():10d}"
            f"{np.mean((off <= strict)[sure]):7.1%}{np.mean((off <= allowed)[sure]):9.1%}"
            f"{np.mean(held):8.1%}{np.median(off[sure]):12.1e}{np.quantile(off[sure], 0.95):9.1e}"
        )
    for number, why in sorted({(r["number"], r["refused"]) for r in rows if "refused" in r}):
        print(f"case {number}: {why}")


if __name__ == "__main__":
    main()
