"""Compare steady cracks in series with coupled simulations, and draw windows at random.

    python benchmarks/window.py --points 60 --seed 1
    python benchmarks/window.py --windows 200 --seed 1
    python benchmarks/window.py --windows 8 --seed 1 --simulate

Points are pairs of contacts of which one opens by steady cracks, outside the bands. Each is
simulated. The first lists the answers and tensions of both and counts how often they agree; the
second evaluates random windows and lists errors other than refusals.
"""

import argparse
import sys
import traceback
from collections import Counter
from dataclasses import replace
from time import process_time

import numpy as np

from viscotack import (
    AtForce,
    Cone,
    Dugdale,
    Elastic,
    InputError,
    Layer,
    LennardJones,
    PowerLawProfile,
    Problem,
    RetardationPowerLaw,
    Retraction,
    Sphere,
    StandardSolid,
    simulate_in_series,
    which_opens,
    window,
)
from viscotack.geometry import Bonded

# Largest Tabor number that is simulated in seconds.
_LARGEST_TABOR = 30.0
# Time limit of a simulated cell of a random window [s].
_SIMULATED = 5.0


def solid(rng, kinds=("elastic", "standard", "power")):
    """Return a random solid."""
    E, ratio = 10 ** rng.uniform(5.5, 6.7), 10 ** rng.uniform(-1.5, -0.3)
    plateaus = {"rubbery_modulus": E, "glassy_modulus": E / ratio, "poisson_ratio": 0.5}
    match rng.choice(kinds):
        case "elastic":
            return Elastic(rubbery_modulus=E, poisson_ratio=0.5)
        case "standard":
            return StandardSolid(**plateaus, tau0=10 ** rng.uniform(-3, 0))
    exponent, tau0 = rng.uniform(0.4, 1.0), 10 ** rng.uniform(-3, 0)
    return RetardationPowerLaw(**plateaus, tau0=tau0, exponent=exponent)


def of_tabor(rng, material, work, radius, low=3.5, high=_LARGEST_TABOR):
    """Return a law for which a sphere has a random Tabor number."""
    tabor = np.exp(rng.uniform(np.log(low), np.log(high)))
    gap = (radius * work**2 / (material.contact_modulus**2 * tabor**3)) ** (1 / 3)
    return LennardJones(work_of_adhesion=work, equilibrium_gap=gap)


def pair(rng):
    """Return two random contacts of about the same strength."""
    radius, work = 10 ** rng.uniform(-3.5, -2), 10 ** rng.uniform(-1.5, -0.5)
    base, stamp = solid(rng, ("elastic", "elastic", "standard", "power")), solid(rng)
    ratio, size = 10 ** rng.uniform(-0.4, 0.6), 10 ** rng.uniform(-0.2, 0.2)
    unit = 1.5 * np.pi * radius * work
    protocol = Retraction(
        start=AtForce(unit * 10 ** rng.uniform(-0.7, 1.0)),
        speed=10 ** rng.uniform(-7, -2.5),
        stiffness=rng.choice([None, unit / 1e-6 * 10 ** rng.uniform(-1, 1)]),
    )
    first, second = (
        Problem(m, of_tabor(rng, m, w, r), Sphere(r), protocol)
        for m, w, r in ((base, work * ratio, radius * size), (stamp, work, radius))
    )
    return first, second


