"""Tabor numbers from 10 on: `python benchmarks/large_tabor.py`, about two minutes.

An elastic contact beside JKR; the PDMS lens of the demo with a range of attraction of 30.8 nm at
four speeds, at the default accuracy and a four times better one, beside the contact whose edge is a
steady crack; and where simulations hand over to that.
"""

from __future__ import annotations

import sys
from pathlib import Path
from time import process_time

from viscotack import (
    AtDepth,
    Elastic,
    Groups,
    Problem,
    StandardSolid,
    crack_contact,
    pull_off_force,
    solve,
)

sys.path.insert(0, str(Path(__file__).parents[1] / "examples"))
from pdms_lens import PDMS, SHORT_GAP, lens

DEFAULT, BETTER = 2e-3, 5e-4
SOLID = StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)


def measured(problem: Problem | Groups, accuracy: float) -> tuple[float, str]:
    """Return the pull-off force, and what it took."""
    began = process_time()
    result = solve(problem, accuracy=accuracy, until="pull-off", estimate_error=False)
    took = f"{process_time() - began:.2f} s of processor time, {result.method}"
    if result.energy_residual is not None:
        steps = result.statistics["steps"]
        took += f", {steps:.0f} steps, energy residual {result.energy_residual:.1e}"
    return pull_off_force(result), f"accuracy {accuracy:g}: {took}"


def main() -> None:
    """Run and print."""
    elastic = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    groups = Groups(tabor=30.0, material=elastic, start=AtDepth(200.0), rate=1.0)
    force, took = measured(groups, DEFAULT)
    print(f"elastic, mu 30: {force:.5f} times the JKR pull-off force; {took}", flush=True)
    for speed in (1e-3, 1e-4, 1e-5, 1e-6):
        problem = lens(PDMS, speed, SHORT_GAP)
        newton = problem.scales().force
        for accuracy in (DEFAULT, BETTER):
            force, took = measured(problem, accuracy)
            print(
                f"lens at {speed * 1e6:g} um/s: {force * newton * 1e3:.3f} mN; {took}", flush=True
            )
        found = crack_contact(problem)
        assert found.pull_off_force is not None
        words = f"{found.pull_off_force * newton * 1e3:.3f} mN within {found.band:.1%}"
        print(f"  as a contact with a crack for its edge: {words}", flush=True)
    for tabor in (30.0, 100.0, 190.0, 210.0, 1e4, 1e5):
        start = AtDepth(10 * tabor)
        groups = Groups(tabor=tabor, material=SOLID, start=start, rate=3 * tabor)
        force, took = measured(groups, DEFAULT)
        print(f"standard solid, mu {tabor:g}: {force:.4f}; {took}", flush=True)


if __name__ == "__main__":
    main()
