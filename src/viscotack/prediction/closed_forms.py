"""Closed-form estimates of the pull-off force of a sphere: five theories, each with its range.

The estimates hold for a relaxed contact that a rigid machine retracts at a constant speed. Their
ranges and errors were measured against :func:`viscotack.solve` with power laws and standard solids,
modulus ratios 1e-3 to 0.3, exponents 0.3 to 1.6, Tabor numbers 0.3 to 8 and rates 0.1 to 1e8;
:mod:`.tiers` rejects other problems.
A law other than Lennard-Jones is replaced by the one of the same work and strength, at its
range-corrected Tabor number. The resulting error was measured with exponential laws of decay 0.25
to 3, Dugdale's law with falls of 0.3 to 1 and two tables, modulus ratios 0.01 to 0.3 and 1,
range-corrected Tabor numbers 0.1 to 10.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from viscotack.errors import InputError
from viscotack.model.geometry import HalfSpace, Sphere
from viscotack.model.materials import Elastic
from viscotack.model.problem import Groups
from viscotack.model.problem.accuracy import at_least, at_most
from viscotack.model.protocol import AtDepth, Start
from viscotack.model.traction import LennardJones, effective_range, softening
from viscotack.model.traction.growing import check_of_gap_alone
from viscotack.theory import (
    CrackLaw,
    detachment,
    jkr,
    lennard_jones,
    persson_brener,
    rate,
    unloading,
)
from viscotack.theory.elastic.relaxed import contact_in_groups

# sigma_c/sigma_0 of a sphere with the Lennard-Jones traction, fitted in the thesis.
STRENGTH_RATIO = np.pi / 9
# Least Tabor number of JKR in Johnson and Greenwood's map without load, Lennard-Jones form.
_JKR = 3.0
# Fractions of the force between slowest and fastest that still count as the limit itself.
_SLOW, _FAST = 0.02, 0.9
# Retraction in the mean retardation time, in contact heights, up to which the bulk is (nearly)
# relaxed.
_RELAXED, _NEARLY = 6.0, 25.0
# Errors that include nine of ten cases. Their coverage, for 384 independent cases: 92 % of 121
# (glassy), and at least 90 % of 109 (rate-fit), 263 (detachment) and 101 (unloading) to which each
# applies.
_FIT_ERROR = 0.22
# For `detachment`: Tabor number, start over the radius at pull-off, error.
_DETACHMENT = ((2.0, 1.5, 0.07), (2.0, 1.2, 0.15), (1.0, 2.0, 0.12))
# Error of the glassy limit: c (mu k^(1/3))^p s^q, at least the first number, with s the start
# over the smallest contact of the full glassy force; above the last number it is not usable.
_GLASSY_LEAST, _GLASSY_ERROR, _GLASSY_MOST = 0.05, (0.6, -1.3, -3.0), 0.25
# Force of a start over that of a sufficiently large one: (1 + c m^p x^q)^-e, m the Tabor number of
# the edge at its speed, x the start over the radius at pull-off; fitted to 66 cases.
_LIGHT = (1.4, -1.63, -4.6, 0.36)
# Effect of a start of twice the radius: least x, and a band that included nine of ten pairs of
# starts of other cases, Tabor numbers 1 to 8: 192 with Lennard-Jones, 79 with laws with a tail.
# Below 1 it was 22 %; with Dugdale's law, where a light start has less effect, 15 of 19.
_HEAVIER, _PRESSED_TABOR = 2.0, 1.0
_PRESSED = ((1.7, 0.03), (1.3, 0.06), (0.8, 0.08), (0.5, 0.12), (0.0, 0.16))
# Additional errors for another law of the same work and strength, one whose tension falls no
# more steeply than this [strength^2/work], and one that falls more steeply, as Dugdale's: then they
# include nine of ten of 255 and of 65 estimates.
_STEEP = 1.5
_OTHER_LAW = {
    "elastic": (0.0, 0.04),
    "unloading": (0.02, 0.14),
    "detachment": (0.0, 0.07),
    "rate-fit": (0.02, 0.05),
    "glassy": (0.02, 0.02),
}
_TIP = np.pi ** (1 / 3)


@dataclass(frozen=True)
class Estimate:
    """Estimate of the pull-off force by one tier, with its validity; see :func:`viscotack.advise`.

    Attributes
    ----------
    tier : str
        "crack contact", "elastic", "unloading", "detachment", "rate-fit", "glassy" or "simulation".
    pull_off_force : float or None
        In 1.5 pi R dg0; None if the tier has no estimate, or is not run here.
    error : float or None
        Relative error that includes nine of ten cases; None if the tier does not apply.
    applies : bool
        Whether the problem is in the tier's range.
    why : str
        Reason, as a sentence.
    """

    tier: str
    pull_off_force: float | None
    error: float | None
    applies: bool
    why: str


@dataclass(frozen=True)
class ClosedForms:
    """Regime of a retraction by theory, and the estimate of each closed form.

    Attributes
    ----------
    slowest, fastest : float
        Pull-off force of the relaxed and of the glassy solid [1.5 pi R dg0].
    start_radius : float or None
        Relaxed contact radius of the start by JKR [(pi R^2 dg0/E0*)^(1/3)].
    regime : str
        "quasi-static", "rate-dependent" or "glassy"; "unknown" if no theory applies.
    preload : str
        As in :class:`viscotack.Advice`.
    preload_change : tuple of float or None
        As in :class:`viscotack.Advice`.
    edge_speed : float or None
        Speed of the edge at pull-off [(R^2 dg0/E0*)^(1/3) per time unit].
    edge_energy : float
        Energy of that edge over the work of adhesion.
    estimates : tuple of Estimate
        Elastic, unloading, detachment, rate-fit and glassy.
    curve : Unloading or None
        The curve behind the estimate "unloading", a moving edge on a relaxed bulk: depth [h0],
        force [1.5 pi R dg0], contact radius [(pi R^2 dg0/E0*)^(1/3)], edge speed as in a result,
        time in the time unit. The force is without the estimate's correction for the range of the
        forces. None for elastic solids and for starts without a JKR contact.
    """

    slowest: float
    fastest: float
    start_radius: float | None
    estimates: tuple[Estimate, ...]
    regime: str = "unknown"
    preload: str = "unknown"
    preload_change: tuple[float, float] | None = None
    edge_speed: float | None = None
    edge_energy: float = 1.0
    curve: unloading.Unloading | None = None

    def regime_of(self, force: float) -> str:
        """Return the regime of a retraction with a known pull-off force [1.5 pi R dg0]."""
        slow = force / self.slowest - 1 < _SLOW
        if slow:
            return "quasi-static"
        return "glassy" if self.regime == "glassy" else "rate-dependent"


def closed_forms(asked: Groups) -> ClosedForms:
    """Evaluate the closed forms for a problem.

    Parameters
    ----------
    asked : Groups
        A sphere in relaxed contact, retracted by a rigid machine at constant speed.

    Raises
    ------
    ValueError
        If it is another test or another indenter.
    """
    if not is_classic(asked):
        shape, body = asked.geometry.word, asked.body.word
        where = "" if isinstance(asked.body, HalfSpace) else f" on a {body}"
        raise InputError(
            f"the closed forms cover spheres on a half-space, got a {shape}{where}; simulate it"
        )
    check_test(asked)
    groups = lennard_jones_alike(asked)
    mu, k = groups.tabor, groups.modulus_ratio
    slowest = float(lennard_jones.pull_off_ratio(mu))
    fastest = float(lennard_jones.pull_off_ratio(mu * k ** (1 / 3))) / k
    contact = contact_in_groups(groups.start, tabor=mu)
    start = None if contact is None else float(np.asarray(contact.contact_radius)) / _TIP
    depth = None if contact is None else float(np.asarray(contact.depth))
    try:
        return _by_theory(asked, groups, slowest, fastest, depth, start)
    except ValueError as error:  # the material has no modes as fine as the theory needs
        limits = {"elastic": slowest, "glassy": fastest}
        estimates = tuple(_limit(name, limits.get(name), str(error)) for name in _OTHER_LAW)
        return ClosedForms(slowest, fastest, start, estimates)


def _by_theory(
    asked: Groups,
    groups: Groups,
    slowest: float,
    fastest: float,
    depth: float | None,
    start: float | None,
) -> ClosedForms:
    """Evaluate the theories of a moving edge."""
    curve = None
    if groups.modulus_ratio < 1:
        # without such a JKR start, use the regime of a retraction from zero load
        free = float(np.asarray(jkr.depth(jkr.contact_radius_at_force(0.0, **_UNIT), **_UNIT)))
        begin = free if depth is None else depth
        curve = unloading.retraction(begin, _crack(groups), speed=_speed(groups), **_UNIT)
    here, pressed = _with_and_without_pressing(groups, depth, start)
    state = here if here is not None and here.margin >= 1 else None
    amplification, gamma, edge = 1.0, 1.0, None
    if state is not None:
        amplification, gamma, edge = state.amplification, state.amplification, state.crack_speed
    elif curve is not None:
        place = int(np.argmin(curve.force))
        amplification = curve.pull_off_force / _JKR_FORCE
        gamma, edge = float(curve.amplification[place]), float(curve.edge_speed[place])
    regime = "rate-dependent"
    if amplification - 1 < _SLOW:
        regime = "quasi-static"
    elif gamma * groups.modulus_ratio > _FAST:
        regime = "glassy"
    # a larger start has no effect in quasi-static retraction, and an unknown one for steep laws
    change, preload = None, "any" if regime == "quasi-static" else "unknown"
    if preload != "any" and not _steep(asked):
        change = _change(groups, here, pressed)
    if change is not None:
        preload = "raises" if change[0] > 0 else "lowers" if change[1] < 0 else "same"
    if depth is None:
        curve = None
    estimates = (
        _elastic(asked, regime, slowest),
        _unloaded(groups, slowest, curve),
        _detached(groups, slowest, state),
        _fitted(groups, preload),
        _glassy(groups, regime, fastest, start, slowest, gamma),
    )
    if not isinstance(asked.traction, LennardJones):
        steep = _steep(asked)
        estimates = tuple(
            e if e.error is None else replace(e, error=e.error + _OTHER_LAW[e.tier][steep])
            for e in estimates
        )
    if curve is not None:
        curve = curve._replace(
            depth=curve.depth * asked.tabor,
            contact_radius=curve.contact_radius / _TIP,
            force=curve.force / _JKR_FORCE,
        )
    return ClosedForms(
        slowest, fastest, start, estimates, regime, preload, change, edge, gamma, curve
    )


# R = E0* = dg0 = 1, so that h0 = 1/mu
_UNIT: dict[str, Any] = dict(radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0)
_JKR_FORCE = 1.5 * np.pi


def is_classic(groups: Groups) -> bool:
    """Whether it is a sphere on a half-space, which the closed forms cover."""
    return isinstance(groups.geometry, Sphere) and isinstance(groups.body, HalfSpace)


def is_plain(groups: Groups) -> bool:
    """Whether a rigid machine retracts a relaxed contact at constant speed."""
    steady = groups.rate is not None and not groups.moves and groups.stiffness is None
    return isinstance(groups.start, Start) and steady


def check_test(groups: Groups) -> None:
    """Raise an InputError for tests other than a retraction from rest at constant speed."""
    check_of_gap_alone(groups.traction, "advice")
    if not is_plain(groups):
        raise InputError(
            "advice covers a relaxed contact that a rigid drive retracts at constant speed; "
            "simulate other tests"
        )


def lennard_jones_alike(groups: Groups) -> Groups:
    """Return the contact with the Lennard-Jones law of the same work and strength.

    Its Tabor number is the effective one.
    """
    if isinstance(groups.traction, LennardJones):
        return groups
    length = effective_range(groups.traction)
    start = groups.start
    return replace(
        groups,
        tabor=groups.tabor / length,
        traction=LennardJones(work_of_adhesion=1.0, equilibrium_gap=1.0),
        start=AtDepth(start.depth / length) if isinstance(start, AtDepth) else start,
        rate=_rate(groups) / length,
    )


def _rate(groups: Groups) -> float:
    assert groups.rate is not None, "checked by the caller"
    return groups.rate


def _crack(groups: Groups) -> CrackLaw:
    """Return the crack law of the edge, in units R = E0* = dg0 = 1."""
    length = persson_brener.crack_tip_length(
        contact_modulus=1.0,
        work_of_adhesion=1.0,
        strength=groups.traction.strength * groups.tabor,
        strength_ratio=STRENGTH_RATIO,
    )
    return CrackLaw(
        theory="persson-brener", material=groups.material, tip_length=float(np.asarray(length))
    )


def _speed(groups: Groups) -> float:
    """Return the retraction speed in the same units."""
    return _rate(groups) / groups.tabor


def _steep(groups: Groups) -> bool:
    """Return whether the tension falls abruptly, without a tail, like Dugdale's."""
    return softening(groups.traction) > _STEEP


