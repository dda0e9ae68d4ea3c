"""Rows of simulated detachments from a file: those published by others, or of a campaign."""

import os
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack import InputError

Array = npt.NDArray[np.float64]

# A sample of the table that the authors of the thesis published; tests/data/README.md says of it.
SAMPLE = Path(__file__).resolve().parents[2] / "tests/data/sphere_bem_published/rows.csv"

# Column here -> column of the published table, and the factor that makes ours of theirs. Their rate
# counts retraction negative, their work is in pi R dg0 h0.
_PUBLISHED = {
    "tabor": ("mu", 1.0),
    "modulus_ratio": ("k", 1.0),
    "exponent": ("n", 1.0),
    "preload": ("alphaload", 1.0),
    "rate": ("runload", -1.0),
    "pull_off_force": ("outputAmplification", 1.0),
    "work_to_pull_off": ("workofSepration", 1 / 1.5),
}
# What the published table holds where no work was found.
_NO_WORK = 0.01
# Along the retraction; the last is minus the pull-off force.
KEY_POINTS = ("travel_to_pull_off", "force_at_25", "force_at_50", "force_at_75", "force_at_87_5")


@dataclass(frozen=True, eq=False)
class Detachments:
    """Detachments of a sphere from a relaxed power-law solid, a row each, dimensionless."""

    tabor: Array
    modulus_ratio: Array
    exponent: Array
    preload: Array  # depth [h0]
    rate: Array  # speed of the retraction [h0/tau0], positive
    pull_off_force: Array  # [1.5 pi R dg0]
    work_to_pull_off: Array  # [1.5 pi R dg0 h0]
    work_known: npt.NDArray[np.bool_]  # False in rows whose work is a placeholder
    # Travel to the pull-off [h0], forces at 25, 50, 75, 87.5 and 100 % of it, compression positive,
    # shape (n, 6); None where the file has none.
    key_points: Array | None = None

    def __len__(self) -> int:
        return len(self.tabor)

    def chosen(self, rows: Any) -> "Detachments":
        """Return the rows of an index or a mask."""
        values: dict[str, Any] = {f.name: getattr(self, f.name) for f in fields(self)}
        some: dict[str, Any] = {k: None if v is None else v[rows] for k, v in values.items()}
        return Detachments(**some)


def read_detachments(path: str | os.PathLike[str]) -> Detachments:
    """Return the rows of a file, CSV, or Parquet by its ending.

    Its columns are tabor, modulus_ratio, exponent, preload, rate, pull_off_force and
    work_to_pull_off as ``viscotack campaign export`` writes them, or those of the table that the
    authors of the thesis published. Other columns are left alone. A missing column and a number
    that has no logarithm are refused, by its row.
    """
    from pyarrow import csv, parquet

    read = parquet.read_table if Path(path).suffix == ".parquet" else csv.read_csv
    table = read(os.fspath(path))
    published = "outputAmplification" in table.column_names
    values = {}
    for name, (old, factor) in _PUBLISHED.items():
        column, factor = (old, factor) if published else (name, 1.0)
        if column not in table.column_names:
            raise InputError(f"{path} has no column {column}")
        values[name] = factor * table.column(column).to_numpy().astype(float)
        wrong = np.flatnonzero(~(np.isfinite(values[name]) & (values[name] > 0)))
        if wrong.size:
            raise InputError(
                f"{path}, row {wrong[0] + 1}: {column} has no logarithm, which is learned; leave "
                f"such rows out ({wrong.size})"
            )
    work = table.column("workofSepration" if published else "work_to_pull_off").to_numpy()
    points = None
    if all(name in table.column_names for name in KEY_POINTS):
        read_points = [table.column(name).to_numpy().astype(float) for name in KEY_POINTS]
        points = np.stack([*read_points, -values["pull_off_force"]], axis=1)
    return Detachments(**values, work_known=work != _NO_WORK, key_points=points)
