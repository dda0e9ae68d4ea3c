"""What histories give, in numbers: the table of docs/histories.md and the Maugis table.

Prints to standard output. Time: about a minute. ``python benchmarks/histories.py [random-tests]``.
"""

import sys
from pathlib import Path
from time import perf_counter

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "ladder"))

import test_histories as histories  # noqa: E402
import test_traction_laws as laws  # noqa: E402

from viscotack.methods import solve  # noqa: E402
from viscotack.problem import Groups  # noqa: E402
from viscotack.protocol import Apart, Approach, AtDepth, AtForce, Dwell, LoadTo  # noqa: E402
from viscotack.result.dead_load import time_to_detachment  # noqa: E402
from viscotack.result.observables import pull_off_force  # noqa: E402
from viscotack.theory import lennard_jones  # noqa: E402


def dugdale() -> None:
    print("Dugdale against Maugis, default accuracy: lambda, error of the pull-off force")
    for parameter in (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0):
        tabor, force, depth, _ = laws.maugis_branch(parameter)
        groups = Groups(
            tabor=tabor,
            material=laws.ELASTIC,
            start=AtDepth(float(np.interp(0.8, force, depth))),
            rate=1.0,
            traction=laws.near_dugdale(parameter),
        )
        found = pull_off_force(solve(groups, until="pull-off", estimate_error=False))
        print(f"{parameter:8g} {found / -force[0] - 1:+10.1e}")


def limits() -> None:
    print("relaxed start, slow approach and dwell, stiff spring: pull-off force")
    for make, depth in ((histories.sphere, 5.0), (histories.punch, 1.0)):
        slow = (Approach(0.01, AtDepth(depth)), Dwell(100.0))
        cases = (
            make(AtDepth(depth), rate=10.0),
            make(Apart(10.0), *slow, rate=10.0),
            make(AtDepth(depth), rate=10.0, stiffness=1e5),
        )
        forces = [pull_off_force(histories.run(case, "pull-off")) for case in cases]
        print("".join(f"{force:12.6f}" for force in forces))
    print("largest load: stiffness of the spring, and under load control")
    for k in (1.0, 0.1, 0.01, 1e-4):
        case = histories.sphere(AtForce(1.0), rate=1 / k, stiffness=k)
        print(f"{k:8g} {-histories.run(case).force.min():10.4f}")
    load = histories.run(histories.sphere(AtForce(1.0), LoadTo(-9.0, 10.0)))
    print(f"    load {-load.force.min():10.4f}")


def dead_loads() -> None:
    print("dead load: material, mu, load, time to detachment, of it that of the crack")
    for material in (histories.SOLID, histories.POWER_LAW):
        for tabor in (3.24, 8.0):
            for load in (1.1, 1.3, 2.0, 3.0):
                moves = (LoadTo(-load, 1e-3), Dwell(1e5, hold="force"))
                case = histories.sphere(AtForce(0.0), *moves, tabor=tabor, material=material)
                found = time_to_detachment(histories.run(case))
                ratio = float(lennard_jones.pull_off_ratio(tabor))
                share = histories.crack_time(load / ratio, tabor, material) / found
                print(
                    f"{type(material).__name__:20} {tabor:5g} {load:5g} {found:9.4g} {share:6.2f}"
                )


def table() -> None:
    print("Table 3.1, pull-off: columns relaxed, step, ramp; rows shallow, deep")
    print("punch\n", histories.six(histories.punch, 1.0))
    for tabor in (1.0, 3.24):

        def sphere(*args, tabor=tabor, **options):
            return histories.sphere(*args, tabor=tabor, **options)

        print(f"sphere, mu = {tabor}\n", histories.six(sphere, 5.0))


def wandering(number: int) -> None:
    began = perf_counter()
    stopped = histories.wander(range(number))
    print(f"{number} random histories in {perf_counter() - began:.1f} s; stopped: {stopped}")


if __name__ == "__main__":
    dugdale()
    limits()
    dead_loads()
    table()
    wandering(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
