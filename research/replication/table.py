"""Rows of simulated detachments from a file: those published by others, or of a campaign."""

import csv
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
    """Detachments of a sphere from a relaxed power-law solid, a row each, dimensionless.

    Attributes
    ----------
    tabor, modulus_ratio, exponent, preload, rate : ndarray, shape (n,)
        The five groups; preload is a depth [h0], rate a speed [h0/tau0], all positive.
    pull_off_force, work_to_pull_off : ndarray, shape (n,)
        [1.5 pi R dg0] and [1.5 pi R dg0 h0], positive.
    work_known : ndarray of bool, shape (n,)
        False in rows whose work is a placeholder.
    key_points : ndarray, shape (n, 6), or None
        Travel to the pull-off [h0], forces at 25, 50, 75, 87.5 and 100 % of it, compression
        positive; None where the file has none.
    """

    tabor: Array
    modulus_ratio: Array
    exponent: Array
    preload: Array
    rate: Array
    pull_off_force: Array
    work_to_pull_off: Array
    work_known: npt.NDArray[np.bool_]
    key_points: Array | None = None

    def __len__(self) -> int:
        return len(self.tabor)

    def chosen(self, rows: Any) -> "Detachments":
        """Return the rows of an index or a mask."""
        values: dict[str, Any] = {f.name: getattr(self, f.name) for f in fields(self)}
        some: dict[str, Any] = {k: None if v is None else v[rows] for k, v in values.items()}
        return Detachments(**some)


def read_detachments(path: str | os.PathLike[str]) -> Detachments:
    """Return the rows of a file.

    Parameters
    ----------
    path : path
        CSV, or Parquet by its ending, with the columns tabor, modulus_ratio, exponent, preload,
        rate, pull_off_force and work_to_pull_off as ``viscotack campaign export`` writes them; or
        CSV with those of the table that the authors of the thesis published (runload, alphaload,
        mu, k, n, outputAmplification, workofSepration). Other columns are left alone.

    Raises
    ------
    ValueError
        If there is no such file, columns are missing, or a number is not positive and finite, with
        its row.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(
            f"there is no file {path}; take the table that the authors of the thesis published, "
            "from Data_Files of https://github.com/alimaghamii/ML4Adh, or the sample of it, "
            f"{SAMPLE}"
        )
    columns = _parquet(path) if path.suffix == ".parquet" else _csv(path)
    if "outputAmplification" in columns:
        scaled = {name: (old, factor) for name, (old, factor) in _PUBLISHED.items()}
    else:
        scaled = {name: (name, 1.0) for name in _PUBLISHED}
    missing = [old for old, _ in scaled.values() if old not in columns]
    if missing:
        raise InputError(
            f"{path} has no column {', '.join(missing)}; it needs {', '.join(_PUBLISHED)}, or the "
            "columns of the published table"
        )
    values = {
        name: _numbers(path, old, columns[old], factor) for name, (old, factor) in scaled.items()
    }
    work = columns[scaled["work_to_pull_off"][0]]
    known = np.array([float(w) != _NO_WORK for w in work])
    points = None
    if all(name in columns for name in KEY_POINTS):
        force = -values["pull_off_force"]
        read = [_column(path, name, columns[name]) for name in KEY_POINTS]
        points = np.stack([*read, force], axis=1)
    return Detachments(**values, work_known=known, key_points=points)


def _csv(path: Path) -> dict[str, list[str]]:
    with open(path, newline="", encoding="utf-8-sig") as file:
        rows = list(csv.reader(file))
    if len(rows) < 2:
        raise InputError(f"{path} has no rows")
    width = len(rows[0])
    short = next((i for i, row in enumerate(rows) if len(row) != width), None)
    if short is not None:
        raise InputError(f"{path}, line {short + 1}: {len(rows[short])} values, expected {width}")
    return {name: [row[i] for row in rows[1:]] for i, name in enumerate(rows[0])}


def _parquet(path: Path) -> dict[str, list[Any]]:
    try:
        from pyarrow import parquet
    except ImportError:
        raise ModuleNotFoundError(
            f"reading {path} needs pyarrow; install it with pip install 'viscotack[campaign]'"
        ) from None
    table = parquet.ParquetFile(path).read()
    if not table.num_rows:
        raise InputError(f"{path} has no rows")
    return {name: table.column(name).to_pylist() for name in table.column_names}


def _column(path: Path, name: str, values: list[Any]) -> Array:
    found = np.empty(len(values))
    for i, value in enumerate(values):
        try:
            found[i] = float(value)
        except (TypeError, ValueError):
            raise InputError(f"{path}, row {i + 1}: {name} is {value!r}, not a number") from None
    return found


def _numbers(path: Path, name: str, values: list[Any], factor: float) -> Array:
    found = factor * _column(path, name, values)
    wrong = np.flatnonzero(~(np.isfinite(found) & (found > 0)))
    if wrong.size:
        raise InputError(
            f"{path}: {name} must be {'negative' if factor < 0 else 'positive'} and finite, for "
            f"its logarithm is learned; {wrong.size} rows are not, the first is row {wrong[0] + 1} "
            f"with {values[wrong[0]]!r}; leave them out"
        )
    return found
