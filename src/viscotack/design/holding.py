r"""Dead load that a sphere holds for a time: its edge is a slow steady crack.

Under the tension P an elastic contact of the radius a releases the energy

.. math:: G(a, P) = \frac{(4 E_0^* a^3/3R + P)^2}{8 \pi E_0^* a^3} ,

and its edge recedes at the speed of a crack of that energy. The time to detachment is the integral
of da over the speed from the relaxed radius under the preload. Loads below the elastic pull-off
force are held for ever, and loads above the instantaneous one not at all. The load is multiplied by
the elastic pull-off ratio at the effective Tabor number, as in
:mod:`viscotack.simulate.crack_contact.by_crack`.
"""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np

from viscotack.errors import InputError, OutOfRange
from viscotack.model.geometry import HalfSpace, Sphere
from viscotack.model.problem import Problem
from viscotack.model.protocol import AtForce
from viscotack.model.traction import LennardJones
from viscotack.simulate.crack_contact.by_crack import LEAST_TABOR
from viscotack.theory import SteadyCrack, jkr, lennard_jones

# Relative standard error of the load against simulations.
HELD_ERROR = 0.01
# Loads and radii of the integral; smallest radius, and excess of the least load over the elastic
# pull-off force; part of the largest energy at which the edge is as good as detached.
_LOADS, _RADII, _LAST, _EXCESS, _MOST = 60, 200, 0.02, 1e-4, 0.98


def held_load(problem: Problem, time: float) -> float:
    """Return the largest dead load that a relaxed sphere holds for a time.

    Parameters
    ----------
    problem : Problem
        Sphere on a half-space, relaxed under a force; speed and stiffness do not matter.
    time : float
        Time to detachment [s].

    Returns
    -------
    float
        Tension [N]; the elastic pull-off force for a time that no larger load is held.

    Raises
    ------
    OutOfRange
        If the cohesive zone is as large as the contact.
    ValueError
        For another shape, body, law or start.
    """
    shape: Any = problem.geometry
    body, start = problem.body, problem.protocol.start
    known = isinstance(shape, Sphere) and isinstance(body, HalfSpace)
    if not (known and type(problem.traction) is LennardJones and isinstance(start, AtForce)):
        raise InputError(
            "the load held for a time is known for spheres on a half-space with Lennard-Jones "
            "forces that begin under a preload"
        )
    material, law, R = problem.material, problem.traction, shape.radius
    E, w, h0 = material.contact_modulus, law.work_of_adhesion, law.equilibrium_gap
    mu = (R * w**2 / E**2) ** (1 / 3) / h0
    crack = SteadyCrack(material.reduced(), LennardJones(1.0, 1.0))
    beta = (R**2 * w / E) ** (1 / 3)
    first = float(
        jkr.contact_radius_at_force(
            start.force / (R * w), radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0
        )
    )
    # tensions in R dg, radii in beta; above the strongest radius the edge runs at once
    a = first * np.geomspace(1.0, _LAST, _RADII)
    strongest = np.max(np.sqrt(8 * pi * _MOST * crack.largest * a**3) - 4 / 3 * a**3)
    load = np.geomspace(1.5 * pi * (1 + _EXCESS), strongest, _LOADS)
    energy = (4 / 3 * a**3 + load[:, None]) ** 2 / (8 * pi * a**3)
    least = energy.min(axis=1)
    if not mu * least[0] ** (-1 / 3) >= LEAST_TABOR:
        raise OutOfRange(
            f"the cohesive zone is as large as the contact: effective Tabor number "
            f"{mu * least[0] ** (-1 / 3):.3g}, valid from "
            f"{LEAST_TABOR:g}"
        )
    # beyond the largest energy the edge is at its largest speed
    fast = np.minimum(energy, _MOST * crack.largest)
    speed = np.asarray(crack.speed(np.maximum(fast, 1 + _EXCESS / 10)))
    unit = E * h0**2 / (w * material.time_unit)  # of the speed of an edge [m/s]
    times = beta / unit * -np.trapezoid(1 / speed, a, axis=1)
    tension = load * np.asarray(lennard_jones.pull_off_ratio(mu * least ** (-1 / 3))) * R * w
    order = np.argsort(times)
    if time >= times[order[-1]]:
        return float(tension[order[-1]])
    return float(np.exp(np.interp(np.log(time), np.log(times[order]), np.log(tension[order]))))
