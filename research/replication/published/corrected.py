"""The corrected table: inputs of published rows, both values, our errors, and the difference."""

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from viscotack.campaign import CaseSettings

from ..table import Detachments
from .compare import CONVERGED, INPUTS, Row, inputs_of

COLUMNS = (
    *INPUTS,
    *("published_force", "force", "force_error", "force_difference"),
    *("published_work", "work", "work_error", "work_difference", "accuracy"),
)


def write_corrected(rows: Sequence[Row], sample: Detachments, path: Path) -> None:
    """Write a line of a CSV for each row that is in the sample or apart.

    Force in 1.5 pi R dg0, work in 1.5 pi R dg0 h0; errors are the solver's estimates, relative, and
    differences the published value over ours, less one. Rows that are apart have the values of
    their converged run. An empty cell: the published table has no work there, or we state none.
    """
    wanted = set(zip(*(getattr(sample, name).tolist() for name in INPUTS), strict=True))
    with path.open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(COLUMNS)
        for row in rows:
            if "best" not in row and inputs_of(row) not in wanted:
                continue
            ours = row.get("best", row["ours"])
            force, work = ours["pull_off_force"], ours["work_to_pull_off"]
            known = np.isfinite(row["work_difference"])
            numbers = (
                *(row["force"], force, ours["error_estimate"], row["force"] / force - 1),
                *(row["work"] if known else None, work, ours["error_estimate_work"]),
                *(row["work"] / work - 1 if known else None,),
                CONVERGED if "best" in row else CaseSettings.accuracy,
            )
            inputs = [f"{row[name]:.10g}" for name in INPUTS]
            out.writerow([*inputs, *("" if x is None else f"{x:.6g}" for x in numbers)])
