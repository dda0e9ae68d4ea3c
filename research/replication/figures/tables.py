"""Tables as numbers and as pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..bench import Numbers

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def drawn(numbers: Numbers, figure: Figure) -> None:
    """Draw the columns and rows of a table."""
    ax = figure.subplots()
    ax.set_axis_off()
    table = ax.table(cellText=numbers["rows"], colLabels=numbers["columns"], loc="center")
    table.auto_set_font_size(False)
    table.set_fontsize(9.5)
    table.scale(1, 1.45)
    table.auto_set_column_width(list(range(len(numbers["columns"]))))
    for (row, _), cell in table.get_celld().items():
        cell.set_edgecolor("0.8")
        cell.visible_edges = "B" if row else "BT"
        if row == 0:
            cell.get_text().set_fontweight("bold")
