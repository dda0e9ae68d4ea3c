"""Figures of what is designed: designs, arrays, windows, force tables, and regimes of pads."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from viscotack.arrays import Array
from viscotack.design import Design, DesignFile
from viscotack.design.arrays import ArrayPull, PadArray
from viscotack.design.arrays.load import Hold
from viscotack.design.control import ForceTable, Released
from viscotack.design.fast import Force
from viscotack.design.margins import pad_of
from viscotack.design.window import CriticalSpeed, Window
from viscotack.errors import InputError
from viscotack.plot.style import BLUE, ORANGE, drawing, label_in_si, said
from viscotack.theory.punch import REGIMES, RegimeMap

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


# Largest number of pads that carry the number of their turn.
_NUMBERED = 60


def draw_array(array: PadArray, found: ArrayPull, *, load: Hold | None = None) -> "Figure":
    """Draw the force of an array by travel of the drive, and which pad detaches when.

    Parameters
    ----------
    array : PadArray
        The array.
    found : ArrayPull
        Result of :func:`viscotack.pull_array`.
    load : Hold, optional
        Load whose force is drawn.

    Returns
    -------
    matplotlib.figure.Figure
        Left the force, compression positive, with the pull-off and its interval; right the pads
        at their places, numbered by their turn. Pads that detach at one instant have the same
        number.

    Examples
    --------
    >>> from viscotack import AtForce, Elastic, LennardJones, Problem, Retraction, Sphere
    >>> from viscotack.design.arrays import grid, pull_array
    >>> pad = Problem(
    ...     material=Elastic(rubbery_modulus=1e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.1, equilibrium_gap=1e-8),
    ...     geometry=Sphere(radius=1e-3),
    ...     protocol=Retraction(start=AtForce(1e-3), speed=1e-5),
    ... )
    >>> array = PadArray(pad, grid(2, 2, 3e-3))
    >>> found = pull_array(array, speed=1e-5, preload=4e-3)
    >>> draw_array(array, found).axes[0].get_xlabel()
    'travel of the drive [µm]'
    """
    places = np.array(array.positions, dtype=float)
    turn = np.full(len(places), np.nan)
    for number, (when, _) in enumerate(found.jumps):
        turn[np.isclose(found.released, when, rtol=1e-6, atol=1e-9 * -found.drive[-1])] = number + 1
    with drawing(10.0, 4.6) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.35, 1))
        left.axhline(0, color="0.6", lw=0.8)
        left.plot(-found.drive, found.force, color=BLUE)
        low, high = found.interval
        left.axhspan(-low, -high, color=BLUE, alpha=0.15, lw=0, label="pull-off, interval")
        if load is not None:
            left.axhline(-load.force, color=ORANGE, ls="--", label="load")
        label_in_si(left.xaxis, "travel of the drive", "m")
        label_in_si(left.yaxis, "force on the array", "N")
        force = said(found.pull_off_force, "N")
        left.set_title(f"{len(places)} pads: {force}, load sharing {found.load_sharing:.2f}")
        left.legend(loc="best", frameon=False)
        x, y = places.T
        touched = ~np.isnan(turn)
        if not touched.all():
            style = {"s": 260, "facecolors": "none", "edgecolors": "0.5", "label": "no contact"}
            right.scatter(x[~touched], y[~touched], **style)
            right.legend(loc="upper left", bbox_to_anchor=(0, -0.12), frameon=False)
        style = {"s": 260, "c": turn[touched], "cmap": "viridis_r", "edgecolors": "0.3"}
        drawn = right.scatter(x[touched], y[touched], **style)
        if len(places) <= _NUMBERED:
            for at_x, at_y, number in zip(x[touched], y[touched], turn[touched], strict=True):
                colour = "white" if number > (1 + len(found.jumps)) / 2 else "black"
                style = {"ha": "center", "va": "center", "color": colour, "fontsize": 9}
                right.annotate(f"{number:.0f}", (at_x, at_y), **style)
        else:
            figure.colorbar(drawn, ax=right, label="turn")
        right.set_aspect("equal")
        right.margins(0.15)
        right.grid(False)
        label_in_si(right.xaxis, "x", "m")
        label_in_si(right.yaxis, "y", "m")
        right.set_title("order in which the pads detach")
    return figure


# Colours of the words, distinguishable without colour vision.
_WINDOW_COLOURS = {
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
            for word, colour in _WINDOW_COLOURS.items()
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

    words = list(_WINDOW_COLOURS)
    number = np.array([words.index(cell.word) for cell in found.cells])
    axes.pcolormesh(
        _edges(found.speeds),
        _edges(found.preloads),
        number.reshape(len(found.preloads), len(found.speeds)),
        cmap=ListedColormap(list(_WINDOW_COLOURS.values())),
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


# Most speeds whose curves are drawn.
_CURVES = 7


def draw_control(table: ForceTable, released: Released | None = None) -> "Figure":
    """Draw forces by depth at some speeds of a table, and a release by time.

    Parameters
    ----------
    table : ForceTable
        The table.
    released : Released, optional
        A release on a simulated rig.

    Returns
    -------
    matplotlib.figure.Figure
        Left the forces, compression positive, and the path of the release; right force and speed
        of the drive by time.
    """
    from matplotlib import colormaps

    count = 1 if released is None else 2
    with drawing(5.4 * count, 4.4) as figure:
        axes = figure.subplots(1, count, squeeze=False)[0]
        some = np.unique(np.linspace(0, len(table.speed) - 1, _CURVES).round().astype(int))
        colours = colormaps["viridis"](np.linspace(0, 0.9, len(some)))
        for i, colour in zip(some, colours, strict=True):
            travel = np.interp(table.share, [0, 1, 2, 3], [0.0, *table.travel[i]])
            label = said(float(table.speed[i]), "m/s")
            axes[0].plot(travel, table.force[i], color=colour, lw=1, label=label)
        axes[0].axhline(0, color="0.6", lw=0.6)
        if released is not None:
            gone = table.start_depth - released.depth
            axes[0].plot(gone, released.force, color=ORANGE, lw=2, label="release")
            _draw_ticks(axes[1], released)
        label_in_si(axes[0].xaxis, "travel of the indenter", "m")
        label_in_si(axes[0].yaxis, "force", "N")
        axes[0].legend(fontsize="x-small", handlelength=1.2, title="speed", title_fontsize="small")
    return figure


def _draw_ticks(axes: "Axes", released: Released) -> None:
    """Draw force and speed of the drive by time."""
    axes.plot(released.time, released.force, color=ORANGE, label="force")
    axes.axhline(-released.wanted, color="0.4", ls=":", lw=1, label="wanted")
    axes.legend(loc="best", fontsize="small")
    other = axes.twinx()
    other.grid(False)
    other.step(released.time, -released.drive_speed, where="post", color=BLUE, lw=1)
    other.yaxis.label.set_color(BLUE)
    label_in_si(axes.xaxis, "time", "s")
    label_in_si(axes.yaxis, "force", "N")
    label_in_si(other.yaxis, "speed of the drive, away", "m/s")


# Colours of cohesive, thin layer, half-plane.
_REGIME_COLOURS = ("#f2c9a0", "#cfe3f2", "#dddddd")


def draw_regimes(found: RegimeMap) -> "Figure":
    """Draw the regime map of a pad: detachment regime over retraction speed and thickness.

    Contour lines connect equal pull-off stresses.

    Parameters
    ----------
    found : RegimeMap
        Result of :func:`viscotack.theory.punch.unloading.regime_map`.

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.theory.punch import Frictionless, Pad
    >>> from viscotack.theory.punch.unloading import regime_map
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = Pad(
    ...     half_width=1e-3,
    ...     contact_modulus=1e6,
    ...     work_of_adhesion=0.05,
    ...     strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> law = pad.crack_law("greenwood", material=solid)
    >>> figure = draw_regimes(regime_map([1e-4, 2e-3], [1e-6, 1.0], pad, law))
    >>> figure.axes[0].get_xlabel()
    'retraction speed [mm/s]'
    """
    from matplotlib.patches import Patch

    number = np.argmax(found.regime[..., None] == np.array(REGIMES), axis=-1)
    speed, thickness = found.speed, found.thickness
    with drawing() as figure:
        axes = figure.subplots()
        axes.set(xscale="log", yscale="log")
        axes.contourf(
            speed, thickness, number, levels=(-0.5, 0.5, 1.5, 2.5), colors=_REGIME_COLOURS
        )
        lines = axes.contour(
            speed, thickness, found.stress, levels=10, colors="0.3", linewidths=1.2
        )
        axes.clabel(lines, fmt=lambda x: said(x, "Pa"), fontsize=10)
        axes.tick_params(pad=8)
        label_in_si(axes.xaxis, "retraction speed", "m/s")
        label_in_si(axes.yaxis, "thickness", "m")
        patches = zip(REGIMES, _REGIME_COLOURS, strict=True)
        handles = [Patch(fc=colour, ec="0.3", label=words) for words, colour in patches]
        axes.legend(handles=handles[::-1], loc="lower right", frameon=True)
    return figure
