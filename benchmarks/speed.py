"""How much faster than the published algorithm, at no less accuracy, in one run on one machine.

`python benchmarks/speed.py`: each case by the plain twin and by the simulation, in turn; the error
of both is measured against a converged simulation. About two minutes.
"""

from __future__ import annotations

from time import perf_counter

import numpy as np
from cases import case
from threadpoolctl import threadpool_limits

from viscotack import pull_off_force, solve
from viscotack.bem.plain import plain_solve

# case, last depth of the twin's equal steps
CASES = [
    (case(3.24, 0.1, 0.8, 73.0, 10**2.5), 49.0),
    (case(3.24, 0.1, 0.8, 16.7, 10**0.5), -4.0),
    (case(1.0, 0.01, 0.4, 20.0, 1e3), 15.0),
    (case(0.3, 0.1, 0.6, 10.0, 1e4), 7.5),
    (case(1.0, 0.1, 0.2, 20.0, 1e5), 12.0),
    (case(3.24, 0.1, 1.6, 30.0, 1e2), 20.0),
]
# The thesis takes 500 nodes; with 1,000 steps its error here is a few tenths of a per cent.
NODES, STEPS = 500, 1000


def timed(work, repeat: int = 1):
    """Return the result and the shortest time of a few calls."""
    times = []
    for _ in range(repeat):
        began = perf_counter()
        answer = work()
        times.append(perf_counter() - began)
    return answer, min(times)


def main() -> None:
    """Run and print."""
    ratios, ratios_with = [], []
    with threadpool_limits(limits=1, user_api="blas"):
        for groups, last in CASES:
            depth = groups.start.depth
            outer = float(np.sqrt(2 * (50 + depth) / groups.tabor))
            best = pull_off_force(
                solve(groups, accuracy=1e-4, until="pull-off", estimate_error=False)
            )
            fast, seconds = timed(
                lambda g=groups: solve(g, until="pull-off", estimate_error=False), repeat=3
            )
            _, seconds_with = timed(lambda g=groups: solve(g, until="pull-off"), repeat=3)
            plain, plain_seconds = timed(
                lambda g=groups, o=outer, b=last: plain_solve(
                    g, nodes=NODES, outer_radius=o, steps=STEPS, last_depth=b
                )
            )
            ratios.append(plain_seconds / seconds)
            ratios_with.append(plain_seconds / seconds_with)
            print(
                f"mu {groups.tabor:g}, n {groups.material.exponent:g}, k {groups.modulus_ratio:g}, "
                f"depth {depth:g}, rate {groups.rate:.4g}: plain {plain_seconds:.1f} s, off by "
                f"{100 * (pull_off_force(plain) / best - 1):+.3f} %; here {seconds:.3f} s, off by "
                f"{100 * (pull_off_force(fast) / best - 1):+.3f} %; {ratios[-1]:.0f} times faster "
                f"({ratios_with[-1]:.0f} with the error estimate)",
                flush=True,
            )
    print(
        f"times faster, median        {np.median(ratios):.0f} "
        f"({np.median(ratios_with):.0f} with the error estimate), least {min(ratios):.0f}"
    )


if __name__ == "__main__":
    main()
