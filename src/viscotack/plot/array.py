"""Figure of an array of pads: force by travel of the drive, and the order of detachment."""

from typing import TYPE_CHECKING

import numpy as np

from viscotack.design.arrays import ArrayPull, PadArray
from viscotack.design.arrays.load import Hold

from .style import BLUE, ORANGE, drawing, label_in_si, said

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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
