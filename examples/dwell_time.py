"""Contact ageing: the longer a bead has rested on rubber, the harder it is to pull off.

The bead is pressed on within 10 ms, rests for a while at that depth, and is pulled off at 100 um/s.
The contact grows while the rubber relaxes; when it has come to rest the pull-off force is that of
the relaxed contact, the dashed line.

Prints a table and draws ``out/dwell_time.png``. Time: three seconds.
"""

from pathlib import Path

import numpy as np

import viscotack as vt
from viscotack.model.protocol import Dwell, MoveTo

RUBBER = vt.RetardationPowerLaw(
    rubbery_modulus=1.5e6, glassy_modulus=150e6, exponent=0.4, tau0=1.0, poisson_ratio=0.5
)
DWELLS = np.geomspace(1e-3, 1e3, 13)  # s
DEPTH, TOUCH, SPEED = 5e-6, 10e-3, 100e-6  # m, s, m/s
PICTURE = Path("out/dwell_time.png")


def bead(*moves, start: float = 0.0) -> vt.Problem:
    """Return the bead that makes these moves from a relaxed depth [m] before it is pulled off."""
    return vt.Problem(
        material=RUBBER,
        traction=vt.LennardJones(work_of_adhesion=0.15, equilibrium_gap=1e-6),
        geometry=vt.Sphere(radius=5e-3),
        protocol=vt.Retraction(start=vt.AtDepth(start), moves=moves, speed=SPEED),
    )


def pull_off(problem: vt.Problem, accuracy: float) -> float:
    """Return the pull-off force [mN]."""
    result = vt.solve(problem, accuracy=accuracy, until="pull-off", estimate_error=False)
    return vt.pull_off_force(result) * problem.scales().force * 1e3


def draw(dwells, forces, relaxed: float, path: Path) -> None:
    """Draw the pull-off force by the dwell time."""
    import matplotlib.pyplot as plt
    import matplotlib.style

    with matplotlib.style.context("viscotack.plot.viscotack"):
        figure, axes = plt.subplots(figsize=(8.0, 5.2))
        axes.semilogx(dwells, forces, "o-", mfc="white", label="simulation")
        axes.axhline(relaxed, ls="--", color="0.4", label="relaxed contact")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.set_xlabel("dwell time [s]")
        axes.set_ylabel("pull-off force [mN]")
        axes.set_title("A contact that has rested holds harder")
        axes.legend()
        vt.save_figure(figure, path)


def main(dwells=DWELLS, accuracy: float = 2e-3, picture: Path = PICTURE) -> tuple:
    relaxed = pull_off(bead(start=DEPTH), accuracy)
    print("   dwell   pull-off")
    print("       s         mN")
    forces = []
    for dwell in dwells:
        forces.append(pull_off(bead(MoveTo(DEPTH, TOUCH), Dwell(float(dwell))), accuracy))
        print(f"{dwell:8.3g}{forces[-1]:11.2f}", flush=True)
    print(f" relaxed{relaxed:11.2f}")
    picture.parent.mkdir(parents=True, exist_ok=True)
    draw(dwells, forces, relaxed, picture)
    print(f"Picture: {picture}")
    return relaxed, forces


if __name__ == "__main__":
    main()
