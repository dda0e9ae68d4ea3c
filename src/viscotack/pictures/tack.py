"""Figures of tack tests: the retraction curves, and pull-off forces against speed."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from viscotack.lab.tack import Cycle

from .plot import axis_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_STYLE = Path(__file__).with_name("viscotack.mplstyle")
_MOST = 40  # largest number of curves that are drawn
_POINTS = 2000  # of one curve


def draw_tests(cycles: Sequence[Cycle]) -> "Figure":
    """Draw force against depth of every retraction, and pull-off force against true speed.

    Dots are pull-offs, bars standard uncertainties. At most 40 evenly chosen curves are drawn, but
    the pull-offs of all cycles.
    """
    import matplotlib.style
    from matplotlib.figure import Figure

    with matplotlib.style.context(_STYLE):
        figure = Figure(figsize=(11.0, 5.0), layout="constrained")
        left, right = figure.subplots(1, 2)
        _curves(left, cycles)
        _pull_offs(right, cycles)
    return figure


def _curves(axes: "Axes", cycles: Sequence[Cycle]) -> None:
    chosen = [cycles[i] for i in np.unique(np.linspace(0, len(cycles) - 1, _MOST, dtype=int))]
    forces, force_unit = axis_unit(max(c.pull_off_force.value for c in chosen), "N")
    depths, depth_unit = axis_unit(max(float(np.ptp(c.depth[c.retraction])) for c in chosen), "m")
    for cycle in chosen:
        back = cycle.retraction
        every = max((back.stop - back.start) // _POINTS, 1)
        (line,) = axes.plot(
            cycle.depth[back][::every] / depths, cycle.force[back][::every] / forces, lw=1.0
        )
        axes.plot(
            cycle.depth_at_pull_off.value / depths,
            -cycle.pull_off_force.value / forces,
            "o",
            ms=4,
            color=line.get_color(),
        )
    axes.axhline(0.0, color="0.6", lw=0.8)
    axes.set_xlabel(f"depth [{depth_unit}]")
    axes.set_ylabel(f"force, compression positive [{force_unit}]")


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
