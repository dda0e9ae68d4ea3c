"""Rows to test with: made ones, in memory and in a file."""

import csv

import numpy as np

from research.replication.learning.features import Descriptor, crack_amplification
from research.replication.table import KEY_POINTS, Detachments


def made_rows(count=120, seed=0, *, noise=0.0, points=False):
    """Return rows whose force follows the analytic crack and a power of the preload."""
    rng = np.random.default_rng(seed)
    columns = {
        "tabor": rng.choice([1.0, 3.24], count),
        "modulus_ratio": rng.choice([0.1, 0.3], count),
        "exponent": rng.choice([0.6, 1.6], count),
        "preload": 10 ** rng.uniform(-1, 2, count),
        "rate": 10 ** rng.uniform(-1, 8, count),
        "pull_off_force": np.ones(count),
        "work_to_pull_off": np.ones(count),
        "work_known": np.ones(count, dtype=bool),
    }
    rows = Detachments(**columns)
    force = crack_amplification(rows, Descriptor.OWN_TABOR) * rows.preload**0.05
    force = force * 10 ** rng.normal(0, noise, count)
    columns |= {"pull_off_force": force, "work_to_pull_off": force * rows.tabor}
    if points:
        shares = np.array([0.2, 0.5, 0.8, 0.95, 1.0])
        travel = rows.preload + force
        columns["key_points"] = np.column_stack([travel, -force[:, None] * shares])
    return Detachments(**columns)


def write_rows(path, rows):
    names = ("tabor", "modulus_ratio", "exponent", "preload", "rate")
    names += ("pull_off_force", "work_to_pull_off")
    columns = {name: getattr(rows, name) for name in names}
    if rows.key_points is not None:
        columns |= dict(zip(KEY_POINTS, rows.key_points.T, strict=False))
    columns["versions"] = ["viscotack, and what it stands on"] * len(rows)
    with open(path, "w", newline="") as file:
        lines = csv.writer(file)
        lines.writerow(columns)
        lines.writerows(zip(*columns.values(), strict=True))
    return path
