"""Lists of cases, drawn with fixed seeds: the sets `fresh`, `unseen`, `deep` and `sharp`.

``python -m research.training.drawing fresh --out fresh.csv`` writes a list, which
``python -m research.datasets fresh`` runs. Any beginning of the first two has cases of all its
designs, as many for their number; those of `fresh` measure how wide intervals must be, those of
`unseen` judge, and nothing is taken from them. The others are deep pulls about as fast as the bulk
relaxes, of power laws (`deep`) and other solids (`sharp`): their force may have two maxima, and the
work jumps where they are equal.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from viscotack.errors import InputError
from viscotack.model.materials.random_solids import creep_spectrum
from viscotack.prediction.surrogate import physics
from viscotack.prediction.surrogate.physics import INPUTS, Array

# Tabor number, modulus ratio, depth [h0], rate times retardation time over depth, and exponent.
_DEEP_LOW = np.log10([0.02, 1e-4, 5.0, 0.2, 0.6])
_DEEP_HIGH = np.log10([10.0, 5e-2, 500.0, 5.0, 2.0])
_COUNTS, _SEEDS = {"deep": 600, "sharp": 1600}, {"deep": 2331, "sharp": 2332}
# First number of the random solids, and the shares of those of one and of two to four times.
_FIRST, _ONE, _FEW = 400_000, 0.45, 0.8
_COLUMNS = {
    "deep": ("tabor", "modulus_ratio", "exponent", "preload", "rate"),
    "sharp": ("tabor", "modulus_ratio", "solid", "preload", "rate"),
}
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


def deep(name: str) -> list[tuple[float, ...]]:
    """Return the cases of a list, in the order of `_COLUMNS`."""
    random = np.random.default_rng(_SEEDS[name])
    found, number = [], _FIRST
    for _ in range(_COUNTS[name]):
        row = 10 ** (_DEEP_LOW + random.random(len(_DEEP_LOW)) * (_DEEP_HIGH - _DEEP_LOW))
        tabor, k, depth, part, exponent = (float(f"{x:.6g}") for x in row)
        if name == "deep":
            found.append((tabor, k, exponent, depth, float(f"{part * depth:.6g}")))
            continue
        sort = random.random()
        least, most = (1, 1) if sort < _ONE else (2, 4) if sort < _FEW else (1, 40)
        while not least <= len(creep_spectrum(number := number + 1, k)[0]) <= most:
            pass
        weights, times = creep_spectrum(number, k)
        time = float(np.exp(weights @ np.log(times)))
        found.append((tabor, k, number, depth, float(f"{part * depth / time:.6g}")))
    return found


def main() -> None:
    """Draw and write."""
    parser = argparse.ArgumentParser(prog="python -m research.training.drawing")
    parser.add_argument("name", choices=(*LISTS, *_COUNTS), help="which list")
    parser.add_argument("--out", type=Path, required=True, help="CSV file")
    given = parser.parse_args()
    rows = drawn(given.name)[0] if given.name in LISTS else deep(given.name)
    header = ",".join(_COLUMNS.get(given.name, INPUTS))
    form = f"%.{_DIGITS}g"
    np.savetxt(given.out, rows, delimiter=",", header=header, comments="", fmt=form)
    print(given.out)


if __name__ == "__main__":
    main()