def points(count, seed, skip):
    """Compare decided answers with coupled simulations, after the first ones of the seed."""
    rng, agreed, done, errors, residuals, costs = np.random.default_rng(seed), 0, 0, [], [], []
    reasons = Counter()
    while done < count:
        first, second = pair(rng)
        if first.material.modulus_ratio == second.material.modulus_ratio == 1:
            continue
        begin = process_time()
        try:
            found = which_opens(first, second)
        except InputError as error:
            reasons[str(error)[:40]] += 1
            continue
        if found.opened is None:
            reasons[found.why[:40]] += 1
            continue
        if skip > 0:
            skip -= 1
            continue
        middle = process_time()
        result = simulate_in_series(first, second, time_limit=300)
        costs.append((middle - begin, process_time() - middle))
        done += 1
        agreed += result.opened == found.opened
        errors.append(found.tension / result.tension - 1 if result.tension > 0 else np.inf)
        residuals.append(result.energy_residual)
        mark = "" if result.opened == found.opened else "  DIFFERS"
        print(
            f"{done:3d} opens {found.opened} and {result.opened}, tension {found.tension:.4g} and "
            f"{result.tension:.4g} N ({errors[-1]:+.2%}), bands {found.bands[0]:.1%} and "
            f"{found.bands[1]:.1%}, energy {residuals[-1]:.1e}, {costs[-1][0]:.2f} and "
            f"{costs[-1][1]:.1f} s, {result.status}{mark}",
            flush=True,
        )
    off = np.abs(errors)
    print(f"{agreed} of {done} agree; not decided: {dict(reasons)}")
    print(
        f"tension: median {np.median(off):.2%}, 95 % {np.quantile(off, 0.95):.2%}, largest "
        f"{off.max():.2%}; energy up to {max(residuals):.1e}"
    )
    cheap, simulated = np.median(costs, axis=0)
    print(f"processor time: median {cheap:.2f} s by steady cracks, {simulated:.2f} s simulated")


def odd_contact(rng):
    """Return a contact of any kind, often one that a tier refuses."""
    material, radius = solid(rng), 10 ** rng.uniform(-4, -2)
    work = 10 ** rng.uniform(-2, 0)
    law = of_tabor(rng, material, work, radius, 1.0, 1e3)
    if rng.random() < 0.2:
        law = Dugdale(work_of_adhesion=work, equilibrium_gap=law.equilibrium_gap)
    shape = rng.choice([Sphere(radius), Sphere(radius), Cone(0.05), PowerLawProfile(1e6, 3.0)])
    problem = Problem(material, law, Sphere(radius), Retraction(AtForce(1e-3), 1e-4))
    problem = replace(problem, geometry=shape)
    if rng.random() < 0.15:
        layer = Layer(thickness=radius / 2, base=Bonded(poisson_ratio=0.5))
        problem = replace(problem, body=layer)
    return problem


def windows(count, seed, simulate):
    """Evaluate random windows; return the number of errors that are not refusals."""
    rng, failures, words, refused = np.random.default_rng(seed), 0, Counter(), 0
    for number in range(count):
        try:
            stamp, donor, receiver = (odd_contact(rng) for _ in range(3))
            unit = stamp.scales().force
            found = window(
                stamp,
                donor=donor if number % 3 < 2 else None,
                receiver=receiver if number % 3 > 0 else None,
                speeds=10 ** rng.uniform(-9, -1, 3),
                preloads=unit * rng.choice([-0.2, 1, 1], 2) * 10 ** rng.uniform(-1, 1, 2),
                simulate=simulate,
                time_limit=_SIMULATED,
            )
        except InputError:
            refused += 1
            continue
        except Exception:
            failures += 1
            traceback.print_exc()
            continue
        words.update(cell.word for cell in found.cells)
        failures += sum(cell.word == "undecided" and not cell.why for cell in found.cells)
    print(f"{count} windows: {refused} refused, {failures} failures, cells {dict(words)}")
    return failures


def main():
    """Run the comparison that is asked for."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--points", type=int, default=0)
    options.add_argument("--skip", type=int, default=0)
    options.add_argument("--windows", type=int, default=0)
    options.add_argument("--simulate", action="store_true")
    options.add_argument("--seed", type=int, default=1)
    given = options.parse_args()
    if given.points:
        points(given.points, given.seed, given.skip)
    return int(given.windows > 0 and windows(given.windows, given.seed, given.simulate) > 0)


if __name__ == "__main__":
    sys.exit(main())
