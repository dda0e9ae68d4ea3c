"""One detachment in SI: a 1 mm bead pulled off soft rubber at 10 um/s.

Writes detach_once.png. Time: under a second.
"""

import viscotack as vt

problem = vt.Problem(
    material=vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.1, poisson_ratio=0.5),
    traction=vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=200e-9),
    geometry=vt.Sphere(radius=1e-3),
    protocol=vt.Retraction(start=vt.AtForce(1e-3), speed=10e-6),
)
result = vt.solve(problem)
force = result.pull_off_force * problem.scales().force
print(f"{result.status}; pull-off force {force * 1e3:.3f} mN")
vt.save_figure(vt.draw_overview(result), "detach_once.png")
