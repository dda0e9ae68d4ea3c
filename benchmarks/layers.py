"""What a layer costs beside the half-space: processor time in pairs, the least of a few runs.

`python benchmarks/layers.py [--repeat 3]`: a sphere to the pull-off with its error estimate,
elastic and relaxing, at three Tabor numbers. `first` is the first run on this layer: the first on a
base tabulates its kernel.
"""

from __future__ import annotations

import os

for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")

import argparse  # noqa: E402
from dataclasses import replace  # noqa: E402
from time import process_time  # noqa: E402

import numpy as np  # noqa: E402

import viscotack as vt  # noqa: E402
from viscotack import Bonded, Frictionless, Layer  # noqa: E402

MOST = 2.0
BASES = (Frictionless(), *(Bonded(poisson_ratio=nu) for nu in (0.0, 0.3, 0.45, 0.49)))
THICKNESSES = (3.0, 1.0, 0.3)
ELASTIC = vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
RELAXING = vt.StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
CASES = [
    vt.Groups(1.0, ELASTIC, vt.AtForce(1.0), 1.0),
    vt.Groups(3.0, RELAXING, vt.AtForce(1.0), 3.0),
    vt.Groups(8.0, RELAXING, vt.AtForce(1.0), 10.0),
]


def timed(groups: vt.Groups) -> tuple[float, int]:
    """Return the processor time [s] and the steps of a run."""
    began = process_time()
    result = vt.solve(groups, until="pull-off")
    return process_time() - began, int(result.statistics["steps"])


def main() -> None:
    """Print times and their ratios."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--repeat", type=int, default=3)
    repeat = options.parse_args().repeat
    ratios, firsts = [], []
    for base in BASES:
        for thickness in THICKNESSES:
            for case in CASES:
                film = replace(case, body=Layer(thickness, base))
                runs = [(timed(case), timed(film)) for _ in range(repeat)]
                half_space, layer = (min(pair[i][0] for pair in runs) for i in (0, 1))
                ratios.append(layer / half_space)
                firsts.append(runs[0][1][0] / half_space)
                print(
                    f"{base!r} b {thickness:g} mu {case.tabor:g} k {case.modulus_ratio:g}: "
                    f"{layer:.2f} s, {runs[0][1][1]} steps; half-space {half_space:.2f} s, "
                    f"{runs[0][0][1]} steps; ratio {ratios[-1]:.2f}, first {firsts[-1]:.2f}",
                    flush=True,
                )
    print(
        f"layer over half-space: median {np.median(ratios):.2f}, at most {max(ratios):.2f} "
        f"(asked: {MOST:g}); first run {np.median(firsts):.2f}, at most {max(firsts):.2f}"
    )


if __name__ == "__main__":
    main()
