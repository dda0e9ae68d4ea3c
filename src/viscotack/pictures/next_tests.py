"""Figure of tests: what each leaves of the uncertainty, by speed."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from viscotack.identify import NextTests
from viscotack.units import readable

from .plot import log_axis_unit, plain_ticks

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLE = Path(__file__).with_name("viscotack.mplstyle")


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
    import matplotlib.style
    from matplotlib.figure import Figure

    with matplotlib.style.context(_STYLE):
        figure = Figure(figsize=(10.0, 4.6), layout="constrained")
        left, right = figure.subplots(1, 2, width_ratios=(1.6, 1), sharey=True)
        groups: dict[str, list[tuple[float, float]]] = {}
        for one in found.ranked:
            groups.setdefault(_condition(one.trial), []).append((one.trial.speed, one.left))
        factor, unit = log_axis_unit([one.trial.speed for one in found.ranked], "m/s")
        for name, rows in groups.items():
            v, deviation = np.array(sorted(rows)).T
            left.plot(v / factor, 100 * deviation, "o-", ms=4, label=name)
        left.axhline(100 * found.now, color="0.4", ls="--", label="now")
        left.set_xscale("log")
        left.set_ylim(0, None)
        plain_ticks(left.xaxis)
        left.set_xlabel(f"speed of the test [{unit}]")
        left.set_ylabel("standard deviation after it [%]")
        left.legend(fontsize=8, loc="lower left")
        steps = [found.now, *(one.left for one in found.sequence)]
        right.plot(range(len(steps)), 100 * np.array(steps), "o-")
        names = [
            "now",
            *(
                readable(one.trial.speed, "m/s", digits=2).replace(" u", " µ")
                for one in found.sequence
            ),
        ]
        right.set_xticks(range(len(steps)), names, fontsize=8)
        right.set_xlabel("best sequence of tests")
    return figure


def _condition(trial) -> str:  # noqa: ANN001
    parts = [readable(trial.preload, "N", digits=2), f"R {readable(trial.radius, 'm', digits=3)}"]
    if trial.dwell is not None:
        parts.append(f"dwell {readable(trial.dwell, 's', digits=3)}")
    return ", ".join(parts)
