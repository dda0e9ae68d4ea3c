"""How long does it hold? A bead on rubber with a weight hung below it.

Below the elastic pull-off force the contact bears the load for ever; above it the edge creeps in
until the bead falls. The line is a crack of Persson and Brener in a relaxed JKR contact, with the
load counted beside the elastic pull-off force of forces that have a range.

Prints a table and draws ``out/dead_load.png``. Time: three seconds.
"""

from pathlib import Path

import numpy as np

import viscotack as vt
from viscotack.model.protocol import Dwell, LoadTo
from viscotack.theory import jkr, lennard_jones, persson_brener

RUBBER = vt.StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5)
RADIUS, WORK, GAP = 5e-3, 0.15, 1e-6  # m, J/m^2, m
LOADS = np.array([1.1, 1.2, 1.4, 1.7, 2.0, 2.5, 3.0, 4.0])  # elastic pull-off forces
LONGEST = 1e4  # s
PICTURE = Path("out/dead_load.png")


def hanging(load: float) -> vt.Problem:
    """Return the bead that rests under no force, and then bears this load [N]."""
    return vt.Problem(
        material=RUBBER,
        traction=vt.LennardJones(work_of_adhesion=WORK, equilibrium_gap=GAP),
        geometry=vt.Sphere(radius=RADIUS),
        protocol=vt.Retraction(
            start=vt.AtForce(0.0),
            moves=(LoadTo(-load, duration=1e-4), Dwell(LONGEST, hold="force")),
            speed=None,
        ),
    )


def crack_time(load: float) -> float:
    """Return the time [s] that the crack takes under a load [N], in a contact of no range."""
    E = RUBBER.contact_modulus
    scale = dict(contact_modulus=E, work_of_adhesion=WORK)
    law = vt.LennardJones(work_of_adhesion=WORK, equilibrium_gap=GAP)
    tip = persson_brener.crack_tip_length(strength=law.strength, strength_ratio=np.pi / 9, **scale)
    first = jkr.contact_radius_at_force(0.0, radius=RADIUS, **scale)
    a = np.linspace(first, 0.02 * first, 400)
    energy = (4 * E * a**3 / (3 * RADIUS) + load) ** 2 / (8 * np.pi * E * a**3) / WORK
    creeps = energy < 1 / RUBBER.modulus_ratio
    speed = np.asarray(persson_brener.speed(energy[creeps], material=RUBBER))
    return -float(np.trapezoid(RUBBER.time_unit / (tip * speed), a[creeps]))


def draw(loads, times, path: Path) -> None:
    """Draw the time to detachment by the load."""
    import matplotlib.pyplot as plt
    import matplotlib.style

    elastic = elastic_pull_off()
    fine = np.geomspace(1.03, loads[-1], 60)
    with matplotlib.style.context("viscotack.plot.viscotack"):
        figure, axes = plt.subplots(figsize=(8.0, 5.2))
        jkr_force = jkr.pull_off_force(radius=RADIUS, work_of_adhesion=WORK)
        theory = [crack_time(x * jkr_force) for x in fine]
        axes.semilogy(fine, theory, label="crack of Persson and Brener")
        axes.semilogy(loads, times, "o", mfc="white", label="simulation")
        axes.axvline(1.0, ls="--", color="0.4")
        axes.annotate("holds for ever", (1.0, times[len(times) // 2]), rotation=90, ha="right")
        axes.set_xlim(0.8, None)
        axes.set_xlabel(f"load [elastic pull-off force, {elastic * 1e3:.2f} mN]")
        axes.set_ylabel("time to detachment [s]")
        axes.set_title("How long does it hold?")
        axes.legend()
        vt.save_figure(figure, path)


def elastic_pull_off() -> float:
    """Return the elastic pull-off force [N] of forces that have this range."""
    tabor = hanging(1e-3).tabor
    ratio = float(lennard_jones.pull_off_ratio(tabor))
    return ratio * float(jkr.pull_off_force(radius=RADIUS, work_of_adhesion=WORK))


def main(loads=LOADS, accuracy: float = 2e-3, picture: Path = PICTURE) -> list[float]:
    elastic = elastic_pull_off()
    print(f"Elastic pull-off force: {elastic * 1e3:.2f} mN")
    below = vt.solve(hanging(0.98 * elastic), accuracy=accuracy, estimate_error=False)
    print(f"  2 % less, for {LONGEST:g} s: {below.status}\n")
    print("    load     holds for    crack")
    print("      mN             s        s")
    times = []
    for load in loads:
        problem = hanging(load * elastic)
        times.append(
            vt.time_to_detachment(vt.solve(problem, accuracy=accuracy, estimate_error=False))
        )
        expected = crack_time(load * jkr.pull_off_force(radius=RADIUS, work_of_adhesion=WORK))
        print(f"{load * elastic * 1e3:8.2f}{times[-1]:14.3f}{expected:9.3f}", flush=True)
    picture.parent.mkdir(parents=True, exist_ok=True)
    draw(loads, times, picture)
    print(f"Picture: {picture}")
    return times


if __name__ == "__main__":
    main()
