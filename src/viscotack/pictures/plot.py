"""Figures of a result. Simulations are drawn as open markers, theories as lines.

Each function returns a new matplotlib ``Figure``. No window is opened, and the global state of
matplotlib is unchanged. :func:`save_figure` writes a figure in the style of the package.
"""

import io
import os
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.whole import write_whole
from viscotack.problem.outputs import Unit
from viscotack.result import Outcome, Result
from viscotack.result.cycles import pull_offs
from viscotack.theory.punch import REGIMES, RegimeMap
from viscotack.units import prefixed

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

# Colours of a regime map (cohesive, thin layer, half-plane), and number of contour lines.
_REGIME_COLOURS = ("#f2c9a0", "#cfe3f2", "#dddddd")
_STRESS_LINES = 10
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
    with _style():
        figure = _figure(figsize=(13.0, 9.0))
        axes = figure.subplots(2, 2)
        _curve(axes[0, 0], result, "depth", "force")
        _curve(axes[0, 1], result, "contact_radius", "force")
        _curve(axes[1, 0], result, "time", "contact_radius")
        _curve(axes[1, 1], result, "time", "edge_speed")
        if np.any(result.edge_speed > 0):
            axes[1, 1].set_yscale("log", nonpositive="mask")
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
    with _style():
        figure = _figure(figsize=(4.6 * len(shown) + 1.5, 1.2 + 0.32 * len(names)))
        panels = figure.subplots(1, len(shown), sharey=True, squeeze=False)[0]
        for axes, name in zip(panels, shown, strict=True):
            values, errors = (
                [each[name].get(x, np.nan) for x in names]
                for each in (found.elasticities, found.errors)
            )
            colours = ["#08519c" if v > 0 else "#d94801" for v in values]
            axes.barh(names, values, xerr=errors, color=colours, ecolor="0.4")
            axes.axvline(0, color="0.4", lw=0.8)
            axes.set_xlabel("d ln y/d ln x")
            axes.set_title(name.replace("_", " "))
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
    along, _, label = _series(result, "time" if moved else "depth")
    factor, unit = _work_unit(result)
    with _style():
        figure = _figure(figsize=(13.0, 5.2))
        left, right = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
        left.plot(along, energy.drive * factor, color="k", label="drive work")
        for name, words in _ENERGIES.items():
            values = getattr(energy, name)
            series = (values - values[0]) * factor
            if np.any(series != 0):
                left.plot(along, series, label=words)
        left.set_xlabel(label)
        left.set_ylabel(f"energy {unit}")
        left.legend()
        scales = result.scales
        factor_time, unit_time = (1.0, "/ time unit") if scales is None else (scales.time, "[s]")
        times, heat = energy.mode_time * factor_time, energy.mode_heat * factor
        right.vlines(times, 0, heat, color="C2", lw=6)
        right.set_xscale("log")
        right.set_ylim(bottom=0)
        right.set_xlabel(f"retardation time {unit_time}")
        right.set_ylabel(f"heat of each mode {unit}")
        if not len(times):
            right.text(0.5, 0.5, "elastic: no heat", transform=right.transAxes, ha="center")
    return figure


def draw_regimes(found: RegimeMap) -> "Figure":
    """Draw the regime map of a pad: detachment regime over retraction speed and thickness.

    Contour lines connect equal pull-off stresses.

    Parameters
    ----------
    found : RegimeMap
        Result of :func:`viscotack.theory.punch.map.regime_map`.

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> from viscotack.theory.punch import Frictionless, Pad
    >>> from viscotack.theory.punch.map import regime_map
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
    v, v_unit = log_axis_unit(found.speed, "m/s")
    b, b_unit = log_axis_unit(found.thickness, "m")
    p, p_unit = axis_unit(float(np.nanmedian(found.stress)), "Pa")
    speed, thickness, stress = found.speed / v, found.thickness / b, found.stress / p
    with _style():
        figure = _figure()
        axes = figure.subplots()
        axes.set_xscale("log")
        axes.set_yscale("log")
        colours = {"levels": (-0.5, 0.5, 1.5, 2.5), "colors": _REGIME_COLOURS}
        axes.contourf(speed, thickness, number, **colours)
        lines = axes.contour(
            speed, thickness, stress, levels=_STRESS_LINES, colors="0.3", linewidths=1.2
        )
        axes.clabel(lines, fmt=f"%.3g {p_unit}", fontsize=10)
        plain_ticks(axes.xaxis)
        plain_ticks(axes.yaxis)
        axes.tick_params(pad=8)
        axes.set_xlabel(f"retraction speed [{v_unit}]")
        axes.set_ylabel(f"thickness [{b_unit}]")
        patches = zip(REGIMES, _REGIME_COLOURS, strict=True)
        handles = [Patch(fc=colour, ec="0.3", label=words) for words, colour in patches]
        axes.legend(handles=handles[::-1], loc="lower right", frameon=True)
    return figure


def save_figure(figure: "Figure", path: str | os.PathLike[str]) -> None:
    """Write a figure to a file, complete or not at all.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    path : path
        File name; its ending chooses the format: .png, .pdf or .svg.

    Raises
    ------
    ValueError
        If the ending is not a known format.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> import os, tempfile
    >>> from matplotlib.figure import Figure
    >>> figure = Figure()
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_figure(figure, os.path.join(folder, "forces.svg"))
    ...     os.listdir(folder)
    ['forces.svg']
    """
    check_format(path)
    content = io.BytesIO()
    with _style():
        figure.savefig(content, format=Path(path).suffix.lstrip(".").lower())
    write_whole(path, content.getvalue())


def check_format(path: str | os.PathLike[str]) -> None:
    """Raise ValueError unless figures can be written in the format of this file name."""
    from matplotlib.backend_bases import FigureCanvasBase

    known = FigureCanvasBase.get_supported_filetypes()
    if Path(path).suffix.lstrip(".").lower() not in known:
        raise InputError(
            f"cannot draw to {os.fspath(path)!r}: the file name must end in one of "
            f"{', '.join(sorted(known))}"
        )


def _style() -> AbstractContextManager[Any]:
    import matplotlib.style

    return matplotlib.style.context(Path(__file__).with_name("viscotack.mplstyle"))


def _figure(**options: Any) -> "Figure":
    from matplotlib.figure import Figure

    return Figure(**options)


def _single(result: Result, x: str, y: str) -> "Figure":
    with _style():
        figure = _figure()
        axes = figure.subplots()
        _curve(axes, result, x, y)
        axes.legend()
    return figure


def _curve(axes: "Axes", result: Result, x: str, y: str) -> None:
    (horizontal, xfactor, xlabel), (vertical, yfactor, ylabel) = (
        _series(result, x),
        _series(result, y),
    )
    drawn = _drawn_steps(np.isfinite(horizontal) & np.isfinite(vertical))
    axes.plot(
        horizontal[drawn],
        vertical[drawn],
        "-o",
        lw=0.8,
        mfc="white",
        markevery=0.04,
        label="simulation",
    )
    if y == "force":
        axes.axhline(0, color="0.6", lw=1, zorder=0)
        _mark_pull_off(axes, result, x, xfactor, yfactor, ylabel)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)


def _drawn_steps(known: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Select the steps to draw: those with a value, and one between them where the line breaks."""
    later = np.flip(np.logical_or.accumulate(np.flip(known)))
    return known | (np.append(False, known[:-1]) & later)


