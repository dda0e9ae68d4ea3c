"""Figure of a window: picking and printing of a stamp, by speed and preload."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from viscotack.arrays import Array
from viscotack.design.window import CriticalSpeed, Window

from .style import drawing, label_in_si

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Colours of the words, distinguishable without colour vision.
_COLOURS = {
    "pick": "#6baed6",
    "pick and print": "#a1d99b",
    "print": "#fdae6b",
    "neither": "#969696",
    "undecided": "#f0f0f0",
}
_LINES = {"donor": "-", "receiver": "--"}
# Ratio of the ends of a map with a single speed or preload.
_SINGLE = 2.0


def draw_window(*maps: Window, titles: Sequence[str] = ()) -> "Figure":
    """Draw maps of speed and preload: pick, print, neither, undecided, and critical speeds.

    Parameters
    ----------
    *maps : Window
        Results of :func:`viscotack.window`, drawn side by side.
    titles : sequence of str
        Their titles, for example temperatures.

    Returns
    -------
    matplotlib.figure.Figure
        Both axes are logarithmic if all preloads are in compression. A shaded strip around a line
        of critical speeds is their interval.

    Examples
    --------
    >>> from viscotack import AtForce, Elastic, LennardJones, Problem, Retraction, Sphere, window
    >>> contact = Problem(
    ...     material=Elastic(rubbery_modulus=1e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.1, equilibrium_gap=1e-7),
    ...     geometry=Sphere(radius=1e-3),
    ...     protocol=Retraction(start=AtForce(1e-3), speed=1e-5),
    ... )
    >>> found = window(contact, donor=contact, speeds=[1e-6, 1e-3], preloads=[1e-3, 1e-2])
    >>> draw_window(found).axes[0].get_xlabel()
    'speed of the drive [µm/s]'
    """
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    with drawing(5.2 + 3.8 * len(maps), 5.6) as figure:
        panels = figure.subplots(1, len(maps), squeeze=False, sharey=True)[0]
        for axes, found in zip(panels, maps, strict=True):
            _draw_map(axes, found)
        for axes, title in zip(panels, titles, strict=False):
            axes.set_title(title)
        label_in_si(panels[0].yaxis, "preload", "N")
        present = {cell.word for found in maps for cell in found.cells}
        handles: list[Patch | Line2D] = [
            Patch(fc=colour, ec="0.3", label=word)
            for word, colour in _COLOURS.items()
            if word in present
        ]
        bases = {each.base for found in maps for each in found.critical_speeds}
        handles += [
            Line2D([], [], color="0.1", ls=style, marker="o", label=f"critical speed, {base}")
            for base, style in _LINES.items()
            if base in bases
        ]
        figure.legend(handles=handles, loc="outside right upper", frameon=False)
    return figure


def _draw_map(axes: "Axes", found: Window) -> None:
    """Draw one map with its critical speeds."""
    from matplotlib.colors import ListedColormap

    words = list(_COLOURS)
    number = np.array([words.index(cell.word) for cell in found.cells])
    axes.pcolormesh(
        _edges(found.speeds),
        _edges(found.preloads),
        number.reshape(len(found.preloads), len(found.speeds)),
        cmap=ListedColormap(list(_COLOURS.values())),
        vmin=-0.5,
        vmax=len(words) - 0.5,
    )
    axes.set_xscale("log")
    if found.preloads[0] > 0:
        axes.set_yscale("log")
    for base, style in _LINES.items():
        known = [each for each in found.critical_speeds if each.base == base]
        if known:
            _draw_critical(axes, known, style)
    label_in_si(axes.xaxis, "speed of the drive", "m/s")
    axes.grid(False)


def _edges(values: Sequence[float]) -> Array:
    """Return the edges of cells around numbers, by ratios where all are positive."""
    x = np.array(values, dtype=float)
    positive = bool(np.all(x > 0))
    at = np.log(x) if positive else x
    if at.size == 1:
        half = np.log(_SINGLE) if positive else abs(at[0]) or 1.0
        edges = np.array([at[0] - half, at[0] + half])
    else:
        half = np.diff(at) / 2
        edges = np.array([at[0] - half[0], *(at[:-1] + half), at[-1] + half[-1]])
    return np.exp(edges) if positive else edges


def _draw_critical(axes: "Axes", known: list[CriticalSpeed], style: str) -> None:
    """Draw critical speeds with their intervals, one line for each change of contact."""
    for change in {(each.below, each.above) for each in known}:
        line = [each for each in known if (each.below, each.above) == change]
        x = np.array([each.speed for each in line])
        y = np.array([each.preload for each in line])
        axes.plot(x, y, style, marker="o", ms=5, color="0.1")
        low, high = (
            np.array([each.speed if (end := each.interval[k]) is None else end for each in line])
            for k in (0, 1)
        )
        axes.fill_betweenx(y, low, high, color="0.1", alpha=0.18, lw=0)
