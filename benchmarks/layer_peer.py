"""A bonded layer of Poisson ratio 0.49 beside the independent code of `tests/hankel_layer.py`.

`python benchmarks/layer_peer.py` prints pull-off forces of spheres, elastic and relaxing, and of
discs, and the stiffness of a disc, of both codes. Some two minutes.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

import viscotack as vt
from viscotack.theory.elastic import on_layer

sys.path.append(str(Path(__file__).parents[1] / "tests"))
import hankel_layer as peer  # noqa: E402

BASE = vt.Bonded(poisson_ratio=0.49)
ACCURACY, SPACING, RINGS = 5e-4, 0.02, 400
# Tabor number, thickness, modulus ratio, rate
SPHERES = [
    (tabor, thickness, ratio, rate)
    for tabor in (1.0, 3.0)
    for thickness in (0.1, 0.3, 1.0, 3.0)
    for ratio, rate in ((1.0, 1.0), (0.1, 1.0), (0.1, 30.0))
]
DISCS = [(tabor, thickness) for tabor in (1.0, 3.0) for thickness in (0.1, 0.5, 2.0)]


def here(tabor: float, thickness: float, ratio: float, rate: float, shape: Any) -> float:
    """Return the pull-off force by the package."""
    solid = vt.StandardSolid(
        rubbery_modulus=1.0, glassy_modulus=1 / ratio, tau0=1.0, poisson_ratio=0.0
    )
    start = vt.AtDepth(1.0 if isinstance(shape, vt.Sphere) else 0.0)
    body = vt.Layer(thickness, BASE)
    groups = vt.Groups(tabor, solid, start, rate, geometry=shape, body=body)
    result = vt.solve(groups, until="pull-off", accuracy=ACCURACY, estimate_error=False)
    return vt.pull_off_force(result)


def main() -> None:
    """Print both codes and their differences."""
    off = []

    def show(words: str, found: float, other: float) -> None:
        off.append(abs(found / other - 1))
        print(f"{words}: {found:.5f}, other code {other:.5f}, apart {off[-1]:.1e}", flush=True)

    for tabor, thickness, ratio, rate in SPHERES:
        travel = 0.02 * (1 + tabor * min(1.0, thickness))
        curve = peer.sphere(tabor, thickness, ratio, rate, spacing=SPACING, travel=travel)
        words = f"sphere mu {tabor:g} b {thickness:g} k {ratio:g} rate {rate:g}"
        found = here(tabor, thickness, ratio, rate, vt.Sphere(1.0))
        show(words, found, peer.pull_off(*curve))
    for tabor, thickness in DISCS:
        curve = peer.disc(tabor, thickness, rings=RINGS, travel=0.02)
        found = here(tabor, thickness, 1.0, 1.0, vt.Disc(1.0))
        show(f"disc mu {tabor:g} b {thickness:g}", found, peer.pull_off(*curve))
    for thickness in (0.1, 0.5, 2.0):
        coarse, fine = (peer.disc_stiffness(thickness, rings) for rings in (RINGS // 2, RINGS))
        found = float(on_layer.stiffness(np.array([1.0]), vt.Layer(thickness, BASE))[0])
        show(f"stiffness of a disc, b {thickness:g}", found, 2 * fine - coarse)
    print(
        f"{len(off)} figures, apart by {np.median(off):.1e} in the median, {max(off):.1e} at most"
    )


if __name__ == "__main__":
    main()
