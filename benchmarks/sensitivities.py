"""Derivatives of simulations against differences of simulations with changed inputs.

Draws random tests of a sphere: standard solids, Prony series and power laws, three traction laws,
starts by depth or force, some with a dwell, a spring, an approach or a layer, and compares the
elasticities of ``solve(sensitivities=True)`` with central differences of finer simulations, at two
changes of the input (Richardson). Needs: nothing. Time: 10 s a case.

    python benchmarks/sensitivities.py --cases 25 --seed 1 --output out/sensitivities.csv
"""

from __future__ import annotations

import argparse
import csv
from pathlib import Path
from time import process_time

import numpy as np

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
from viscotack.problem import inputs
from viscotack.protocol import Approach
from viscotack.result.observables import work_to
from viscotack.result.opening import edge_at
from viscotack.result.parts import spans
from viscotack.traction import Dugdale, Exponential

OUTPUTS = ("pull_off_force", "work_to_pull_off", "depth_at_pull_off", "contact_radius_at_pull_off")
# Relative changes of an input in the differences, and the accuracy of their simulations.
CHANGES, FINE = (0.03, 0.06), 4e-4
# Inputs per case, and the elasticity below which an error counts absolutely.
INPUTS, SMALL = 8, 0.1


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


def outputs(problem: Groups) -> np.ndarray:
    """Return the outputs at the pull-off of a fine simulation."""
    result = solve(problem, until="pull-off", accuracy=FINE, estimate_error=False)
    at = pull_off(result)
    return np.array(
        [at.force, work_to(result, at), at.depth, edge_at(result, spans(result)[-1], at)]
    )


def difference(problem: Groups, name: str, change: float) -> np.ndarray:
    """Return the derivatives of the outputs by the logarithm of an input."""
    kept, inputs._CHANGE = inputs._CHANGE, change
    try:
        (one,) = inputs.changed(problem, [name])
    finally:
        inputs._CHANGE = kept
    return (outputs(one.high) - outputs(one.low)) / (np.log1p(one.up) - np.log1p(one.down))


def rows_of(number: int, problem: Groups, accuracy: float):
    """Yield a row for each output and input of a case."""
    solve(problem, until="pull-off", accuracy=accuracy, estimate_error=False)
    names = [each.name for each in inputs.changed(problem)][:INPUTS]
    began = process_time()
    solve(problem, until="pull-off", accuracy=accuracy, estimate_error=False)
    plain = process_time() - began
    began = process_time()
    solve(
        problem, until="pull-off", accuracy=accuracy, estimate_error=False, sensitivities=names[:5]
    )
    more = (process_time() - began) / plain - 1
    finer = {
        a: solve(problem, until="pull-off", accuracy=a, sensitivities=names).sensitivities
        for a in (accuracy, accuracy / 4)
    }
    found = finer[accuracy]
    middle = outputs(problem)
    for name in names:
        near, far = (difference(problem, name, change) for change in CHANGES)
        best = (4 * near - far) / 3
        for i, output in enumerate(OUTPUTS):
            if output not in found.elasticities:
                yield [number, output, name, "refused", found.refused[output]]
                continue
            if name not in found.elasticities[output]:
                yield [number, output, name, "refused", found.refused.get(name, "")]
                continue
            size, error = abs(middle[i]), (found.errors or {}).get(output, {}).get(name)
            yield [
                number,
                output,
                name,
                found.elasticities[output][name],
                finer[accuracy / 4].elasticities.get(output, {}).get(name),
                best[i] / size,
                abs(near[i] - best[i]) / size,
                error,
                more,
            ]


def main() -> None:
    """Compare, print the shares within 1 %, and write the rows."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=25)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--accuracy", type=float, default=2e-3)
    parser.add_argument("--output", type=Path, default=Path("out/sensitivities.csv"))
    asked = parser.parse_args()
    asked.output.parent.mkdir(parents=True, exist_ok=True)
    with asked.output.open("w", newline="") as file:
        table = csv.writer(file)
        for number in range(asked.first, asked.first + asked.cases):
            problem = case(np.random.default_rng([asked.seed, number]))
            try:
                for row in rows_of(number, problem, asked.accuracy):
                    table.writerow(row)
            except (InputError, RuntimeError) as error:
                table.writerow([number, "", "", "failed", str(error)])
            file.flush()
    report(asked.output)


def report(path: Path) -> None:
    """Print the share of elasticities within 1 % by output."""
    with path.open(newline="") as file:
        rows = list(csv.reader(file))
    for output in OUTPUTS:
        mine = [r for r in rows if r[1] == output and r[3] != "refused"]
        ours, finer, best, unsure, stated = (
            np.array([float(r[k]) if r[k] else np.nan for r in mine]) for k in (3, 4, 5, 6, 7)
        )
        scale = np.maximum(np.abs(best), SMALL)
        sure = unsure < 0.01 * scale
        off, finer_off = np.abs(ours - best) / scale, np.abs(finer - best) / scale
        held = np.abs(ours - best) <= stated + 0.01 * scale
        print(
            f"{output:28} {len(mine):4d} elasticities, {np.mean(sure):.0%} with sure differences;"
            f" of these within 1 %: {np.mean(off[sure] < 0.01):.1%} (at a quarter of the accuracy "
            f"{np.mean(finer_off[sure] < 0.01):.1%}), median {np.median(off[sure]):.1e}, "
            f"95 % {np.quantile(off[sure], 0.95):.1e}; stated error holds {np.mean(held[sure]):.1%}"
        )
    refused = {(r[0], r[4]) for r in rows if r[3] in ("refused", "failed")}
    for number, why in sorted(refused):
        print(f"case {number}: {why}")
    more = {r[0]: float(r[8]) for r in rows if len(r) > 8}
    print(f"five derivatives take {np.median(list(more.values())):.0%} more time (median)")


if __name__ == "__main__":
    main()
