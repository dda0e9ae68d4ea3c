"""The grid beside contacts of revolution and beside itself on finer pixels.

python -m research.grid spheres           # forces, works and processor time of 22 spheres
python -m research.grid trust --seed 1    # stated errors of drawn spheres
python -m research.grid rough --seed 1    # and of drawn rough maps
python -m research.grid size              # time and memory by the number of pixels
python -m research.grid speeds --pixels 1024   # docs/rough_speed.png: pull-off and loss by speed
"""

import argparse
import resource
from dataclasses import replace
from itertools import product
from time import process_time

import numpy as np

import viscotack as vt
from viscotack.errors import InputError
from viscotack.model.geometry import Bonded, HalfSpace, Layer
from viscotack.model.protocol import Apart, Approach, AtForce, Dwell, Retraction
from viscotack.model.surfaces import self_affine, sphere
from viscotack.plot.style import drawing, save_figure
from viscotack.result.observables import work_of_separation
from viscotack.simulate.rough import RoughProblem, pull

RADIUS, GAP = 5e-3, 1.5e-6
ALONG = np.sqrt(RADIUS * GAP)
PLATEAUS = {"rubbery_modulus": 1.5e6, "poisson_ratio": 0.5}


def solid(k):
    """Return a solid of this modulus ratio."""
    if k == 1:
        return vt.Elastic(**PLATEAUS)
    return vt.StandardSolid(**PLATEAUS, glassy_modulus=1.5e6 / k, tau0=0.1)


def of_sphere(tabor, material, test, pixels, half, body=None):
    """Return the problem on the grid and that of revolution, and the unit of force [N]."""
    work = np.sqrt(tabor**3 * material.contact_modulus**2 * GAP**3 / RADIUS)
    law = vt.LennardJones(work_of_adhesion=work, equilibrium_gap=GAP)
    unit = 1.5 * np.pi * RADIUS * work
    common = {
        "material": material,
        "traction": law,
        "protocol": test(unit),
        "body": body or HalfSpace(),
    }
    surface = sphere(pixels, 2 * half * ALONG / pixels, radius=RADIUS)
    rough = RoughProblem(surface=surface, **common)
    return rough, vt.Problem(geometry=vt.Sphere(RADIUS), **common), unit


def compared(problem, exact, unit):
    """Return errors of force and work, the stated ones, and the processor time."""
    began = process_time()
    found = pull(problem)
    spent = process_time() - began
    result = vt.solve(exact, until="detached", estimate_error=False, accuracy=1e-3)
    force = found.pull_off_force / (unit * vt.pull_off_force(result)) - 1
    work = found.work_of_separation / (unit * GAP * work_of_separation(result)) - 1
    return found, force, work, spent


def spheres(given):
    """Compare spheres by Tabor number, modulus ratio, speed and machine."""
    print("mu    k     speed  test      px/zone  force      work      residual  steps  CPU s")

    def row(name, tabor, k, speed, test, pixels):
        problem, exact, unit = of_sphere(tabor, solid(k), test, pixels, 6.0)
        found, force, work, spent = compared(problem, exact, unit)
        print(
            f"{tabor:<5g} {k:<5g} {speed:<6g} {name:<9} {problem.zone.pixels:7.2f} "
            f"{100 * force:+8.3f} % {100 * work:+8.3f} % {found.energy_residual:8.1e} "
            f"{found.statistics['steps']:6.0f} {spent:6.1f}",
            flush=True,
        )

    for tabor, k, speed in product((0.3, 0.7, 1.0, 1.5), (1, 0.1, 0.01), (1e-5, 1e-3)):
        if k == 1 and speed > 1e-5:
            continue
        row(
            "pull",
            tabor,
            k,
            speed,
            lambda F, v=speed: Retraction(start=AtForce(0.3 * F), speed=v),
            given.pixels,
        )

    def history(F, stiffness=None):
        moves = (Approach(speed=1e-5, to=AtForce(0.5 * F)), Dwell(duration=0.3))
        K = stiffness and stiffness * F / GAP
        return Retraction(start=Apart(10e-6), moves=moves, speed=1e-4, stiffness=K)

    row("approach", 1.0, 0.1, 1e-4, history, given.pixels)
    row("spring", 1.0, 0.1, 1e-4, lambda F: history(F, 0.3), given.pixels)


