"""Figures of a prediction with its interval, and of the shares of inputs in its variance.

Force positive in compression, depth positive into the solid.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import PchipInterpolator

from viscotack.errors import InputError
from viscotack.model.problem.outputs import PLANE
from viscotack.plot.style import drawing, label_of
from viscotack.prediction.prediction import Prediction
from viscotack.prediction.uncertainty import Uncertainty
from viscotack.result import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
    curve = prediction.curve
    if curve is None:
        raise InputError(f"the theory {prediction.method!r} has no force curve to draw")
    scales, kind = prediction.problem.scales(), prediction.problem.groups().outputs
    along, across = kind.of("depth"), kind.of("force")
    length, load = (
        1.0 if scales is None else getattr(scales, x.unit.scale) for x in (along, across)
    )
    with drawing() as figure:
        axes = figure.subplots()
        axes.axhline(0, color="0.6", lw=1, zorder=0)
        place = np.arange(len(curve.depth))
        fine = np.linspace(0, place[-1], place[-1] * _BETWEEN + 1)
        depth, force = (PchipInterpolator(place, x)(fine) for x in (curve.depth, curve.force))
        axes.plot(depth * length, force * load, color="C1", label="prediction")
        _band(axes, prediction, length, load)
        low, high = prediction.interval
        P, share = prediction.pull_off_force, prediction.confidence
        sides = [[(high - P) * load], [(P - low) * load]]
        label = "pull-off, interval" if share is None else f"pull-off, {share:.0%} interval"
        style = {"fmt": "s", "color": "C1", "capsize": 5, "label": label}
        axes.errorbar(curve.depth[-1] * length, -P * load, yerr=sides, **style)
        if simulated is not None:
            place = {"mfc": "none", "color": "C0", "markevery": 0.04, "zorder": 1}
            depth, force = simulated.depth * length, simulated.force * load
            axes.plot(depth, force, "o", label="simulation", **place)
        label_of(axes.xaxis, along, scales is not None)
        label_of(axes.yaxis, across, scales is not None)
        axes.legend()
    return figure


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


def draw_uncertainty(found: Uncertainty) -> Figure:
    """Draw first-order and total indices of the inputs as bars, the largest on top.

    Parameters
    ----------
    found : Uncertainty
        Result of :func:`viscotack.uncertainty`.
    """
    names = sorted(found.total, key=found.total.__getitem__)
    with drawing(7.0, 1.4 + 0.42 * len(names)) as figure:
        axes = figure.subplots()
        axes.barh(names, [found.total[x] for x in names], color="0.8", label="with other inputs")
        axes.barh(names, [found.first[x] for x in names], height=0.45, label="alone")
        axes.set_xlim(0, 1)
        axes.set_xlabel("share of the variance of ln(force)")
        axes.legend(loc="lower right", fontsize="small")
    return figure
