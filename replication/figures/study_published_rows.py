"""Tables 5.1 to 5.4 from the authors' own rows, and what the models are worth on new materials.

Claims: those of Tables 5.1 to 5.4: 60.3 % less error by the descriptor, R2 up to 0.9995.

Needs: the whole published table, given by --table; without it the kept numbers stand, of 6,430
rows.

Costs: 30 models and ten by modulus ratio, three minutes of processor time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from viscotack import InputError

from ..bench import Bench, Numbers
from ..learning.features import Descriptor, Target
from ..learning.learners import BOOSTING, FOREST
from ..learning.splits import random_split, value_split
from ..learning.tables import repeated_reduction
from ..learning.thesis import TABLES
from ..learning.validation import Trial, score
from ..table import read_detachments
from .learned import SEED, scored
from .style import COLOURS, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NEEDS_TABLE = True
SIZE = (9.0, 3.8)


def numbers(bench: Bench) -> Numbers:
    """Return the entries of the four tables beside the printed ones, and R2 by new k."""
    if bench.table is None:
        raise InputError("this needs the whole published table: give its path by --table")
    rows = read_detachments(bench.table)
    found: Numbers = {"rows": len(rows)}
    for table in TABLES:
        scores = [scored(rows, table.number, name) for name in table.entries]
        printed = table.entries.values()
        found[table.number] = {
            "model": list(table.entries),
            "mse": [1e3 * float(s.mse.mean()) for s in scores],
            "r2": [float(s.r2.mean()) for s in scores],
            "within": [
                abs(1e3 * float(s.mse.mean()) - e.mse) <= e.mse_spread
                for s, e in zip(scores, printed, strict=True)
            ],
            "thesis_mse": [e.mse for e in printed],
            "thesis_spread": [e.mse_spread for e in printed],
        }
    again = repeated_reduction(rows, seed=SEED, jobs=1, quick=False)
    found["reduction"] = again["reduction_best_over_best"]
    for words, split in (
        ("random", random_split(len(rows), SEED)),
        ("new_k", value_split("k", rows.modulus_ratio)),
    ):
        found[words] = [
            score(rows, Trial(Target.FORCE, descriptor, learner), split, seed=SEED).pooled_r2
            for descriptor, learner in ((Descriptor.NONE, BOOSTING), (Descriptor.PUBLISHED, FOREST))
        ]
    return found


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the errors of the four tables, here and printed."""
    for ax, target, some in zip(
        panels(figure, 1, 2), ("force", "work"), (("5.1", "5.2"), ("5.3", "5.4")), strict=True
    ):
        models = numbers[some[0]]["model"]
        for i, number in enumerate(some):
            of = numbers[number]
            # the tables have their models in different orders
            order = [of["model"].index(name) for name in models]
            x = np.arange(len(models)) + 0.15 * (2 * i - 1)
            style = {"color": COLOURS[i], "capsize": 3, "ls": "", "marker": "s", "mfc": "none"}
            printed = of["thesis_mse"][order], of["thesis_spread"][order]
            ax.errorbar(x, *printed, **style, label=f"Table {number}")
            label = f"{numbers['rows']:.0f} of its rows"
            ax.plot(x, of["mse"][order], "o", color=COLOURS[i], label=label)
        ax.set_xticks(np.arange(len(models)), [name.replace(" ", "\n") for name in models])
        ax.set_yscale("log")
        ax.set_ylabel(f"mean square error of the {target} [1e-3]")
        ax.legend()
