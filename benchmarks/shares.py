"""How the asked accuracy is divided: the errors that mesh, steps and modes make each alone.

`python benchmarks/shares.py [--count 16]`: the twelve cases of `cost.py` and others over the range
of `cases.spread`, to the pull-off. Each part has its default setting while the others are 20 times
as accurate, beside a run in which all of them are. Some minutes.
"""

from __future__ import annotations

import argparse
from dataclasses import replace

import numpy as np
from cases import spread
from cost import REFERENCE

from viscotack import Groups, pull_off_force, work_to_pull_off
from viscotack.bem.settings import Settings
from viscotack.bem.solver import _run
from viscotack.problem.accuracy import DEFAULT_ACCURACY

FINER = 20.0
PARTS = {
    "mesh": ("nodes_per_zone", "growth_inside", "growth_outside", "reach"),
    "steps": ("step_error", "force_change", "travel", "first_travel", "imbalance"),
    "modes": ("mode_tolerance",),
}
# Of the work the asked accuracy is so many times that of the force (`accuracy.py`).
WORK = 5.0


def answer(groups: Groups, settings: Settings) -> np.ndarray:
    """Return force and work of a run with these settings."""
    result = _run(groups, groups, settings, "pull-off", False, None)
    return np.array([pull_off_force(result), work_to_pull_off(result)])


def errors(groups: Groups, default: Settings, fine: Settings) -> dict[str, np.ndarray]:
    """Return the relative errors of force and work, of all parts together and of each alone."""
    best = answer(groups, fine)
    chosen = {"all": default} | {
        part: replace(fine, **{name: getattr(default, name) for name in names})
        for part, names in PARTS.items()
    }
    return {part: abs(answer(groups, settings) / best - 1) for part, settings in chosen.items()}


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=16)
    parser.add_argument("--seed", type=int, default=11)
    chosen = parser.parse_args()
    asked = DEFAULT_ACCURACY
    default, fine = (Settings.for_accuracy(x) for x in (asked, asked / FINER))
    rows = []
    for groups in [*REFERENCE, *spread(chosen.count, chosen.seed)]:
        rows.append(errors(groups, default, fine))
        parts = ", ".join(f"{name} {f:.1e} {w:.1e}" for name, (f, w) in rows[-1].items())
        print(f"mu {groups.tabor:.3g}, k {groups.modulus_ratio:.2g}: {parts}", flush=True)
    for name in rows[0]:
        force, work = np.array([row[name] for row in rows]).T / np.array([[asked], [WORK * asked]])
        print(
            f"{name:5s} over asked: force {np.median(force):.3f} in the median, {force.max():.3f} "
            f"at most, within in {np.sum(force < 1)} of {len(rows)}; work {np.median(work):.3f}, "
            f"{work.max():.3f}, {np.sum(work < 1)}"
        )


if __name__ == "__main__":
    main()
