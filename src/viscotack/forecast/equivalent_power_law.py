"""Which power law stands for the solid of a test, and whether what was learned holds for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from viscotack.problem import Groups

if TYPE_CHECKING:
    from viscotack.surrogate.alike import Alike


def like_of(groups: Groups, depth: float) -> Alike:
    """Return the power law that stands for the solid of a test from a start at a depth [h0]."""
    from viscotack.surrogate import alike, linear_solids, store

    assert groups.rate is not None, "checked at the door"
    material, k = groups.material, groups.modulus_ratio
    creep = np.asarray(material.creep(alike.TIMES / groups.rate)) * material.rubbery_modulus
    # rounded, it may lie beyond its ends
    creep = np.clip(creep, k, 1.0)
    one = np.ones(1)
    learned = store.shipped("solids")
    return linear_solids.like(learned, groups.tabor * one, k * one, depth * one, creep[None])


def unlike_words(like: Alike) -> list[str]:
    """Return in words that a solid is unlike all that were learned from, or nothing."""
    from viscotack.surrogate import linear_solids, store

    learned = store.shipped("solids")
    if learned.inside(like).all():
        return []
    (far,) = linear_solids.far(like, learned.constants["spread"])
    most = learned.constants["farthest"]
    return [
        "the creep of the solid around h0 over the speed is unlike that of all solids which were "
        f"learned from: it leaves a power law by {like.unlike[0]:.2g} of the way from glass "
        f"to rubber, in the logarithm, and {most[0]:.2g} was learned from (in the "
        f"directions of those {far:.2g}, up to {most[1]:.2g})"
    ]


def alike_words(like: Alike) -> str:
    """Return in words what a solid is like."""
    from viscotack.surrogate import physics

    return (
        "around the times of the test the solid creeps like a power law by retardation with the "
        f"exponent {like.groups[0, physics.EXPONENT]:.3g}, to {like.unlike[0]:.1g} of the "
        "way from glass to rubber, in the logarithm"
    )
