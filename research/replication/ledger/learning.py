"""Claims of chapter 5 and appendices VI, VII and X: figures of simulation, and what was learned."""

import numpy as np

from viscotack import datasets

from ..figures.cases import K
from ..figures.forces import distance
from ..learning.thesis import LOGGED_TIME
from ..table import SAMPLE, read_detachments
from .claim import Measured, Of, listed

# What the workers spent on the shipped set (docs/datasets.md).
_WORKERS_SECONDS = 1436.0


def tables(of: Of) -> Measured:
    parts = [of("published-rows")[number] for number in ("5.1", "5.2", "5.3", "5.4")]
    found = sum(bool(w) for part in parts for w in part["within"])
    alike = sum(
        abs(mse - printed) < 1e-4 * printed
        for part in parts
        for mse, printed in zip(part["mse"], part["thesis_mse"], strict=True)
    )
    return Measured(
        float(found), f"{found} of 16 within the printed spread, {alike} of them to four digits"
    )


def row_count(of: Of) -> Measured:
    count = of("published-rows")["rows"]
    return Measured(float(count), f"{count:,.0f} rows, on which all linear entries are met")


def time(of: Of) -> Measured:
    return Measured(LOGGED_TIME, f"{LOGGED_TIME:g} s in the authors' log")


def reduction(of: Of) -> Measured:
    n = of("published-rows")["reduction"]
    return Measured(
        float(n[0]),
        f"{100 * n[0]:.1f} %; with the folds of one seed in both tables {100 * n[1]:.1f} or "
        f"{100 * n[2]:.1f} %",
    )


def reduction_here(of: Of) -> Measured:
    plain, augmented = of("table-5.1"), of("table-5.2")
    best = 1 - float(np.min(augmented["mse"])) / float(np.min(plain["mse"]))
    return Measured(
        best,
        f"{100 * best:.0f} % (errors {np.min(plain['mse']):.3f} and "
        f"{np.min(augmented['mse']):.3f})",
    )


def random_r2(of: Of) -> Measured:
    n = of("published-rows")["5.2"]
    r2 = float(n["r2"][n["model"].index("Random Forest")])
    return Measured(r2, f"{r2:.4f} of the forest with the descriptor")


def new_n(of: Of) -> Measured:
    plain, augmented = of("published-rows")["new_n"]
    return Measured(
        float(augmented), f"{augmented:.4f} with the descriptor, {plain:.4f} without (XGBoost)"
    )


def trend(of: Of) -> Measured:
    logs = [np.log(each["paml"] / each["theory"]) for each in of("5.5")["trend"]]
    first, *_, last = (100 * (np.exp(np.max(np.abs(off))) - 1) for off in logs)
    forces = [np.concatenate([x[w] for x in of("5.5")["trend"]]) for w in ("paml", "theory")]
    order = float(np.corrcoef(np.log(forces))[0, 1])
    return Measured(
        order,
        f"correlation {order:.3f} of the logarithms over all rates; off by {first:.0f} % at most "
        f"at k = 0.5 and {last:.0f} % at k = 0.02",
    )


def new_k(of: Of) -> Measured:
    plain, augmented = of("published-rows")["new_k"]
    return Measured(
        float(augmented), f"{augmented:.2f} with the descriptor, {plain:.2f} without (XGBoost)"
    )


def best_model(of: Of) -> Measured:
    n = of("table-5.2")
    i = int(np.argmin(n["mse"]))
    return Measured(float(n["r2"][i]), f"{n['model'][i]}, R2 {n['r2'][i]:.4f}")


def work_gain(of: Of) -> Measured:
    plain, augmented = of("table-5.3"), of("table-5.4")
    gain = 1 - augmented["mse"] / plain["mse"]
    return Measured(float(np.min(gain)), listed("{:.0f} % ({})", 100 * gain, plain["model"]))


def best_of_work(of: Of) -> Measured:
    n, theirs = of("table-5.4"), of("published-rows")["5.4"]
    ratio = [
        float(t["mse"][t["model"].index("Random Forest")] / t["mse"][t["model"].index("XGBoost")])
        for t in (n, theirs)
    ]
    return Measured(
        ratio[0],
        f"its error is {ratio[0]:.2f} of that of XGBoost on the shipped set, {ratio[1]:.2f} on the "
        "authors' rows",
    )


