"""Relaxed contacts: JKR's, by depth, by force or by radius."""

from __future__ import annotations

from viscotack.errors import InputError
from viscotack.theory.elastic.relaxed import largest_radius

from ._profile import Profile


def radius_at_depth(profile: Profile, depth: float) -> float:
    """Return the radius of the larger, stable relaxed contact at a depth [beta^2/R]."""
    return _found(largest_radius(profile.relaxed_depth, depth), "depth")


def radius_at_force(profile: Profile, force: float) -> float:
    """Return the radius of the larger, stable relaxed contact under a force [R dg]."""
    return _found(largest_radius(profile.relaxed_force, force), "force")


def _found(radius: float | None, name: str) -> float:
    if radius is None:
        raise InputError(
            f"there is no relaxed contact at this {name}: forces of short range let go of "
            "the contact there; start deeper"
        )
    return radius
