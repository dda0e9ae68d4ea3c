"""Put studies of synthetic labs to the test, from DMA and rig curves to a forecast.

    python -m research.labs [--growing|--disturbed] [--tabor 10 1e4] [--count 20] [--first 0]
                              [--out labs.jsonl]

Each lab has a solid, an interface, a lens and a rig of its own, drawn from a seed: Tabor numbers 10
to 1e4, modulus ratios 1e-3 to 0.3, power laws, standard solids and Prony series. It measures a DMA
sweep with 2 % of noise and fits it; pulls at six speeds over three decades with a rig that yields
(its compliance known within 10 %), a zero, a drift, noise, and forces that scatter by 3 % from test
to test. Its files are evaluated, its interface identified, and two speeds forecast that were not
measured: between two of the series, and three times its fastest. Truth is simulated up to a Tabor
number of 25 with an accuracy of 2e-3, beyond it is the contact whose edge is a steady crack,
through the spring of the rig, or simulated up to 100 where no crack is steady. Finished labs in the
file are not done again. --tabor draws from other Tabor numbers.

With --disturbed each lab in turn has a disturbance that it does not know: none; a zero that wanders
slowly by 2 % of the pull-off force; a third of the samples dropped; the compliance told wrongly by
10 % as known within 2 %; tests 2 K warmer than told (WLF constants 5 and 150 K); an exponential law
with the strength of Lennard-Jones forces of that range; 125 points a record.

With --growing the interface grows with the opening speed, after Gent and Schultz: by 0.2 to 5 times
its strength at rest in the middle of the speeds, with exponents of 0.25 to 0.7. Truth is the
contact whose edge is a steady crack of that very law; the fit has a lattice of cracks. Labs 0 to 19
are those that are stated; what was tried was tried on labs from 1000 on.
"""

import argparse
import json
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.stats import chi2

import viscotack as vt
from viscotack.identify import RateSeries, forecast_rates, identify_rates, pull_offs
from viscotack.lab import MasterCurve, fit
from viscotack.lab.fit.report import issued
from viscotack.lab.tack import TackRecord, evaluate
from viscotack.model.materials.conversion import slowed

SCATTER, NOISE, LEVEL = 0.03, 0.004, 0.9
# Largest Tabor numbers of a simulated truth, without growth: always, and where no crack is steady.
SIMULATED, SIMULABLE = 25.0, 100.0
GROWING, DISTURBED = 20, 30  # of the seed of a lab
SHORT = 10.0  # Tabor number beyond which attraction out of contact is left out
KINDS = ("none", "drift", "dropped", "compliance", "temperature", "law", "few points")
SHIFT = vt.materials.shift.WLF(reference_temperature=293.15, c1=5.0, c2=150.0)
WARMER = 10 ** SHIFT.log10_shift(295.15)  # factor of the times of a solid 2 K warmer
WANDER = 0.02  # of the zero, in pull-off forces
ALIKE = 0.358  # decay length over h0 of the exponential law of that strength


def solid_of(rng):
    """Return a solid and the model by which its lab fits it."""
    rubbery = 10 ** rng.uniform(4.5, 6.5)
    k, tau0 = 10 ** rng.uniform(-3, -0.5), 10 ** rng.uniform(-3, 0)
    plateaus = dict(rubbery_modulus=rubbery, glassy_modulus=rubbery / k, poisson_ratio=0.5)
    kind = rng.integers(3)
    if kind == 0:
        exponent = rng.uniform(0.25, 0.8)
        return vt.RetardationPowerLaw(**plateaus, exponent=exponent, tau0=tau0), "power-law"
    if kind == 1:
        return vt.StandardSolid(**plateaus, tau0=tau0), "sls"
    count = int(rng.integers(3, 7))
    share = rng.dirichlet(np.ones(count))
    times = np.sort(tau0 * 10 ** rng.uniform(-3, 1, count))
    arms = [(float(s * rubbery * (1 / k - 1)), float(t)) for s, t in zip(share, times, strict=True)]
    return vt.Prony(rubbery_modulus=rubbery, branches=arms, poisson_ratio=0.5), "prony"


def passport_of(solid, model, rng):
    """Return what a DMA with 2 % of noise says of the solid."""
    unit = solid.time_unit
    omega = np.geomspace(1e-3, 1e6, 80) / unit
    modulus = solid.complex_modulus(omega)
    noise = np.exp(0.02 * rng.standard_normal((2, omega.size)))
    curve = MasterCurve(293.15, omega, modulus.real * noise[0], modulus.imag * noise[1], "E")
    return issued(fit(curve, model=model, poisson_ratio=0.5, draws=60), name="of a lab")