def drawn_map(rng, pixels, law_length):
    """Return a drawn self-affine map whose zones have three to eight pixels."""
    pixel = 0.75 * law_length / rng.uniform(3, 8)
    return self_affine(
        pixels,
        pixel,
        hurst=rng.uniform(0.3, 1.0),
        rms_height=GAP * 10 ** rng.uniform(-0.7, 0.7),
        seed=int(rng.integers(1 << 30)),
        roll_off=pixels * pixel * rng.uniform(0.3, 1.0),
        shortest=pixel * rng.uniform(8, 16),
        periodic=bool(rng.random() < 0.7),
    )


def drawn(rng, pixels):
    """Return a drawn rough problem."""
    k = 10 ** -rng.uniform(0, 3)
    kind = rng.integers(4)
    material = solid(1) if kind == 0 else solid(k)
    if kind == 2:
        material = vt.RetardationPowerLaw(
            **PLATEAUS, glassy_modulus=1.5e6 / k, exponent=rng.uniform(0.2, 0.9), tau0=0.1
        )
    law = vt.LennardJones(work_of_adhesion=10 ** rng.uniform(-2, 0), equilibrium_gap=GAP)
    length = material.contact_modulus * GAP**2 / law.work_of_adhesion
    surface = drawn_map(rng, pixels, length)
    stress = law.strength * 10 ** rng.uniform(-2, -0.5)
    preload = AtForce(stress * surface.area)
    speed = 10 ** rng.uniform(-7, -2)
    stiffness = None
    if rng.random() < 0.3:
        stiffness = law.strength * surface.area / GAP * 10 ** rng.uniform(-1.5, 0.5)
    if rng.random() < 0.4:
        moves = (Approach(speed=speed, to=preload), Dwell(duration=10 ** rng.uniform(-3, 1)))
        start = Apart(6 * GAP)
        test = Retraction(start=start, moves=moves, speed=speed, stiffness=stiffness)
    else:
        test = Retraction(start=preload, speed=speed, stiffness=stiffness)
    body = HalfSpace()
    if rng.random() < 0.3:
        thickness = min(surface.size) * rng.uniform(0.05, 0.5)
        base = Bonded(poisson_ratio=0.5) if rng.random() < 0.5 else None
        body = Layer(thickness=thickness, **({"base": base} if base else {}))
    return RoughProblem(surface=surface, material=material, traction=law, protocol=test, body=body)


def judge(inside, about, found, **off):
    """Print errors beside the stated ones, and note the ratio of the stated to the true."""
    stated = found.error_estimate or {}
    for name, value in off.items():
        # whole maps in contact have no error of the area
        inside[name].append(stated[name] / abs(value) if value else np.inf)
    pairs = [f"{name} {100 * x:+.3f} of {100 * stated[name]:.3f} %" for name, x in off.items()]
    print(f"{about}: {', '.join(pairs)}", flush=True)


def summed(inside):
    """Print how many errors are within the stated ones, and how far these are above."""
    for name, found in inside.items():
        ratio = np.array(found)
        print(
            f"{name}: {np.mean(ratio >= 1):.0%} of {len(found)} within the stated error, "
            f"{np.median(ratio[np.isfinite(ratio)]):.1f} times the true one in the median"
        )


def trust(given):
    """Compare stated errors of drawn spheres with contacts of revolution."""
    rng = np.random.default_rng(given.seed)
    inside = {"force": [], "work": []}
    for _ in range(given.count):
        tabor, k = rng.uniform(0.3, 2.0), float(rng.choice([1, 0.3, 0.1, 0.01]))
        speed, press = 10 ** rng.uniform(-6, -2.5), rng.uniform(0, 0.6)

        def test(F, v=speed, p=press):
            return Retraction(start=AtForce(p * F), speed=v)

        zone = 0.75 * ALONG * tabor**-1.5
        half = 6.0
        side = round(2 * half * ALONG / (zone / rng.uniform(1.6, 4)))
        problem, exact, unit = of_sphere(tabor, solid(k), test, min(max(side, 48), 160), half)
        found, force, work, _ = compared(problem, exact, unit)
        about = f"sphere mu {tabor:.2f} k {k:g} {problem.zone.pixels:.2f} px"
        judge(inside, about, found, force=force, work=work)
    summed(inside)


