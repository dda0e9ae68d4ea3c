"""Which cases to simulate next: those of which a surrogate is least sure.

``python -m viscotack.surrogate.training.choosing --count 2000 --out cases.csv`` writes a list for
``viscotack campaign run cases.csv``. The set `chosen` was made in this way, with four networks that
had learned the first 10,000 rows of `broad` and `thesis`.
"""

import argparse
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import qmc

from viscotack.errors import InputError

from .. import physics
from ..model import Surrogate
from ..physics import INPUTS, Array
from ..store import SHIPPED, load

# Points to choose from: a Sobol fill, and a quarter as many on the faces of the range, where a
# fill has few.
_POINTS = 2**16
# One surprising point shall not draw all the cases, and neither shall a great number of dull ones.
_MOST_SPREAD, _POWER = 0.03, 1.5


def choose(surrogate: Surrogate, count: int, *, seed: int = 0) -> Array:
    """Return inputs of cases to be simulated, likelier where the networks disagree; shape (n, 5).

    Parameters
    ----------
    surrogate : Surrogate
        Whose networks are asked.
    count : int
        How many.
    seed : int
        Of the draw.

    Raises
    ------
    ValueError
        If more are wanted than there are points to choose from, or one network alone is asked.
    """
    most = _POINTS + _POINTS // 4
    if not 0 < count <= most:
        raise InputError(f"there are {most} points to choose from, {count} were asked for")
    if len(surrogate.force.weights[0]) < 2:
        raise InputError("one network alone does not disagree; the surrogate has only one")
    low, high = np.log10(physics.LOW), np.log10(physics.HIGH)
    random = np.random.default_rng(seed)
    # the name that every supported version of SciPy knows
    generator: dict[str, Any] = {"seed": seed}
    inner = qmc.Sobol(len(INPUTS), **generator).random(_POINTS)
    faces = random.random((_POINTS // 4, len(INPUTS)))
    side = random.integers(0, len(INPUTS), len(faces))
    faces[np.arange(len(faces)), side] = random.integers(0, 2, len(faces))
    groups = 10 ** (low + np.concatenate([inner, faces]) * (high - low))
    spread = np.minimum(surrogate.evaluate(groups).force_spread, _MOST_SPREAD) ** _POWER
    return groups[random.choice(len(groups), count, replace=False, p=spread / spread.sum())]


def main() -> None:
    """Choose and write."""
    parser = argparse.ArgumentParser(prog="python -m viscotack.surrogate.training.choosing")
    parser.add_argument("--count", type=int, default=2000, help="cases")
    parser.add_argument("--out", type=Path, required=True, help="CSV file")
    parser.add_argument(
        "--surrogate", type=Path, default=SHIPPED, help="the shipped one if left out"
    )
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    found = choose(load(given.surrogate), given.count, seed=given.seed)
    np.savetxt(given.out, found, delimiter=",", header=",".join(INPUTS), comments="", fmt="%.6g")
    print(given.out)


if __name__ == "__main__":
    main()
