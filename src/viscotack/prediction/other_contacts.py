r"""What theory gives for contacts other than a sphere on a half-space: films, discs, profiles.

No closed form and no surrogate was verified for them, but their limits are known: relaxed, the
pull-off force is that of JKR (:mod:`viscotack.theory.elastic.film`); fast, that of JKR with the
energy :math:`\Delta\gamma_0/k` of a glassy edge. Both hold for forces of short range and for a
contact that begins at the start and only shrinks.

In between, under a shape without details, the edge is a steady crack that recedes on the film
(:mod:`viscotack.theory.crack.contact.recession`), within the limits and the error of
:mod:`viscotack.theory.crack.contact.recession`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.geometry import Base, Disc, HalfSpace, Layer, detail
from viscotack.model.problem import Groups
from viscotack.theory import SteadyCrack, film
from viscotack.theory.crack.contact import profile_on, recede
from viscotack.theory.crack.contact.recession import (
    ERROR,
    ERROR_BY_ZONE,
    LEAST_RATIO,
    MOST_ZONE,
    outside,
)
from viscotack.theory.elastic import disc, relaxed

from .cautions import REST_ZONE
from .closed_forms import Estimate

# Differences from the half-space for which a thickness is stated.
TOLERANCES = (0.1, 0.05, 0.01)
# Part of the fast force at which the gain is called saturated, and rates [beta^2/R per time unit]
# among which it is searched for.
SATURATED, _RATES = 0.9, np.geomspace(1e-4, 1e7, 34)
# Radii of the curves of this search.
_COARSE = 80
# Parts of the slow and the fast force that still count as these limits.
_SLOW, _FAST = 1.02, 0.9
_LOAD = 1.5 * np.pi
_UNITS: Any = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}
# Poisson ratio from which a bonded film is squeezed rather than compressed.
_SQUEEZED = 0.45
RECEDING = "receding crack"


@dataclass(frozen=True)
class OtherContact:
    """Limits and film quantities of a contact, in the units of :class:`viscotack.Advice`.

    Attributes
    ----------
    slow_force, fast_force : float
        Pull-off force of the relaxed solid and of the fastest retraction, for forces of short
        range [1.5 pi R dg0].
    strength_force : float or None
        Force at which a disc detaches everywhere at the strength of the interface; the two limits
        are not above it.
    over_half_space : float or None
        Slow force of a film over that of a half-space.
    radius_over_thickness : float or None
        Contact radius at slow pull-off over the thickness of the film.
    half_space_thickness : tuple of float or None
        Thickness [beta] from which on the slow force differs from the half-space's by less than
        10, 5 and 1 %.
    reaches_through : bool
        Whether the forces reach through the film already in slow retraction, so that it holds less
        than the slow limit: zone length times contact radius above half of the squared thickness.
    film_strain : float or None
        Largest strain of the film at the start, over beta/R: depth over thickness, and shear at
        the base of a thin bonded film of a Poisson ratio from 0.45 on.
    saturation_rate, half_space_saturation_rate : float or None
        Retraction speed [h0/time unit] at which 90 % of the fast force are reached, on this body,
        and for a film also on a half-space, by the theory of a receding crack; None where it does
        not hold.
    receding : Estimate
        Force at the speed of the problem by this theory.
    edge_speed : float or None
        Speed of the edge at pull-off [(R^2 dg0/E0*)^(1/3) per time unit] by this theory.
    start_radius : float or None
        Relaxed contact radius of the start [beta]; None if JKR has none.
    """

    slow_force: float
    fast_force: float
    strength_force: float | None
    over_half_space: float | None
    radius_over_thickness: float | None
    half_space_thickness: tuple[float, ...] | None
    reaches_through: bool
    film_strain: float | None
    saturation_rate: float | None
    half_space_saturation_rate: float | None
    receding: Estimate
    edge_speed: float | None
    start_radius: float | None

    def regime_of(self, force: float | None) -> str:
        """Return the regime of a retraction, by the force of a receding crack if none is known."""
        if self.fast_force == self.slow_force:
            return "quasi-static"
        if force is None and self.receding.applies:
            force = self.receding.pull_off_force
        if force is None:
            return "unknown"
        if force < _SLOW * self.slow_force:
            return "quasi-static"
        return "glassy" if force > _FAST * self.fast_force else "rate-dependent"

    @property
    def estimates(self) -> tuple[Estimate, ...]:
        """The two limits and the receding crack as rows of the table of tiers."""
        why = (
            "{} by JKR (of a disc by Kendall), to which simulations tend as the Tabor number grows"
        )
        slow = "the force of the relaxed solid, the smallest"
        fast = "the force of a glassy edge on a relaxed solid, the largest"
        return (
            Estimate("slow limit", self.slow_force, None, False, why.format(slow)),
            Estimate("fast limit", self.fast_force, None, False, why.format(fast)),
            self.receding,
        )


def check_contact(groups: Groups) -> None:
    """Raise an InputError for contacts whose limits are not known."""
    shape, body = groups.geometry.word, groups.body.word
    if groups.in_plane_strain or not isinstance(groups.body, HalfSpace | Layer):
        raise InputError(
            "advice covers shapes of revolution on a half-space or a layer, got a "
            f"{shape} on a {body}; simulate it"
        )


def other_contact(groups: Groups) -> OtherContact:
    """Evaluate the theories of a contact of revolution on a half-space or a layer.

    Parameters
    ----------
    groups : Groups
        A relaxed contact that a rigid drive retracts at constant speed.
    """
    shape: Any = groups.geometry
    body: Any = groups.body
    start = relaxed.contact_in_groups(groups.start, tabor=groups.tabor, shape=shape, body=body)
    radius = None if start is None else float(start.contact_radius)
    if isinstance(shape, Disc):
        radius = shape.radius
    whole = film.pull_off(shape=shape, body=body, **_UNITS)
    held, edge = -float(whole.force), float(whole.contact_radius)
    slow = held
    fast = -_strongest(groups, radius, 1 / groups.modulus_ratio)
    strength = None
    if isinstance(shape, Disc):
        one = groups.traction.strength * groups.tabor
        strength = float(disc.strength_limit(contact_radius=shape.radius, strength=one))
        slow, fast = min(slow, strength), min(fast, strength)
    limits = slow, max(fast, slow)
    receding = _receding(groups, radius, limits)
    layer = isinstance(body, Layer)
    over = None
    if layer:
        over = held / -float(film.pull_off(shape=shape, body=HalfSpace(), **_UNITS).force)
    rates = _saturation(groups, radius)
    return OtherContact(
        slow_force=limits[0] / _LOAD,
        fast_force=limits[1] / _LOAD,
        strength_force=None if strength is None else strength / _LOAD,
        over_half_space=over,
        radius_over_thickness=edge / body.thickness if layer else None,
        half_space_thickness=_thicknesses(groups),
        reaches_through=layer and _zone(groups) * edge > MOST_ZONE * body.thickness**2,
        film_strain=_strain(groups, start),
        saturation_rate=rates[0],
        half_space_saturation_rate=rates[1],
        receding=receding[0],
        edge_speed=receding[1],
        start_radius=radius,
    )


def _zone(groups: Groups) -> float:
    """Return the length of the cohesive zone of a relaxed edge [beta]."""
    return REST_ZONE / groups.effective_tabor**2


def _strongest(groups: Groups, radius: float | None, work: float) -> float:
    """Return the smallest force [R dg] of contacts that shrink from the start."""
    shape: Any = groups.geometry
    body: Any = groups.body
    solid = {"contact_modulus": 1.0, "work_of_adhesion": work}
    if radius is None:
        return float(film.pull_off(shape=shape, body=body, **solid).force)
    return float(relaxed.strongest(shape, largest=radius, body=body, **solid).force)


def _thicknesses(groups: Groups) -> tuple[float, ...] | None:
    """Return the thicknesses of half-spaces; None for half-spaces and shapes with details."""
    shape: Any = groups.geometry
    body = groups.body
    sharp = isinstance(shape, Disc) and shape.is_sharp
    if not isinstance(body, Layer) or not (sharp or np.isinf(detail(shape))):
        return None
    return _thicknesses_of(shape, body.base)


# most of the time of an advice, and the same for all problems with this shape and base
@lru_cache(maxsize=64)
def _thicknesses_of(shape: Any, base: Base) -> tuple[float, ...]:
    case = {"shape": shape, "base": base, **_UNITS}
    return tuple(film.half_space_thickness(tolerance=x, **case) for x in TOLERANCES)


def _strain(groups: Groups, start: Any) -> float | None:
    """Return the largest strain of a film at the start, over beta/R.

    A film that cannot be compressed flows sideways: at the distance r the displaced volume is
    pi r^2 (a^2 - r^2)/(4 R), and the parabola of its displacements has the slope 3/(2 pi r b^2)
    times this volume at the base, at most a^3/(4 sqrt(3) R b^2).
    """
    body = groups.body
    if not isinstance(body, Layer) or start is None:
        return None
    strain = max(float(start.depth), 0.0) / body.thickness
    nu, a = body.poisson_ratio, float(start.contact_radius)
    if nu is not None and nu >= _SQUEEZED and a > body.thickness:
        strain = max(strain, a**3 / (4 * np.sqrt(3) * body.thickness**2))
    return strain


def _case(groups: Groups, radius: float | None) -> str:
    """Return why there is no receding crack on this contact, or ""."""
    if groups.modulus_ratio >= 1:
        return "an elastic solid has no rate"
    if isinstance(groups.geometry, Disc):
        return "a disc detaches as a whole: no edge recedes"
    if np.isfinite(detail(groups.geometry)):
        return "the profile may have several edges"
    if radius is None:
        return "JKR has no contact at the start"
    if groups.modulus_ratio < LEAST_RATIO:
        return f"compared with simulations for modulus ratios from {LEAST_RATIO:g} on"
    return ""


def _receding(
    groups: Groups, radius: float | None, limits: tuple[float, float]
) -> tuple[Estimate, float | None]:
    """Return the force of a receding crack at the speed of the problem, and its edge speed."""
    if why := _case(groups, radius):
        return Estimate(RECEDING, None, None, False, why), None
    assert groups.rate is not None and radius is not None, "checked by the caller"
    rate = groups.rate * groups.material.time_unit / groups.tabor
    try:
        force, energy, edge, speed = _recede(groups, radius, np.array([rate]))
    except ValueError as error:  # a material without steady cracks
        return Estimate(RECEDING, None, None, False, str(error)), None
    found = float(np.clip(force[0], *limits)) / _LOAD
    why, error = _outside(groups, radius, float(energy[0]), float(edge[0]))
    # of the units of steady cracks, E0* h0^2/(dg tau), in those of a contact
    speed = float(speed[0]) / groups.tabor**2 / groups.material.time_unit
    if why:
        return Estimate(RECEDING, found, None, False, why), None
    why = "the edge recedes as a steady crack and the bulk responds with its creep"
    return Estimate(RECEDING, found, error, True, why), speed


def _outside(groups: Groups, radius: float, energy: float, edge: float) -> tuple[str, float]:
    """Return why the theory does not hold at a pull-off, or "", and its error."""
    effective = groups.effective_tabor * max(energy, 1.0) ** (-1 / 3)
    through = 0.0
    if isinstance(groups.body, Layer):
        crack = SteadyCrack(groups.material, groups.traction)
        zone = crack.zone_length * energy / groups.tabor**2
        through = zone * edge / groups.body.thickness**2
    why = outside(effective, radius / edge, through)
    return why, np.inf if why else ERROR + ERROR_BY_ZONE * through


def _recede(groups: Groups, radius: float, rates: Array, radii: int = 160) -> tuple[Array, ...]:
    """Return pull-off force [R dg], energy [dg], radius [beta] and speed of the edge by rate."""
    crack = SteadyCrack(groups.material, groups.traction)
    body: Any = groups.body
    profile = profile_on(groups.geometry, body)
    start, tabor = np.full(rates.shape, radius), np.full(rates.shape, groups.tabor)
    found = recede(crack, profile, radius=start, rate=rates, tabor=tabor, radii=radii)
    at = np.argmin(found.force, axis=0), np.arange(rates.size)
    return -found.force[at], found.amplification[at], found.radius[at], found.speed[at]


def _saturation(groups: Groups, radius: float | None) -> tuple[float | None, float | None]:
    """Return the rates [h0/time unit] of saturation on the body, and for a film on a half-space."""
    if _case(groups, radius) or radius is None:
        return None, None
    try:
        here = _saturated(groups, radius)
        if here is None or not isinstance(groups.body, Layer):
            return here, None
        return here, _saturated(replace(groups, body=HalfSpace()), radius)
    except ValueError:  # a material without steady cracks
        return None, None


def _saturated(groups: Groups, radius: float) -> float | None:
    """Return the rate [h0/time unit] of saturation, None where the theory does not hold."""
    force, energy, edge, _ = _recede(groups, radius, _RATES, _COARSE)
    wanted = -SATURATED * _strongest(groups, radius, 1 / groups.modulus_ratio)
    above = np.flatnonzero(force >= wanted)
    i = int(above[0]) if above.size else 0
    if i == 0 or _outside(groups, radius, float(energy[i]), float(edge[i]))[0]:
        return None
    log = np.interp(np.log(wanted), np.log(force[i - 1 : i + 1]), np.log(_RATES[i - 1 : i + 1]))
    return float(np.exp(log)) * groups.tabor / groups.material.time_unit
