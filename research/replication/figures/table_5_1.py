"""Table 5.1: models of the pull-off force from the five inputs.

Claims: XGBoost is best, with R2 0.9988 and an error of 0.145 (in 1e-3 of log10 squared).

Needs: the shipped set of 8,505 detachments in place of the thesis's own; scikit-learn, XGBoost.

Costs: half a minute of processor time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..bench import Bench, Numbers
from .learned import as_text, of_table
from .tables import drawn

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIZE = (7.6, 2.2)


def numbers(bench: Bench) -> Numbers:
    """Return error and R2 of each model over five random folds, and the printed ones."""
    return of_table("5.1", bench.each)


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the table."""
    drawn(as_text(numbers), figure)
