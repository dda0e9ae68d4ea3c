"""Relaxed contacts: JKR's, by depth, by force or by radius."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from viscotack.errors import InputError

from ._profile import Profile

_LARGEST = 1e6


def radius_at_depth(profile: Profile, depth: float) -> float:
    """Return the radius of the larger, stable relaxed contact at a depth [beta^2/R]."""
    return _largest_root(lambda a: float(profile.relaxed_depth(a)) - depth, "depth", depth)


def radius_at_force(profile: Profile, force: float) -> float:
    """Return the radius of the larger, stable relaxed contact under a force [R dg]."""
    return _largest_root(lambda a: float(profile.relaxed_force(a)) - force, "force", force)


def _largest_root(excess, name: str, value: float) -> float:  # noqa: ANN001
    radii = np.geomspace(1e-4, _LARGEST, 600)
    below = [i for i, a in enumerate(radii) if excess(a) <= 0]
    if not below or below[-1] == radii.size - 1:
        raise InputError(
            f"there is no relaxed contact at this {name}: forces of short range let go of "
            "the contact there; start deeper"
        )
    low, high = radii[below[-1]], radii[below[-1] + 1]
    return float(brentq(excess, low, high, xtol=1e-13))  # type: ignore[arg-type]
