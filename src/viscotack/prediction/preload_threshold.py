"""Compute by simulation the preload above which the pull-off force hardly increases."""

from __future__ import annotations

import numpy as np

from viscotack.errors import InputError
from viscotack.model.problem import Groups, Problem
from viscotack.model.protocol import AtRadius

# The search: its smallest radius, the number of simulations,
_SMALLEST_START, _COARSE, _FINE = 1.2, 13, 9
# and the factor on its usual end up to which it is extended.
_WIDER = 3.0


def threshold_contact_radius(
    problem: Problem | Groups, *, slope: float, accuracy: float = 2e-3
) -> float:
    """Return the relaxed contact radius above which more preload hardly raises the force.

    Parameters
    ----------
    problem : Problem or Groups
        Its start is ignored.
    slope : float
        Threshold of the derivative of the pull-off force [pi R dg0] with respect to the radius
        [(pi R^2 dg0/E0*)^(1/3)]; the thesis uses 0.1.
    accuracy : float
        Accuracy of each simulation.

    Returns
    -------
    float
        Contact radius [(pi R^2 dg0/E0*)^(1/3)], at least 1.2, which is also returned if the force
        does not depend on the preload.

    Raises
    ------
    ValueError
        If the slope is not positive, or the force still increases by more at the largest radius.

    Notes
    -----
    Takes some twenty simulations, 5 to 10 s. If the bulk continues to creep, a heavier preload
    lowers the force again; the result is the last radius with this slope. The fit of
    :func:`viscotack.theory.sphere.bounds.threshold_contact_radius` is larger: at mu = 3.24, k =
    0.1 and a rate of 3.16 it gives 2.16 (n = 0.4) and 2.64 (n = 1.6), and this function 1.47 and
    1.95.

    Examples
    --------
    The pull-off force of an elastic solid does not depend on the preload:

    >>> from viscotack import AtDepth, Elastic, Groups
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> case = Groups(tabor=1.0, material=solid, start=AtDepth(10.0), rate=1.0)
    >>> threshold_contact_radius(case, slope=0.1, accuracy=0.02)
    1.2
    """
    from viscotack.result.observables import pull_off_force
    from viscotack.simulate import solve

    if not slope > 0:
        raise InputError(f"slope must be positive, got {slope}; the thesis uses 0.1")
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
                f"{radii[-1]:.3g}; choose a larger slope"
            )
        # near saturation the slope decreases slowly
        radii = np.append(radii, radii[-1] + radii[1] - radii[0])
        forces.append(force(float(radii[-1])))
    if not np.any(steep):
        return _SMALLEST_START
    # interpolate the slope between the midpoints of neighbouring intervals
    last = int(np.flatnonzero(steep)[-1])
    near = np.linspace(radii[last], radii[last + 2], _FINE)
    middle = near[_FINE // 2]
    fit = np.polynomial.Polynomial.fit(near - middle, [force(float(x)) for x in near], 4).deriv()
    fine = np.linspace(near[0], near[-1], 2001)
    beyond = np.flatnonzero(fit(fine - middle) >= slope)
    return float(fine[beyond[-1]]) if beyond.size else float(near[0])
