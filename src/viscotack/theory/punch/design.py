r"""Design formulas for a flat punch on a viscoelastic layer: thickness for a pull-off stress.

The pull-off stress at a crack speed, or at a retraction speed, decreases with the thickness, from
the strength :math:`\sigma_0` to the half-plane; these functions invert it. The detachment regime
over thickness and speed is computed by :mod:`viscotack.theory.punch.map`.

The pad and the crack law of its edges are those of :mod:`viscotack.theory.punch.unloading`, with
its range and errors: the stress is up to 19 % too high, and so is the thickness, by up to twice as
much on thin layers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy

from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, plain, positive
from viscotack.theory.crack import CrackLaw

from . import rate, unloading
from .pad import Pad

# Largest thickness, in half widths, for a given crack speed (a half-plane to 1e-4) and
# for a given retraction speed.
_HALF_PLANE, _THICKEST = 100.0, 5.0
_TOLERANCE = 1e-12


def pull_off_stress(thickness: Values, pad: Pad, law: CrackLaw, *, crack_speed: Values) -> Number:
    r"""Return the mean stress [Pa] at which the edges of a full contact have a crack speed [m/s].

    .. math:: \bar\sigma = \bar\sigma_{el} \sqrt{\Gamma(v)}, \quad
              \Gamma < (\sigma_0/\bar\sigma_{el})^2

    with the exact elastic stress. It ranges from the elastic stress of a slow crack to the smaller
    of :math:`1/\sqrt k` times that and the strength. A ligament narrower than the punch carries
    less in proportion.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    pad : Pad
        Punch, layer and interface; the Poisson ratio of a bonded layer is at most 0.49.
    law : CrackLaw
        Crack law of the edges, :meth:`viscotack.theory.punch.pad.Pad.crack_law`.
    crack_speed : array_like
        v [m/s], not negative.

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
    >>> stress = pull_off_stress(3e-4, pad, law, crack_speed=[0, 1e-2, 1])
    >>> [f"{s / 1e3:.1f} kPa" for s in stress]
    ['19.2 kPa', '25.3 kPa', '46.2 kPa']
    """
    elastic = np.asarray(pad.elastic_stress(thickness))
    gamma = rate.amplification(crack_speed, law, largest=(pad.strength / elastic) ** 2)
    return plain(elastic * np.sqrt(gamma))


def thickness_at_crack_speed(
    stress: Values, pad: Pad, law: CrackLaw, *, crack_speed: float
) -> Number:
    """Return the thickness [m] with a given pull-off stress [Pa] at a crack speed [m/s].

    The inverse of :func:`pull_off_stress`. Takes 20 ms per value.

    Parameters
    ----------
    stress : array_like
        Mean pull-off stress [Pa], below the strength and above that of a layer of 100 a.
    pad : Pad
        Punch, layer and interface; the Poisson ratio of a bonded layer is at most 0.49.
    law : CrackLaw
        Crack law of the edges, :meth:`viscotack.theory.punch.pad.Pad.crack_law`.
    crack_speed : float
        v [m/s], not negative.

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
    >>> f"{thickness_at_crack_speed(3e4, pad, law, crack_speed=0.01) * 1e6:.0f} um"
    '198 um'
    """
    return _thickness(
        stress, pad, lambda b: pull_off_stress(b, pad, law, crack_speed=crack_speed), _HALF_PLANE
    )


def thickness_at_speed(stress: Values, pad: Pad, law: CrackLaw, *, speed: float) -> Number:
    """Return the thickness [m] with a given pull-off stress [Pa] at a retraction speed [m/s].

    The inverse of :func:`viscotack.theory.punch.unloading.pull_off`. Takes 50 ms per value.

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
    return _thickness(
        stress, pad, lambda b: unloading.pull_off(speed, pad, law, thickness=b).stress, _THICKEST
    )


def _thickness(wanted: Values, pad: Pad, stress: Callable[[float], Any], thickest: float) -> Number:
    """Return the thickness at which a stress that decreases with it has given values."""
    sigma, s0, a = positive(stress=wanted), pad.strength, pad.half_width
    if np.any(sigma >= s0):
        raise InputError(
            f"stress must be below the strength of the interface, {s0:.6g} Pa, got "
            f"{np.max(sigma):.6g} Pa"
        )
    lowest = float(stress(thickest * a))
    if np.any(sigma <= lowest):
        raise InputError(
            f"stress must exceed that of a layer {thickest:g} times as thick as the half width, "
            f"{lowest:.6g} Pa, got {np.min(sigma):.6g} Pa"
        )
    # up to this thickness the elastic layer detaches at the strength
    thin = np.log(pad.elastic_thickness(s0)) - 1e-6
    thick = np.log(thickest * a)

    def solved(value: float) -> float:
        def miss(log_b: float) -> float:
            return float(np.log(stress(float(np.exp(log_b))) / value))

        root: Any = scipy.optimize.brentq(miss, thin, thick, xtol=_TOLERANCE)
        return float(np.exp(root))

    return plain(np.vectorize(solved, otypes=[float])(sigma))
