"""The flat punch on a layer: what docs/punch.md states of it; four minutes on two cores.

`python benchmarks/punch.py [--draw]` runs chapter 3 of Maghami, PhD thesis (2025), for a standard
solid with k = 0.1, a = 64.85 a0 and a cohesion of 0.05 where nothing else is said: the pull-off
stress by thickness and rate (Fig. 3.6) between the two elastic ones, the six loading protocols of
Table 3.1 (Fig. 3.5), surface energy (Fig. 3.9) and work of separation (Fig. 3.10); and elastic runs
beside the exact curve between thin and thick layers. --draw makes the pictures of the page,
--record writes the records that it quotes.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path
from time import perf_counter, process_time
from typing import Any, NamedTuple

import matplotlib.style
import numpy as np
from cases import spread_out, standard_solid
from matplotlib.figure import Figure

import viscotack
from viscotack import (
    Approach,
    AtDepth,
    Bonded,
    Elastic,
    Frictionless,
    StandardSolid,
    crack_speed_at_pull_off,
    draw_regimes,
    effective_surface_energy,
    ligament_at_pull_off,
    pull_off_stress,
    save_figure,
    solve,
    work_of_separation,
)
from viscotack.bem.twins.plain_punch import plain_solve
from viscotack.geometry import FlatPunch, Layer
from viscotack.problem import Groups
from viscotack.theory.punch import Pad, regime_map
from viscotack.theory.punch import crossover as exact_curve

STYLE = Path(viscotack.__file__).parent / "pictures/viscotack.mplstyle"
DOCS = Path(__file__).resolve().parents[1] / "docs"
SIZE, COHESION, K = 64.85, 0.05, 0.1
ELASTIC = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
# B = b/a from 0.001 to 10, the ends of the thesis's range; its thicknesses are not printed.
THICKNESSES = SIZE * np.geomspace(1e-3, 10, 30)
RATES = (0.1, 1.0, 10.0, 100.0)
FOUR = (3.24, 6.48, 12.97, 32.42)
# Six protocols: depth at rest, depth of loading, loading rate; then retraction at 10.
VERY_FAST = 1e7
PROTOCOLS = (
    (0.0, 1.0, VERY_FAST),
    (1.0, 1.0, None),
    (0.0, 1.0, 5.0),
    (0.0, 2.0, VERY_FAST),
    (2.0, 2.0, None),
    (0.0, 2.0, 5.0),
)


class Work(NamedTuple):
    """A case, and how it is solved."""

    groups: Groups
    until: str = "pull-off"
    accuracy: float = 2e-3
    estimate: bool = False


class Answer(NamedTuple):
    """What comes out; nan where it was not reached."""

    stress: float
    ligament: float
    crack_speed: float
    energy: float
    work: float
    residual: float
    seconds: float
    error: float


def case(thickness: float, rate: float, **changes: Any) -> Groups:
    """Return a case of the thesis."""
    standard = Groups(
        tabor=None,
        cohesion=COHESION,
        geometry=FlatPunch(SIZE),
        body=Layer(thickness),
        material=standard_solid(K),
        start=AtDepth(1.0),
        rate=rate,
    )
    return replace(standard, **changes)


def relaxed(thickness: float, size: float = SIZE) -> Groups:
    """Return the elastic layer of the rubbery modulus, the slowest retraction."""
    return case(thickness, 1.0, geometry=FlatPunch(size), material=ELASTIC)


def glassy(thickness: float, size: float = SIZE) -> Groups:
    """Return the elastic layer of the glassy modulus: a0 is 1/k times as long for it."""
    slow = relaxed(K * thickness, K * size)
    return replace(slow, cohesion=K * COHESION)


def measure(work: Work) -> Answer:
    """Solve a case."""
    began = process_time()
    result = solve(
        work.groups, accuracy=work.accuracy, until=work.until, estimate_error=work.estimate
    )
    seconds = process_time() - began
    thin = work.groups.body.thickness < 4 / np.pi * work.groups.geometry.half_width
    return Answer(
        stress=pull_off_stress(result),
        ligament=ligament_at_pull_off(result),
        crack_speed=crack_speed_at_pull_off(result),
        energy=effective_surface_energy(result) if thin else np.nan,
        work=work_of_separation(result) if work.until == "detached" else np.nan,
        residual=float(result.energy_residual or 0.0),
        seconds=seconds,
        error=(result.error_estimate or {}).get("force", np.nan),
    )


def table(works: list[Work]) -> np.ndarray:
    """Return the answers as rows."""
    return np.array(spread_out(measure, works))


def thickness_and_rate() -> dict[str, Any]:
    """Print Fig. 3.6, 120 cases between the two elastic ones, and return errors and times."""
    found = table([Work(case(float(b), r)) for b in THICKNESSES for r in RATES])
    seconds = found[:, 6].sum()
    stress = found[:, 0].reshape(-1, len(RATES))
    print(
        f"120 cases of Fig. 3.6: {seconds:.1f} s of processor time, energy residual "
        f"{found[:, 5].max():.1e} at most"
    )
    limits = table([Work(f(float(b))) for b in THICKNESSES for f in (relaxed, glassy)])
    slow, fast = limits[:, 0].reshape(-1, 2).T
    thin = (THICKNESSES > 3) & (THICKNESSES < 0.2 * SIZE)
    b, ligament = THICKNESSES[thin], limits[::2, 1][thin]
    law = np.sqrt(4 / (np.pi * b)) * (1 + 0.177 * b / SIZE)
    for words, part in (("", 1.0), (", on the ligament", ligament)):
        off = 100 * (slow[thin] / part / law - 1)
        print(f"  slow one beside the thin-layer law: {off.min():.1f} to {off.max():.1f} %{words}")
    print(
        f"  below the slow elastic one by {1e3 * np.max(slow[:, None] / stress - 1):.2f} per mille"
    )
    print(
        f"  above the fast elastic one by {1e3 * np.max(stress / fast[:, None] - 1):.2f} per mille"
    )
    print(f"  energy residual of the elastic runs {limits[:, 5].max():.1e} at most")
    some = [(i, j) for i in range(2, 30, 3) for j in range(len(RATES))]
    cases = [case(float(THICKNESSES[i]), RATES[j]) for i, j in some]
    fine = table([Work(groups, accuracy=1e-4) for groups in cases])[:, 0]
    coarse = table([Work(groups, estimate=True) for groups in cases])
    errors = np.abs(coarse[:, 0] / fine - 1)
    print(
        f"  against a 20 times better accuracy, {len(some)} cases: "
        f"{100 * np.max(errors):.3f} % at most, {100 * np.median(errors):.3f} % in the median"
    )
    estimated = coarse[:, 7]
    ratio = np.median(estimated / np.maximum(errors, 1e-6))
    print(f"  estimates cover {np.sum(estimated >= errors)}, {ratio:.1f} times the error (median)")
    worst = int(np.argmax(np.max(stress, axis=1) / fast))
    b = float(THICKNESSES[worst])
    closer = table([Work(groups, accuracy=1e-4) for groups in (case(b, 100.0), glassy(b))])
    print(
        f"  where it is above most, fine: {closer[0, 0]:.5f} at rate 100, {closer[1, 0]:.5f} fast"
    )
    print("  b/a0      slow    0.1      1       10      100     fast")
    for row in np.column_stack([THICKNESSES, slow, stress, fast])[::3]:
        print("  " + "".join(f"{x:8.4f}" if i else f"{x:7.2f} " for i, x in enumerate(row)))
    return {
        "largest_error": np.max(errors),
        "median_error": np.median(errors),
        "covered": int(np.sum(estimated >= errors)),
        "compared": len(some),
        "estimate_over_error": ratio,
        "residual": max(found[:, 5].max(), limits[:, 5].max()),
        "below_slow": np.max(slow[:, None] / stress - 1),
        "above_fast": np.max(stress / fast[:, None] - 1),
        "seconds": seconds,
    }


def trial_values() -> dict[str, Any]:
    """Print two values beside those of an independent program, and return them."""
    values = {}
    for b, rate, expected in ((3.24, 1.0, 0.947), (32.42, 10.0, 0.4465)):
        found = measure(Work(case(b, rate), accuracy=1e-4)).stress
        print(f"trial value b = {b} a0, rate {rate:g}: {found:.4f} beside {expected}")
        values[f"{b:.0f}"] = found
    return {"trial": values}


def protocols() -> dict[str, Any]:
    """Print and return the spread over the six protocols of Table 3.1."""
    thicknesses = SIZE * np.array([0.001, 0.005, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 3.0, 10.0])
    works = []
    for b in thicknesses:
        for rest, load, speed in PROTOCOLS:
            moves = () if speed is None else (Approach(speed=speed, to=AtDepth(load)),)
            works.append(Work(case(float(b), 10.0, start=AtDepth(rest), moves=moves)))
    found = table(works)
    stress = found[:, 0].reshape(len(thicknesses), -1)
    change = 100 * (stress / stress[:, 1:2] - 1)
    print(f"six protocols: relative to the relaxed start [%], residual {found[:, 5].max():.1e}")
    for b, row in zip(thicknesses, change, strict=True):
        print(f"  b/a0 {b:7.3f}: " + " ".join(f"{x:+6.2f}" for x in row))
    spread = np.ptp(change, axis=1)
    print(f"  spread {spread.max():.2f} % at most")
    return {"protocols": spread.max() / 100}


def enhancement() -> dict[str, Any]:
    """Print the inset of Fig. 3.9, the largest surface energy by thickness; return its table."""
    lines = []
    print("largest surface energy, Eq. 3.30 with the ligament / whole, over what the size allows")
    sizes = (32.42, 64.84, 129.69)
    ratios = np.array([1.5, 2.0, 3.0, 5.0, 8.0, 12.7, 20.0, 32.42])
    for rate in (100.0, 1e4):
        works = [Work(case(float(b), rate, geometry=FlatPunch(s))) for s in sizes for b in ratios]
        found = table(works)
        energy = found[:, 3].reshape(len(sizes), -1)
        whole = energy * found[:, 1].reshape(len(sizes), -1) ** 2
        allowed = np.minimum(np.pi / 4 * ratios, 1 / K)
        for size, with_, without in zip(sizes, energy / allowed, whole / allowed, strict=True):
            print(f"  rate {rate:g}, a = {size} a0")
            for words, row in (("ligament", with_), ("whole", without)):
                print(f"    {words:<9}" + " ".join(f"{x:6.3f}" for x in row))
                if rate == 100.0:
                    case_ = f"a = {size} a0, ligament" if words == "ligament" else words
                    lines.append(f"| {case_} | {' | '.join(f'{x:.3f}' for x in row)} |")
    print("    b/a0     " + " ".join(f"{b:6.2f}" for b in ratios))
    head = f"| b/a0 | {' | '.join(f'{b:.3g}' for b in ratios)} |"
    return {"surface_energy": [head, "|---" * (len(ratios) + 1) + "|", *lines]}


def bell() -> dict[str, Any]:
    """Print Fig. 3.10, the work of separation by thickness and rate; return its table."""
    lines = [
        "| b/a0 | rate 1e-3 | largest | at rate | rate 1e4 | elastic theory |",
        "|---" * 6 + "|",
    ]
    rates = np.geomspace(1e-3, 1e4, 22)
    found = table([Work(case(b, float(r)), until="detached") for b in FOUR for r in rates])
    works = found[:, 4].reshape(len(FOUR), -1)
    speeds = found[:, 2].reshape(len(FOUR), -1)
    print(f"work of separation [dg0]: 88 runs to separation, residual {found[:, 5].max():.1e}")
    for b, row, speed in zip(FOUR, works, speeds, strict=True):
        elastic = exact_curve.work_of_separation(
            b, half_width=SIZE, work_of_adhesion=1.0, base=Frictionless()
        )
        top = int(np.argmax(row))
        print(
            f"  b = {b:5.2f} a0: {row[0]:.3f} slow, {row[top]:.3f} at rate {rates[top]:.3g} (crack "
            f"speed {speed[top]:.3g} h0/tau), {row[-1]:.3f} fast; elastic theory {elastic:.3f}"
        )
        lines.append(
            f"| {b} | {row[0]:.2f} | {row[top]:.2f} | {rates[top]:.2g} | {row[-1]:.3f} "
            f"| {elastic:.3f} |"
        )
    return {"work": lines}


def crack_speeds() -> dict[str, Any]:
    """Print the crack speed at pull-off over the rate at two accuracies; return its table."""
    rates = (1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 1e4)
    lines = ["| rate | 1 | 3 | 10 | 30 | 100 | 300 | 1000 | 1e4 |", "|---" * (len(rates) + 1) + "|"]
    for accuracy, words in ((2e-3, "2e-3"), (1e-4, "1e-4")):
        speeds = table([Work(case(3.24, r), accuracy=accuracy) for r in rates])[:, 2]
        over = " | ".join(f"{v / r:.0f}" for v, r in zip(speeds, rates, strict=True))
        lines.append(f"| accuracy {words} | {over} |")
    print("\n".join(lines))
    return {"crack_speed": lines}


def crossover() -> dict[str, Any]:
    """Print elastic runs, extrapolated to small cohesive zones, beside the exact curve.

    A crack of finite zone recedes by a part of the punch before pull-off, which falls as the root
    of a0/a; a parabola in that root through three sizes leads to the limit.
    """
    ratios = np.array([0.05, 0.2, 0.5, 1.0, 4 / np.pi, 2.0, 5.0, 10.0])
    sizes = np.array([64.0, 256.0, 1024.0])
    works = [Work(relaxed(float(B * s), float(s))) for B in ratios for s in sizes]
    found = table(works)
    stress = found[:, 0].reshape(len(ratios), -1) * np.sqrt(sizes)
    limits = np.polynomial.polynomial.polyfit(1 / np.sqrt(sizes), stress.T, 2)[0]
    exact = exact_curve.pull_off_stress(
        ratios, half_width=1.0, contact_modulus=1.0, work_of_adhesion=2 / np.pi, base=Frictionless()
    )
    lines = ["| b/a | 64 | 256 | 1024 | limit | exact | off by |", "|---" * 7 + "|"]
    print("elastic pull-off stress over that of a thin layer or a half-plane, the larger one;")
    print(f"residual {found[:, 5].max():.1e}; runs at a/a0 = 64, 256 and 1024, and their limit")
    for B, row, limit, value in zip(ratios, stress, limits, np.asarray(exact), strict=True):
        envelope = max(np.sqrt(4 / (np.pi * B)), 1.0)
        print(
            f"  b/a {B:6.3f}: "
            + " ".join(f"{x / envelope:.4f}" for x in row)
            + f", limit {limit / envelope:.4f}, exact {value / envelope:.4f} "
            + f"({100 * (limit / value - 1):+.2f} %)"
        )
        name = "4/pi (b1)" if 1 < B < 2 else f"{B:g}"
        cells = [
            *(f"{x / envelope:.3f}" for x in row),
            *(f"{x / envelope:.4f}" for x in (limit, value)),
        ]
        lines.append(f"| {name} | {' | '.join(cells)} | {100 * (limit / value - 1):.2f} % |")
    return {"crossover": lines}


def bonded() -> None:
    """Print the same limit of glued layers beside the thin-layer law of appendix I."""
    sizes, B = np.array([64.0, 256.0, 1024.0]), 0.05
    for nu in (0.0, 0.3, 0.45):
        base = Bonded(poisson_ratio=nu)
        cases = [replace(relaxed(B * s, s), body=Layer(B * s, base)) for s in sizes.tolist()]
        found = table([Work(groups) for groups in cases])
        limit = np.polynomial.polynomial.polyfit(
            1 / np.sqrt(sizes), found[:, 0] * np.sqrt(sizes), 2
        )[0]
        law = np.sqrt(4 / (np.pi * B * base.foundation))
        exact = exact_curve.pull_off_stress(
            B, half_width=1.0, contact_modulus=1.0, work_of_adhesion=2 / np.pi, base=base
        )
        print(
            f"bonded, nu = {nu}, b = {B} a: limit {limit:.4f}, exact {exact:.4f}, "
            f"thin-layer law {law:.4f} sigma0 sqrt(a0/a); residual {found[:, 5].max():.1e}"
        )


def twin() -> None:
    """Print the fast solver beside the thesis's algorithm, M = 200."""
    for b, rate, last in ((3.24, 1.0, -5.5), (32.42, 10.0, -25.0)):
        groups = case(b, rate)
        began = perf_counter()
        plain = plain_solve(groups, triangles=200, steps=400, last_depth=last)
        seconds, found = perf_counter() - began, measure(Work(groups))
        slow = pull_off_stress(plain)
        excess = 100 * (slow / found.stress - 1)
        print(
            f"b = {b} a0, rate {rate:g}: plain twin {slow:.4f} in {seconds:.1f} s, fast solver "
            f"{found.stress:.4f} in {found.seconds:.2f} s ({excess:+.2f} %)"
        )


