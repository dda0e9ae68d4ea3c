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
import numpy.typing as npt
from scipy.optimize import least_squares

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.geometry import HalfSpace, Sphere
from viscotack.model.problem import Groups, Problem
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
    groups = _checked(result)
    crack = SteadyCrack(groups.material, groups.traction)
    rest = SteadyCrack(groups.material, at_rest(groups.traction))
    a, P = result.contact_radius * _ROOT, result.force * _LOAD
    with np.errstate(invalid="ignore"):
        energy = (2 * a**2 / 3 - P / (2 * a)) ** 2 / (2 * np.pi * a)
        steady = _steady(result, a, rest.zone_length / groups.tabor**2) & (energy > 1)
    if np.count_nonzero(steady) < _FEWEST:
        raise InputError(
            "the edge was hardly ever a steady opening crack, because it travelled too few zone "
            "lengths; start deeper, retract faster, or use forces of shorter range"
        )
    speed, gamma = result.edge_speed[steady], energy[steady]
    bulk = np.asarray(rest.amplification(speed * groups.tabor**2 * groups.material.time_unit))
    v0, n = _gent_schultz(speed, gamma)
    scales: Any = result.scales
    strain = None if scales is None else _strain(result, crack, speed, steady)
    unit = 1.0 if scales is None else scales.edge_speed
    said = _words(gamma[-1], bulk[-1], strain, grows(groups.traction))
    return EdgeEnergy(speed * unit, gamma, bulk, gamma / bulk, v0 * unit, n, strain, said)


def _checked(result: Result) -> Groups:
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
    return groups


def _steady(result: Result, a: Array, zone: float) -> npt.NDArray[np.bool_]:
    """Return a mask of the steps at which the edge is a steady opening crack."""
    lowest = int(np.argmin(result.force))
    gone = a[0] - a > _ZONES * zone
    near = (np.arange(a.size) <= lowest) | (a > _BEYOND * a[lowest])
    return gone & near & (result.edge_speed > 0) & (result.force < 0)


def _gent_schultz(speed: Array, gamma: Array) -> tuple[float, float]:
    """Fit reference speed and exponent of 1 + (v/v0)^n to energies."""
    log_v, log_g = np.log(speed), np.log(gamma)
    middle = float(np.median(log_v))

    def misfit(x: Array) -> Array:
        return np.logaddexp(0.0, x[1] * (log_v - x[0])) - log_g

    found = least_squares(misfit, [middle, 0.4], bounds=([-np.inf, 0.01], [np.inf, 3.0]))
    return float(np.exp(found.x[0])), float(found.x[1])


def _strain(result: Result, crack: SteadyCrack, speed: Array, steady: npt.NDArray) -> float:
    """Return the largest slope of the surface at pull-off: gap over length, in SI."""
    groups, problem = result.groups, result.problem
    assert isinstance(problem, Problem)
    at = int(np.argmin(result.force[steady]))
    found = crack.at(float(speed[at]) * groups.tabor**2 * groups.material.time_unit)
    law = problem.traction
    # h0 over the length E0* h0^2/dg
    unit = law.work_of_adhesion / (problem.material.contact_modulus * law.equilibrium_gap)
    return unit * float(np.max(np.diff(found.gap) / np.diff(found.position)))


def _words(gamma: float, bulk: float, strain: float | None, grown: bool) -> tuple[str, ...]:
    said = [
        f"the energy of the edge is up to {gamma:.3g} works of adhesion; the bulk accounts for "
        f"{bulk:.3g}"
    ]
    if grown:
        said.append(f"the interface contributes a factor of {gamma / bulk:.3g}")
    if strain is not None and strain > _LARGEST_STRAIN:
        said.append(
            f"the slope of the surface at the edge is {strain:.2g}: above {_LARGEST_STRAIN:g} a "
            "linear solid is doubtful"
        )
    return tuple(said)
