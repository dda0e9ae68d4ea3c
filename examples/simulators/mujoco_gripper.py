"""A pad of 64 soft domes in MuJoCo: lift 200 g at 1 mm/s, set it down, let go at 10 um/s.

Adhesion of MuJoCo is a number. Here it is a contact with memory, written by `viscotack export
contact` and called from MuJoCo's passive forces: the same pad holds when it is pulled fast and lets
go when it is pulled slowly. Needs `pip install mujoco` and a C compiler.

Run it from the folder of this file: ``python mujoco_gripper.py gripper.png gripper.gif``.
"""

import ctypes
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import mujoco
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.patches import Rectangle

import viscotack as vt
from viscotack.design.control import reduced_contact, reduced_header

DOMES = 64
SCENE = """
<mujoco>
  <option timestep="2e-4" integrator="implicitfast"/>
  <worldbody>
    <geom name="table" type="plane" size="0.1 0.1 0.01" solref="0.002 1" solimp="0.99 0.99 0.001"/>
    <body name="load" pos="0 0 0.02">
      <joint name="load" type="slide" axis="0 0 1"/>
      <geom name="load" type="box" size="0.02 0.02 0.02" mass="0.2" solref="0.002 1"/>
    </body>
    <body name="pad" pos="0 0 0.0462" gravcomp="1">
      <joint name="pad" type="slide" axis="0 0 1"/>
      <geom name="pad" type="box" size="0.005 0.005 0.005" mass="0.2" {pad}/>
    </body>
  </worldbody>
  <actuator>
    <position name="drive" joint="pad" kp="2e4" kv="100"/>
  </actuator>
</mujoco>
"""
# The pad starts so far above the load [m].
GAP = 1.2e-3
# Legs of the drive: speed [m/s] and travel [m], up positive: down, press, rest for 1 s, lift, set
# down, rest, let go, away.
LEGS = [
    (1e-3, -1.1e-3),
    (1e-4, -0.3e-3),
    (0, 0),
    (1e-3, 0.9e-3),
    (1e-3, -0.75e-3),
    (0, 0),
    (1e-5, 0.25e-3),
    (1e-3, 2e-3),
]


def drive():
    """Return times and heights of the corners of the drive."""
    time, height = [0.0], [0.0]
    for speed, travel in LEGS:
        time.append(time[-1] + (abs(travel) / speed if speed else 1.0))
        height.append(height[-1] + travel)
    return np.array(time), np.array(height)


def compiled(case):
    """Return the functions of a contact in C, and the size of its state."""
    folder = Path(tempfile.mkdtemp())
    header = reduced_header(reduced_contact(vt.read_case(case)), "dome")
    (folder / "dome.h").write_text(header)
    (folder / "dome.c").write_text(
        '#include "dome.h"\nsize_t size(void) { return sizeof(dome); }\n'
        "void apart(dome *it, double depth) { dome_apart(it, depth); }\n"
        "double step(dome *it, double d, double dt) { return dome_step(it, d, dt, NULL); }\n"
    )
    subprocess.run("cc -O2 -shared -fPIC dome.c -o dome.so -lm".split(), cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "dome.so"))
    library.size.restype, library.step.restype = ctypes.c_size_t, ctypes.c_double
    return library


class Adhesion:
    """The force between pad and load, for `mujoco.set_mjcb_passive`.

    MuJoCo calls it several times for one instant. The contact advances only when the time has: with
    a Runge-Kutta integrator, which goes back and forth, it has no meaning.
    """

    def __init__(self, model, library):
        if model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4:
            raise ValueError("integrator: a contact with memory cannot go back in time; not RK4")
        self.library, self.it = library, ctypes.create_string_buffer(library.size())
        self.library.apart(self.it, ctypes.c_double(-GAP))
        self.time, self.force = 0.0, 0.0

    def __call__(self, model, data):
        """Add the force to the passive forces."""
        if data.time > self.time:
            depth = data.joint("load").qpos[0] - data.joint("pad").qpos[0] - GAP
            dt = data.time - self.time
            one = self.library.step(self.it, ctypes.c_double(depth), ctypes.c_double(dt))
            self.time, self.force = data.time, DOMES * one
        data.joint("pad").qfrc_passive[0] += self.force
        data.joint("load").qfrc_passive[0] -= self.force


