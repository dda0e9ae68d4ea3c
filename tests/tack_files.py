"""Small files of tack tests in the layouts of rigs and microscopes, all of one invented test.

A sphere of 5 mm on rubber by JKR: approach, dwell, retraction, then free of contact. Layouts follow
the instruments' exports; names and numbers are made up.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from viscotack.theory import jkr

SPHERE = {"radius": 5e-3, "contact_modulus": 1e6, "work_of_adhesion": 0.152}
SPEED, APPROACH_SPEED, DWELL = 20e-6, 50e-6, 10.0
FAR, DEEP = 200e-6, 20e-6  # where approach and retraction begin and end


@dataclass(frozen=True)
class Test:
    """What a rig would write: compression positive, depth positive into the solid."""

    time: np.ndarray
    force: np.ndarray
    drive: np.ndarray
    contact_radius: np.ndarray
    parts: tuple[int, ...]


def made(noise=0.0, zero=0.0, drift=0.0, tilt=0.0, compliance=0.0, sphere=SPHERE, seed=0):
    """Return approach, dwell and retraction of an elastic sphere, with the faults of a rig."""
    leaves = jkr.instability(**sphere).depth
    down = np.linspace(-FAR, DEEP, 500)
    up = np.linspace(DEEP, -FAR, 700)
    radius = [
        np.array([_radius(d, sphere, 0.0) for d in down]),
        np.full(60, _radius(DEEP, sphere, 0.0)),
        np.array([_radius(d, sphere, leaves) for d in up]),
    ]
    depth = np.concatenate([down, np.full(60, DEEP), up])
    a = np.concatenate(radius)
    force = np.where(a > 0, jkr.force(a, **sphere), 0.0)
    drive = depth + compliance * force
    way = np.abs(np.diff(drive, prepend=drive[0]))
    step = np.concatenate([way[:500] / APPROACH_SPEED, np.full(60, DWELL / 60), way[560:] / SPEED])
    time = np.cumsum(step)
    rng = np.random.default_rng(seed)
    force = force + zero + drift * time + tilt * drive + noise * rng.standard_normal(time.size)
    return Test(time, force, drive, a, (500, 560, 1260))


def _radius(depth, sphere, first):
    """Return the contact radius at a depth; on the way in contact begins at depth 0."""
    return jkr.contact_radius_at_depth(depth, **sphere) if depth > first else 0.0


def text(headings, columns, above=(), separator=",", decimal=".", units=None, encoding="utf-8"):
    lines = [*above, separator.join(headings)]
    lines += [] if units is None else [separator.join(units)]
    for row in zip(*columns, strict=True):
        lines.append(separator.join(f"{x:.7g}" for x in row).replace(".", decimal))
    return ("\r\n".join(lines) + "\r\n").encode(encoding)


def plain(test):
    return text(
        ["Time [s]", "Depth [um]", "Force [mN]"], [test.time, 1e6 * test.drive, 1e3 * test.force]
    )


def with_camera(test):
    return text(
        ["Time [s]", "Depth [um]", "Force [mN]", "Contact radius [um]"],
        [test.time, 1e6 * test.drive, 1e3 * test.force, 1e6 * test.contact_radius],
    )


def anton_paar(test):
    """One file for each interval: numbers, newtons, a gap in millimetres."""
    edges = (0, *test.parts)
    files = []
    for begin, end in zip(edges, edges[1:], strict=False):
        part = slice(begin, end)
        files.append(
            text(
                ["Point No.", "Normal Force [N]", "Gap [mm]", "Time [s]"],
                [
                    np.arange(1.0, end - begin + 1),
                    test.force[part],
                    3 - 1e3 * test.drive[part],
                    test.time[part],
                ],
            )
        )
    return files


STIFFNESS = 1e4  # N/m, of an invented cantilever
LAYOUTS = Path(__file__).parent / "data" / "layouts" / "tack"
# every tenth point of the test without faults
TEXTS = {path.stem: path for path in sorted(LAYOUTS.iterdir()) if path.suffix in (".csv", ".txt")}
# the whole test: an archive of three segments with conversions based on each other; forward, held
# and backward curves of 32 bits; a wave of version 5 with three named columns and a note
BINARIES = {path.name: path for path in sorted(LAYOUTS.glob("curve.*"))}
