"""The PDMS study of the thesis, from its printed constants and fits: which ranges, and why two.

    python benchmarks/pdms_study.py [--record]

Sec. 4.6 found a Tabor number of 2.05 (a range of 1.55 um) from force against contact radius at
0.98 um/s, and 30.8 nm from the rate series. The measured forces are those of the printed fit,
Eq. 4.28; the slow test is computed, as its points were not published. Takes a minute.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

from viscotack.identify import PullOff, forecast_rates, identify_rates
from viscotack.lab.tack import Measured
from viscotack.materials.library import published

sys.path.insert(0, str(Path(__file__).parent))
from slow_test_error import read_as_slow, told  # noqa: E402, a script beside this one

RADIUS, WORK, PRELOAD = 5.19e-3, 0.1523, 1.5e-3
SPEEDS = np.array([1.0, 10.0, 100.0, 1000.0]) * 1e-6
MEASURED = np.array([4.33, 5.57, 9.39, 21.1]) * 1e-3
LINEAR = np.array([4.26, 5.24, 7.56, 10.9]) * 1e-3
PART = 0.03  # of each force, that its mean is not known


def series(force, count):
    """Return the first pull-offs of a row."""
    return [
        PullOff(float(v), Measured(float(P), PART * float(P)), PRELOAD)
        for v, P in zip(SPEEDS[:count], force, strict=False)
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--record", action="store_true", help="record the table of the page")
    recorded = parser.parse_args().record
    passport = published("pdms-10-1")
    slow = (WORK, 0.02 * WORK)
    lines = [
        "| speeds used | range found (90 %) | fitted at 1, 10, 100, 1000 um/s, mN "
        "| residuals over uncertainty |",
        "|---|---|---|---|",
    ]
    for words, force, count, known in (
        ("measured, to 10 um/s", MEASURED, 2, slow),
        ("measured, to 100 um/s", MEASURED, 3, slow),
        ("measured, to 1000 um/s", MEASURED, 4, slow),
        ("measured, to 1000 um/s, work free", MEASURED, 4, None),
        ("linear theory of the thesis", LINEAR, 4, slow),
    ):
        fit = identify_rates(
            series(force, count), material=passport, radius=RADIUS, work_of_adhesion=known
        )
        print(f"{words}: residuals {fit.scatter:.2g} of their uncertainty")
        print("   fitted " + ", ".join(f"{1e3 * P:.2f}" for P in fit.forces) + " mN")
        for sentence in fit.words:
            print(f"   {sentence}")
        forces = ", ".join(f"{1e3 * P:.3g}" for P in fit.forces)
        if count == 2:
            ahead = forecast_rates(fit, SPEEDS[2:])
            ends = zip(ahead.low, ahead.high, strict=True)
            for v, P, (low, high) in zip(ahead.speed, ahead.force, ends, strict=True):
                band = f"{1e3 * P:.1f} ({1e3 * low:.1f} to {1e3 * high:.1f}) mN"
                print(f"   forecast {1e6 * v:.0f} um/s: {band}")
                forces += f"; forecast {band.removesuffix(' mN')}"
        if known is not None:
            name = {2: "1 and 10", 3: "1 to 100", 4: "1 to 1000"}[count] + " um/s"
            name = name if force is MEASURED else "the thesis's own linear curve"
            gap, ends = fit.equilibrium_gap, fit.intervals["equilibrium_gap"]
            span = f"{gap * 1e9:.0f} nm ({ends.low * 1e9:.0f} to {ends.high * 1e9:.0f})"
            lines.append(f"| {name} | {span} | {forces} | {fit.scatter:.2g} |")
    if recorded:
        print(json.dumps({"table": lines}, indent=1))
    for speed in (1e-9, 0.98e-6):
        tabor, fit = read_as_slow(speed, models=("maugis", "carpick"))
        read = "; ".join(f"{one.model} {told(one)}" for one in fit.fits)
        print(f"{1e6 * speed:.3g} um/s, Tabor number {tabor:.3g}, fitted as elastic: {read}")


if __name__ == "__main__":
    main()
