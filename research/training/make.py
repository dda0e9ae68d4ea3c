"""A surrogate of the package, from its datasets to its file, without intervals.

``python -m research.training CONTACT --out DIR [--workers N]``. Fitted networks are kept in the
folder, so that a run that was stopped goes on. On the same machine and libraries the result is the
same to the last digit. `second` adds second networks and measures the intervals.
"""

import argparse
import json
import platform
import sys
from collections.abc import Callable
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from time import perf_counter
from typing import Any

from threadpoolctl import threadpool_limits

from viscotack import datasets
from viscotack.prediction.surrogate import store
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.version import __version__

from . import train_punch, train_short_range, train_solids, train_sphere
from .shop import Shop

# What trains each surrogate: with a shop, and whether on few rows only, to see that it runs.
# Returned are the surrogate, the names of its datasets, and further metadata.
Course = Callable[..., tuple[Surrogate, tuple[str, ...], dict[str, Any]]]
COURSES: dict[str, Course] = {
    "sphere": train_sphere.learned,
    "solids": train_solids.learned,
    "punch": train_punch.learned,
    "short range": train_short_range.learned,
}


def make(contact: str, folder: Path, *, workers: int = 1, quick: bool = False) -> dict[str, Any]:
    """Train a surrogate of ``COURSES``, write it into a folder, and return its metadata.

    The networks are kept in the folder too. With `quick` rows are few and networks small, to see
    that it runs.
    """
    began = perf_counter()
    with threadpool_limits(1), Shop(folder / "networks", workers) as shop:
        made, sets, found = COURSES[contact](shop, quick=quick)
    facts = {
        "viscotack": __version__,
        "made": datetime.now(UTC).date().isoformat(),
        "machine": platform.machine(),
        "libraries": {name: version(name) for name in ("numpy", "scipy", "jax", "jaxlib")},
        "sets": {n: datasets.files.checksum(datasets.path(n).read_bytes()) for n in sets},
        **found,
    }
    path = folder / store.FILES[contact].name
    store.save(made, path, facts)
    print(f"{path}, {perf_counter() - began:.0f} s", file=sys.stderr)
    return facts


def main() -> None:
    """Train and print metadata."""
    parser = argparse.ArgumentParser(prog="python -m research.training", description=__doc__)
    parser.add_argument("contact", choices=tuple(COURSES))
    parser.add_argument("--out", type=Path, required=True, help="folder of the networks and file")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    parser.add_argument("--quick", action="store_true", help="few rows, to see that it runs")
    given = parser.parse_args()
    facts = make(given.contact, given.out, workers=given.workers, quick=given.quick)
    print(json.dumps(facts, indent=1))
