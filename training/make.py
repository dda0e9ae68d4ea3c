"""The surrogate that is shipped, from its datasets to its file and its scores.

``python -m training --out DIR [--workers N]``. Fitted networks are kept in the folder,
so that a run that was stopped goes on. On the same machine and libraries the result is the same to
the last digit.
"""

import argparse
import json
import platform
import sys
from dataclasses import asdict
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from threadpoolctl import threadpool_limits

from viscotack import datasets
from viscotack.files.whole import write_whole
from viscotack.surrogate import store
from viscotack.version import __version__

from . import drawing, rows, scores
from .recipe import BANDED, QUICK, Recipe, learn, learn_limits
from .refining import QUICK_REFINEMENT, Refinement, refine
from .rows import FAR_OFF, FAST, LEARNED
from .shop import Shop

# Rows drawn at random that no network learns from.
_KEPT, _SEED = 0.06, 2026
# Every so many rows where all is only tried.
_THINNED = 4


def make(folder: Path, *, workers: int, quick: bool = False) -> dict[str, Any]:
    """Train, write ``surrogate.npz`` and ``scores.json`` in the folder; return the scores.

    :mod:`training.second` measures the intervals.

    Parameters
    ----------
    folder : Path
        Where the networks are kept too.
    workers : int
        Processes; four take about half an hour.
    quick : bool
        Few rows and small networks, to see that it runs.
    """
    began = perf_counter()
    fast = rows.read(FAST)
    learned, test = parted()
    if quick:
        fast, learned, test = (r.chosen(slice(None, None, _THINNED)) for r in (fast, learned, test))
    recipe, banded = (QUICK, QUICK.force) if quick else (Recipe(), BANDED)
    refinement = QUICK_REFINEMENT if quick else Refinement()
    with threadpool_limits(1), Shop(folder / "networks", workers) as shop:
        limits = learn_limits(learned, fast, recipe, shop)
        _say(began, "limits")
        whole = learn(learned, limits, recipe, shop)
        begun = scores.begin_bands(learned, limits, banded, shop)
        rough = whole.surrogate()
        _say(began, "networks")
        surrogate = refine(rough, learned, fast, refinement, shop)
        _say(began, "networks of what they leave over")
        found: dict[str, Any] = {"bands kept apart": []}
        for one in begun:
            found["bands kept apart"].append(scores.score_band(one, limits))
            _say(began, json.dumps(found["bands kept apart"][-1]))
    facts = _facts(len(learned), len(test), recipe, refinement)
    store.save(surrogate, folder / "surrogate.npz", facts | {"scores": found})
    write_whole(folder / "scores.json", (json.dumps(found, indent=1) + "\n").encode())
    return found


def measuring_rows(test: rows.Rows) -> tuple[rows.Rows, ...]:
    """Return the rows that measure intervals: those kept apart, and those of `fresh`.

    Of the former without those of `thesis`, most of which are materials of a few kinds; of the
    latter without those whose own errors are larger than what is to be measured, and those on faces
    of the range as a set of their own, for errors reach further there.
    """
    fresh = rows.read("fresh")
    measuring = rows.certain("fresh")
    faces = np.array(drawing.designs_of("fresh", fresh.groups)) == "faces"
    kept = test.chosen(test.origin != LEARNED.index("thesis"))
    return kept, fresh.chosen(measuring & ~faces), fresh.chosen(measuring & faces)


def parted() -> tuple[rows.Rows, rows.Rows]:
    """Return the rows that networks learn from, and those kept apart."""
    whole = rows.read(*LEARNED)
    kept = kept_apart(len(whole))
    return whole.chosen(~kept), whole.chosen(kept)


def kept_apart(count: int) -> npt.NDArray[np.bool_]:
    """Return which of the rows no network learns from: the same in every run."""
    return np.random.default_rng(_SEED).random(count) < _KEPT


def _facts(learned: int, test: int, recipe: Recipe, refinement: Refinement) -> dict[str, Any]:
    names = ("numpy", "scipy", "jax", "jaxlib")
    return {
        "viscotack": __version__,
        "made": datetime.now(UTC).date().isoformat(),
        "machine": platform.machine(),
        "libraries": {name: version(name) for name in names},
        "sets": {
            name: datasets.files.checksum(datasets.path(name).read_bytes())
            for name in (*LEARNED, FAST, *FAR_OFF, "fresh")
        },
        "rows": {"learned from": learned, "kept apart": test},
        "recipe": asdict(recipe) | {"refinement": asdict(refinement)},
    }


def _say(began: float, what: str) -> None:
    print(f"{perf_counter() - began:6.0f} s  {what}", file=sys.stderr, flush=True)


def main() -> None:
    """Train and say where the file is."""
    parser = argparse.ArgumentParser(prog="python -m training", description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the networks and files")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    parser.add_argument("--quick", action="store_true", help="few rows, to see that it runs")
    given = parser.parse_args()
    make(given.out, workers=given.workers, quick=given.quick)
    print(given.out / "surrogate.npz")
