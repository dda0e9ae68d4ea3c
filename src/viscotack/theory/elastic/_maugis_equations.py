r"""Dimensionless Maugis-Dugdale equations, explicit in c/a and without cancellation.

Contact radius and cohesive radius in :math:`(\pi R^2 \Delta\gamma_0 / K)^{1/3}`, depth in
:math:`(\pi^2 \Delta\gamma_0^2 R / K^2)^{1/3}`, force in :math:`\pi R \Delta\gamma_0`,
:math:`K = \frac43 E^*`. The independent variable is the excess :math:`\varepsilon = c/a - 1`, which
is accurate for thin cohesive zones; :math:`t = \tan\varphi = \sqrt{c^2/a^2 - 1}`.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def angle(excess: Any) -> tuple[Any, Any, Any]:
    """Return m = c/a, t = sqrt(m^2 - 1) and phi = arcsec(m)."""
    t = np.sqrt(excess * (2 + excess))
    return 1 + excess, t, np.arctan(t)


def contact_radius(excess: Any, lam: Any) -> Any:
    r"""Return the contact radius, the positive root of :math:`A a^2 + B a = 1`.

    .. math:: A = \tfrac{\lambda}{2} [t + (m^2 - 2) \varphi], \quad
              B = \tfrac{4 \lambda^2}{3} [t \varphi - m + 1]
    """
    m, t, phi = angle(excess)
    A = lam / 2 * (_tan_excess(t, phi) + t**2 * phi)
    B = 4 * lam**2 / 3 * (t * phi - t**2 / (m + 1))
    return 2 / (B + np.sqrt(B**2 + 4 * A))


def force_and_depth(excess: Any, lam: Any, a: Any) -> tuple[Any, Any]:
    """Return force and depth at a contact radius that satisfies the equation of the gap."""
    m, t, phi = angle(excess)
    return a**3 - lam * a**2 * (t + m**2 * phi), a**2 - 4 / 3 * lam * a * t


def force_slope(excess: Any, lam: Any) -> Any:
    """Return dP/da divided by a along the curve; it changes sign at the force minimum."""
    m, t, phi = angle(excess)
    a = contact_radius(excess, lam)
    q = _shrinkage(excess, lam, a)
    return 3 * a - 2 * lam / t * (q * (1 + t * phi) + t * phi)


def depth_slope(excess: Any, lam: Any) -> Any:
    """Return d(depth)/d(excess) along the curve."""
    m, t, phi = angle(excess)
    a = contact_radius(excess, lam)
    q = _shrinkage(excess, lam, a)
    # c = m a, so that dc = m da + a dm
    da_dm = -a * m / (t**2 - q)
    return (2 * a - 4 / 3 * lam * q / t) * da_dm


def _shrinkage(excess: Any, lam: Any, a: Any) -> Any:
    """Return m dc/da - 1 along the curve, without cancellation for a thin zone."""
    m, t, phi = angle(excess)
    ring = lam * a * (t**2 * phi - _tan_excess(t, phi)) + 4 * lam**2 / 3 * excess
    by_zone = lam * a * (m * phi + t / m) + 4 * lam**2 / 3 * (m * phi / t + 1 / m - 1)
    return ring / (m * by_zone)


def _tan_excess(t: Any, phi: Any) -> Any:
    """Return t - arctan(t), by its series where the difference would cancel."""
    u = np.minimum(t, 0.2)
    series = u**3 * np.polynomial.polynomial.polyval(-(u**2), 1 / np.arange(3.0, 29.0, 2.0))
    return np.where(t < 0.2, series, t - phi)