def draw() -> None:
    """Draw the curves and the map of docs/punch.md."""
    stress = table([Work(case(float(b), r)) for b in THICKNESSES for r in RATES])[:, 0]
    limits = table([Work(f(float(b))) for b in THICKNESSES for f in (relaxed, glassy)])[:, 0]
    slow, fast = limits.reshape(-1, 2).T
    with matplotlib.style.context(STYLE):
        figure = Figure(figsize=(13.0, 5.4))
        left, right = figure.subplots(1, 2)
        left.plot(THICKNESSES, fast, "k-", lw=1, label="elastic, glassy")
        for marker, rate, column in zip("os^D", RATES, stress.reshape(-1, 4).T, strict=True):
            left.plot(THICKNESSES, column, marker, mfc="none", ms=5, label=f"rate {rate:g}")
        left.plot(THICKNESSES, slow, "k--", lw=1, label="elastic, rubbery")
        left.set_xscale("log")
        left.set_yscale("log")
        left.set_yticks([0.1, 0.2, 0.5, 1.0], ["0.1", "0.2", "0.5", "1"])
        left.minorticks_off()
        left.set_xlabel("thickness / $a_0$")
        left.set_ylabel(r"pull-off stress / $\sigma_0$")
        left.legend(fontsize=11)
        for rate in RATES:
            result = solve(case(3.24, rate), estimate_error=False)
            right.plot(result.depth, -result.force, lw=1.5, label=f"rate {rate:g}")
        right.set_xlim(-9, 1.2)
        right.set_xlabel("depth / $h_0$")
        right.set_ylabel(r"mean tension / $\sigma_0$, $b = 3.24\,a_0$")
        right.legend(fontsize=11)
    save_figure(figure, DOCS / "punch_stress.png")
    solid = StandardSolid(
        rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    )
    pad = Pad(
        half_width=1e-3,
        contact_modulus=1e6,
        work_of_adhesion=0.05,
        strength=5e4,
        base=Frictionless(),
    )
    law = pad.crack_law("greenwood", material=solid)
    found = regime_map(np.geomspace(1e-5, 5e-3, 121), np.geomspace(1e-6, 1.0, 121), pad, law)
    save_figure(draw_regimes(found), DOCS / "punch_map.png")


def main() -> None:
    """Measure, and draw if asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--draw", action="store_true", help="make the pictures of docs/punch.md")
    parser.add_argument("--record", action="store_true", help="record what docs/punch.md quotes")
    parser.add_argument("--only", help="one of the parts, by the name of its function")
    options = parser.parse_args()
    if options.draw:
        draw()
        return
    parts = (
        thickness_and_rate, trial_values, twin, protocols, enhancement, bell, crack_speeds,
        crossover, bonded,
    )  # fmt: skip
    for part in parts:
        if options.only in (None, part.__name__):
            began = perf_counter()
            values = part()
            if options.record and values:
                print(json.dumps(values, indent=1))
            print(f"  {perf_counter() - began:.1f} s\n", flush=True)


if __name__ == "__main__":
    main()
