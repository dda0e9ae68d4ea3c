"""Figure of tests: what each leaves of the uncertainty, by speed."""

from typing import TYPE_CHECKING

import numpy as np

from viscotack.identify import NextTests
from viscotack.units import readable

from .style import drawing, label_in_si

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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
