"""Simulate cycles of partial unloading: does linear memory alone make a pull-off grow."""

from collections.abc import Iterator

import viscotack as vt

from .curves import RADIUS, STIFFNESS
from .prediction import BASE, SHORT, SPEEDS, TIME, Measured, Solid, matched, published, rouse

# Forces [nN] at which nine cycles on PDMS rest for 10 s, and to which they unload between.
PEAKS = (325, 658, 999, 1356, 1711, 2075, 2438, 2798, 3166)
VALLEYS = (216, 457, 712, 962, 1227, 1492, 1752, 2020)


def grown(test: Measured) -> Iterator[tuple[str, float, float]]:
    """Yield for each spectrum the pull-off and contact time after nine cycles over those of one."""
    speed, rest = SPEEDS[BASE], vt.Dwell(duration=10.0)
    single = (vt.Approach(speed=speed, to=vt.AtForce(PEAKS[-1] * 1e-9)), rest)
    cycles: tuple[vt.Approach | vt.Retract | vt.Dwell, ...] = ()
    for peak, valley in zip(PEAKS, (*VALLEYS, None), strict=True):
        cycles += (vt.Approach(speed=speed, to=vt.AtForce(peak * 1e-9)), rest)
        if valley is not None:
            cycles += (vt.Retract(speed=speed, to=vt.AtForce(valley * 1e-9)),)
    solids: list[tuple[str, float, Solid]] = [
        ("published", test.work_of_adhesion, published(test.contact_modulus, TIME))
    ]
    for name, law in (("matched, published shape", published), ("matched, Rouse", rouse)):
        work, time = matched(test, law, SHORT)
        solids.append((name, work, law(test.contact_modulus, time)))
    for name, work, solid in solids:
        found = []
        for moves in (single, cycles):
            problem = vt.Problem(
                material=solid,
                traction=vt.LennardJones(work_of_adhesion=work, equilibrium_gap=SHORT),
                geometry=vt.Sphere(radius=RADIUS),
                protocol=vt.Retraction(
                    start=vt.Apart(gap=4e-9), moves=moves, speed=speed, stiffness=STIFFNESS
                ),
            )
            answer = vt.crack_contact(problem)
            if answer.pull_off_force is None or answer.time_at_pull_off is None:
                raise ValueError(f"no pull-off: {answer.why}")
            found.append((answer.pull_off_force, answer.time_at_pull_off))
        yield name, found[1][0] / found[0][0], found[1][1] / found[0][1]
