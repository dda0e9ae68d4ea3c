"""Touch and part: the loop that force and depth make, at three speeds.

A glass bead of 5 mm radius comes down on soft rubber to a depth of 5 um and goes up again at the
same speed. The area of the loop is the work that is lost, nearly all of it as heat in the rubber.
It is largest at a middle speed: slowly the rubber answers as an elastic one, fast as a glassy one.

Prints a table and draws ``out/hysteresis.png``. Time: two seconds.
"""

from pathlib import Path

import numpy as np

import viscotack as vt
from viscotack.model.protocol import Apart, Approach

RUBBER = vt.StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5)
SPEEDS = (0.1e-6, 10e-6, 1e-3)  # m/s
DEPTH, GAP = 5e-6, 12e-6  # m
PICTURE = Path("out/hysteresis.png")


def loop(speed: float) -> vt.Problem:
    """Return the bead that goes down and up at this speed [m/s]."""
    return vt.Problem(
        material=RUBBER,
        traction=vt.LennardJones(work_of_adhesion=0.15, equilibrium_gap=1e-6),
        geometry=vt.Sphere(radius=5e-3),
        protocol=vt.Retraction(
            start=Apart(GAP), moves=(Approach(speed, to=vt.AtDepth(DEPTH)),), speed=speed
        ),
    )


def lost_work(result: vt.Result) -> dict[str, float]:
    """Return where the work of the loop went [nJ]."""
    unit = result.problem.scales().work * 1e9
    return {name: float(getattr(result.energy, name)[-1]) * unit for name in ("jumps", "heat")}


def draw(results: list[vt.Result], path: Path) -> None:
    """Draw the loops, approach dashed and retraction full."""
    import matplotlib as mpl
    import matplotlib.pyplot as plt
    import matplotlib.style

    colors = mpl.colormaps["viridis"](np.linspace(0.0, 0.8, len(results)))
    with matplotlib.style.context("viscotack.plot.viscotack"):
        figure, axes = plt.subplots(figsize=(8.5, 5.6))
        for result, color in zip(results, colors, strict=True):
            table = vt.columns(result)
            depth, force = table["depth_m"] * 1e6, table["force_N"] * 1e3
            turn = int(np.argmax(depth))
            speed = result.problem.protocol.speed
            axes.plot(depth[: turn + 1], force[: turn + 1], "--", color=color)
            axes.plot(depth[turn:], force[turn:], color=color, label=f"{speed * 1e6:g} µm/s")
        axes.axhline(0.0, color="0.7", lw=1, zorder=0)
        axes.set_xlabel("depth [µm]")
        axes.set_ylabel("force [mN], compression positive")
        axes.set_title("Down (dashed) and up again: most is lost at a middle speed")
        axes.legend(title="speed")
        vt.save_figure(figure, path)


def main(speeds=SPEEDS, accuracy: float = 2e-3, picture: Path = PICTURE) -> list[vt.Result]:
    print("   speed   pull-off      lost in jumps    as heat")
    print("    um/s         mN                 nJ         nJ")
    results = []
    for speed in speeds:
        result = vt.solve(loop(speed), accuracy=accuracy, estimate_error=False)
        force, lost = vt.summary(result)["pull_off_force_N"], lost_work(result)
        print(
            f"{speed * 1e6:8g}{force * 1e3:11.2f}{lost['jumps']:19.2f}{lost['heat']:11.2f}",
            flush=True,
        )
        results.append(result)
    picture.parent.mkdir(parents=True, exist_ok=True)
    draw(results, picture)
    print(f"Picture: {picture}")
    return results


if __name__ == "__main__":
    main()
