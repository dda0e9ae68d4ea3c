"""Compare tests chosen by `next_tests` with random ones, in simulated labs.

    python -m benchmarks.next_tests --labs 6 --out out/next_tests.jsonl

A lab of `benchmarks/labs.py` (solid, sphere and interface drawn; Tabor numbers of 30 to 3,000)
knows its material within 25 % of all times and 5 % of the moduli, off by a draw of that, and has
pulled a sphere at three slow speeds. It wants the force at a speed that it does not reach. Twice
it makes one more test out of 16 (eight speeds, two preloads), with 2 % of noise, identifies the
interface again and forecasts. One way the test is the best by `next_tests`, the other ways it is
drawn. The band of the forecast is compared, and its distance from the truth. Forces are those of
a contact whose edge is a steady crack.
"""

import argparse
import json
import time
from pathlib import Path

import numpy as np

from benchmarks.labs import lab_of
from viscotack import InputError, LennardJones, Problem, Retraction, Sphere, crack_contact
from viscotack.identify import PullOff, forecast_rates, identify_rates
from viscotack.identify.ranked_tests import Trial, next_tests
from viscotack.lab.tack import Measured
from viscotack.materials import Passport
from viscotack.materials.scaling import scaled
from viscotack.protocol import AtForce

NOISE, MORE, WAYS, SOLIDS, DOUBT = 0.02, 2, 3, 8, (0.05, 0.25)


class Given:
    """Labs of these Tabor numbers, without growth and disturbance."""

    growing = disturbed = False
    tabor = (30.0, 3e3)


def true_force(lab, trial):
    """Return the force of a test without noise [N]."""
    problem = Problem(
        material=lab["solid"],
        traction=LennardJones(work_of_adhesion=lab["work"], equilibrium_gap=lab["gap"]),
        geometry=Sphere(radius=lab["radius"]),
        protocol=Retraction(AtForce(trial.preload), trial.speed),
    )
    return crack_contact(problem).pull_off_force * problem.scales().force


def measured(lab, trial, rng):
    """Return a pull-off with noise."""
    force = true_force(lab, trial) * (1 + NOISE * rng.standard_normal())
    return PullOff(trial.speed, Measured(force, NOISE * force), trial.preload)


def identified(lab, passport, series):
    return identify_rates(
        series,
        material=passport,
        radius=lab["radius"],
        gaps=(lab["gap"] / 100, lab["gap"] * 100),
    )


def forecast(fit, wanted):
    """Return half the width of the band of ln(force), and ln of its middle."""
    found = forecast_rates(fit, [wanted.speed], preload=wanted.preload)
    return float(np.log(found.high[0] / found.low[0]) / 2), float(np.log(found.force[0]))


def tests_of(lab):
    """Return the series, the candidates and the wanted test of a lab."""
    middle = float(np.sqrt(lab["speeds"][0] * lab["speeds"][-1]))
    first = [Trial(middle * x, preload=lab["preload"]) for x in (0.03, 0.1, 0.3)]
    candidates = [
        Trial(float(middle * x), preload=lab["preload"] * y)
        for x in np.geomspace(0.01, 10, 8)
        for y in (0.3, 3.0)
    ]
    return first, candidates, Trial(90 * middle, preload=lab["preload"])


def slow_enough(lab):
    """Return a lab with speeds for which the theory holds at the wanted test."""
    for _ in range(8):
        try:
            true_force(lab, tests_of(lab)[2])
            return lab
        except InputError:
            lab = lab | {"speeds": lab["speeds"] / 10}
    raise RuntimeError("no speed of this lab is slow enough")


def possible(lab, candidates):
    """Return the candidates for which there is a true force."""
    found = []
    for each in candidates:
        try:
            true_force(lab, each)
            found.append(each)
        except InputError:
            pass
    return found


def done(seed):
    """Return the bands of a lab by chosen and by random tests."""
    begin = time.process_time()
    lab = slow_enough(lab_of(seed, Given))
    rng = lab["rng"]
    first, candidates, wanted = tests_of(lab)
    candidates = possible(lab, candidates)
    solids = [
        scaled(lab["solid"], modulus=float(E), time=float(t))
        for E, t in np.exp(rng.standard_normal((SOLIDS + 1, 2)) * DOUBT)
    ]
    passport = Passport(name="of a lab", material=solids[0], allowed=tuple(solids[1:]))
    series = [measured(lab, each, rng) for each in first]
    truth = float(np.log(true_force(lab, wanted)))
    start = identified(lab, passport, series)
    now = forecast(start, wanted)
    print(f"lab {seed}: half width {now[0]:.1%}, {time.process_time() - begin:.0f} s", flush=True)

    def way(choose):
        """Return width and error after each further test, and the tests."""
        known, fit, rows, made = list(series), start, [], []
        for _ in range(MORE):
            trial = choose(fit)
            made.append([trial.speed, trial.preload])
            known.append(measured(lab, trial, rng))
            fit = identified(lab, passport, known)
            width, middle = forecast(fit, wanted)
            rows.append([width, abs(middle - truth)])
        return {"rows": rows, "tests": made}

    best = way(lambda fit: next_tests(fit, candidates, wanted=[wanted]).ranked[0].trial)
    others = [way(lambda fit: candidates[rng.integers(len(candidates))]) for _ in range(WAYS)]
    return {
        "seed": seed,
        "tabor": lab["tabor"],
        "candidates": len(candidates),
        "now": [now[0], abs(now[1] - truth)],
        "best": best,
        "random": others,
        "seconds": time.process_time() - begin,
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--labs", type=int, default=6)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path("out/next_tests.jsonl"))
    asked = parser.parse_args()
    asked.out.parent.mkdir(parents=True, exist_ok=True)
    kept = asked.out.read_text().splitlines() if asked.out.exists() else []
    rows = {row["seed"]: row for row in map(json.loads, kept)}
    seed = asked.first
    while len(rows) < asked.labs:
        if seed not in rows:
            try:
                rows[seed] = done(seed)
            except (InputError, RuntimeError) as reason:
                print(f"lab {seed} is left out: {reason}", flush=True)
                seed += 1
                continue
            with asked.out.open("a") as file:
                file.write(json.dumps(rows[seed]) + "\n")
        seed += 1
    faster = 0
    for row in rows.values():
        drawn = np.array([[x[0] for x in each["rows"]] for each in row["random"]])
        best = np.array([x[0] for x in row["best"]["rows"]])
        faster += bool(np.all(best <= np.median(drawn, axis=0)))
        print(
            f"lab {row['seed']:3d}, mu {row['tabor']:6.0f}: half width now {row['now'][0]:.1%}, "
            f"best {' then '.join(f'{x:.1%}' for x in best)}, random (median) "
            f"{' then '.join(f'{x:.1%}' for x in np.median(drawn, axis=0))}; of the random ways "
            f"{np.mean(drawn[:, -1] > best[-1]):.0%} end wider; error {row['now'][1]:.1%}, then "
            f"{row['best']['rows'][-1][1]:.1%}; {row['seconds']:.0f} s"
        )
    print(f"narrower after each test than the median of random tests: {faster} of {len(rows)}")


if __name__ == "__main__":
    main()