def run(constant, library):
    """Simulate with a constant adhesion, or None.

    Returns times [s], heights of the load [m], forces of the drive [N] and heights of the pad [m].
    """
    # With memory MuJoCo has no contact of its own between pad and load. Its adhesion is that of a
    # corner, of four in contact, and needs a gap in which it pulls.
    how = 'contype="0" conaffinity="0"'
    if constant is not None:
        how = f'adhesion="{constant / 4}" margin="2e-4" gap="2e-4"'
    mujoco.set_mjcb_passive(None)
    model = mujoco.MjModel.from_xml_string(SCENE.format(pad=how))
    data = mujoco.MjData(model)
    corners = drive()
    if constant is None:
        mujoco.set_mjcb_passive(Adhesion(model, library))
    rows = []
    try:
        while data.time < corners[0][-1]:
            data.ctrl[0] = np.interp(data.time, *corners)
            mujoco.mj_step(model, data)
            load, pad = (data.joint(name).qpos[0] for name in ("load", "pad"))
            rows.append((data.time, load, data.actuator("drive").force[0], pad))
    finally:
        mujoco.set_mjcb_passive(None)
    return np.array(rows)[::50].T


def film(runs, path):
    """Draw the last 4 mm between pad and load, four times as fast as they move."""
    figure, axes = plt.subplots(1, len(runs), figsize=(5, 2.2), layout="constrained")
    moving = []
    for ax, (label, (time, load, _, pad)) in zip(axes, runs.items(), strict=True):
        ax.set(xlim=(-12, 12), ylim=(-1, 4), xticks=[], title=label)
        shapes = [
            ax.add_patch(Rectangle((-11, -3), 22, 3, color="tab:gray")),
            ax.add_patch(Rectangle((-5, 0), 10, 9, color="tab:red")),
        ]
        moving.append((time, load, pad, shapes))
    axes[0].set_ylabel("height [mm]")

    def shown(at):
        for time, load, pad, (below, above) in moving:
            below.set_y(1e3 * np.interp(at, time, load) - 3)
            above.set_y(1e3 * (np.interp(at, time, pad) + GAP))
        figure.supxlabel(f"{at:.1f} s", fontsize="medium")

    frames = np.arange(0.0, drive()[0][-1], 0.5)
    FuncAnimation(figure, shown, frames=frames).save(path, PillowWriter(fps=8), dpi=64)
    plt.close(figure)


def main(picture="gripper.png", moving="gripper.gif"):
    """Lift and let go, draw it beside constant adhesions, and make a film."""
    library = compiled(Path(__file__).with_name("pad_dome.toml"))
    figure, axes = plt.subplots(3, 1, sharex=True, figsize=(6, 5.5), layout="constrained")
    axes[0].plot(drive()[0], drive()[1] * 1e3, "k")
    runs, lifted = {}, {}
    for label, constant in (("with memory", None), ("1.5 N", 1.5), ("3 N", 3.0)):
        runs[label] = time, height, force, _ = run(constant, library)
        axes[1].plot(time, height * 1e3, label=label)
        axes[2].plot(time, force, label=label)
        lifted[label] = float(height.max() * 1e3), float(height[-1] * 1e3)
        print(f"{label}: lifted {lifted[label][0]:.2f} mm, at the end {lifted[label][1]:.2f} mm")
    axes[0].set_ylabel("drive [mm]")
    axes[1].set_ylabel("load [mm]")
    axes[2].set(xlabel="time [s]", ylabel="force of the drive [N]")
    axes[1].legend()
    figure.savefig(picture, dpi=90)
    film(runs, moving)
    return lifted


if __name__ == "__main__":
    main(*sys.argv[1:])
