"""Tables 5.1 to 5.4 of the thesis anew, with how each model does on what it has not seen.

Every part of the study is a dictionary of words, numbers and lists of them: JSON as it is. Times
are kept apart, for they alone differ from run to run.
"""

from itertools import product
from typing import Any

import numpy as np

from ..table import Detachments
from .features import Descriptor, Target
from .learners import BOOSTING, FOREST, LEARNERS, TREE
from .splits import (
    COMBINATION_FOLDS,
    FOLDS,
    RANDOM,
    Split,
    band_split,
    grouped_splits,
    random_split,
)
from .thesis import REDUCTION, TABLES, Table
from .validation import (
    Score,
    Trial,
    r_squared,
    relative,
    scores,
    work_rows,
)

Part = dict[str, Any]

_LEAST_BANDS = 5
# Fewer rows have no R2 to speak of.
_ENOUGH = 20


def tables(
    rows: Detachments, *, seed: int, jobs: int, quick: bool
) -> tuple[Part, dict[str, float], dict[Trial, Score]]:
    """Return the tables, the time of a fit [s] by model, and the scores on random rows.

    The scores of the tables are on all rows, as the authors'. Beside each stands what it is by
    every other split, there without the rows whose work is a placeholder.
    """
    kinds = [Trial(*kind) for kind in product(Target, Descriptor, LEARNERS)]
    folds = 2 if quick else FOLDS
    split = random_split(len(rows), seed, folds)
    of_all = scores(rows, [(t, split) for t in kinds], seed=seed, jobs=jobs, quick=quick)
    as_published = dict(zip(kinds, of_all, strict=True))
    entries, times, reductions = [], {}, []
    for which in Target:
        known = rows.chosen(work_rows(rows, which))
        combination_folds = folds if quick else COMBINATION_FOLDS
        splits = grouped_splits(known, seed, folds=folds, combination_folds=combination_folds)
        some = [kind for kind in kinds if kind.target is which]
        trials = [(trial, split) for split in splits for trial in some]
        results = scores(known, trials, seed=seed, jobs=jobs, quick=quick)
        found = dict(zip(trials, results, strict=True))
        for trial in some:
            by_split = {split.name: _group(found[trial, split], split) for split in splits}
            entries.append(_entry(trial, as_published[trial]) | {"splits": by_split})
            times[" / ".join(_names(trial))] = as_published[trial].train_time_s
        reductions += _reductions(some, splits, found)
    reductions = _reductions(kinds, (split,), {(t, split): s for t, s in as_published.items()}) + [
        r for r in reductions if r["split"] != RANDOM or r["target"] != Target.FORCE
    ]
    part = {"entries": entries, "reduction_published": REDUCTION, "reductions": reductions}
    return part, times, as_published


def published(trial: Trial) -> Table | None:
    """Return the table of the thesis that a trial belongs to."""
    wanted = trial.target, trial.descriptor
    return next((t for t in TABLES if (t.target, t.descriptor) == wanted), None)


def repeated_reduction(
    rows: Detachments, *, seed: int, jobs: int, quick: bool, times: int = 5
) -> Part:
    """Return how far errors and their fall by the descriptor depend on the draw of the folds."""
    kinds = [
        Trial(Target.FORCE, descriptor, learner)
        for descriptor in (Descriptor.NONE, Descriptor.PUBLISHED)
        for learner in (TREE, BOOSTING, FOREST)
    ]
    splits = [random_split(len(rows), seed + i) for i in range(1 if quick else times)]
    trials = [(trial, split) for split in splits for trial in kinds]
    all_scores = scores(rows, trials, seed=seed, jobs=jobs, quick=quick)
    mse = np.array([s.mse.mean() for s in all_scores]).reshape(len(splits), len(kinds))
    half = len(kinds) // 2
    best = 1 - mse[:, half:].min(axis=1) / mse[:, :half].min(axis=1)
    return {
        "draws": len(splits),
        "mse_1e-3": {
            " / ".join(_names(trial)[1:]): {
                "mean": 1e3 * mse[:, i].mean(),
                "least": 1e3 * mse[:, i].min(),
                "greatest": 1e3 * mse[:, i].max(),
            }
            for i, trial in enumerate(kinds)
        },
        "reduction_best_over_best": best.tolist(),
    }


