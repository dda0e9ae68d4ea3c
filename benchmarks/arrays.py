"""Compare arrays by the curve of one pad with coupled simulations of unequal pads on one spring.

    python benchmarks/arrays.py --points 24 --seed 2
    python benchmarks/arrays.py --points 12 --seed 6 --softer 10
    python benchmarks/arrays.py --random 100 --seed 1

The first draws two or three different viscoelastic pads on a plate behind a spring, marches all of
them together, and compares the pull-off force with that of `pull_array`, outside its share of the
interval for the tier of one pad. The second pulls random arrays and lists errors other than
refusals.
"""

import argparse
import sys
import traceback
from dataclasses import replace
from time import process_time

import numpy as np
from threadpoolctl import threadpool_limits

from viscotack import (
    AtDepth,
    AtForce,
    Backing,
    Cone,
    Elastic,
    InputError,
    LennardJones,
    OutOfRange,
    PadArray,
    Problem,
    RetardationPowerLaw,
    Retraction,
    Sphere,
    StandardSolid,
    crack_contact,
    pull_array,
)
from viscotack.bem.series import begun_side
from viscotack.bem.settings import Settings
from viscotack.bem.span import separated
from viscotack.bem.steps import UNBALANCED_CUT, cut
from viscotack.pads import grid
from viscotack.series.simulated import part_of, posed_contact

_MOST_STEPS, _TRIALS, _EQUAL, _FALLEN = 20_000, 15, 1e-7, 0.3
# Shortest step over the first one.
_SHORTEST = 1e-3


def march_in_parallel(problems, stiffness, speed, accuracy=2e-3):
    """March pads at relaxed depths on one plate behind a spring; return the pull-off force [N].

    The plate is at z = D - F/K, with the sum F of the forces, and each pad moves with it.
    """
    settings = Settings.for_accuracy(accuracy)
    with threadpool_limits(limits=1, user_api="blas"):
        posed = [posed_contact(problem, settings) for problem in problems]
        sides = _sides(posed, stiffness, speed, settings)
        offset = np.array([side.depth for side in sides])
        z, held, most = 0.0, [True] * len(sides), 0.0
        drive, pace = sum(side.force for side in sides) / stiffness, -speed
        for _ in range(_MOST_STEPS):
            live = [i for i, holds in enumerate(held) if holds]
            if not live:
                break
            step = _step(sides, live, offset, z, drive, (stiffness, speed, pace), most)
            if step is None:
                break
            dt, at, moved = step
            drive, pace, z = drive - speed * dt, (at - z) / dt, at
            for i in live:
                change = moved[i].depth - sides[i].depth
                slope = (moved[i].force - sides[i].force) / change if change else 0.0
                sides[i] = sides[i].arrived(moved[i], dt, slope)
                body = sides[i].run.body
                held[i] = not separated(sides[i].at.state.gap, body.contact.span)
                sides[i] = sides[i].remeshed() if held[i] else sides[i]
            tension = -sum(side.force for side, holds in zip(sides, held, strict=True) if holds)
            most = max(most, tension)
            if most > 0 and tension < _FALLEN * most:
                break
    return most


def _sides(posed, stiffness, speed, settings):
    """Return the pads at rest, with modes that cover the times of the pull."""
    travel = max((max(x.start.depth, 0) + 5 * x.contact.travel) * x.units.depth for x in posed)
    forces = sum(x.units.force / x.groups.modulus_ratio for x in posed)
    longest = (travel + 2 * forces / stiffness) / speed
    shortest = min(2 * settings.first_travel * x.contact.travel * x.units.depth for x in posed)
    parts = [part_of(x, settings, shortest / speed, longest) for x in posed]
    return [begun_side(part, settings, 2 * speed) for part in parts]


def _step(sides, live, offset, z, drive, machine, most):
    """Return length, place of the plate and moves of an accepted step; None at a jump."""
    stiffness, speed, pace = machine
    dt = min(sides[i].longest() for i in live)
    shortest = _SHORTEST * min(sides[i].least_step for i in live)
    while True:
        found = _balanced(
            sides, live, offset, (z + pace * dt, dt), drive - speed * dt, machine, most
        )
        if found is None:
            if dt <= shortest:
                return None
            dt *= UNBALANCED_CUT
            continue
        at, moved = found
        if dt <= shortest or not any(each.attempt.too_long for each in moved.values()):
            return dt, at, moved
        dt *= cut(max(each.attempt.strain for each in moved.values()))


def _balanced(sides, live, offset, trial, drive, machine, most):
    """Return the place of the plate at which spring and pads balance, and the moves of the pads."""
    (at, dt), stiffness = trial, machine[0]
    slope, before = 1 + sum(sides[i].stiffness for i in live) / stiffness, None
    for _ in range(_TRIALS):
        moved = {i: sides[i].moved(dt, at + offset[i]) for i in live}
        if any(each is None for each in moved.values()):
            return None
        force = sum(each.force for each in moved.values())
        off = at + force / stiffness - drive
        if abs(off) * stiffness < _EQUAL * max(abs(force), most):
            return at, moved
        if before is not None and (at - before[0]) * (off - before[1]) > 0:
            slope = (off - before[1]) / (at - before[0])
        before, at = (at, off), at - off / slope
    return None


