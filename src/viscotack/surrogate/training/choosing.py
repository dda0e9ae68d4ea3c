"""Which cases to simulate next: those of which a surrogate is least sure.

``python -m viscotack.surrogate.training.choosing --count 700 --out cases.csv`` writes a list for
``viscotack campaign run cases.csv``. The set `steep` was made in this way, by how far errors of the
force reach; `chosen` before it, by how far four networks were apart that had learned the first
10,000 rows of `broad` and `thesis`.
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
from ..trust import CONFIDENCES, error_inputs

# Points to choose from: a Sobol fill, and a quarter as many on the faces of the range, where a
# fill has few.
_POINTS = 2**16
# One surprising point shall not draw all the cases, and neither shall a great number of dull ones:
# chances go with the squared errors that are to be expected, up to one [log10].
_MOST, _POWER = 0.02, 2.0


def choose(surrogate: Surrogate, count: int, *, seed: int = 0) -> Array:
    """Return inputs of cases to be simulated, likelier where errors reach far; shape (n, 5).

    Parameters
    ----------
    surrogate : Surrogate
        That says how far its errors of the force reach.
    count : int
        How many.
    seed : int
        Of the draw.

    Raises
    ------
    ValueError
        If more are wanted than there are points to choose from.
    """
    most = _POINTS + _POINTS // 4
    if not 0 < count <= most:
        raise InputError(f"there are {most} points to choose from, {count} were asked for")
    low, high = np.log10(physics.LOW), np.log10(physics.HIGH)
    random = np.random.default_rng(seed)
    # the name that every supported version of SciPy knows
    generator: dict[str, Any] = {"seed": seed}
    inner = qmc.Sobol(len(INPUTS), **generator).random(_POINTS)
    faces = random.random((_POINTS // 4, len(INPUTS)))
    side = random.integers(0, len(INPUTS), len(faces))
    faces[np.arange(len(faces)), side] = random.integers(0, 2, len(faces))
    groups = 10 ** (low + np.concatenate([inner, faces]) * (high - low))
    said = surrogate.evaluate(groups)
    reach = surrogate.trust.widths(error_inputs(physics.scaled(groups), said), CONFIDENCES[0])[0]
    chance = np.minimum(reach, _MOST) ** _POWER
    return groups[random.choice(len(groups), count, replace=False, p=chance / chance.sum())]


def main() -> None:
    """Choose and write."""
    parser = argparse.ArgumentParser(prog="python -m viscotack.surrogate.training.choosing")
    parser.add_argument("--count", type=int, default=700, help="cases")
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
