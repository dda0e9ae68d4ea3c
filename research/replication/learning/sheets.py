"""The numbers of the study as tables to read, those of the thesis first."""

from typing import Any

from .sheet import Sheet
from .sheets_beside import (
    architectures_sheet,
    extrapolation_sheet,
    grid_sheet,
    importance_sheet,
    rows_sheet,
    statistics_sheet,
    trajectories_sheet,
)
from .study import Study

Part = dict[str, Any]


def sheets(study: Study) -> list[Sheet]:
    """Return every table of a study, in the order of reading."""
    numbers = study.numbers
    made = [*_tables(study), _reductions(numbers), _repeated(numbers), _groups(numbers)]
    made += [_bands(numbers), _noise(numbers), rows_sheet(numbers), grid_sheet(numbers)]
    made += [architectures_sheet(numbers["architectures"], "architectures", "log10 force")]
    made += [extrapolation_sheet(numbers), importance_sheet(numbers), statistics_sheet(numbers)]
    if "absent" not in numbers["trajectories"]:
        made.append(trajectories_sheet(numbers["trajectories"]))
        made.append(
            architectures_sheet(
                numbers["trajectories"]["architectures"],
                "architectures_trajectories",
                "the six points of the trajectory",
            )
        )
    return made


_WORDS = {"force": "effective surface energy (pull-off force)", "work": "work to pull-off"}


def _tables(study: Study) -> list[Sheet]:
    entries = study.numbers["tables"]["entries"]
    found = []
    for which, descriptor in dict.fromkeys((e["target"], e["descriptor"]) for e in entries):
        some = [e for e in entries if (e["target"], e["descriptor"]) == (which, descriptor)]
        number, splits = some[0]["table"], list(some[0]["splits"])
        title = f"{_WORDS[which].capitalize()}, descriptor: {descriptor}"
        rows = []
        for e in some:
            thesis = e["thesis"] or {}
            time = study.times[f"{which} / {descriptor} / {e['model']}"]
            within = [thesis.get(key) for key in ("mse_within_spread", "r2_within_spread")]
            rows.append(
                (
                    e["model"],
                    *(e[key] for key in ("mse_1e-3", "mse_spread_1e-3")),
                    *(thesis.get(key) for key in ("mse_1e-3", "mse_spread_1e-3")),
                    *(e[key] for key in ("r2", "r2_spread")),
                    *(thesis.get(key) for key in ("r2", "r2_spread")),
                    None if None in within else "yes" if all(within) else "no",
                    e["size"],
                    thesis.get("size"),
                    time,
                    thesis.get("train_time_s"),
                    *(s["r2"] for s in e["splits"].values()),
                )
            )
        name = f"table_{number.replace('.', '_')}" if number else f"{which}_own_tabor"
        found.append(
            Sheet(
                name,
                f"Table {number}: {title}" if number else title,
                "Five folds of random rows, all rows, as the thesis; MSE in 1e-3 of log10. To the "
                "right R2 of all held-out rows together when each fold holds out something new, "
                "without the rows whose work is a placeholder.",
                (
                    *("model", "MSE", "+-", "MSE thesis", "+-"),
                    *("R2", "+-", "R2 thesis", "+-", "within its spread"),
                    *("size", "size thesis", "fit [s]", "fit thesis [s]"),
                    *(f"R2, {split}" for split in splits),
                ),
                tuple(rows),
            )
        )
    return found


def _reductions(numbers: Part) -> Sheet:
    part = numbers["tables"]["reductions"]
    models = list(part[0]["by_model"])
    return Sheet(
        "reductions",
        "How far the descriptor lowers the mean square error",
        f"The thesis reports {100 * numbers['tables']['reduction_published']:.1f} % for the force: "
        "best of Table 5.2 over best of Table 5.1, two different models. In per cent; negative "
        "where it raises the error.",
        ("target", "descriptor", "held out", "rows", "best over best", "with the network", *models),
        tuple(
            (
                *(r[key] for key in ("target", "descriptor", "split", "rows")),
                100 * r["best_over_best"],
                100 * r["best_over_best_with_network"],
                *(100 * r["by_model"][m] for m in models),
            )
            for r in part
        ),
    )


def _repeated(numbers: Part) -> Sheet:
    part = numbers["repeated"]
    falls = [100 * x for x in part["reduction_best_over_best"]]
    return Sheet(
        "repeated",
        f"The same five folds drawn {part['draws']} times: force",
        "Fall of the error by the descriptor, best over best of tree, boosting and forest: "
        f"{min(falls):.1f} to {max(falls):.1f} %. MSE in 1e-3.",
        ("descriptor / model", "mean MSE", "least", "greatest"),
        tuple(
            (name, *(e[key] for key in ("mean", "least", "greatest")))
            for name, e in part["mse_1e-3"].items()
        ),
    )


def _groups(numbers: Part) -> Sheet:
    rows = []
    for e in numbers["tables"]["entries"]:
        for split in ("a new k", "a new n", "a new mu"):
            for g in e["splits"].get(split, {"groups": []})["groups"]:
                of = (e["target"], e["descriptor"], e["model"], split.removeprefix("a new "))
                rows.append((*of, g["held_out"], g["rows"], g["r2"], 100 * g["typical_error"]))
    return Sheet(
        "groups",
        "What is new to the model, value by value",
        "R2 about the mean of the value's own rows, where there are 20 or more; typical error in "
        "per cent of the quantity.",
        ("target", "descriptor", "model", "input", "value", "rows", "R2", "typical error [%]"),
        tuple(rows),
    )


def _bands(numbers: Part) -> Sheet:
    return Sheet(
        "bands",
        "XGBoost when a band of one input is held out",
        "Bands of equal numbers of rows, eight where values allow; the edges are the first and "
        "the last, where the model extrapolates. R2 of rows together.",
        ("target", "descriptor", "held out", "bands", "R2 inner", "R2 edges", "worst error [%]"),
        tuple(
            (
                *(e[key] for key in ("target", "descriptor", "split")),
                len(e["bands"]),
                *(e[key] for key in ("inner_r2", "edge_r2")),
                100 * max(e["typical_error"]),
            )
            for e in numbers["bands"]["entries"]
        ),
    )


def _noise(numbers: Part) -> Sheet:
    part = numbers["noise"]
    columns = tuple(part["force"])
    return Sheet(
        "noise",
        "Label noise: rows with the same five inputs",
        "floor_mse_1e-3 is the variance of log10 among them: with an MSE below it on random rows a "
        "model is as good as the labels let one see. It sees only what differs when an input is "
        "repeated; an error that repeats with it is not in it.",
        ("target", *columns),
        tuple((which, *(part[which][c] for c in columns)) for which in part),
    )