def problem_of(lab, speed):
    """Return the test of a lab at a speed of its drive."""
    law = vt.LennardJones(work_of_adhesion=lab["work"], equilibrium_gap=lab["gap"])
    if lab["disturbance"] == "law":
        law = vt.Exponential(work_of_adhesion=lab["work"], equilibrium_gap=lab["gap"], decay=ALIKE)
    if lab["reference_speed"] is not None:
        constants = {name: float(lab[name]) for name in ("reference_speed", "exponent")}
        law = vt.GentSchultz.of(law, **constants)
    return vt.Problem(
        material=lab["true_solid"],
        traction=law,
        geometry=vt.Sphere(radius=lab["radius"]),
        protocol=vt.Retraction(
            start=vt.AtForce(lab["preload"]), speed=speed, stiffness=lab["stiffness"]
        ),
    )


def lab_of(seed, given):
    """Return a lab: its solid, interface, lens, rig and speeds."""
    growing, kind = given.growing, KINDS[seed % len(KINDS)] if given.disturbed else "none"
    more = [GROWING] * growing + [DISTURBED] * given.disturbed
    rng = np.random.default_rng([2026, *more, seed])
    solid, model = solid_of(rng)
    work, radius = 10 ** rng.uniform(-1.7, -0.5), 10 ** rng.uniform(-3, -2)
    tabor = 10 ** rng.uniform(*np.log10(given.tabor))
    gap = (radius * work**2 / solid.contact_modulus**2) ** (1 / 3) / tabor
    pull_off = 1.5 * np.pi * radius * work
    contact = (radius**2 * work / solid.contact_modulus) ** (1 / 3)
    # a drive that goes the height of the contact in so many times of the solid
    height = contact**2 / radius
    middle = height / solid.time_unit * 10 ** rng.uniform(-1, 2)
    exponent, share = rng.uniform(0.25, 0.7) if growing else None, None
    if growing:
        share = 10 ** rng.uniform(-0.7, 0.7)
    return {
        "exponent": exponent,
        "growth": share,
        "reference_speed": None,
        "rng": rng,
        "disturbance": kind,
        "keeps_speeds": tabor <= SIMULABLE and (given.disturbed or given.tabor[1] <= SIMULABLE),
        "solid": solid,
        "true_solid": slowed(solid, WARMER) if kind == "temperature" else solid,
        "model": model,
        "work": float(work),
        "gap": float(gap),
        "tabor": float(tabor),
        "radius": float(radius),
        "preload": float(pull_off * 10 ** rng.uniform(0.3, 1.3)),
        "stiffness": float(pull_off / (height * 10 ** rng.uniform(-1.5, -0.3))),
        "speeds": middle * np.geomspace(0.03, 30, 6),
        "held_out": middle * np.array([0.5, 90.0]),
    }


def with_growth(lab):
    """Return a lab whose interface grows by the share drawn, in the middle of its speeds."""
    if lab["exponent"] is None:
        return lab
    # an edge opens the gap with its speed times dg/(E0* h0), about; it goes as one at rest does
    middle = float(np.sqrt(lab["speeds"][0] * lab["speeds"][-1]))
    edge = vt.crack_contact(problem_of(lab | {"reference_speed": None}, middle))
    strain = lab["work"] / (lab["solid"].contact_modulus * lab["gap"])
    opening = edge.crack_speed_at_pull_off * edge.problem.scales().edge_speed * strain
    return lab | {"reference_speed": opening * lab["growth"] ** (-1 / lab["exponent"])}


def slow_enough(lab):
    """Return a lab with speeds at which edges have a way to go; a lab is told when they have not.

    Twice the fastest speed, that the edge has more than it needs. A lab that is disturbed or of a
    low Tabor number, and whose tests can be simulated, keeps its speeds.
    """
    if lab["keeps_speeds"]:
        return lab
    for _ in range(8):
        try:
            lab = with_growth(lab)
            vt.crack_contact(problem_of(lab, 2 * lab["held_out"][-1]))
            return lab
        except vt.OutOfRange:
            slower = {name: lab[name] / 10 for name in ("speeds", "held_out")}
            lab = lab | slower
    return lab


def steady(problem, lab):
    """Return the contact whose edge is a steady crack, or None where the truth is simulated."""
    if lab["exponent"] is None and lab["tabor"] <= SIMULATED:
        return None
    try:
        return vt.crack_contact(problem)
    except vt.OutOfRange:
        if lab["tabor"] > SIMULABLE or lab["exponent"] is not None:
            raise
        return None


