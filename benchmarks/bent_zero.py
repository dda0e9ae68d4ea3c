"""Compare pull-off forces read from rig curves with the true ones at low Tabor numbers.

    python benchmarks/bent_zero.py [--tabor 2 5] [--first 200] [--count 20]

The labs of `labs.py` without scatter between tests. Attraction lasts beyond the contact and would
bend the zero if it were not part of the model of the signal. Labs below 200 served in development;
the stated figures are those of 200 to 219, and of 300 to 309 with Tabor numbers of 1 to 2.
"""

import argparse

import labs
import numpy as np

from viscotack.lab.tack import evaluate


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tabor", type=float, nargs=2, default=(2.0, 5.0))
    parser.add_argument("--first", type=int, default=200)
    parser.add_argument("--count", type=int, default=20)
    given = parser.parse_args(namespace=argparse.Namespace(growing=False, disturbed=False))
    labs.SCATTER, rows = 0.0, []
    for seed in range(given.first, given.first + given.count):
        lab, errors = labs.lab_of(seed, given), []
        for speed in lab["speeds"][[0, 2, 4, 5]]:
            true, stiffness = labs.curve_of(lab, speed)[3], lab["stiffness"]
            found = evaluate(labs.record_of(lab, speed), compliance=1 / stiffness)
            forces = [one.pull_off_force for one in found.cycles]
            errors += [one.value / true - 1 for one in forces]
            rows += [(one.value / true - 1, (one.value - true) / one.uncertainty) for one in forces]
        print(f"Tabor {lab['tabor']:.2f}: {', '.join(f'{x:+.2%}' for x in errors)}", end="; ")
        print(f"mean {np.mean(errors):+.2%}", flush=True)
    error, ratio = np.sqrt(np.mean(np.square(rows), axis=0))
    print(f"{len(rows)} tests: error rms {error:.2%}, over uncertainty {ratio:.2f}")


if __name__ == "__main__":
    main()
