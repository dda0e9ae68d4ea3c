"""Figures of a simulation: force, radius, energy, and sensitivities."""

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.model.problem.outputs import Series
from viscotack.result import Outcome, Result
from viscotack.result.cycles import pull_offs

from .style import BLUE, ORANGE, drawing, label_of, said

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Series of Result.energy besides the drive work -> label.
_ENERGIES = {
    "interface": "interface",
    "elastic": "elastic energy",
    "spring": "machine spring",
    "heat": "heat in the solid",
    "interface_heat": "heat in the interface",
    "jumps": "lost in jumps",
    "transfer": "lost in remeshing",
}


def draw_force(result: Result) -> "Figure":
    """Draw the force against the depth, with the pull-off marked.

    Parameters
    ----------
    result : Result
        A simulation; axes are in SI if its problem is in SI.

    Returns
    -------
    matplotlib.figure.Figure
        Force positive in compression.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, Groups, solve
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> groups = Groups(tabor=1.0, material=solid, start=AtDepth(5.0), rate=1.0)
    >>> result = solve(groups, accuracy=0.02, until="pull-off", estimate_error=False)
    >>> draw_force(result).axes[0].get_xlabel()
    'depth / $h_0$'
    """
    return _single(result, "depth", "force")


def draw_radius(result: Result) -> "Figure":
    """Draw the force against the contact radius, with the pull-off marked.

    Parameters
    ----------
    result : Result
        A simulation; axes are in SI if its problem is in SI.

    Returns
    -------
    matplotlib.figure.Figure
        Force positive in compression.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, Groups, solve
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> groups = Groups(tabor=1.0, material=solid, start=AtDepth(5.0), rate=1.0)
    >>> result = solve(groups, accuracy=0.02, until="pull-off", estimate_error=False)
    >>> len(draw_radius(result).axes)
    1
    """
    return _single(result, "contact_radius", "force")


def draw_overview(result: Result) -> "Figure":
    """Draw force against depth and radius, and radius and crack speed against time.

    Parameters
    ----------
    result : Result
        A simulation; axes are in SI if its problem is in SI.

    Returns
    -------
    matplotlib.figure.Figure
        Four panels.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, Groups, solve
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> groups = Groups(tabor=1.0, material=solid, start=AtDepth(5.0), rate=1.0)
    >>> result = solve(groups, accuracy=0.02, until="pull-off", estimate_error=False)
    >>> len(draw_overview(result).axes)
    4
    """
    with drawing(13.0, 9.0) as figure:
        axes = figure.subplots(2, 2)
        _curve(axes[0, 0], result, "depth", "force")
        _curve(axes[0, 1], result, "contact_radius", "force")
        _curve(axes[1, 0], result, "time", "contact_radius")
        _curve(axes[1, 1], result, "time", "edge_speed")
        axes[0, 0].legend()
        figure.suptitle(result.status, x=0.01, ha="left")
    return figure


def draw_sensitivities(result: Result) -> "Figure":
    """Draw the elasticities of the pull-off by every input as a tornado, largest on top.

    Parameters
    ----------
    result : Result
        Result of ``solve(sensitivities=True)``.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for the force and one for the work, as far as they have elasticities, with errors.

    Raises
    ------
    ValueError
        If the result has no elasticities.
    """
    found = result.sensitivities
    if found is None or not found.elasticities:
        why = "; ".join(dict.fromkeys(found.refused.values())) if found else "none were computed"
        raise InputError(f"there are no elasticities to draw: {why}")
    shown = list(found.elasticities)[:2]
    first = found.elasticities[shown[0]]
    names = sorted(first, key=lambda name: abs(first[name]))
    with drawing(4.6 * len(shown) + 1.5, 1.2 + 0.32 * len(names)) as figure:
        panels = figure.subplots(1, len(shown), sharey=True, squeeze=False)[0]
        for axes, name in zip(panels, shown, strict=True):
            values, errors = (
                [each[name].get(x, np.nan) for x in names]
                for each in (found.elasticities, found.errors)
            )
            colours = [BLUE if v > 0 else ORANGE for v in values]
            axes.barh(names, values, xerr=errors, color=colours, ecolor="0.4")
            axes.axvline(0, color="0.4", lw=0.8)
            axes.set(xlabel="d ln y/d ln x", title=name.replace("_", " "))
    return figure


