r"""JKR: a rigid sphere on an elastic half-space with adhesion of vanishing range.

Parameters of all functions: ``radius`` R of the sphere [m], ``contact_modulus`` E* [Pa],
``work_of_adhesion`` :math:`\Delta\gamma_0` [J/m^2], all positive. Range: large Tabor number,
elastic solid; for a viscoelastic solid this is the infinitely slow limit. For a finite range
use :mod:`viscotack.theory.elastic.maugis`, without adhesion :mod:`viscotack.theory.elastic.hertz`.

Along the equilibrium curve the contact radius falls from the loaded state through the force
minimum (:func:`pull_off`, where a dead load detaches) to the depth minimum
(:func:`instability`, where a rigid drive detaches) and on to zero on a branch that nothing
holds. Formulas use, with Eq. 4.16,

.. math:: \hat a = \frac{a}{(\pi R^2 \Delta\gamma_0 / E^*)^{1/3}}, \quad
          \hat\delta = \frac{\delta}{(\pi^2 \Delta\gamma_0^2 R / E^{*2})^{1/3}}, \quad
          \hat P = \frac{P}{\pi R \Delta\gamma_0}.

Source: Johnson, Kendall & Roberts (1971), doi:10.1098/rspa.1971.0141; Eq. 2.3 and 2.4.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from viscotack.theory._checks import Number, at_least, plain, positive

from .jkr_branches import (
    contact_radius_at_depth,
    contact_radius_at_force,
    unstable_contact_radius_at_depth,
    unstable_contact_radius_at_force,
)
from .jkr_detachment import (
    Point,
    instability,
    pull_off,
    pull_off_force,
    work_to_instability,
    work_to_pull_off,
)
from .jkr_surface import gap, pressure, surface_displacement

__all__ = [
    "Point",
    "contact_radius_at_depth",
    "contact_radius_at_force",
    "depth",
    "force",
    "gap",
    "instability",
    "pressure",
    "pull_off",
    "pull_off_force",
    "surface_displacement",
    "unstable_contact_radius_at_depth",
    "unstable_contact_radius_at_force",
    "work_to_instability",
    "work_to_pull_off",
]

_LENGTH = "a contact radius is a length"


def force(
    contact_radius: npt.ArrayLike,
    *,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
) -> Number:
    r"""Return the force [N], positive in compression, at a contact radius [m] (Eq. 2.3).

    .. math:: P = \frac{4 E^* a^3}{3 R} - \sqrt{8 \pi E^* a^3 \Delta\gamma_0}

    Examples
    --------
    >>> P = force(1e-4, radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{P * 1e3:.3f} mN"
    '0.212 mN'
    """
    R, E, w = positive(
        radius=radius, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    a = at_least(0, _LENGTH, contact_radius=contact_radius)
    return plain(4 * E * a**3 / (3 * R) - np.sqrt(8 * np.pi * E * a**3 * w))


def depth(
    contact_radius: npt.ArrayLike,
    *,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
) -> Number:
    r"""Return the depth [m], positive into the solid, at a contact radius [m] (Eq. 2.4).

    .. math:: \delta = \frac{a^2}{R} - \sqrt{\frac{2 \pi a \Delta\gamma_0}{E^*}}

    Examples
    --------
    >>> d = depth(1e-4, radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{d * 1e6:.2f} um"
    '4.40 um'
    """
    R, E, w = positive(
        radius=radius, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    a = at_least(0, _LENGTH, contact_radius=contact_radius)
    return plain(a**2 / R - np.sqrt(2 * np.pi * a * w / E))
