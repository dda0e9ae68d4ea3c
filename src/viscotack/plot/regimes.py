"""Figure of the regime map of a pad."""

from typing import TYPE_CHECKING

import numpy as np

from viscotack.theory.punch import REGIMES, RegimeMap

from .style import drawing, label_in_si, said

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Colours of cohesive, thin layer, half-plane.
_COLOURS = ("#f2c9a0", "#cfe3f2", "#dddddd")


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
    >>> from viscotack.model.materials import StandardSolid
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
    speed, thickness = found.speed, found.thickness
    with drawing() as figure:
        axes = figure.subplots()
        axes.set(xscale="log", yscale="log")
        axes.contourf(speed, thickness, number, levels=(-0.5, 0.5, 1.5, 2.5), colors=_COLOURS)
        lines = axes.contour(
            speed, thickness, found.stress, levels=10, colors="0.3", linewidths=1.2
        )
        axes.clabel(lines, fmt=lambda x: said(x, "Pa"), fontsize=10)
        axes.tick_params(pad=8)
        label_in_si(axes.xaxis, "retraction speed", "m/s")
        label_in_si(axes.yaxis, "thickness", "m")
        patches = zip(REGIMES, _COLOURS, strict=True)
        handles = [Patch(fc=colour, ec="0.3", label=words) for words, colour in patches]
        axes.legend(handles=handles[::-1], loc="lower right", frameon=True)
    return figure
