"""What docs/steady_crack.md says of the steady crack: its values, meshes, and the picture.

python benchmarks/steady_crack.py             the tables
python benchmarks/steady_crack.py --record    the table of other theories, recorded for the page
python benchmarks/steady_crack.py --figure    docs/steady_crack.png
"""

import argparse
import json
from pathlib import Path
from time import perf_counter

import numpy as np

from viscotack import (
    AtDepth,
    Dugdale,
    Exponential,
    Groups,
    LennardJones,
    Prony,
    StandardSolid,
    crack_contact,
)
from viscotack.theory import SteadyCrack
from viscotack.theory.crack.steady import _branch, _mesh, _start, best_strength_ratio, compared

SPEEDS = np.array([0.01, 0.1, 1.0, 10.0, 100.0, 1000.0])
LAWS = {
    "Lennard-Jones": LennardJones(1.0, 1.0),
    "exponential, 0.25": Exponential(1.0, 1.0, 0.25),
    "Dugdale": Dugdale(1.0, 1.0),
}


def standard(k=0.1):
    return StandardSolid(rubbery_modulus=1.0, glassy_modulus=1 / k, tau0=1.0, poisson_ratio=0.0)


def values():
    for name, law in LAWS.items():
        crack = SteadyCrack(standard(), law)
        for sign, word in ((1, "opening"), (-1, "closing")):
            gamma = "  ".join(f"{g:.4f}" for g in crack.amplification(sign * SPEEDS))
            print(f"{name:18} {word}  {gamma}")
        balance = [crack.at(v) for v in (*SPEEDS, 1e4, *-SPEEDS, -1e4)]
        missed = max(abs(p.amplification / (1 + np.sign(p.speed) * p.heat) - 1) for p in balance)
        others = compared(crack, SPEEDS)
        alpha, off = best_strength_ratio(crack)
        print(f"  1 + heat, 1 - heat: {missed:.1e}")
        print(f"  Persson-Brener off {np.round(others.off('persson_brener'), 3)}")
        print(f"  at best {off:.1%} with alpha {alpha:.3f}")
        print(f"  Greenwood off {np.round(others.off('greenwood'), 3)}")


def meshes():
    """Print how far a mesh twice as fine is from that in use."""
    for name, law in LAWS.items():
        for k in (0.1, 0.01):
            crack, soft = SteadyCrack(standard(k), law), _start.softened(law)
            length = _start.effective_range(soft) ** 2
            mesh = _mesh.mesh(length, 3e4 * length / k, refined=2.0)
            start, worst = _start.elastic(soft, mesh), 0.0
            for sign in (1, -1):
                fine = _branch.Branch(
                    mesh, _start.pinned(soft), crack.modes, start, crack.slow_coefficient, sign
                )
                for v in (0.1, 1.0, 10.0, 100.0):
                    found = fine.at(np.log(v)).amplification / start.amplification
                    worst = max(worst, abs(crack.amplification(sign * v) / found - 1))
            print(f"{name:18} k {k:g}: elastic {start.amplification - 1:.1e}, others {worst:.1e}")


def times():
    rng = np.random.default_rng(3)
    arms = tuple(zip(rng.uniform(0.1, 1, 20), 10 ** rng.uniform(-6, 3, 20), strict=True))
    solid = Prony(rubbery_modulus=1.0, poisson_ratio=0.0, branches=arms)
    begin = perf_counter()
    SteadyCrack(solid, LAWS["Lennard-Jones"]).amplification(np.geomspace(1e-4, 1e8, 1000))
    print(f"1,000 speeds of 20 arms: {perf_counter() - begin:.1f} s")


def other_cracks():
    """Return how far closed forms are off the steady crack, a row for each law."""
    rows = []
    for name, law in LAWS.items():
        crack = SteadyCrack(standard(), law)
        others, (alpha, off) = compared(crack, SPEEDS), best_strength_ratio(crack)
        spans = [span(others.off(theory)) for theory in ("persson_brener", "greenwood")]
        name = name.replace(", ", ", decay ")
        his = ": it is his crack" if name == "Dugdale" else ""
        rows.append(f"| {name} | {spans[0]} | {alpha:.3f}, {100 * off:.1f} % | {spans[1]}{his} |")
    return [
        "| law | Persson-Brener, α = π/9 | its best α, and off by | Greenwood, length of the "
        "strength |",
        "|---|---|---|---|",
        *rows,
    ]


def span(off):
    """Return least and largest of relative differences, in words."""
    ends = (100 * float(x) for x in (np.min(off), np.max(off)))
    low, high = (f"{x:+.{1 if abs(x) < 9.5 else 0}f}".replace("-", "−") for x in ends)
    return f"{low} to {high} %"


def figure(path):
    from matplotlib.figure import Figure

    drawn = Figure(figsize=(9, 3.8), layout="constrained")
    left, right = drawn.subplots(1, 2)
    crack, v = SteadyCrack(standard(), LAWS["Lennard-Jones"]), np.geomspace(1e-2, 1e4, 100)
    others = compared(crack, v)
    left.loglog(v, crack.amplification(v), "k", label="opens")
    left.loglog(v, crack.amplification(-v), "k--", label="closes")
    left.loglog(v, others.persson_brener, label="Persson-Brener, alpha = pi/9")
    left.loglog(v, others.greenwood, label="Greenwood")
    left.set_xlabel("speed [E0* h0^2/(dg tau)]")
    left.set_ylabel("energy [dg]")
    left.legend()
    tabor = np.geomspace(10, 1e6, 11)
    for rate in (0.1, 1.0, 10.0, 100.0):
        forces = [
            crack_contact(
                Groups(tabor=mu, material=standard(), start=AtDepth(20 * mu), rate=rate * mu)
            ).pull_off_force
            for mu in tabor
        ]
        right.semilogx(tabor, forces, label=f"{rate:g} mu h0/tau")
    right.set_xlabel("Tabor number")
    right.set_ylabel("pull-off force [1.5 pi R dg]")
    right.legend(title="retraction")
    drawn.savefig(path, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--figure", action="store_true")
    parser.add_argument("--record", action="store_true")
    given = parser.parse_args()
    if given.record:
        print(json.dumps({"others": other_cracks()}, indent=1))
        return
    if given.figure:
        figure(Path(__file__).parents[1] / "docs" / "steady_crack.png")
        return
    values()
    meshes()
    times()


if __name__ == "__main__":
    main()
