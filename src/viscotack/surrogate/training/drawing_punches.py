"""Draw the cases of `punch_starts`, `punch_faces` and `punch_limits`: starts of any stress.

``python -m viscotack.surrogate.training.drawing_punches starts --out starts.csv`` writes a list of
cases whose size, thickness, modulus ratio, stress of the start and rate are spread evenly in the
logarithm over the range of the surrogate of the punch; ``faces`` one of cases of which one to three
inputs are at an end of it, ``fast`` one at a rate beyond all others and a little beyond the ends.
The first cases do not depend on how many there
are, so a list can be made longer.
"""

import argparse
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import qmc

from viscotack.files.whole import write_whole

from ..punch_physics import HIGH, INPUTS, LOW, MODULUS_RATIO, PRELOAD, RATE, Array, compliance

_DIGITS = 6
_SEEDS = {"starts": 41, "fast": 43, "faces": 47}
# A rate at which nothing relaxes, and how far its cases go beyond the ends of the range.
_FASTEST, _BEYOND = 1e16, 1.1
# The cohesion of all: it changes crack speeds and nothing else.
_COHESION = "0.05"


def drawn(design: str, count: int) -> Array:
    """Return rows of size, thickness, modulus ratio, depth of the start and rate, shape (n, 5).

    Examples
    --------
    >>> bool(np.all(drawn("starts", 4)[:2] == drawn("starts", 2)))
    True
    """
    # the name that every supported version of SciPy knows
    generator: dict[str, Any] = {"seed": _SEEDS[design]}
    sobol = qmc.Sobol(len(INPUTS), **generator)
    places = sobol.random(1 << max(count - 1, 1).bit_length())[:count]
    low, high = np.log10(LOW), np.log10(HIGH)
    if design == "fast":
        low, high = low - np.log10(_BEYOND), high + np.log10(_BEYOND)
        high[MODULUS_RATIO] = np.log10(HIGH[MODULUS_RATIO])
    if design == "faces":
        _to_faces(places)
    rows = 10 ** (low + (high - low) * places)
    rows[:, PRELOAD] *= compliance(rows)
    if design == "fast":
        rows[:, RATE] = _FASTEST
    return rows


def _to_faces(places: Array) -> None:
    """Move one to three inputs of each place to an end of its range."""
    for number, place in enumerate(places):
        random = np.random.default_rng((_SEEDS["faces"], number))
        which = random.choice(len(place), random.integers(1, 4), replace=False)
        place[which] = random.integers(0, 2, len(which))


def main() -> None:
    """Write a list."""
    parser = argparse.ArgumentParser(prog="python -m viscotack.surrogate.training.drawing_punches")
    parser.add_argument("design", choices=sorted(_SEEDS), help="what is drawn")
    parser.add_argument("--out", type=Path, required=True, help="CSV file")
    parser.add_argument("--cases", type=int, required=True, help="how many")
    given = parser.parse_args()
    lines = [",".join((*INPUTS, "cohesion"))]
    for row in drawn(given.design, given.cases).tolist():
        lines.append(",".join([*(f"{x:.{_DIGITS}g}" for x in row), _COHESION]))
    write_whole(given.out, ("\n".join(lines) + "\n").encode())


if __name__ == "__main__":
    main()