def bands(rows: Detachments, *, seed: int, jobs: int, quick: bool) -> Part:
    """Return errors when a band of one input is held out, inner bands and edges apart.

    Of inputs with many values: where 5 bands cannot be made, a new value is asked of the tables.
    """
    found = []
    for which in Target:
        known = rows.chosen(work_rows(rows, which))
        columns = {
            "mu": known.tabor,
            "k": known.modulus_ratio,
            "n": known.exponent,
            "preload": known.preload,
            "rate": known.rate,
        }
        splits = [band_split(name, values) for name, values in columns.items()]
        trials = [
            (Trial(which, descriptor, BOOSTING), split)
            for split in splits
            if len(split.labels) >= _LEAST_BANDS
            for descriptor in (Descriptor.NONE, Descriptor.PUBLISHED)
        ]
        results = scores(known, trials, seed=seed, jobs=jobs, quick=quick)
        found += [_band(*trial, one) for trial, one in zip(trials, results, strict=True)]
    return {"entries": found}


def _band(trial: Trial, split: Split, one: Score) -> Part:
    inner = (split.fold > 0) & (split.fold < len(split.labels) - 1)
    return {
        "split": split.name,
        **dict(zip(("target", "descriptor", "model"), _names(trial), strict=True)),
        "bands": list(split.labels),
        "typical_error": [relative(m) for m in one.mse],
        "inner_r2": r_squared(one.true[inner], one.predicted[inner]),
        "edge_r2": r_squared(one.true[~inner], one.predicted[~inner]),
    }


def _names(trial: Trial) -> tuple[str, str, str]:
    return trial.target.value, trial.descriptor.value, trial.learner.name


def _entry(trial: Trial, one: Score) -> Part:
    target, descriptor, model = _names(trial)
    entry: Part = {
        "target": target,
        "descriptor": descriptor,
        "model": model,
        "table": None,
        "mse_1e-3": 1e3 * float(one.mse.mean()),
        "mse_spread_1e-3": 1e3 * float(one.mse.std()),
        "r2": float(one.r2.mean()),
        "r2_spread": float(one.r2.std()),
        "size": round(float(one.sizes.mean())),
        "typical_error": one.typical_error,
        "thesis": None,
    }
    table = published(trial)
    if table is not None:
        entry["table"] = table.number
        there = table.entries.get(model)
        if there is not None:
            entry["thesis"] = {
                "mse_1e-3": there.mse,
                "mse_spread_1e-3": there.mse_spread,
                "r2": there.r2,
                "r2_spread": there.r2_spread,
                "size": there.size,
                "train_time_s": there.train_time_s,
                "mse_within_spread": abs(entry["mse_1e-3"] - there.mse) <= there.mse_spread,
                "r2_within_spread": abs(entry["r2"] - there.r2) <= there.r2_spread,
            }
    return entry


def _group(one: Score, split: Split) -> Part:
    counts = np.bincount(split.fold, minlength=len(split.labels))
    return {
        "r2": one.pooled_r2,
        "typical_error": one.typical_error,
        "groups": [
            {
                "held_out": label,
                "rows": int(count),
                "r2": float(r2) if count >= _ENOUGH and np.isfinite(r2) else None,
                "typical_error": relative(mse),
            }
            for label, count, r2, mse in zip(split.labels, counts, one.r2, one.mse, strict=True)
        ],
    }


def _reductions(
    kinds: list[Trial], splits: tuple[Split, ...], found: dict[tuple[Trial, Split], Score]
) -> list[Part]:
    """Return by how much the descriptor lowers the error, by split, descriptor and model."""
    rows = []
    augmented = {(k.target, k.descriptor) for k in kinds if k.descriptor is not Descriptor.NONE}
    for (which, descriptor), split in product(sorted(augmented), splits):
        without, beside = (
            {m.name: found[Trial(which, d, m), split].pooled_mse for m in LEARNERS}
            for d in (Descriptor.NONE, descriptor)
        )
        compared = [name for name in without if name in TABLES[0].entries]
        best = [min(errors[name] for name in compared) for errors in (beside, without)]
        rows.append(
            {
                "target": which.value,
                "descriptor": descriptor.value,
                "split": split.name,
                "rows": len(split.fold),
                "best_over_best": 1 - best[0] / best[1],
                "best_over_best_with_network": 1 - min(beside.values()) / min(without.values()),
                "by_model": {name: 1 - beside[name] / without[name] for name in without},
            }
        )
    return rows
