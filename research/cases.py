"""Cases that several commands of this folder take, and processes that do them."""

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np
from scipy.stats import qmc

from viscotack import AtDepth, Elastic, Groups, RetardationPowerLaw, StandardSolid

REDUCED = {"rubbery_modulus": 1.0, "poisson_ratio": 0.0}


def reduced(modulus_ratio: float, exponent: float | None = None) -> Any:
    """Return a reduced power law by retardation, without exponent a standard solid.

    At a modulus ratio of 1 the solid is elastic.
    """
    if modulus_ratio == 1:
        return Elastic(**REDUCED)
    creeping = {**REDUCED, "glassy_modulus": 1 / modulus_ratio, "tau0": 1.0}
    if not exponent:
        return StandardSolid(**creeping)
    return RetardationPowerLaw(exponent=exponent, **creeping)


def case(tabor: float, modulus_ratio: float, exponent: float, depth: float, rate: float) -> Groups:
    """Return a power-law case by its five groups."""
    return Groups(
        tabor=tabor, material=reduced(modulus_ratio, exponent), start=AtDepth(depth), rate=rate
    )


def spread(count: int, seed: int) -> list[Groups]:
    """Return cases that fill mu 0.01-10, n 0.2-2, k 1e-3-0.5, depth 0.01-100, rate 0.1-1e8."""
    low = np.log10([0.01, 0.2, 1e-3, 0.01, 0.1])
    high = np.log10([10.0, 2.0, 0.5, 100.0, 1e8])
    points = qmc.Sobol(5, seed=seed).random_base2(int(np.ceil(np.log2(count))))[:count]
    return [
        case(mu, k, n, depth, rate)
        for mu, n, k, depth, rate in (10 ** (low + points * (high - low))).tolist()
    ]


def words(groups: Groups) -> str:
    """Return a power-law case in a few words."""
    m: Any = groups.material
    depth = groups.start.depth if isinstance(groups.start, AtDepth) else np.nan
    return (
        f"mu {groups.tabor:.3g}, n {m.exponent:.3g}, k {m.modulus_ratio:.3g}, depth {depth:.3g}, "
        f"rate {groups.rate:.3g}"
    )


def spread_out(work: Callable[[Any], Any], items: Sequence[Any], workers: int = 2) -> list[Any]:
    """Return work(item) for all items, done by a few processes."""
    with ProcessPoolExecutor(workers) as pool:
        chunk = min(16, max(1, len(items) // (20 * workers)))
        return list(pool.map(work, items, chunksize=chunk))
