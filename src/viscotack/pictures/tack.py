"""Figures of tack tests: the retraction curves, and pull-off forces against speed."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from viscotack.identify.pull_off import same_speeds
from viscotack.lab.tack import Cycle
from viscotack.units import readable

from .plot import axis_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_STYLE = Path(__file__).with_name("viscotack.mplstyle")
_POINTS = 2000  # of one curve
_LEGEND = 10  # largest number of speeds in the legend


def draw_tests(cycles: Sequence[Cycle], most: int = 40) -> "Figure":
    """Draw force against depth of every retraction, and pull-off force against true speed.

    Curves have the colour of their speed, and the legend its mean pull-off force. Dots are
    pull-offs, bars standard uncertainties. At most `most` evenly chosen curves are drawn, but the
    pull-offs of all cycles.
    """
    import matplotlib.style
    from matplotlib.figure import Figure

    with matplotlib.style.context(_STYLE):
        figure = Figure(figsize=(11.0, 5.0), layout="constrained")
        left, right = figure.subplots(1, 2)
        _curves(left, cycles, most)
        _pull_offs(right, cycles)
    return figure


def _curves(axes: "Axes", cycles: Sequence[Cycle], most: int) -> None:
    from matplotlib import colormaps

    groups = same_speeds(cycles)
    rows = [(number, cycle) for number, same in enumerate(groups) for cycle in same]
    chosen = [rows[i] for i in _evenly(len(rows), most)]
    shown = [cycle for _, cycle in chosen]
    forces, force_unit = axis_unit(max(c.pull_off_force.value for c in shown), "N")
    depths, depth_unit = axis_unit(max(float(np.ptp(c.depth[c.retraction])) for c in shown), "m")
    # the last colours are too light for lines
    colours = colormaps["viridis"](np.linspace(0.0, 0.9, len(groups)))
    for number, cycle in chosen:
        back = cycle.retraction
        every = max((back.stop - back.start) // _POINTS, 1)
        colour = colours[number]
        depth, force = cycle.depth[back][::every], cycle.force[back][::every]
        axes.plot(depth / depths, force / forces, lw=1.0, color=colour)
        axes.plot(
            cycle.depth_at_pull_off.value / depths,
            -cycle.pull_off_force.value / forces,
            "o",
            ms=4,
            color=colour,
        )
    for number in _evenly(len(groups), _LEGEND):
        axes.plot([], [], color=colours[number], label=_label(groups[number]))
    axes.legend(fontsize="small")
    axes.axhline(0.0, color="0.6", lw=0.8)
    axes.set_xlabel(f"depth [{depth_unit}]")
    axes.set_ylabel(f"force, compression positive [{force_unit}]")


def _evenly(count: int, most: int) -> list[int]:
    """Return at most `most` evenly spaced indices below a count."""
    return np.unique(np.linspace(0, count - 1, min(count, most), dtype=int)).tolist()


def _label(same: Sequence[Cycle]) -> str:
    """Return speed and mean pull-off force, such as "1.33 um/s: 4.31 mN (3 tests)"."""
    speed = float(np.mean([cycle.speed.value for cycle in same]))
    force = float(np.mean([cycle.pull_off_force.value for cycle in same]))
    words = f"{readable(speed, 'm/s', digits=3)}: {readable(force, 'N', digits=3)}"
    words = words.replace(" u", " µ")
    return words if len(same) == 1 else f"{words} ({len(same)} tests)"


def _pull_offs(axes: "Axes", cycles: Sequence[Cycle]) -> None:
    force, unit = axis_unit(max(cycle.pull_off_force.value for cycle in cycles), "N")
    speed, speed_unit = axis_unit(max(cycle.speed.value for cycle in cycles), "m/s")
    axes.errorbar(
        [cycle.speed.value / speed for cycle in cycles],
        [cycle.pull_off_force.value / force for cycle in cycles],
        xerr=[cycle.speed.uncertainty / speed for cycle in cycles],
        yerr=[cycle.pull_off_force.uncertainty / force for cycle in cycles],
        fmt="o",
        ms=4,
        lw=1.0,
    )
    if all(cycle.speed.value > 0 for cycle in cycles):
        axes.set_xscale("log")
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(f"true speed of retraction [{speed_unit}]")
    axes.set_ylabel(f"pull-off force [{unit}]")
