"""Make the files of this folder: what a rig would write of a glass lens on PDMS 10:1.

    python examples/from_rig/make.py

Computed by the contact whose edge is a steady crack, with 5 uN of noise, a drift and a zero; the
approach, which the theory of a receding contact does not have, is Hertz's.
"""

from pathlib import Path

import numpy as np

import viscotack as vt
from viscotack.model.materials.library import published

FOLDER = Path(__file__).parent
RADIUS, WORK_OF_ADHESION, GAP, PRELOAD = 5.19e-3, 0.1523, 200e-9, 1.5e-3
SPEEDS = {"slow": 1e-8, "1_um_s": 1e-6, "30_um_s": 30e-6, "1000_um_s": 1e-3}


def columns(speed, noise=5e-6, seed=0):
    """Return time, gap, force and contact radius of approach, dwell and retraction."""
    problem = vt.Problem(
        material=published("pdms-10-1").material,
        traction=vt.LennardJones(work_of_adhesion=WORK_OF_ADHESION, equilibrium_gap=GAP),
        geometry=vt.Sphere(radius=RADIUS),
        protocol=vt.Retraction(start=vt.AtForce(PRELOAD), speed=speed),
    )
    found, modulus = vt.crack_contact(problem), 1.458e6 / 0.75
    unit = (np.pi * RADIUS**2 * WORK_OF_ADHESION / modulus) ** (1 / 3)
    steps = np.linspace(0, 1, 450)
    depth = found.depth * GAP
    back = np.linspace(depth[0], depth[-1], 450)
    force = np.interp(-back, -depth, found.force) * 1.5 * np.pi * RADIUS * WORK_OF_ADHESION
    size = np.interp(-back, -depth, found.contact_radius) * unit
    free = depth[-1] - 30e-6 * steps[1:250] / steps[249]
    down = np.linspace(free[-1], depth[0], 150)
    pressed = force[0] * (np.maximum(down, 0) / depth[0]) ** 1.5
    touched = np.sqrt(RADIUS * np.maximum(down, 0))
    depth = np.concatenate([down, np.full(30, depth[0]), back, free])
    force = np.concatenate([pressed, np.full(30, force[0]), force, np.zeros(free.size)])
    size = np.concatenate([touched, np.full(30, size[0]), size, np.zeros(free.size)])
    way = np.abs(np.diff(depth, prepend=depth[0]))
    pace = np.concatenate([np.full(180, 2e-6), np.full(depth.size - 180, speed)])
    time = np.cumsum(way / pace + np.where((way == 0) & (pace == 2e-6), 2.0, 0.0))
    rng = np.random.default_rng(seed)
    force = force + 2e-5 + 1e-5 * time / time[-1] + noise * rng.standard_normal(time.size)
    return time, 2e-3 - depth, force, size


def main():
    for seed, (name, speed) in enumerate(SPEEDS.items()):
        time, gap, force, size = columns(speed, seed=seed)
        lines = ["Time [s],Gap [mm],Normal Force [mN]"]
        rows = [
            f"{t:.7g},{1e3 * g:.7f},{1e3 * P:.4f}" for t, g, P in zip(time, gap, force, strict=True)
        ]
        if name == "slow":
            lines = ["Time [s],Gap [mm],Normal Force [mN],Contact radius [um]"]
            rows = [f"{row},{1e6 * a:.2f}" for row, a in zip(rows, size, strict=True)]
        (FOLDER / f"lens_{name}.csv").write_text("\n".join([*lines, *rows]) + "\n")


if __name__ == "__main__":
    main()
