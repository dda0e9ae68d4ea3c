"""Read the raw curves of the microsphere from a checkout of their repository, and measure them."""

import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

from viscotack.arrays import Array
from viscotack.theory import jkr

RADIUS = 7.5e-6  # m
STIFFNESS = 3.01  # N/m, of the spring whose displacement is the force
_FOLDER = "Nanoindentation Datenauswertung/data"
_MOVING = 0.5  # part of the median step of the drive above which it moves
_ZERO = 50  # samples at the start, far from the surface, that are the zero of the force


@dataclass(frozen=True, eq=False)
class Curve:
    """One test: drive [m, positive into the solid], force [N, compression positive], time [s]."""

    drive: Array
    force: Array
    time: Array

    @property
    def jump_in(self) -> int:
        """Index of the last sample before the contact."""
        return int(np.diff(self.force[: self.drive.argmax()]).argmin())

    @property
    def pull_off(self) -> int:
        """Index of the largest tension."""
        return int(self.force.argmin())

    @property
    def pull_off_force(self) -> float:
        """Largest tension [N]."""
        return -float(self.force.min())

    @property
    def retraction(self) -> int:
        """Index of the first sample of the last motion out of the solid."""
        step = np.diff(self.drive[: self.pull_off])
        return int(np.flatnonzero(step > _MOVING * step.min())[-1]) + 1

    @property
    def speed(self) -> float:
        """Speed of the drive in the retraction [m/s]."""
        part = slice(self.retraction, self.pull_off)
        return -float(np.polyfit(self.time[part], self.drive[part], 1)[0])

    @property
    def jump_in_force(self) -> float:
        """Largest tension before the first compression [N]."""
        after = self.force[self.jump_in + 1 :]
        return -float(after[: int((after > 0).argmax())].min())

    @property
    def contact_time(self) -> float:
        """Time from jump-in to pull-off [s]."""
        return float(self.time[self.pull_off] - self.time[self.jump_in])

    @property
    def travel_to_snap_off(self) -> float:
        """Travel of the drive from the largest tension to the loss of half of it [m]."""
        after = self.force[self.pull_off :]
        gone = int((after > 0.5 * after[0]).argmax())
        return float(self.drive[self.pull_off] - self.drive[self.pull_off + gone])


def names(repository: Path) -> list[str]:
    """List the files of the measurements on silicone, without opening them."""
    command = ["git", f"--git-dir={repository}", "ls-tree", "-r", "-z", "--name-only", "HEAD"]
    found = subprocess.run([*command, _FOLDER], capture_output=True, check=True).stdout
    every = [name.removeprefix(_FOLDER + "/") for name in found.decode().split("\0")]
    return [name for name in every if name.startswith("PDMS")]


def curves(repository: Path, name: str) -> list[Curve]:
    """Read the curves of one file: decimal commas, Latin-1, blocks behind POC or eoh.

    The piezo is in um under the heading [nm], and the time in s under [ms].
    """
    command = ["git", f"--git-dir={repository}", "show", f"HEAD:{_FOLDER}/{name}"]
    text = subprocess.run(command, capture_output=True, check=True).stdout.decode("latin-1")
    blocks = text.replace(",", ".").split("eoh")[1].split("POC")
    found = []
    for block in blocks:
        rows = [line.split("\t") for line in block.splitlines()]
        numbers = np.array([row[:3] for row in rows if len(row) == 6], dtype=float)
        if len(numbers) > _ZERO:
            drive, spring, time = (numbers * (1e-6, 1e-9, 1.0)).T
            force = STIFFNESS * (spring - spring[:_ZERO].mean())
            found.append(Curve(drive, force, time))
    return found


def jkr_fit(curve: Curve) -> tuple[float, float]:
    """Fit E0* [Pa] and work of adhesion [J/m2] to the forces of the retraction at its drives."""
    part = slice(curve.retraction, curve.pull_off)
    drive, force = curve.drive[part], curve.force[part]
    radii = np.linspace(0.05, 1.0, 2000) * RADIUS

    def residuals(unknown: Array) -> Array:
        solid = {"radius": RADIUS, "contact_modulus": 1e6 * unknown[0]}
        solid["work_of_adhesion"] = 1e-3 * unknown[1]
        forces = np.asarray(jkr.force(radii, **solid))
        drives = np.asarray(jkr.depth(radii, **solid)) + forces / STIFFNESS
        stable = slice(int(drives.argmin()), None)
        there = np.interp(drive - 1e-6 * unknown[2], drives[stable], forces[stable])
        return (there - force) / 1e-9

    zero = 1e6 * float(np.interp(0.0, force[::-1], drive[::-1]))
    best = least_squares(residuals, [1.8, 60.0, zero - 0.4], x_scale=[1.0, 30.0, 0.1])
    return 1e6 * float(best.x[0]), 1e-3 * float(best.x[1])
