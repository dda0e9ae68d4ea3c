"""Figure of a design: forces by speed with their targets, and elasticities."""

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from viscotack.design import Design, DesignFile
from viscotack.design.fast import Force
from viscotack.design.margins import pad_of
from viscotack.errors import InputError

from .style import BLUE, ORANGE, drawing, label_in_si

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLOURS = {"hold": BLUE, "release": ORANGE, "work": "#41ab5d", "dead_load": "#6a51a3"}
_BELOW = {"frameon": False, "fontsize": 9, "loc": "upper center", "bbox_to_anchor": (0.5, -0.16)}
# Number of speeds, and factor on both ends of their range.
_SPEEDS, _WIDER = 25, 2.0
# Ticks of forces over their targets.
_TICKS = [m * 10.0**e for e in range(-3, 4) for m in (1, 3)]


def draw_design(found: Design, stated: DesignFile) -> "Figure":
    """Draw the pull-off force of the best design by speed, and its elasticities.

    Parameters
    ----------
    found : Design
        Result of :func:`viscotack.find_design`.
    stated : DesignFile
        Materials, interface and targets.

    Returns
    -------
    matplotlib.figure.Figure
        Left the force of all pads by speed with its interval, the targets, and simulations as
        dots; right d ln P/d ln x of the two forces.
    """
    with drawing(10.0, 4.6) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.35, 1))
        _draw_forces(left, found, stated)
        _draw_slopes(right, found)
    return figure


def _draw_forces(axes: "Axes", found: Design, stated: DesignFile) -> None:
    best, run = found.best, found.best.run
    # of the stated material that is like the worst of the conditions
    speeds: dict[str, float] = {}
    for name, speed, worst in (
        ("hold", best.choice.hold_speed, min),
        ("release", best.choice.release_speed, max),
    ):
        if speed is not None:
            speeds[name] = worst(stated.conditions.speeds(name, best.choice.material, speed))
    pad = pad_of(best.choice, 1.0, bonded=stated.space.bonded)
    known = speeds.values()
    ends = (min(known) / _WIDER, max(known) * _WIDER) if known else (1e-6, 1e-3)
    points = np.geomspace(*ends, _SPEEDS).tolist()
    forces = [found.fast.force(replace(pad, speed=v)) for v in points]
    curve = [(v, f) for v, f in zip(points, forces, strict=True) if isinstance(f, Force)]
    N = best.choice.pads
    if curve:
        v = [v for v, _ in curve]
        low, value, high = (
            [N * getattr(f, end) for _, f in curve] for end in ("low", "value", "high")
        )
        axes.fill_between(v, low, high, color="0.75", lw=0, label="90 % interval")
        axes.plot(v, value, color="0.25", label=f"{N} pad{'s' * (N > 1)}, {found.tier}")
    for target, speed in speeds.items():
        axes.axvline(speed, color=_COLOURS[target], lw=0.8, ls=":")
        wanted = getattr(stated.targets, target)
        if wanted is not None:
            words = f"{target}, {'at least' if target == 'hold' else 'at most'}"
            axes.axhline(wanted, color=_COLOURS[target], ls="--", label=words)
        value = None if run is None else run.forces.get(target)
        if value is not None:
            label = f"{target}, simulated"
            axes.plot(speed, value, "o", color=_COLOURS[target], label=label)
    axes.set(xscale="log", yscale="log")
    moved = " of the stated material" if stated.conditions.shifts else ""
    label_in_si(axes.xaxis, f"speed{moved}", "m/s")
    label_in_si(axes.yaxis, "pull-off force", "N")
    met = "met" if best.margin >= 0 else "not met"
    axes.set_title(f"worst target {np.expm1(best.margin):+.0%}: {met}")
    axes.legend(**_BELOW, ncols=3)


def _draw_slopes(axes: "Axes", found: Design) -> None:
    names = list(dict.fromkeys(x for each in found.elasticities.values() for x in each))
    several = max(len(found.elasticities), 1)
    height = 0.8 / several
    for i, (force, slopes) in enumerate(found.elasticities.items()):
        at = [names.index(x) + (i - (several - 1) / 2) * height for x in slopes]
        values = [np.nan if s is None else s for s in slopes.values()]
        axes.barh(at, values, height=height, color=_COLOURS[force], label=force.replace("_", " "))
    axes.set_yticks(range(len(names)), [x.replace("_", " ") for x in names])
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.axvline(0, color="0.4", lw=0.8)
    axes.set(xlabel="d ln P/d ln x", title="what matters")
    axes.legend(**_BELOW, ncols=3)


def draw_front(found: Design) -> "Figure":
    """Draw the front of a design: the margins of each pair of neighbouring targets.

    Parameters
    ----------
    found : Design
        Result of :func:`viscotack.find_design` for several targets.

    Returns
    -------
    matplotlib.figure.Figure
        Dots have the forces over their targets (for the release and the preload the targets over
        them) by the less favourable ends of the intervals, and lines lead to the more favourable
        ends. In the upper right quarter, beyond 1, both targets are met. The star is the first
        design.
    """
    if not found.front:
        raise InputError("a front needs several targets; this design has one")
    names = list(found.front[0].margins)
    pairs = list(pairwise(names))
    with drawing(5.2 * len(pairs), 4.6) as figure:
        panels = np.ravel(figure.subplots(1, len(pairs), squeeze=False))
        for axes, (x, y) in zip(panels, pairs, strict=True):
            for one in found.front:
                low, high = one.margins, one.best_margins
                axes.plot(*np.exp([[low[x], high[x]], [low[y], high[y]]]), color="0.7", lw=1.5)
            at = np.exp([[one.margins[x], one.margins[y]] for one in found.front])
            axes.plot(*at.T, "o", ms=5, color=_COLOURS["hold"])
            best = found.best.margins
            axes.plot(*np.exp([best[x], best[y]]), "*", ms=13, color=_COLOURS["release"])
            axes.axhline(1, color="0.4", lw=0.8)
            axes.axvline(1, color="0.4", lw=0.8)
            axes.set(xscale="log", yscale="log", xlabel=_over(x), ylabel=_over(y))
            for axis, ends in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
                ticks = [x for x in _TICKS if ends[0] <= x <= ends[1]]
                axis.set_ticks(ticks, [f"{x:g}" for x in ticks])
                axis.set_ticks([], minor=True)
    return figure


def _over(target: str) -> str:
    """Return the label of the margin of a target."""
    words = target.replace("_", " ")
    return f"target over {words}" if target in ("release", "preload") else f"{words} over target"