def beyond(of: Of) -> Measured:
    n = of("5.5")
    ml, paml = (distance(n, "0.2", f"{name}_at_points") for name in ("ml", "paml"))
    law = distance(n, "0.2", "theory_at_points")
    return Measured(
        paml / ml,
        f"{100 * paml:.1f} % with, {100 * ml:.1f} % without it; the law alone {100 * law:.1f} % "
        "(n = 0.2)",
    )


def depths(of: Of) -> Measured:
    n = of("5.6")
    words, worst = [], 0.0
    for name, part in n.items():
        paml = max(distance(part, e, "paml_at_points") for e in ("0.2", "0.6", "1.6"))
        law = max(distance(part, e, "theory_at_points") for e in ("0.2", "0.6", "1.6"))
        worst = max(worst, paml)
        words.append(f"{name.split(', ')[1]} h0: {100 * paml:.0f} / {100 * law:.0f} %")
    return Measured(worst, "PA-ML / law off simulation: " + "; ".join(words))


def less(of: Of) -> Measured:
    tops = [float(np.max(part["1.6"]["simulated"])) for part in of("5.6").values()]
    words = f"{listed('{:.2f}', tops)} from 60, 30, 15, 7.5 h0"
    return Measured(tops[-1] / tops[0], words)


def transition(of: Of) -> Measured:
    n = of("5.7")
    jkr, dmt = (float(n[name]["1.6"]["simulated"][-1]) for name in ("2.56, 75", "0.16, 75"))
    return Measured(
        K * dmt, f"k P/P_JKR = {K * jkr:.3f} at μ = 2.56, {K * dmt:.3f} at 0.16, from 75 h0"
    )


def above_jkr(of: Of) -> Measured:
    n = of("5.7")["2.56, 75"]["1.6"]
    top = float(np.max(n["simulated"]))
    return Measured(
        K * top,
        f"{K * top:.3f} ± {100 * float(np.max(n['error'])):.1g} % from 75 h0, 1.07 from 300 h0 "
        "(`fast-limit`)",
    )


def reversal(of: Of) -> Measured:
    n = of("5.8")
    least, most = n["simulated"][0, 0], n["simulated"][0, -1]
    x = np.log(n["depth"])
    sign = np.flatnonzero(np.diff(np.sign(most - least)))
    i = int(sign[0])
    gap = (most - least)[i : i + 2]
    at = float(np.exp(x[i] + (x[i + 1] - x[i]) * gap[0] / (gap[0] - gap[1])))
    return Measured(at, f"μ = 3.2 and 0.05 cross at {at:.1f} h0 (rate 1e8)")


def plateau(of: Of) -> Measured:
    n = of("5.8")
    deep = n["depth"] > 30
    forces = n["simulated"][1][:, deep]
    law = float(n["theory"][1])
    return Measured(
        float(np.ptp(forces) / law),
        f"{np.min(forces):.2f} to {np.max(forces):.2f} beyond 30 h0, falling with depth; law "
        f"{law:.2f}",
    )


def slow_depth(of: Of) -> Measured:
    n = of("5.8")
    forces = n["simulated"][2]
    deep = n["depth"] > 3
    return Measured(
        float(np.max(forces) / np.min(forces)),
        f"{np.min(forces):.2f} to {np.max(forces):.2f} over all depths; "
        f"{np.min(forces[:, deep]):.2f} to {np.max(forces[:, deep]):.2f} beyond 3 h0; law "
        f"{float(n['theory'][2]):.2f}",
    )


def caption(of: Of) -> Measured:
    n = of("5.8")
    top = K * float(n["theory"][0])
    return Measured(
        top, f"the law is at {top:.3f} of 1/k at 1e8: the two rates differ by less than that"
    )


def work_bell(of: Of) -> Measured:
    n = of("5.9")
    words, ratios = [], []
    for e in ("0.4", "0.6", "1.6"):
        w = n[e]["simulated"]
        ratios.append(float(np.max(w) / w[-1]))
        words.append(f"{w[0]:.1f} / {np.max(w):.1f} / {w[-1]:.1f} (n = {e})")
    return Measured(min(ratios), "slow / largest / fast: " + "; ".join(words))