class _State(NamedTuple):
    """State at pull-off that the retraction approaches, if the start is large enough."""

    amplification: float
    crack_speed: float
    margin: float
    part: float


def _with_and_without_pressing(
    groups: Groups, depth: float | None, start: float | None
) -> tuple[_State, _State] | tuple[None, None]:
    """Return the states of the start and of one twice as large; None if there is none."""
    if groups.modulus_ratio >= 1 or depth is None or start is None:
        return None, None
    radii = np.array([start, _HEAVIER * start]) * _TIP
    depths = np.append(depth, jkr.depth(radii[1], **_UNIT))
    try:
        found = detachment.unlimited(_speed(groups), _crack(groups), depth=depths, **_UNIT)
    except ValueError:
        # the problem is valid: it starts beyond the pull-off of a slow retraction
        return None, None
    gamma, margin = np.asarray(found.amplification), radii / np.asarray(found.contact_radius)
    c, p, q, e = _LIGHT
    part = (1 + c * (groups.tabor / np.cbrt(gamma)) ** p * margin**q) ** -e
    speed = np.asarray(found.crack_speed)
    here, pressed = (
        _State(*x) for x in zip(*(y.tolist() for y in (gamma, speed, margin, part)), strict=True)
    )
    return here, pressed


def _change(
    groups: Groups, here: _State | None, pressed: _State | None
) -> tuple[float, float] | None:
    """Return the smallest and largest relative change of the force by pressing, or None.

    Two effects compete: a start hardly larger than the contact at pull-off has a lower force, and
    a larger start takes longer, so that the bulk relaxes more and the edge is slower.
    """
    if here is None or pressed is None or not at_least(groups.tabor, _PRESSED_TABOR):
        return None
    factor = pressed.amplification * pressed.part / (here.amplification * here.part)
    band = next(band for least, band in _PRESSED if here.margin >= least)
    return factor * (1 - band) - 1, factor * (1 + band) - 1


