"""Figure of the shares of inputs in the variance of a force."""

from typing import TYPE_CHECKING

from viscotack.prediction.uncertainty import Uncertainty

from .style import drawing

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_uncertainty(found: Uncertainty) -> "Figure":
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
        axes.set_xlabel("share of the variance of the logarithm of the force")
        axes.legend(loc="lower right", fontsize="small")
    return figure
