"""Tables 5.1 to 5.4 from the authors' archive, and what the models are worth on new materials.

Claims: those of Tables 5.1 to 5.4: 60.3 % less error by the descriptor, R2 up to 0.9995.

Seen: Squares with bars are printed, dots are learned here from the authors' 8,920 rows by their
seeds: all 16 within the bars.

Needs: the authors' archive, given by --archive; without it the kept numbers stand.

Costs: 30 models of five folds, those by exponent and modulus ratio, and a grid of nine: three
minutes of processor time.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from viscotack import InputError

from ..archive import Learned, learned
from ..bench import Bench, Numbers
from ..learning.features import Target
from ..learning.learners import BOOSTING, FOREST, LEARNERS, Learner
from ..learning.thesis import TABLES
from ..learning.validation import Score, Split, random_split, score, value_split
from .style import COLOURS, panels

NEEDS_ARCHIVE = True
SIZE = (9.0, 3.8)
# The authors' seeds, of folds and of models: their script of Table 5.2 has another.
_SEED, _OTHER_SEED = 42, 40
SEEDS = {"5.1": _SEED, "5.2": _OTHER_SEED, "5.3": _SEED, "5.4": _SEED}
# The authors' grid of boosting, and the shares of the rows that test and stop it.
_RATES, _DEPTHS, _ROUNDS, _PATIENCE = (0.01, 0.05, 0.1), (3, 6, 9), 1000, 10
_TEST, _STOP = 0.20, 0.15


def numbers(bench: Bench) -> Numbers:
    """Return the entries of the four tables beside the printed ones, and what they depend on."""
    if bench.archive is None:
        raise InputError("this needs the authors' archive: give its path by --archive")
    rows = learned(bench.archive)
    found: Numbers = {"rows": len(rows.force)}
    for table in TABLES.values():
        of, seed = (table.target, table.descriptor), SEEDS[table.number]
        tried = [_scored(rows, *of, LEARNERS[name], seed) for name in table.entries]
        mse = np.array([1e3 * one.mse.mean() for one in tried])
        printed, spread = np.array([(e.mse, e.mse_spread) for e in table.entries.values()]).T
        found[table.number] = {
            "model": list(table.entries),
            "mse": mse,
            "spread": [1e3 * one.mse.std() for one in tried],
            "r2": [one.r2.mean() for one in tried],
            "within": (np.abs(mse - printed) <= spread).tolist(),
            "thesis_mse": printed,
            "thesis_spread": spread,
        }
    found["reduction"] = [_reduction(rows, *s) for s in ((42, 40), (42, 42), (40, 40))]
    for words, column in (("new_n", 4), ("new_k", 3)):
        values = rows.inputs[:, column] if column == 4 else 10 ** rows.inputs[:, column]
        found[words] = [
            _scored(rows, Target.FORCE, *model, split=value_split(values)).pooled_r2
            for model in ((False, BOOSTING), (True, FOREST))
        ]
    return found | {"grid": _grid(rows)}


def _scored(
    rows: Learned,
    which: Target,
    descriptor: bool,
    learner: Learner,
    seed: int = _SEED,
    split: Split | None = None,
) -> Score:
    """Return the score of a model on the authors' folds, or on others."""
    y = rows.force if which is Target.FORCE else rows.work
    split = random_split(len(y), seed) if split is None else split
    return score(rows.features(descriptor=descriptor), y, learner, split, seed=seed)


def _reduction(rows: Learned, plain: int, augmented: int) -> float:
    """Return by how much the best model's error falls with the descriptor, by seeds of folds."""
    best = [
        min(
            float(np.mean(_scored(rows, Target.FORCE, descriptor, learner, seed).mse))
            for learner in (BOOSTING, FOREST)
        )
        for descriptor, seed in ((False, plain), (True, augmented))
    ]
    return 1 - best[1] / best[0]


def _grid(rows: Learned) -> dict[str, Any]:
    """Return the best boosting of the authors' grid and where it stops, as their script does."""
    import xgboost
    from sklearn.model_selection import train_test_split

    X = rows.features(descriptor=True)
    some, _, of_some, _ = train_test_split(X, rows.force, test_size=_TEST, random_state=_SEED)
    known, stop, y, of_stop = train_test_split(some, of_some, test_size=_STOP, random_state=_SEED)
    data, beside = xgboost.DMatrix(known, label=y), xgboost.DMatrix(stop, label=of_stop)
    tried = []
    for rate in _RATES:
        for depth in _DEPTHS:
            settings = {"eta": rate, "max_depth": depth, "seed": _SEED, "nthread": 1}
            best = xgboost.train(
                {"objective": "reg:squarederror", "eval_metric": "rmse", **settings},
                data,
                num_boost_round=_ROUNDS,
                evals=[(beside, "held")],
                early_stopping_rounds=_PATIENCE,
                verbose_eval=False,
            )
            tried.append((best.best_score, rate, depth, best.best_iteration))
    error, rate, depth, rounds = min(tried)
    return {"rmse": float(error), "eta": rate, "depth": depth, "rounds": int(rounds)}


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the errors of the four tables, here and printed."""
    for ax, target, some in zip(
        panels(figure, 1, 2), ("force", "work"), (("5.1", "5.2"), ("5.3", "5.4")), strict=True
    ):
        models = numbers[some[0]]["model"]
        for i, number in enumerate(some):
            of = numbers[number]
            # the tables have their models in different orders
            order = [of["model"].index(name) for name in models]
            x = np.arange(len(models)) + 0.15 * (2 * i - 1)
            style = {"color": COLOURS[i], "capsize": 3, "ls": "", "marker": "s", "mfc": "none"}
            printed = of["thesis_mse"][order], of["thesis_spread"][order]
            ax.errorbar(x, *printed, **style, label=f"Table {number}")
            label = f"here, on its {numbers['rows']:.0f} rows"
            ax.plot(x, of["mse"][order], "o", color=COLOURS[i], label=label)
        ax.set_xticks(np.arange(len(models)), [name.replace(" ", "\n") for name in models])
        ax.set_yscale("log")
        ax.set_ylabel(f"mean square error of the {target} [1e-3]")
        ax.legend()
