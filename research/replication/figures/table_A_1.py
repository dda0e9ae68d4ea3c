"""Table A.1: how the inputs of the data set are spread.

Claims: mean, median, standard deviation and range of the five inputs of 8,505 rows.

Seen: The shipped set has the mean, the spread and the range of the thesis's.

Needs: the shipped set, whose inputs were drawn to have these statistics.

Costs: a second.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from ..learning.features import inputs
from ..learning.thesis import STATISTICS
from .learned import rows
from .style import drawn_table

SIZE = (8.6, 2.4)
_WORDS = ("mean", "median", "st. dev.", "min", "max")


def numbers(bench: Bench) -> Numbers:
    """Return five statistics of five inputs, here and printed."""
    found: Numbers = {"rows": len(rows())}
    for name, v in zip(STATISTICS, inputs(rows()).T, strict=True):
        here = [v.mean(), np.median(v), v.std(ddof=1), v.min(), v.max()]
        found[name] = {"here": here, "thesis": list(STATISTICS[name])}
    return found


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the table, each entry ours / the thesis's."""
    names = [name for name in numbers if name != "rows"]
    table = {
        "columns": ["ours / thesis", *names],
        "rows": [
            [word, *(f"{numbers[n]['here'][i]:.4g} / {numbers[n]['thesis'][i]:.4g}" for n in names)]
            for i, word in enumerate(_WORDS)
        ],
    }
    drawn_table(table["columns"], table["rows"], figure)
