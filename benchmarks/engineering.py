"""Which contacts of an engineer are answered, by what, and with what band.

`python benchmarks/engineering.py [--count 2000] [--seed 1] [--judged 0]`: contacts drawn evenly in
logarithms: radius 0.1 to 20 mm, modulus 1e4 to 1e7 Pa, work of adhesion 0.02 to 1 J/m2, range 0.3
to 5 nm, modulus ratio 1e-4 to 0.3, speed 1 um/s to 0.1 m/s; and, what is left open there, exponent
0.15 to 2, time tau0 1e-4 to 10 s, preload 0.1 to 100 times 1.5 pi R dg0. How many `predict` answers
by what was learned, how long it takes, and how far it is from the theory of a crack at the edge on
so many of them (--judged), a second or two each.
"""

from __future__ import annotations

import argparse
from collections import Counter
from contextlib import suppress
from time import perf_counter

import numpy as np

from viscotack import (
    AtForce,
    InputError,
    LennardJones,
    OutOfRange,
    Problem,
    RetardationPowerLaw,
    Retraction,
    Sphere,
    crack_contact,
)
from viscotack.forecast import predict
from viscotack.forecast.tiers import AT_ONCE

RANGES = {
    "radius": (1e-4, 2e-2),
    "modulus": (1e4, 1e7),
    "work_of_adhesion": (0.02, 1.0),
    "range": (0.3e-9, 5e-9),
    "modulus_ratio": (1e-4, 0.3),
    "speed": (1e-6, 0.1),
    "exponent": (0.15, 2.0),
    "time": (1e-4, 10.0),
    "preload": (0.1, 100.0),
}


def contacts(count: int, seed: int) -> list[Problem]:
    """Return contacts in SI, of which those beyond small strain are left out."""
    low, high = np.log(np.array(list(RANGES.values()))).T
    drawn = np.exp(low + np.random.default_rng(seed).random((count, len(low))) * (high - low))
    found = []
    for row in drawn.tolist():
        with suppress(InputError):
            found.append(_problem(dict(zip(RANGES, row, strict=True))))
    return found


def _problem(of: dict[str, float]) -> Problem:
    load = 1.5 * np.pi * of["radius"] * of["work_of_adhesion"] * of["preload"]
    return Problem(
        material=RetardationPowerLaw(
            rubbery_modulus=of["modulus"],
            glassy_modulus=of["modulus"] / of["modulus_ratio"],
            exponent=of["exponent"],
            tau0=of["time"],
            poisson_ratio=0.5,
        ),
        traction=LennardJones(work_of_adhesion=of["work_of_adhesion"], equilibrium_gap=of["range"]),
        geometry=Sphere(radius=of["radius"]),
        protocol=Retraction(start=AtForce(load), speed=of["speed"]),
    )


def main() -> None:
    """Draw, ask and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--judged", type=int, default=0)
    given = parser.parse_args()
    found, times, inside = Counter(), [], []
    drawn = contacts(given.count, given.seed)
    tabor = np.array([problem.tabor for problem in drawn])
    for problem in drawn:
        began = perf_counter()
        try:
            said = predict(problem, budget=AT_ONCE)
        except OutOfRange:
            said = None
        times.append(perf_counter() - began)
        found["not learned" if said is None else f"{said.method}, {said.band}"] += 1
        if said is not None:
            inside.append((problem, said))
    print(f"{len(drawn)} of {given.count} contacts of small strain, percent of these:")
    print(f"Tabor numbers: 5, 50, 95 %: {np.quantile(tabor, [0.05, 0.5, 0.95]).round(1)}")
    for words, number in found.most_common():
        print(f"{words:<40}{number / len(drawn):>7.1%}")
    print(f"one answer: {1e3 * np.median(times):.2f} ms in the median")
    off, held, silent = [], [], 0
    for problem, said in inside[: given.judged]:
        try:
            by_theory = crack_contact(problem)
        except OutOfRange:
            silent += 1
            continue
        assert by_theory.pull_off_force is not None
        off.append(abs(said.pull_off_force / by_theory.pull_off_force - 1))
        held.append(said.interval[0] <= by_theory.pull_off_force <= said.interval[1])
    if off:
        print(
            f"{len(off)} beside the theory: off by {np.median(off):.2%} in the median, "
            f"{np.max(off):.2%} at most; {np.mean(held):.0%} in their interval; "
            f"of {silent} more the theory has no answer"
        )


if __name__ == "__main__":
    main()
