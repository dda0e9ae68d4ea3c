"""One style for every picture: theory is a line, simulation an open marker, a model a dot."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.style
from matplotlib.figure import Figure

# Okabe and Ito's, told apart by every eye; with the markers of the thesis, for those who see none.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
MARKERS = ("^", "*", "D", "s", "o", "v", "P")
SIMULATED: dict[str, Any] = {"ls": "", "mfc": "none"}
MODEL: dict[str, Any] = {"ls": "", "ms": 3.5, "marker": "."}
# Exponents of the thesis's materials, each with its own colour everywhere; 0 is a standard solid.
OF_EXPONENT = {0.2: 3, 0.4: 0, 0.6: 1, 0.8: 2, 1.6: 4, 0.0: 5}

FORCE = r"pull-off force / $\frac{3}{2}\pi R\,\Delta\gamma_0$"
PULL = r"force / $\frac{3}{2}\pi R\,\Delta\gamma_0$"
RADIUS = r"contact radius / $(\pi R^2\Delta\gamma_0/E_0^*)^{1/3}$"
ENERGY = r"$\Delta\gamma_{eff}\,/\,\Delta\gamma_0$"
RATE = r"retraction rate $r\,\tau_0/h_0$"
WORK = r"work to pull-off / $\frac{3}{2}\pi R\,\Delta\gamma_0 h_0$"
DEPTH = r"depth / $h_0$"
TIP_SPEED = r"crack speed $v\,\tau_0/l_0$"
_SMALL = Path(__file__).with_name("small.mplstyle")


def colour(exponent: float) -> str:
    """Return the colour of an exponent, 0 for a standard solid."""
    return COLOURS[OF_EXPONENT[round(float(exponent), 3)]]


def marker(exponent: float) -> str:
    """Return the marker of an exponent, 0 for a standard solid."""
    return MARKERS[OF_EXPONENT[round(float(exponent), 3)]]


def words(exponent: float) -> str:
    """Return the name of a material by its exponent."""
    return f"$n$ = {exponent:g}" if exponent else "standard solid"


def panels(figure: Figure, rows: int, columns: int, **options: Any) -> list[Any]:
    """Return the axes of a grid, lettered where there are several."""
    axes = [ax for row in figure.subplots(rows, columns, squeeze=False, **options) for ax in row]
    if len(axes) > 1:
        for letter, ax in zip("abcdefgh", axes, strict=False):
            ax.set_title(f"({letter})", fontsize="medium")
    return axes


def decades(ax: Any, *, x: bool = True, y: bool = True) -> None:
    """Make axes logarithmic."""
    if x:
        ax.set_xscale("log")
    if y:
        ax.set_yscale("log")


def saved(
    draw: Callable[[Any, Figure], None],
    numbers: Any,
    path: Path,
    *,
    size: tuple[float, float],
    note: str = "",
    dpi: int = 150,
) -> Path:
    """Draw numbers into a file, with a note below the picture."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with matplotlib.style.context(["viscotack.plot.viscotack", _SMALL]):
        figure = Figure(figsize=size)
        draw(numbers, figure)
        if note:
            figure.supxlabel(note, fontsize=8.5, x=0.01, ha="left", color="0.35")
        figure.savefig(path, dpi=dpi)
    return path


def drawn_table(columns: list[str], rows: list[list[str]], figure: Figure) -> None:
    """Draw the columns and rows of a table."""
    ax = figure.subplots()
    ax.set_axis_off()
    table = ax.table(cellText=rows, colLabels=columns, loc="center")
    table.auto_set_font_size(False)
    table.set_fontsize(9.5)
    table.scale(1, 1.45)
    table.auto_set_column_width(list(range(len(columns))))
    for (row, _), cell in table.get_celld().items():
        cell.set_edgecolor("0.8")
        cell.visible_edges = "B" if row else "BT"
        if row == 0:
            cell.get_text().set_fontweight("bold")