def curve_of(lab, speed):
    """Return time, depth of the drive and force of the true retraction, and its pull-off."""
    problem = problem_of(lab, speed)
    series = steady(problem, lab)
    if series is None:
        series = vt.solve(problem, accuracy=2e-3, estimate_error=False)
    force = -np.min(series.force) if series.method == "simulation" else series.pull_off_force
    scales = problem.scales()
    depth, pressed = series.depth * scales.length, series.force * scales.force
    drive = depth + pressed / lab["stiffness"]
    return (drive[0] - drive) / speed, drive, pressed, force * scales.force


def attraction(lab, apart):
    """Return the van der Waals force [N] of a sphere so far above the equilibrium gap [m].

    It is left out where it is short.
    """
    if lab["tabor"] > SHORT:
        return np.zeros_like(apart)
    return -8 / 3 * np.pi * lab["radius"] * lab["work"] * (1 + apart / lab["gap"]) ** -2.0


def record_of(lab, speed):
    """Return what the rig writes: approach, dwell, retraction; zero, drift and noise."""
    rng = lab["rng"]
    past, drive, force, pull_off = curve_of(lab, speed)
    even = np.linspace(0, past[-1], 700)
    force, drive = np.interp(even, past, force), np.interp(even, past, drive)
    force = force * (1 + SCATTER * rng.standard_normal())
    top, far = drive[0], 0.5 * (drive[0] - drive[-1])
    # on until the approach from there begins well apart
    far = max(far, drive[-1] + 0.4 * max(top, 0.0))
    away = drive[-1] - np.linspace(1 / 150, 1, 150) * far
    down = np.linspace(away[-1], top, 300)
    height = np.maximum(down, 0) / top if top > 0 else np.zeros(down.size)
    pressed = force[0] * height**1.5 + attraction(lab, -down) * (down < 0)
    way = np.concatenate([down, np.full(30, top), drive, away])
    # on from the gap at which the attraction is that of the end
    most, last = -attraction(lab, 0.0), max(-force[-1], 1e-6 * pull_off)
    gap = lab["gap"] * (np.sqrt(most / last) - 1)
    free = attraction(lab, gap + drive[-1] - away)
    push = np.concatenate([pressed, np.full(30, force[0]), force, free])
    step = far / 150 / speed
    clock = np.concatenate(
        [np.linspace(-1.3, -0.3, 300), np.linspace(-0.29, -1e-3, 30)]
    ) * past[-1]  # fmt: skip
    clock = np.concatenate([clock, even, even[-1] + step * np.arange(1, 151)])
    noise = NOISE * pull_off
    push = push + 3 * noise * (1 + clock / clock[-1]) + noise * rng.standard_normal(push.size)
    kind, kept = lab["disturbance"], np.arange(push.size)
    if kind == "drift":
        turns, phase = rng.uniform(0.5, 1.5), rng.uniform(0, 2 * np.pi)
        push += WANDER * pull_off * np.sin(2 * np.pi * turns * clock / np.ptp(clock) + phase)
    elif kind == "dropped":
        kept = kept[rng.random(kept.size) > 1 / 3]
    elif kind == "few points":
        kept = np.linspace(0, kept.size - 1, 125).astype(int)
    return TackRecord(clock[kept], push[kept], way[kept], into=1)


