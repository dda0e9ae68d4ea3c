"""The learning study of the thesis repeated, and what it is worth: all of its parts, in order.

Maghami, PhD thesis (2025), chapter 5 and appendices VI, VII and X.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from viscotack import InputError

from ..table import Array, Detachments
from .extrapolation import extrapolation
from .features import DESCRIPTOR, INPUTS, Descriptor, Target, crack_amplification, inputs, target
from .insight import insight
from .learners import BOOSTING, FOREST, LINEAR, NETWORK, TREE, check_installed
from .noise import label_noise
from .tables import bands, repeated_reduction, tables
from .thesis import ROWS, STATISTICS
from .trajectories import trajectories
from .tuning import architectures, forest_curve, grid_search, rows_curve
from .validation import Score, Trial, shared

Part = dict[str, Any]

# Pictures A.4 and A.5 of the thesis.
_DRAWN = (
    Trial(Target.FORCE, Descriptor.NONE, LINEAR),
    Trial(Target.FORCE, Descriptor.NONE, BOOSTING),
    Trial(Target.FORCE, Descriptor.PUBLISHED, FOREST),
    Trial(Target.FORCE, Descriptor.PUBLISHED, BOOSTING),
)
_MOST_POINTS = 2000
_FEWEST_ROWS = 50
# Parts of which there are several.
_LISTS = ("grid", "forest", "rows", "insight")


@dataclass(frozen=True)
class Study:
    """What came out.

    Attributes
    ----------
    numbers : dict
        Every number by part, as JSON holds it; the same bytes for the same table, seed and
        versions of the libraries.
    times : dict
        Processor time of a fit [s] by target, descriptor and model.
    """

    numbers: Part
    times: dict[str, float]


def check(rows: Detachments) -> None:
    """Refuse a table that is too small, and a machine that lacks the learning libraries."""
    check_installed()
    if len(rows) < _FEWEST_ROWS:
        raise InputError(f"a study needs at least {_FEWEST_ROWS} rows, got {len(rows)}")


def study(
    rows: Detachments,
    *,
    seed: int = 42,
    jobs: int = 1,
    quick: bool = False,
    progress: Callable[[str], None] = lambda _: None,
) -> Study:
    """Repeat the study on a table.

    Parameters
    ----------
    rows : Detachments
        At least 50.
    seed : int
        Of every draw; 42 is the authors'.
    jobs : int
        Processes of this machine, a thread each.
    quick : bool
        Whether to go through all of it with small models, to see that it works; its numbers mean
        nothing.
    progress : callable
        Called with the name of each part as it begins.

    Raises
    ------
    ModuleNotFoundError
        If scikit-learn or xgboost is missing.
    ValueError
        If the table is too small.
    """
    check(rows)
    if jobs < 1:
        raise InputError(f"jobs must be at least 1, got {jobs}")
    plain: dict[str, Any] = {"seed": seed, "quick": quick}
    every: dict[str, Any] = plain | {"jobs": jobs}
    progress("tables 5.1 to 5.4, by every split")
    table, times, scores = tables(rows, **every)
    numbers: Part = {"settings": plain, "data": _statistics(rows), "tables": table}
    numbers["noise"] = {which.value: label_noise(rows, which) for which in Target}
    numbers["predicted"] = [_predicted(trial, scores[trial], seed) for trial in _DRAWN]
    progress("the folds drawn again, and bands of inputs")
    numbers["repeated"] = repeated_reduction(rows, **every)
    numbers["bands"] = bands(rows, **every)
    progress("settings, learning curves, extrapolation, what models go by")
    names, parts = zip(*_parts(rows), strict=True)
    found = shared(_made, [(part, plain) for part in parts], jobs)
    for name in dict.fromkeys(names):
        some = [one for other, one in zip(names, found, strict=True) if other == name]
        numbers[name] = some if name in _LISTS else some[0]
    return Study(numbers, times)


def _parts(rows: Detachments) -> list[tuple[str, tuple[Any, ...]]]:
    """Return the parts that need no other: name, function, and arguments before the settings."""
    both = tuple(Descriptor)[:2]
    curves = [(curve, rows, d) for d in both for curve in (grid_search, forest_curve)]
    tuning = [("grid" if part[0] is grid_search else "forest", part) for part in curves]
    learning = [
        ("rows", (rows_curve, rows, learner, d))
        for learner in (TREE, BOOSTING, FOREST)
        for d in both
    ]
    inside = [
        ("insight", (insight, rows, Target.FORCE, d, learner))
        for learner in (FOREST, NETWORK)
        for d in both
    ]
    single = [
        ("extrapolation", (extrapolation, rows)),
        ("architectures", (architectures, inputs(rows), target(rows, Target.FORCE))),
        ("trajectories", (trajectories, rows)),
    ]
    return [*single, *tuning, *learning, *inside]


def _made(part: tuple[Any, ...], settings: Part) -> Any:
    return part[0](*part[1:], **settings)


def _statistics(rows: Detachments) -> Part:
    """Return Table A.1 of this table, beside the thesis's."""
    columns = dict(zip(INPUTS, inputs(rows).T, strict=True))
    columns |= {f"log10 {which.value}": target(rows, which) for which in Target}
    columns[f"log10 {DESCRIPTOR}"] = np.log10(crack_amplification(rows, Descriptor.PUBLISHED))
    return {
        "rows": len(rows),
        "rows_thesis": ROWS,
        "work_is_a_placeholder": int((~rows.work_known).sum()),
        "statistics": {
            name: {"here": _moments(values), "thesis": list(STATISTICS.get(name, ())) or None}
            for name, values in columns.items()
        },
    }


def _moments(v: Array) -> list[float]:
    return [float(x) for x in (v.mean(), np.median(v), v.std(ddof=1), v.min(), v.max())]


def _predicted(trial: Trial, one: Score, seed: int) -> Part:
    rows = np.random.default_rng(seed).permutation(len(one.true))[:_MOST_POINTS]
    return {
        "target": trial.target.value,
        "descriptor": trial.descriptor.value,
        "model": trial.learner.name,
        "true": one.true[rows].tolist(),
        "predicted": one.predicted[rows].tolist(),
    }
