"""The pictures of the published table beside the simulation."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

# Differences in percent.
_TICKS = (-10, -2, -0.5, 0, 0.5, 2, 10)


def draw(rows: Sequence[dict[str, Any]], folder: Path) -> None:
    """Write both pictures into a folder."""
    import matplotlib.pyplot as plt

    force = np.array([row["force_difference"] for row in rows])
    work = np.array([row["work_difference"] for row in rows])
    exponent, tabor = (np.array([row[name] for row in rows]) for name in ("exponent", "tabor"))
    rate = np.array([row["rate"] for row in rows])
    with plt.style.context("viscotack.plot.viscotack"):
        figure, axes = plt.subplots(1, 2, figsize=(8, 3), sharey=True)
        for axis, values, words in zip(axes, (force, work), ("force", "work"), strict=True):
            sizes = np.abs(values[np.isfinite(values)])
            for chosen, label in ((exponent <= 0.3, "n ≤ 0.3"), (exponent > 0.3, "n > 0.3")):
                part = np.sort(np.abs(values[chosen & np.isfinite(values)]))
                axis.plot(part, np.arange(1, part.size + 1) / part.size, label=label)
            axis.axvline(np.median(sizes), color="0.6", linewidth=0.8)
            axis.set(xscale="log", xlim=(1e-5, 1), xlabel=f"|published / ours − 1|, {words}")
        axes[0].set_ylabel("share of the rows below")
        axes[0].legend()
        figure.savefig(folder / "differences.png", dpi=110, bbox_inches="tight")
        plt.close(figure)

        figure, axes = plt.subplots(1, 3, figsize=(13, 4.5), sharey=True)
        named = (("rate r τ0/h0", rate), ("exponent n", exponent), ("Tabor number μ", tabor))
        for axis, (words, values) in zip(axes, named, strict=True):
            axis.scatter(values, 100 * force, s=6, alpha=0.4, linewidths=0)
            axis.axhline(0, color="0.6", linewidth=0.8)
            axis.set(xscale="linear" if words.startswith("exponent") else "log", xlabel=words)
            axis.set_yscale("symlog", linthresh=0.5)
            axis.set(ylim=(-50, 50), yticks=_TICKS, yticklabels=[f"{t:g}" for t in _TICKS])
        axes[0].set_ylabel("published / ours − 1 [%]")
        figure.savefig(folder / "regions.png", dpi=110, bbox_inches="tight")
        plt.close(figure)
