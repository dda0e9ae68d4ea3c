"""Draw solids where the answer feels them most, and is least like that of a power law.

``python -m viscotack.surrogate.training.choosing_solids --out unsure.csv`` writes the last list of
the set `solids`. Candidates are drawn as those that fill the range are, with solids of their own;
the chance of one is how steeply the force rises with the rate, times how unlike a power law it is.
"""

import argparse
from pathlib import Path

import numpy as np

from viscotack.campaign.random_solids import creep_spectrum
from viscotack.datasets.drawing_solids import NAMES, rows
from viscotack.files.whole import write_whole

from .. import store
from ..alike import TIMES, alike
from ..physics import RATE

CANDIDATES, FIRST, SEED = 9000, 100_000, 25
# Step of log10 of the rate over which it rises; likenesses count up to some times the usual one.
_STEP, _USUAL, _MOST = 0.1, 0.01, 3.0


def chosen(count: int) -> list[tuple[str, ...]]:
    """Return cases as texts, in random order, so that the first are like all."""
    drawn = list(rows(CANDIDATES, first=FIRST, seed=SEED))
    columns = {name: np.array([float(row[i]) for row in drawn]) for i, name in enumerate(NAMES)}
    mu, k, depth, rate = (columns[n] for n in ("tabor", "modulus_ratio", "preload", "rate"))
    creep = np.empty((len(drawn), len(TIMES)))
    for i, (number, ratio, speed) in enumerate(zip(columns["solid"], k, rate, strict=True)):
        weights, tau = creep_spectrum(number, ratio)
        crept = -np.expm1(-TIMES[:, None] / speed / tau) @ (weights / weights.sum())
        creep[i] = ratio + (1 - ratio) * crept
    found = alike(mu, k, depth, creep)
    forces = []
    for way in (-1, 1):
        groups = found.groups.copy()
        groups[:, RATE] *= 10 ** (way * _STEP)
        forces.append(np.log10(store.shipped().evaluate(groups).pull_off_force))
    rise = np.clip((forces[1] - forces[0]) / (2 * _STEP), 0, 1)
    chance = np.maximum(rise * np.minimum(found.unlike / _USUAL, _MOST), 1e-3)
    random = np.random.default_rng(SEED)
    # weighted draws without repetition (Efraimidis and Spirakis)
    key = random.random(len(drawn)) ** (1 / chance)
    return [drawn[i] for i in random.permutation(np.sort(np.argsort(-key)[:count]))]


def main() -> None:
    """Write the list."""
    parser = argparse.ArgumentParser(prog="python -m viscotack.surrogate.training.choosing_solids")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--cases", type=int, default=3000)
    given = parser.parse_args()
    lines = [NAMES, *chosen(given.cases)]
    write_whole(given.out, "".join(",".join(line) + "\n" for line in lines).encode())


if __name__ == "__main__":
    main()
