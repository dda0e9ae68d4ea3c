"""Why a rough rubber does not stick: pull-off of a rough sphere by roughness, stiffness and speed.

    python examples/rough/why_not_sticky.py [picture.png]

A glass sphere with self-affine roughness is pulled off silicones of two stiffnesses, slowly and
fast. Roughness takes the grip of the stiff one first, and pulling fast gives a part of it back.
"""

import sys
from pathlib import Path

import viscotack as vt
from viscotack.model.surfaces import self_affine, sphere
from viscotack.simulate.rough import RoughProblem, pull, stickiness

RADIUS, GAP, WORK = 5e-3, 1.5e-6, 0.1
PIXELS, PIXEL = 80, 12e-6
HEIGHTS = (0.0, 0.5e-6, 1e-6, 2e-6, 4e-6)
STIFFNESSES = {"0.75 MPa": 0.75e6, "3 MPa": 3e6}
SPEEDS = {"10 um/s": 1e-5, "1 mm/s": 1e-3}


def surface(rms_height):
    """Return the sphere with roughness of this rms height [m]."""
    smooth = sphere(PIXELS, PIXEL, radius=RADIUS)
    if not rms_height:
        return smooth
    rough = self_affine(
        PIXELS,
        PIXEL,
        hurst=0.8,
        rms_height=rms_height,
        seed=7,
        roll_off=240e-6,
        shortest=80e-6,
        periodic=False,
    )
    return smooth + rough


def problem(rms_height, modulus, speed):
    """Return the pull after a preload of 0.5 mN."""
    rubber = vt.StandardSolid(
        rubbery_modulus=modulus, glassy_modulus=10 * modulus, tau0=0.05, poisson_ratio=0.5
    )
    return RoughProblem(
        surface=surface(rms_height),
        material=rubber,
        traction=vt.LennardJones(work_of_adhesion=WORK, equilibrium_gap=GAP),
        protocol=vt.Retraction(start=vt.AtForce(0.5e-3), speed=speed),
    )


def main(picture=None, heights=HEIGHTS, accuracy=5e-3):
    """Print the forces [mN] and draw their ratio to those of the smooth sphere."""
    forces = {}
    for stiff, modulus in STIFFNESSES.items():
        for fast, speed in SPEEDS.items():
            row = []
            for height in heights:
                case = problem(height, modulus, speed)
                found = pull(case, accuracy=accuracy, estimate_error=False)
                row.append(found.pull_off_force)
            forces[stiff, fast] = row
            measure = stickiness(case).full_contact
            numbers = " ".join(f"{1e3 * force:6.3f}" for force in row)
            print(f"{stiff:9s} {fast:8s} {numbers} mN; energy of full contact, last {measure:.2g}")
    if picture is not None:
        _drawn(forces, heights).savefig(picture)
    return forces


def _drawn(forces, heights):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.subplots()
    styles = {"10 um/s": "--", "1 mm/s": "-"}
    colours = {"0.75 MPa": "#08519c", "3 MPa": "#d94801"}
    for (stiff, fast), row in forces.items():
        axes.plot(
            [1e6 * height for height in heights],
            [force / row[0] for force in row],
            styles[fast],
            color=colours[stiff],
            marker="o",
            label=f"{stiff}, {fast}",
        )
    axes.set_xlabel("rms height of the roughness [µm]")
    axes.set_ylabel("pull-off force over that of a smooth sphere")
    axes.set_ylim(0, None)
    axes.legend(frameon=False)
    return figure


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
