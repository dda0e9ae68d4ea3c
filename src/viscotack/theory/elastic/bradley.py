r"""Bradley: a rigid sphere and a rigid plane that attract by the Lennard-Jones 3-9 traction.

The traction of parallel planes vanishes at the equilibrium gap h0 (Eq. 2.1). The depth
:math:`\delta` is zero where the smallest gap is h0, so the gap is
:math:`h_0 - \delta + r^2/2R`. Range: h0 small compared with R, Tabor number tending to zero. For a
deformable solid use :mod:`viscotack.theory.elastic.maugis`.

Source: Bradley (1932), Philosophical Magazine 13, 853 (no DOI known to this package), with the 3-9
traction of Eq. 2.1, that of Greenwood (1997), doi:10.1098/rspa.1997.0070.
"""

from __future__ import annotations

import numpy as np

from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, plain, positive


def force(
    depth: Values, *, radius: Values, work_of_adhesion: Values, equilibrium_gap: Values
) -> Number:
    r"""Return the force [N], positive in compression, at a depth [m].

    With the nearest gap :math:`h = h_0 - \delta`,

    .. math:: P = -2 \pi R \Delta\gamma_0
              \left[ \tfrac43 (h_0/h)^2 - \tfrac13 (h_0/h)^8 \right]

    Parameters
    ----------
    depth : array_like
        Depth [m], below h0; zero where the smallest gap is h0.
    radius, work_of_adhesion, equilibrium_gap : array_like
        R of the sphere [m], :math:`\Delta\gamma_0` [J/m^2] and h0 [m]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> P = force(0.0, radius=1e-6, work_of_adhesion=0.05, equilibrium_gap=3e-10)
    >>> f"{P * 1e9:.1f} nN"
    '-314.2 nN'
    """
    R, w, h0 = positive(
        radius=radius, work_of_adhesion=work_of_adhesion, equilibrium_gap=equilibrium_gap
    )
    d = np.asarray(depth, dtype=float)
    if not np.all(np.isfinite(d) & (d < h0)):
        raise InputError(
            f"depth must be finite and below the equilibrium gap {np.min(h0):.6g} m, got "
            f"{np.max(d)} m; rigid bodies do not overlap"
        )
    x2 = (h0 / (h0 - d)) ** 2
    return plain(-2 * np.pi * R * w * (4 * x2 - x2**4) / 3)


def pull_off_force(*, radius: Values, work_of_adhesion: Values) -> Number:
    r"""Return the pull-off force [N], the positive number :math:`2 \pi R \Delta\gamma_0`.

    It occurs at zero depth and depends only on radius and work of adhesion.

    Parameters
    ----------
    radius, work_of_adhesion : array_like
        R of the sphere [m] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> f"{pull_off_force(radius=1e-6, work_of_adhesion=0.05) * 1e9:.1f} nN"
    '314.2 nN'
    """
    R, w = positive(radius=radius, work_of_adhesion=work_of_adhesion)
    return plain(2 * np.pi * R * w)


def work_to_pull_off(
    *, radius: Values, work_of_adhesion: Values, equilibrium_gap: Values
) -> Number:
    r"""Return the work [J] from zero force, at h = 2^(-1/3) h0, to the force minimum at h0.

    .. math:: W = 2 \pi R \Delta\gamma_0 h_0
              \left( \tfrac{8}{7} 2^{1/3} - \tfrac{9}{7} \right)
              = 0.20559398\ldots \times \tfrac32 \pi R \Delta\gamma_0 h_0

    Parameters
    ----------
    radius, work_of_adhesion, equilibrium_gap : array_like
        R of the sphere [m], :math:`\Delta\gamma_0` [J/m^2] and h0 [m]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> W = work_to_pull_off(radius=1e-6, work_of_adhesion=0.05, equilibrium_gap=3e-10)
    >>> f"{W * 1e18:.2f} aJ"
    '14.53 aJ'
    """
    R, w, h0 = positive(
        radius=radius, work_of_adhesion=work_of_adhesion, equilibrium_gap=equilibrium_gap
    )
    return plain(2 * np.pi * R * w * h0 * (8 * 2 ** (1 / 3) - 9) / 7)
