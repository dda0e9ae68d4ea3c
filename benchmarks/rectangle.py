"""Compare the bounds of rectangular punches with contacts that open cell by cell.

    python benchmarks/rectangle.py --cells 24 --ratios 1 2 4
    python benchmarks/rectangle.py --record

The contact of a rigid flat punch on a half-space is divided into square cells of even pressure. At
a depth the cell that releases most energy opens as soon as this exceeds its work of adhesion, and
the depth grows until another one does. Cells overestimate the work of an edge by a factor that a
disc of as many cells shows; forces are divided by its root.
"""

import argparse

import numpy as np
import records

from viscotack.theory.elastic.disc import pull_off_force
from viscotack.theory.punch.rectangle import bounds

_SOLID = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}


def compliance(x, y, h):
    """Return the displacements of cells of side h by unit forces, E* = 1 (Love 1929)."""
    dx, dy = x[:, None] - x[None], y[:, None] - y[None]
    total = 0.0
    for sx in (-1, 1):
        for sy in (-1, 1):
            u, v = dx + sx * h / 2, dy + sy * h / 2
            total = total + sx * sy * (
                u * np.arcsinh(v / np.abs(u)) + v * np.arcsinh(u / np.abs(v))
            )
    return total / (np.pi * h**2)


def pulled(x, y, h):
    """Return the largest tension of the cells at x and y, E* = work of adhesion = 1."""
    M, live = np.linalg.inv(compliance(x, y, h)), np.ones(x.size, dtype=bool)
    most, depth = 0.0, 0.0
    while live.any():
        own, even = np.diag(M)[live], M.sum(axis=1)[live]
        critical = h * np.sqrt(2 * own) / np.abs(even)
        depth = max(depth, critical.min())
        most = max(most, depth * even.sum())
        i = np.flatnonzero(live)[np.argmin(critical)]
        M = M - np.outer(M[:, i], M[i]) / M[i, i]
        live[i] = False
        M[i], M[:, i] = 0.0, 0.0
    return most


def cells(wide, long):
    """Return the places of cells of side 1 in a rectangle centred at 0."""
    x, y = np.meshgrid(np.arange(long) - (long - 1) / 2, np.arange(wide) - (wide - 1) / 2)
    return x.ravel(), y.ravel()


def main():
    """Print bounds and computed forces over those of the disc of the same width."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--cells", type=int, default=24)
    options.add_argument("--ratios", type=float, nargs="+", default=[1.0, 2.0, 4.0])
    options.add_argument("--record", action="store_true", help="record the table of the page")
    given = options.parse_args()
    if given.record:
        record()
    else:
        compare(given.cells, given.ratios)


def record():
    """Record bounds and forces by the fineness of the cells, for the pages."""
    several = {count: compare(count, [1.0, 2.0, 4.0]) for count in (12, 20)}
    heads = " | ".join(f"{count} cells across" for count in several)
    lines = [f"| ratio of the sides | bounds | {heads} |", "|---" * (2 + len(several)) + "|"]
    for ratio in (1.0, 2.0, 4.0):
        low, high, _ = several[12][ratio]
        forces = " | ".join(f"{found[ratio][2]:.3f}" for found in several.values())
        lines.append(f"| {ratio:g} | {low:.3f} to {high:.3f} | {forces} |")
    records.write("rectangle", {"table": lines})


def compare(n, ratios):
    """Print bounds and computed force by the ratio of the sides, and return them."""
    several = {}
    x, y = cells(n, n)
    inside = np.hypot(x, y) < n / 2
    radius = np.sqrt(inside.sum() / np.pi)
    round_ = pulled(x[inside], y[inside], 1.0)
    scale = round_ / pull_off_force(contact_radius=radius, **_SOLID)
    print(f"disc of {inside.sum()} cells: {scale:.3f} of Kendall's force")
    for ratio in ratios:
        long = round(ratio * n)
        one = pull_off_force(contact_radius=n / 2, **_SOLID)
        low, high = (P / one for P in bounds(long / 2, half_width=n / 2, **_SOLID))
        found = pulled(*cells(n, long), 1.0) / scale / one
        print(f"{long / n:.3g} : 1  between {low:.3f} and {high:.3f}, computed {found:.3f}")
        several[ratio] = (low, high, found)
    return several


if __name__ == "__main__":
    main()
