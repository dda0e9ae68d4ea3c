"""Models of chapter 5: errors on the shipped set and on the published rows."""

from itertools import product
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from viscotack import InputError

from ..archive import Learned, learned
from ..bench import Bench, Numbers
from ..learning.features import Target, features, inputs, target
from ..learning.learners import Learner
from ..learning.thesis import STATISTICS, STOPPED_AT, TABLES
from ..learning.validation import Score, Split, random_split, score, value_split
from .learned import FORCE_ML, FORCE_PAML, SEED, held_out, of_table, rows
from .style import COLOURS, decades, drawn_table, panels


def numbers_table_models(bench: Bench, name: str) -> Numbers:
    """Return error and R2 of each model over five random folds, and the printed ones."""
    return of_table(name.removeprefix("table-"), bench.each)


def draw_table_models(numbers: Numbers, figure: Figure) -> None:
    rows = [
        [
            name,
            f"{numbers['mse'][i]:.3g} ± {numbers['mse_spread'][i]:.2g}",
            f"{numbers['thesis_mse'][i]:.3g} ± {numbers['thesis_mse_spread'][i]:.2g}",
            f"{numbers['r2'][i]:.4f}",
            f"{numbers['thesis_r2'][i]:.4f}",
            f"{numbers['size'][i]:.0f}",
        ]
        for i, name in enumerate(numbers["model"])
    ]
    drawn_table(["", "MSE 1e-3", "thesis", "R2", "thesis", "size"], rows, figure)


TRIALS = {
    "A.4": {"Linear regression": (Target.FORCE, False, Learner.LINEAR), "XGBoost": FORCE_ML},
    "A.5": {
        "Forest": FORCE_PAML,
        "XGBoost": (Target.FORCE, True, Learner.BOOSTING),
    },
}
_POINTS = 800


def numbers_A_4(bench: Bench, name: str) -> Numbers:
    """Return log10 of the force of some rows, simulated and predicted, with R2 of all."""
    return {model: held_out(trial, _POINTS) for model, trial in TRIALS[name].items()}


def draw_A_4(numbers: Numbers, figure: Figure) -> None:
    for ax, (name, of) in zip(panels(figure, 1, 2), numbers.items(), strict=True):
        ax.plot(of["true"], of["predicted"], "o", ms=2, mfc="none", mew=0.5, color=COLOURS[0])
        ends = np.array([0, np.max(of["true"])])
        ax.plot(ends, ends, "k--", lw=0.8)
        ax.set(title=f"{name}: $R^2$ = {of['r2']:.4f}", xlabel="$\\log_{10}$ force, simulated")
    figure.axes[0].set_ylabel("$\\log_{10}$ force, predicted")


_WORDS = ("mean", "median", "st. dev.", "min", "max")


def numbers_table_A_1(bench: Bench) -> Numbers:
    """Return five statistics of five inputs, here and printed."""
    found: Numbers = {"rows": len(rows())}
    for name, v in zip(STATISTICS, inputs(rows()).T, strict=True):
        here = [v.mean(), np.median(v), v.std(ddof=1), v.min(), v.max()]
        found[name] = {"here": here, "thesis": list(STATISTICS[name])}
    return found


def draw_table_A_1(numbers: Numbers, figure: Figure) -> None:
    names = [name for name in numbers if name != "rows"]
    rows = [
        [word, *(f"{numbers[n]['here'][i]:.4g} / {numbers[n]['thesis'][i]:.4g}" for n in names)]
        for i, word in enumerate(_WORDS)
    ]
    drawn_table(["ours / thesis", *names], rows, figure)


RATES, DEPTHS = (0.02, 0.05, 0.1, 0.3), (4, 6, 8)
# A boosting stops when this many rounds have not helped the rows held out.
_PATIENCE, _MOST_ROUNDS, _HELD_OUT = 50, 2000, 0.15


def parted() -> Any:
    """Return features to learn from and held out, then the forces of both."""
    from sklearn.model_selection import train_test_split

    X, y = features(rows(), descriptor=True), target(rows(), Target.FORCE)
    return train_test_split(X, y, test_size=_HELD_OUT, random_state=SEED)


