r"""Pull-off of a sphere from an elastic solid whose edge takes an energy that grows with its speed.

The bulk is elastic; all losses are at the edge, whose energy is the empirical law of Gent and
Schultz in the speed of the edge:

.. math:: \delta = \frac{a^2}{R} - \sqrt{\frac{2 \pi a G}{E^*}}, \quad
          P = \frac{4 E^* a^3}{3 R} - \sqrt{8 \pi E^* a^3 G}, \quad
          G = w \left( 1 + \left( \frac{-\dot a}{v_0} \right)^n \right), \quad
          \delta + \frac{P}{K} = \delta_0 - v t

after Maugis and Barquins (1978), doi:10.1088/0022-3727/11/14/011. The contact begins at rest under
a preload. With a rigid machine the force depends on E* by :math:`v_0/E^{*1/3}` only.
"""

from __future__ import annotations

import numpy as np

from viscotack.arrays import Array
from viscotack.theory._checks import Number, Values, contact_scales, plain, positive
from viscotack.theory.elastic import jkr

# Number of steps in ln a, last radius over the scale of the contact, and number of steps within the
# first one, because a fast edge takes up its energy near the start. Forces are within 0.3 %.
_STEPS, _LAST, _FIRST = 64, 0.25, 24
_SOONEST = 1e-9  # the first of these, as a part of ln a
_ROUNDS, _CLOSE = 30, 1e-8  # of Newton's method, in ln


def pull_off_force(
    speed: Values,
    *,
    radius: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
    reference_speed: Values,
    exponent: Values,
    preload: Values,
    stiffness: float | None = None,
) -> Number:
    """Return the pull-off force [N] at a speed of the drive.

    Parameters
    ----------
    speed : array_like
        Retraction speed v of the drive [m/s].
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and w, the energy of the edge at rest [J/m^2]; positive.
    reference_speed, exponent : array_like
        v0 of the edge [m/s] and n; positive.
    preload : array_like
        Force of the start at rest [N]; positive.
    stiffness : float, optional
        K of the machine between drive and sphere [N/m]; None for a rigid one.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> case = dict(radius=5e-3, contact_modulus=2e6, work_of_adhesion=0.06, preload=2e-3)
    >>> law = dict(reference_speed=50e-6, exponent=0.4)
    >>> [f"{pull_off_force(v, **case, **law) * 1e3:.2f} mN" for v in (1e-16, 50e-6)]
    ['1.41 mN', '5.51 mN']
    """
    case = {"speed": speed, "radius": radius, "contact_modulus": contact_modulus}
    case |= {"work_of_adhesion": work_of_adhesion, "reference_speed": reference_speed}
    case |= {"exponent": exponent, "preload": preload}
    v, R, E, w, v0, n, P = np.broadcast_arrays(*positive(**case))
    length, depth, load = contact_scales(R, E, w)
    start = np.asarray(
        jkr.contact_radius_at_force(P, radius=R, contact_modulus=E, work_of_adhesion=w)
    )
    soft = 0.0 if stiffness is None else load / (depth * positive(stiffness=stiffness))
    reduced = start / length, v * length / (v0 * depth), n, soft
    return plain(load * _tension(*(np.asarray(x, dtype=float) for x in reduced)))


def _tension(start: Array, rate: Array, n: Array, soft: Array | float) -> Array:
    """Return the largest tension from a start radius, in the scales of the contact.

    `rate` is the speed over that at which an edge of speed v0 takes up the depth. First order in
    the steps: the largest tensions of two runs are extrapolated.
    """
    first = np.geomspace(_SOONEST, 1 / _STEPS, _FIRST, endpoint=False)
    way = np.concatenate([[0.0], first, np.arange(1, _STEPS + 1) / _STEPS])
    way = np.sort(np.concatenate([way, (way[1:] + way[:-1]) / 2]))
    fine, coarse = (_receded(part, start, rate, n, soft) for part in (way, way[::2]))
    return 2 * fine - coarse


def _receded(way: Array, start: Array, rate: Array, n: Array, soft: Array | float) -> Array:
    r"""Return the largest tension of a run over fractions of the way of ln a.

    In each step of backward Euler the drive moves on by :math:`rate\,|\Delta a|\,(G - 1)^{-1/n}`.
    With :math:`G = (p + s)^2`, the logarithm of this equation is convex in ln p, nearly straight.
    """
    last = np.minimum(_LAST, start / 2)
    a, log_p = start, np.zeros(start.shape)
    drive, tension = _drive(a, np.ones(start.shape), soft), np.zeros(start.shape)
    for part in way[1:]:
        before, a = a, start * (last / start) ** part
        per_root = np.sqrt(2 * a) * (1 + 2 * a * soft)
        level = np.log(per_root / (rate * (before - a)))
        # the root of G at which the drive stands still
        still = 1 - (drive - _drive(a, np.ones(start.shape), soft)) / per_root
        least = np.maximum(still, 1.0)
        rest, gained = least - still, least**2 - 1
        for _ in range(_ROUNDS):
            p = np.exp(log_p)
            g = p * (p + 2 * least) + gained
            off = level + np.log(p + rest) + np.log(g) / n
            slope = p / (p + rest) + 2 * p * (p + least) / (g * n)
            step = off / slope
            log_p = log_p - step
            if np.max(np.abs(step)) < _CLOSE:
                break
        root = least + np.exp(log_p)
        drive = _drive(a, root, soft)
        tension = np.maximum(tension, np.sqrt(8 * a**3) * root - 4 * a**3 / 3)
    return tension


def _drive(a: Array, root: Array, soft: Array | float) -> Array:
    """Return the position of the drive at a radius and a root of G."""
    depth = a**2 - np.sqrt(2 * a) * root
    return depth + soft * (2 * a * depth - 2 * a**3 / 3)
