"""What all figures share: style, axes with SI prefixes, and writing to a file.

No window is opened, and the global state of matplotlib is unchanged.
"""

import io
import os
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.whole import write_whole
from viscotack.units import prefixed

if TYPE_CHECKING:
    from matplotlib.axes import Axes
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


def axis_unit(values: npt.ArrayLike, unit: str) -> tuple[float, str]:
    """Return the SI unit with the prefix for an axis of these values: its size, and its name."""
    factor, name = prefixed(float(np.nanmax(np.abs(values), initial=0.0)), unit)
    return factor, name.replace("u", "µ")


def log_axis_unit(values: npt.ArrayLike, unit: str) -> tuple[float, str]:
    """Return the same for a logarithmic axis, by the middle of its positive values."""
    x = np.asarray(values, dtype=float)
    x = x[x > 0]
    return axis_unit(float(np.sqrt(x.min() * x.max())) if x.size else 1.0, unit)


def plain_ticks(axes: "Axes") -> None:
    """Label logarithmic axes, whose data are drawn, by plain numbers instead of powers of ten."""
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter

    for axis in (axes.xaxis, axes.yaxis):
        if axis.get_scale() != "log":
            continue
        low, high = axis.get_view_interval()
        if high > 10 * low:
            subs = (1.0,) if high > 100 * low else (1.0, 2.0, 5.0)
            axis.set_major_locator(LogLocator(subs=subs))
        else:
            axis.set_major_locator(MaxNLocator(5))
        axis.set_major_formatter(StrMethodFormatter("{x:.6g}"))
        axis.set_minor_formatter(NullFormatter())


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
