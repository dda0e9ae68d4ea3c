"""Measure how often the region of work and range from repeated tests holds the truth.

    python benchmarks/repeats.py [--count 60] [--tests 2]

A standard solid and an interface are pulled at six speeds over three decades, by the forward model;
each force is the mean of a few tests that scatter by 3 %. The interface is identified twice: with
one scatter pooled over the speeds, and with the standard error of the tests of each speed alone.
Printed are the shares of 90 % regions of work and range that hold the truth, and of 90 % bands of
forecasts at three times the fastest speed.
"""

import argparse

import numpy as np
from scipy.stats import chi2

import viscotack as vt
from viscotack.identify import PullOff, forecast_rates, identify_rates
from viscotack.identify.forward import Forward
from viscotack.identify.repeats import pooled
from viscotack.lab.tack import Measured

SOLID = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-2, poisson_ratio=0.5)
RADIUS, WORK, GAP, PRELOAD = 5.19e-3, 0.15, 200e-9, 1.5e-3
SPEEDS, SCATTER, LEVEL = np.geomspace(1e-6, 1e-3, 6), 0.03, 0.9
FAST = 3 * SPEEDS[-1]


def alone(forces):
    """Return the mean and the standard error of the tests of each speed."""
    return [(float(np.mean(one)), float(np.std(one, ddof=1) / np.sqrt(one.size))) for one in forces]


def together(forces):
    """Return the mean and its uncertainty by the scatter pooled over the speeds."""
    found = pooled(list(forces))
    rows = zip(found.means, forces, strict=True)
    return [(mean, mean * found.uncertainty(one.size)) for mean, one in rows]


def held(values, truth):
    """Return whether the region holds the interface, and the band the force of the fast test."""
    series = [
        PullOff(float(v), Measured(mean, error), PRELOAD)
        for v, (mean, error) in zip(SPEEDS, values, strict=True)
    ]
    found = identify_rates(series, material=SOLID, radius=RADIUS, theory=1e-3, level=LEVEL)
    misfit = found.objective.best({"work_of_adhesion": WORK, "equilibrium_gap": GAP}).misfit
    forecast = forecast_rates(found, FAST)
    return (
        misfit - found.best.misfit <= chi2.ppf(LEVEL, 2),
        bool(forecast.low[0] < truth < forecast.high[0]),
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--tests", type=int, default=2)
    given = parser.parse_args()
    true = Forward(SOLID, RADIUS).pulled(WORK, GAP, [*SPEEDS, FAST], PRELOAD).force
    rng = np.random.default_rng(38)
    rows = {together: [], alone: []}
    for _ in range(given.count):
        forces = true[:-1, None] * (1 + SCATTER * rng.standard_normal((SPEEDS.size, given.tests)))
        for way, found in rows.items():
            found.append(held(way(forces), true[-1]))
    for way, found in rows.items():
        region, band = np.mean(found, axis=0)
        print(f"{way.__doc__} {given.count} series: region {region:.0%}, forecast {band:.0%}")


if __name__ == "__main__":
    main()
