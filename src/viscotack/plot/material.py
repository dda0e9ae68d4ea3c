"""Figure of a material fit: measured points, and the fitted model as a line with its band."""

from typing import TYPE_CHECKING

import numpy as np

from viscotack.arrays import Array
from viscotack.lab.fit.observed import Observed
from viscotack.lab.fit.report import FitReport
from viscotack.model.materials.passport import Passport
from viscotack.model.materials.shift import FittedShift, TabulatedShift

from .style import drawing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WORDS = {
    "storage": "storage modulus $E'$",
    "loss": "loss modulus $E''$",
    "relaxation": "relaxation modulus",
    "creep": "creep compliance",
}
_MARKERS = ("o", "s")
_COLOURS = ("#0072B2", "#D55E00")  # the first two of the style
_BEYOND = 1.0  # decades drawn beyond the measured range, dashed


def draw_fit(report: FitReport, passport: Passport | None = None) -> "Figure":
    """Draw measured data and fitted model above, and the residuals below.

    Points are measured, lines fitted, shading is the confidence band; lines are dashed outside the
    measured range.

    Parameters
    ----------
    report : FitReport
        Result of :func:`viscotack.lab.fit`.
    passport : Passport, optional
        If it contains a table of shift factors, they are drawn in a third panel, with standard
        deviations and the closest shift law.

    Returns
    -------
    matplotlib.figure.Figure
        Write it with :func:`viscotack.save_figure`.

    Examples
    --------
    >>> import numpy as np
    >>> from viscotack.lab import MasterCurve, fit
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> omega = np.geomspace(0.1, 1e4, 16)
    >>> E = solid.complex_modulus(omega)
    >>> data = MasterCurve(293.15, omega, E.real, E.imag, "E")
    >>> report = fit(data, poisson_ratio=0.5, model="sls")
    >>> len(draw_fit(report).axes)
    2
    """
    data = report.observed
    shift = None if passport is None else passport.shift
    tabulated = shift if isinstance(shift, TabulatedShift) else None
    with drawing(8.4, 7.6 if tabulated is None else 10.4) as figure:
        ratios = (2.6, 1.0) if tabulated is None else (2.6, 1.0, 1.5)
        above, below, *more = figure.subplots(len(ratios), 1, height_ratios=ratios)
        below.sharex(above)
        if tabulated is None:
            above.tick_params(labelbottom=False)
        elif passport is not None:
            _shifts(more[0], tabulated, passport.fitted_shift)
        _law(above, report)
        _points(above, data, data.values)
        above.set(yscale="log", xscale="log")
        above.set_ylabel(
            "compliance [1/Pa]" if data.quantity == "creep" else "Young's modulus [Pa]"
        )
        above.legend(loc="best")
        above.set_title(
            f"{report.model}: {report.constants} constants on {data.values.size} numbers, "
            f"median error {100 * report.median_error:.2g} %",
            fontsize=14,
        )
        _residuals(below, report)
        below.set_xlabel("frequency [Hz]" if data.in_frequency else "time [s]")
    return figure


def _x(data: Observed, at):
    return at / (2 * np.pi) if data.in_frequency else at


def _law(axes: "Axes", report: FitReport) -> None:
    data = report.observed
    low, high = data.at[0], data.at[-1]
    inside = np.geomspace(low, high, 300)
    outside = (
        np.geomspace(low * 10**-_BEYOND, low, 30),
        np.geomspace(high, high * 10**_BEYOND, 30),
    )
    curves = data.predicted(report.material, inside)
    band = report.band(inside) if report.draws else None
    for i, part in enumerate(data.parts):
        colour = _COLOURS[i]
        if band is not None:
            label = f"{100 * report.level:.0f} % band" if i == 0 else None
            axes.fill_between(
                _x(data, inside), band[0][i], band[1][i], color=colour, alpha=0.25, lw=0,
                label=label,
            )  # fmt: skip
        axes.plot(_x(data, inside), curves[i], color=colour, label=f"{_WORDS[part]}, fitted")
        for beyond in outside:
            values = data.predicted(report.material, beyond)[i]
            axes.plot(_x(data, beyond), values, color=colour, ls=(0, (3, 2)), lw=1.4)


def _points(axes: "Axes", data: Observed, rows: Array, size: float = 1.0) -> None:
    """Draw a row of numbers for each measured part as open markers."""
    at, size = _x(data, data.at), size * (7.0 if data.at.size <= 60 else 4.0)
    for part, row, marker, colour in zip(data.parts, rows, _MARKERS, _COLOURS, strict=False):
        style = {"mfc": "white", "mec": colour, "ms": size, "mew": 1.4, "ls": "none"}
        axes.plot(at, row, marker, label=f"{_WORDS[part]}, measured", **style)


def _residuals(axes: "Axes", report: FitReport) -> None:
    percent = 100 * np.expm1(report.residuals)
    axes.axhline(0, color="0.5", lw=1.2)
    _points(axes, report.observed, percent, 0.8)
    reach = 1.15 * float(np.max(np.abs(percent)))
    axes.set_ylim(-reach, reach)
    axes.set_ylabel("measured/\nfitted − 1 [%]")


def _shifts(axes: "Axes", shift: TabulatedShift, fitted: FittedShift | None) -> None:
    rows = np.array(shift.temperature)
    doubt = np.array(shift.uncertainty) if shift.uncertainty else None
    axes.errorbar(
        rows - 273.15, shift.log10_shift(rows), doubt, fmt="o", mfc="white", mec=_COLOURS[0],
        ecolor=_COLOURS[0], capsize=3, label="from the sweeps, one standard deviation",
    )  # fmt: skip
    if fitted is not None:
        inside = np.linspace(rows[0], rows[-1], 200)
        values = np.asarray(fitted.law.log10_shift(inside))
        zero = float(fitted.law.log10_shift(shift.reference_temperature))
        name = type(fitted.law).__name__
        axes.plot(inside - 273.15, values - zero, color=_COLOURS[1], label=name)
    axes.set(xlabel="temperature [°C]", ylabel="$\\log_{10} a_T$")
    axes.legend(loc="best")
