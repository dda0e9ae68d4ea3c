"""Compare the dead load that a sphere holds for a time, by a slow crack, with simulations.

    python benchmarks/holding.py --count 20 --seed 4

Draws solids (standard and power law, modulus ratios 0.01 to 0.2), spheres, preloads, times of 3 to
3,000 times of the solid, and Tabor numbers from 2 to 30; simulates the load of the theory until it
falls; and converts the simulated time to a load by the theory.
"""

import argparse
from dataclasses import replace

import numpy as np

from viscotack import (
    AtForce,
    InputError,
    LennardJones,
    Problem,
    RetardationPowerLaw,
    Retraction,
    Sphere,
    StandardSolid,
    solve,
)
from viscotack.design.holding import held_load
from viscotack.protocol import Dwell, LoadTo
from viscotack.result.dead_load import time_to_detachment


def drawn(random, power_law):
    """Return a sphere that rests under a preload, and a time [s]."""
    k, tau0 = 10 ** random.uniform(-2, -0.7), 10 ** random.uniform(-2, 0)
    solid = dict(rubbery_modulus=1e6, glassy_modulus=1e6 / k, tau0=tau0, poisson_ratio=0.5)
    exponent = float(random.uniform(0.3, 0.8))
    kind = RetardationPowerLaw(**solid, exponent=exponent) if power_law else StandardSolid(**solid)
    R, w, mu = (10 ** random.uniform(*x) for x in ((-3.3, -2), (-1.5, -0.8), (0.3, 1.5)))
    h0 = (R * w**2 / kind.contact_modulus**2) ** (1 / 3) / mu
    preload = 1.5 * np.pi * R * w * 10 ** random.uniform(-0.5, 1)
    law = LennardJones(work_of_adhesion=w, equilibrium_gap=h0)
    rest = Retraction(AtForce(preload), 1e-6)
    problem = Problem(material=kind, traction=law, geometry=Sphere(R), protocol=rest)
    return problem, tau0 * 10 ** random.uniform(0.5, 3.5)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=4)
    asked = parser.parse_args()
    random = np.random.default_rng(asked.seed)
    errors = []
    for number in range(asked.count):
        problem, time = drawn(random, number % 2 == 0)
        tabor = problem.groups().tabor
        try:
            load = held_load(problem, time)
            moves = (LoadTo(-load, 0.01 * time), Dwell(20 * time, hold="force"))
            held = Retraction(problem.protocol.start, None, moves)
            run = solve(replace(problem, protocol=held), accuracy=5e-3, throw=False)
            simulated = time_to_detachment(run)
        except InputError as reason:
            print(f"{number:3d} mu {tabor:5.2f}: {reason}", flush=True)
            continue
        errors.append(load / held_load(problem, simulated) - 1)
        print(
            f"{number:3d} mu {tabor:5.2f}: load over 1.5 pi R dg "
            f"{load / problem.scales().force:.3f}, time {simulated / time:.3f} of the wanted one, "
            f"load {errors[-1]:+.2%}",
            flush=True,
        )
    print(
        f"{len(errors)} of {asked.count}: rms {np.sqrt(np.mean(np.square(errors))):.2%}, largest "
        f"{np.abs(errors).max():.2%}"
    )


if __name__ == "__main__":
    main()
