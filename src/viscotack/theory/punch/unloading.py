r"""Retraction of a flat punch from a viscoelastic layer: pull-off, edge cracks, map of regimes.

During retraction, :math:`v = r t` above the free surface, the layer under the punch stores energy
and its two edges recede as cracks. With a relaxed bulk and viscoelastic edges,

.. math:: \Gamma(V) = \frac{v^2}{v_0^2}, \quad V = -\frac{da_c}{dt}, \quad
          \bar\sigma = \frac{E_0^*}{2a} S(a_c/b) \, v,

with v0 the elastic pull-off depth, taken positive. In a layer the energy release rate hardly
depends on the half width of the remaining ligament :math:`a_c`. Neglecting this dependence, which
changes the stress by less than 1 % up to b = 5a and a Poisson ratio of 0.45, the motion is one
integral,

.. math:: \frac{a_c}{a} = 1 - \frac{v_0}{r a} \int_1^{v/v_0} V(\Gamma = u^2) \, du,

and pull-off is the point of largest stress. The amplification is limited by
:math:`(\sigma_0/\bar\sigma_{el})^2`, with the exact elastic pull-off stress of
:mod:`viscotack.theory.punch.crossover`, so the stress does not exceed the strength.

Range: b < 5a, a relaxed start, a cohesive zone small compared with a and b. The bulk is assumed
relaxed; in fast retraction this hardly changes the stress, but pull-off occurs at a much
smaller depth. Compared with 35 simulations of a standard solid with Lennard-Jones forces (k = 0.1,
a = 65 a0, strength E0*/20, b from 1.5 to 324 a0, r from 0.01 to 100 h0/tau0) the stress is 1 % low
to 19 % high, 10 % high in the median, closest where the pad detaches at its strength; the ligament
is accurate to 0.1 a; the depth to 25 % up to r = 1 h0/tau0, and not usable above 10 h0/tau0.

Source: this package, after the thin layer of Maghami, PhD thesis (2025), chapter 3.

**Flat punch on a viscoelastic layer: energy of the edge cracks, limited by the finite size.** The
energy of a fast crack is :math:`\Gamma = \Delta\gamma_{eff}/\Delta\gamma_0` works of adhesion, on a
half-space up to glassy over rubbery modulus, 1/k. On a layer the mean stress cannot exceed the
strength of the interface, so :math:`\Gamma` is below :math:`(\pi/4) \, b/a_0`. The theories of
Greenwood and of Persson and Brener are corrected by their glassy limit: the larger of k and the
inverse of that limit, :math:`k_b`, replaces k, as in
:meth:`viscotack.theory.crack.law.CrackLaw.limited` for any spectrum; for one retardation time this
is Eq. 3.35 and, for Persson and Brener, Eq. 4 of appendix II. Below the thickness b0 the limit is
below 1 and holds at every speed.

Speeds are those of the crack [m/s], opening. The crack is that of the edges of a
:class:`viscotack.theory.punch.pad.Pad`, by its method ``crack_law``.

Source: Maghami, PhD thesis (2025), Eq. 3.31 to 3.35 and appendix II.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, at_least, plain, positive
from viscotack.theory.crack import CrackLaw
from viscotack.theory.punch import crossover
from viscotack.theory.punch.pad import REGIMES, Pad, Thicknesses, regime_thicknesses

# Crack speeds of the grid, in r a/v0: slower ones do not shorten the ligament, and pull-off
# occurs at (a_c/a)(v0/v)/(d ln S/d ln a_c), which is below 2 up to b = 5a.
_SLOWEST, _FASTEST = 1e-8, 10.0
_PER_DECADE = 120
# Largest thickness [half widths] that is searched for a stress, and tolerance of its logarithm.
_THICKEST, _TOLERANCE = 5.0, 1e-12
# States of the motion per rate, and number of states per batch.
_BLOCK = 2**18


class PullOff(NamedTuple):
    """State at pull-off, returned by :func:`pull_off`: floats or arrays of one shape, SI.

    Attributes
    ----------
    stress : array_like
        Largest mean stress over the punch [Pa], tension positive.
    depth : array_like
        Depth [m], negative.
    ligament : array_like
        Half width still in contact [m].
    crack_speed : array_like
        Speed of each edge [m/s]; infinite if the whole contact opens simultaneously, at its
        strength or because the layer is elastic.
    amplification : array_like
        Effective over rubbery surface energy.
    """

    stress: Number
    depth: Number
    ligament: Number
    crack_speed: Number
    amplification: Number


def pull_off(speed: Values, pad: Pad, law: CrackLaw, *, thickness: Values) -> PullOff:
    """Compute the state at pull-off for retraction speeds and thicknesses, broadcast.

    Uses the trapezoidal rule over a fine grid of crack speeds: the error of the stress is below
    1e-5. Every distinct thickness takes 2 to 5 ms, every speed 0.3 ms.

    Parameters
    ----------
    speed, thickness : array_like
        Retraction speed r [m/s] and b [m]; positive.
    pad : Pad
        Punch, layer and interface; the Poisson ratio of a bonded layer is at most 0.49.
    law : CrackLaw
        Crack law of the edges, :meth:`viscotack.theory.punch.pad.Pad.crack_law`.

    Returns
    -------
    PullOff
        Stress [Pa], depth [m], ligament [m], crack speed [m/s] and amplification.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.theory.punch import Frictionless, Pad
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> law = pad.crack_law("greenwood", material=solid)
    >>> found = pull_off([1e-6, 1e-3], pad, law, thickness=3e-4)
    >>> [f"{s / 1e3:.1f} kPa" for s in found.stress]
    ['19.4 kPa', '31.5 kPa']
    """
    r, b = np.broadcast_arrays(*positive(speed=speed, thickness=thickness))
    found = np.empty((len(PullOff._fields), *r.shape))
    for value in np.unique(b):
        here = b == value
        found[:, here] = _at_thickness(r[here], float(value), pad, law)
    return PullOff(*(plain(x) for x in found))


def thickness_at_speed(stress: Values, pad: Pad, law: CrackLaw, *, speed: float) -> Number:
    """Return the thickness [m] with a given pull-off stress [Pa] at a retraction speed [m/s].

    The inverse of :func:`pull_off`. Takes 50 ms per value.

    Parameters
    ----------
    stress : array_like
        Mean pull-off stress [Pa], below the strength and above that of a layer of 5 a.
    pad : Pad
        Punch, layer and interface; the Poisson ratio of a bonded layer is at most 0.49.
    law : CrackLaw
        Crack law of the edges, :meth:`viscotack.theory.punch.pad.Pad.crack_law`.
    speed : float
        r [m/s], positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.theory.punch import Frictionless, Pad
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> law = pad.crack_law("greenwood", material=solid)
    >>> f"{thickness_at_speed(3e4, pad, law, speed=1e-4) * 1e6:.0f} um"
    '183 um'
    """
    sigma, s0, a = positive(stress=stress), pad.strength, pad.half_width
    if np.any(sigma >= s0):
        raise InputError(
            f"stress must be below the strength of the interface, {s0:.6g} Pa, got "
            f"{np.max(sigma):.6g} Pa"
        )

    def at_pull_off(b: float) -> float:
        return float(np.asarray(pull_off(speed, pad, law, thickness=b).stress))

    lowest = at_pull_off(_THICKEST * a)
    if np.any(sigma <= lowest):
        raise InputError(
            f"stress must exceed that of a layer {_THICKEST:g} times as thick as the half width, "
            f"{lowest:.6g} Pa, got {np.min(sigma):.6g} Pa"
        )
    # up to this thickness the elastic layer detaches at the strength
    thin = np.log(pad.elastic_thickness(s0)) - 1e-6
    thick = np.log(_THICKEST * a)

    def solved(value: float) -> float:
        def miss(log_b: float) -> float:
            return float(np.log(at_pull_off(float(np.exp(log_b))) / value))

        root: Any = scipy.optimize.brentq(miss, thin, thick, xtol=_TOLERANCE)
        return float(np.exp(root))

    return plain(np.vectorize(solved, otypes=[float])(sigma))


def _at_thickness(speed: Any, b: float, pad: Pad, law: CrackLaw) -> Any:
    """Return the fields of PullOff, shape (5, speeds)."""
    a, elastic, v0 = pad.half_width, float(pad.elastic_stress(b)), -float(pad.elastic_depth(b))
    largest = (pad.strength / elastic) ** 2
    if largest <= 1 or law.largest <= 1:
        # detachment at the strength, or elastic: no moving crack
        stress = min(pad.strength, elastic)
        state = stress, -v0 * stress / elastic, a, np.inf, min(1.0, largest)
        return np.repeat(np.array(state)[:, None], speed.size, axis=1)
    # from the drives r a/v0
    low = np.log10(_SLOWEST * np.min(speed * a / v0))
    high = np.log10(_FASTEST * np.max(speed * a / v0))
    crack = np.logspace(low, high, round(_PER_DECADE * (high - low)) + 1)
    gamma = np.asarray(amplification(crack, law, largest=largest))
    u = np.sqrt(gamma)
    steps = (crack[1:] + crack[:-1]) / 2 * np.diff(u)
    lost = np.append(0.0, np.cumsum(steps)) * v0 / a
    found = np.empty((5, speed.size))
    rows = max(1, _BLOCK // u.size)
    for i in range(0, speed.size, rows):
        r = speed[i : i + rows, None]
        left = np.maximum(1 - lost / r, 0.0)
        best = np.argmax(_stress(left, u, b, v0, pad), axis=1)
        # maximum of a parabola in ln of the crack speed through three states
        near = np.clip(best, 1, u.size - 2)[:, None] + np.array([-1, 0, 1])
        left, wide = np.take_along_axis(left, near, axis=1), u[near]
        t = _top(_stress(left, wide, b, v0, pad))
        left, wide = _at(t, left), _at(t, wide)
        found[:, i : i + rows] = (
            _stress(left, wide, b, v0, pad),
            -v0 * wide,
            a * left,
            np.exp(_at(t, np.log(crack[near]))),
            wide**2,
        )
    return found


def _stress(left: Any, u: Any, b: float, v0: float, pad: Pad) -> Any:
    """Return the mean stress over the punch; zero without a ligament."""
    a, E = pad.half_width, pad.contact_modulus
    ligament = a * np.where(left > 0, left, 1.0)
    stiffness = crossover.stiffness(b, half_width=ligament, contact_modulus=E, base=pad.base)
    return np.where(left > 0, stiffness * v0 * u / (2 * a), 0.0)


def _top(values: Any) -> Any:
    """Return the position of the maximum of the parabola through values at -1, 0 and 1."""
    before, middle, after = values.T
    bend = np.minimum(before - 2 * middle + after, 0.0)
    flat = bend == 0
    return np.where(flat, 0.0, np.clip((before - after) / (2 * (bend - flat)), -1, 1))


def _at(t: Any, values: Any) -> Any:
    """Return the parabola through values at -1, 0 and 1."""
    before, middle, after = values.T
    return middle + t * (after - before) / 2 + t**2 * (before - 2 * middle + after) / 2


def largest_amplification(thickness: Values, pad: Pad) -> Number:
    r"""Return the effective over rubbery surface energy allowed by the size of the pad.

    .. math:: \Gamma_{max} = \frac{\min(b, b_1)}{b_0}
              = \frac\pi4 \frac{b}{\zeta a_0} \;(b < b_1), \quad \frac{a}{a_0} \;(b > b_1)

    where the mean stress equals the strength (Eq. 3.31, which is for b < b1). The material gives
    another limit, 1/k. Below 1 the pad detaches at its strength at any speed.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    pad : Pad
        Punch, layer and interface; the Poisson ratio of a bonded layer is below 0.5.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> f"{largest_amplification(1e-4, pad):.2f}"
    '2.50'
    """
    b = positive(thickness=thickness)
    b0, _, b1 = regime_thicknesses(pad, modulus_ratio=1.0)
    return plain(np.minimum(b, b1) / b0)


def amplification(crack_speed: Values, law: CrackLaw, *, largest: Values) -> Number:
    r"""Return effective over rubbery surface energy at a crack speed, corrected for finite size.

    Parameters
    ----------
    crack_speed : array_like
        Speed [m/s] at which each edge recedes, not negative.
    law : CrackLaw
        Crack law of the edges on a half-space.
    largest : array_like
        Limit by the size: :func:`largest_amplification`, or infinity for a half-space.

    Raises
    ------
    InputError
        If a speed is negative or not finite, or a limit is not positive.

    Notes
    -----
    1e5 speeds take 0.1 s; every distinct ``largest`` below 1/k takes 1 to 5 ms.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.theory.punch import Frictionless, Pad
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> law = pad.crack_law("greenwood", material=solid)
    >>> found = amplification(0.1, law, largest=[0.5, 2.5, np.inf])
    >>> [f"{x:.3f}" for x in found]
    ['0.500', '2.163', '3.891']
    """
    v, limit = np.broadcast_arrays(
        at_least(0, "a crack that closes is another problem", crack_speed=crack_speed),
        _positive_limit(largest),
    )
    # below b0 the strength limits the stress at every speed
    found = np.array(np.minimum(limit, 1.0))
    for limited, here in _limited(law, limit):
        found[here] = limited.amplification(v[here])
    return plain(found)


def crack_speed(amplification: Values, law: CrackLaw, *, largest: Values) -> Number:
    """Return the crack speed [m/s] at which an amplification is reached.

    Parameters
    ----------
    amplification : array_like
        Effective over rubbery surface energy, at least 1 and below both `largest` and glassy
        over rubbery modulus.
    law : CrackLaw
        Crack law of the edges on a half-space.
    largest : array_like
        As for :func:`amplification`.

    Raises
    ------
    InputError
        If an amplification is not in its range, or a limit is not positive.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.theory.punch import Frictionless, Pad
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> law = pad.crack_law("greenwood", material=solid)
    >>> f"{crack_speed(2.0, law, largest=2.5) * 1e3:.1f} mm/s"
    '54.2 mm/s'
    """
    gamma, limit = np.broadcast_arrays(
        at_least(
            1,
            "the energy of the slowest crack is the work of adhesion",
            amplification=amplification,
        ),
        _positive_limit(largest),
    )
    most = np.minimum(limit, law.largest)
    if np.any((gamma >= most) & (gamma > 1)):
        raise InputError(
            "amplification must be below the limits of size and material, which are reached at "
            f"infinite speed: got {np.max(gamma):.6g}, limit {np.min(most):.6g}"
        )
    found = np.zeros(gamma.shape)
    for limited, here in _limited(law, limit):
        found[here] = limited.speed(gamma[here])
    return plain(found)


def _positive_limit(largest: Values) -> Any:
    limit = np.asarray(largest, dtype=float)
    if not np.all(limit > 0):
        raise InputError(f"largest must be a positive amplification, got {np.min(limit)}")
    return limit


def _limited(law: CrackLaw, limit: Any) -> Iterator[tuple[CrackLaw, Any]]:
    """Yield each limited law and its elements; nothing if the limit is 1 or below."""
    ratios = np.maximum(1 / limit, law.material.modulus_ratio)
    for ratio in np.unique(ratios[ratios < 1]):
        yield law.limited(modulus_ratio=float(ratio)), ratios == ratio


class RegimeMap(NamedTuple):
    """Detachment of a pad over thickness (rows) and speed (columns), from :func:`regime_map`.

    Attributes
    ----------
    thickness : ndarray, shape (N,)
        Thickness of the layer [m].
    speed : ndarray, shape (M,)
        Retraction speed [m/s].
    regime : ndarray of str, shape (N, M)
        One of :data:`viscotack.theory.punch.pad.REGIMES`.
    stress : ndarray, shape (N, M)
        Mean pull-off stress [Pa].
    crack_speed : ndarray, shape (N, M)
        Speed of each edge at pull-off [m/s]; infinite if the whole contact opens simultaneously.
    amplification : ndarray, shape (N, M)
        Effective over rubbery surface energy at pull-off.
    boundaries : Thicknesses
        b0 of the slowest and of the fastest retraction, and b1 [m].
    """

    thickness: npt.NDArray[np.float64]
    speed: npt.NDArray[np.float64]
    regime: npt.NDArray[np.str_]
    stress: npt.NDArray[np.float64]
    crack_speed: npt.NDArray[np.float64]
    amplification: npt.NDArray[np.float64]
    boundaries: Thicknesses


def regime_map(thickness: Values, speed: Values, pad: Pad, law: CrackLaw) -> RegimeMap:
    """Compute the detachment regimes over thicknesses and retraction speeds.

    Cohesive if the energy of the crack at pull-off on a half-space would exceed the limit of the
    finite size; otherwise a thin layer below b1 and a half-plane above. A 40 by 40 map takes half a
    second.

    Parameters
    ----------
    thickness : array_like, shape (N,)
        b [m], positive.
    speed : array_like, shape (M,)
        Retraction speed [m/s], positive.
    pad : Pad
        Punch, layer and interface; the Poisson ratio of a bonded layer is at most 0.49.
    law : CrackLaw
        Crack law of the edges, :meth:`viscotack.theory.punch.pad.Pad.crack_law`.

    Raises
    ------
    InputError
        If a value is outside its range or not finite, or an axis is not one-dimensional.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.theory.punch import Frictionless, Pad
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> law = pad.crack_law("greenwood", material=solid)
    >>> found = regime_map([1e-4, 2e-3], [1e-6, 1.0], pad, law)
    >>> found.regime.tolist()
    [['thin layer', 'cohesive'], ['half-plane', 'half-plane']]
    """
    b, r = (np.atleast_1d(x) for x in positive(thickness=thickness, speed=speed))
    if b.ndim > 1 or r.ndim > 1:
        raise InputError(
            f"thickness and speed must be one-dimensional arrays, got shapes {b.shape} and "
            f"{r.shape}"
        )
    state = pull_off(r, pad, law, thickness=b[:, None])
    crack = np.asarray(state.crack_speed)
    running = np.isfinite(crack)
    unlimited = np.ones(crack.shape)
    unlimited[running] = amplification(crack[running], law, largest=np.inf)
    boundaries = regime_thicknesses(pad, modulus_ratio=law.material.modulus_ratio)
    elastic = np.asarray(pad.elastic_stress(b))
    cohesive = np.sqrt(unlimited) * elastic[:, None] >= pad.strength
    thick = np.where(b > boundaries.half_plane, 2, 1)[:, None]
    return RegimeMap(
        thickness=b,
        speed=r,
        regime=np.array(REGIMES)[np.where(cohesive, 0, thick)],
        stress=np.asarray(state.stress),
        crack_speed=crack,
        amplification=np.asarray(state.amplification),
        boundaries=boundaries,
    )
