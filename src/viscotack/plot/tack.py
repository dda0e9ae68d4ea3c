"""Figures of tack tests: the retraction curves, and pull-off forces against speed."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from viscotack.lab.tack import Cycle
from viscotack.lab.tack.repeats import same_speeds, same_temperatures, temperature_of
from viscotack.model.materials.shift import Shift

from .style import drawing, label_in_si, said

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_POINTS = 2000  # of one curve
_LEGEND = 10  # largest number of speeds in the legend


def draw_tests(cycles: Sequence[Cycle], most: int = 40, shift: Shift | None = None) -> "Figure":
    """Draw force against depth of every retraction, and pull-off force against true speed.

    Curves have the colour of their temperature and speed, and the legend the mean pull-off force.
    Dots are pull-offs, bars standard uncertainties; tests at several temperatures have a colour
    each. With a shift law the pull-offs are drawn against the speed a_T v at its reference
    temperature. At most `most` evenly chosen curves are drawn, but the pull-offs of all cycles.
    """
    with drawing(11.0, 5.0) as figure:
        left, right = figure.subplots(1, 2)
        _curves(left, cycles, most)
        _pull_offs(right, cycles, shift)
    return figure


def _curves(axes: "Axes", cycles: Sequence[Cycle], most: int) -> None:
    from matplotlib import colormaps

    groups = same_speeds(cycles)
    rows = [(number, cycle) for number, same in enumerate(groups) for cycle in same]
    chosen = [rows[i] for i in _evenly(len(rows), most)]
    # the last colours are too light for lines
    colours = colormaps["viridis"](np.linspace(0.0, 0.9, len(groups)))
    for number, cycle in chosen:
        back = cycle.retraction
        every = max((back.stop - back.start) // _POINTS, 1)
        colour = colours[number]
        depth, force = cycle.depth[back][::every], cycle.force[back][::every]
        axes.plot(depth, force, lw=1.0, color=colour)
        at = cycle.depth_at_pull_off.value, -cycle.pull_off_force.value
        axes.plot(*at, "o", ms=4, color=colour)
    several = len(same_temperatures(cycles)) > 1
    for number in _evenly(len(groups), _LEGEND):
        axes.plot([], [], color=colours[number], label=_label(groups[number], several))
    axes.legend(fontsize="small")
    axes.axhline(0.0, color="0.6", lw=0.8)
    label_in_si(axes.xaxis, "depth", "m")
    label_in_si(axes.yaxis, "force, compression positive", "N")


def _evenly(count: int, most: int) -> list[int]:
    """Return at most `most` evenly spaced indices below a count."""
    return np.unique(np.linspace(0, count - 1, min(count, most), dtype=int)).tolist()


def _celsius(same: Sequence[Cycle]) -> str:
    temperature = temperature_of(same)
    return "no temperature" if temperature is None else f"{temperature - 273.15:.3g} °C"


def _label(same: Sequence[Cycle], several: bool) -> str:
    """Return speed and mean pull-off force, such as "1.33 um/s: 4.31 mN (3 tests)".

    With the temperature if there are several.
    """
    speed = float(np.mean([cycle.speed.value for cycle in same]))
    force = float(np.mean([cycle.pull_off_force.value for cycle in same]))
    words = f"{_celsius(same)}, " * several + f"{said(speed, 'm/s')}: {said(force, 'N')}"
    return words if len(same) == 1 else f"{words} ({len(same)} tests)"


def _pull_offs(axes: "Axes", cycles: Sequence[Cycle], shift: Shift | None) -> None:
    from matplotlib import colormaps

    groups = same_temperatures(cycles)
    factors = [_factor(same, shift) for same in groups]
    colours = colormaps["plasma"](np.linspace(0.0, 0.85, len(groups)))
    for same, factor, colour in zip(groups, factors, colours, strict=True):
        axes.errorbar(
            [factor * cycle.speed.value for cycle in same],
            [cycle.pull_off_force.value for cycle in same],
            xerr=[factor * cycle.speed.uncertainty for cycle in same],
            yerr=[cycle.pull_off_force.uncertainty for cycle in same],
            fmt="o",
            ms=4,
            lw=1.0,
            color=colour if len(groups) > 1 else None,
            label=_celsius(same),
        )
    if all(cycle.speed.value > 0 for cycle in cycles):
        axes.set_xscale("log")
    if len(groups) > 1:
        axes.legend(fontsize="small")
    axes.set_ylim(bottom=0.0)
    name = "true speed of retraction"
    if shift is not None:
        name = f"speed $a_T v$ at {shift.reference_temperature - 273.15:.3g} °C"
    label_in_si(axes.xaxis, name, "m/s")
    label_in_si(axes.yaxis, "pull-off force", "N")


def _factor(same: Sequence[Cycle], shift: Shift | None) -> float:
    """Return a_T of tests at one temperature; 1 without a shift law."""
    temperature = temperature_of(same)
    if shift is None or temperature is None:
        return 1.0
    return 10.0 ** float(shift.log10_shift(temperature))
