"""Compare published trends of stamps and arrays with the models, by sign and size.

    python benchmarks/trends.py

Read were the abstracts of Kim et al., Appl. Phys. Lett. 91, 161905 (2007), and Feng et al.,
Langmuir 23, 12555 (2007), doi:10.1021/la701555n, and table 1 of doi:10.1038/s41528-018-0037-x.
They do not state the geometries, so sizes depend on assumptions that the output names.
"""

from dataclasses import replace

import numpy as np

from viscotack import (
    AtForce,
    Backing,
    Elastic,
    LennardJones,
    PadArray,
    Problem,
    RetardationPowerLaw,
    Retraction,
    Sphere,
    crack_contact,
    pull_array,
)
from viscotack.pads import grid
from viscotack.pads.curve import Curve
from viscotack.pads.interacting import coupled, interactions
from viscotack.series import which_opens
from viscotack.series.opening import posed

PDMS = RetardationPowerLaw(
    rubbery_modulus=1.458e6,
    glassy_modulus=3.089e9,
    exponent=0.2207,
    tau0=18.76e-3,
    poisson_ratio=0.5,
)
STAMP = Problem(
    PDMS, LennardJones(0.05, 20e-9), Sphere(1e-3), Retraction(AtForce(1e-3), speed=1e-5)
)


def switching():
    """Ratio of the pull-off forces of a stamp of PDMS at two speeds."""
    speeds = 1e-6, 1e-5, 1e-4, 1e-3, 1e-2
    forces = [
        crack_contact(replace(STAMP, protocol=replace(STAMP.protocol, speed=v))).pull_off_force
        for v in speeds
    ]
    print("pull-off force of a PDMS tip over that at 1 um/s:")
    for v, force in zip(speeds, forces, strict=True):
        print(f"  {v * 1e6:8g} um/s: {force / forces[0]:.2f}")


def backing():
    """Load sharing of brittle fibres on a thick elastic backing, against a thin one."""
    print("brittle fibres on a half-space, force over that with equal load sharing:")
    E, radius = 1.0, 1.0
    for side, spacing in ((4, 4.0), (8, 4.0), (14, 4.0), (14, 8.0)):
        c = interactions(spacing * np.array(grid(side, side, 1.0)), E, radius=radius)
        # a disc on a half-space of the same modulus, until its tension reaches 1
        stiffness = 2 * E * radius
        end = -1.0 / stiffness
        fibre = Curve(np.array([0.0, end, end]), np.array([0.0, -1.0, 0.0]))
        found = coupled([fibre] * side**2, np.zeros(side**2), c)
        share = found.plate.pull_off_force / side**2
        print(f"  {side} x {side}, {spacing:g} radii apart: {share:.2f}")


def tilt():
    """Pull-off force of an array by the tilt of its plate."""
    pad = Problem(
        Elastic(rubbery_modulus=1.458e6, poisson_ratio=0.5),
        LennardJones(0.05, 20e-9),
        Sphere(1e-3),
        Retraction(AtForce(1e-3), 1e-5),
    )
    print("10 x 10 elastic pads, 0.5 mm apart, force over that without tilt:")
    for degrees in (0.0, 0.02, 0.05, 0.1, 0.2):
        backing = Backing(tilt=np.radians(degrees))
        array = PadArray(pad, grid(10, 10, 0.5e-3), backing=backing)
        found = pull_array(array, speed=1e-5, preload=100 * 0.2e-3)
        print(f"  {degrees:g} degrees: {found.load_sharing:.2f}, {len(found.order)} touch")


def temperature():
    """Which opens at one speed, if the times of the stamp are longer, as in the cold."""
    donor = Problem(
        Elastic(rubbery_modulus=72e9, poisson_ratio=0.17),
        LennardJones(0.1, 0.5e-9),
        Sphere(1.2e-3),
        STAMP.protocol,
    )
    print("donor or stamp opens at 10 um/s, by the factor on the times of the stamp:")
    for factor in (0.1, 1.0, 10.0):
        stamp = replace(STAMP, material=replace(PDMS, tau0=factor * PDMS.tau0))
        pair = (posed(each, preload=1e-3, speed=1e-5) for each in (donor, stamp))
        print(f"  {factor:g}: {('donor', 'stamp')[which_opens(*pair).nominal or 0]}")


if __name__ == "__main__":
    switching()
    backing()
    tilt()
    temperature()
