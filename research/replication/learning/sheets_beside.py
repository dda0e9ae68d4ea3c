"""Tables of settings, extrapolation and insight: what stands beside the thesis's own."""

from collections.abc import Sequence
from typing import Any

from .sheet import Sheet

Part = dict[str, Any]


def rows_sheet(numbers: Part) -> Sheet:
    """Return the error at the rows of this table and at those of the thesis."""
    return Sheet(
        "rows",
        "Learning curves by rows, carried to the rows of the thesis",
        "A power law through the MSE [1e-3] of the force; what more rows would give, other "
        "things being equal.",
        ("model", "descriptor", "rows", "MSE", "exponent", "thesis rows", "MSE there"),
        tuple(
            (
                *(p["model"], p["descriptor"], p["training_rows"][-1], p["mse_1e-3"][-1]),
                *(p["exponent"], p["thesis_training_rows"], p["mse_1e-3_at_thesis_rows"]),
            )
            for p in numbers["rows"]
        ),
    )


def grid_sheet(numbers: Part) -> Sheet:
    """Return the grid search of appendix X."""
    keys = ("learning_rate", "depth", "rounds", "mse_1e-3")
    return Sheet(
        "grid",
        "Grid search of XGBoost with early stopping, 15 % of the rows held out",
        f"The thesis stopped at round {numbers['grid'][0]['thesis_rounds']} (appendix X).",
        ("descriptor", "learning rate", "depth", "rounds", "MSE [1e-3]"),
        tuple((p["descriptor"], *(c[k] for k in keys)) for p in numbers["grid"] for c in p["grid"]),
    )


def architectures_sheet(parts: Sequence[Part], name: str, words: str) -> Sheet:
    """Return the error by layers and activation, for a target in words."""
    return Sheet(
        name,
        f"Layers and activation of the network (Fig. 5.12), for {words}",
        "Mean square error of standardised targets over three folds.",
        ("layers", "activation", "MSE", "+-"),
        tuple(
            ("-".join(map(str, p["layers"])), p["activation"], p["mse"], p["mse_spread"])
            for p in parts
        ),
    )


def extrapolation_sheet(numbers: Part) -> Sheet:
    """Return how far models go off theory and simulation beyond the rows."""
    rows = []
    for case in numbers["extrapolation"]["cases"]:
        of = (case["modulus_ratio"], case["exponent"], case["training_rows_like_it"])
        off = case["theory_off_simulation"]
        rows.append(
            (*of, "Persson-Brener, Eq. 4.24", None, 0.0, None if off is None else 100 * off)
        )
        for m in case["models"]:
            distances = [m["off_theory"], m["off_simulation"]]
            percent = [None if d is None else 100 * d for d in distances]
            rows.append((*of, m["model"], m["descriptor"], *percent))
    return Sheet(
        "extrapolation",
        "Beyond the rows (Fig. 5.5): mu = 3.24, preload 73 h0",
        "Root mean square distance [%] over the rates, from the analytic curve and from "
        "simulations of this package. Rows like it: tabor above 2.9, preload above 51, same solid.",
        ("k", "n", "rows like it", "model", "descriptor", "off theory", "off simulation"),
        tuple(rows),
    )


def importance_sheet(numbers: Part) -> Sheet:
    """Return the importance of each column."""
    return Sheet(
        "importance",
        "Permutation importance: fall of R2 of the force when a column is shuffled",
        "Of held-out rows. Rate, solid and descriptor belong together, so that shuffling one "
        "also asks of rows that cannot be.",
        ("model", "descriptor", "column", "fall of R2", "+-"),
        tuple(
            (p["model"], p["descriptor"], name, f["importance"], f["importance_spread"])
            for p in numbers["insight"]
            for name, f in p["features"].items()
        ),
    )


def statistics_sheet(numbers: Part) -> Sheet:
    """Return Table A.1."""
    words = ("mean", "median", "deviation", "least", "greatest")
    return Sheet(
        "table_A_1",
        "Table A.1: the columns",
        f"{numbers['data']['rows']} rows here, {numbers['data']['rows_thesis']} in the thesis.",
        ("column", *words, *(f"{w}, thesis" for w in words)),
        tuple(
            (name, *part["here"], *(part["thesis"] or (None,) * len(words)))
            for name, part in numbers["data"]["statistics"].items()
        ),
    )


def trajectories_sheet(part: Part) -> Sheet:
    """Return how well the six points of a retraction are met."""
    counts = part["rows"]
    return Sheet(
        "trajectories",
        "Six points of the retraction at once (section 5.5)",
        f"{counts['learned from']} rows learned from or deciding when to stop, {counts['judged']} "
        "judged. Median error over the travel, and over the greatest force of the points.",
        ("point", "R2", "R2, a new (mu, k, n)", "median error [%]"),
        tuple(
            (p["point"], p["r2"], p["r2_new_mu_k_n"], 100 * p["median_error"])
            for p in part["points"]
        ),
    )
