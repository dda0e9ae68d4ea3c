"""Figures of an identified interface: points, curves, residuals; and what further tests leave."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack.identify import (
    CurveGroup,
    EdgeFit,
    NextTests,
    Posterior,
    RateForecast,
    RateSeriesFit,
    SlowTestFit,
    fitted_force,
)
from viscotack.identify.contact_time import DwellFit
from viscotack.lab.tack import Cycle
from viscotack.lab.tack.repeats import same_speeds, temperature_of
from viscotack.plot.style import drawing, label_in_si, said
from viscotack.units import readable

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# parameter -> label and scale factor
_SCALES = {
    "work_of_adhesion": ("work of adhesion [J/m$^2$]", 1.0),
    "equilibrium_gap": ("range $h_0$ [nm]", 1e9),
    "reference_speed": ("reference speed $v_0$ [µm/s]", 1e6),
    "strengthening": ("strength over that at rest", 1.0),
    "exponent": ("exponent $n$", 1.0),
    "growth_per_decade": ("growth in a decade of contact time", 1.0),
}
_SHOWN = 40  # largest number of drawn curves of one speed
_CURVES = 6  # largest number of speeds with a curve
_MOST = 20.0  # largest difference of the information criterion of a model that is drawn


def draw_slow_test(fit: SlowTestFit) -> "Figure":
    """Draw force against radius or depth, the plausible models, and their residuals."""
    test = fit.test
    with drawing(8.4, 7.0) as figure:
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2.6, 1.0))
        x = test.at
        order = np.argsort(x)
        above.plot(x, test.force, "o", ms=3, color="0.4", label="measured")
        for one in fit.fits:
            if one.criterion > fit.best.criterion + _MOST:
                continue
            force = fitted_force(test, one.model, one.values)
            (line,) = above.plot(x[order], force[order], label=one.model.upper())
            rest = (test.force - force) / test.force_noise
            below.plot(x, rest, "o", ms=3, color=line.get_color())
        below.axhline(0.0, color="0.6", lw=0.8)
        label_in_si(above.yaxis, "force, compression positive", "N")
        label_in_si(below.xaxis, "contact radius" if test.against == "radius" else "depth", "m")
        below.set_ylabel("residual / noise")
        above.legend()
    return figure


def draw_curves(groups: Sequence[CurveGroup]) -> "Figure":
    """Draw the fitted curves of each speed, and work and modulus of every curve with their mean."""
    fits = [fit for group in groups for fit in group.curves]
    with drawing(11.0, 6.4) as figure:
        panels = figure.subplot_mosaic([["curves", "work"], ["curves", "modulus"]])
        curves = panels["curves"]
        for number, group in enumerate(groups):
            colour = f"C{number % 10}"
            speed = said(group.speed, "m/s")
            for index, fit in enumerate(group.curves[:_SHOWN]):
                test, x = fit.test, fit.test.at - fit.values.get("zero", 0.0)
                curves.plot(x, test.force, ".", ms=2, color=colour, alpha=0.4)
                order = np.argsort(x)
                label = None if index else f"{speed}: {len(group.curves)} curves"
                force = fitted_force(test, fit.model, fit.values)
                curves.plot(x[order], force[order], lw=1.0, color=colour, label=label)
        what = "contact radius" if fits[0].test.against == "radius" else "fitted depth"
        label_in_si(curves.xaxis, what, "m")
        label_in_si(curves.yaxis, "force", "N")
        curves.legend(fontsize="small")
        for name, quantity, unit in (
            ("work", "work_of_adhesion", "J/m^2"),
            ("modulus", "contact_modulus", "Pa"),
        ):
            axes, number = panels[name], 0
            for colour, group in enumerate(groups):
                at = np.arange(number, number := number + len(group.curves)) + 1
                values = [getattr(fit, quantity) for fit in group.curves]
                y, bars = np.array([[x.value, x.uncertainty] for x in values]).T
                axes.errorbar(at, y, yerr=bars, fmt="o", ms=3, color=f"C{colour % 10}")
                mean = getattr(group, quantity)
                axes.plot(at[[0, -1]], [mean.value] * 2, "k-", lw=1.0)
                if mean.low is not None:
                    axes.fill_between(at[[0, -1]], mean.low, mean.high, alpha=0.2)
            label_in_si(axes.yaxis, name, unit)
        panels["modulus"].set_xlabel("curve")
    return figure


def draw_dwells(fit: DwellFit) -> "Figure":
    """Draw pull-off force against contact time: measured, straight line in ln t, and law."""
    with drawing(8.0, 5.4) as figure:
        axes = figure.subplots()
        axes.semilogx(fit.times, fit.forces, "o", color="0.4", label="measured")
        at = np.geomspace(fit.times[0], fit.times[-1], 200)
        axes.semilogx(at, fit.line(at), "--", label="straight in the logarithm of the time")
        if fit.law is not None:
            axes.semilogx(at, fit.force(at), label=fit.law.replace("-", " "))
        label_in_si(axes.xaxis, "time in contact", "s")
        label_in_si(axes.yaxis, "pull-off force", "N")
        axes.legend()
    return figure


def draw_rate_series(
    fit: RateSeriesFit | EdgeFit, forecast: RateForecast | None = None
) -> "Figure":
    """Draw pull-off force against speed: measured, fitted, and forecast with its band."""
    with drawing(8.0, 5.4) as figure:
        axes = figure.subplots()
        measured = [one.force.value for one in fit.series]
        speed = [one.speed for one in fit.series]
        bars = [one.force.uncertainty for one in fit.series]
        style = {"fmt": "o", "color": "0.3", "label": "measured", "zorder": 3}
        axes.errorbar(speed, measured, yerr=bars, **style)
        work = readable(fit.work_of_adhesion, "J/m^2", digits=3).replace("^2", "$^2$")
        interface = f"{work}, {_second(fit)}"
        axes.plot(speed, fit.forces, "x", ms=9, zorder=4, label=f"fit: {interface}")
        if forecast is not None:
            _band(axes, forecast)
        axes.set(xscale="log", yscale="log")
        name, at = "true speed of retraction", fit.passport.temperature
        if at is not None and any(one.shift != 1.0 for one in fit.series):
            name = f"speed $a_T v$ at {at - 273.15:.3g} °C"
        label_in_si(axes.xaxis, name, "m/s")
        label_in_si(axes.yaxis, "pull-off force", "N")
        axes.legend()
    return figure


def draw_fitted_curves(fit: RateSeriesFit, cycles: Sequence[Cycle]) -> "Figure":
    """Draw one measured retraction for each speed, the curve of the fit, and their difference.

    Of repeated tests the one nearest to the fitted series is drawn; at most six speeds. The
    travel counts from zero force. The curves of the fit are those of a rigid machine, with
    tensions scaled to the pull-off with the machine's stiffness. The difference is drawn until
    the pull-off of the fit.
    """
    from matplotlib import colormaps

    chosen = np.unique(np.linspace(0, len(fit.series) - 1, _CURVES).round().astype(int))
    groups = same_speeds(cycles)
    with drawing(8.4, 7.0) as figure:
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2.6, 1.0))
        pairs = [_fitted_pair(fit, int(i), groups) for i in chosen]
        colours = colormaps["viridis"](np.linspace(0.0, 0.9, len(pairs)))
        for i, colour, (measured, fitted) in zip(chosen, colours, pairs, strict=True):
            one = fit.series[i]
            measured_force, fitted_force = said(one.force.value, "N"), said(fit.forces[i], "N")
            where = one.conditions.replace(" u", " µ")
            label = f"{where}: {measured_force}, fit {fitted_force}"
            travel, force = measured
            above.plot(travel, force, lw=1.0, color=colour, label=label)
            above.plot(*fitted, "--", color=colour)
            # the steep end, where travels that differ little give large differences, is left out
            last = fitted[0][np.argmin(fitted[1])]
            inside = (travel >= fitted[0][0]) & (travel <= last)
            rest = force[inside] - np.interp(travel[inside], *fitted)
            below.plot(travel[inside], rest, lw=1.0, color=colour)
        below.axhline(0.0, color="0.6", lw=0.8)
        label_in_si(above.yaxis, "force, compression positive", "N")
        label_in_si(below.xaxis, "travel from zero force", "m")
        label_in_si(below.yaxis, "difference", "N")
        above.legend(fontsize="small", loc="lower left")
    return figure


def _fitted_pair(
    fit: RateSeriesFit, i: int, groups: Sequence[Sequence[Cycle]]
) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
    """Return travel [m] and force [N] of a measured retraction and of the fit at its speed."""
    one = fit.series[i]
    near = [group for group in groups if temperature_of(group) == one.temperature]
    same = min(near or groups, key=lambda group: abs(group[0].speed.value - one.true_speed))
    cycle = min(same, key=lambda cycle: abs(cycle.pull_off_force.value - one.force.value))
    work, gap, growth = fit.interface
    depth, force = fit.forward.curve(work, gap, one.speed, one.preload or 0.0, growth)
    force = np.where(force < 0, fit.yielding[i] * force, force)
    fitted = _from_zero_force(depth, force)
    # the free flight is not compared
    back = cycle.retraction
    travel, force = _from_zero_force(cycle.depth[back], cycle.force[back])
    near = travel <= 1.1 * fitted[0][-1]
    return (travel[near], force[near]), fitted


def _from_zero_force(depth: Any, force: Any) -> tuple[Any, Any]:
    """Return the travel from zero force, or from a start in tension, and the force."""
    at = int(np.argmax(force < 0))
    if at == 0:
        return depth[0] - depth, force
    share = force[at - 1] / (force[at - 1] - force[at])
    zero = depth[at - 1] + share * (depth[at] - depth[at - 1])
    return zero - depth, force


def _second(fit: RateSeriesFit | EdgeFit) -> str:
    """Return the exponent of an edge law; else the range, its bound, or that it is unknown."""
    if isinstance(fit, EdgeFit):
        return f"exponent {fit.best.values['exponent']:.2g}"
    ends = fit.intervals["equilibrium_gap"]
    if ends.told:
        return f"range {readable(fit.equilibrium_gap, 'm', digits=3)}"
    if ends.closed_below or ends.closed_above:
        side, end = ("above", ends.low) if ends.closed_below else ("below", ends.high)
        return f"range {side} {readable(end, 'm', digits=3)}"
    return "range not identifiable"


def _band(axes: Any, forecast: RateForecast) -> None:
    order = np.argsort(forecast.speed)
    x, low, high, middle = (
        each[order] for each in (forecast.speed, forecast.low, forecast.high, forecast.force)
    )
    where = f"forecast at {readable(forecast.preload, 'N', digits=3)}"
    if forecast.temperature is not None:
        where += f", {forecast.temperature - 273.15:.3g} C"
    if forecast.dwell is not None:
        where += f", {readable(forecast.dwell, 's', digits=3)} of dwell"
    elif forecast.contact_time is not None:
        where += f", {readable(forecast.contact_time[0], 's', digits=2)} in contact"
    if len(x) == 1:
        # a line and a band through one speed have no width
        sides = [middle - low, high - middle]
        label = f"{where}, {forecast.level:.0%}"
        axes.errorbar(x, middle, yerr=sides, fmt="s", capsize=4, label=label)
        return
    (line,) = axes.plot(x, middle, ls="--", label=where)
    axes.fill_between(
        x, low, high, color=line.get_color(), alpha=0.2, lw=0, label=f"{forecast.level:.0%} band"
    )


def draw_posterior(chain: Posterior, fit: RateSeriesFit | EdgeFit) -> "Figure":
    """Draw the posterior of an interface: marginal and pairwise distributions."""
    from corner import corner

    side = 7.0 if len(chain.parameters) == 2 else 11.0
    # the corner library positions the panels
    with drawing(side, side, **{"figure.constrained_layout.use": False}) as figure:
        columns = [_SCALES.get(one.name, (one.name, 1.0)) for one in chain.parameters]
        scale = np.array([factor for _, factor in columns])
        ends = [(1 - fit.level) / 2, 0.5, (1 + fit.level) / 2]
        best = np.array([fit.best.values[one.name] for one in chain.parameters])
        corner(
            chain.values * scale,
            labels=[label for label, _ in columns],
            truths=best * scale,
            quantiles=ends,
            title_quantiles=ends,
            show_titles=True,
            title_fmt=".3g",
            title_kwargs={"fontsize": 10},
            label_kwargs={"fontsize": 11},
            fig=figure,
        )
    return figure


def draw_next_tests(found: NextTests) -> "Figure":
    """Draw the standard deviation after each test by its speed, and the best sequence.

    Parameters
    ----------
    found : NextTests
        Result of :func:`viscotack.identify.next_tests`.

    Returns
    -------
    matplotlib.figure.Figure
        Left a line for each preload, radius and dwell; right the deviation along the sequence.
    """
    with drawing(10.0, 4.6) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.6, 1), sharey=True)
        groups: dict[str, list[tuple[float, float]]] = {}
        for one in found.ranked:
            groups.setdefault(one.trial.conditions, []).append((one.trial.speed, one.left))
        for name, rows in groups.items():
            v, deviation = np.array(sorted(rows)).T
            left.plot(v, 100 * deviation, "o-", ms=4, label=name)
        left.axhline(100 * found.now, color="0.4", ls="--", label="now")
        left.set_xscale("log")
        label_in_si(left.xaxis, "speed of the test", "m/s")
        left.set_ylabel("standard deviation after it [%]")
        left.set_ylim(0, None)
        left.legend(fontsize=8, loc="lower left")
        steps = [found.now, *(one.left for one in found.sequence)]
        right.plot(range(len(steps)), 100 * np.array(steps), "o-")
        speeds = (readable(one.trial.speed, "m/s", digits=2) for one in found.sequence)
        names = ["now", *(speed.replace(" u", " µ") for speed in speeds)]
        right.set_xticks(range(len(steps)), names, fontsize=8)
        right.set_xlabel("best sequence of tests")
    return figure