def draw_energy(result: Result) -> "Figure":
    """Draw the energy balance, and the heat by retardation time.

    The horizontal axis is the depth for a single retraction, and the time for a history with
    moves. Elastic and interface energy are drawn as changes since the start. The drive work equals
    their sum plus the heat in the solid and the energy lost in jumps.

    Parameters
    ----------
    result : Result
        A simulation with energies.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ValueError
        If the result contains no energies.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, Groups, solve
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> groups = Groups(tabor=1.0, material=solid, start=AtDepth(5.0), rate=1.0)
    >>> result = solve(groups, accuracy=0.02, until="pull-off", estimate_error=False)
    >>> len(draw_energy(result).axes)
    2
    """
    if result.energy is None:
        raise InputError("the result contains no energies to draw; repeat the simulation")
    energy = result.energy
    moved = bool(result.groups.moves)
    kind, scales = result.problem.outputs, result.scales
    column = kind.of("time" if moved else "depth")
    joule, second = (
        (1.0, 1.0) if scales is None else (getattr(scales, kind.energy.scale), scales.time)
    )
    factor = kind.energy_factor(result.groups) * joule
    with drawing(13.0, 5.2) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
        along = _drawn(result, column)
        left.plot(along, energy.drive * factor, color="k", label="drive work")
        for name, words in _ENERGIES.items():
            values = getattr(energy, name)
            series = (values - values[0]) * factor
            if np.any(series != 0):
                left.plot(along, series, label=words)
        label_of(left.xaxis, column, scales is not None)
        label_of(left.yaxis, Series("", "energy", kind.energy), scales is not None)
        left.legend()
        times, heat = energy.mode_time * second, energy.mode_heat * factor
        right.vlines(times, 0, heat, color="C2", lw=6)
        right.set(
            xscale="log", xlabel="retardation time" + (" / time unit" if scales is None else " [s]")
        )
        right.set_ylim(bottom=0)
        label_of(right.yaxis, Series("", "heat of each mode", kind.energy), scales is not None)
        if not len(times):
            right.text(0.5, 0.5, "elastic: no heat", transform=right.transAxes, ha="center")
    return figure


def _single(result: Result, x: str, y: str) -> "Figure":
    with drawing() as figure:
        axes = figure.subplots()
        _curve(axes, result, x, y)
        axes.legend()
    return figure


def _curve(axes: "Axes", result: Result, x: str, y: str) -> None:
    columns = [result.problem.outputs.of(name) for name in (x, y)]
    horizontal, vertical = (_drawn(result, column) for column in columns)
    # the steps with a value, and one between them where the line breaks
    known = np.isfinite(horizontal) & np.isfinite(vertical)
    later = np.flip(np.logical_or.accumulate(np.flip(known)))
    drawn = known | (np.append(False, known[:-1]) & later)
    style = {"lw": 0.8, "mfc": "white", "markevery": 0.04, "label": "simulation"}
    axes.plot(horizontal[drawn], vertical[drawn], "-o", **style)
    if y == "force":
        axes.axhline(0, color="0.6", lw=1, zorder=0)
        _mark_pull_off(axes, result, *columns)
    if y == "edge_speed" and np.any(result.edge_speed > 0):
        axes.set_yscale("log", nonpositive="mask")
    for axis, column in zip((axes.xaxis, axes.yaxis), columns, strict=True):
        label_of(axis, column, result.scales is not None)


def _mark_pull_off(axes: "Axes", result: Result, along: Series, force: Series) -> None:
    """Mark the pull-off of every cycle that has one; the label gives the last value."""
    if result.outcome is Outcome.STOPPED:
        return
    found = [end for end in pull_offs(result) if end is not None]
    if not found:
        return  # nothing to mark
    forces = [-end.force * _factor(result, force) for end in found]
    last = abs(forces[-1])
    value = f"{last:.4g}" if result.scales is None else said(last, force.unit.si)
    label = f"pull-off, {value}" if len(found) == 1 else f"pull-offs, the last {value}"
    places = [getattr(end, along.source) * _factor(result, along) for end in found]
    axes.plot(places, forces, "s", color="C1", ms=9, label=label, zorder=3)


def _drawn(result: Result, column: Series) -> npt.NDArray[np.float64]:
    """Return a series as it is drawn, in SI where the problem is."""
    return getattr(result, column.source) * _factor(result, column)


def _factor(result: Result, column: Series) -> float:
    scales = result.scales
    return column.factor(result.groups) * (
        1.0 if scales is None else getattr(scales, column.unit.scale)
    )
