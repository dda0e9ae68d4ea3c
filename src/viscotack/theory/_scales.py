"""Scales of an elastic adhesive sphere, Eq. 4.16."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._checks import Values, positive


def contact_scales(
    radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> tuple[Any, Any, Any]:
    r"""Return the scales of contact radius [m], depth [m] and force [N].

    .. math:: (\pi R^2 \Delta\gamma_0 / E^*)^{1/3}, \quad
              (\pi^2 \Delta\gamma_0^2 R / E^{*2})^{1/3}, \quad \pi R \Delta\gamma_0
    """
    R, E, w = positive(
        radius=radius, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    ratio = np.cbrt(np.pi * w / (E * R))
    return R * ratio, R * ratio**2, np.pi * R * w
