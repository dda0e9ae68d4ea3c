"""Compare the predictions with the curves at other speeds, once."""

import csv
from dataclasses import dataclass
from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib.figure import Figure

from viscotack.arrays import Array

from .curves import Curve, curves, names

# A protocol at two speeds: silicone, what its files have in their names, those at 20 nm/s, others.
PROTOCOLS = (
    ("PDMS", "9 cycles", "9cycles,1,5um offset,", "20nms", "7nms", ("%",)),
    ("PDMS", "9 cycles 75 %", "14.09/APM-PDMS-150ms,4um,", "20nms", "7nms", ("16cycles",)),
    ("10:1", "16 cycles", "30.09/APM-PDMS10-1-100ms,4um,", "20nms", "40nms", ()),
)
# Growth of the pull-off with time in contact, d ln F/d ln t, from the tests at 20 nm/s.
GROWTH = {"PDMS": 0.043, "10:1": 0.089}
_DETACHED = 0.05  # mean of the last forces over the pull-off force, at most, of a whole test


@dataclass(frozen=True)
class Group:
    """Tests of one protocol at one speed; SI units."""

    solid: str
    protocol: str
    every: tuple[Curve, ...]

    def values(self, name: str) -> Array:
        """Return a number of every test, by its name."""
        return np.array([getattr(curve, name) for curve in self.every])


def groups(repository: Path) -> list[tuple[Group, Group]]:
    """Read each protocol at 20 nm/s and at its other speed."""
    found = []
    for solid, protocol, part, slow, other, without in PROTOCOLS:
        pair = []
        for speed in (slow, other):
            chosen = [
                name
                for name in names(repository)
                if part in name and speed in name and not any(word in name for word in without)
            ]
            every = [curve for name in chosen for curve in curves(repository, name)]
            whole = [
                curve
                for curve in every
                if abs(curve.force[-20:].mean()) < -_DETACHED * curve.force.min()
            ]
            print(f"{solid}, {protocol}, {speed}: {len(whole)} whole of {len(every)} in {chosen}")
            pair.append(Group(solid, protocol, tuple(whole)))
        found.append((pair[0], pair[1]))
    return found


def ratio(there: Array, base: Array) -> tuple[float, float]:
    """Return a ratio of means and its standard error; one test has the scatter of the others."""
    spread = [x.std(ddof=1) if len(x) > 1 else base.std(ddof=1) for x in (there, base)]
    parts = [s / x.mean() / len(x) ** 0.5 for s, x in zip(spread, (there, base), strict=True)]
    found = float(there.mean() / base.mean())
    return found, found * float(np.hypot(*parts))


def table(repository: Path, predictions: Path) -> list[dict[str, str | float]]:
    """Return measured and predicted ratios of the forces at two speeds, a row for each protocol."""
    with predictions.open(newline="") as file:
        predicted = list(csv.DictReader(file))
    rows = []
    for base, other in groups(repository):
        speed = float(other.values("speed").mean()) * 1e9
        case = [row for row in predicted if row["solid"] == base.solid]
        nearest = min((row["speed_nm_per_s"] for row in case), key=lambda v: abs(float(v) - speed))
        # every prediction there, over the same hypothesis at the base speed
        pairs = [
            (there, slow)
            for there in case
            for slow in case
            if there["speed_nm_per_s"] == nearest
            and float(slow["force_over_that_at_base"]) == 1
            and all(there[name] == slow[name] for name in ("spectrum", "range_nm"))
        ]
        matched = [pair for pair in pairs if pair[0]["spectrum"].startswith("matched")]
        short = [pair for pair in pairs if pair not in matched and float(pair[0]["range_nm"]) <= 1]
        times = [float(group.values("contact_time").mean()) for group in (other, base)]
        growth = (times[0] / times[1]) ** GROWTH[base.solid]
        row: dict[str, str | float] = {"solid": base.solid, "protocol": base.protocol}
        row |= {"speed_nm_per_s": speed, "tests": len(other.every), "at_20": len(base.every)}
        row |= {"contact_time_s": times[0], "at_20_s": times[1], "growth": growth}
        for name, factor in (("pull_off", growth), ("jump_in", 1.0)):
            forces = [group.values(f"{name}_force") for group in (other, base)]
            row |= {
                f"{name}_nN": forces[0].mean() * 1e9,
                f"{name}_at_20_nN": forces[1].mean() * 1e9,
            }
            row[f"{name}_ratio"], row[f"{name}_error"] = ratio(*forces)
            for hypothesis, chosen in (("published", short), ("matched", matched)):
                expected = [
                    factor * float(x[f"{name}_nN"]) / float(y[f"{name}_nN"]) for x, y in chosen
                ]
                row |= {f"{name}_{hypothesis}_low": min(expected)}
                row |= {f"{name}_{hypothesis}_high": max(expected)}
            row[f"{name}_no_loss"] = factor
        rows.append(row)
    return rows


def draw(rows: list[dict[str, str | float]], path: Path) -> None:
    """Draw measured and predicted ratios side by side."""
    places = np.arange(len(rows))
    labels = [
        f"{row['solid']}, {row['protocol']}\n{row['speed_nm_per_s']:.1f} nm/s" for row in rows
    ]
    with matplotlib.style.context("viscotack.plot.viscotack"):
        figure = Figure(figsize=(12.0, 5.0))
        for axes, name in zip(figure.subplots(1, 2), ("pull_off", "jump_in"), strict=True):

            def of(what: str, name: str = name) -> Array:
                return np.array([float(row[f"{name}_{what}"]) for row in rows])

            for hypothesis, color in (("published", "C3"), ("matched", "C0")):
                low, high = of(f"{hypothesis}_low"), of(f"{hypothesis}_high")
                label = f"predicted, {hypothesis} spectrum"
                axes.bar(places, high - low + 0.002, 0.6, low, color=color, alpha=0.6, label=label)
            axes.plot(places, of("no_loss"), "k_", ms=40, label="predicted, no loss at the edge")
            axes.errorbar(places, of("ratio"), of("error"), fmt="ko", label="measured")
            axes.axhline(1.0, color="0.7", lw=1, zorder=0)
            axes.set_xticks(places, labels, size=11)
            axes.set_ylabel(f"{name.replace('_', '-')} force over that at 20 nm/s")
        figure.axes[0].set_ylim(0.86, 1.13)
        figure.axes[0].legend(fontsize=11, loc="upper left")
        figure.savefig(path, dpi=80)
