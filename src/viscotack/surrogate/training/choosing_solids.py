"""Draw solids where the answer feels them most, and is least like that of a power law.

``python -m viscotack.surrogate.training.choosing_solids --out unsure.csv`` writes a list like the
last one of the set `solids`. Candidates are drawn as those that fill the range are, with solids of
their own; the chance of one is how steeply the force rises with the rate, times how unlike a power
law it is. ``--cases 10000 --candidates 24000 --first 200000 --seed 26`` draws one like the first of
`rough`. With ``--wide`` the chance is the squared width of the interval that the surrogate of today
says; that of an earlier day drew the second, from 30,000, ``--first 300000 --seed 27``.
"""

import argparse
from pathlib import Path

import numpy as np

from viscotack.arrays import Array
from viscotack.campaign.random_solids import creep_spectrum
from viscotack.datasets.drawing_solids import NAMES, rows
from viscotack.files.whole import write_whole

from .. import linear_solids, store
from ..alike import TIMES
from ..physics import RATE
from .likeness import Tests, first

# Step of log10 of the rate over which it rises; likenesses count up to some times the usual one,
# half widths of log10 of the force up to this one.
_STEP, _USUAL, _MOST, _WIDEST = 0.1, 0.01, 3.0, 0.06


def chosen(
    count: int,
    *,
    candidates: int = 9000,
    number: int = 100_000,
    seed: int = 25,
    wide: bool = False,
) -> list[tuple[str, ...]]:
    """Return cases as texts, in random order, so that the first are like all.

    Parameters
    ----------
    count : int
        How many.
    candidates, number, seed : int
        How many are drawn from, the number of the first solid, and what the draw follows from.
    wide : bool
        Whether the widths of intervals say the chances.
    """
    drawn = list(rows(candidates, first=number, seed=seed))
    columns = {name: np.array([float(row[i]) for row in drawn]) for i, name in enumerate(NAMES)}
    mu, k, depth, rate = (columns[n] for n in ("tabor", "modulus_ratio", "preload", "rate"))
    creep = np.empty((len(drawn), len(TIMES)))
    for i, (solid, ratio, speed) in enumerate(zip(columns["solid"], k, rate, strict=True)):
        weights, tau = creep_spectrum(solid, ratio)
        crept = -np.expm1(-TIMES[:, None] / speed / tau) @ (weights / weights.sum())
        creep[i] = ratio + (1 - ratio) * crept
    chance = (_widths if wide else _unlike)((mu, k, depth), creep)
    random = np.random.default_rng(seed)
    # weighted draws without repetition (Efraimidis and Spirakis)
    key = np.log(random.random(len(drawn))) / chance
    return [drawn[i] for i in random.permutation(np.sort(np.argsort(-key)[:count]))]


def _unlike(tests: Tests, creep: Array) -> Array:
    """Return how steeply forces rise with the rate, times how unlike power laws solids are."""
    found = first(tests, creep)
    forces = []
    for way in (-1, 1):
        groups = found.groups.copy()
        groups[:, RATE] *= 10 ** (way * _STEP)
        forces.append(np.log10(store.shipped().evaluate(groups).pull_off_force))
    rise = np.clip((forces[1] - forces[0]) / (2 * _STEP), 0, 1)
    return np.maximum(rise * np.minimum(found.unlike / _USUAL, _MOST), 1e-3)


def _widths(tests: Tests, creep: Array) -> Array:
    """Return the squares of the widths of intervals."""
    tabor, k, preload = tests
    made = linear_solids.shipped()
    like = made.like(tabor, k, preload, creep)
    said = made.evaluate(like)
    ends = made.intervals(like, said).pull_off_force[:, 1]
    return np.minimum(np.log10(ends / said.pull_off_force), _WIDEST) ** 2


def main() -> None:
    """Write the list."""
    parser = argparse.ArgumentParser(prog="python -m viscotack.surrogate.training.choosing_solids")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--cases", type=int, default=3000)
    parser.add_argument("--candidates", type=int, default=9000, help="drawn from")
    parser.add_argument("--first", type=int, default=100_000, help="number of the first solid")
    parser.add_argument("--seed", type=int, default=25, help="of the draw")
    parser.add_argument("--wide", action="store_true", help="by the widths of intervals")
    given = parser.parse_args()
    cases = chosen(
        given.cases,
        candidates=given.candidates,
        number=given.first,
        seed=given.seed,
        wide=given.wide,
    )
    lines = [NAMES, *cases]
    write_whole(given.out, "".join(",".join(line) + "\n" for line in lines).encode())


if __name__ == "__main__":
    main()