def _haste(groups: Groups) -> float:
    """Return the contact heights retracted during the mean retardation time."""
    unit = groups.material.time_unit
    modes = groups.material.retardation_modes(
        shortest=1e-9 * unit, longest=1e3 * unit, tolerance=1e-6
    )
    weights = np.array(modes.weights)
    mean = float(weights @ np.array(modes.times) / np.sum(weights)) if weights.size else 0.0
    return _rate(groups) * mean / (np.pi ** (2 / 3) * groups.tabor)


def _limit(name: str, force: float | None, why: str) -> Estimate:
    """Return the estimate of a theory that does not apply, with its force as a limit if any."""
    return Estimate(name, force, None, False, why)


_NO_RATE = "an elastic solid has no rate"
_TOO_LONG = "the range of the forces is too long for a crack: Tabor number {:.3g}, valid from 1"


def _elastic(asked: Groups, regime: str, slowest: float) -> Estimate:
    if regime != "quasi-static":
        why = "the solid is not relaxed while the edge moves; the force is a lower limit"
        return _limit("elastic", slowest, why)
    why = "the retraction is slow enough for the solid to stay relaxed"
    if isinstance(asked.material, Elastic):
        why = "the solid is elastic, and its force does not depend on speed"
    return Estimate("elastic", slowest, _SLOW, True, why)


