"""Results made from closed forms, with exact observables, to test what reads results."""

from dataclasses import fields

import numpy as np

import viscotack as vt

TABOR, RATE = 3.24, 7.0
# Displacements of Eq. 4.16 in h0.
DISPLACEMENT = TABOR * np.pi ** (2 / 3)

SI = vt.Problem(
    vt.StandardSolid(rubbery_modulus=1.458e6, glassy_modulus=14.58e6, tau0=0.02, poisson_ratio=0.5),
    vt.LennardJones(0.1523, 1.55e-6),
    vt.Sphere(5.19e-3),
    vt.Retraction(vt.AtForce(1.5e-3), 100e-6),
)
GROUPS = vt.Groups(tabor=TABOR, material=SI.material.reduced(), start=vt.AtDepth(20), rate=RATE)

# Of a JKR contact, all exact (Eq. 4.16, and the work of Eq. 46).
PULL_OFF_RADIUS = (9 / 8) ** (1 / 3)
PULL_OFF_DEPTH = -(3 ** (1 / 3)) / 4 * DISPLACEMENT
WORK_TO_PULL_OFF = 0.801822441637802 * DISPLACEMENT
WORK_TO_INSTABILITY = 1.735408533548926 / 1.5 * DISPLACEMENT


def jkr_force(a):
    """Return the force of a JKR contact in 1.5 pi R dg0 at an outputs' radius."""
    return (4 / 3 * a**3 - np.sqrt(8 * a**3)) / 1.5


def jkr_depth(a):
    return DISPLACEMENT * (a**2 - np.sqrt(2 * a))


def jkr_crack_speed(a):
    """Return the edge speed without pi, at constant retraction; nan where it is infinite."""
    slope = DISPLACEMENT * (2 * a - 1 / np.sqrt(2 * a))
    return np.pi ** (1 / 3) * RATE / np.where(slope > 0, slope, np.nan)


def jkr_result(*, start=2.3, end=0.6, steps=200, shift=0.5, **changes):
    """Return a JKR retraction at uneven steps; `shift` in [0, 1) moves all steps but the ends."""
    s = np.concatenate([[0], (np.arange(1, steps) - shift) / (steps - 1), [1]])
    s = s + 0.1 * np.sin(2 * np.pi * s)
    a = start + (end - start) * s
    depth = jkr_depth(a)
    parts = dict(
        problem=GROUPS,
        time=(depth[0] - depth) / RATE,
        depth=depth,
        force=jkr_force(a),
        contact_radius=a,
        edge_speed=jkr_crack_speed(a),
        status="still in contact just past the pull-off",
        statistics={"steps": steps, "newton_iterations": 3 * steps, "wall_time_s": 0.25},
    )
    return vt.Result(**(parts | changes))


def jkr_detachment(*, steps=200, far=40.0, **changes):
    """Return a JKR retraction to the instability, a jump there, and the far attraction after it.

    Beyond the jump the force is that of undeformed surfaces a gap d = 1 - depth apart,
    -(16/9)/d^2, whose energy is -(16/9)/d.
    """
    first = jkr_result(end=0.5, steps=steps)
    edge = first.depth[-1]
    # The jump costs a small but finite motion, as in a simulation.
    step = 1e-3
    after = edge - step - np.concatenate([[0.0], np.geomspace(0.05, far, 60)])
    d = 1 - after
    force = -(16 / 9) / d**2
    nothing = np.full_like(after, np.nan)
    depth = np.concatenate([first.depth, after])
    time = (depth[0] - depth) / RATE
    jump = vt.Event(
        "jump out of contact",
        time=time[len(first.depth)],
        depth=after[0],
        force=first.force[-1],
        energy=1.7,
    )
    parts = dict(
        problem=GROUPS,
        time=time,
        depth=depth,
        force=np.concatenate([first.force, force]),
        contact_radius=np.concatenate([first.contact_radius, nothing]),
        edge_speed=np.concatenate([first.edge_speed, nothing]),
        status=f"jumped at depth {edge:.4g} h0",
        events=(jump,),
        statistics=first.statistics,
        energy=energies(
            interface=np.concatenate([np.full(len(first.depth), -20.0), -(16 / 9) / d])
        ),
    )
    return vt.Result(**(parts | changes))


def energies(**known):
    """Return the books of a run of which only some are known; the others are zero."""
    steps = max(len(values) for values in known.values())
    books = {field.name: np.zeros(steps) for field in fields(vt.Energies)}
    return vt.Energies(**(books | known))


def work_of_separation(jump_depth):
    """Return the exact work of `jkr_detachment`: to the instability, and of the far attraction."""
    return WORK_TO_INSTABILITY + (16 / 9) / (1 - jump_depth)
