"""Which input decides how a lens comes off: elasticities of its pull-off, as a tornado.

Time: 6 s. Writes what_matters.png.
"""

from pathlib import Path

import viscotack as vt
from viscotack.plot.simulation import draw_sensitivities
from viscotack.plot.style import save_figure


def main(picture: Path = Path("what_matters.png"), accuracy: float = 2e-3) -> vt.Result:
    """Simulate a lens on rubber, print the elasticities of its pull-off and draw them."""
    rubber = vt.Prony(
        rubbery_modulus=1e6, branches=[(3e6, 2e-3), (2e6, 0.05), (1e6, 1.0)], poisson_ratio=0.5
    )
    problem = vt.Problem(
        material=rubber,
        traction=vt.LennardJones(work_of_adhesion=0.1, equilibrium_gap=1e-6),
        geometry=vt.Sphere(radius=5e-3),
        protocol=vt.Retraction(start=vt.AtForce(2e-3), speed=50e-6),
    )
    result = vt.solve(problem, until="pull-off", accuracy=accuracy, sensitivities=True)
    found = result.sensitivities
    assert found is not None
    force = found.elasticities["pull_off_force"]
    for name in sorted(force, key=lambda name: -abs(force[name])):
        print(f"{name:32} {force[name]:7.3f} ± {found.errors['pull_off_force'][name]:.3f}")
    save_figure(draw_sensitivities(result), picture)
    return result


if __name__ == "__main__":
    main()