def _unloaded(groups: Groups, slowest: float, curve: unloading.Unloading | None) -> Estimate:
    name, mu = "unloading", groups.tabor
    if curve is None:
        no_start = "JKR has no contact at the start"
        return _limit(name, None, _NO_RATE if groups.modulus_ratio >= 1 else no_start)
    force, haste = slowest * curve.pull_off_force / _JKR_FORCE, _haste(groups)
    if not at_least(mu, 1):
        return _limit(name, force, _TOO_LONG.format(mu))
    if not at_most(haste, _NEARLY):
        why = (
            f"the bulk has no time to relax: {haste:.3g} contact heights are retracted in the "
            f"mean retardation time; valid up to about {_RELAXED:g}"
        )
        return _limit(name, force, why)
    if not at_most(haste, _RELAXED):
        why = "the bulk hardly relaxes while the edge moves; the force is up to 20 % low"
        return Estimate(name, force, 0.2, True, why)
    why = "the bulk relaxes while the edge moves as a crack"
    return Estimate(name, force, 0.05 if at_least(mu, _JKR) else 0.12, True, why)


def _detached(groups: Groups, slowest: float, state: _State | None) -> Estimate:
    name, mu = "detachment", groups.tabor
    if groups.modulus_ratio >= 1:
        return _limit(name, None, _NO_RATE)
    if state is None:
        why = "the preload is too light for this rate, so the force depends on the start"
        return _limit(name, None, why)
    force = slowest * state.amplification
    for least, needed, error in _DETACHMENT:
        if at_least(mu, least) and at_least(state.margin, needed):
            why = "the edge moves as a crack, and the bulk responds with its creep up to pull-off"
            return Estimate(name, force, error, True, why)
    if not at_least(mu, 1):
        return _limit(name, force, _TOO_LONG.format(mu))
    why = (
        f"the contact radius at the start is {state.margin:.3g} times that at pull-off; valid "
        f"from {1.2 if at_least(mu, 2) else 2:g} times"
    )
    return _limit(name, force, why)