def interaction(of: Of) -> Measured:
    n = of("5.9")
    low, high = 2, 11
    at = [[float(n[e]["simulated"][i]) for e in ("0.4", "0.6", "1.6")] for i in (low, high)]
    rates = [float(n["simulated_rate"][i]) for i in (low, high)]
    words = "; ".join(
        f"{listed('{:.1f}', row)} at {r:.2g}" for row, r in zip(at, rates, strict=True)
    )
    holds = at[0][0] < at[0][1] < at[0][2] and at[1][0] > at[1][1] > at[1][2]
    return Measured(float(holds), f"{words} for n = 0.4, 0.6, 1.6")


def tabor_work(of: Of) -> Measured:
    n = of("5.10")
    least = min(
        float(np.min(n[e]["simulated"][1:] / n[e]["simulated"][:-1])) for e in ("1.6", "0.6")
    )
    return Measured(
        least, f"at least {least:.2f} times per step of μ (0.05, 0.2, 0.8, 3.2), 11 rates"
    )


def layout(of: Of) -> Measured:
    n = of("5.12")
    i, j = np.unravel_index(int(np.argmin(n["mse"])), n["mse"].shape)
    return Measured(
        float(i == len(n["layers"]) - 1 and j == 0),
        f"{n['layers'][i]}, {n['activation'][j]}: {n['mse'][i, j]:.4f}",
    )


def trajectories(of: Of) -> Measured:
    n = of("5.13")
    travel, force = [], []
    for points, part in zip(n["points"], n["curves"], strict=True):
        true = part["points"]
        travel.append(abs(points[0] / true[0] - 1))
        force.append(np.max(np.abs(points[1:] - true[1:])) / np.max(np.abs(true[1:])))
    return Measured(
        float(np.median(force)),
        f"forces within {100 * np.median(force):.0f} % of the greatest (median; worst "
        f"{100 * np.max(force):.0f} %), travel within {100 * np.median(travel):.0f} % "
        f"({100 * np.max(travel):.0f} %)",
    )


def boosting(of: Of) -> Measured:
    n, grid = of("A.8"), of("published-rows")["grid"]
    last = float(n["held_out"][-1] / np.min(n["held_out"]))
    return Measured(
        float(grid["rounds"]),
        f"best of the authors' grid: {grid['rounds']:.0f} rounds (rate {grid['eta']:g}, depth "
        f"{grid['depth']:.0f}); it levels off ({last:.3f} of its least at the end)",
    )


def forest(of: Of) -> Measured:
    n = of("A.9")
    after = float(n["held_out"][-1] / n["held_out"][4])
    return Measured(after, f"{after:.2f} of the error of 20 trees at 200")


def statistics(of: Of) -> Measured:
    n = of("table-A.1")
    off = max(
        abs(part["here"][0] - part["thesis"][0]) / part["thesis"][2]
        for name, part in n.items()
        if name != "rows"
    )
    return Measured(float(off), f"means of the shipped set within {off:.3f} standard deviations")


def range_of_rates(of: Of) -> Measured:
    rows = read_detachments(SAMPLE)
    top = float(np.log10(np.max(rows.rate)))
    return Measured(
        top, f"log10 of the largest rate of 1,200 published rows {top:.1f}; Table A.1 has 10"
    )


def range_of_depths(of: Of) -> Measured:
    return Measured(10**2.738, f"Table A.1 has 10^2.738 = {10**2.738:.0f}")


def seconds(of: Of) -> Measured:
    count = datasets.load("thesis").num_rows
    each = _WORKERS_SECONDS / count
    return Measured(each, f"{each:.2f} s a case, 24 min for {count:,}, with stated errors")


def impossible(of: Of) -> Measured:
    n = of("limits")
    return Measured(
        float(n["broad_force"]),
        f"{n['broad_force']:.3f} ± {100 * n['broad_error']:.1g} % JKR forces at rate 100, in a "
        "second",
    )
