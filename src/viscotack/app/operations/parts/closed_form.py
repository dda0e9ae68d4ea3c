"""The answer of a closed form: numbers or columns of them, and a curve that is drawn."""

from typing import TYPE_CHECKING, Any

from ..request import Answer

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def closed_form(
    found: Any,
    record: dict[str, Any],
    curve: tuple[Any, Any],
    labels: tuple[str, str],
    *,
    logarithmic: bool = False,
) -> Answer:
    """Return the answer with numbers, or lists of them, by name; `curve` is drawn as a line."""
    return Answer(
        found,
        data=lambda: record,
        pictures={"plot": lambda: _drawn(curve, labels, logarithmic)},
    )


def _drawn(curve: tuple[Any, Any], labels: tuple[str, str], logarithmic: bool) -> "Figure":
    from matplotlib.figure import Figure

    figure = Figure(layout="constrained")
    axes = figure.subplots()
    axes.plot(*curve)
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
    if logarithmic:
        axes.set_xscale("log")
        axes.set_yscale("log")
    return figure
