"""Pictures of an interface that was found: measured points, fitted curves, residuals."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from viscotack.identify import PullOff, RateSeriesFit, SlowTestFit, fitted_force

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLE = Path(__file__).with_name("viscotack.mplstyle")
_MOST = 20.0  # of the criterion: models that are worth a line


def draw_slow_test(fit: SlowTestFit) -> "Figure":
    """Return force against radius or depth, with the models worth a line, and their residuals."""
    import matplotlib.style
    from matplotlib.figure import Figure

    test = fit.test
    with matplotlib.style.context(_STYLE):
        figure = Figure(figsize=(8.4, 7.0), layout="constrained")
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2.6, 1.0))
        x = 1e6 * test.at
        order = np.argsort(x)
        above.plot(x, 1e3 * test.force, "o", ms=3, color="0.4", label="measured")
        for one in fit.fits:
            if one.criterion > fit.best.criterion + _MOST:
                continue
            force = fitted_force(one, test)
            (line,) = above.plot(x[order], 1e3 * force[order], label=one.model.upper())
            below.plot(
                x, (test.force - force) / test.force_noise, "o", ms=3, color=line.get_color()
            )
        below.axhline(0.0, color="0.6", lw=0.8)
        above.set_ylabel("force, compression positive [mN]")
        below.set_ylabel("residual / noise")
        below.set_xlabel("contact radius [um]" if test.against == "radius" else "depth [um]")
        above.legend()
    return figure


def draw_rate_series(series: Sequence[PullOff], fit: RateSeriesFit) -> "Figure":
    """Return pull-off force against speed: measured with uncertainties, and fitted."""
    import matplotlib.style
    from matplotlib.figure import Figure

    with matplotlib.style.context(_STYLE):
        figure = Figure(figsize=(8.0, 5.4), layout="constrained")
        axes = figure.subplots()
        speed = [1e6 * one.speed for one in series]
        axes.errorbar(
            speed,
            [1e3 * one.force.value for one in series],
            yerr=[1e3 * one.force.uncertainty for one in series],
            fmt="o",
            color="0.3",
            label="measured",
        )
        axes.plot(
            speed,
            [1e3 * force for force in fit.forces],
            label=f"{fit.work_of_adhesion:.3g} J/m$^2$, range {1e9 * fit.equilibrium_gap:.3g} nm",
        )
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("true speed of retraction [um/s]")
        axes.set_ylabel("pull-off force [mN]")
        axes.legend()
    return figure
