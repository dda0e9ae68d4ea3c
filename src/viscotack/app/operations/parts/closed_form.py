"""The answer of a closed form: numbers or columns of them, and a curve that is drawn."""

from typing import TYPE_CHECKING, Any

from ..request import Answer
from .record_words import record_words

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
        record=lambda: record,
        words=lambda: _words(record),
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


def _words(record: dict[str, Any]) -> str:
    if not isinstance(next(iter(record.values())), list):
        return record_words(record)
    rows = zip(*record.values(), strict=True)
    lines = ["  ".join(_cell(value) for value in row) for row in rows]
    return "\n".join(["  ".join(f"{name:>18}" for name in record), *lines])


def _cell(value: float | None) -> str:
    return f"{'-':>18}" if value is None else f"{value:18.6g}"
