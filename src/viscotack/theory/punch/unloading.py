r"""Retraction of a flat punch from a viscoelastic layer at a given speed: the state at pull-off.

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
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy

from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, plain, positive
from viscotack.theory.crack import CrackLaw

from . import crossover, rate
from .pad import Pad

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
    crack, gamma = _motion(speed * a / v0, largest, law)
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


def _motion(drive: Any, largest: float, law: CrackLaw) -> tuple[Any, Any]:
    """Return the crack speeds [m/s] of the drives r a/v0, and their amplifications."""
    low, high = np.log10([_SLOWEST * np.min(drive), _FASTEST * np.max(drive)])
    crack = np.logspace(low, high, round(_PER_DECADE * (high - low)) + 1)
    return crack, np.asarray(rate.amplification(crack, law, largest=largest))
