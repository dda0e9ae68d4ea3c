r"""Sample the cases of `solids`: ``python -m research.datasets.drawing_solids --cases 20000``.

Tabor number, modulus ratio and depth are distributed uniformly in the logarithm over the ranges of
`broad`, and every case has its own solid. The rate is distributed uniformly in the logarithm
between the limit where all creep is over when the contact ends and the limit where none has begun.
The first cases do not depend on the number of cases, so a list can be extended.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np

from viscotack.model.materials.random_solids import creep_spectrum

_LOW, _HIGH = np.log10([0.01, 1e-4, 0.005]), np.log10([10.0, 0.7, 500.0])
# Ratio of creep to the relaxed one where it is over, and to the glassy one where it begins.
_OVER, _BEGUN = 0.95, 1.1
# Factors by which rates exceed this range: slowest and fastest.
_SLOW, _FAST = 0.02, 10.0
_DIGITS = 6
NAMES = ("tabor", "modulus_ratio", "solid", "preload", "rate")


def rows(count: int, *, first: int = 0, seed: int = 23) -> Iterator[tuple[str, ...]]:
    """Yield cases as texts, in the order of ``NAMES``; `first` is the index of the first solid.

    Examples
    --------
    >>> next(rows(1))[2]
    '0'
    """
    from scipy.stats import qmc

    # the name in every supported version of scipy
    generator: dict[str, Any] = {"seed": seed}
    places = qmc.Sobol(4, **generator).random(1 << max(count - 1, 1).bit_length())[:count]
    for number, (*place, speed) in enumerate(places.tolist(), first):
        tabor, ratio, depth = (float(_text(x)) for x in 10 ** (_LOW + (_HIGH - _LOW) * place))
        slow, fast = (np.log10(r) for r in _rates(number, ratio, depth))
        rate = 10 ** (slow + (fast - slow) * speed)
        yield (_text(tabor), _text(ratio), str(number), _text(depth), _text(rate))


def _rates(number: int, k: float, depth: float) -> tuple[float, float]:
    """Return the slowest and the fastest rate [h0 over the unit of time] of a solid."""
    weights, times = creep_spectrum(number, k)
    at = np.geomspace(1e-6 * times[0], 1e3 * times[-1], 600)
    creep = k + (1 - k) * -np.expm1(-at[:, None] / times) @ (weights / weights.sum())
    # at most the start of creep if the remaining creep equalled the glassy compliance
    begun = min(_BEGUN * k, k + 0.1 * (1 - k))
    over = max(_OVER, k + 0.9 * (1 - k))
    return _SLOW / np.interp(over, creep, at), _FAST * max(depth, 1.0) / np.interp(begun, creep, at)


def _text(value: float) -> str:
    return f"{value:.{_DIGITS}g}"


def main() -> None:
    """Write a list of cases to standard output."""
    parser = argparse.ArgumentParser(
        prog="python -m research.datasets.drawing_solids", description=__doc__
    )
    parser.add_argument("--cases", type=int, required=True, help="number of cases")
    parser.add_argument("--first", type=int, default=0, help="number of the first solid")
    parser.add_argument("--seed", type=int, default=23, help="seed of the other inputs")
    given = parser.parse_args()
    print(",".join(NAMES))
    for row in rows(given.cases, first=given.first, seed=given.seed):
        sys.stdout.write(",".join(row) + "\n")


if __name__ == "__main__":
    main()