def done(seed, given):
    """Return how one lab fares."""
    growing = given.growing
    lab = slow_enough(lab_of(seed, given))
    rng = lab["rng"]
    held = [curve_of(lab, v)[3] for v in lab["held_out"]]
    records = [record_of(lab, v) for v in lab["speeds"]]
    begin = time.process_time()
    passport = passport_of(lab["solid"], lab["model"], rng)
    # the shift by which its sweeps were joined
    passport = replace(passport, shift=SHIFT)
    fitted = time.process_time()
    compliance = (1 + 0.1 * rng.standard_normal()) / lab["stiffness"]
    doubt = 0.1
    if lab["disturbance"] == "compliance":
        compliance, doubt = rng.choice([0.9, 1.1]) / lab["stiffness"], 0.02
    known = {"compliance": compliance, "compliance_uncertainty": doubt / lab["stiffness"]}
    evaluations = [evaluate(record, **known) for record in records]
    cycles = [cycle for one in evaluations for cycle in one.cycles]
    series = pull_offs(cycles)
    # four unknowns cost more the more is looked at
    around = tuple(lab["gap"] * (np.array([1 / 30, 30]) if growing else np.array([1e-3, 1e3])))
    found = identify_rates(
        RateSeries(
            series,
            material=passport,
            radius=lab["radius"],
            preload=lab["preload"],
            gaps=around,
            stiffness=1 / compliance,
            compliance_uncertainty=doubt,
            growth=growing,
            scatter=SCATTER,
            level=LEVEL,
        )
    )
    identified = time.process_time()
    truth = {"work_of_adhesion": lab["work"], "equilibrium_gap": lab["gap"]}
    if growing:
        opening = float(found.search.opening.speed(lab["gap"]))
        more = (opening / lab["reference_speed"]) ** lab["exponent"]
        truth |= {"strengthening": 1 + more, "exponent": float(lab["exponent"])}
    beyond = found.objective.best(truth).misfit - found.best.misfit
    try:
        forecast, refusal = forecast_rates(found, lab["held_out"]), None
    except vt.OutOfRange as error:
        forecast, refusal = forecast_rates(found, lab["held_out"][:1]), str(error)
    return {
        "seed": seed,
        "disturbance": lab["disturbance"],
        "model": lab["model"],
        "tabor": lab["tabor"],
        "modulus_ratio": lab["solid"].modulus_ratio,
        "pull_offs": len(series),
        "amplification": float(held[1] / (1.5 * np.pi * lab["radius"] * lab["work"])),
        "misfit_of_truth": float(beyond),
        "inside": bool(beyond <= chi2.ppf(LEVEL, len(truth))),
        "truth": truth,
        "found": dict(found.best.values),
        "chance": found.growth.chance if growing else None,
        "work_over_truth": found.work_of_adhesion / lab["work"],
        "gap_over_truth": found.equilibrium_gap / lab["gap"],
        "scatter": found.scatter,
        "forecast_over_truth": [one / x for one, x in zip(forecast.force, held, strict=False)],
        # a forecast that is refused holds nothing
        "held": [
            bool(a < x < b) for a, x, b in zip(forecast.low, held, forecast.high, strict=False)
        ]
        + [False] * (len(held) - forecast.speed.size),
        "forecast_refused": refusal,
        # most negative logarithm of a forecast over a force measured at a slower speed
        "below_slower": min(
            float(np.log(force / one.force.value))
            for v, force in zip(forecast.speed, forecast.force, strict=True)
            for one in series
            if one.speed < v
        ),
        "half_width": ((forecast.high - forecast.low) / 2 / forecast.force).tolist(),
        "seconds": [fitted - begin, identified - fitted, time.process_time() - identified],
        "words": [*found.words, *forecast.words],
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--growing", action="store_true")
    parser.add_argument("--disturbed", action="store_true")
    parser.add_argument("--tabor", type=float, nargs=2, default=(10.0, 1e4))
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path("labs.jsonl"))
    given = parser.parse_args()
    rows = (
        [json.loads(line) for line in given.out.read_text().splitlines()]
        if given.out.exists()
        else []
    )
    for seed in range(given.first, given.first + given.count):
        if any(row["seed"] == seed for row in rows):
            continue
        try:
            rows.append(done(seed, given))
        except (ValueError, RuntimeError) as error:
            kind = KINDS[seed % len(KINDS)] if given.disturbed else "none"
            rows.append({"seed": seed, "disturbance": kind, "refused": str(error)})
        with given.out.open("a") as file:
            file.write(json.dumps(rows[-1]) + "\n")
        print(rows[-1], flush=True)
    told = [row for row in rows if "refused" not in row]
    held = [one for row in told for one in row["held"]]
    if given.growing:
        sure = sum(row["chance"] < 0.01 for row in told)
        print(f"growth is told from none, at 1 %: {sure}")
    print(f"{len(told)} labs, {len(rows) - len(told)} refused")
    print(f"truth inside the region: {sum(row['inside'] for row in told)}")
    for kind in KINDS if given.disturbed else ():
        some = [row["inside"] for row in told if row["disturbance"] == kind]
        print(f"  {kind}: {sum(some)} of {len(some)}")
    below = sum(row["below_slower"] < 0 for row in told)
    print(f"labs with a forecast below a slower measured force: {below}")
    print(f"forecasts refused: {sum(row['forecast_refused'] is not None for row in told)}")
    print(f"forecasts inside the band: {sum(held)} of {len(held)}")
    widths = [one for row in told for one in row["half_width"]]
    print(f"half width of a band: {np.median(widths):.1%} in the median")
    print(f"identification: {np.median([row['seconds'][1] for row in told]):.0f} s")


if __name__ == "__main__":
    main()
