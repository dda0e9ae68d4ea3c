"""Deep pulls about as fast as the bulk relaxes: the sets `deep` (power laws) and `sharp` (solids).

``python -m training.deep_draws deep --out deep.csv`` writes a list, which
``python -m viscotack.datasets deep`` runs. The force of these pulls may have two maxima, and the
work jumps where they are equal.
"""

import argparse
from pathlib import Path

import numpy as np

from viscotack.campaign.random_solids import creep_spectrum

# Tabor number, modulus ratio, depth [h0], rate times retardation time over depth, and exponent.
_LOW = np.log10([0.02, 1e-4, 5.0, 0.2, 0.6])
_HIGH = np.log10([10.0, 5e-2, 500.0, 5.0, 2.0])
COUNTS, _SEEDS = {"deep": 600, "sharp": 1600}, {"deep": 2331, "sharp": 2332}
# First number of the random solids, and the shares of those of one and of two to four times.
_FIRST, _ONE, _FEW = 400_000, 0.45, 0.8
COLUMNS = {
    "deep": ("tabor", "modulus_ratio", "exponent", "preload", "rate"),
    "sharp": ("tabor", "modulus_ratio", "solid", "preload", "rate"),
}


def drawn(name: str) -> list[tuple[float, ...]]:
    """Return the cases of a list, in the order of `COLUMNS`."""
    random = np.random.default_rng(_SEEDS[name])
    found, number = [], _FIRST
    for _ in range(COUNTS[name]):
        row = 10 ** (_LOW + random.random(len(_LOW)) * (_HIGH - _LOW))
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
    parser = argparse.ArgumentParser(prog="python -m training.deep_draws")
    parser.add_argument("name", choices=tuple(COUNTS), help="which list")
    parser.add_argument("--out", type=Path, required=True, help="CSV file")
    given = parser.parse_args()
    rows, header = drawn(given.name), ",".join(COLUMNS[given.name])
    np.savetxt(given.out, rows, delimiter=",", header=header, comments="", fmt="%.6g")
    print(given.out)


if __name__ == "__main__":
    main()
