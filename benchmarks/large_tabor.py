"""Tabor numbers of 100: `python benchmarks/large_tabor.py`, about three minutes.

An elastic contact beside JKR, and the PDMS lens of the demo with a range of attraction of 30.8 nm
at four speeds, at the loosest accuracy; at one of them also at a better one.
"""

from __future__ import annotations

import sys
from pathlib import Path
from time import process_time

from viscotack import AtDepth, Elastic, Groups, Problem, pull_off_force, solve

sys.path.insert(0, str(Path(__file__).parents[1] / "examples"))
from pdms_lens import PDMS, SHORT_GAP, lens

LOOSEST = 0.02


def measured(problem: Problem | Groups, accuracy: float) -> tuple[float, str]:
    """Return the pull-off force, and what it took."""
    began = process_time()
    result = solve(problem, accuracy=accuracy, until="pull-off", estimate_error=False)
    return pull_off_force(result), (
        f"accuracy {accuracy:g}: {process_time() - began:.0f} s of processor time, "
        f"{result.statistics['steps']:.0f} steps, energy residual {result.energy_residual:.1e}"
    )


def main() -> None:
    """Run and print."""
    elastic = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    groups = Groups(tabor=100.0, material=elastic, start=AtDepth(-70.0), rate=1.0)
    force, took = measured(groups, 2e-3)
    print(f"elastic, mu 100: {force:.5f} times the JKR pull-off force; {took}", flush=True)
    for speed, accuracy in (
        (1e-3, LOOSEST),
        (1e-4, LOOSEST),
        (1e-4, 0.01),
        (1e-5, LOOSEST),
        (1e-6, LOOSEST),
    ):
        problem = lens(PDMS, speed, SHORT_GAP)
        force, took = measured(problem, accuracy)
        newton = force * problem.scales().force
        print(f"lens at {speed * 1e6:g} um/s: {newton * 1e3:.3f} mN; {took}", flush=True)


if __name__ == "__main__":
    main()
