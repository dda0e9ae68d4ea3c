"""Pictures of the study: simulations are open markers, theory a dashed line, models lines."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Part = dict[str, Any]

_FORCE, _RATE = "pull-off force / (1.5 pi R dg0)", "rate tau0/h0"
_COLOURS = ("C0", "C1", "C2", "C3", "C4", "C5", "C6", "C7")


def figures(numbers: Part) -> dict[str, "Figure"]:
    """Return the pictures by name of file, without its ending."""
    drawn: dict[str, Callable[[Part], Figure]] = {
        "splits": _splits,
        "modulus_ratios": _modulus_ratios,
        "predicted": _predicted,
        "bands": _bands,
        "learning": _learning,
        "architectures": _architectures,
        "extrapolation": _extrapolation,
        "importance": _importance,
        "dependence": _dependence,
    }
    if "absent" not in numbers["trajectories"]:
        drawn["trajectories"] = _trajectories
    return {name: draw(numbers) for name, draw in drawn.items()}


def _figure(rows: int, columns: int, *, width: float = 4.6, height: float = 3.6) -> Any:
    from matplotlib.figure import Figure

    figure = Figure(layout="constrained", figsize=(width * columns, height * rows))
    return figure, figure.subplots(rows, columns, squeeze=False)


def _splits(numbers: Part) -> "Figure":
    """Draw the error of each model by how new to it the rows are."""
    entries = numbers["tables"]["entries"]
    figure, axes = _figure(1, 2, width=6.5, height=4.2)
    for ax, which in zip(axes[0], ("force", "work"), strict=True):
        models = list(dict.fromkeys(e["model"] for e in entries))
        for e in entries:
            style = {"none": ":", "as published": "-"}.get(e["descriptor"])
            if e["target"] == which and style:
                names = [name.removeprefix("a ") for name in e["splits"]]
                errors = [100 * s["typical_error"] for s in e["splits"].values()]
                label = e["model"] if style == "-" else None
                colour = _COLOURS[models.index(e["model"])]
                ax.plot(names, errors, style, color=colour, marker="o", ms=3, label=label)
        floor = numbers["noise"][which]["floor_mse_1e-3"]
        if floor is not None:
            error = 100 * (10 ** (1e-3 * floor) ** 0.5 - 1)
            ax.axhline(error, color="k", lw=0.8, label="repeated inputs")
        ax.set_yscale("log")
        ax.set_ylabel(f"typical error of the {which} [%]")
        ax.tick_params(axis="x", rotation=30)
    figure.legend(
        *axes[0, 0].get_legend_handles_labels(),
        title="solid: with the descriptor",
        fontsize="small",
        loc="outside right",
    )
    return figure


def _modulus_ratios(numbers: Part) -> "Figure":
    """Draw the error on each modulus ratio when it is new to the model."""
    figure, axes = _figure(1, 1, width=8.5, height=4.2)
    ax = axes[0, 0]
    for e in numbers["tables"]["entries"]:
        split = e["splits"].get("a new k")
        if (
            split
            and e["target"] == "force"
            and e["model"] in ("XGBoost", "Random Forest", "Network")
        ):
            colour = {"XGBoost": "C0", "Random Forest": "C1", "Network": "C2"}[e["model"]]
            style = {"none": ":", "as published": "-", "own Tabor number": "--"}[e["descriptor"]]
            groups = split["groups"]
            ax.plot(
                [f"{g['held_out']}\n{g['rows']} rows" for g in groups],
                [100 * g["typical_error"] for g in groups],
                style,
                color=colour,
                label=f"{e['model']}, descriptor {e['descriptor']}",
            )
    ax.set_yscale("log")
    ax.set_xlabel("modulus ratio that is held out")
    ax.set_ylabel("typical error of the force [%]")
    figure.legend(fontsize="x-small", loc="outside right")
    return figure


def _predicted(numbers: Part) -> "Figure":
    """Draw predicted against true, as Fig. A.4 and A.5 of the thesis, on rows not learned."""
    parts = numbers["predicted"]
    figure, axes = _figure(1, len(parts), width=3.4, height=3.4)
    for ax, part in zip(axes[0], parts, strict=True):
        ax.plot(part["true"], part["predicted"], "o", ms=2, mfc="none", mew=0.4)
        ends = [min(part["true"]), max(part["true"])]
        ax.plot(ends, ends, "k--", lw=0.8)
        ax.set_title(f"{part['model']}, descriptor {part['descriptor']}", fontsize="small")
        ax.set_xlabel("log10 force, simulated")
    axes[0, 0].set_ylabel("log10 force, predicted")
    return figure


def _bands(numbers: Part) -> "Figure":
    """Draw the error of each band held out."""
    entries = [e for e in numbers["bands"]["entries"] if e["target"] == "force"]
    names = list(dict.fromkeys(e["split"] for e in entries))
    figure, axes = _figure(1, max(1, len(names)), height=3.8)
    for ax, name in zip(axes[0], names, strict=False):
        for e in entries:
            if e["split"] == name:
                errors = [100 * x for x in e["typical_error"]]
                ax.plot(e["bands"], errors, "o-", label=f"descriptor {e['descriptor']}")
        ax.set_yscale("log")
        ax.set_xlabel(name)
        ax.tick_params(axis="x", rotation=60, labelsize="x-small")
    axes[0, 0].set_ylabel("typical error of the force, XGBoost [%]")
    if names:
        axes[0, 0].legend(fontsize="small")
    return figure


def _learning(numbers: Part) -> "Figure":
    """Draw learning curves: rounds (Fig. A.8), trees (Fig. A.9), rows."""
    figure, axes = _figure(1, 3)
    for i, part in enumerate(numbers["grid"]):
        best = part["best"]
        axes[0, 0].plot(best["round"], best["rmse_trained"], ":", color=_COLOURS[i])
        label = f"descriptor {part['descriptor']}"
        axes[0, 0].plot(best["round"], best["rmse_held_out"], color=_COLOURS[i], label=label)
    axes[0, 0].set_xlabel("rounds of XGBoost (dotted: learned rows)")
    for i, part in enumerate(numbers["forest"]):
        axes[0, 1].plot(part["trees"], part["rmse_trained"], ":", color=_COLOURS[i])
        label = f"descriptor {part['descriptor']}"
        axes[0, 1].plot(part["trees"], part["rmse_held_out"], color=_COLOURS[i], label=label)
    axes[0, 1].set_xlabel("trees of the forest (dotted: learned rows)")
    for ax in axes[0, :2]:
        ax.set_ylabel("root mean square error of log10 force")
    for i, part in enumerate(numbers["rows"]):
        style = "o:" if part["descriptor"] == "none" else "o-"
        label = f"{part['model']}, descriptor {part['descriptor']}"
        colour = _COLOURS[i // 2]
        axes[0, 2].plot(part["training_rows"], part["mse_1e-3"], style, color=colour, label=label)
    axes[0, 2].set_xlabel("rows learned from")
    axes[0, 2].set_ylabel("mean square error of log10 force [1e-3]")
    for ax in axes[0]:
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.legend(fontsize="x-small")
    return figure


def _architectures(numbers: Part) -> "Figure":
    """Draw the error by layers and activation (Fig. 5.12)."""
    of = {"log10 force": numbers["architectures"]}
    if "absent" not in numbers["trajectories"]:
        of["six points of the trajectory"] = numbers["trajectories"]["architectures"]
    figure, axes = _figure(1, len(of), width=6.0)
    for ax, (title, parts) in zip(axes[0], of.items(), strict=True):
        for activation in dict.fromkeys(p["activation"] for p in parts):
            some = [p for p in parts if p["activation"] == activation]
            ax.errorbar(
                ["-".join(map(str, p["layers"])) for p in some],
                [p["mse"] for p in some],
                [p["mse_spread"] for p in some],
                fmt="o-",
                capsize=3,
                label=activation,
            )
        ax.set_yscale("log")
        ax.set_title(title)
        ax.set_ylabel("mean square error, standardised")
        ax.legend()
    return figure


def _extrapolation(numbers: Part) -> "Figure":
    """Draw force against rate beyond the rows (Fig. 5.5)."""
    cases = numbers["extrapolation"]["cases"]
    columns = 4
    figure, axes = _figure(-(-len(cases) // columns), columns, width=4.2)
    for ax in axes.flat[len(cases) :]:
        ax.set_axis_off()
    for ax, case in zip(axes.flat, cases, strict=False):
        for i, model in enumerate(case["models"]):
            label = f"{model['model']}, descriptor {model['descriptor']}"
            ax.plot(case["rate"], model["force"], color=_COLOURS[i], label=label)
        ax.plot(case["rate"], case["theory"], "k--", label="Persson-Brener, Eq. 4.24")
        pairs = zip(case["simulated_rate"], case["simulated_force"], strict=True)
        known = [(r, f) for r, f in pairs if f is not None]
        if known:
            ax.plot(*zip(*known, strict=True), "o", mfc="none", mec="k", label="simulated")
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.set_xlabel(_RATE)
        ax.set_title(
            f"k = {case['modulus_ratio']}, n = {case['exponent']}: "
            f"{case['training_rows_like_it']} rows like it",
            fontsize="small",
        )
    axes[0, 0].set_ylabel(_FORCE)
    axes.flat[0].legend(fontsize="xx-small")
    return figure


def _importance(numbers: Part) -> "Figure":
    """Draw the fall of R2 when a column is shuffled."""
    parts = numbers["insight"]
    figure, axes = _figure(1, len(parts), height=3.0, width=4.2)
    for ax, part in zip(axes[0], parts, strict=True):
        names = list(part["features"])
        of = part["features"].values()
        ax.barh(names, [f["importance"] for f in of], xerr=[f["importance_spread"] for f in of])
        ax.set_title(f"{part['model']}, descriptor {part['descriptor']}", fontsize="small")
        ax.set_xlabel("fall of R2 when shuffled")
    return figure


def _dependence(numbers: Part) -> "Figure":
    """Draw the mean prediction along each feature."""
    parts = numbers["insight"]
    names = list(dict.fromkeys(name for part in parts for name in part["features"]))
    figure, axes = _figure(2, -(-len(names) // 2), height=3.2, width=4.0)
    for ax, name in zip(axes.flat, names, strict=False):
        for part in parts:
            of = part["features"].get(name)
            if of:
                style = ":" if part["descriptor"] == "none" else "-"
                label = f"{part['model']}, descriptor {part['descriptor']}"
                colour = "C1" if part["model"] == "Random Forest" else "C2"
                ax.plot(of["value"], of["answer"], style, color=colour, label=label)
        ax.set_xlabel(name)
    for ax in axes[:, 0]:
        ax.set_ylabel("mean log10 force")
    axes[0, 0].legend(fontsize="x-small")
    return figure


def _trajectories(numbers: Part) -> "Figure":
    """Draw key points of retractions that were not learned (Fig. 5.13)."""
    from .trajectories import SHARES

    shown = numbers["trajectories"]["shown"]
    figure, axes = _figure(2, -(-len(shown) // 2), height=3.2, width=4.2)
    for ax, one in zip(axes.flat, shown, strict=False):
        for key, style in (("true", "ko"), ("predicted", "C2x-")):
            travel, *force = one[key]
            depth = [one["preload"] - share * travel for share in SHARES[1:]]
            ax.plot(depth, force, style, mfc="none", label=key)
        ax.invert_xaxis()
        words = ("tabor", "modulus_ratio", "exponent", "preload", "rate")
        ax.set_title(", ".join(f"{one[w]:.3g}" for w in words), fontsize="small")
        ax.set_xlabel("depth / h0")
    axes[0, 0].set_ylabel("force / (1.5 pi R dg0)")
    axes[0, 0].legend(title="mu, k, n, preload, rate above", fontsize="x-small")
    return figure
