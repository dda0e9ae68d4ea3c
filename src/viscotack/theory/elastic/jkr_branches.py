r"""The branches of the JKR equilibrium: the contact radius at a depth or at a force.

The functions are reached as ``jkr.contact_radius_at_depth`` and so on; parameters, units, signs,
range and source as in :mod:`viscotack.theory.elastic.jkr`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.theory._checks import Number, at_least, plain
from viscotack.theory._scales import contact_scales

_NO_DEPTH = "above that the contact is lost even on a rigid drive, see instability"
_FAR = 1e30
_NO_FORCE = "a stronger pull detaches, see pull_off_force"


def contact_radius_at_depth(
    depth: npt.ArrayLike,
    *,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
) -> Number:
    r"""Return the contact radius [m] that a rigid drive holds at a depth [m].

    The larger root of :math:`\hat a^2 - \sqrt{2 \hat a} = \hat\delta`, in closed form; the depth
    must not lie below that of :func:`jkr.instability`.

    Examples
    --------
    >>> case = dict(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{contact_radius_at_depth(0.0, **case) * 1e6:.1f} um"
    '68.0 um'
    """
    length, height, _ = contact_scales(radius, contact_modulus, work_of_adhesion)
    d = at_least(-0.75 * height, _NO_DEPTH, depth=depth) / height
    larger, _ = _roots_at_depth(d)
    return plain(length * larger**2)


def unstable_contact_radius_at_depth(
    depth: npt.ArrayLike,
    *,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
) -> Number:
    r"""Return the smaller contact radius [m] in equilibrium at a depth [m]; nothing holds it.

    It exists between the depth of :func:`jkr.instability` and zero, where it vanishes.

    Examples
    --------
    >>> case = dict(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{unstable_contact_radius_at_depth(-1e-6, **case) * 1e6:.2f} um"
    '3.25 um'
    """
    length, height, _ = contact_scales(radius, contact_modulus, work_of_adhesion)
    d = at_least(-0.75 * height, _NO_DEPTH, depth=depth) / height
    if np.any(d > 0):
        raise InputError(
            f"depth must not be positive on the unstable branch, got {np.max(depth)} m; "
            "use contact_radius_at_depth"
        )
    _, smaller = _roots_at_depth(d)
    return plain(length * smaller**2)


def contact_radius_at_force(
    force: npt.ArrayLike,
    *,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
) -> Number:
    r"""Return the contact radius [m] that a dead load holds at a force [N].

    The larger root of :math:`\frac43 \hat a^3 - \sqrt{8 \hat a^3} = \hat P`; the force must not
    lie below minus :func:`jkr.pull_off_force`.

    Examples
    --------
    >>> case = dict(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{contact_radius_at_force(0.0, **case) * 1e6:.1f} um"
    '89.1 um'
    """
    length, _, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    P = at_least(-1.5 * load, _NO_FORCE, force=force) / load
    return plain(length * np.cbrt(_root_at_force(P) ** 2))


def unstable_contact_radius_at_force(
    force: npt.ArrayLike,
    *,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
) -> Number:
    r"""Return the smaller contact radius [m] in equilibrium at a force [N].

    It exists for tension up to :func:`jkr.pull_off_force`. A dead load does not hold it; a rigid
    drive holds the part of it with a radius above that of :func:`jkr.instability`.

    Examples
    --------
    >>> case = dict(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{unstable_contact_radius_at_force(-1e-4, **case) * 1e6:.1f} um"
    '21.8 um'
    """
    length, _, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    P = at_least(-1.5 * load, _NO_FORCE, force=force) / load
    if np.any(P > 0):
        raise InputError(
            f"force must not be positive on the unstable branch, got {np.max(force)} N; "
            "use contact_radius_at_force"
        )
    # The product of the two roots is -3P/4: no cancellation for a small force.
    return plain(length * np.cbrt((0.75 * P / _root_at_force(P)) ** 2))


def _roots_at_depth(d: npt.NDArray[np.float64]) -> tuple[Any, Any]:
    r"""Return both roots s = sqrt(a) of :math:`s^4 - \sqrt2 s - d = 0`, d from -3/4.

    Ferrari's solution; m is the positive root of the resolvent m^3 + d m - 1/4 = 0. Differences
    of nearly equal numbers are written as quotients. At d = -3/4 round-off may leave a tiny
    negative number under a root.
    """
    # beyond that the root grows with the fourth root of the depth, to round-off
    far = np.maximum(d, _FAR) / _FAR
    d = np.minimum(d, _FAR)
    C = np.cbrt(1 / 8 + np.sqrt(np.maximum(1 / 64 + d**3 / 27, 0)))
    m = 1 / (4 * (C**2 + d / 3 + (d / (3 * C)) ** 2))
    t = np.sqrt(2 * m)
    larger = (t + np.sqrt(np.maximum(2 * np.sqrt(2) / t - t**2, 0))) / 2
    product = -d * np.sqrt(m) / (m**1.5 + 0.5)
    return far**0.25 * larger, product / larger


def _root_at_force(P: npt.NDArray[np.float64]) -> Any:
    r"""Return the larger root c = a^(3/2) of :math:`\frac43 c^2 - \sqrt8 c - P = 0`."""
    return 0.75 * (np.sqrt(2) + np.sqrt(np.maximum(2 + 4 * P / 3, 0)))