def numbers_A_8(bench: Bench) -> Numbers:
    """Return the error by round of the best of the grid, and when each cell stopped."""
    from xgboost import XGBRegressor

    train, held, y_train, y_held = parted()
    models = [
        XGBRegressor(
            learning_rate=rate,
            max_depth=depth,
            n_estimators=_MOST_ROUNDS,
            early_stopping_rounds=_PATIENCE,
            random_state=SEED,
            n_jobs=1,
        ).fit(train, y_train, eval_set=[(train, y_train), (held, y_held)], verbose=False)
        for rate, depth in product(RATES, DEPTHS)
    ]
    best = min(models, key=lambda model: model.best_score)
    learned, held_out = (best.evals_result()[f"validation_{i}"]["rmse"] for i in (0, 1))
    every = max(1, len(learned) // 200)
    return {
        "round": np.arange(1, len(learned) + 1, every),
        "learned": np.array(learned[::every]),
        "held_out": np.array(held_out[::every]),
        "stopped_at": best.best_iteration + 1,
        "thesis_rounds": STOPPED_AT,
    }


def draw_A_8(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["round"], numbers["learned"], ":", color=COLOURS[0], label="rows learned from")
    ax.plot(numbers["round"], numbers["held_out"], color=COLOURS[1], label="rows held out")
    ax.axvline(
        numbers["stopped_at"], color="0.5", lw=1, label=f"best here, {numbers['stopped_at']}"
    )
    ax.axvline(numbers["thesis_rounds"], color="k", ls="--", lw=1, label="thesis, 689")
    decades(ax)
    ax.set(xlabel="boosting round", ylabel=r"root mean square error of $\log_{10}$ force")
    ax.legend()


TREES = (1, 2, 5, 10, 20, 50, 100, 200)


def numbers_A_9(bench: Bench) -> Numbers:
    """Return the error by number of trees, on rows learned from and held out."""
    from sklearn.ensemble import RandomForestRegressor

    train, held, y_train, y_held = parted()
    forest = RandomForestRegressor(warm_start=True, random_state=SEED)
    errors = []
    for count in TREES:
        forest.set_params(n_estimators=count).fit(train, y_train)
        errors.append(
            [
                np.sqrt(np.mean((forest.predict(X) - y) ** 2))
                for X, y in ((train, y_train), (held, y_held))
            ]
        )
    learned, held_out = np.array(errors).T
    return {"trees": np.array(TREES), "learned": learned, "held_out": held_out}


def draw_A_9(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["trees"], numbers["learned"], "o:", color=COLOURS[0], label="rows learned from")
    ax.plot(numbers["trees"], numbers["held_out"], "o-", color=COLOURS[1], label="rows held out")
    decades(ax)
    ax.set(xlabel="trees", ylabel=r"root mean square error of $\log_{10}$ force")
    ax.legend()


# The authors' seeds, of folds and of models: their script of Table 5.2 has another.
_SEED, _OTHER_SEED = 42, 40
SEEDS = {"5.1": _SEED, "5.2": _OTHER_SEED, "5.3": _SEED, "5.4": _SEED}
# The authors' grid of boosting, and the shares of the rows that test and stop it.
_RATES, _DEPTHS, _ROUNDS, _NO_GAIN = (0.01, 0.05, 0.1), (3, 6, 9), 1000, 10
_TEST, _STOP = 0.20, 0.15


def numbers_published_rows(bench: Bench) -> Numbers:
    """Return the entries of the four tables beside the printed ones, and what they depend on."""
    if bench.archive is None:
        raise InputError("this needs the authors' archive: give its path by --archive")
    rows = learned(bench.archive)
    found: Numbers = {"rows": len(rows.force)}
    for number, table in TABLES.items():
        of, seed = (table.target, table.descriptor), SEEDS[number]
        tried = [_scored(rows, *of, Learner(name), seed) for name in table.entries]
        mse = np.array([1e3 * one.mse.mean() for one in tried])
        printed, spread = np.array([(e.mse, e.mse_spread) for e in table.entries.values()]).T
        found[number] = {
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
            for model in ((False, Learner.BOOSTING), (True, Learner.FOREST))
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
            for learner in (Learner.BOOSTING, Learner.FOREST)
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
    for rate, depth in product(_RATES, _DEPTHS):
        settings = {"eta": rate, "max_depth": depth, "seed": _SEED, "nthread": 1}
        best = xgboost.train(
            {"objective": "reg:squarederror", "eval_metric": "rmse", **settings},
            data,
            num_boost_round=_ROUNDS,
            evals=[(beside, "held")],
            early_stopping_rounds=_NO_GAIN,
            verbose_eval=False,
        )
        tried.append((best.best_score, rate, depth, best.best_iteration))
    error, rate, depth, rounds = min(tried)
    return {"rmse": float(error), "eta": rate, "depth": depth, "rounds": int(rounds)}


def draw_published_rows(numbers: Numbers, figure: Figure) -> None:
    for ax, what, some in zip(
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
        ax.set(yscale="log", ylabel=f"mean square error of the {what} [1e-3]")
        ax.legend()
