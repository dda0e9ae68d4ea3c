"""Compare pull-off forces read from rig curves with the true ones at low Tabor numbers.

    python benchmarks/bent_zero.py [--tabor 2 5] [--labs 0 1 2]

The labs of `labs.py` without scatter between tests. Attraction lasts beyond the contact and bends
the zero that is read from the free parts, so the forces are too low.
"""

import argparse

import labs
import numpy as np

from viscotack.lab.tack import evaluate


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tabor", type=float, nargs=2, default=(2.0, 5.0))
    parser.add_argument("--labs", type=int, nargs="+", default=[0, 1, 2])
    given = parser.parse_args(namespace=argparse.Namespace(growing=False, disturbed=False))
    labs.SCATTER = 0.0
    for seed in given.labs:
        lab, errors = labs.lab_of(seed, given), []
        for speed in lab["speeds"][[0, 2, 4, 5]]:
            true, stiffness = labs.curve_of(lab, speed)[3], lab["stiffness"]
            found = evaluate(labs.record_of(lab, speed), compliance=1 / stiffness)
            errors += [one.pull_off_force.value / true - 1 for one in found.cycles]
        print(f"Tabor {lab['tabor']:.2f}: {', '.join(f'{x:+.2%}' for x in errors)}", end="; ")
        print(f"mean {np.mean(errors):+.2%}", flush=True)


if __name__ == "__main__":
    main()
