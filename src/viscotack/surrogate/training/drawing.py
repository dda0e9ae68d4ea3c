"""Cases that no network of an answer learns from, drawn with a fixed seed: the set `fresh`.

``python -m viscotack.surrogate.training.drawing --out fresh.csv`` writes its list, which
``python -m viscotack.datasets fresh`` runs. Any beginning of the list has cases of all designs, as
many for their number. Every second case of a design measures how wide intervals must be; nothing is
taken from the others, which judge.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

from .. import physics
from ..physics import INPUTS, Array

# Digits of an input in a list of cases.
_DIGITS = 6
# Places where intervals of an earlier surrogate held least, found by others; as they were told.
BOXES: dict[str, dict[str, tuple[float, float]]] = {
    "box of light tension": {
        "tabor": (0.017, 0.074),
        "modulus_ratio": (7e-4, 0.3),
        "preload": (0.035, 0.21),
    },
    "box of fast large contacts": {
        "tabor": (6.5, 10.0),
        "exponent": (0.6, 2.0),
        "preload": (0.2, 500.0),
        "rate": (7.6e4, 1e10),
    },
    "box of nearly elastic shallow starts": {
        "modulus_ratio": (0.42, 0.7),
        "preload": (0.005, 1.0),
    },
}


@dataclass(frozen=True)
class Design:
    """A way to draw cases.

    Attributes
    ----------
    name : str
        "even": evenly in the logarithms; "faces": one to three inputs at an end of their range,
        others evenly; or a box of ``BOXES``.
    count : int
        How many.
    """

    name: str
    count: int


SEED = 2311
DESIGNS = (
    Design("even", 500),
    Design("faces", 500),
    *(Design(box, 40) for box in BOXES),
)


def fresh() -> tuple[Array, list[str]]:
    """Return the inputs of the cases in the order of the list, shape (n, 5), and their designs."""
    random = np.random.default_rng(SEED)
    groups = np.concatenate([_draw(design, random) for design in DESIGNS])
    place = np.concatenate([(np.arange(d.count) + 0.5) / d.count for d in DESIGNS])
    names = [design.name for design in DESIGNS for _ in range(design.count)]
    order = np.argsort(place, kind="stable")
    return _rounded(groups[order]), [names[i] for i in order]


def designs_of(groups: Array) -> list[str]:
    """Return the designs of cases of the list, in their order."""
    of = dict(zip(map(tuple, fresh()[0].tolist()), fresh()[1], strict=True))
    try:
        return [of[tuple(row)] for row in groups.tolist()]
    except KeyError as row:
        raise InputError(f"{row} is no case of the list; draw it again") from None


def measuring(designs: list[str]) -> npt.NDArray[np.bool_]:
    """Return which cases measure the intervals: of each design every second one, from the first.

    Examples
    --------
    >>> measuring(["even", "faces", "even", "even"]).tolist()
    [True, True, False, True]
    """
    found, seen = [], dict.fromkeys(designs, 0)
    for name in designs:
        found.append(seen[name] % 2 == 0)
        seen[name] += 1
    return np.array(found)


def _draw(design: Design, random: np.random.Generator) -> Array:
    limits = physics.LIMITS | BOXES.get(design.name, {})
    low, high = np.log10(np.array([limits[name] for name in INPUTS])).T
    part = random.random((design.count, len(INPUTS)))
    if design.name == "faces":
        ends = random.integers(0, 2, part.shape)
        # the first of the inputs in a random order, one to three of them
        order = np.argsort(random.random(part.shape), axis=1)
        part = np.where(order < random.integers(1, 4, (design.count, 1)), ends, part)
    return 10 ** (low + part * (high - low))


def _rounded(groups: Array) -> Array:
    return np.array([[float(f"{x:.{_DIGITS}g}") for x in row] for row in groups.tolist()])


def main() -> None:
    """Draw and write."""
    parser = argparse.ArgumentParser(prog="python -m viscotack.surrogate.training.drawing")
    parser.add_argument("--out", type=Path, required=True, help="CSV file")
    given = parser.parse_args()
    form = f"%.{_DIGITS}g"
    np.savetxt(given.out, fresh()[0], delimiter=",", header=",".join(INPUTS), comments="", fmt=form)
    print(given.out)


if __name__ == "__main__":
    main()
