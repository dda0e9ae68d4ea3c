"""Figure of a prediction: surrogate curve, interval, and markers of a simulation.

Force positive in compression, depth positive into the solid.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import PchipInterpolator

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.prediction.prediction import Prediction
from viscotack.problem.outputs import PLANE
from viscotack.result import Result

from .plot import axis_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from viscotack.prediction.surrogate.line import Curves


_STYLE = Path(__file__).with_name("viscotack.mplstyle")
# Line segments between two points of a curve.
_BETWEEN = 8


def draw_prediction(prediction: Prediction, simulated: Result | None = None) -> Figure:
    """Draw the predicted force against the depth, with its band and the interval of the pull-off.

    With SI prefixes for a problem in SI, else in h0 and 1.5 pi R dg0; of a punch the mean stress,
    in Pa with a prefix or in sigma0.

    Parameters
    ----------
    prediction : Prediction
        A prediction with a curve.
    simulated : Result, optional
        Simulation of the same problem, drawn as open markers.

    Returns
    -------
    matplotlib.figure.Figure
        Force positive in compression.

    Raises
    ------
    ValueError
        If the prediction has no curve because its method is a theory.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, predict
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> figure = draw_prediction(predict(Groups(2.0, solid, AtDepth(3.0), rate=100.0)))
    >>> len(figure.axes)
    1
    """
    import matplotlib.style
    from matplotlib.figure import Figure

    curve = prediction.curve
    if curve is None:
        raise InputError(f"the theory {prediction.method!r} has no force curve to draw")
    scales, kind = prediction.problem.scales(), prediction.problem.groups().outputs
    drawn = [kind.of(name).unit for name in ("depth", "force")]
    what = "mean stress" if kind is PLANE else "force"
    if scales is None:
        length, load = 1.0, 1.0
        units = [f"/ {unit.drawn}" for unit in drawn]
    else:
        length, load = scales.length, getattr(scales, drawn[1].scale)
        far, name = axis_unit(length * float(np.abs(curve.depth).max()), drawn[0].si)
        most, load_name = axis_unit(load * float(np.abs(curve.force).max()), drawn[1].si)
        length, load, units = length / far, load / most, [f"[{name}]", f"[{load_name}]"]
    with matplotlib.style.context(_STYLE):
        figure = Figure()
        axes = figure.subplots()
        axes.axhline(0, color="0.6", lw=1, zorder=0)
        depth, force = _smooth(curve)
        axes.plot(depth * length, force * load, color="C1", label="prediction")
        _band(axes, prediction, length, load)
        low, high = -np.array(prediction.interval)[::-1] * load
        axes.errorbar(
            curve.depth[-1] * length,
            -prediction.pull_off_force * load,
            yerr=[
                [-prediction.pull_off_force * load - low],
                [high + prediction.pull_off_force * load],
            ],
            fmt="s",
            color="C1",
            capsize=5,
            label="pull-off, interval"
            if prediction.confidence is None
            else f"pull-off, {prediction.confidence:.0%} interval",
        )
        if simulated is not None:
            place = {"mfc": "none", "color": "C0", "markevery": 0.04, "zorder": 1}
            depth, force = simulated.depth * length, simulated.force * load
            axes.plot(depth, force, "o", label="simulation", **place)
        axes.set_xlabel(f"depth {units[0]}")
        axes.set_ylabel(f"{what} {units[1]}")
        axes.legend()
    return figure


def _smooth(curve: Curves) -> tuple[Array, Array]:
    """Interpolate a curve with ``_BETWEEN`` segments between two points."""
    place = np.arange(len(curve.depth))
    fine = np.linspace(0, place[-1], place[-1] * _BETWEEN + 1)
    depth, force = (PchipInterpolator(place, x)(fine) for x in (curve.depth, curve.force))
    return depth, force


def _band(axes: Axes, prediction: Prediction, length: float, load: float) -> None:
    """Shade the uncertainty of the tensile force and mark that of its zero crossing."""
    curve, band = prediction.curve, prediction.curve_band
    if curve is None or band is None:
        return
    tense = curve.force <= 0
    low, high = (curve.force[tense] + side * band for side in (-1, 1))
    shade = {"color": "C1", "alpha": 0.2, "lw": 0, "zorder": 0.5}
    axes.fill_between(curve.depth[tense] * length, low * load, high * load, **shade)
    if prediction.zero_force_interval is not None:
        ends = np.array(prediction.zero_force_interval) * length
        kind = prediction.problem.groups().outputs
        label = f"zero {'stress' if kind is PLANE else 'force'}, interval"
        axes.plot(ends, [0.0, 0.0], "|-", color="C1", ms=10, zorder=0.6, label=label)
