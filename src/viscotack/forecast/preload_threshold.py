"""The preload from which pressing harder brings hardly more force, by simulation."""

from __future__ import annotations

import numpy as np

from viscotack.errors import InputError
from viscotack.problem import Groups, Problem
from viscotack.protocol import AtRadius

# The search: its smallest radius, how many simulations it takes,
_SMALLEST_START, _COARSE, _FINE = 1.2, 13, 9
# and up to which multiple of its usual end it goes on.
_WIDER = 3.0


def threshold_contact_radius(
    problem: Problem | Groups, *, slope: float, accuracy: float = 2e-3
) -> float:
    """Return the relaxed contact radius from which more preload brings hardly more force.

    Parameters
    ----------
    problem : Problem or Groups
        Its start is not used.
    slope : float
        What "hardly" is: the derivative of the pull-off force [pi R dg0] by the radius
        [(pi R^2 dg0/E0*)^(1/3)] falls below it; the thesis takes 0.1.
    accuracy : float
        Of each simulation.

    Returns
    -------
    float
        Contact radius [(pi R^2 dg0/E0*)^(1/3)], from 1.2; that is also the answer where the force
        does not depend on the preload at all.

    Notes
    -----
    Some twenty simulations, 5 to 10 s. Where the bulk creeps on, a heavier preload lowers the force
    again; this is the last radius at which it raises it by the slope. The fit of
    :func:`viscotack.theory.sphere.bounds.threshold_contact_radius` asks for more: at mu = 3.24, k =
    0.1 and a rate of 3.16 it has 2.16 (n = 0.4) and 2.64 (n = 1.6) where this finds 1.47 and 1.95.
    """
    from viscotack.methods import solve
    from viscotack.result.observables import pull_off_force

    if not slope > 0:
        raise InputError(f"slope must be positive, got {slope}; the thesis takes 0.1")
    groups = problem.groups()

    def force(radius: float) -> float:
        case = Groups(
            tabor=groups.tabor,
            material=groups.material,
            start=AtRadius(radius),
            rate=groups.rate,
            traction=groups.traction,
        )
        result = solve(case, accuracy=accuracy, until="pull-off", estimate_error=False)
        return 1.5 * pull_off_force(result)

    largest = 2 * (9 / (8 * groups.modulus_ratio)) ** (1 / 3) + 1.0
    radii = np.linspace(_SMALLEST_START, largest, _COARSE)
    forces = [force(float(x)) for x in radii]
    while True:
        steep = np.diff(forces) / np.diff(radii) >= slope
        if not steep[-1]:
            break
        if radii[-1] > _WIDER * largest:
            raise InputError(
                f"the force still grows by more than {slope} at the largest radius tried, "
                f"{radii[-1]:.3g}; ask for a larger slope"
            )
        # near saturation the slope fades slowly
        radii = np.append(radii, radii[-1] + radii[1] - radii[0])
        forces.append(force(float(radii[-1])))
    if not np.any(steep):
        return _SMALLEST_START
    # the slope passes the limit between the middles of two neighbouring pieces
    last = int(np.flatnonzero(steep)[-1])
    near = np.linspace(radii[last], radii[last + 2], _FINE)
    middle = near[_FINE // 2]
    fit = np.polynomial.Polynomial.fit(near - middle, [force(float(x)) for x in near], 4).deriv()
    fine = np.linspace(near[0], near[-1], 2001)
    beyond = np.flatnonzero(fit(fine - middle) >= slope)
    return float(fine[beyond[-1]]) if beyond.size else float(near[0])
