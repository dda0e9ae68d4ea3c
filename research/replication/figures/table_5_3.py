"""Table 5.3: models of the work to pull-off from the five inputs.

Claims: the forest is best, with R2 0.9945.

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
    return of_table("5.3", bench.each)


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the table."""
    drawn(as_text(numbers), figure)
