"""Remake the table of elastic pull-off of a Lennard-Jones sphere: force and work against mu.

Runs the solver at the Chebyshev points of ln mu between 0.01 and 10 from zero force to the force
minimum, and prints `viscotack.theory.elastic.lennard_jones.ROWS`.

Time: about ten minutes on one core, nearly all of it for mu above 3.
"""

import argparse

import numpy as np

from viscotack import AtForce, Elastic, Groups, pull_off_force, solve, work_to_pull_off

LOWEST, HIGHEST, DEGREE = 0.01, 10.0, 16


def points(degree):
    """Return the Tabor numbers of the table, ascending."""
    x = np.cos(np.pi * np.arange(degree, -1, -1) / degree)
    middle, half = np.log(LOWEST * HIGHEST) / 2, np.log(HIGHEST / LOWEST) / 2
    return np.exp(middle + half * x)


def pulled(tabor, accuracy):
    """Return force [1.5 pi R w], work [1.5 pi R w h0] and the estimated errors of both."""
    solid = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    case = Groups(tabor=tabor, material=solid, start=AtForce(0.0), rate=1.0)
    result = solve(case, accuracy=accuracy, until="pull-off")
    estimate = result.error_estimate
    return pull_off_force(result), work_to_pull_off(result), estimate["force"], estimate["work"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--accuracy", type=float, default=1e-4)
    options = parser.parse_args()
    for tabor in points(DEGREE):
        force, work, *errors = pulled(tabor, options.accuracy)
        print(
            f"    ({tabor:.15g}, {force:.8f}, {work:.7f}),  # {errors[0]:.0e} {errors[1]:.0e}",
            flush=True,
        )


if __name__ == "__main__":
    main()