def _fitted(groups: Groups, preload: str) -> Estimate:
    name, mu, k = "rate-fit", groups.tabor, groups.modulus_ratio
    if k >= 1:
        return _limit(name, None, _NO_RATE)
    r = float(np.asarray(rate.rate_as_published(_rate(groups) * groups.material.time_unit)))
    speed = rate.COEFFICIENT * r**rate.EXPONENT
    force = float(np.asarray(persson_brener.amplification(speed, material=groups.material)))
    if abs(np.log(mu / rate.FITTED_TABOR)) > np.log(1.25):
        why = f"Eq. 4.24 was fitted only at a Tabor number of 3.24; this one is {mu:.3g}"
    elif not (at_least(k, 0.01) and at_most(k, 0.1)):
        why = f"Eq. 4.24 was fitted for modulus ratios from 0.01 to 0.1; this one is {k:.3g}"
    elif preload == "raises":
        why = "Eq. 4.24 was fitted to heavier preloads"
    else:
        why = "crack speed from the rate by the fit of Eq. 4.24, force by Persson-Brener"
        return Estimate(name, force, _FIT_ERROR, True, why)
    return _limit(name, force, why)


def _glassy(
    groups: Groups,
    regime: str,
    fastest: float,
    start: float | None,
    slowest: float,
    gamma: float,
) -> Estimate:
    name, k = "glassy", groups.modulus_ratio
    if k >= 1:
        return _limit(name, slowest, "an elastic solid has no glassy limit")
    least = (9 / (8 * k)) ** (1 / 3)
    if start is None or start < 1.5 * least:
        why = (
            "the start is too small a contact for the full glassy force, which needs a radius of "
            f"{1.5 * least:.3g} or more; this force is an upper limit"
        )
        return _limit(name, fastest, why)
    if regime != "glassy":
        return _limit(name, fastest, "the retraction is slower; this force is an upper limit")
    c, p, q = _GLASSY_ERROR
    # reduction by a light preload, and by an edge below the glassy energy
    light = c * (groups.tabor * k ** (1 / 3)) ** p * (start / least) ** q
    error = max(_GLASSY_LEAST, light + 1 / (gamma * k) - 1)
    if error > _GLASSY_MOST:
        why = (
            "the range of the forces is so long that the full glassy force needs a larger contact "
            "at the start; this force is an upper limit"
        )
        return _limit(name, fastest, why)
    return Estimate(name, fastest, error, True, "the energy of the edge is nearly the glassy one")
