"""How far rows with the same inputs disagree: no model can be judged below that."""

from typing import Any

import numpy as np

from ..table import Array, Detachments
from .features import Target, target
from .splits import same_input
from .validation import work_rows


def label_noise(rows: Detachments, which: Target) -> dict[str, Any]:
    """Return the floor that repeated inputs set.

    Returns
    -------
    dict
        ``floor_mse_1e-3``: variance of the log10 among rows of the same input, pooled without
        bias, what a perfect model would be charged on held-out rows; ``floor_r2`` that of all
        rows; ``spread_median``, ``spread_95``, ``spread_worst``: greatest over least of an input,
        less 1; how many inputs repeat and the share of rows among them. None instead of numbers
        where nothing repeats.
    """
    known = rows.chosen(work_rows(rows, which))
    y, group = target(known, which), same_input(known)
    counts = np.bincount(group)
    repeated = counts > 1
    found: dict[str, Any] = {
        "rows": len(known),
        "inputs": int(len(counts)),
        "repeated_inputs": int(repeated.sum()),
        "share_of_rows_repeated": float(counts[repeated].sum() / len(known)),
    }
    if not repeated.any():
        return found | dict.fromkeys(
            ("floor_mse_1e-3", "floor_r2", "spread_median", "spread_95", "spread_worst")
        )
    mean = np.bincount(group, y) / counts
    within = float(np.sum((y - mean[group]) ** 2) / np.sum(counts[repeated] - 1))
    spread = (
        10 ** (_by_group(np.maximum, y, group, -np.inf) - _by_group(np.minimum, y, group, np.inf))
        - 1
    )
    median, high = np.quantile(spread[repeated], (0.5, 0.95))
    return found | {
        "floor_mse_1e-3": 1e3 * within,
        "floor_r2": 1 - within / float(np.var(y)),
        "spread_median": float(median),
        "spread_95": float(high),
        "spread_worst": float(spread.max()),
    }


def _by_group(reduce: np.ufunc, y: Array, group: Any, start: float) -> Array:
    found = np.full(group.max() + 1, start)
    reduce.at(found, group, y)
    return found
