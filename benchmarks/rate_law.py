"""Which law leads from the rate to crack speed and force at pull-off: how well each one does.

`python benchmarks/rate_law.py [--count 128]`: simulated states at pull-off beside the thesis's fit
(Eq. 4.24) in both its readings, the equation of motion of the edge and `theory.detachment`; then
the bands that `viscotack.advise` states beside the share of cases that they cover. Three sets of
cases, power laws and standard solids, all from heavy preload: over the whole range, in the range
of the fit, and fast. Five minutes on two cores.
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np
from cases import power_law, spread_out, standard_solid
from scipy.stats import qmc

from viscotack import AtRadius, Groups, advise, solve
from viscotack.result.observables import pull_off
from viscotack.theory import (
    CrackLaw,
    detachment,
    jkr,
    lennard_jones,
    persson_brener,
    rate,
    unloading,
)

# Ranges of Tabor number, modulus ratio, exponent, rate, and start over the full glassy contact.
SETS = {
    "whole range": ((0.3, 8.0), (1e-3, 0.3), (0.3, 1.6), (0.1, 1e6), (1.0, 3.0)),
    "range of the fit": ((2.6, 4.0), (0.01, 0.1), (0.4, 1.6), (0.1, 1e6), (1.0, 3.0)),
    "fast": ((0.3, 8.0), (0.01, 0.3), (0.3, 1.6), (1e4, 1e8), (1.5, 4.0)),
}
_UNIT: dict[str, Any] = dict(radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0)
_STRENGTH_RATIO = np.pi / 9


def cases(name: str, count: int, seed: int) -> list[Groups]:
    """Return cases that fill a set evenly in logarithms; every third is a standard solid."""
    low, high = np.log10(SETS[name]).T
    points = qmc.Sobol(5, seed=seed).random_base2(int(np.ceil(np.log2(count))))[:count]
    found = []
    for i, (mu, k, n, speed, start) in enumerate((10 ** (low + points * (high - low))).tolist()):
        # the smallest relaxed contact of the full glassy force, and that of no load at least
        full = max((9 / (8 * k)) ** (1 / 3), 1.65)
        found.append(
            Groups(
                tabor=mu,
                material=standard_solid(k) if i % 3 == 0 else power_law(k, n),
                start=AtRadius(start * full),
                rate=speed,
            )
        )
    return found


def measure(groups: Groups) -> dict[str, Any]:
    """Return simulated over predicted speeds and forces, and the bands of the advice."""
    mu, solid = groups.tabor, groups.material
    assert isinstance(groups.start, AtRadius)
    found = pull_off(solve(groups, accuracy=2e-3, until="pull-off", estimate_error=False))
    # R = E0* = dg0 = 1: depths in 1/mu, speeds in the unit of the result, forces in 1.5 pi
    tip = float(
        persson_brener.crack_tip_length(
            contact_modulus=1.0,
            work_of_adhesion=1.0,
            strength=groups.traction.strength * mu,
            strength_ratio=_STRENGTH_RATIO,
        )
    )
    depth = float(jkr.depth(groups.start.contact_radius * np.pi ** (1 / 3), **_UNIT))
    speed = groups.rate / mu
    law = CrackLaw(theory="persson-brener", material=solid, tip_length=tip)
    curve = unloading.retraction(depth, law, speed=speed, **_UNIT)
    predicted = {
        "Eq. 4.24 as published": rate.rate_as_published(groups.rate),
        "Eq. 4.24, own mu": rate.rate_in_contact_heights(speed, time_unit=solid.time_unit, **_UNIT),
    }
    speeds = {
        name: rate.COEFFICIENT * float(np.asarray(r)) ** rate.EXPONENT * tip
        for name, r in predicted.items()
    }
    speeds["equation of motion"] = float(curve.edge_speed[int(np.argmin(curve.force))])
    slow = float(lennard_jones.pull_off_ratio(mu))
    forces = {"equation of motion": slow * curve.pull_off_force / (1.5 * np.pi)}
    margin = 0.0
    try:
        state = detachment.at_pull_off(speed, law, depth=depth, **_UNIT)
    except ValueError:
        pass  # too light a preload for this rate
    else:
        speeds["detachment"] = float(state.crack_speed)
        forces["detachment"] = slow * float(state.force) / (1.5 * np.pi)
        margin = groups.start.contact_radius * np.pi ** (1 / 3) / float(state.contact_radius)
    advice = advise(groups)
    return {
        "case": groups,
        "mu": mu,
        "margin": margin,
        "speed": {name: found.crack_speed / v for name, v in speeds.items()},
        "force": {name: found.force / f for name, f in forces.items()},
        "advice": {
            e.tier: (found.force / e.pull_off_force, e.error, e.applies)
            for e in advice.estimates
            if e.pull_off_force is not None
        },
    }


def scatter(ratios: list[float]) -> str:
    """Return median and the factor within which nine of ten lie, of simulated over predicted."""
    x = np.log(ratios)
    x = x[np.isfinite(x)]
    if not x.size:
        return "no cases"
    return (
        f"{x.size:4d} cases, median {np.exp(np.median(x)):6.3f}, nine of ten within a factor "
        f"{np.exp(np.quantile(np.abs(x), 0.9)):7.3f}, all within {np.exp(np.abs(x).max()):9.3g}"
    )


def covered(rows: list[dict[str, Any]], tier: str) -> str:
    """Return how many of the cases to which a tier applies lie in the band that it states."""
    chosen = [r["advice"][tier] for r in rows if r["advice"].get(tier, (0, 0, False))[2]]
    if not chosen:
        return f"{tier:12s} applies to none"
    error = np.array([1 / ratio - 1 for ratio, _, _ in chosen])
    band = np.array([said for _, said, _ in chosen])
    return (
        f"{tier:12s} applies to {len(chosen):4d}, bands of {100 * band.min():.0f} to "
        f"{100 * band.max():.0f} % cover {100 * np.mean(np.abs(error) <= band):.0f} %; nine of ten "
        f"are within {100 * np.quantile(np.abs(error), 0.9):.0f} %"
    )


def report(rows: list[dict[str, Any]]) -> None:
    """Print the scatter of each law and the cover of each band."""
    near = [r for r in rows if r["mu"] >= 1 and r["margin"] >= 1.2]
    for title, chosen in (
        ("all", rows),
        ("mu 1 and more, start 1.2 a and more", near),
        ("mu 2 and more, start 1.2 a and more", [r for r in near if r["mu"] >= 2]),
        ("mu below 1", [r for r in rows if r["mu"] < 1]),
    ):
        print(f"  {title}")
        for what in ("speed", "force"):
            for name in sorted({name for r in chosen for name in r[what]}):
                ratios = [r[what][name] for r in chosen if name in r[what]]
                print(f"    {what} over {name:22s} {scatter(ratios)}")
    for tier in ("elastic", "unloading", "detachment", "rate-fit", "glassy"):
        print(f"  advice: {covered(rows, tier)}")


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=128)
    parser.add_argument("--seed", type=int, default=2026)
    chosen = parser.parse_args()
    everything = []
    for name in SETS:
        rows = spread_out(measure, cases(name, chosen.count, chosen.seed))
        print(f"{name}: {len(rows)} cases", flush=True)
        report(rows)
        everything += rows
    print("together")
    report(everything)


if __name__ == "__main__":
    main()
