"""How wrong an elastic fit of a viscoelastic test reads the range of attraction.

    python benchmarks/slow_test_error.py [--record]

The PDMS lens of docs/steady_crack.md with a range of 200 nm (Tabor number 15.9), pulled at several
speeds: force against contact radius by the crack contact, 1 % of noise, fitted as if it were slow.
"""

import argparse
import json

import numpy as np

import viscotack as vt
from viscotack.identify import SlowTest, identify_slow
from viscotack.materials.library import published

RADIUS, WORK_OF_ADHESION, GAP, PRELOAD = 5.19e-3, 0.1523, 200e-9, 1.5e-3
SPEEDS = (1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4)
NOISE = 0.01  # of the largest tension


def pulled(speed, material=None):
    """Return force [N] and contact radius [m] of the retraction, and E0* [Pa]."""
    solid = published("pdms-10-1").material if material is None else material
    problem = vt.Problem(
        material=solid,
        traction=vt.LennardJones(work_of_adhesion=WORK_OF_ADHESION, equilibrium_gap=GAP),
        geometry=vt.Sphere(radius=RADIUS),
        protocol=vt.Retraction(start=vt.AtForce(PRELOAD), speed=speed),
    )
    answer = vt.crack_contact(problem)
    modulus = solid.rubbery_modulus / (1 - solid.poisson_ratio**2)
    force = answer.force * 1.5 * np.pi * RADIUS * WORK_OF_ADHESION
    radius = answer.contact_radius * (np.pi * RADIUS**2 * WORK_OF_ADHESION / modulus) ** (1 / 3)
    return force, radius, modulus, problem.groups().tabor


def read_as_slow(speed, known=True, models=("jkr", "maugis", "carpick"), seed=0):
    """Return what the elastic models make of a test at this speed."""
    force, radius, modulus, tabor = pulled(speed)
    stop = int(np.argmin(force)) + 1
    chosen = np.unique(np.linspace(0, stop - 1, 60, dtype=int))
    noise = NOISE * -force.min()
    rng = np.random.default_rng(seed)
    test = SlowTest(
        force[chosen] + noise * rng.standard_normal(chosen.size), radius[chosen], "radius", RADIUS,
        noise,
    )  # fmt: skip
    return tabor, identify_slow(
        test, contact_modulus=(modulus, 0.03 * modulus) if known else None, models=models
    )


def record():
    """Record what is read at each speed with the modulus from DMA, for the pages."""
    lines = [
        "| speed | work of adhesion read (true 0.152 J/m2) | Tabor number, Maugis | Carpick "
        "| residuals over noise |",
        "|---|---|---|---|---|",
    ]
    for speed, words in ((1e-9, "1 nm/s"), (1e-7, "100 nm/s"), (1e-6, "1 um/s"),
                         (1e-5, "10 um/s"), (1e-4, "100 um/s")):  # fmt: skip
        _, fit = read_as_slow(speed)
        read = {one.model: one for one in fit.fits}
        tabor = [told(read[name]) for name in ("maugis", "carpick")]
        maugis = read["maugis"]
        lines.append(
            f"| {words} | {maugis.work_of_adhesion:.3f} | {tabor[0]} | {tabor[1]} "
            f"| {maugis.scatter / fit.test.force_noise:.2g} |"
        )
    print(json.dumps({"table": lines}, indent=1))


def told(one):
    """Return the Tabor number that a fit reads, with its interval, or above which it lies."""
    ends = one.intervals.get("tabor")
    if ends is None:
        return "not told"
    if not ends.closed_above:
        return f"above {ends.low:.2g}"
    return f"{one.tabor:.2g} ({ends.low:.2g} to {ends.high:.2g})"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--record", action="store_true", help="record the table of the page")
    if parser.parse_args().record:
        record()
        return
    for known in (True, False):
        print("contact modulus from DMA, 3 %" if known else "contact modulus fitted too")
        print("speed [um/s]  model    work [J/m2]  E0* [MPa]  Tabor number read  scatter/noise")
        for speed in SPEEDS:
            tabor, fit = read_as_slow(speed, known)
            for name in ("jkr", "maugis", "carpick"):
                (one,) = (x for x in fit.fits if x.model == name)
                mu = "-" if one.tabor is None else f"{one.tabor:.3g}"
                print(
                    f"{speed * 1e6:12g}  {name:7}  {one.work_of_adhesion:11.4f}  "
                    f"{one.contact_modulus / 1e6:9.3f}  {mu:>17}  "
                    f"{one.scatter / fit.test.force_noise:13.2f}"
                )
        print(f"true: {WORK_OF_ADHESION} J/m2, Tabor number {tabor:.3g}\n")


if __name__ == "__main__":
    main()
