r"""Energy per area of the contact edge over its speed, from a simulated retraction.

The pressure in a contact that recedes from rest equals that of the relaxed solid at some hereditary
depth, for any memory of the bulk (:mod:`viscotack.theory.crack.contact`). Therefore force and
radius determine the energy at the edge, by the JKR formula for the relaxed solid,

.. math:: \frac{G}{\Delta\gamma_0} = \frac{1}{2 \pi a}
          \left( \frac{2 a^2}{3} - \frac{P}{2 a} \right)^2

with a in :math:`(R^2 \Delta\gamma_0/E_0^*)^{1/3}` and P in R dg, compression positive. The
simulation gives the speed of the edge, which others take from fits (Eq. 4.24 of Maghami, PhD
thesis (2025)). The steady crack of the law at rest gives the contribution of the bulk.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.geometry import HalfSpace, Sphere
from viscotack.model.protocol import Apart
from viscotack.model.traction import at_rest, grows
from viscotack.theory import SteadyCrack

from . import Outcome, Result

# Zone lengths of travel until the crack is steady, and the range evaluated beyond the force
# minimum: radii above this fraction of that at pull-off.
_ZONES, _BEYOND = 3.0, 0.5
# Strain at the edge above which linear viscoelasticity is doubtful.
_LARGEST_STRAIN = 0.1
_ROOT, _LOAD = np.pi ** (1 / 3), 1.5 * np.pi
_FEWEST = 8


@dataclass(frozen=True, eq=False)
class EdgeEnergy:
    """Energy of the edge of a contact over its speed, from :func:`edge_energy`.

    Attributes
    ----------
    speed : ndarray
        Speed of the edge [m/s]; for a dimensionless problem in (R^2 dg/E0*)^(1/3) per time unit.
    amplification : ndarray
        Energy at the edge over the work of adhesion, from force and radius.
    bulk : ndarray
        Energy of the steady crack of the law at rest at that speed, over the work of adhesion.
    interface : ndarray
        Factor of the interface, amplification over bulk: about 1 for a law of the gap alone.
    reference_speed, exponent : float
        Fit of the Gent-Schultz relation 1 + (v/v0)^n to the amplification, with v0 in the unit of
        `speed`.
    strain : float or None
        Largest slope of the surface at the edge at pull-off; None for a dimensionless problem.
    words : tuple of str
        Sentences on the result.
    """

    speed: Array
    amplification: Array
    bulk: Array
    interface: Array
    reference_speed: float
    exponent: float
    strain: float | None
    words: tuple[str, ...]


def edge_energy(result: Result) -> EdgeEnergy:
    """Compute the energy at the edge of a sphere over its simulated speed.

    Parameters
    ----------
    result : Result
        Retraction of a sphere from a relaxed contact, without moves before it.

    Returns
    -------
    EdgeEnergy
        Speeds [m/s] and dimensionless energies.

    Raises
    ------
    ValueError
        If it is another test, a failed run, or the edge never became a steady crack.

    Examples
    --------
    >>> import viscotack as vt
    >>> solid = vt.StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = vt.Groups(tabor=10.0, material=solid, start=vt.AtDepth(60.0), rate=30.0)
    >>> found = edge_energy(vt.solve(test, until="pull-off", estimate_error=False))
    >>> f"{found.amplification[-1]:.1f} of the edge, {found.bulk[-1]:.1f} by the steady crack"
    '7.3 of the edge, 7.1 by the steady crack'
    """
    groups = result.groups
    if not isinstance(groups.geometry, Sphere) or not isinstance(groups.body, HalfSpace):
        raise InputError(
            "the energy at an edge is available for spheres on a half-space, got a "
            f"{groups.geometry.word} on a {groups.body.word}"
        )
    if groups.moves or groups.rate is None or isinstance(groups.start, Apart):
        raise InputError(
            "the energy at an edge is available for a retraction from a relaxed contact, without "
            "moves before it"
        )
    if result.outcome is Outcome.STOPPED:
        raise InputError(f"the run failed, so there are no energies: {result.status}")
    rest = SteadyCrack(groups.material, at_rest(groups.traction))
    a, P = result.contact_radius * _ROOT, result.force * _LOAD
    with np.errstate(invalid="ignore"):
        energy = (2 * a**2 / 3 - P / (2 * a)) ** 2 / (2 * np.pi * a)
        # where the edge is a steady opening crack
        lowest = int(np.argmin(result.force))
        steady = (energy > 1) & (result.edge_speed > 0) & (result.force < 0)
        steady &= a[0] - a > _ZONES * rest.zone_length / groups.tabor**2
        steady &= (np.arange(a.size) <= lowest) | (a > _BEYOND * a[lowest])
    if np.count_nonzero(steady) < _FEWEST:
        raise InputError(
            "the edge was hardly ever a steady opening crack, because it travelled too few zone "
            "lengths; start deeper, retract faster, or use forces of shorter range"
        )
    speed, gamma = result.edge_speed[steady], energy[steady]
    to_crack = groups.tabor**2 * groups.material.time_unit
    bulk = np.asarray(rest.amplification(speed * to_crack))
    words = [
        f"the energy of the edge is up to {gamma[-1]:.3g} works of adhesion; the bulk accounts for "
        f"{bulk[-1]:.3g}"
    ]
    if grows(groups.traction):
        words.append(f"the interface contributes a factor of {gamma[-1] / bulk[-1]:.3g}")
    v0, n = _gent_schultz(speed, gamma)
    scales: Any = result.scales
    strain, unit = None, 1.0
    if scales is not None:
        # gap over length at pull-off; h0 is over the length E0* h0^2/dg of the crack
        at = int(np.argmin(result.force[steady]))
        found = SteadyCrack(groups.material, groups.traction).at(float(speed[at]) * to_crack)
        problem: Any = result.problem
        slopes, law = np.diff(found.gap) / np.diff(found.position), problem.traction
        h0 = law.equilibrium_gap
        strain = law.work_of_adhesion / (problem.material.contact_modulus * h0) * np.max(slopes)
        strain, unit = float(strain), scales.edge_speed
        if strain > _LARGEST_STRAIN:
            words.append(
                f"the slope of the surface at the edge is {strain:.2g}: above {_LARGEST_STRAIN:g} "
                "a linear solid is doubtful"
            )
    return EdgeEnergy(speed * unit, gamma, bulk, gamma / bulk, v0 * unit, n, strain, tuple(words))


def _gent_schultz(speed: Array, gamma: Array) -> tuple[float, float]:
    """Fit reference speed and exponent of 1 + (v/v0)^n to energies."""
    log_v, log_g = np.log(speed), np.log(gamma)
    middle = float(np.median(log_v))

    def misfit(x: Array) -> Array:
        return np.logaddexp(0.0, x[1] * (log_v - x[0])) - log_g

    found = least_squares(misfit, [middle, 0.4], bounds=([-np.inf, 0.01], [np.inf, 3.0]))
    return float(np.exp(found.x[0])), float(found.x[1])
