"""Cases that no network learns from, drawn with fixed seeds: the sets `fresh` and `unseen`.

``python -m training.drawing fresh --out fresh.csv`` writes a list, which
``python -m viscotack.datasets fresh`` runs. Any beginning of a list has cases of all its designs,
as many for their number. Those of `fresh` measure how wide intervals must be; those of `unseen`
judge, and nothing is taken from them.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from viscotack.errors import InputError
from viscotack.surrogate import physics
from viscotack.surrogate.physics import INPUTS, Array

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


def _designs(each: int, of_box: int) -> tuple[Design, ...]:
    return (Design("even", each), Design("faces", each), *(Design(box, of_box) for box in BOXES))


# Seeds and designs of the lists.
LISTS = {"fresh": (2311, _designs(500, 40)), "unseen": (2322, _designs(1900, 100))}


def drawn(name: str) -> tuple[Array, list[str]]:
    """Return the inputs of the cases in the order of a list, shape (n, 5), and their designs."""
    seed, designs = LISTS[name]
    random = np.random.default_rng(seed)
    groups = np.concatenate([_draw(design, random) for design in designs])
    place = np.concatenate([(np.arange(d.count) + 0.5) / d.count for d in designs])
    names = [design.name for design in designs for _ in range(design.count)]
    order = np.argsort(place, kind="stable")
    return _rounded(groups[order]), [names[i] for i in order]


def designs_of(name: str, groups: Array) -> list[str]:
    """Return the designs of cases of a list, in their order."""
    inputs, designs = drawn(name)
    of = dict(zip(map(tuple, inputs.tolist()), designs, strict=True))
    try:
        return [of[tuple(row)] for row in groups.tolist()]
    except KeyError as row:
        raise InputError(f"{row} is no case of the list; draw it again") from None


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
    parser = argparse.ArgumentParser(prog="python -m training.drawing")
    parser.add_argument("name", choices=tuple(LISTS), help="which list")
    parser.add_argument("--out", type=Path, required=True, help="CSV file")
    given = parser.parse_args()
    form = f"%.{_DIGITS}g"
    np.savetxt(
        given.out,
        drawn(given.name)[0],
        delimiter=",",
        header=",".join(INPUTS),
        comments="",
        fmt=form,
    )
    print(given.out)


if __name__ == "__main__":
    main()
