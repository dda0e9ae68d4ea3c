"""Releases at wanted forces on simulated rigs: ``python benchmarks/control.py [COUNT] [SEED]``.

Random contacts of spheres on power-law and standard solids, each behind a random spring, are to let
go at a random force between those of the slowest and the fastest speed of their force table. The
controller reads drive and force a thousand times a second. Beside it the drive at the constant
speed that the table has for the force, and the controller with the table of a contact whose work of
adhesion and modulus are both 10 % larger. Then the time of a tick.
"""

import sys
from dataclasses import replace
from math import inf
from time import perf_counter

import numpy as np

import viscotack as vt
from viscotack.control import Release, force_table, let_go
from viscotack.errors import InputError

PERIOD = 1e-3
OFF = 1.1


def contact(rng, stiffer=1.0):
    """Draw a contact, and the duration of its slowest release."""

    def among(low, high):
        return float(10 ** rng.uniform(np.log10(low), np.log10(high)))

    modulus, k, radius = among(1e5, 3e6), among(3e-3, 0.3), among(5e-4, 1e-2)
    work, tabor, tau = among(0.03, 0.3), among(0.3, 5), among(1e-3, 1)
    solid = {
        "rubbery_modulus": modulus * stiffer,
        "glassy_modulus": modulus * stiffer / k,
        "tau0": tau,
        "poisson_ratio": 0.5,
    }
    if rng.random() < 0.7:
        material = vt.RetardationPowerLaw(exponent=float(rng.uniform(0.3, 1.2)), **solid)
    else:
        material = vt.StandardSolid(**solid)
    gap = (radius * work**2 / (modulus / 0.75) ** 2) ** (1 / 3) / tabor
    force = 1.5 * np.pi * radius * work
    problem = vt.Problem(
        material=material,
        traction=vt.LennardJones(work_of_adhesion=work * stiffer, equilibrium_gap=gap),
        geometry=vt.Sphere(radius=radius),
        protocol=vt.Retraction(
            start=vt.AtForce(force=float(rng.uniform(0, 3)) * force), speed=1e-4
        ),
    )
    length = (force**2 / (radius * modulus**2)) ** (1 / 3)
    return problem, length, force / length


def main(count=50, seed=1):
    """Let contacts go, and print how far from the wanted force."""
    rows, took = [], []
    for number in range(count):
        rng = np.random.default_rng([seed, number])
        problem, length, stiff = contact(rng)
        slow = length / float(10 ** rng.uniform(-0.3, 0.7))
        spring = stiff * float(10 ** rng.uniform(-0.7, 1.5))
        began = perf_counter()
        try:
            table = force_table(problem, slow, 30 * slow, tolerance=0.02)
            made = perf_counter() - began
            low, high = table.pull_off_force.min(), table.pull_off_force.max()
            wanted = float(rng.uniform(low, high))
            release = Release(table, wanted, spring, PERIOD)
            found = let_go(problem, release)
            other, _, _ = contact(np.random.default_rng([seed, number]), OFF)
            wrong = force_table(other, slow, 30 * slow, tolerance=0.02)
            try:
                off = let_go(problem, Release(wrong, wanted, spring, PERIOD)).miss
            except InputError:
                off = np.nan
            test = replace(problem.protocol, speed=release.speed, stiffness=spring)
            open_loop = vt.solve(replace(problem, protocol=test), until="pull-off")
            constant = vt.pull_off_force(open_loop) * problem.scales().force / wanted - 1
        except InputError as reason:
            print(f"{number:3d}: {reason}", flush=True)
            rows.append((np.nan,) * 4)
            continue
        rows.append((found.miss, constant, off, high / low))
        took.append(made)
        print(
            f"{number:3d}: {problem.material.__class__.__name__:20s} mu "
            f"{problem.groups().tabor:4.2f} spring {spring / stiff:5.2f} F_max/F_min "
            f"{high / low:5.2f} ticks {len(found.time):5d} miss {found.miss:+8.2%} constant drive "
            f"{constant:+8.2%} table 10 % off {off:+8.2%}",
            flush=True,
        )
    values = np.abs(np.array(rows, float))
    names = ("controller", "constant drive", "table 10 % off")
    for name, value in zip(names, values.T[:3], strict=True):
        known = value[np.isfinite(value)]
        print(
            f"{name}: within 5 % in {np.sum(known < 0.05)} of {len(value)}, median "
            f"{np.median(known):.2%}, largest {known.max():.2%}"
        )
    print(f"tables: {np.median(took):.1f} s in the median")
    release = Release(table, wanted, spring, PERIOD, inf)
    began = perf_counter()
    for _ in range(20_000):
        release.drive_speed(table.start_depth, 0.0)
    print(f"a tick of the controller: {(perf_counter() - began) / 20_000 * 1e6:.1f} us")


if __name__ == "__main__":
    main(*(int(x) for x in sys.argv[1:]))