def rough(given):
    """Compare stated errors of drawn rough maps with pixels half as large and finer steps."""
    rng = np.random.default_rng(given.seed)
    inside = {"force": [], "work": [], "area": []}
    while len(inside["force"]) < given.count:
        try:
            fine = drawn(rng, 2 * given.pixels)
            surface = fine.surface
            every_second = replace(
                surface, heights=surface.heights[::2, ::2], pixel=2 * surface.pixel
            )
            found = pull(replace(fine, surface=every_second), time_limit=given.limit)
        except InputError:
            continue
        better = pull(fine, accuracy=5e-4, estimate_error=False, time_limit=4 * given.limit)
        if vt.Outcome.STOPPED in (found.outcome, better.outcome) or found.error_estimate is None:
            print(f"{found.status}; {better.status}; {found.error_estimate}", flush=True)
            continue
        about = (
            f"k {fine.material.modulus_ratio:.3g}, {fine.zone.pixels / 2:.2f} px, "
            f"{len(found.events)} jumps"
        )
        judge(
            inside,
            about,
            found,
            force=found.pull_off_force / better.pull_off_force - 1,
            work=found.work_of_separation / better.work_of_separation - 1,
            area=found.area.max() / better.area.max() - 1,
        )
    summed(inside)


def size(given):
    """Show processor time and memory of one pull by the number of pixels."""
    for side in (64, 128, 256, 512):
        if side > given.pixels:
            break
        problem = of_size(side)
        began = process_time()
        found = pull(problem, estimate_error=False)
        spent = process_time() - began
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        many = found.statistics["newton_iterations"]
        print(
            f"{side:4d}^2 {spent:7.1f} s, {1e3 * spent / many:8.1f} ms per iteration of Newton, "
            f"{found.statistics['steps']:.0f} steps, {memory:.0f} MB, "
            f"{found.pull_off_stress / 1e3:.3f} kPa",
            flush=True,
        )


def of_size(side):
    """Return the problem whose cost by the size of the grid is measured."""
    surface = self_affine(
        side, 10e-6, hurst=0.8, rms_height=1.5e-6, seed=4, roll_off=640e-6, shortest=80e-6
    )
    law = vt.LennardJones(work_of_adhesion=0.1, equilibrium_gap=GAP)
    test = Retraction(start=AtForce(0.1 * law.strength * surface.area), speed=5e-5)
    material = vt.RelaxationPowerLaw(
        rubbery_modulus=0.75e6, glassy_modulus=15e6, exponent=0.5, tau0=0.05, poisson_ratio=0.5
    )
    return RoughProblem(surface=surface, material=material, traction=law, protocol=test)


def speeds(given):
    """Draw pull-off stress and dissipation of whole cycles of a map by their speed."""
    side, height = given.pixels, 6e-6
    surface = self_affine(
        side, 5e-6, hurst=0.8, rms_height=height, seed=4, roll_off=2.56e-3, shortest=40e-6
    )
    problem = of_size(64)
    law, area = problem.traction, surface.area
    rows = []
    print("speed     pull-off stress  dissipated per area  largest contact  steps  CPU s")
    for speed in np.geomspace(1e-6, 1e-2, 5):
        press = Approach(speed=float(speed), to=AtForce(0.1 * law.strength * area))
        test = Retraction(start=Apart(5 * height), moves=(press,), speed=float(speed))
        began = process_time()
        found = pull(replace(problem, surface=surface, protocol=test), estimate_error=False)
        lost = (found.heat[-1] + found.jumps[-1]) / area
        rows.append((speed, found.pull_off_stress, lost, found.area.max() / area))
        print(
            f"{speed:.0e} {found.pull_off_stress:10.1f} Pa {1e3 * lost:12.4f} mJ/m2 "
            f"{rows[-1][3]:16.1%} {found.statistics['steps']:10.0f} {process_time() - began:6.0f}",
            flush=True,
        )
    speed, stress, lost, touching = np.array(rows).T
    with drawing(7.2, 2.8) as figure:
        figure.set_layout_engine("constrained")
        left, middle, right = figure.subplots(1, 3)
        left.loglog(1e6 * speed, 1e-3 * stress, "o-")
        left.set_ylabel("pull-off stress [kPa]")
        middle.loglog(1e6 * speed, 1e3 * lost, "o-")
        middle.set_ylabel("loss [mJ/m²]")
        right.semilogx(1e6 * speed, 100 * touching, "o-")
        right.set_ylabel("touching [%]")
        for axes in (left, middle, right):
            axes.yaxis.set_minor_formatter("")
            axes.set_xlabel("speed [µm/s]")
        save_figure(figure, "docs/rough_speed.png")


PARTS = (spheres, trust, rough, size, speeds)


def main():
    """Run one part."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parts = {part.__name__: part for part in PARTS}
    parser.add_argument("part", choices=parts)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--pixels", type=int, default=64)
    parser.add_argument("--limit", type=float, default=60.0)
    given = parser.parse_args()
    parts[given.part](given)


if __name__ == "__main__":
    main()
