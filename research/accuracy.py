"""Is the default good to what it says? Cases over the whole range against converged runs.

`python -m research.accuracy [--count 30]`: force and work of the default setting beside those at
a 20 times better accuracy, the error estimate beside the true error, the energy residual, the time.

`python -m research.accuracy --drawn 200 --seed 1`: stated errors of force, work and depth of the
pull-off of random tests, spheres and punches of `drawn_tests.py`, beside runs ten times as
accurate. Ten minutes on two cores.
"""

import argparse
from time import perf_counter
from typing import Any

import numpy as np

from research.cases import spread, spread_out, words
from research.drawn_tests import drawn
from viscotack import depth_at_pull_off, pull_off_force, solve, work_to_pull_off
from viscotack.errors import InputError
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.simulate import SimulationError

# Of what errors are stated, and whether that is relative.
STATED = {
    "force": (pull_off_force, True),
    "work": (work_to_pull_off, True),
    "depth": (depth_at_pull_off, False),
}
# How many times as accurate the runs are that judge a case: one of the range, a random one.
FINER, FINER_DRAWN = 20.0, 10.0


def measure(asked: tuple[Any, float, float, float]) -> dict[str, Any]:
    """Return the stated and the true error of a case by name, its energy residual and time [s].

    A case is a problem, or seed and number of a random test. Of a case that is refused it is why.
    """
    case, accuracy, finer, limit = asked
    row: dict[str, Any] = {"case": case}
    try:
        groups = drawn(*case) if isinstance(case, tuple) else case
        row["case"] = f"{case[1]:4d} {groups}" if isinstance(case, tuple) else words(case)
        given: dict[str, Any] = {"until": "pull-off", "time_limit": limit}
        began = perf_counter()
        result = solve(groups, accuracy=accuracy, **given)
        row |= {"time": perf_counter() - began, "residual": result.energy_residual}
        best = solve(groups, accuracy=accuracy / finer, estimate_error=False, **given)
    except (InputError, SimulationError) as refusal:
        return row | {"refused": str(refusal)}
    for name, (observable, relative) in STATED.items():
        try:
            value, true = observable(result), observable(best)
        except InputError:
            continue  # not told: there is no pull-off, or the work means nothing
        unit = abs(true) if relative else 1.0
        row[name] = (result.error_estimate or {}).get(name, np.nan), (value - true) / unit
    return row


def report(rows: list[dict[str, Any]]) -> None:
    """Print how large errors are, and how often and by how much stated ones cover true ones."""
    answered = [row for row in rows if "refused" not in row]
    print(f"{len(rows)} tests, {len(rows) - len(answered)} refused")
    for name in STATED:
        stated, off = np.array([row[name] for row in answered if name in row]).T
        true = np.abs(off)
        ratio = np.median(stated / np.maximum(true, np.finfo(float).tiny))
        print(
            f"{name:5s} of {len(true)}: largest {true.max():.4g}, median {np.median(true):.4g}, "
            f"{100 * np.mean(stated >= true):.1f} % covered, stated over true {ratio:.4g} in the "
            "median"
        )
    for name in ("residual", "time"):
        values = [row[name] for row in answered]
        print(f"{name}: largest {max(values):.4g}, median {np.median(values):.4g}")


def line(row: dict[str, Any]) -> str:
    """Return the errors of a case in a line."""
    known = {name: row[name] for name in STATED if name in row}
    errors = ", ".join(
        f"{name} {off:+.2g} (said {said:.2g})" for name, (said, off) in known.items()
    )
    return f"{row['case']}: {errors}, residual {row['residual']:.0e}, {row['time']:.3f} s"


def main() -> None:
    """Run and print all cases, of random ones those that are off by more than they state."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--seed", type=int, default=2026)
    parser.add_argument("--drawn", type=int, metavar="COUNT", help="random tests")
    parser.add_argument("--accuracy", type=float, default=DEFAULT_ACCURACY)
    parser.add_argument("--limit", type=float, default=30.0, help="seconds of a simulation")
    parser.add_argument("--workers", type=int, default=2)
    chosen = parser.parse_args()
    cases: list[Any] = spread(chosen.count, chosen.seed)
    finer = FINER
    if chosen.drawn:
        cases, finer = [(chosen.seed, number) for number in range(chosen.drawn)], FINER_DRAWN
    asked = [(case, chosen.accuracy, finer, chosen.limit) for case in cases]
    rows = spread_out(measure, asked, chosen.workers)
    for row in rows:
        missed = any(abs(row[name][1]) > row[name][0] for name in STATED if name in row)
        if missed or not chosen.drawn and "refused" not in row:
            print(line(row))
    report(rows)


if __name__ == "__main__":
    main()
