"""What all figures share: style, axes with SI prefixes, and writing to a file.

No window is opened, and the global state of matplotlib is unchanged.
"""

import io
import os
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from math import sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Any

from viscotack.errors import InputError
from viscotack.files.whole import write_whole
from viscotack.model.problem.outputs import Series
from viscotack.units import prefixed, readable

if TYPE_CHECKING:
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

# Blue and orange of lines that mean one thing in several figures: force and load, hold and release.
BLUE, ORANGE = "#08519c", "#d94801"


def style(**settings: Any) -> AbstractContextManager[Any]:
    """Return the style of the package, changed by settings, as a context."""
    import matplotlib.style

    return matplotlib.style.context([Path(__file__).with_name("viscotack.mplstyle"), settings])


@contextmanager
def drawing(width: float = 7.2, height: float = 5.0, **settings: Any) -> Iterator["Figure"]:
    """Enter the style of the package with a new figure of a size [inch]."""
    from matplotlib.figure import Figure

    with style(**settings):
        yield Figure(figsize=(width, height))


def label_in_si(axis: "Axis", words: str, unit: str) -> float:
    """Label an axis whose data are in SI and drawn by words and the unit with its prefix.

    Ticks are plain numbers in that unit, also on a logarithmic axis. Returns the size of the unit.
    """
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

    low, high = sorted(axis.get_view_interval())
    is_log = axis.get_scale() == "log"
    size, name = prefixed(sqrt(low * high) if is_log else max(abs(low), abs(high)), unit)
    if is_log and high > 10 * low:
        axis.set_major_locator(LogLocator(subs=(1.0,) if high > 100 * low else (1.0, 2.0, 5.0)))
    elif is_log:
        axis.set_major_locator(MaxNLocator(5))
    axis.set_minor_formatter(NullFormatter())
    axis.set_major_formatter(lambda x, _: f"{x / size:.6g}".replace("-", "\N{MINUS SIGN}"))
    axis.set_label_text(f"{words} [{name.replace('u', 'µ').replace('^2', '$^2$')}]")
    return size


def label_of(axis: "Axis", series: Series, in_si: bool) -> None:
    """Label an axis by the words of a series, with its unit in SI or that of its groups."""
    if in_si:
        label_in_si(axis, series.words, series.unit.si)
    else:
        axis.set_label_text(f"{series.words} / {series.unit.drawn}")


def said(value: float, unit: str) -> str:
    """Return a quantity in SI with three digits, such as "1.33 µm/s"."""
    return readable(value, unit, digits=3).replace(" u", " µ")


def save_figure(figure: "Figure", path: str | os.PathLike[str]) -> None:
    """Write a figure to a file, complete or not at all.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    path : path
        File name; its ending chooses the format: .png, .pdf or .svg.

    Raises
    ------
    ValueError
        If the ending is not a known format.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> import os, tempfile
    >>> from matplotlib.figure import Figure
    >>> figure = Figure()
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_figure(figure, os.path.join(folder, "forces.svg"))
    ...     os.listdir(folder)
    ['forces.svg']
    """
    check_format(path)
    content = io.BytesIO()
    with style():
        figure.savefig(content, format=Path(path).suffix.lstrip(".").lower())
    write_whole(path, content.getvalue())


def check_format(path: str | os.PathLike[str]) -> None:
    """Raise ValueError unless figures can be written in the format of this file name."""
    from matplotlib.backend_bases import FigureCanvasBase

    known = FigureCanvasBase.get_supported_filetypes()
    if Path(path).suffix.lstrip(".").lower() not in known:
        raise InputError(
            f"cannot draw to {os.fspath(path)!r}: the file name must end in one of "
            f"{', '.join(sorted(known))}"
        )
