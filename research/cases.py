"""Cases that several commands of this folder take, and where published data lie."""

from __future__ import annotations

import argparse
import csv
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import qmc

from viscotack import AtDepth, AtForce, Groups, RetardationPowerLaw, StandardSolid

# A sample of the table that the authors of the thesis published; tests/data/README.md says of it.
SAMPLE = Path(__file__).resolve().parents[1] / "tests/data/sphere_bem_published/rows.csv"


def power_law(modulus_ratio: float, exponent: float) -> RetardationPowerLaw:
    """Return the reduced power law by retardation spectrum."""
    return RetardationPowerLaw(
        rubbery_modulus=1.0,
        glassy_modulus=1 / modulus_ratio,
        exponent=exponent,
        tau0=1.0,
        poisson_ratio=0.0,
    )


def standard_solid(modulus_ratio: float) -> StandardSolid:
    """Return the reduced standard linear solid."""
    return StandardSolid(
        rubbery_modulus=1.0, glassy_modulus=1 / modulus_ratio, tau0=1.0, poisson_ratio=0.0
    )


def case(tabor: float, modulus_ratio: float, exponent: float, depth: float, rate: float) -> Groups:
    """Return a power-law case by its five groups."""
    return Groups(
        tabor=tabor, material=power_law(modulus_ratio, exponent), start=AtDepth(depth), rate=rate
    )


# Values of slow, refined runs of another program: force, and how well it is known.
REFINED = {
    "A: mu 3.24, n 0.8, k 0.1, depth 73, rate 10^2.5": (case(3.24, 0.1, 0.8, 73, 10**2.5), 7.3298),
    "B: mu 3.24, n 0.8, k 0.1, depth 16.7, rate 10^0.5": (
        case(3.24, 0.1, 0.8, 16.7, 10**0.5),
        2.1074,
    ),
    "C: mu 1, n 0.4, k 0.01, depth 20, rate 10^3": (case(1.0, 0.01, 0.4, 20, 1e3), 8.3126),
    "D: mu 0.3, n 0.6, k 0.1, depth 10, rate 10^4": (case(0.3, 0.1, 0.6, 10, 1e4), 6.6754),
} | {
    f"standard solid, mu 3.24, k 0.1, start at force 28.865, rate {rate:g}": (
        Groups(tabor=3.24, material=standard_solid(0.1), start=AtForce(28.865), rate=rate),
        force,
    )
    for rate, force in ((1.0, 2.0169), (10.0, 4.1019), (100.0, 8.9335), (1000.0, 10.1644))
}


def spread(count: int, seed: int) -> list[Groups]:
    """Return cases that fill mu 0.01-10, n 0.2-2, k 1e-3-0.5, depth 0.01-100, rate 0.1-1e8."""
    low = np.log10([0.01, 0.2, 1e-3, 0.01, 0.1])
    high = np.log10([10.0, 2.0, 0.5, 100.0, 1e8])
    points = qmc.Sobol(5, seed=seed).random_base2(int(np.ceil(np.log2(count))))[:count]
    return [
        case(mu, k, n, depth, rate)
        for mu, n, k, depth, rate in (10 ** (low + points * (high - low))).tolist()
    ]


def add_table(parser: argparse.ArgumentParser) -> None:
    """Add the option that says where the published table is."""
    parser.add_argument(
        "--table",
        type=_table,
        default=str(SAMPLE),
        metavar="PATH",
        help="CSV of published detachments; the sample in tests/data if left out",
    )


def _table(path: str) -> Path:
    if Path(path).is_file():
        return Path(path)
    raise argparse.ArgumentTypeError(
        f"there is no file {path}; take the table that the authors of the thesis published, from "
        "Data_Files of https://github.com/alimaghamii/ML4Adh, or the sample of it in "
        "tests/data/sphere_bem_published of this repository"
    )


def published_rows(table: Path, count: int, seed: int) -> list[dict[str, float]]:
    """Return rows of a published table, drawn at random."""
    with table.open(newline="", encoding="utf-8-sig") as file:
        rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    chosen = np.random.default_rng(seed).choice(len(rows), min(count, len(rows)), replace=False)
    return [rows[i] for i in chosen]


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
    return list(spread_as_done(work, items, workers))


def spread_as_done(
    work: Callable[[Any], Any], items: Sequence[Any], workers: int = 2
) -> Iterator[Any]:
    """Yield work(item) for all items in their order, while a few processes go on with the rest."""
    with ProcessPoolExecutor(workers) as pool:
        yield from pool.map(work, items, chunksize=min(16, max(1, len(items) // (20 * workers))))