def _mark_pull_off(
    axes: "Axes", result: Result, x: str, xfactor: float, yfactor: float, ylabel: str
) -> None:
    """Mark the pull-off of every cycle that has one; the label gives the last value."""
    if result.outcome is Outcome.STOPPED:
        return
    found = [end for end in pull_offs(result) if end is not None]
    if not found:
        return  # nothing to mark
    force = [-end.force * yfactor for end in found]
    unit = ylabel.rpartition(" [")[2].rstrip("]")
    last = abs(force[-1])
    value = f"{last:.4g}" if result.scales is None else f"{last:.3g} {unit}"
    label = f"pull-off, {value}" if len(found) == 1 else f"pull-offs, the last {value}"
    places = [getattr(end, x) * xfactor for end in found]
    axes.plot(places, force, "s", color="C1", ms=9, label=label, zorder=3)


def _work_unit(result: Result) -> tuple[float, str]:
    """Factor and unit with which energies are drawn."""
    kind = result.problem.outputs
    work = np.zeros(1) if result.energy is None else result.energy.drive
    factor = kind.energy_factor(result.groups)
    return _drawn(result, work, factor, kind.energy)


def _series(result: Result, name: str) -> tuple[npt.NDArray[np.float64], float, str]:
    """Return a scaled series, its scale factor, and the axis label."""
    values, column = getattr(result, name), result.problem.outputs.of(name)
    factor = column.factor(result.groups)
    factor, unit = _drawn(result, values, factor, column.unit)
    return values * factor, factor, f"{column.words} {unit}"


def _drawn(
    result: Result, values: npt.NDArray[np.float64], factor: float, unit: Unit
) -> tuple[float, str]:
    """Factor and unit with which numbers of a result are drawn."""
    scales = result.scales
    if scales is None:
        return factor, f"/ {unit.drawn}"
    factor *= getattr(scales, unit.scale)
    largest = np.nanmax(np.abs(values), initial=0.0) * abs(factor)
    prefix, name = axis_unit(largest, unit.si)
    return factor / prefix, f"[{name}]"


def axis_unit(largest: float, unit: str) -> tuple[float, str]:
    """Return the SI unit with the prefix for an axis up to this value: its size, and its name."""
    factor, name = prefixed(largest, unit)
    return factor, name.replace("u", "µ")


def log_axis_unit(values: npt.ArrayLike, unit: str) -> tuple[float, str]:
    """Return the same for a logarithmic axis, by the middle of its positive values."""
    x = np.asarray(values, dtype=float)
    x = x[x > 0]
    return axis_unit(float(np.sqrt(x.min() * x.max())) if x.size else 1.0, unit)


def plain_ticks(axis: "Axis") -> None:
    """Label a logarithmic axis, whose data are drawn, by plain numbers instead of powers of ten."""
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter

    low, high = axis.get_view_interval()
    if high > 10 * low:
        subs = (1.0,) if high > 100 * low else (1.0, 2.0, 5.0)
        axis.set_major_locator(LogLocator(subs=subs))
    else:
        axis.set_major_locator(MaxNLocator(5))
    axis.set_major_formatter(StrMethodFormatter("{x:.6g}"))
    axis.set_minor_formatter(NullFormatter())