def drawn(rng):
    """Return a viscoelastic pad and the depths of two or three of them."""
    E, ratio = 10 ** rng.uniform(5.7, 6.5), 10 ** rng.uniform(-1.3, -0.5)
    plateaus = {"rubbery_modulus": E, "glassy_modulus": E / ratio, "poisson_ratio": 0.5}
    tau0 = 10 ** rng.uniform(-2, 0)
    if rng.random() < 0.5:
        material = StandardSolid(**plateaus, tau0=tau0)
    else:
        material = RetardationPowerLaw(**plateaus, tau0=tau0, exponent=rng.uniform(0.4, 1.0))
    radius, work, tabor = (
        10 ** rng.uniform(-3, -2),
        10 ** rng.uniform(-1.5, -0.7),
        rng.uniform(5, 15),
    )
    gap = (radius * work**2 / (material.contact_modulus**2 * tabor**3)) ** (1 / 3)
    length = (radius * work**2 / material.contact_modulus**2) ** (1 / 3)
    depths = (
        length * rng.uniform(0.3, 5.0) * np.append(1.0, rng.uniform(0.3, 1, rng.integers(1, 3)))
    )
    protocol = Retraction(AtDepth(depths[0]), length / tau0 * 10 ** rng.uniform(-2, 1.5))
    pad = Problem(material, LennardJones(work, gap), Sphere(radius), protocol)
    stiffness = 1.5 * np.pi * radius * work / length * len(depths) * 10 ** rng.uniform(-0.5, 1.5)
    return pad, depths, stiffness


def points(count, seed, softer):
    """Compare arrays with coupled simulations."""
    rng, done, errors, shares, refused = np.random.default_rng(seed), 0, [], [], 0
    while done < count:
        pad, depths, stiffness = drawn(rng)
        stiffness /= softer
        V = pad.protocol.speed
        each = [replace(pad, protocol=Retraction(AtDepth(float(d)), V)) for d in depths]
        try:
            preload = sum(crack_contact(x).force[0] for x in each) * pad.scales().force
            places = grid(1, len(depths), 100 * pad.geometry.radius)
            array = PadArray(pad, places, depths, backing=Backing(stiffness=stiffness))
            begin = process_time()
            found = pull_array(array, speed=V, preload=float(preload))
        except OutOfRange as error:
            refused += "share the backing" in str(error)
            continue
        except InputError:
            continue
        if found.method != "steady cracks":
            continue
        middle = process_time()
        P = march_in_parallel(each, stiffness, V)
        end = process_time()
        low, high = found.interval
        done += 1
        errors.append(found.pull_off_force / P - 1)
        shares.append((high - low) / 2 / found.pull_off_force)
        inside = "" if low <= P <= high else "  OUTSIDE"
        print(
            f"{done:3d} {len(depths)} pads, {found.pull_off_force:.4g} and {P:.4g} N "
            f"({errors[-1]:+.2%} within {shares[-1]:.2%}), {middle - begin:.1f} and "
            f"{end - middle:.1f} s{inside}",
            flush=True,
        )
    off = np.abs(errors)
    print(
        f"{np.mean(off <= shares):.0%} of {done} inside; error median {np.median(off):.2%}, 95 % "
        f"{np.quantile(off, 0.95):.2%}, largest {off.max():.2%}; {refused} refused for sharing"
    )


def random_arrays(count, seed):
    """Pull random arrays; return the number of errors that are not refusals."""
    rng, failures, refused = np.random.default_rng(seed), 0, 0
    for _ in range(count):
        try:
            work, radius = 10 ** rng.uniform(-2, 0), 10 ** rng.uniform(-4, -2)
            E = 10 ** rng.uniform(5, 7)
            solid = {"rubbery_modulus": E, "poisson_ratio": 0.5}
            material = Elastic(**solid)
            if rng.random() < 0.3:
                material = StandardSolid(**solid, glassy_modulus=10 * E, tau0=0.1)
            shape = Sphere(radius) if rng.random() < 0.8 else Cone(0.05)
            length = (radius * work**2 / material.contact_modulus**2) ** (1 / 3)
            law = LennardJones(work, length / 10 ** rng.uniform(0.5, 3))
            pad = Problem(material, law, shape, Retraction(AtForce(1e-3), 1e-4))
            rows, columns = rng.integers(1, 5, 2)
            number, unit = int(rows * columns), 1.5 * np.pi * radius * work
            stiff = unit / length
            backing = Backing(
                stiffness=rng.choice([None, number * stiff * 10 ** rng.uniform(-1, 2)]),
                pad_stiffness=rng.choice([None, stiff * 10 ** rng.uniform(-1, 2)]),
                base_modulus=rng.choice([None, None, E]),
                tilt=rng.choice([0.0, rng.uniform(0, 2e-3)]),
                curvature=rng.normal(0, 0.1),
            )
            array = PadArray(
                pad,
                grid(int(rows), int(columns), radius * 10 ** rng.uniform(-0.5, 1)),
                length * rng.normal(0, 1, number) * rng.choice([0, 1]),
                np.clip(rng.normal(1, 0.1, number), 0.5, 2),
                backing,
            )
            load = number * unit * rng.choice([-0.2, 1, 1]) * 10 ** rng.uniform(-1, 1)
            found = pull_array(array, speed=10 ** rng.uniform(-6, -3), preload=load)
        except InputError:
            refused += 1
            continue
        except Exception:
            failures += 1
            traceback.print_exc()
            continue
        whole = np.all(np.diff(found.drive) <= 0) and found.force[-1] == 0
        failures += not (whole and len(found.order) and 0 < found.load_sharing < 2)
    print(f"{count} arrays: {refused} refused, {failures} failures")
    return failures


def main():
    """Run the comparison that is asked for."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--points", type=int, default=0)
    options.add_argument("--random", type=int, default=0)
    options.add_argument("--softer", type=float, default=1.0)
    options.add_argument("--seed", type=int, default=1)
    given = options.parse_args()
    if given.points:
        points(given.points, given.seed, given.softer)
    return int(given.random > 0 and random_arrays(given.random, given.seed) > 0)


if __name__ == "__main__":
    sys.exit(main())
